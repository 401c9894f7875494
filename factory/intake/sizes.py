"""The factor that makes a mesh's units metres, by the real sizes of its category."""

from __future__ import annotations

from dataclasses import dataclass

from ..mesh import FloatArray
from .categories import UNKNOWN, Category, category_table

UNITS = ((0.001, "millimetres", 1.0), (0.01, "centimetres", 1.0), (0.0254, "inches", 2.0))
"""Factors tried when a size is implausible in metres, and how much better than others each fits."""

_UNIT_WITHIN = 4.0
"""How far off the expected size, times that handicap, a unit is still believed."""

UNIT_WITHIN = 0.005
"""How far the largest extent of a mesh that image-to-3D tools leave in a unit cube is from 1."""

_UNKNOWN_EXTENT_IN_UNITS = 0.5


@dataclass(frozen=True)
class Scale:
    """A factor from input units to metres, and the sentence that says why.

    Attributes:
        factor: metres per input unit.
        source: as in ``Provenance.scale_source``.
        note: ``None`` if nothing was assumed.
        plausible: whether a known unit explains the size; if not, the typical size was imposed.
    """

    factor: float
    source: str
    note: str | None = None
    plausible: bool = True


def scale_of_unit_cube(extents: FloatArray, category: str | None) -> Scale | None:
    """Return the factor to its category's typical size for a mesh that fills a unit cube.

    Image-to-3D tools scale whatever they make to it, so that its size says nothing.

    Args:
        extents: of the mesh, z up, input units, shape [3].
        category: as for :func:`scale_by_size`.
    """
    usual = category_table().get(category) if category else None
    if usual is None or abs(float(extents.max()) - 1.0) > UNIT_WITHIN:
        return None
    what, value = _measured(extents, usual)
    factor = usual.typical / value
    note = (
        f"The input fills a cube of side 1, as image-to-3D tools leave their meshes: it was scaled "
        f"by {factor:.4g} to a {what} of {usual.typical:g} m, usual for {_article(usual.name)}; "
        f"its own is {value:.4g}."
    )
    return Scale(factor, "category", note)


def scale_by_size(extents: FloatArray, category: str | None) -> Scale:
    """Return the factor that makes a mesh plausible in metres, by category if it is known.

    Args:
        extents: of the mesh, z up, input units, shape [3].
        category: as from :func:`normalised` or :func:`guess_category`.
    """
    size = category_table().get(category) if category else None
    if size is None:
        size = UNKNOWN
        source = "guess"
    else:
        source = "category"
    what, value = _measured(extents, size)
    plausible = f"{size.least:g} to {size.most:g} m is plausible for {_article(size.name)}"
    if size.least <= value <= size.most:
        return Scale(
            1.0,
            "as_is",
            f"The input was taken to be in metres: its {what} is {value:.4g}, and {plausible}.",
        )
    expected = size.typical if source == "category" else _UNKNOWN_EXTENT_IN_UNITS
    unit = _best_unit(value, size, expected)
    if unit is not None:
        factor, name = unit
        note = (
            f"The input was taken to be in {name}: "
            f"its {what} is {value:.4g}, so {value * factor:.4g} m"
        )
        return Scale(factor, source, f"{note}; {plausible}.")
    factor = size.typical / value
    note = (
        f"The input was scaled by {factor:.6g} to a {what} of {size.typical:g} m: "
        f"its own is {value:.4g}"
    )
    return Scale(factor, source, f"{note}, which no known unit makes likely ({plausible}).", False)


def _measured(extents: FloatArray, size: Category) -> tuple[str, float]:
    """Return what of a mesh is compared with usual sizes, and how large it is."""
    if size.measure == "extent" or extents[2] <= 0.0:
        return "largest extent", float(extents.max())
    return "height", float(extents[2])


def _best_unit(value: float, size: Category, expected: float) -> tuple[float, str] | None:
    """Return the unit that makes ``value`` plausible and closest to the expected size."""
    off = {
        (factor, name): handicap * max(value * factor / expected, expected / (value * factor))
        for factor, name, handicap in UNITS
        if size.least <= value * factor <= size.most
    }
    best = min(off, key=lambda unit: off[unit], default=None)
    return best if best is not None and off[best] <= _UNIT_WITHIN else None


def _article(category: str) -> str:
    words = category.replace("_", " ")
    return f"an {words}" if words[0] in "aeiou" else f"a {words}"
