"""Data made once and kept in a folder: the views and the rows of generated objects' sides."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.geometry.posing import closed, turned

from ..datasets.objects import described
from ..elevations.rows import Rows, rows_of
from ..elevations.views import views_of, write_views
from ..objects import CATEGORIES, make_object
from ..objects.groups import LIDDED, OTHER, PANELLED

#: Objects of a folder are looked at so often, each time in other looks.
LOOKS = 3


def keep_views(folder: Path, seed: int, objects: int) -> None:
    """Keep views of generated objects, those that are not there yet."""
    for number in range(objects):
        path = folder / f"{seed}_{number}.npz"
        if not path.is_file():
            rng = np.random.default_rng([seed, number])
            write_views(path, views_of(_made(number, rng), rng))


def keep_described_views(folder: Path, seed: int, data: Path, yaw: float) -> None:
    """Keep views of the objects of a folder of descriptions, several of each.

    Args:
        folder: where.
        seed: of their looks.
        data: folder of folders with a URDF or an MJCF each.
        yaw: turn about the vertical that brings their fronts to -Y [rad].
    """
    for name, found in described(data):
        articulation = turned(closed(found), yaw)
        for look in range(LOOKS):
            rng = np.random.default_rng([seed, look, len(articulation.mesh.faces)])
            path = folder / f"{name.replace('/', '__')}_{look}.npz"
            if not path.is_file():
                write_views(path, views_of(articulation, rng))


def kept_rows(folder: Path, seed: int, number: int) -> Rows:
    """Return the rows of one generated object, made where they are not kept yet."""
    path = folder / f"{seed}_{number}.npz"
    if not path.is_file():
        rng = np.random.default_rng([seed, number])
        np.savez_compressed(path, **vars(rows_of(_made(number, rng), rng)))
    with np.load(path, allow_pickle=False) as data:
        return Rows(**{name: data[name] for name in data.files})


def _made(number: int, rng: np.random.Generator) -> Articulation:
    kinds = (PANELLED, LIDDED, PANELLED, OTHER, PANELLED)[number % 5]
    kind = str(rng.choice(CATEGORIES if number % 10 == 3 else kinds))
    return make_object(kind, int(rng.integers(2**31)))
