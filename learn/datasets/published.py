"""What the release's preprocessing leaves: folders with ``original.obj``, and point caches.

A folder holds ``original.obj``, ``meta.npz`` (``vert_to_bone`` [vertex_count], ``bone_structure``
[edge_count, 2] of parent and child), ``link_axes_plucker.npz`` (per bone [12]: ``(l, l x p)`` of
the turn, then of the slide) and ``link_range.npz`` (per bone [4]: turn, then slide). A point cache
holds the same about points instead of vertices, and no mesh; its points are taken as one component.
Lengths are in units of the object's longest side.
"""

from __future__ import annotations

import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from asset_factory.factory.articulate.annotated import AnnotatedArticulator
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.geometry.rows import distinct_rows
from asset_factory.factory.intake.annotation import AnnotatedJoint, Annotation
from asset_factory.factory.intake.importers.prediction import point_on_line
from asset_factory.factory.intake.limits import require_at_most
from asset_factory.factory.intake.loading import load_visual
from asset_factory.factory.mesh import IntArray, Mesh
from asset_factory.factory.models.particulate.sampling import Cloud

from ..samples.sampled_object import SampledObject, sampled_at
from .categories import categories_of
from .item import SourceItem, find_items
from .settings import SourceSettings

Arrays = dict[str, npt.NDArray[Any]]
MESH = "original.obj"
META = "meta.npz"
AXES = "link_axes_plucker.npz"
RANGES = "link_range.npz"
POINT_FIELDS = frozenset(
    {"points", "normals", "point_to_bone", "bone_structure", "link_axes_plucker", "link_range"}
)
MOST_BONES = 4096
TINY = 1e-6
"""Side of the triangle that stands for a point, in lengths of the object's longest side."""
FULL_TURN = 2.0 * np.pi - 1e-3
"""A range of so much is a turn without an end: the release writes those as -pi to pi [rad]."""


def find_published(root: Path) -> tuple[SourceItem, ...]:
    """Return the folders with ``original.obj`` and labels, and point caches."""
    return find_items(root, _mains, categories_of(root))


def read_published(item: SourceItem, settings: SourceSettings) -> Articulation | SampledObject:
    """Return one object; the given points where there is no mesh. Raises InputRejected."""
    if item.main.name != META:
        return _sampled_from_points(item, settings)
    folder = item.folder
    intake = settings.intake
    visual = load_visual(folder / MESH, folder, intake)
    bones = _arrays_of(item.main, settings.max_bytes)
    axes, ranges = (_arrays_of(folder / name, settings.max_bytes) for name in (AXES, RANGES))
    labels = _face_labels(folder / MESH, bones, visual.source_face_count)
    # The release writes visuals twice: of all faces on the same vertices the first is kept.
    kept = np.sort(distinct_rows(np.sort(visual.mesh.faces, axis=1))[0])
    articulator = _articulator(labels, visual.source_faces[kept], bones, axes, ranges)
    return articulator.articulate(visual.mesh.submesh(kept))


def _sampled_from_points(item: SourceItem, settings: SourceSettings) -> SampledObject:
    """Return the sample of a point cache: a tiny triangle stands for each point, all one component.

    Raises:
        InputRejected: ``bad_annotation``, ``not_a_tree``, ``no_movable_joint``, ``too_many_parts``.
    """
    stored = _arrays_of(item.main, settings.max_bytes)
    points = stored["points"]
    bones = stored["point_to_bone"].astype(np.int64)
    lines = stored["link_axes_plucker"]
    ranges = stored["link_range"]
    count = len(lines)
    name = item.main.name
    fitting = bones.shape == (len(points),) and len(bones) and len(ranges) == count
    if not fitting or not 0 <= bones.min() <= bones.max() < count:
        wrong = f"do not fit its points and {count} bones"
        raise _bad_annotation(f"{name}: point_to_bone, link_range {wrong}")
    axes, ends = ({str(bone): row for bone, row in enumerate(of)} for of in (lines, ranges))
    corners = points[:, None] + TINY * np.eye(3)
    rows = np.arange(len(points))
    mesh = Mesh.from_triangles(corners, np.arange(3 * len(points)))
    articulator = _articulator(bones, rows, stored, axes, ends)
    sharp = stored.get("point_from_sharp", np.zeros(len(points), dtype=np.bool_))
    cloud = Cloud(points, stored["normals"], rows, sharp, np.zeros_like(rows))
    about = {"name": item.name, "category": item.category, "source": "particulate"}
    return sampled_at(cloud, articulator.articulate(mesh), **about)


def _articulator(
    labels: IntArray, faces: IntArray, bones: Arrays, axes: Arrays, ranges: Arrays
) -> AnnotatedArticulator:
    """Return who believes labels of faces, shape [face_count], and the joints between bones."""
    structure = bones["bone_structure"]
    if structure.min(initial=0) < 0:
        raise _bad_annotation(f"bone_structure holds {structure.min()}, want 0 and more")
    count = int(max(labels.max(), structure.max(initial=0))) + 1
    require_at_most("its labels", count, MOST_BONES, "bones")
    names = tuple(f"part_{bone}" for bone in range(count))
    annotation = Annotation(labels, names, _joints(bones, axes, ranges), "pred.npz")
    return AnnotatedArticulator(annotation, np.eye(4), faces)


def _mains(files: Sequence[Path]) -> list[Path]:
    names = {path.name: path for path in files}
    if {MESH, META, AXES, RANGES} <= set(names):
        return [names[META]]
    return [path for path in files if path.suffix == ".npz" and _holds_points(path)]


def _holds_points(path: Path) -> bool:
    try:
        with zipfile.ZipFile(path) as archive:
            return {f"{field}.npy" for field in POINT_FIELDS} <= set(archive.namelist())
    except (OSError, zipfile.BadZipFile):
        return False


def _face_labels(path: Path, bones: Arrays, face_count: int) -> IntArray:
    """Return the bone of every OBJ triangle, polygons fanned, by its first vertex, [face_count]."""
    first: list[int] = []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        if line.startswith("f "):
            corners = line.split()[1:]
            first += [int(corners[0].split("/")[0])] * (len(corners) - 2)
    labels = bones["vert_to_bone"].reshape(-1).astype(np.int64)
    vertices = np.asarray(first, dtype=np.int64) - 1
    fitting = len(vertices) == face_count and len(labels)
    if not fitting or not 0 <= vertices.min() <= vertices.max() < len(labels):
        labelled = f"{len(labels)} labelled vertices"
        raise _bad_annotation(f"{path.name}: its faces do not fit the {labelled}")
    if labels.min() < 0:
        raise _bad_annotation(f"{META}: vert_to_bone holds {labels.min()}, want 0 and more")
    return labels[vertices]


def _joints(bones: Arrays, axes: Arrays, ranges: Arrays) -> tuple[AnnotatedJoint, ...]:
    nothing = np.zeros(12)
    return tuple(
        _annotated_joint(
            parent, child, axes.get(str(child), nothing), ranges.get(str(child), nothing[:4])
        )
        for parent, child in bones["bone_structure"].reshape(-1, 2).astype(int).tolist()
    )


def _bad_annotation(message: str) -> InputRejected:
    """Return the refusal of labels that contradict themselves or their mesh."""
    return InputRejected("bad_annotation", message)


def _arrays_of(path: Path, max_bytes: int) -> Arrays:
    """Return the arrays of an ``.npz``, unpickled nothing.

    Raises:
        InputRejected: ``missing_file``, ``too_large``, or ``bad_annotation``: damaged, not finite.
    """
    if not path.is_file():
        raise InputRejected("missing_file", f"{path.name}: is not there")
    try:
        with zipfile.ZipFile(path) as archive:
            size = sum(entry.file_size for entry in archive.infolist())
            require_at_most(path.name, size, max_bytes, "bytes")
        with np.load(path, allow_pickle=False) as stored:
            arrays = {name: stored[name] for name in stored.files}
    except (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile) as error:
        raise _bad_annotation(f"{path.name}: is no .npz of plain arrays: {error}") from error
    for name, values in arrays.items():
        if values.dtype.kind not in "biuf" or not np.isfinite(values.astype(np.float64)).all():
            raise _bad_annotation(f"{path.name}: {name} holds what is no finite number")
    return arrays


def _annotated_joint(
    parent: int, child: int, lines: npt.NDArray[Any], ranges: npt.NDArray[Any]
) -> AnnotatedJoint:
    """Return the joint of one bone.

    ``lines`` are ``(l, l x p)`` of the turn and of the slide, zero where there is none, shape [12];
    ``ranges`` of the turn [rad] and of the slide, from the pose that the object is in, shape [4].
    """
    if lines.shape != (12,) or ranges.shape != (4,):
        shapes = f"axes of shape {list(lines.shape)}, ranges {list(ranges.shape)}"
        raise _bad_annotation(f"bone {child}: {shapes}; want 12, 4")
    turn, moment, slide = (np.asarray(lines[i : i + 3], dtype=np.float64) for i in (0, 3, 6))
    low, high, near, far = (float(value) for value in ranges.astype(np.float64))
    kind = ("fixed", "revolute", "prismatic", "both")[turn.any() + 2 * slide.any()]
    endless = high - low >= FULL_TURN
    ends = (near, far) if kind == "prismatic" else (None, None) if endless else (low, high)
    return AnnotatedJoint(
        name=f"joint_{child}",
        kind=kind,
        parent=parent,
        child=child,
        axis=slide if kind == "prismatic" else turn,
        origin=point_on_line(turn, moment) if turn.any() else np.zeros(3),
        lower=ends[0],
        upper=ends[1],
        slide_axis=slide if kind == "both" else None,
        slide_lower=near if kind == "both" else None,
        slide_upper=far if kind == "both" else None,
    )
