"""Objects read from files with their joints; cached, because the slowest take seconds."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from asset_factory.factory.articulate.catalog import choose
from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part
from asset_factory.factory.config import BuildConfig, IntakeConfig
from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.intake.load import load
from asset_factory.factory.mesh import Mesh
from asset_factory.factory.runtime.code import code_digest
from asset_factory.factory.runtime.store import Store, stage_key


def imported(path: Path, digest: str, store: Store | None) -> Articulation:
    """Return the articulation described by a URDF, an MJCF or an annotated mesh, without its looks.

    Args:
        path: of the description or the mesh.
        digest: of that file, under which the articulation is kept.
        store: where; ``None`` reads the files every time.

    Raises:
        InputRejected: it cannot be read, is no tree, or comes without joints.
    """
    key = stage_key("evaluation-case", code_digest(__name__), path.parent.name, digest)
    found = None if store is None else store.load(key)
    if found is not None:
        return _restored(found)
    intake = load(path, IntakeConfig())
    arrays = _arrays(choose(intake, BuildConfig(articulator="annotated")).articulate(intake.mesh))
    if store is not None:
        store.save(key, arrays)
    return _restored(arrays)


def _arrays(articulation: Articulation) -> dict[str, npt.NDArray[Any]]:
    joints = [
        {
            **asdict(joint),
            "kind": str(joint.kind),
            "axis": joint.axis.tolist(),
            "origin": joint.origin.tolist(),
        }
        for joint in articulation.joints
    ]
    names = [part.name for part in articulation.parts]
    text = json.dumps({"parts": names, "joints": joints, "notes": list(articulation.notes)})
    return {
        "vertices": articulation.mesh.vertices,
        "faces": articulation.mesh.faces.astype(np.int32),
        "face_parts": face_parts(articulation).astype(np.int16),
        "rest": np.frombuffer(text.encode(), dtype=np.uint8),
    }


def _restored(arrays: dict[str, npt.NDArray[Any]]) -> Articulation:
    rest = json.loads(arrays["rest"].tobytes().decode())
    owner = arrays["face_parts"]
    parts = tuple(Part(name, np.flatnonzero(owner == i)) for i, name in enumerate(rest["parts"]))
    joints = tuple(
        Joint(
            **{
                **j,
                "kind": JointKind(j["kind"]),
                "axis": np.array(j["axis"]),
                "origin": np.array(j["origin"]),
            }
        )
        for j in rest["joints"]
    )
    mesh = Mesh.from_triangles(arrays["vertices"], arrays["faces"])
    return Articulation(mesh, parts, joints, "annotated", tuple(rest["notes"]))
