"""Are the collision shapes what engines can take, and do they lie where the visible surface is?"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from ..config import LintConfig
from ..description import DescribedShape, FloatArray, Link
from ..geometry.hull import CollisionHull, FlatHull, convex_hull, farthest_along
from ..geometry.outside import distance_outside
from ..geometry.placing import diagonal
from ..report import Finding
from .lint_interior import interior_findings
from .result import error, graded, significant, warning

#: Visible surface is sampled this many times denser where it is the yardstick.
DENSER = 8
QUANTILE = 0.95


def shape_findings(
    link: Link, down: FloatArray, config: LintConfig
) -> tuple[list[Finding], dict[str, Any]]:
    """Check one link's shapes and measure them; ``down`` points down in its frame, shape [3]."""
    findings: list[Finding] = []
    hulls: list[CollisionHull] = []
    doubtful: list[Finding] = []
    for shape in link.collisions:
        try:
            hull = convex_hull(shape.corners)
        except FlatHull as flat:
            message = f"collision shape {shape.name!r} of link {link.name!r} has no volume: {flat}"
            findings.append(error("degenerate_collision", message, parts=(link.name,)))
            continue
        hulls.append(hull)
        doubtful.extend(_hull_findings(link, shape, hull, config))
    findings.extend(_worst_of_each_code(doubtful))
    count = len(link.collisions)
    numbers: dict[str, Any] = {
        "collision_shapes": count,
        "visual_shapes": len(link.visuals),
        "collision_meshes": [
            {"file": shape.file, "vertices": len(shape.vertices), "faces": len(shape.faces)}
            for shape in link.collisions
            if shape.kind == "mesh"
        ],
    }
    if count > config.hulls_per_link:
        message = (
            f"link {link.name!r} has {count} collision shapes; "
            f"GPU simulation allows {config.hulls_per_link}"
        )
        limit = float(config.hulls_per_link)
        findings.append(
            warning("many_hulls", message, parts=(link.name,), value=float(count), limit=limit)
        )
    findings.extend(_scale_findings(link, config))
    if hulls and link.visuals:
        found, distances = _cover_findings(link, hulls, config)
        findings.extend(found)
        numbers.update(distances)
    filled, kept = interior_findings(link, hulls, down, config)
    return findings + filled, {**numbers, **kept}


def _worst_of_each_code(findings: list[Finding]) -> Iterator[Finding]:
    """Yield one finding per code: the worst, with the number of shapes that share it.

    A hundred hulls must not bury the rest.
    """
    for code in dict.fromkeys(finding.code for finding in findings):
        same = [finding for finding in findings if finding.code == code]
        worst = max(same, key=lambda finding: math.inf if finding.value is None else finding.value)
        others = f"; the same of {len(same) - 1} more" if len(same) > 1 else ""
        yield replace(worst, message=f"{worst.message}{others}")


def _hull_findings(
    link: Link, shape: DescribedShape, hull: CollisionHull, config: LintConfig
) -> Iterator[Finding]:
    name = f"collision shape {shape.name!r} of link {link.name!r}"
    parts = (link.name,)
    if shape.kind == "mesh" and hull.corners > config.hull_vertices:
        most = config.hull_vertices
        allowed = "GPU simulation allows"
        if hull.corners > config.most_vertices:
            most = config.most_vertices
            allowed = "each engine cooks it down to another; want at most"
        grave = most == config.most_vertices
        message = f"{name} has a hull of {hull.corners} corners; {allowed} {most}"
        count = float(hull.corners)
        limit = float(most)
        yield graded(grave, "many_hull_vertices", message, parts=parts, value=count, limit=limit)
    aspect = _aspect(hull)
    if aspect > config.hull_aspect:
        message = (
            f"{name} is {aspect:.0f} times longer than thick; "
            f"GPU simulation takes up to {config.hull_aspect:g}"
        )
        yield warning(
            "oblong_hull", message, parts=parts, value=round(aspect, 3), limit=config.hull_aspect
        )
    if shape.kind == "mesh":
        volume = _signed_volume(shape)
        if volume <= 0.0 or hull.volume > config.convexity * volume:
            ratio = round(hull.volume / volume, 4) if volume > 0.0 else None
            message = f"{name} is open, flat or inside out: engines take its hull"
            if ratio is not None and ratio <= 1e3:
                message = (
                    f"{name} is not convex: engines take its hull, {ratio:.3g} times its own volume"
                )
            yield warning(
                "nonconvex_collision", message, parts=parts, value=ratio, limit=config.convexity
            )


def _aspect(hull: CollisionHull) -> float:
    """Return the longest over shortest width, along the hull's own principal directions."""
    centered = hull.vertices - hull.vertices.mean(axis=0)
    _, _, directions = np.linalg.svd(centered, full_matrices=False)
    widths = np.ptp(centered @ directions.T, axis=0)
    across_faces = hull.offsets + farthest_along(hull.vertices, -hull.normals)
    return float(widths.max()) / min(float(widths.min()), float(across_faces.min()))


def _signed_volume(shape: DescribedShape) -> float:
    """Return the volume by the divergence theorem [m3]; means something only for a closed mesh."""
    corners = (shape.vertices - shape.vertices.mean(axis=0))[shape.faces]
    volume = (
        np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0
    )
    return float(volume)


def _scale_findings(link: Link, config: LintConfig) -> Iterator[Finding]:
    if not (link.visuals and link.collisions):
        return
    seen, touched = (
        diagonal(shape.corners for shape in shapes) for shapes in (link.visuals, link.collisions)
    )
    if not config.scale_share * seen <= touched <= seen / config.scale_share:
        smaller = touched < seen
        limit = config.scale_share if smaller else 1.0 / config.scale_share
        message = (
            f"collision geometry of link {link.name!r} is {touched:.3g} m across, "
            f"what is visible {seen:.3g} m: "
            f"want {'at least' if smaller else 'at most'} {limit:g} times that; are both in metres?"
        )
        ratio = significant(touched / seen, 4) if seen > 0.0 else None
        yield error("collision_scale", message, parts=(link.name,), value=ratio, limit=limit)


def _cover_findings(
    link: Link, hulls: list[CollisionHull], config: LintConfig
) -> tuple[list[Finding], dict[str, Any]]:
    """Return how far the visible and the touchable surface are apart, both ways."""
    generator = np.random.default_rng(0)
    visible = _sampled(link.visuals, DENSER * config.samples, generator)
    touchable = _sampled(link.collisions, config.samples, generator)
    if len(visible) == 0 or len(touchable) == 0:
        return [], {}

    low = visible.min(axis=0)
    high = visible.max(axis=0)
    across = float(np.linalg.norm(high - low))
    bare = distance_outside(visible[::DENSER], hulls)
    spacing = float(np.median(np.asarray(cKDTree(visible).query(visible, k=2)[0])[:, 1]))
    empty = np.maximum(0.0, np.asarray(cKDTree(visible).query(touchable)[0]) - spacing)
    uncovered, overhang = (float(np.quantile(values, QUANTILE)) for values in (bare, empty))
    shift = _shift(low, high, hulls)
    covered = 1.0 - float((bare > config.gap_m).mean())
    numbers = {
        "uncovered_mm": round(1000 * uncovered, 3),
        "overhang_mm": round(1000 * overhang, 3),
        "shift_mm": round(1000 * shift, 3),
        "covered": round(covered, 4),
    }
    most_shift = config.offset_share * across
    if shift > most_shift:
        words = f"lies {1000 * shift:.1f} mm beside what is visible"
        message = f"collision geometry of link {link.name!r} {words}"
        return [_apart(True, "collision_offset", message, link, shift, most_shift)], numbers

    findings = []
    if covered < config.least_covered:
        message = (
            f"link {link.name!r}: {1.0 - covered:.0%} of the visible surface lies more than "
            f"{1000 * config.gap_m:g} mm outside its collision geometry, where nothing is felt; "
            f"want {config.least_covered:.0%} covered"
        )
        share = round(covered, 4)
        limit = config.least_covered
        findings.append(
            error("collision_gap", message, parts=(link.name,), value=share, limit=limit)
        )
        uncovered = 0.0
    allowed = max(config.gap_m, config.gap_share * across)
    for gap, words in (
        (uncovered, "visible surface lies outside its collision geometry"),
        (overhang, "collision surface lies away from what is visible"),
    ):
        if gap > allowed:
            message = f"link {link.name!r}: {words} by up to {1000 * gap:.1f} mm"
            findings.append(_apart(False, "collision_gap", message, link, gap, allowed))
    return findings, numbers


def _apart(grave: bool, code: str, message: str, link: Link, gap: float, most: float) -> Finding:
    """Return the finding that surfaces of a link are too far apart [m]."""
    value, limit = (round(1000 * length, 3) for length in (gap, most))
    return graded(grave, code, message, parts=(link.name,), value=value, unit="mm", limit=limit)


def _shift(low: FloatArray, high: FloatArray, hulls: list[CollisionHull]) -> float:
    """Return how far the box of hulls is shifted against the visible box [m].

    Both ends of an axis must be moved the same way.
    """
    points = np.vstack([hull.vertices for hull in hulls])
    below = points.min(axis=0) - low
    above = points.max(axis=0) - high
    moved = np.where(below * above > 0.0, np.minimum(np.abs(below), np.abs(above)), 0.0)
    return float(np.linalg.norm(moved))


def _sampled(
    shapes: tuple[DescribedShape, ...], count: int, generator: np.random.Generator
) -> FloatArray:
    """Return points spread over the surfaces by area [m], shape [count, 3]; none without area."""
    corners = np.vstack([shape.vertices[shape.faces] for shape in shapes])
    areas = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    total = areas.sum()
    if not total > 0.0:
        return np.zeros((0, 3))
    chosen = generator.choice(len(areas), size=count, p=areas / total)
    u, v = generator.random((2, count))
    fold = u + v > 1.0
    u[fold] = 1.0 - u[fold]
    v[fold] = 1.0 - v[fold]
    a = corners[chosen, 0]
    b = corners[chosen, 1]
    c = corners[chosen, 2]
    points: FloatArray = a + u[:, None] * (b - a) + v[:, None] * (c - a)
    return points
