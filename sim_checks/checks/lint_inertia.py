"""Is a link's inertia one that a rigid body can have, and one that this body could have?"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..config import LintConfig
from ..description import ABSURD, FloatArray, Link, LinkInertia, sensible
from ..geometry.hull import FlatHull, convex_hull
from ..report import Finding, Severity

#: Relative slack of the triangle inequality: files are written with few digits.
TRIANGLE_SLACK = 1e-3
#: How far outside its box a centre of mass may lie, as a share of the link's diagonal.
CENTER_SLACK = 0.05


def inertia_findings(link: Link, config: LintConfig) -> Iterator[Finding]:
    """Hard where no rigid body has such an inertia; soft where this one hardly can."""
    inertia = link.inertia
    if inertia is None:
        return
    parts = (link.name,)
    if not (sensible(inertia.mass) and sensible(inertia.center) and sensible(inertia.tensor)):
        message = f"link {link.name!r}: a number of its inertia is not finite, or beyond {ABSURD:g}"
        yield Finding("inertia_not_finite", Severity.HARD, message, parts=parts)
        return
    if inertia.mass <= 0.0:
        message = f"link {link.name!r} weighs {inertia.mass:g} kg, want more than 0"
        yield Finding(
            "mass_not_positive",
            Severity.HARD,
            message,
            parts=parts,
            value=inertia.mass,
            unit="kg",
            limit=0.0,
        )
        return
    moments: FloatArray = np.linalg.eigvalsh(0.5 * (inertia.tensor + inertia.tensor.T)).astype(
        np.float64
    )
    if moments[0] <= 0.0:
        message = (
            f"link {link.name!r}: smallest principal moment is "
            f"{moments[0]:.3g} kg m2, want more than 0"
        )
        yield Finding(
            "inertia_not_positive",
            Severity.HARD,
            message,
            parts=parts,
            value=float(moments[0]),
            unit="kg m2",
            limit=0.0,
        )
        return
    if moments[0] + moments[1] < moments[2] * (1.0 - TRIANGLE_SLACK):
        a, b, c = moments
        message = (
            f"link {link.name!r}: principal moments {a:.3g}, {b:.3g}, {c:.3g} kg m2: "
            "the two smaller must add up to the largest at least"
        )
        ratio = float((a + b) / c)
        yield Finding(
            "inertia_triangle",
            Severity.HARD,
            message,
            parts=parts,
            value=round(ratio, 6),
            limit=1.0,
        )
        return
    yield from _plausible(link, inertia, moments, config)


def _plausible(
    link: Link, inertia: LinkInertia, moments: FloatArray, config: LintConfig
) -> Iterator[Finding]:
    shapes = link.collisions or link.visuals
    if not shapes:
        return
    parts = (link.name,)
    points = np.vstack([shape.vertices for shape in shapes])
    low = points.min(axis=0)
    high = points.max(axis=0)
    diagonal = float(np.linalg.norm(high - low))
    outside = float(np.maximum(low - inertia.center, inertia.center - high).max())
    if outside > CENTER_SLACK * diagonal:
        message = (
            f"link {link.name!r}: centre of mass lies {1000 * outside:.1f} "
            "mm outside the link's box"
        )
        yield Finding(
            "center_outside",
            Severity.SOFT,
            message,
            parts=parts,
            value=round(1000 * outside, 4),
            unit="mm",
            limit=round(1000 * CENTER_SLACK * diagonal, 4),
        )
    yield from _gyration(link, math.sqrt(float(moments[2]) / inertia.mass), diagonal, config)
    volume = _volume(link)
    if volume > 0.0 and not config.density_low <= inertia.mass / volume <= config.density_high:
        density = inertia.mass / volume
        message = (
            f"link {link.name!r}: {inertia.mass:.3g} kg in {1000 * volume:.3g} litres of hulls is "
            f"{density:.3g} kg/m3, want {config.density_low:g} to {config.density_high:g}"
        )
        limit = config.density_low if density < config.density_low else config.density_high
        times = max(limit / density, density / limit) if density > 0.0 else math.inf
        severity = Severity.HARD if times > config.density_hard else Severity.SOFT
        yield Finding(
            "density_implausible",
            severity,
            message,
            parts=parts,
            value=float(f"{density:.4g}"),
            unit="kg/m3",
            limit=limit,
        )


def _gyration(
    link: Link, gyration: float, diagonal: float, config: LintConfig
) -> Iterator[Finding]:
    points = np.vstack([shape.vertices for shape in (*link.collisions, *link.visuals)])
    across = float(np.linalg.norm(np.ptp(points, axis=0)))
    number = round(gyration, 6) if math.isfinite(gyration) else None
    if gyration > across:
        message = (
            f"link {link.name!r}: radius of gyration {gyration:.3g} m is more than its diagonal of "
            f"{across:.3g} m: no mass within it has such an inertia"
        )
        limit = round(across, 6)
        yield Finding(
            "inertia_impossible",
            Severity.HARD,
            message,
            None,
            None,
            (link.name,),
            number,
            "m",
            limit,
        )
    elif gyration > config.gyration_share * diagonal:
        message = (
            f"link {link.name!r}: radius of gyration {gyration:.3g} m is too large for a "
            f"link {diagonal:.3g} m across"
        )
        limit = round(config.gyration_share * diagonal, 6)
        yield Finding(
            "inertia_implausible",
            Severity.SOFT,
            message,
            None,
            None,
            (link.name,),
            number,
            "m",
            limit,
        )


def _volume(link: Link) -> float:
    """Volume of the collision hulls together [m3]; overlaps count twice."""
    total = 0.0
    for shape in link.collisions:
        try:
            total += convex_hull(shape.vertices).volume
        except FlatHull:
            continue
    return total
