"""Low-poly furniture as artists model it: closed boxes that touch or overlap, nothing inside."""

from collections.abc import Sequence

from plain_solids import box_between

from asset_factory.factory.mesh import Material, Mesh, concatenate

WOOD = Material("wood", (0.35, 0.2, 0.1, 1.0))
PAINT = Material("paint", (0.7, 0.7, 0.65, 1.0))
METAL = Material("metal", (0.2, 0.2, 0.22, 1.0))
Triple = Sequence[float]


def board(low: Triple, high: Triple, material: Material = WOOD) -> Mesh:
    """A closed box between two corners [m]."""
    return box_between(low, high, material)


def knob(at: Triple) -> Mesh:
    """A small block on a front at y = 0."""
    x, z = at
    return board((x - 0.015, -0.05, z - 0.015), (x + 0.015, -0.018, z + 0.015), METAL)


def plate(low: tuple[float, float], high: tuple[float, float]) -> Mesh:
    """A front from 2 cm before the carcass to 3 cm within it."""
    return board((low[0], -0.02, low[1]), (high[0], 0.03, high[1]), PAINT)


def drawer_chest() -> Mesh:
    """A closed block with two drawers' fronts sunk into it, a knob each."""
    return concatenate(
        [
            board((0.0, 0.0, 0.0), (0.6, 0.45, 0.6)),
            plate((0.05, 0.06), (0.55, 0.28)),
            plate((0.05, 0.32), (0.55, 0.54)),
            knob((0.3, 0.17)),
            knob((0.3, 0.43)),
        ]
    )


def fridge() -> Mesh:
    """A closed block with a small door above a large one, bars at the left of both."""
    return concatenate(
        [
            board((0.0, 0.0, 0.0), (0.6, 0.6, 1.6)),
            board((0.0, -0.06, 0.02), (0.6, -0.001, 1.05), PAINT),
            board((0.0, -0.06, 1.07), (0.6, -0.001, 1.58), PAINT),
            board((0.05, -0.1, 0.65), (0.08, -0.06, 0.95), METAL),
            board((0.05, -0.1, 1.15), (0.08, -0.06, 1.4), METAL),
        ]
    )
