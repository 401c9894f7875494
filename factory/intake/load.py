"""Input file -> Intake: a plain mesh, or a description whose parts and joints come with it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from asset_factory.sim_checks.description import DescriptionError
from asset_factory.sim_checks.read.gather import gather
from asset_factory.sim_checks.read.roots import ReadOptions, Roots
from asset_factory.sim_checks.read.usd.layers import SUFFIXES as USD_SUFFIXES
from asset_factory.sim_checks.read.usd.layers import is_usd
from asset_factory.sim_checks.read.xacro import SUFFIX as XACRO

from ..config import IntakeConfig
from ..errors import InputRejected
from ..geometry.triangles import face_areas
from ..mesh import FloatArray, IntArray, Mesh
from ..runtime.keys import Stage
from ..runtime.store import digest_bytes
from .categories import category_of
from .files import InputFiles
from .importers.imported import Imported
from .importers.mjcf import import_mjcf
from .importers.urdf import import_urdf
from .importers.usd import import_usd
from .importers.xml_source import read_xml
from .intake import Intake, Provenance
from .licenses import require_allowed
from .limits import require_sensible_size
from .loading import load_mesh
from .naming import safe_name, well_formed
from .orientation import rotation_to_z_up
from .reads import ReadLog, content_digest
from .rejecting import rejecting
from .sidecar import Sidecar, read_sidecar
from .sizes import Scale, check_config, given_scale, given_up, scale_by_size

LOAD = Stage(
    "load",
    code=(__name__,),
    settings=("intake",),
    libraries=("numpy", "scipy", "trimesh", "manifold3d", "pillow", "mujoco", "xacro"),
    data=("categories.toml",),
)
DESCRIPTION_SUFFIXES = frozenset({".urdf", ".xml", XACRO}) | USD_SUFFIXES


def load(path: Path, config: IntakeConfig, log: ReadLog | None = None) -> Intake:
    """Load a mesh file, a URDF, also as xacro, an MJCF or a USD layer.

    ``log`` of the files that are read is filled also where it raises.

    Raises:
        InputRejected: with a reason code.
    """
    if path.suffix.lower() in DESCRIPTION_SUFFIXES:
        return load_description(path, config, log)
    return load_mesh(path, config, log)


def load_description(path: Path, config: IntakeConfig, log: ReadLog | None = None) -> Intake:
    """Return an articulated object as an input: its visual geometry with every joint at zero.

    Zero is the joint value 0 of a URDF, ``qpos0`` of an MJCF and the authored pose of a USD stage.
    The annotation speaks of the file's own frame and units: of a URDF and an MJCF metres and z up
    by both specifications, of a stage those that it states. ``transform`` leads from there to the
    object frame, which else differs only where an option or a sidecar says so.

    What the file refers to lies in its folder, its package or a root.

    Returns:
        An intake whose ``annotation`` is set; ``source_faces`` counts the faces of the
        description's shapes in the order of the file.

    Raises:
        InputRejected: ``unreadable``, ``unsupported``, ``missing_file``, ``external_reference``,
            ``too_large``, ``empty``, ``zero_size``, ``absurd_size``, ``not_a_tree``,
            ``unsupported_joint``, ``bad_sidecar``, ``license_disallowed``. ``unsupported``, too:
            the library that reads USD is not installed.
        TimeoutError, ChildProcessError: what reads it hung or was killed, which is no verdict.
        ConfigError: ``config.up`` or ``config.height`` cannot be.
    """
    check_config(config)
    files = InputFiles(path.parent, config, log)
    sidecar = read_sidecar(path, files)
    imported = _imported(path, config, files.log)
    digest = digest_bytes("\n".join([*imported.digests, *files.digests]).encode())
    license = _allowed_license(path.name, sidecar, imported, config, digest)
    whole, kept = _joined(imported, path.name)
    up, up_source = given_up(config, sidecar) or ("z", "format")
    rotation = rotation_to_z_up(up)
    extents = np.ptp(whole.vertices[np.unique(whole.faces[kept])] @ rotation.T, axis=0)
    scale = given_scale(extents, config, sidecar, path.name) or Scale(1.0, "format")
    corners = np.stack([whole.vertices.min(axis=0), whole.vertices.max(axis=0)])
    require_sensible_size(path.name, corners * scale.factor)
    category = category_of(path, sidecar.category)
    transform = np.eye(4)
    transform[:3, :3] = scale.factor * rotation
    return Intake(
        name=safe_name(path),
        mesh=whole.submesh(kept).transformed(transform),
        source_faces=kept,
        transform=transform @ imported.frame,
        provenance=Provenance(
            input=well_formed(path.name),
            digest=digest,
            category=category,
            up=up,
            up_source=up_source,
            scale=scale.factor * float(np.cbrt(np.linalg.det(imported.frame[:3, :3]))),
            scale_source=scale.source,
            density=sidecar.density,
            license=license,
            dropped_degenerate=imported.dropped_degenerate + len(whole.faces) - len(kept),
            dropped_non_finite=imported.dropped_non_finite,
            notes=(*imported.notes, *_doubts(extents * scale.factor, category)),
        ),
        annotation=imported.annotation,
    )


def _imported(path: Path, config: IntakeConfig, log: ReadLog) -> Imported:
    """Read a description; of a URDF or MJCF a copy beside all that it refers to, if need be."""
    if is_usd(path):
        return import_usd(path, config, log)
    roots = tuple(map(Path, (*config.roots, *config.given)))
    options = ReadOptions(roots, config.allow_outside, config.arguments)
    with TemporaryDirectory() as folder:
        with rejecting(path.name, path.parent, log):
            try:
                gathered = gather(path, Path(folder), options)
            except DescriptionError:
                _note(Roots(path, options).looked, log)
                raise
        if gathered.path == path:
            return _imported_from(path, config, log)
        _note((path, *gathered.files, *Roots(path, options).looked), log)
        imported = _imported_from(gathered.path, config, ReadLog())
    told = (finding.message for finding in gathered.findings)
    return replace(imported, notes=(*told, *imported.notes))


def _note(places: Iterable[Path], log: ReadLog) -> None:
    for place in places:
        log.note(place, content_digest(place))


def _imported_from(path: Path, config: IntakeConfig, log: ReadLog) -> Imported:
    root = read_xml(path, config.max_bytes, log)
    with rejecting(path.name, path.parent, log), np.errstate(all="ignore"):
        if root.tag == "robot":
            return import_urdf(root, path, config, log)
        if root.tag == "mujoco":
            return import_mjcf(root, path, config, log)
    begins = f"{path.name}: begins with <{root.tag[:80]}>, want <robot> or <mujoco>"
    raise InputRejected("unreadable", begins)


def _allowed_license(
    name: str, sidecar: Sidecar, imported: Imported, config: IntakeConfig, digest: str
) -> str | None:
    """Return the license of the whole; if none is stated, those of its files, each allowed."""
    licenses = (sidecar.license,) if sidecar.license else imported.licenses
    for license in licenses or (None,):
        require_allowed(name, license, config.allowed_licenses, digest)
    return "; ".join(licenses) or None


def _joined(imported: Imported, name: str) -> tuple[Mesh, IntArray]:
    """Return all pieces as one mesh, and which of its faces have an area."""
    if not imported.pieces:
        raise InputRejected("empty", f"{name}: no link has any geometry")
    whole = imported.mesh
    kept = np.flatnonzero(face_areas(whole) > 0.0)
    if not len(kept):
        raise InputRejected("empty", f"{name}: no face of its geometry has any area")
    return whole, kept


def _doubts(extents: FloatArray, category: str | None) -> list[str]:
    """Return a note where the size is not plausible; a description is believed all the same."""
    if scale_by_size(extents, category).factor == 1.0:
        return []
    size = " x ".join(f"{extent:.3g}" for extent in extents)
    thing = (category or "object").replace("_", " ")
    odd = f"odd for this kind of thing ({thing}); give a height."
    return [f"The description says metres, so {size} m was kept, {odd}"]
