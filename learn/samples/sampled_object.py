"""A labelled object that training draws samples from: surface points, parts and motions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from graphlib import CycleError, TopologicalSorter
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from asset_factory.factory.articulation import Articulation, Joint
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.intake.importers.prediction import load_fields
from asset_factory.factory.mesh import BoolArray, FloatArray, IntArray, read_only
from asset_factory.factory.models.particulate.prediction import MotionClass
from asset_factory.factory.models.particulate.sampling import Cloud, draw
from asset_factory.factory.models.particulate.surface import Surface
from asset_factory.factory.runtime.store import write_whole

from ..bodies import bodies_of

MOST_PARTS = 16
"""Part queries of the network."""
COVERED = 0.25
"""Share of the points that go to the largest faces first, so small components are seen."""
MOST_BYTES = 512 * 1024 * 1024
"""Of a sampled object's arrays; a thousandth is usual."""
_MOST_COMPONENTS = 10_000_000
_TYPES: dict[str, Any] = {
    "part_ids": np.int16, "components": np.int32, "sharp": np.bool_, "endless": np.bool_,
    "parents": np.int16, "motion": np.int16,
}  # fmt: skip


@dataclass(frozen=True)
class SampledObject:
    """One object at joint values 0: points in its object frame [m], parts root first.

    Attributes:
        name: unique within its source.
        points: shape [point_count, 3], float32.
        normals: shape [point_count, 3], float32; the mean of two, shorter than 1, at sharp edges.
        part_ids: part of each point, shape [point_count], int16.
        sharp: whether it lies on a sharp edge, shape [point_count].
        components: connected component of the mesh, shape [point_count], int32.
        parents: part each part hangs on, -1 for the root, shape [part_count].
        motion: :class:`MotionClass` of each part, shape [part_count].
        axis: unit direction a part turns about, zero where it does not, shape [part_count, 3].
        origin: a point on that axis [m], shape [part_count, 3].
        turn: limits [rad], shape [part_count, 2].
        endless: whether it turns without limits, shape [part_count].
        slide_direction: unit, zero where it does not slide, shape [part_count, 3].
        slide: limits [m], shape [part_count, 2].
    """

    name: str
    points: FloatArray
    normals: FloatArray
    part_ids: IntArray
    sharp: BoolArray
    components: IntArray
    parents: IntArray
    motion: IntArray
    axis: FloatArray
    origin: FloatArray
    turn: FloatArray
    endless: BoolArray
    slide_direction: FloatArray
    slide: FloatArray

    def __post_init__(self) -> None:
        for each in fields(self):
            if each.name != "name":
                dtype = _TYPES.get(each.name, np.float32)
                object.__setattr__(self, each.name, read_only(getattr(self, each.name), dtype))
        _check(self)


def sampled_from(
    articulation: Articulation, name: str, points: int, rng: np.random.Generator
) -> SampledObject:
    """Return the training view of an object; its joint values 0 need not be closed.

    Half of the ``points`` are on sharp edges.

    Raises:
        InputRejected: as :func:`sampled_at`, ``zero_size``.
    """
    surface = Surface.of(articulation.mesh.vertices, articulation.mesh.faces)
    cloud = draw(surface, points, rng, most_covered=int(COVERED * points))
    return sampled_at(cloud, articulation, name)


def sampled_at(cloud: Cloud, articulation: Articulation, name: str) -> SampledObject:
    """Return the training view of an object at these points of its surface.

    A part that does not move is one with its parent: nobody could tell them apart. A part behind a
    carrier turns *and* slides.

    Raises:
        InputRejected: ``too_many_parts``, ``no_movable_joint``, ``unsupported_joint``.
    """
    bodies = bodies_of(articulation)
    row = np.zeros(len(bodies), dtype=np.int64)
    moving = np.flatnonzero(bodies.moving).tolist()
    for body, parent in enumerate(bodies.parents):
        held = row[parent] if parent >= 0 else 0
        row[body] = 1 + moving.index(body) if body in moving else held
    if not moving:
        message = f"{name}: nothing moves; want a joint to learn from"
        raise InputRejected("no_movable_joint", message, value=0.0)
    if len(moving) >= MOST_PARTS:
        message = f"{name}: has {1 + len(moving)} parts, want at most {MOST_PARTS}"
        raise InputRejected("too_many_parts", message, value=1 + len(moving), limit=MOST_PARTS)
    parents = [row[bodies.parents[body]] if bodies.parents[body] >= 0 else 0 for body in moving]
    return SampledObject(
        name=name,
        points=cloud.points,
        normals=cloud.normals,
        part_ids=row[bodies.labels[cloud.faces]],
        sharp=cloud.sharp,
        components=cloud.components,
        parents=np.array([-1, *parents]),
        **_motions(name, [bodies.joints[body] for body in moving]),
    )


def _motions(name: str, chains: Sequence[tuple[Joint, ...]]) -> dict[str, Any]:
    """Return what a sample says of its parts' motions, the root first; others by their joints."""
    count = 1 + len(chains)
    widths = {"axis": 3, "origin": 3, "turn": 2, "slide_direction": 3, "slide": 2}
    told: dict[str, Any] = {name: np.zeros((count, width)) for name, width in widths.items()}
    told |= {"motion": np.zeros(count, dtype=np.int64), "endless": np.zeros(count, dtype=np.bool_)}
    for row, chain in enumerate(chains, start=1):
        if len({joint.turns for joint in chain}) < len(chain):
            said = f"{name}, {chain[-1].name!r}: want at most one turn and one slide"
            raise InputRejected("unsupported_joint", said)
        told["motion"][row] = sum(1 if joint.turns else 2 for joint in chain)
        for joint in chain:
            way, limits = ("axis", "turn") if joint.turns else ("slide_direction", "slide")
            told[way][row] = joint.axis
            told[limits][row] = (joint.lower, joint.upper)
            if joint.turns:
                told["origin"][row] = joint.origin
                told["endless"][row] = joint.kind == "continuous"
    return told


def parents_first(parents: Sequence[int]) -> list[int]:
    """Return the parts ordered so that each comes after what it hangs on.

    Raises:
        ValueError: some hang on one another in a circle.
    """
    hung = {part: (parent,) if parent >= 0 else () for part, parent in enumerate(parents)}
    try:
        return list(TopologicalSorter(hung).static_order())
    except CycleError as error:
        looped = f"part {error.args[1][0]} does not hang on the root"
        raise ValueError(f"parents {parents}: {looped}") from None


def carried(parents: Sequence[int], own: FloatArray) -> FloatArray:
    """Return the motions of parts by their own joints, [n, 4, 4], and by those that carry them."""
    poses = np.array(own)
    for part in parents_first(parents):
        if parents[part] >= 0:
            poses[part] = poses[parents[part]] @ own[part]
    return poses


def write_sampled(path: Path, sampled: SampledObject) -> None:
    """Write one uncompressed npz file, complete or not there."""
    buffer = BytesIO()
    np.savez(buffer, allow_pickle=False, **vars(sampled))
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, buffer.getvalue())


def read_sampled(path: Path) -> SampledObject:
    """Return a sampled object from its file.

    Raises:
        InputRejected: ``bad_sample``: not such a file, damaged, or too large.
    """
    try:
        found: Any = load_fields(path, MOST_BYTES, [each.name for each in fields(SampledObject)])
        return SampledObject(**found | {"name": str(found["name"])})
    except (InputRejected, ValueError) as error:
        said = f"{path}: cannot be read as a sampled object: {error}"
        raise InputRejected("bad_sample", said) from error


def _check(sampled: SampledObject) -> None:
    points = len(sampled.points)
    parts = len(sampled.parents)
    wanted: dict[str, tuple[int, ...]] = {
        **dict.fromkeys(("points", "normals"), (points, 3)),
        **dict.fromkeys(("part_ids", "sharp", "components"), (points,)),
        **dict.fromkeys(("axis", "origin", "slide_direction"), (parts, 3)),
        **dict.fromkeys(("turn", "slide"), (parts, 2)),
        **dict.fromkeys(("parents", "motion", "endless"), (parts,)),
    }
    for name, shape in wanted.items():
        value = getattr(sampled, name)
        if value.shape != shape:
            raise ValueError(f"{name}: shape {value.shape}, want {shape}")
        if not np.isfinite(value).all():
            raise ValueError(f"{name}: holds numbers that are not finite")
    if not points or not 1 <= parts <= MOST_PARTS:
        most = f"want points, and 1 to {MOST_PARTS} parts"
        raise ValueError(f"{points} points and {parts} parts: {most}")
    if not 0 <= int(sampled.part_ids.min()) <= int(sampled.part_ids.max()) < parts:
        raise ValueError(f"part_ids: want 0 to {parts - 1}")
    if not 0 <= int(sampled.components.min()) <= int(sampled.components.max()) < _MOST_COMPONENTS:
        raise ValueError(f"components: want 0 to {_MOST_COMPONENTS - 1}")
    if not np.ptp(sampled.points, axis=0).max() > 0.0:
        raise ValueError("points: all at one place, want some size")
    _check_tree(sampled.parents.tolist(), sampled.motion.tolist())


def _check_tree(parents: list[int], motion: list[int]) -> None:
    if parents[0] != -1 or not all(0 <= parent < len(parents) for parent in parents[1:]):
        raise ValueError(f"parents {parents}: want -1 for the first part alone")
    parents_first(parents)
    if not all(kind in tuple(MotionClass) for kind in motion):
        raise ValueError(f"motion {motion}: want {', '.join(f'{kind:d}' for kind in MotionClass)}")
