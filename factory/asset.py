"""An articulation with everything a simulator needs: hulls, inertias, handles."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from .articulation import Articulation
from .errors import InvalidAsset
from .mesh import FloatArray, IntArray, cross, freeze, read_only


@dataclass(frozen=True)
class Hull:
    """One convex piece of collision geometry, object frame at rest.

    Attributes:
        vertices: hull corners [m], shape [vertex_count, 3], at least four, not coplanar.
        faces: outward triangles, shape [face_count, 3].
    """

    vertices: FloatArray
    faces: IntArray

    def __post_init__(self) -> None:
        freeze(self, "vertices")
        freeze(self, "faces", dtype=np.int64)
        if len(self.vertices) < 4 or not np.isfinite(self.vertices).all():
            raise InvalidAsset(f"hull: {len(self.vertices)} vertices, want at least 4 finite ones")
        if not self.volume > 0.0:
            raise InvalidAsset(
                f"hull: volume is {self.volume:.3g} m3, want more than 0 and faces outward"
            )

    @cached_property
    def bounds(self) -> FloatArray:
        """Return the lower and upper corner of the axis-aligned box around it [m], shape [2, 3]."""
        return np.stack([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    @cached_property
    def volume(self) -> float:
        """Return the enclosed volume [m3], by the divergence theorem."""
        corners = (self.vertices - self.vertices.mean(axis=0))[self.faces]
        return float(
            np.einsum("ij,ij->i", corners[:, 0], cross(corners[:, 1], corners[:, 2])).sum() / 6.0
        )

    @cached_property
    def planes(self) -> FloatArray:
        """Return outward unit normals and offsets, ``n . x <= d`` inside, [plane_count, 4]."""
        a, b, c = (self.vertices[self.faces[:, i]] for i in range(3))
        normals = cross(b - a, c - a)
        length = np.linalg.norm(normals, axis=1)
        kept = length > 1e-12 * max(1e-12, float(length.max()))
        normals = normals[kept] / length[kept, None]
        # The farthest vertex rather than the face's own: a sliver's normal may cut into the hull.
        offsets = (self.vertices @ normals.T).max(axis=0)
        return np.asarray(read_only(np.column_stack([normals, offsets])), dtype=np.float64)


@dataclass(frozen=True)
class Inertial:
    """Mass and its distribution.

    Attributes:
        mass: [kg], positive.
        center: centre of mass, object frame at rest [m], shape [3].
        tensor: inertia about ``center`` in the object frame's axes [kg m2], shape [3, 3];
            symmetric, positive definite, and its principal moments satisfy the triangle inequality.

    Raises:
        InvalidAsset: with the offending number.
    """

    mass: float
    center: FloatArray
    tensor: FloatArray

    def __post_init__(self) -> None:
        freeze(self, "center", "tensor")
        if not (np.isfinite(self.mass) and self.mass > 0.0):
            raise InvalidAsset(f"inertial: mass must be more than 0, not {self.mass} kg")
        if not (np.isfinite(self.center).all() and np.isfinite(self.tensor).all()):
            raise InvalidAsset("inertial: centre or tensor is not finite")
        if not np.allclose(self.tensor, self.tensor.T, rtol=1e-9, atol=1e-15):
            raise InvalidAsset("inertial: tensor is not symmetric")
        moments = np.linalg.eigvalsh(self.tensor)
        if not moments[0] > 0.0:
            raise InvalidAsset(
                f"inertial: smallest principal moment is {moments[0]:.3g} kg m2, want more than 0"
            )
        if moments[0] + moments[1] < moments[2] * (1.0 - 1e-9):
            raise InvalidAsset(
                f"inertial: principal moments {moments.tolist()} kg m2 break the "
                "triangle inequality"
            )


@dataclass(frozen=True)
class Handle:
    """Where a moving part is held, object frame at rest: measured on the part that was made.

    Attributes:
        point: [m], shape [3], on the part's surface.
        normal: unit, outward; a hand comes against it, shape [3].
        pull: unit direction in which pulling there opens the joint, shape [3].
        faces: mesh faces of what sticks out, or of the flat patch around an edge, shape
            [face_count].
        source: how it was found, e.g. ``protrusion`` or ``far_edge``.
    """

    point: FloatArray
    normal: FloatArray
    pull: FloatArray
    faces: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    source: str = "far_edge"

    def __post_init__(self) -> None:
        freeze(self, "point", "normal", "pull")
        freeze(self, "faces", dtype=np.int64)


@dataclass(frozen=True)
class Target:
    """A place where a robot can open a joint, object frame at rest.

    Attributes:
        joint: name of the joint that it opens.
        part: index of the part that is held; what the joint moves, or what that carries.
        kind: ``grasp``: two fingers close around it; ``hook``: a finger reaches behind it;
            ``push``: a fingertip presses on it.
        point: on the surface [m], shape [3]; of a grasp, in the middle between the fingers.
        normal: unit, outward; the hand comes against it, shape [3]. Of a grasp and a push it is the
            surface's.
        pull: unit direction in which the point first moves when the joint opens, shape [3]; of a
            knob that is held about its axis, the direction in which the finger on the side of
            ``fingers`` moves.
        fingers: unit direction along which the fingers close, across ``normal``, shape [3].
        opening: gap between the fingers that just takes what they grasp [m]; 0 for other kinds.
        score: 0 (hopeless) to 1 (a handle made for it).
    """

    joint: str
    part: int
    kind: str
    point: FloatArray
    normal: FloatArray
    pull: FloatArray
    fingers: FloatArray
    opening: float
    score: float

    def __post_init__(self) -> None:
        freeze(self, "point", "normal", "pull", "fingers")


@dataclass(frozen=True)
class StandingPlace:
    """A place for a robot's base.

    Attributes:
        position: x and y, object frame [m], shape [2].
        yaw: about z, at which it faces the target with every joint closed [rad].
    """

    position: tuple[float, float]
    yaw: float


@dataclass(frozen=True)
class PartBody:
    """What one part weighs, collides with, and is held by.

    Attributes:
        hulls: convex pieces; empty only for a carrier.
        inertial: see :class:`Inertial`.
        handle: ``None`` for parts that no joint moves.
        decomposition: how the hulls came about: ``exact``, ``single``, ``coacd``, ``halved``,
            ``built``, ``none``...
        degraded: sentences, one for each rung of the retry ladder below the first; empty when all
            went well.
    """

    hulls: tuple[Hull, ...]
    inertial: Inertial
    handle: Handle | None = None
    decomposition: str = "none"
    degraded: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "hulls", tuple(self.hulls))
        object.__setattr__(self, "degraded", tuple(self.degraded))


@dataclass(frozen=True)
class InnerSurface:
    """A surface that the input does not have, made so that a part of a one-piece mesh is a body.

    Attributes:
        part: name of the part that it belongs to.
        kind: ``rim``, ``slab back``, ``opening``, ``frame``, ``hollow``, ``lid hollow``,
            ``drawer box``, ``shelf``, ``knob base`` or ``wheel``.
        rule: where its place comes from.
        thickness_m: of the matter that it bounds [m]; ``None`` where the rule does not say.
        depth_m: of a hollow or a box [m]; ``None`` for other surfaces.
    """

    part: str
    kind: str
    rule: str
    thickness_m: float | None = None
    depth_m: float | None = None


@dataclass(frozen=True)
class Asset:
    """An articulation and one body per part.

    Attributes:
        name: what the asset is called in files; letters, digits, ``_``, ``-``.
        articulation: parts and joints.
        bodies: as many as parts, in their order.
        targets: where robots open the joints; joints in tree order, best first.
        invented: surfaces that the input does not have.
    """

    name: str
    articulation: Articulation
    bodies: tuple[PartBody, ...]
    targets: tuple[Target, ...] = ()
    invented: tuple[InnerSurface, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "bodies", tuple(self.bodies))
        object.__setattr__(self, "targets", tuple(self.targets))
        object.__setattr__(self, "invented", tuple(self.invented))
        parts = self.articulation.parts
        if len(self.bodies) != len(parts):
            raise InvalidAsset(
                f"asset {self.name!r}: {len(self.bodies)} bodies for {len(parts)} parts"
            )
        for part, body in zip(parts, self.bodies, strict=True):
            if len(part.faces) and not body.hulls:
                raise InvalidAsset(
                    f"part {part.name!r}: has {len(part.faces)} faces and no hull to collide with"
                )

    @property
    def hull_count(self) -> int:
        """Return the number of convex pieces over all parts."""
        return sum(len(body.hulls) for body in self.bodies)
