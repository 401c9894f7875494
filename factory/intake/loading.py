"""Any mesh file becomes an :class:`Intake` in metres, z up, or a rejection with a reason code."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from asset_factory.sim_checks.read.document import inside

from ..config import IntakeConfig
from ..errors import InputRejected
from ..geometry.clean import Cleaned, clean
from ..mesh import FloatArray
from .categories import category_of
from .files import InputFiles
from .formats.catalog import FORMATS, format_of
from .intake import Intake, Provenance
from .licenses import require_allowed
from .limits import require_sensible_size
from .naming import safe_name, well_formed
from .orientation import rotation_to_z_up
from .reads import ReadLog
from .rejecting import rejecting
from .sidecar import Sidecar, read_sidecar
from .sizes import check_config, given_scale, given_up, scale_by_size, scale_of_unit_cube
from .stated import read_stated

_MOST_NOTES = 32
_LONGEST_NOTE = 400


@dataclass(frozen=True)
class Visual(Cleaned):
    """One mesh file, cleaned, in its own frame and units, and the license that it states.

    ``digest`` is SHA-256 over the file and those that it refers to; ``notes`` say what was left
    out.
    """

    source_face_count: int
    digest: str
    license: str | None
    notes: tuple[str, ...]


def load_visual(path: Path, root: Path, limits: IntakeConfig, log: ReadLog | None = None) -> Visual:
    """Read one mesh file as it is: no up axis change, no scaling (COLLADA: to m by its unit).

    The file's own face order is: glTF by node, depth first, then primitive; everything else as in
    the file, polygons fanned.

    It is in one of ``FORMATS``, and nothing outside ``root`` is read; ``max_bytes``, ``max_faces``
    and ``max_texture_pixels`` of the limits are obeyed.

    Raises:
        InputRejected: ``unreadable``, ``unsupported``, ``empty``, ``too_large``, ``not_finite``,
            ``zero_size`` or ``external_reference``.
    """
    files = InputFiles(root, limits, log)
    if not inside(path, root.resolve()):
        outside = f"{path.name}: lies outside the folder of its description"
        raise InputRejected("external_reference", outside)
    return _load(path, files)


def load_mesh(
    path: Path, config: IntakeConfig, log: ReadLog | None = None, *, stated: bool = True
) -> Intake:
    """Read one mesh file with its sidecar; turn it z up and bring it to metres. Its origin stays.

    What it refers to lies in its folder or below. ``stated`` says whether the parts that are stated
    beside it are read.

    Raises:
        InputRejected: as :func:`load_visual`, or ``bad_sidecar``, ``absurd_size``,
            ``license_disallowed``.
        ConfigError: ``config.up`` or ``config.height`` cannot be.
    """
    check_config(config)
    files = InputFiles(path.parent, config, log)
    visual = _load(path, files)
    sidecar = read_sidecar(path, files)
    parts = read_stated(path, files) if stated else None
    license = sidecar.license or visual.license
    require_allowed(path.name, license, config.allowed_licenses, files.digest)
    notes = list(visual.notes)
    up, up_source = _choose_up(path, config, sidecar, notes)
    rotation = rotation_to_z_up(up)
    extents = np.abs(rotation) @ visual.mesh.extents
    category = _choose_category(path, sidecar, notes)
    scale = (
        given_scale(extents, config, sidecar, path.name)
        or scale_of_unit_cube(extents, category)
        or scale_by_size(extents, category)
    )
    notes += [scale.note] if scale.note else []
    if up_source == "format" and not scale.plausible:
        notes += _doubts(visual.mesh.extents, category)
    require_sensible_size(path.name, visual.mesh.bounds * scale.factor)
    transform = np.eye(4)
    transform[:3, :3] = scale.factor * rotation
    return Intake(
        name=safe_name(path),
        mesh=visual.mesh.transformed(transform),
        source_faces=visual.source_faces,
        transform=transform,
        provenance=Provenance(
            input=well_formed(path.name),
            digest=files.digest,
            category=category,
            up=up,
            up_source=up_source,
            scale=scale.factor,
            scale_source=scale.source,
            density=sidecar.density,
            license=license,
            dropped_degenerate=visual.dropped_degenerate,
            dropped_non_finite=visual.dropped_non_finite,
            notes=tuple(notes),
        ),
        annotation_path=sidecar.annotation,
        annotation_data=files.read(sidecar.annotation) if sidecar.annotation else None,
        stated=parts,
    )


def _load(path: Path, files: InputFiles) -> Visual:
    form = format_of(path)
    if form is None:
        known = ", ".join(each.suffix for each in FORMATS)
        raise InputRejected("unsupported", f"{path.name}: want one of {known}")
    with rejecting(path.name, path.parent, files.log), np.errstate(all="ignore"):
        data = files.read(path)
        if not data:
            raise InputRejected("empty", f"{path.name}: has 0 bytes", value=0.0, unit="bytes")
        soup = form.read(data, path, files)
    return Visual(
        **vars(clean(soup, path.name)),
        source_face_count=len(soup.corners),
        digest=files.digest,
        license=soup.license,
        notes=_few(soup.notes),
    )


def _few(notes: tuple[str, ...]) -> tuple[str, ...]:
    """Keep the first of a file's complaints: nobody reads of a thousand missing textures."""
    short = tuple(note[:_LONGEST_NOTE] for note in notes[:_MOST_NOTES])
    more = len(notes) - len(short)
    return (*short, f"{more} more notes of this kind.") if more else short


def _choose_up(
    path: Path, config: IntakeConfig, sidecar: Sidecar, notes: list[str]
) -> tuple[str, str]:
    """Return the axis up and who says so; a note where nobody does."""
    form = format_of(path)
    said = ("y", "format") if form is not None and form.y_up else ("z", "default")
    up, source = given_up(config, sidecar) or said
    if source == "default":
        notes.append(f"The up axis was taken to be {up}: {path.suffix.lower()} does not say.")
    return up, source


def _doubts(extents: FloatArray, category: str | None) -> list[str]:
    """Return a note where the size is plausible with the input's z axis up."""
    if not scale_by_size(extents, category).plausible:
        return []
    height = f"its height would be {extents[2]:.4g}, a plausible size"
    advice = "if the file breaks glTF's rule that y is up, set up to z."
    return [f"With the input's z axis up {height}: {advice}"]


def _choose_category(path: Path, sidecar: Sidecar, notes: list[str]) -> str | None:
    category = category_of(path, sidecar.category)
    if category is not None and not sidecar.category:
        name = f"{path.parent.name}/{path.name}"
        notes.append(f"The category {category} was guessed from the name {name}.")
    return category
