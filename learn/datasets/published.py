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

import numpy as np

from asset_factory.factory.articulate.annotated import AnnotatedArticulator
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.geometry.rows import distinct_rows
from asset_factory.factory.intake.annotation import AnnotatedJoint, Annotation
from asset_factory.factory.intake.limits import require_at_most
from asset_factory.factory.intake.loading import load_visual
from asset_factory.factory.mesh import IntArray

from ..samples.sampled_object import SampledObject
from .categories import categories_of
from .item import SourceItem, find_items
from .plucker import Arrays, annotated_joint, arrays_of, bad_annotation
from .point_cache import sampled_from_points
from .settings import SourceSettings

MESH = "original.obj"
META = "meta.npz"
AXES = "link_axes_plucker.npz"
RANGES = "link_range.npz"
POINT_FIELDS = frozenset(
    {"points", "normals", "point_to_bone", "bone_structure", "link_axes_plucker", "link_range"}
)


def find_published(root: Path) -> tuple[SourceItem, ...]:
    """Return the folders with ``original.obj`` and labels, and point caches."""
    return find_items(root, _mains, categories_of(root))


def read_published(item: SourceItem, settings: SourceSettings) -> Articulation | SampledObject:
    """Return one object; the given points where there is no mesh. Raises InputRejected."""
    if item.main.name != META:
        return sampled_from_points(item, settings)
    folder = item.folder
    intake = settings.intake
    visual = load_visual(folder / MESH, folder, intake)
    bones = arrays_of(item.main, settings.max_bytes)
    axes, ranges = (arrays_of(folder / name, settings.max_bytes) for name in (AXES, RANGES))
    labels = _face_labels(folder / MESH, bones, visual.source_face_count)
    count = int(max(labels.max(), bones["bone_structure"].max(initial=0))) + 1
    names = tuple(f"part_{bone}" for bone in range(count))
    annotation = Annotation(labels, names, _joints(bones, axes, ranges), "pred.npz")
    # The release writes visuals twice: of all faces on the same vertices the first is kept.
    kept = np.sort(distinct_rows(np.sort(visual.mesh.faces, axis=1))[0])
    articulator = AnnotatedArticulator(annotation, np.eye(4), visual.source_faces[kept])
    return articulator.articulate(visual.mesh.submesh(kept))


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
        raise bad_annotation(f"{path.name}: its faces do not fit the {labelled}")
    if labels.min() < 0:
        raise bad_annotation(f"{META}: vert_to_bone holds {labels.min()}, want 0 and more")
    require_at_most(META, int(labels.max()), 4096, "bones")
    return labels[vertices]


def _joints(bones: Arrays, axes: Arrays, ranges: Arrays) -> tuple[AnnotatedJoint, ...]:
    nothing = np.zeros(12)
    return tuple(
        annotated_joint(
            parent, child, axes.get(str(child), nothing), ranges.get(str(child), nothing[:4])
        )
        for parent, child in bones["bone_structure"].reshape(-1, 2).astype(int).tolist()
    )
