"""What an asset is, as data: ``asset.json``."""

from __future__ import annotations

import json
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np
import numpy.typing as npt

from ..articulation import Joint
from ..asset import Hull, Target
from ..intake.intake import Provenance
from ..manufacture.targets.standing import standing_place
from ..runtime.layout import MJCF, URDF
from ..runtime.numbers import magnitude, rounded
from .links import Layout
from .resistance import Resistance

#: Raised when the meaning of a field changes.
SCHEMA = 1
#: Everything whose version can change an exported number.
TOOLS = ("asset-factory", "coacd", "manifold3d", "numpy", "pillow", "scipy", "trimesh", "vhacdx")


def manifest_data(layout: Layout, provenance: Provenance) -> dict[str, Any]:
    """JSON data in a fixed order; m, kg, rad, object frame unless a field says otherwise."""
    asset = layout.asset
    articulation = asset.articulation
    rest, closed = (
        _bounds(layout, {}),
        _bounds(layout, {j.name: j.lower for j in articulation.joints}),
    )
    return {
        "schema": SCHEMA,
        "name": asset.name,
        "category": provenance.category,
        "license": provenance.license,
        "urdf": URDF,
        "mjcf": MJCF,
        "articulator": articulation.articulator,
        "scale": 1.0,
        "fixed_base": True,
        "mass": magnitude(asset.mass),
        "bounds": _rows(rest),
        "closed_bounds": _rows(closed),
        "ground_offset": rounded(-min(rest[0, 2], closed[0, 2])),
        "hulls": asset.hull_count,
        "joints": [
            _joint(layout, joint, resistance)
            for joint, resistance in zip(articulation.joints, layout.resistances, strict=True)
        ],
        "links": [_link(layout, part) for part in range(len(layout.links))],
        "targets": [_target(layout, target) for target in asset.targets],
        "excluded_pairs": [list(pair) for pair in layout.excluded_pairs],
        "provenance": {
            **_provenance(provenance),
            "weights": [asdict(weights) for weights in articulation.weights],
        },
        "tools": tool_versions(),
        "notes": [*provenance.notes, *articulation.notes, *layout.notes],
    }


def manifest_text(data: dict[str, Any]) -> str:
    """The file's text."""
    return json.dumps(data, indent=2, allow_nan=False) + "\n"


def tool_versions() -> dict[str, str | None]:
    """Installed versions of what made the asset; ``None`` for what is not installed."""
    versions: dict[str, str | None] = {}
    for tool in TOOLS:
        try:
            versions[tool] = version(tool)
        except PackageNotFoundError:
            versions[tool] = None
    return versions


def hull_aspect(hull: Hull) -> float:
    """Longest over shortest side of a hull's principal box; GPU PhysX refuses oblong hulls."""
    centered = hull.vertices - hull.vertices.mean(axis=0)
    _, _, axes = np.linalg.svd(centered, full_matrices=False)
    sides = np.ptp(centered @ axes.T, axis=0)
    return float(sides.max() / max(float(sides.min()), 1e-12))


def _joint(layout: Layout, joint: Joint, resistance: Resistance) -> dict[str, Any]:
    body = layout.asset.bodies[joint.child]
    origin = layout.asset.articulation.link_frame(joint.child)
    handle = body.handle
    return {
        "name": joint.name,
        "kind": str(joint.kind),
        "parent": layout.links[joint.parent].name,
        "child": layout.links[joint.child].name,
        "axis": _row(joint.axis),
        "origin": _row(joint.origin),
        "lower": rounded(joint.lower),
        "upper": rounded(joint.upper),
        "unit": joint.unit,
        "confidence": None if joint.confidence is None else rounded(joint.confidence, 4),
        "inertia": magnitude(resistance.inertia),
        "damping": magnitude(resistance.damping),
        "friction": magnitude(resistance.friction),
        "default_damping": joint.movable and joint.damping is None,
        "default_friction": joint.movable and joint.friction is None,
        "handle": None
        if handle is None
        else {
            "frame": layout.links[joint.child].name,
            "point": _row(handle.point - origin),
            "normal": _row(handle.normal),
            "pull": _row(handle.pull),
            "source": handle.source,
        },
        "placement": _placement(layout, joint),
    }


def _target(layout: Layout, target: Target) -> dict[str, Any]:
    """A way to open a joint; point and directions in the frame of the link ``part``."""
    origin = layout.asset.articulation.link_frame(target.part)
    return {
        "joint": target.joint,
        "part": layout.links[target.part].name,
        "kind": target.kind,
        "point": _row(target.point - origin),
        "normal": _row(target.normal),
        "pull": _row(target.pull),
        "fingers": _row(target.fingers),
        "opening_m": rounded(target.opening),
        "score": rounded(target.score, 4),
    }


def _placement(layout: Layout, joint: Joint) -> dict[str, Any] | None:
    """Where a robot's base may stand to open the joint at its best target.

    ``x``, ``y`` [m] and ``yaw`` [rad], object frame.
    """
    target = next((target for target in layout.asset.targets if target.joint == joint.name), None)
    place = None if target is None else standing_place(layout.asset, joint, target)
    if place is None:
        return None
    return {"position": [rounded(value) for value in place.position], "yaw": rounded(place.yaw)}


def _link(layout: Layout, part: int) -> dict[str, Any]:
    body, files = layout.asset.bodies[part], layout.links[part]
    confidence = layout.asset.articulation.parts[part].confidence
    return {
        "name": files.name,
        "confidence": None if confidence is None else rounded(confidence, 4),
        "mass": magnitude(body.inertial.mass),
        "hulls": len(body.hulls),
        "max_hull_vertices": max((len(hull.vertices) for hull in body.hulls), default=0),
        "max_hull_aspect": rounded(max((hull_aspect(hull) for hull in body.hulls), default=0.0), 3),
        "visuals": len(files.visuals),
        "decomposition": body.decomposition,
        "degraded": list(body.degraded),
    }


def _provenance(provenance: Provenance) -> dict[str, Any]:
    return {
        "input": provenance.input,
        "digest": provenance.digest,
        "up": provenance.up,
        "up_source": provenance.up_source,
        "scale": magnitude(provenance.scale),
        "scale_source": provenance.scale_source,
        "density": provenance.density,
        "dropped_degenerate": provenance.dropped_degenerate,
        "dropped_non_finite": provenance.dropped_non_finite,
    }


def _bounds(layout: Layout, values: dict[str, float]) -> npt.NDArray[np.float64]:
    """Lower and upper corner of everything visible for given joint values, shape [2, 3]."""
    articulation = layout.asset.articulation
    poses = articulation.poses(values)
    corners = []
    for part, pose in zip(articulation.parts, poses, strict=True):
        vertices = articulation.mesh.vertices[np.unique(articulation.mesh.faces[part.faces])]
        corners.append(vertices @ pose[:3, :3].T + pose[:3, 3])
    cloud = np.concatenate(corners)
    cloud = cloud if len(cloud) else np.zeros((1, 3))
    return np.stack([cloud.min(axis=0), cloud.max(axis=0)])


def _row(values: npt.NDArray[np.float64]) -> list[float]:
    return [rounded(value) for value in values.tolist()]


def _rows(values: npt.NDArray[np.float64]) -> list[list[float]]:
    return [_row(row) for row in values]
