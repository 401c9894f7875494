"""Are the collision shapes what engines can take, and do they lie where the visible surface is?"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from ..config import LintConfig
from ..description import DescribedShape, FloatArray, Link
from ..geometry.hull import CollisionHull, FlatHull, convex_hull, distance_outside, farthest_along
from ..geometry.placing import diagonal
from ..geometry.surfaces import VisibleSurface
from ..report import Finding
from .lint_interior import interior_findings
from .result import Concerned, Findings, error, graded, in_mm, measured, significant, warning

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
        doubtful += _hull_findings(link, shape, hull, config)
    findings += _worst_of_each_code(doubtful)
    count = len(link.collisions)
    meshes = (shape for shape in link.collisions if shape.kind == "mesh")
    numbers: dict[str, Any] = {
        "collision_shapes": count,
        "visual_shapes": len(link.visuals),
        "collision_meshes": [
            {"file": mesh.file, "vertices": len(mesh.vertices), "faces": len(mesh.faces)}
            for mesh in meshes
        ],
    }
    if count > (most := config.hulls_per_link):
        message = f"link {link.name!r} has {count} collision shapes; GPU simulation allows {most}"
        told = measured(float(count), limit=float(most))
        findings.append(warning("many_hulls", message, parts=(link.name,), **told))
    findings += _scale_findings(link, config)
    if hulls and link.visuals:
        found, distances = _cover_findings(link, hulls, config)
        findings += found
        numbers |= distances
    filled, kept = interior_findings(link, hulls, down, config)
    return findings + filled, {**numbers, **kept}


def _worst_of_each_code(findings: list[Finding]) -> Findings:
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
) -> Findings:
    name = f"collision shape {shape.name!r} of link {link.name!r}"
    parts = (link.name,)
    if shape.kind == "mesh" and hull.corners > config.hull_vertices:
        grave = hull.corners > config.most_vertices
        most = config.most_vertices if grave else config.hull_vertices
        cooked = "each engine cooks it down to another; want at most"
        allowed = cooked if grave else "GPU simulation allows"
        message = f"{name} has a hull of {hull.corners} corners; {allowed} {most}"
        told = measured(float(hull.corners), limit=float(most))
        yield graded(grave, "many_hull_vertices", message, parts=parts, **told)
    aspect = _aspect(hull)
    if aspect > (limit := config.hull_aspect):
        longer = f"{name} is {aspect:.0f} times longer than thick"
        message = f"{longer}; GPU simulation takes up to {limit:g}"
        yield warning("oblong_hull", message, parts=parts, value=round(aspect, 3), limit=limit)
    if shape.kind == "mesh":
        volume = VisibleSurface(shape.vertices, shape.faces).volume
        limit = config.convexity
        if volume <= 0.0 or hull.volume > limit * volume:
            ratio = round(hull.volume / volume, 4) if volume > 0.0 else None
            message = f"{name} is open, flat or inside out: engines take its hull"
            if ratio is not None and ratio <= 1e3:
                larger = f"{ratio:.3g} times its own volume"
                message = f"{name} is not convex: engines take its hull, {larger}"
            yield warning("nonconvex_collision", message, parts=parts, value=ratio, limit=limit)


def _aspect(hull: CollisionHull) -> float:
    """Return the longest over shortest width, along the hull's own principal directions."""
    centered = hull.vertices - hull.vertices.mean(axis=0)
    _, _, directions = np.linalg.svd(centered, full_matrices=False)
    widths = np.ptp(centered @ directions.T, axis=0)
    across_faces = hull.offsets + farthest_along(hull.vertices, -hull.normals)
    return float(widths.max()) / min(float(widths.min()), float(across_faces.min()))


def _scale_findings(link: Link, config: LintConfig) -> Findings:
    if not (link.visuals and link.collisions):
        return
    seen = diagonal(shape.corners for shape in link.visuals)
    touched = diagonal(shape.corners for shape in link.collisions)
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
    near = cKDTree(visible)
    spacing = float(np.median(np.asarray(near.query(visible, k=2)[0])[:, 1]))
    empty = np.maximum(0.0, np.asarray(near.query(touchable)[0]) - spacing)
    uncovered, overhang = (float(np.quantile(values, QUANTILE)) for values in (bare, empty))
    shift = _shift(low, high, hulls)
    covered = 1.0 - float((bare > config.gap_m).mean())
    numbers = {
        "uncovered_mm": round(1000 * uncovered, 3),
        "overhang_mm": round(1000 * overhang, 3),
        "shift_mm": round(1000 * shift, 3),
        "covered": round(covered, 4),
    }
    subject: Concerned = {"parts": (link.name,)}
    most_shift = config.offset_share * across
    if shift > most_shift:
        words = f"lies {1000 * shift:.1f} mm beside what is visible"
        message = f"collision geometry of link {link.name!r} {words}"
        beside = error("collision_offset", message, **subject, **in_mm(shift, most_shift, 3))
        return [beside], numbers

    findings = []
    if covered < config.least_covered:
        message = (
            f"link {link.name!r}: {1.0 - covered:.0%} of the visible surface lies more than "
            f"{1000 * config.gap_m:g} mm outside its collision geometry, where nothing is felt; "
            f"want {config.least_covered:.0%} covered"
        )
        told = measured(round(covered, 4), limit=config.least_covered)
        findings.append(error("collision_gap", message, **subject, **told))
        uncovered = 0.0
    allowed = max(config.gap_m, config.gap_share * across)
    for gap, words in (
        (uncovered, "visible surface lies outside its collision geometry"),
        (overhang, "collision surface lies away from what is visible"),
    ):
        if gap > allowed:
            message = f"link {link.name!r}: {words} by up to {1000 * gap:.1f} mm"
            findings.append(warning("collision_gap", message, **subject, **in_mm(gap, allowed, 3)))
    return findings, numbers


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
    areas = np.concatenate([VisibleSurface(s.vertices, s.faces).areas for s in shapes])
    total = areas.sum()
    if not total > 0.0:
        return np.zeros((0, 3))
    chosen = generator.choice(len(areas), size=count, p=areas / total)
    u, v = generator.random((2, count))
    fold = u + v > 1.0
    u[fold] = 1.0 - u[fold]
    v[fold] = 1.0 - v[fold]
    a, b, c = (corners[chosen, k] for k in range(3))
    points: FloatArray = a + u[:, None] * (b - a) + v[:, None] * (c - a)
    return points
