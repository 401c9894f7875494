"""The objects that small networks are fitted to: generated ones, and folders of descriptions."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from pathlib import Path

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.errors import ConfigError, InputRejected
from asset_factory.factory.runtime.terminal import say

from ..objects.catalog import CATEGORIES, make_object
from ..objects.mixture import in_character
from .description import find_descriptions, read_description
from .settings import SourceSettings


def generated(
    seeds: Iterable[int],
    categories: Sequence[str] = CATEGORIES,
    characters: Sequence[str] = ("plain", "artist"),
) -> Iterator[tuple[str, Articulation]]:
    """Yield an object per seed and category, with names; each character is as frequent."""
    for seed in seeds:
        for number, category in enumerate(categories):
            character = characters[(seed + number) % len(characters)]
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
