"""The axis up and the factor to metres: as somebody says, else by real sizes of a category."""

from __future__ import annotations

from dataclasses import dataclass

from ..config import IntakeConfig
from ..errors import ConfigError, InputRejected
from ..mesh import FloatArray
from .categories import UNKNOWN, Category, usual_of
from .orientation import parse_up
from .sidecar import Sidecar

UNITS = ((0.001, "millimetres", 1.0), (0.01, "centimetres", 1.0), (0.0254, "inches", 2.0))
"""Factors tried when a size is implausible in metres, and how much better than others each fits."""

_UNIT_WITHIN = 4.0
"""How far off the expected size, times that handicap, a unit is still believed."""

CUBE_WITHIN = 0.005
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
    usual = usual_of(category)
    if usual is UNKNOWN or abs(float(extents.max()) - 1.0) > CUBE_WITHIN:
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
    size = usual_of(category)
    source = "guess" if size is UNKNOWN else "category"
    what, value = _measured(extents, size)
    least, most = size.range
    plausible = f"{least:g} to {most:g} m is plausible for {_article(size.name)}"
    if least <= value <= most:
        said = f"its {what} is {value:.4g}, and {plausible}."
        return Scale(1.0, "as_is", f"The input was taken to be in metres: {said}")
    expected = size.typical if source == "category" else _UNKNOWN_EXTENT_IN_UNITS
    unit = _best_unit(value, size, expected)
    if unit is not None:
        factor, name = unit
        said = f"its {what} is {value:.4g}, so {value * factor:.4g} m; {plausible}."
        return Scale(factor, source, f"The input was taken to be in {name}: {said}")
    factor = size.typical / value
    said = f"scaled by {factor:.6g} to a {what} of {size.typical:g} m"
    note = f"The input was {said}: its own is {value:.4g}"
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
        if size.range[0] <= value * factor <= size.range[1]
    }
    best = min(off, key=lambda unit: off[unit], default=None)
    return best if best is not None and off[best] <= _UNIT_WITHIN else None


def _article(category: str) -> str:
    words = category.replace("_", " ")
    return f"an {words}" if words[0] in "aeiou" else f"a {words}"


def check_config(config: IntakeConfig) -> None:
    """Refuse settings that cannot be. Raises ConfigError: of the up axis or the height."""
    if config.up != "auto":
        parse_up(config.up)
    if config.height is not None and not 0.0 < config.height < float("inf"):
        raise ConfigError(f"height {config.height}: want a positive number of metres")


def given_up(config: IntakeConfig, sidecar: Sidecar) -> tuple[str, str] | None:
    """Return the up axis and who says so; ``None`` if nobody does."""
    if config.up != "auto":
        return parse_up(config.up), "option"
    return (sidecar.up, "sidecar") if sidecar.up is not None else None


def given_scale(
    extents: FloatArray, config: IntakeConfig, sidecar: Sidecar, name: str
) -> Scale | None:
    """Return the factor to metres that follows from a height or scale; ``None`` if nobody says.

    Args:
        extents: of the mesh, z up, input units, shape [3].
        config: its height wins over the sidecar's.
        sidecar: of the input.
        name: of the file, which opens the sentence.

    Raises:
        InputRejected: ``zero_size``: there is no height to scale.
    """
    height = config.height if config.height is not None else sidecar.height
    if height is None:
        return None if sidecar.scale is None else Scale(sidecar.scale, "sidecar")
    if not extents[2] > 0.0:
        why = f"has no height to scale to {height:g} m; give a scale instead"
        raise InputRejected("zero_size", f"{name}: {why}")
    source = "option" if config.height is not None else "sidecar"
    return Scale(height / float(extents[2]), source)
