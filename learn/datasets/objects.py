"""The objects that small networks are fitted to: generated ones, and folders of descriptions."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.errors import ConfigError, InputRejected
from asset_factory.factory.runtime.terminal import say

from ..objects.catalog import CATEGORIES, make_object
from ..objects.mixture import in_character
from .description import find_descriptions, read_description
from .settings import SourceSettings


def generated(
    seeds: Sequence[int], categories: Sequence[str] = CATEGORIES
) -> Iterator[tuple[str, Articulation]]:
    """Yield an object per category and seed, with names; every other one as an artist makes it."""
    for category in categories:
        for seed in seeds:
            character = "artist" if seed % 2 else "plain"
            made, _ = in_character(make_object(category, seed), character, seed)
            yield f"generated/{category}_{seed}", made


def described(
    folder: Path, names: Collection[str] | None = None
) -> Iterator[tuple[str, Articulation]]:
    """Yield every readable object of a folder of URDF or MJCF folders, or those named, with names.

    Raises:
        ConfigError: there is none.
    """
    items = [each for each in find_descriptions(folder) if names is None or each.name in names]
    if not items:
        wanted = "want a folder of folders with one each"
        raise ConfigError(f"{folder}: holds no URDF and no MJCF that is asked for, {wanted}")
    for item in items:
        try:
            yield item.name, read_description(item, SourceSettings())
        except InputRejected as error:
            say(f"{item.name} left out: {error}")
