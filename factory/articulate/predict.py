"""One input's articulation alone, without making anything of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..articulation import Joint, Part
from ..config import BuildConfig
from ..errors import InputRejected
from ..intake.source import Source
from ..mesh import Mesh
from ..runtime.numbers import rounded
from ..runtime.stages import Stages
from .standing import standing_hypotheses


def predict(source: Path, config: BuildConfig) -> dict[str, Any]:
    """Return the moving parts of one input, as JSON data: metres, radians, object frame (z up).

    Lengths and angles are rounded to a nanometre.

    Args:
        source: a mesh, URDF or MJCF file.
        config: how to load it, and which articulator to ask.

    Returns:
        Parts and joints in tree order, with what intake noted of it; or, for an input that cannot
        be used or on which nothing moves, ``rejected`` with its reason.
    """
    origin = Source(source, config)
    try:
        intake, (likeliest, *_) = standing_hypotheses(origin.load(), origin, Stages(config))
    except InputRejected as rejection:
        told_of = ("code", "message", "value", "unit", "limit")
        reason = {name: getattr(rejection.finding, name) for name in told_of}
        return {"input": source.name, "rejected": reason}
    names = [part.name for part in likeliest.parts]
    return {
        "input": source.name,
        "articulator": likeliest.articulator,
        "weights": [
            {"file": w.file, "digest": w.digest, "license": w.license} for w in likeliest.weights
        ],
        "parts": [_part(part, likeliest.mesh) for part in likeliest.parts],
        "joints": [_joint(joint, names) for joint in likeliest.joints],
        "notes": [*intake.provenance.notes, *likeliest.notes],
    }


def _part(part: Part, mesh: Mesh) -> dict[str, Any]:
    corners = mesh.vertices[mesh.faces[part.faces]].reshape(-1, 3)
    bounds = None
    if len(corners):
        bounds = [_row(corner) for corner in (corners.min(axis=0), corners.max(axis=0))]
    return {
        "name": part.name,
        "faces": len(part.faces),
        "bounds": bounds,
        "confidence": _share(part.confidence),
    }


def _joint(joint: Joint, names: list[str]) -> dict[str, Any]:
    return {
        "name": joint.name,
        "type": str(joint.kind),
        "parent": names[joint.parent],
        "child": names[joint.child],
        "axis": _row(joint.axis),
        "origin": _row(joint.origin),
        "lower": rounded(joint.lower),
        "upper": rounded(joint.upper),
        "unit": joint.unit,
        "confidence": _share(joint.confidence),
    }


def _row(vector: np.ndarray[Any, np.dtype[np.float64]]) -> list[float]:
    return [rounded(value) for value in vector.tolist()]


def _share(value: float | None) -> float | None:
    return None if value is None else rounded(value, 4)
