"""The objects that motions are learned from: generated ones, and folders of descriptions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.errors import ConfigError, InputRejected

from ..datasets.description import find_descriptions, read_description
from ..datasets.settings import SourceSettings
from ..objects.catalog import CATEGORIES, make_object
from ..objects.mixture import in_character


def generated(
    seeds: Sequence[int], categories: Sequence[str] = CATEGORIES
) -> Iterator[tuple[str, Articulation]]:
    """An object per category and seed, with names; every other one with an artist's surface."""
    for category in categories:
        for seed in seeds:
            made = make_object(category, seed)
            yield (
                f"generated/{category}_{seed}",
                in_character(made, "artist" if seed % 2 else "plain", seed)[0],
            )


def described(folder: Path) -> Iterator[tuple[str, Articulation]]:
    """Yield every readable object of a folder of URDF or MJCF folders, with names.

    Raises:
        ConfigError: there is none.
    """
    items = find_descriptions(folder)
    if not items:
        raise ConfigError(
            f"{folder}: holds no URDF and no MJCF, want a folder of folders with one each"
        )
    for item in items:
        try:
            yield f"{folder.name}/{item.name}", read_description(item, SourceSettings())
        except InputRejected:
            continue
