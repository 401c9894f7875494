"""A USD asset with physics joints as an intake, at its authored pose.

The schema: https://openusd.org/release/api/usd_physics_page_front.html.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np

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
from .usd_layers import require_own_layers
from .usd_stage import read_stage
from .usd_tree import annotation_of


def load_usd(path: Path, config: IntakeConfig) -> Intake:
    """An articulated USD asset as an input; a stage states its own units and up axis.

    Args:
        path: of the root layer; everything that it is composed of lies in or below its folder.
        config: limits.

    Raises:
        InputRejected: ``unsupported``: the library that reads USD is not installed;
            ``external_reference``, ``missing_file``, ``too_large``, ``unreadable``, ``empty``,
            ``not_a_tree``, ``unsupported_joint``, ``bad_sidecar``, ``license_disallowed``.
    """
    if importlib.util.find_spec("pxr") is None:
        raise InputRejected(
            "unsupported", f"{path.name}: reading USD needs usd-core: pip install usd-core"
        )
    files = InputFiles(path.parent, config)
    sidecar = read_sidecar(path, files)
    layers = require_own_layers(path, path.parent, config.max_bytes)
    digests = [digest_read(layer) for layer in layers]
    digest = digest_bytes("\n".join([*digests, *files.digests]).encode())
    require_allowed(path.name, sidecar.license, config.allowed_licenses, digest)
    mesh, annotation, transform = read_annotated(path, config.max_faces)
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
    stage = read_stage(path, max_faces)
    if not stage.pieces:
        raise InputRejected("empty", f"{path.name}: holds no surface that is shown")
    whole = concatenate([mesh for _, mesh in stage.pieces])
    require_at_most(path.name, len(whole.faces), max_faces, "faces")
    transform = np.eye(4)
    transform[:3, :3] = stage.metres * rotation_to_z_up(stage.up)
    return whole.transformed(transform), annotation_of(stage, path.name), transform


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
