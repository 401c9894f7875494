"""A USD asset with physics joints as an intake, at its authored pose.

The schema: https://openusd.org/release/api/usd_physics_page_front.html.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from asset_factory.sim_checks.processes.isolation import WarmChild
from asset_factory.sim_checks.read.native import ask_of
from asset_factory.sim_checks.read.usd.layers import require_inside
from asset_factory.sim_checks.read.usd.shapes import PhysicsSurface
from asset_factory.sim_checks.read.usd.stage import PhysicsStage, read_stage, require_library

from ...config import IntakeConfig
from ...errors import InputRejected
from ...geometry.clean import clean
from ...geometry.soup import plain_soup
from ...mesh import FloatArray, IntArray, Mesh, concatenate
from ...runtime.store import digest_bytes
from ..annotation import Annotation
from ..categories import category_of
from ..files import InputFiles
from ..intake import Intake, Provenance
from ..licenses import require_allowed
from ..limits import require_at_most, require_sensible_size
from ..naming import safe_name, well_formed
from ..orientation import rotation_to_z_up
from ..reads import ReadLog
from ..rejecting import rejecting
from ..sidecar import read_sidecar
from .usd_tree import annotation_of

_COLLIDER_WORDS = frozenset({"collision", "collider", "collisions", "colliders"})


def load_usd(path: Path, config: IntakeConfig, log: ReadLog | None = None) -> Intake:
    """Return an articulated USD asset as an input; a stage states its own units and up axis.

    ``path`` is the root layer's; everything that it is composed of lies in or below its folder.

    Raises:
        InputRejected: ``unsupported``: the library that reads USD is not installed;
            ``external_reference``, ``missing_file``, ``too_large``, ``unreadable``, ``empty``,
            ``not_a_tree``, ``unsupported_joint``, ``bad_sidecar``, ``license_disallowed``.
        TimeoutError, ChildProcessError: what reads it hung or was killed, which is no verdict.
    """
    files = InputFiles(path.parent, config, log)
    with WarmChild() as child, rejecting(path.name, path.parent, files.log):
        require_library(path.name)
        sidecar = read_sidecar(path, files)
        layers = ask_of(child, path.name, require_inside, path, path.parent, config.max_bytes)
        digests = [files.log.digest(layer) for layer in layers]
        digest = digest_bytes("\n".join([*digests, *files.digests]).encode())
        require_allowed(path.name, sidecar.license, config.allowed_licenses, digest)
        stage = ask_of(child, path.name, _read_leniently, path)
    mesh, annotation, transform = _annotated(stage, path.name, config.max_faces)
    require_sensible_size(path.name, mesh.bounds)
    provenance = Provenance(
        input=well_formed(path.name),
        digest=digest,
        category=category_of(path, None),
        up="z",
        up_source="format",
        scale=float(np.cbrt(np.linalg.det(transform[:3, :3]))),
        scale_source="format",
        license=sidecar.license,
    )
    faces: IntArray = np.arange(len(mesh.faces))
    return Intake(safe_name(path), mesh, faces, transform, provenance, annotation)


def read_annotated(
    main: Path, folder: Path, max_bytes: int, max_faces: int
) -> tuple[Mesh, Annotation, FloatArray]:
    """Return all surfaces of a stage as one mesh, its parts and joints, and how it was turned.

    Args:
        main: the layer to begin with.
        folder: everything lies in or below it, symbolic links followed.
        max_bytes: of all layers' files together [bytes].
        max_faces: of all surfaces together.

    Returns:
        The mesh in metres, z up; parts and joints in the stage's frame and units; the transform
        from there, shape [4, 4].

    Raises:
        InputRejected: ``external_reference``, ``missing_file``, ``unreadable``, ``unsupported``
            (value clips and computed references, whose files cannot be known beforehand),
            ``too_large``, ``empty``, ``not_a_tree``, ``unsupported_joint``.
    """
    with rejecting(main.name, folder):
        require_inside(main, folder, max_bytes)
        return _annotated(_read_leniently(main), main.name, max_faces)


def _read_leniently(path: Path) -> PhysicsStage:
    return read_stage(path, lenient=True)


def _annotated(
    stage: PhysicsStage, name: str, max_faces: int
) -> tuple[Mesh, Annotation, FloatArray]:
    pieces = _pieces(stage, name, max_faces)
    if not pieces:
        raise InputRejected("empty", f"{name}: holds no surface that is shown")
    transform = np.eye(4)
    transform[:3, :3] = stage.metres * rotation_to_z_up(stage.up)
    annotation = annotation_of(stage, pieces, transform, name)
    return concatenate([mesh for _, mesh in pieces]), annotation, transform


def _pieces(stage: PhysicsStage, name: str, max_faces: int) -> list[tuple[str, Mesh]]:
    """Return body and shown surface [m], z up; of a body that has others, not its colliders."""
    found: list[tuple[str, bool, Mesh]] = []
    faces = 0
    for surface in stage.surfaces:
        pose = stage.bodies[surface.body].pose
        vertices = surface.vertices @ pose[:3, :3].T + pose[:3, 3]
        try:
            mesh = clean(plain_soup(vertices[surface.faces]), surface.name).mesh
        except InputRejected as error:
            if error.code in ("empty", "zero_size"):
                continue
            raise
        faces += len(mesh.faces)
        require_at_most(name, faces, max_faces, "faces")
        found.append((surface.body, _is_collider(surface), mesh))
    seen = {body for body, collider, _ in found if not collider}
    return [(body, mesh) for body, collider, mesh in found if not collider or body not in seen]


def _is_collider(surface: PhysicsSurface) -> bool:
    """Return whether a surface lies in a group called after collisions, or is called so itself."""
    words = surface.path.lower().replace("/", "_").split("_")
    return not _COLLIDER_WORDS.isdisjoint(words)
