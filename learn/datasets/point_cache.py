"""A sampled object from labelled points alone, as the release caches them for training."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.errors import InputRejected
from asset_factory.factory.mesh import FloatArray, IntArray

from ..samples.sampled_object import SampledObject, require_parts
from .item import SourceItem
from .plucker import FULL_TURN, Arrays, arrays_of, bad_annotation
from .settings import SourceSettings


def sampled_from_points(item: SourceItem, settings: SourceSettings) -> SampledObject:
    """Return the sample of a point cache: fixed parts join their parents, all is one component.

    Raises:
        InputRejected: ``bad_annotation``, ``not_a_tree``, ``no_movable_joint``, ``too_many_parts``.
    """
    stored = arrays_of(item.main, settings.max_bytes)
    points = stored["points"]
    bones = stored["point_to_bone"].astype(np.int64)
    lines = stored["link_axes_plucker"].astype(np.float64)
    ranges = stored["link_range"].astype(np.float64)
    count = len(lines)
    name = item.main.name
    fitting = bones.shape == (len(points),) and len(bones)
    if not fitting or not 0 <= bones.min() <= bones.max() < count:
        raise bad_annotation(f"{name}: point_to_bone does not fit its points and {count} bones")
    if lines.shape != (count, 12) or ranges.shape != (count, 4):
        raise bad_annotation(f"{name}: link_axes_plucker, link_range: want 12 and 4 columns")
    parents, order = _tree(stored, count, name)
    turns, slides = (np.asarray(lines[:, i : i + 3].any(axis=1)) for i in (0, 6))
    kept = [bone for bone in order if parents[bone] < 0 or turns[bone] or slides[bone]]
    require_parts(item.name, len(kept))
    number = np.zeros(count, dtype=np.int64)
    for bone in order:
        number[bone] = kept.index(bone) if bone in kept else number[parents[bone]]
    rows = np.asarray(kept)
    axis = _unit(lines[rows, :3])
    slide = _unit(lines[rows, 6:9])
    squared = np.maximum((lines[rows, :3] ** 2).sum(axis=1, keepdims=True), 1e-12)
    turn = ranges[rows, :2]
    return SampledObject(
        name=item.name,
        category=item.category,
        source="particulate",
        points=points,
        normals=stored["normals"],
        part_ids=number[bones],
        sharp=stored.get("point_from_sharp", np.zeros(len(points), dtype=np.bool_)),
        components=np.zeros(len(points), dtype=np.int64),
        parents=np.array([-1, *(number[parents[bone]] for bone in kept[1:])]),
        motion=turns[rows] * 1 + slides[rows] * 2,
        axis=axis,
        origin=np.cross(lines[rows, 3:6], lines[rows, :3]) / squared,
        turn=turn,
        endless=turn[:, 1] - turn[:, 0] >= FULL_TURN,
        slide_direction=slide,
        slide=ranges[rows, 2:],
    )


def _tree(stored: Arrays, count: int, file: str) -> tuple[IntArray, list[int]]:
    """Return the parent of every bone, -1 for the root, and the bones parents first."""
    parents = np.full(count, -1)
    for parent, child in stored["bone_structure"].reshape(-1, 2).astype(np.int64):
        if not (0 <= parent < count and 0 <= child < count) or parents[child] >= 0:
            said = f"{file}: bone {child} hangs on two bones, or on one that there is not"
            raise InputRejected("not_a_tree", said)
        parents[child] = parent
    roots = np.flatnonzero(parents < 0)
    order = [int(root) for root in roots]
    for bone in order:
        order += [int(child) for child in np.flatnonzero(parents == bone)]
    if len(roots) != 1 or len(order) != count:
        said = f"{file}: {len(roots)} bones hang on none; want one tree of all {count}"
        raise InputRejected("not_a_tree", said)
    return parents, order


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-12))
