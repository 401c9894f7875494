"""One training example: a sampled object in a random state, somewhere in the network's box."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np
from msgspec import Meta

from asset_factory.factory.articulation import rotation_about
from asset_factory.factory.mesh import FloatArray, IntArray
from asset_factory.factory.models.particulate.components import component_features
from asset_factory.factory.models.particulate.prediction import MotionClass

from ..bounds import Amount, Count, Share, Whole
from .sampled_object import SampledObject, carried

QUARTER = np.pi / 2.0
#: Of a size.
Factor = Annotated[float, Meta(ge=1e-3, le=1e3)]
#: An array; in a batch on its way through the network a tensor.
Array = Any


@dataclass(frozen=True)
class DrawSettings:
    """How examples are drawn; scale, shift and points are the paper's.

    Attributes:
        points: per example.
        context: further points of the object, from which its box and what its components look like
            are measured.
        even_share: of them fall on all components alike, whatever their size; the others by length
            and area.
        sharp_share: of those others on sharp edges, where there are any.
        scale: lower and upper factor of the size.
        shift: standard deviation of the place, per axis.
        closed_share: of the examples have every joint closed; in the others each joint is closed as
            often again, else anywhere in its range.
        turned_share: of the examples face anywhere; the others face one of the four sides.
        facing_share: of those others face -Y, as the sampled objects do.
        mirrored_share: of the examples are mirrored left to right.
        stretch: largest factor by which one axis is longer than another, as a natural logarithm.
        fused_share: of the examples are told nothing of their components, as if the mesh were one
            piece.
        merged_share: of the remaining examples have some of their components taken for one.
        components: whether points carry what their components look like.
    """

    points: Count = 2048
    context: Whole = 3072
    even_share: Share = 0.0
    sharp_share: Share = 0.5
    scale: tuple[Factor, Factor] = (0.95, 1.05)
    shift: Amount = 0.02
    closed_share: Share = 0.4
    turned_share: Share = 0.0
    facing_share: Share = 1.0
    mirrored_share: Share = 0.0
    stretch: Amount = 0.0
    fused_share: Share = 0.0
    merged_share: Share = 0.0
    components: bool = False


@dataclass(frozen=True)
class Sample:
    """What the network sees and should answer, in its frame: centred, longest side 1, z up.

    Attributes:
        points, normals: shape [point_count, 3], float32; numbers of parts are int64.
        features: shape [point_count, channels]; without any, no channel.
        part_ids: shape [point_count]; 0 is the root.
        parents: shape [part_count]; -1 for the root.
        motion: :class:`MotionClass` per part, shape [part_count].
        revolute_direction, prismatic_direction: unit, or zero, shape [part_count, 3].
        revolute_range, prismatic_range: from this pose [rad, longest side], shape [part_count, 2].
        closest_points: on the part's axis, nearest to each point; zero without, [point_count, 3].
    """

    points: Array
    normals: Array
    features: Array
    part_ids: Array
    parents: Array
    motion: Array
    revolute_direction: Array
    revolute_range: Array
    prismatic_direction: Array
    prismatic_range: Array
    closest_points: Array


@dataclass(frozen=True)
class _Body:
    """As much of a sampled object as an example looks at, while it is moved; float64.

    Of ``rows``, its points, those of the example come first, then those that stand for the object.
    """

    rows: IntArray
    points: FloatArray
    normals: FloatArray
    axis: FloatArray
    origin: FloatArray
    slide: FloatArray
    reach: FloatArray


def draw(sampled: SampledObject, rng: np.random.Generator, settings: DrawSettings) -> Sample:
    """Draw a sample by the paper's recipe: a random state, the unit box, then jitter."""
    rows = _chosen(sampled, rng, settings)
    seen = np.concatenate([rows, rng.integers(0, len(sampled.points), settings.context)])
    body = _shaped(sampled, seen, rng, settings)
    turns, slides = _state(sampled, rng, settings.closed_share)
    body = _moved(sampled, body, turns, slides * body.reach)
    body = _placed(body, _facing(rng, settings), rng, settings)
    points = body.points[: len(rows)]
    part_ids = sampled.part_ids[rows].astype(np.int64)
    along = body.axis[part_ids]
    off = points - body.origin[part_ids]
    closest = body.origin[part_ids] + along * np.einsum("ij,ij->i", off, along)[:, None]
    turning = (sampled.motion == MotionClass.REVOLUTE) | (sampled.motion == MotionClass.BOTH)
    features = np.zeros((len(rows), 0), dtype=np.float32)
    if settings.components:
        components = _components(sampled, rng, settings)[seen]
        features = component_features(body.points, body.normals, components)[: len(rows)]
    limits = np.where(sampled.endless[:, None], sampled.turn, sampled.turn - turns[:, None])
    reach = (sampled.slide - slides[:, None]) * body.reach[:, None]
    return Sample(
        points=points.astype(np.float32),
        normals=body.normals[: len(rows)].astype(np.float32),
        features=features,
        part_ids=part_ids,
        parents=sampled.parents.astype(np.int64),
        motion=sampled.motion.astype(np.int64),
        revolute_direction=body.axis.astype(np.float32),
        revolute_range=limits.astype(np.float32),
        prismatic_direction=body.slide.astype(np.float32),
        prismatic_range=reach.astype(np.float32),
        closest_points=np.where(turning[part_ids][:, None], closest, 0.0).astype(np.float32),
    )


def _shaped(
    sampled: SampledObject, rows: IntArray, rng: np.random.Generator, settings: DrawSettings
) -> _Body:
    """Mirror and stretch at joint values 0, where any stretch keeps a valid object."""
    factor = np.exp(rng.uniform(-0.5, 0.5, 3) * settings.stretch)
    mirrored = rng.random() < settings.mirrored_share
    factor[0] *= -1.0 if mirrored else 1.0
    # A turn by the right-hand rule is mirrored into one by the left hand.
    axis = sampled.axis * factor * (-1.0 if mirrored else 1.0)
    slide = sampled.slide_direction * factor
    reach = np.linalg.norm(slide, axis=1)
    normals = sampled.normals[rows].astype(np.float64)
    if settings.stretch:
        lengths = np.sqrt(np.einsum("ij,ij->i", normals, normals))[:, None]
        normals = _unit(normals / factor) * lengths
    else:
        normals *= np.sign(factor)
    return _Body(
        rows=rows,
        points=sampled.points[rows] * factor,
        normals=normals,
        axis=_unit(axis),
        origin=sampled.origin * factor,
        slide=_unit(slide),
        reach=np.where(reach > 0.0, reach, 1.0),
    )


def _state(
    sampled: SampledObject, rng: np.random.Generator, closed_share: float
) -> tuple[FloatArray, FloatArray]:
    """Turn [rad] and slide [m] of every part."""
    count = len(sampled.parents)
    share = rng.random((2, count)) * (rng.random((2, count)) >= closed_share)
    share *= rng.random() >= closed_share
    low, high = np.stack([sampled.turn, sampled.slide]).transpose(2, 0, 1).astype(np.float64)
    value = low + share * (high - low)
    value[0, sampled.endless] = rng.uniform(-np.pi, np.pi, int(sampled.endless.sum()))
    return value[0], value[1]


def _moved(sampled: SampledObject, body: _Body, turns: FloatArray, slides: FloatArray) -> _Body:
    """Move every part by its own and its ancestors' joints; axes by its parent's."""
    own = np.tile(np.eye(4), (len(turns), 1, 1))
    for part, (turn, slide) in enumerate(zip(turns, slides, strict=True)):
        rotation = rotation_about(body.axis[part], float(turn))
        arm = body.origin[part] - body.slide[part] * slide
        own[part, :3, :3] = rotation
        own[part, :3, 3] = body.origin[part] - rotation @ arm
    poses = carried(sampled.parents.tolist(), own)
    # The root stays where it is, so that it may stand for what carries it.
    above = poses[np.maximum(sampled.parents, 0)]
    of_point = poses[sampled.part_ids[body.rows]]
    return replace(
        body,
        points=_rotated(of_point, body.points) + of_point[:, :3, 3],
        normals=_rotated(of_point, body.normals),
        axis=_rotated(above, body.axis),
        origin=_rotated(above, body.origin) + above[:, :3, 3],
        slide=_rotated(poses, body.slide),
    )


def _rotated(poses: FloatArray, vectors: FloatArray) -> FloatArray:
    """Return vectors turned as motions turn them, [n, 4, 4] and [n, 3]."""
    return np.asarray(np.einsum("nij,nj->ni", poses[:, :3, :3], vectors))


def _facing(rng: np.random.Generator, settings: DrawSettings) -> float:
    """Turn about the vertical [rad]."""
    anywhere = rng.random()
    ahead = rng.random()
    quarter = int(rng.integers(4))
    if anywhere < settings.turned_share:
        return float(rng.uniform(0.0, 2.0 * np.pi))
    return 0.0 if ahead < settings.facing_share else quarter * QUARTER


def _placed(body: _Body, yaw: float, rng: np.random.Generator, settings: DrawSettings) -> _Body:
    """Place in the network's box, but for a little jitter; slide lengths are in ``reach``."""
    turn = rotation_about(np.array([0.0, 0.0, 1.0]), yaw).T
    points = body.points @ turn
    # Along rows of memory; along columns it takes ten times as long.
    columns = np.ascontiguousarray(points.T)
    low = columns.min(axis=1)
    high = columns.max(axis=1)
    scale = rng.uniform(*settings.scale) / max(float((high - low).max()), 1e-9)
    shift = rng.normal(0.0, settings.shift, 3)
    middle = (low + high) / 2.0
    return replace(
        body,
        points=(points - middle) * scale + shift,
        normals=body.normals @ turn,
        axis=body.axis @ turn,
        origin=(body.origin @ turn - middle) * scale + shift,
        slide=body.slide @ turn,
        reach=body.reach * scale,
    )


def _chosen(sampled: SampledObject, rng: np.random.Generator, settings: DrawSettings) -> IntArray:
    """Return rows of the pool: evenly over components, on sharp edges, and the rest on faces.

    Of the latter two none is drawn twice, unless there are too few.
    """
    evenly = int(settings.even_share * settings.points)
    on_edge = np.flatnonzero(sampled.sharp)
    on_face = np.flatnonzero(~sampled.sharp)
    others = settings.points - evenly
    wanted = int(settings.sharp_share * others) if len(on_edge) else 0
    picked = [
        rng.choice(pool, count, replace=count > len(pool))
        for pool, count in ((on_edge, wanted), (on_face, others - wanted))
        if count
    ]
    if evenly:
        picked.append(_evenly(sampled.components, evenly, rng))
    return np.concatenate(picked)


def _evenly(components: IntArray, count: int, rng: np.random.Generator) -> IntArray:
    """Return rows of points, each of a component drawn from all of them alike."""
    _, which, sizes = np.unique(components, return_inverse=True, return_counts=True)
    return rng.choice(len(components), count, p=1.0 / (len(sizes) * sizes[which]))


def _components(
    sampled: SampledObject, rng: np.random.Generator, settings: DrawSettings
) -> IntArray:
    """Return the components as this example tells them: all, none, or some taken for one."""
    fused, merged = rng.random(2)
    if fused < settings.fused_share:
        return np.zeros(len(sampled.components), dtype=np.int64)
    if merged >= settings.merged_share:
        return sampled.components.astype(np.int64)
    count = int(sampled.components.max()) + 1
    target = np.arange(count)
    loose = rng.random(count) < 0.3
    target[loose] = rng.integers(0, max(1, count // 4), int(loose.sum()))
    return np.asarray(target[sampled.components])


def _unit(vectors: FloatArray) -> FloatArray:
    length = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))[:, None]
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0))
