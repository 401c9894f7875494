"""An object under construction: a body, the parts that move on it, and the joints between them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypedDict, Unpack

import numpy as np

from ....articulation import Articulation, Joint, JointKind, Part, rotation_about
from ....mesh import FloatArray, IntArray, Material, Mesh
from .chance import Chance
from .looks import WHITE, laid_over
from .shapes import Form, Point

#: Directions of axes; what hangs at the back of its lid opens about LEFT.
LEFT, RIGHT = (-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)
FRONT, BACK = (0.0, -1.0, 0.0), (0.0, 1.0, 0.0)
DOWN, UP = (0.0, 0.0, -1.0), (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Placement:
    """Where a face is on which something is built as if the face were the plane y = 0, seen from -Y.

    Attributes:
        turn: columns are the directions of x (to the right), y (into the object) and z (up),
            shape [3, 3]; ``None`` for those of the object.
        origin: of the face [m].
    """

    turn: FloatArray | None
    origin: Point

    def form(self, form: Form) -> Form:
        """A form built on the plane, in its place."""
        vertices = form.vertices if self.turn is None else form.vertices @ self.turn.T
        return Form(vertices + self.origin, form.faces)

    def direction(self, direction: Point) -> FloatArray:
        """A direction on the plane as one of the object."""
        return np.asarray(direction if self.turn is None else self.turn @ direction)

    def point(self, point: Point) -> FloatArray:
        """A point on the plane as one of the object."""
        return self.direction(point) + self.origin


def facing_front(y: float) -> Placement:
    """The face at ``y`` that looks towards -Y."""
    return Placement(None, (0.0, y, 0.0))


def facing_up(z: float) -> Placement:
    """The face at ``z`` that looks up; its own z is the object's y."""
    return Placement(np.array([(1.0, 0, 0), (0, 0, 1.0), (0, -1.0, 0)]), (0.0, 0.0, z))


def facing_side(x: float) -> Placement:
    """The face at ``x`` that looks away from the middle, to the right for ``x`` above 0."""
    side = 1.0 if x > 0.0 else -1.0
    return Placement(np.array([(0, -side, 0), (side, 0, 0), (0, 0, 1.0)]), (x, 0.0, 0.0))


#: Where things are said as they are in the object.
HERE = Placement(None, (0.0, 0.0, 0.0))


@dataclass(eq=False)
class PartDraft:
    """A part and the joint that moves it, while it is built.

    Attributes:
        name: of the part; its joint is called ``<name>_joint``.
        look: of what is added without one.
        parent: the part that it hangs on; ``None`` for the body.
        kind: of its joint.
        axis: unit vector; positive values open.
        origin: a point on the axis [m].
        lower: closed [rad] or [m].
        upper: fully open; neither is used where it turns without end.
        slide: how far the part also slides along its axis [m]; above 0, it hangs on a carrier
            without faces that turns, and slides in it.
        rest: the joint's value at which the object is left; limits then count from there.
        place: the face that the part was described on, if any.
        forms: what it consists of, at value 0, each with its look.
    """

    name: str
    look: Material
    parent: PartDraft | None = None
    kind: JointKind = JointKind.FIXED
    axis: FloatArray = field(default_factory=lambda: np.array(UP))
    origin: FloatArray = field(default_factory=lambda: np.zeros(3))
    lower: float = 0.0
    upper: float = 0.0
    slide: float = 0.0
    rest: float = 0.0
    place: Placement | None = None
    forms: list[tuple[Form, Material]] = field(default_factory=list)

    def add(self, *forms: Form, look: Material | None = None) -> None:
        """Add forms to the part, in its own look or another."""
        seen = look or self.look
        place = self.place
        for form in forms:
            self.forms.append((form if place is None else place.form(form), seen))

    @property
    def face_count(self) -> int:
        """Triangles added so far."""
        return sum(len(form.faces) for form, _ in self.forms)

    def motion(self) -> FloatArray:
        """From the pose of value 0 to the pose at rest, shape [4, 4]."""
        moved = np.eye(4) if self.parent is None else self.parent.motion()
        if not self.rest:
            return moved
        own = np.eye(4)
        own[:3, :3] = rotation_about(self.axis, self.rest)
        own[:3, 3] = self.origin - own[:3, :3] @ self.origin
        return np.asarray(moved @ own)

    @property
    def leans(self) -> bool:
        """Whether it is left at another value than 0, or what it hangs on is."""
        return bool(self.rest) or (self.parent is not None and self.parent.leans)


class Hanging(TypedDict, total=False):
    """How a part hangs: ``on`` which other one, in which ``look`` (its parent's), on which face."""

    on: PartDraft | None
    look: Material | None
    place: Placement | None


class Assembly(Chance):
    """A body and what moves on it; every kind of object is described by adding to one.

    Attributes:
        root: the part that does not move, ``body``.
        parts: the others, parents before children.
        hairline: every form ends this far short of what was said [m], so that forms that meet share
            no corner.
    """

    def __init__(self, rng: np.random.Generator, hairline: float = 0.0) -> None:
        super().__init__(rng)
        self.root = PartDraft("body", WHITE)
        self.parts: list[PartDraft] = []
        self.hairline = hairline

    def body(self, look: Material) -> PartDraft:
        """The part that does not move, from now on in this look."""
        self.root.look = look
        return self.root

    def hinge(
        self,
        name: str,
        axis: Point,
        at: Point,
        upper: float,
        lower: float = 0.0,
        slide: float = 0.0,
        rest: float = 0.0,
        **how: Unpack[Hanging],
    ) -> PartDraft:
        """A part that turns between ``lower`` and ``upper`` [rad]; see :class:`PartDraft`."""
        part = self._hung(name, JointKind.REVOLUTE, axis, at, (lower, upper), **how)
        part.slide = slide
        part.rest = rest
        return part

    def spin(
        self, name: str, axis: Point, at: Point, slide: float = 0.0, **how: Unpack[Hanging]
    ) -> PartDraft:
        """A part that turns without end; see :class:`PartDraft`."""
        part = self._hung(name, JointKind.CONTINUOUS, axis, at, (-np.pi, np.pi), **how)
        part.slide = slide
        return part

    def slider(
        self, name: str, axis: Point, at: Point, upper: float, **how: Unpack[Hanging]
    ) -> PartDraft:
        """A part that slides by up to ``upper`` [m]; see :class:`PartDraft`."""
        return self._hung(name, JointKind.PRISMATIC, axis, at, (0.0, upper), **how)

    def _hung(
        self,
        name: str,
        kind: JointKind,
        axis: Point,
        at: Point,
        limits: tuple[float, float],
        on: PartDraft | None = None,
        look: Material | None = None,
        place: Placement | None = None,
    ) -> PartDraft:
        parent, face = on or self.root, place or HERE
        part = PartDraft(name, look or parent.look, parent, kind)
        part.axis, part.origin = face.direction(axis), face.point(at)
        part.lower, part.upper = limits
        part.place = place
        self.parts.append(part)
        return part

    def articulation(self) -> Articulation:
        """The object; it comes to stand on z = 0, centred over the origin, everything at rest."""
        drafts = [self.root, *self.parts]
        vertices, faces, look, materials = _joined(drafts, self.hairline)
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        offset = -np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
        uv = laid_over(vertices[faces], look, materials)
        mesh = Mesh(vertices + offset, faces, uv, None, look, materials)
        ends = np.cumsum([draft.face_count for draft in drafts]).tolist()
        parts = [Part("body", np.arange(ends[0]))]
        joints: list[Joint] = []
        number = {id(self.root): 0}
        for draft, start, end in zip(self.parts, ends[:-1], ends[1:], strict=True):
            joints += _joints(draft, number[id(draft.parent)], len(parts), offset)
            if draft.slide > 0.0:
                parts.append(Part(f"{draft.name}_carrier", np.zeros(0, dtype=np.int64)))
            number[id(draft)] = len(parts)
            parts.append(Part(draft.name, np.arange(start, end)))
        return Articulation(mesh, tuple(parts), tuple(joints), "procedural")


def _joints(draft: PartDraft, parent: int, child: int, offset: FloatArray) -> list[Joint]:
    """The joint of a part, or that of its carrier and its own; ``child`` is the first one's."""
    name, axis, origin = f"{draft.name}_joint", draft.axis, draft.origin
    if draft.leans:
        motion = draft.motion()
        axis, origin = motion[:3, :3] @ axis, motion[:3, :3] @ origin + motion[:3, 3]
    origin = origin + offset
    limits = (draft.lower - draft.rest, draft.upper - draft.rest)
    if draft.slide <= 0.0:
        return [Joint(name, draft.kind, parent, child, axis, origin, *limits)]
    slide = (JointKind.PRISMATIC, child, child + 1, axis, origin, 0.0, draft.slide)
    return [
        Joint(f"{name}_turn", draft.kind, parent, child, axis, origin, *limits),
        Joint(name, *slide),
    ]


def _joined(
    drafts: list[PartDraft], hairline: float
) -> tuple[FloatArray, IntArray, IntArray, tuple[Material, ...]]:
    """Vertices, faces, the material of each face, and materials; parts in order."""
    vertices: list[FloatArray] = []
    faces: list[IntArray] = []
    looks: list[int] = []
    materials: dict[str, Material] = {}
    place: dict[str, int] = {}
    count = 0
    for draft in drafts:
        motion = draft.motion() if draft.leans else None
        for form, material in draft.forms:
            looks.append(place.setdefault(material.name, len(place)))
            materials.setdefault(material.name, material)
            corners = _shrunk(form.vertices, hairline) if hairline else form.vertices
            if motion is not None:
                corners = corners @ motion[:3, :3].T + motion[:3, 3]
            vertices.append(corners)
            faces.append(form.faces + count)
            count += len(corners)
    look = np.repeat(looks, [len(each) for each in faces])
    return np.concatenate(vertices), np.concatenate(faces), look, tuple(materials.values())


def _shrunk(corners: FloatArray, reach: float) -> FloatArray:
    """A form that ends ``reach`` short of its box on every side [m]."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle, half = (low + high) / 2, (high - low) / 2
    return np.asarray(middle + (corners - middle) * np.maximum(1.0 - reach / half, 0.5))
