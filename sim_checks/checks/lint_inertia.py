"""Is a link's inertia one that a rigid body can have, and one that this body could have?"""

from __future__ import annotations

import math

import numpy as np

from ..config import LintConfig
from ..description import ABSURD, Description, FloatArray, Link, LinkInertia, sensible
from ..geometry.hull import find_hull
from ..geometry.kinematics import Tree
from ..geometry.placing import box_around, box_gap, diagonal
from ..geometry.surfaces import VisibleSurface
from .result import Findings, error, graded, in_mm, measured, rounded, significant, warning

#: Relative slack of the triangle inequality: files are written with few digits.
TRIANGLE_SLACK = 1e-3


def missing_inertia_findings(description: Description, tree: Tree | None) -> Findings:
    """Yield an error where a moving link has no inertia, a warning where a still one has none.

    MuJoCo's compiler makes up what an MJCF leaves out, by a rule of the format.
    """
    if description.format != "urdf":
        return
    parts = (tuple(each.name for each in description.links),) if tree is None else tree.parts
    bare = {link.name for link in description.links if link.inertia is None}
    seen = {link.name for link in description.links if link.collisions or link.visuals}
    for i, part in enumerate(parts):
        moves = i > 0
        massless = moves and bare.issuperset(part)
        for name in part:
            if name not in bare or not (name in seen or (massless and name == part[0])):
                continue
            what = "moves and has" if moves else "has"
            message = (
                f"link {name!r} {what} no inertia: every simulator invents another; "
                "state its mass, centre of mass and moments in an <inertial>"
            )
            yield graded(moves, "missing_inertia", message, parts=(name,))


def inertia_findings(link: Link, config: LintConfig) -> Findings:
    """Yield an error where no rigid body has such an inertia, a warning where this hardly can."""
    inertia = link.inertia
    if inertia is None:
        return
    parts = (link.name,)
    name = f"link {link.name!r}"
    if not (sensible(inertia.mass) and sensible(inertia.center) and sensible(inertia.tensor)):
        message = f"{name}: a number of its inertia is not finite, or beyond {ABSURD:g}"
        yield error("inertia_not_finite", message, parts=parts)
        return
    if inertia.mass <= 0.0:
        message = f"{name} weighs {inertia.mass:g} kg, want more than 0"
        yield error("mass_not_positive", message, parts=parts, **measured(inertia.mass, "kg", 0.0))
        return
    symmetric = 0.5 * (inertia.tensor + inertia.tensor.T)
    moments: FloatArray = np.linalg.eigvalsh(symmetric).astype(np.float64)
    a, b, c = moments.tolist()
    if a <= 0.0:
        message = f"{name}: smallest principal moment is {a:.3g} kg m2, want more than 0"
        yield error("inertia_not_positive", message, parts=parts, **measured(a, "kg m2", 0.0))
    elif a + b < c * (1.0 - TRIANGLE_SLACK):
        message = f"{name}: principal moments {a:.3g}, {b:.3g}, {c:.3g} kg m2: "
        message += "the two smaller must add up to the largest at least"
        ratio = round((a + b) / c, 6)
        yield error("inertia_triangle", message, parts=parts, value=ratio, limit=1.0)
    elif link.collisions or link.visuals:
        box = box_around(shape.vertices for shape in (*link.collisions, *link.visuals))
        yield from _center(link, inertia.center, box, config)
        yield from _gyration(link, inertia, moments, box, config)
        yield from _density(link, inertia.mass, config)


def _center(link: Link, center: FloatArray, box: FloatArray, config: LintConfig) -> Findings:
    """Check how far the centre of mass lies outside the box around the link's shapes."""
    outside = box_gap(center[None], box)
    soft = config.center_soft * diagonal([box])
    if outside <= soft:
        return
    most = max(config.center_hard * diagonal([box]), config.center_m)
    hard = outside > most
    limit = most if hard else soft
    message = (
        f"link {link.name!r}: centre of mass lies {1000 * outside:.1f} mm outside the link's box, "
        f"want at most {1000 * limit:.3g} mm"
    )
    yield graded(hard, "center_outside", message, parts=(link.name,), **in_mm(outside, limit))


def _density(link: Link, mass: float, config: LintConfig) -> Findings:
    """Check mass over hull volume; too dense is an error only where nothing else has room."""
    # Overlaps count twice.
    hulls = (find_hull(shape.vertices) for shape in link.collisions)
    volume = sum(hull.volume for hull in hulls if hull is not None)
    if not volume > 0.0 or config.density_low <= mass / volume <= config.density_high:
        return
    low = mass / volume < config.density_low
    room = volume if low else max(volume, _visible_volume(link, config.sheet_m))
    density = mass / room
    hard = density < config.density_least or density > config.density_most
    if low:
        limit = config.density_least if hard else config.density_low
    else:
        limit = config.density_most if hard else config.density_high
    message = (
        f"link {link.name!r}: {mass:.3g} kg in {1000 * room:.3g} litres is {density:.3g} kg/m3, "
        f"want at {'least' if low else 'most'} {limit:g}"
    )
    told = measured(significant(density, 4), "kg/m3", limit)
    yield graded(hard, "density_implausible", message, parts=(link.name,), **told)


def _gyration(
    link: Link, inertia: LinkInertia, moments: FloatArray, box: FloatArray, config: LintConfig
) -> Findings:
    """Check an inertia against the extents that it must fit in.

    Its largest radius of gyration is held against the diagonal of the collision shapes, and the
    spread of its mass along each axis against the box around all.
    """
    gyration = math.sqrt(float(moments[2]) / inertia.mass)
    across = diagonal(shape.vertices for shape in link.collisions or link.visuals)
    second = np.trace(inertia.tensor) / 2.0 - np.diag(inertia.tensor)
    spread = np.sqrt(np.maximum(second, 0.0) / inertia.mass)
    extent = np.ptp(box, axis=0)
    # Within an extent mass spreads furthest at its two ends, half of it at each.
    most = extent / 2.0 + max(config.center_hard * float(np.linalg.norm(extent)), config.center_m)
    axis = int(np.argmax(spread / most))
    if spread[axis] > most[axis]:
        message = (
            f"link {link.name!r}: its inertia spreads its mass by {spread[axis]:.3g} m along "
            f"{'xyz'[axis]}, where the link is {extent[axis]:.3g} m long: mass inside it cannot"
        )
        told = measured(significant(float(spread[axis])), "m", round(float(most[axis]), 6))
        yield error("inertia_impossible", message, parts=(link.name,), **told)
    elif gyration > config.gyration_share * across:
        message = f"link {link.name!r}: radius of gyration {gyration:.3g} m is too large for a "
        message += f"link {across:.3g} m across"
        told = rounded(gyration, "m", config.gyration_share * across)
        yield warning("inertia_implausible", message, parts=(link.name,), **told)


def _visible_volume(link: Link, sheet: float) -> float:
    """Return the volume that visible surfaces enclose [m3], or of sheets so thick, if more.

    A surface counts with both of its sides; overlaps count twice.
    """
    enclosed = area = 0.0
    for shape in link.visuals:
        surface = VisibleSurface(shape.vertices, shape.faces)
        enclosed += abs(surface.volume)
        area += float(surface.areas.sum())
    return max(enclosed, 0.5 * area * sheet)
