"""Which assets are for training and which for testing."""

from typing import Literal

from ..runtime.store import digest_bytes

Split = Literal["train", "test"]
SPLITS: tuple[Split, ...] = ("train", "test")
#: Share of all assets that are kept for testing.
TEST_SHARE = 0.2


def split_of(asset_id: str) -> Split:
    """Return an asset's split, from its id alone, so that a growing registry moves nothing."""
    return "test" if int(digest_bytes(asset_id.encode())[:8], 16) < TEST_SHARE * 2**32 else "train"
