"""Cabinets and kitchen appliances by ``scene_synthesizer`` (Apache-2.0), as URDF files to train on.

python examples/synthesise_objects.py FOLDER 330 --seed 7

Runs in an environment of its own with ``scene_synthesizer`` installed; it needs nothing of this
package. The same arguments give the same objects, each in a folder of its own, its front towards
-Y; folders that are there are kept.
"""

from __future__ import annotations

import argparse
import random
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

Random = random.Random
Range = tuple[float, float]
#: Half a turn about the vertical, for the one kind that looks the other way.
TURN = np.diag([-1.0, -1.0, 1.0, 1.0])
DOORS = (
    ("door_left",),
    ("door_right",),
    ("door_right", "door_left"),
    ("door_right", "closed", "door_left"),
    ("drawer", "drawer"),
    ("door_right", "door_left", "door_left"),
)

# Arguments are drawn in the order in which they are written: another order makes other objects of
# the same seed.


def size(r: Random, width: Range, depth: Range, height: Range) -> dict[str, float]:
    """Outer size [m], each side between two lengths."""
    return {"width": r.uniform(*width), "depth": r.uniform(*depth), "height": r.uniform(*height)}


def bent_handle(r: Random, scratch: str) -> dict[str, Any]:
    """The shape of a bent handle."""
    return {
        "straight_ratio": r.uniform(0.3, 0.9),
        "curvature_ratio": r.uniform(0.3, 0.9),
        "num_segments_cross_section": r.choice((6, 8, 10)),
        "num_segments_curvature": r.choice((4, 6, 10)),
        "aspect_ratio_cross_section": r.uniform(0.4, 1),
        "tmp_mesh_dir": scratch,
    }


def handles(r: Random, scratch: str) -> dict[str, Any]:
    """Size [m] and shape of a cabinet's handles: plain bars, or bent."""
    return {
        "handle_width": r.uniform(0.05, 0.25),
        "handle_height": r.uniform(0.015, 0.045),
        "handle_depth": r.uniform(0.015, 0.05),
        "handle_shape_args": r.choice((None, bent_handle(r, scratch))),
    }


def long_handle(r: Random, width: float, scratch: str) -> dict[str, Any]:
    """A handle across much of a door of this width [m]."""
    return {
        "handle_length": r.uniform(0.3, 0.85) * width,
        "handle_thickness": r.uniform(0.02, 0.05),
        "handle_depth": r.uniform(0.03, 0.06),
        "handle_shape_args": bent_handle(r, scratch),
    }


def compartments(r: Random) -> Any:
    """Which compartment each cell of a cabinet's front belongs to, shape [rows, columns]."""
    rows = r.choice((1, 2, 3, 4))
    columns = r.choice((1, 1, 2, 3))
    mask = np.arange(rows * columns).reshape(rows, columns)
    if columns > 1 and rows > 1 and r.random() < 0.5:
        mask[:, 0] = mask[0, 0]
    return np.unique(mask, return_inverse=True)[1].reshape(rows, columns)


def base_cabinet(made: Any, r: Random, scratch: str) -> Any:
    """A kitchen's lower cabinet."""
    return made.BaseCabinetAsset(
        **size(r, (0.35, 1.3), (0.4, 0.75), (0.7, 1.0)),
        num_drawers_vertical=r.choice((0, 1, 1, 2)),
        drawer_height=r.uniform(0.12, 0.22),
        lower_compartment_types=r.choice(DOORS),
        num_shelves=r.choice((0, 1, 2)),
        **handles(r, scratch),
    )


def wall_cabinet(made: Any, r: Random, scratch: str) -> Any:
    """A kitchen's upper cabinet."""
    return made.WallCabinetAsset(
        **size(r, (0.35, 1.2), (0.25, 0.45), (0.4, 1.0)),
        compartment_types=r.choice(DOORS[:4]),
        num_shelves=r.choice((0, 1, 2, 3)),
        **handles(r, scratch),
    )


def sink_cabinet(made: Any, r: Random, scratch: str) -> Any:
    """A cabinet under a sink."""
    return made.SinkCabinetAsset(
        **size(r, (0.6, 1.1), (0.55, 0.8), (0.75, 1.0)),
        sink_tmp_mesh_dir=scratch,
        **handles(r, scratch),
    )


def kitchen_island(made: Any, r: Random, scratch: str) -> Any:
    """A free-standing block of cabinets."""
    return made.KitchenIslandAsset(
        **size(r, (0.9, 1.6), (0.55, 0.85), (0.8, 1.0)), **handles(r, scratch)
    )


def drawer_cabinet(made: Any, r: Random, scratch: str) -> Any:
    """Drawers, doors and open compartments in a grid."""
    mask = compartments(r)
    kinds = ("drawer", "drawer", "door_left", "door_right", "open")
    return made.CabinetAsset(
        **size(r, (0.3, 1.2), (0.3, 0.6), (0.5, 1.8)),
        compartment_mask=mask,
        compartment_types=[r.choice(kinds) for _ in range(mask.max() + 1)],
        **handles(r, scratch),
    )


def recursive_cabinet(made: Any, r: Random, scratch: str) -> Any:
    """A cabinet whose front is divided again and again."""
    return made.RecursivelyPartitionedCabinetAsset(
        **size(r, (0.5, 1.5), (0.3, 0.6), (0.6, 2.0)),
        split_prob=r.uniform(0.7, 1),
        split_decay=r.uniform(0.4, 0.6),
        seed=r.randrange(2**31),
    )


def fridge(made: Any, r: Random, scratch: str) -> Any:
    """A refrigerator with a freezer."""
    outer = size(r, (0.5, 0.95), (0.5, 0.85), (1.2, 2.0))
    return made.RefrigeratorAsset(
        **outer,
        freezer_compartment_height=r.uniform(0.25, 0.4) * outer["height"],
        thickness=r.uniform(0.04, 0.08),
        num_shelves=r.choice((2, 3, 4, 5)),
        num_door_shelves=r.choice((2, 3, 4)),
        handle_left=r.random() < 0.5,
        handle_length=r.uniform(0.15, 0.35),
        handle_shape_args=bent_handle(r, scratch),
    )


def microwave(made: Any, r: Random, scratch: str) -> Any:
    """A microwave oven."""
    return made.MicrowaveAsset(
        **size(r, (0.42, 0.7), (0.3, 0.5), (0.24, 0.42)),
        thickness=r.uniform(0.02, 0.05),
        display_panel_width=r.uniform(0.08, 0.16),
        handle_left=r.random() < 0.5,
        tmp_mesh_dir=scratch,
    )


def oven(made: Any, r: Random, scratch: str) -> Any:
    """A kitchen range."""
    outer = size(r, (0.55, 0.95), (0.55, 0.8), (0.82, 1.0))
    return made.RangeAsset(
        **outer,
        control_panel_height=r.uniform(0.06, 0.12),
        storage_height=r.uniform(0.14, 0.24),
        wall_thickness=r.uniform(0.015, 0.03),
        **long_handle(r, outer["width"], scratch),
    )


def dishwasher(made: Any, r: Random, scratch: str) -> Any:
    """A dishwasher with its baskets."""
    outer = size(r, (0.45, 0.8), (0.55, 0.75), (0.75, 0.95))
    return made.DishwasherAsset(
        **outer,
        control_panel_height=r.uniform(0.06, 0.12),
        foot_panel_height=r.uniform(0.03, 0.1),
        door_thickness=r.uniform(0.03, 0.06),
        basket_wire_mesh_gap=r.uniform(0.05, 0.09),
        **long_handle(r, outer["width"], scratch),
    )


def switch(made: Any, r: Random, scratch: str) -> Any:
    """A fuse box with a lever."""
    return made.SafetySwitchAsset(
        fuse_box_width=r.uniform(0.15, 0.35),
        fuse_box_depth=r.uniform(0.08, 0.18),
        fuse_box_height=r.uniform(0.25, 0.5),
        lever_length=r.uniform(0.1, 0.25),
    )


Maker = Callable[[Any, Random, str], Any]
MAKERS: tuple[Maker, ...] = (
    base_cabinet, wall_cabinet, sink_cabinet, kitchen_island, drawer_cabinet, recursive_cabinet,
    fridge, microwave, oven, dishwasher, switch,
)  # fmt: skip


def write_object(folder: Path, maker: Maker, number: int, seed: int) -> None:
    """Make one object and write it as a URDF with its meshes.

    Args:
        folder: of the object; must not be there.
        maker: of its kind.
        number: of the object; with ``seed``, decides everything about it.
        seed: of the set.
    """
    import scene_synthesizer as synth
    from scene_synthesizer import procedural_assets

    category = maker.__name__
    r = Random(f"{seed}/{category}/{number}")
    np.random.seed(r.randrange(2**32))  # noqa: NPY002 - the library draws from numpy's global stream
    with tempfile.TemporaryDirectory() as scratch:
        scene = synth.Scene(seed=number)
        placed = TURN if maker is recursive_cabinet else np.eye(4)
        scene.add_object(maker(procedural_assets, r, scratch), category, transform=placed)
        folder.mkdir(parents=True)
        scene.export(str(folder / f"{category}.urdf"))


def main() -> int:
    """Parse, make, write; 1 if some objects could not be made."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, help="where to write")
    parser.add_argument("count", type=int, help="how many objects, of all kinds in turn")
    parser.add_argument("--seed", type=int, default=4242, help="of the set")
    given = parser.parse_args()
    failed = 0
    for number in range(given.count):
        maker = MAKERS[number % len(MAKERS)]
        folder = given.folder / f"{maker.__name__}_{number:04d}"
        if folder.exists():
            continue
        try:
            write_object(folder, maker, number, given.seed)
        except Exception as error:  # noqa: BLE001 - an odd draw of arguments costs that object alone
            failed += 1
            print(f"{folder.name}: {type(error).__name__}: {error}", file=sys.stderr)
            shutil.rmtree(folder, ignore_errors=True)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
