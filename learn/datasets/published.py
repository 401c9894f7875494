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
from asset_factory.factory.intake.annotation import Annotation
from asset_factory.factory.intake.importers.prediction import (
    MAX_PARTS,
    Fields,
    annotation_in,
    load_fields,
)
from asset_factory.factory.intake.limits import require_at_most
from asset_factory.factory.intake.loading import load_visual
from asset_factory.factory.mesh import IntArray, Mesh
from asset_factory.factory.models.particulate.sampling import Cloud

from ..samples.sampled_object import SampledObject, sampled_at
from .item import SourceItem, find_items
from .settings import SourceSettings

Array = npt.NDArray[Any]
MESH = "original.obj"
META = "meta.npz"
AXES = "link_axes_plucker.npz"
RANGES = "link_range.npz"
POINT_FIELDS = frozenset(
    {"points", "normals", "point_to_bone", "bone_structure", "link_axes_plucker", "link_range"}
)
TINY = 1e-6
"""Side of the triangle that stands for a point, in lengths of the object's longest side."""
FULL_TURN = 2.0 * np.pi - 1e-3
"""A range of so much is a turn without an end: the release writes those as -pi to pi [rad]."""
BEYOND = (-1e8, 1e8)
"""Limits of such a turn: so far that they count as none [rad]."""


def find_published(root: Path) -> tuple[SourceItem, ...]:
    """Return the folders with ``original.obj`` and labels, and point caches."""
    return find_items(root, _mains)


def read_published(item: SourceItem, settings: SourceSettings) -> Articulation | SampledObject:
    """Return one object; the given points where there is no mesh. Raises InputRejected."""
    if item.main.name != META:
        return _sampled_from_points(item, settings)
    folder = item.folder
    visual = load_visual(folder / MESH, folder, settings.intake)
    bones, axes, ranges = (_numbers_in(folder / name, settings) for name in (META, AXES, RANGES))
    structure = bones["bone_structure"]
    labels = _face_labels(folder / MESH, bones["vert_to_bone"], visual.source_face_count)
    count = int(max(labels.max(), structure.max(initial=0))) + 1
    require_at_most("its labels", count, MAX_PARTS, "bones")
    lines = _of_bones(axes, count, 12)
    annotation = _annotation(labels, structure, lines, _of_bones(ranges, count, 4))
    # The release writes visuals twice: of all faces on the same vertices the first is kept.
    kept = np.sort(distinct_rows(np.sort(visual.mesh.faces, axis=1))[0])
    articulator = AnnotatedArticulator(annotation, np.eye(4), visual.source_faces[kept])
    return articulator.articulate(visual.mesh.submesh(kept))


def _sampled_from_points(item: SourceItem, settings: SourceSettings) -> SampledObject:
    """Return the sample of a point cache: a tiny triangle stands for each point, all one component.

    Raises:
        InputRejected: ``bad_annotation``, ``not_a_tree``, ``no_movable_joint``, ``too_many_parts``.
    """
    stored: dict[str, Any] = dict(_numbers_in(item.main, settings))
    points = stored["points"]
    if stored["point_to_bone"].shape != (len(points),):
        raise _bad_annotation(f"{item.main.name}: point_to_bone does not fit its points")
    lines = (stored["link_axes_plucker"], stored["link_range"])
    annotation = _annotation(stored["point_to_bone"], stored["bone_structure"], *lines)
    corners = points[:, None] + TINY * np.eye(3)
    rows = np.arange(len(points))
    mesh = Mesh.from_triangles(corners, np.arange(3 * len(points)))
    articulator = AnnotatedArticulator(annotation, np.eye(4), rows)
    sharp = stored.get("point_from_sharp", np.zeros(len(points), dtype=np.bool_))
    cloud = Cloud(points, stored["normals"], rows, sharp, np.zeros_like(rows))
    return sampled_at(cloud, articulator.articulate(mesh), item.name)


def _annotation(labels: Array, structure: Array, lines: Array, ranges: Array) -> Annotation:
    """Return labels of faces, shape [face_count], and joints between bones, as an annotation.

    ``lines`` are ``(l, l x p)`` of the turn and of the slide, zero where there is none, shape
    [bone_count, 12]; ``ranges`` of the turn [rad] and of the slide, from the pose that the object
    is in, shape [bone_count, 4].
    """
    if labels.min(initial=0) < 0:
        raise _bad_annotation(f"a label is {labels.min()}, want 0 and more")
    turns = ranges[:, :2]
    endless = np.ptp(turns, axis=1) >= FULL_TURN
    fields: Fields = {
        "face_part_ids": labels.astype(np.int64),
        "motion_hierarchy": structure.reshape(-1, 2).astype(np.int64),
        "is_part_revolute": np.asarray(lines[:, :3].any(axis=1)),
        "is_part_prismatic": np.asarray(lines[:, 6:9].any(axis=1)),
        "revolute_plucker": lines[:, :6],
        "revolute_range": np.where(endless[:, None], BEYOND, turns),
        "prismatic_axis": lines[:, 6:9],
        "prismatic_range": ranges[:, 2:],
    }
    return annotation_in(fields, len(labels), "its bones")


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


def _face_labels(path: Path, bones: Array, face_count: int) -> IntArray:
    """Return the bone of every OBJ triangle, polygons fanned, by its first vertex, [face_count]."""
    first: list[int] = []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        if line.startswith("f "):
            corners = line.split()[1:]
            first += [int(corners[0].split("/")[0])] * (len(corners) - 2)
    labels = bones.reshape(-1).astype(np.int64)
    vertices = np.asarray(first, dtype=np.int64) - 1
    fitting = len(vertices) == face_count and len(labels)
    if not fitting or not 0 <= vertices.min() <= vertices.max() < len(labels):
        said = f"{path.name}: its faces do not fit the {len(labels)} labelled vertices"
        raise _bad_annotation(said)
    return labels[vertices]


def _of_bones(stored: Fields, count: int, width: int) -> Array:
    """Return the row stored of each bone, by its number, else zeros, shape [count, width]."""
    found = np.zeros((count, width))
    for bone in range(count):
        row = stored.get(str(bone), found[bone])
        if row.shape != (width,):
            raise _bad_annotation(f"bone {bone}: a row of shape {list(row.shape)}; want {width}")
        found[bone] = row
    return found


def _numbers_in(path: Path, settings: SourceSettings) -> Fields:
    """Return the arrays of an ``.npz``. Raises InputRejected ``bad_annotation``: no numbers."""
    fields = load_fields(path, settings.max_bytes)
    for name, values in fields.items():
        if values.dtype.kind not in "biuf" or not np.isfinite(values).all():
            raise _bad_annotation(f"{path.name}: {name} holds what is no finite number")
    return fields


def _bad_annotation(message: str) -> InputRejected:
    """Return the refusal of labels that contradict themselves or their mesh."""
    return InputRejected("bad_annotation", message)
