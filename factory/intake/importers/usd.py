"""A USD asset with physics joints as an intake, at its authored pose.

The schema: https://openusd.org/release/api/usd_physics_page_front.html.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np

from asset_factory.sim_checks.processes.isolation import WarmChild
from asset_factory.sim_checks.read.usd.refusing import LIMITS, ask_of

from ...config import IntakeConfig
from ...errors import InputRejected
from ...mesh import FloatArray, IntArray, Mesh, concatenate
from ...runtime.store import digest_bytes
from ..annotation import Annotation
from ..files import InputFiles
from ..intake import Intake, Provenance
from ..licenses import require_allowed
from ..limits import require_at_most, require_sensible_size
from ..naming import safe_name, well_formed
from ..orientation import rotation_to_z_up
from ..reads import digest_read
from ..sidecar import read_sidecar
from ..sizes import guess_category, normalised
from .usd_layers import rejecting, require_own_layers
from .usd_stage import UsdStage, read_stage
from .usd_tree import annotation_of


def load_usd(path: Path, config: IntakeConfig) -> Intake:
    """Return an articulated USD asset as an input; a stage states its own units and up axis.

    Args:
        path: of the root layer; everything that it is composed of lies in or below its folder.
        config: limits.

    Raises:
        InputRejected: ``unsupported``: the library that reads USD is not installed;
            ``external_reference``, ``missing_file``, ``too_large``, ``unreadable``, ``empty``,
            ``not_a_tree``, ``unsupported_joint``, ``bad_sidecar``, ``license_disallowed``.
        TimeoutError, ChildProcessError: what reads it hung or was killed, which is no verdict.
    """
    if importlib.util.find_spec("pxr") is None:
        raise InputRejected(
            "unsupported", f"{path.name}: reading USD needs usd-core: pip install usd-core"
        )
    files = InputFiles(path.parent, config)
    sidecar = read_sidecar(path, files)
    with WarmChild() as child, rejecting(path):
        layers = ask_of(
            child, path.name, require_own_layers, path, path.parent, config.max_bytes, limits=LIMITS
        )
        digests = [digest_read(layer) for layer in layers]
        digest = digest_bytes("\n".join([*digests, *files.digests]).encode())
        require_allowed(path.name, sidecar.license, config.allowed_licenses, digest)
        stage = ask_of(child, path.name, read_stage, path, config.max_faces, limits=LIMITS)
    mesh, annotation, transform = _annotated(stage, path.name, config.max_faces)
    require_sensible_size(path.name, mesh.bounds)
    return _intake(path, mesh, annotation, transform, digest, sidecar.license)


def read_annotated(path: Path, max_faces: int) -> tuple[Mesh, Annotation, FloatArray]:
    """All surfaces of a stage as one mesh, its parts and joints, and how it was turned and scaled.

    Args:
        path: of the root layer; see :func:`.usd_layers.require_own_layers` for what to ask before.
        max_faces: most triangles.

    Returns:
        The mesh in metres, z up; parts and joints in the stage's frame and units; the transform
        from there, shape [4, 4].

    Raises:
        InputRejected: ``unreadable``, ``empty``, ``too_large``, ``not_a_tree``,
            ``unsupported_joint``.
    """
    return _annotated(read_stage(path, max_faces), path.name, max_faces)


def _annotated(stage: UsdStage, name: str, max_faces: int) -> tuple[Mesh, Annotation, FloatArray]:
    if not stage.pieces:
        raise InputRejected("empty", f"{name}: holds no surface that is shown")
    whole = concatenate([mesh for _, mesh in stage.pieces])
    require_at_most(name, len(whole.faces), max_faces, "faces")
    transform = np.eye(4)
    transform[:3, :3] = stage.metres * rotation_to_z_up(stage.up)
    return whole.transformed(transform), annotation_of(stage, name), transform


def _intake(
    path: Path,
    mesh: Mesh,
    annotation: Annotation,
    transform: FloatArray,
    digest: str,
    license: str | None,
) -> Intake:
    category = guess_category(path.stem, path.parent.name)
    faces: IntArray = np.arange(len(mesh.faces))
    provenance = Provenance(
        input=well_formed(path.name),
        digest=digest,
        category=normalised(category) if category else None,
        up="z",
        up_source="format",
        scale=float(np.cbrt(np.linalg.det(transform[:3, :3]))),
        scale_source="format",
        license=license,
    )
    return Intake(safe_name(path), mesh, faces, transform, provenance, annotation)
