"""What is shipped is plain arrays, and beside each file a card says which command makes it."""

from pathlib import Path

import numpy as np
import pytest

from asset_factory.factory.models.shipped import load_arrays

WEIGHTS = Path(__file__).parents[3] / "configs" / "weights"
FILES = sorted(path.name for path in WEIGHTS.iterdir() if path.suffix != ".md")


@pytest.mark.parametrize("file", FILES)
def test_weights_are_plain_numbers_with_a_card(file):
    arrays = load_arrays(WEIGHTS / file).arrays
    # A turn without end is longer than any.
    assert not any(np.isnan(values).any() for values in arrays.values())
    card = (WEIGHTS / file).with_suffix(".md").read_text(encoding="utf-8")
    assert card.startswith(f"# {file}\n")
    assert "| made" in card
    assert f"configs/weights/{file}" in card or "`factory train " in card
    assert "seed" in card
    assert "by hand" not in card
    assert "| terms | Apache-2.0 |" in card
