"""An object under construction: a body, the parts that move on it, and the joints between them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TypedDict, Unpack

import numpy as np
import numpy.typing as npt

from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part
from asset_factory.factory.mesh import FloatArray, Material, Mesh, concatenate

from .axes import DOWN, LEFT, RIGHT, UP, Place, Point
from .chance import Chance
from .looks import WHITE, laid_over
from .shapes import Form
from .spans import Span, mid

#: Three numbers, in whatever form.
Vector = npt.ArrayLike
#: Edges of a front, and which way one turns that is hinged there; positive angles open towards -Y.
EDGES: dict[str, Point] = {"left": DOWN, "right": UP, "bottom": RIGHT, "top": LEFT}


@dataclass(eq=False)
class PartDraft:
    """A part and the joint that moves it, while it is built.

    Attributes:
        name: of the part; its joint is called ``<name>_joint``.
        look: of forms added without one.
        parent: the part that it hangs on; ``None`` for the body.
        kind, axis, origin: of its joint at rest [m]; positive values open.
        lower, upper: closed and fully open [rad] or [m]; not used where it turns without end.
        slide: how far the part also slides along its axis [m]; above 0, it hangs on a carrier
            without faces that turns, and slides in it.
        pose: from the object with everything at value 0 to how it is left, [4, 4]; or ``None``.
        carry: the same from the face that the part is described on.
        forms: what it consists of, as it is left, each with its look.
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
    pose: FloatArray | None = None
    carry: FloatArray | None = None
    forms: list[tuple[Form, Material]] = field(default_factory=list)

    def add(self, *forms: Form, look: Material | None = None) -> None:
        """Add forms to the part, in its own look or another."""
        seen = look or self.look
        for form in forms:
            self.forms.append((form if self.carry is None else form.moved(self.carry), seen))


class Hanging(TypedDict, total=False):
    """How a part hangs: ``on`` which other one, in which ``look`` (its parent's), on which face."""

    on: PartDraft | None
    look: Material | None
    place: Place | None


class Assembly(Chance):
    """A body and its moving parts; every kind of object is described by adding to one.

    Attributes:
        root: the part that does not move, ``body``.
        parts: the others, parents before children.
        hairline: every form ends this far short [m], so that forms that meet share no corner.
    """

    def __init__(self, rng: np.random.Generator, hairline: float = 0.0) -> None:
        super().__init__(rng)
        self.root = PartDraft("body", WHITE)
        self.parts: list[PartDraft] = []
        self.hairline = hairline

    def body(self, look: Material, *forms: Form) -> PartDraft:
        """Return the part that does not move, from now on in this look, with more forms."""
        self.root.look = look
        self.root.add(*forms)
        return self.root

    def hinge(
        self,
        name: str,
        axis: Vector,
        at: Vector,
        upper: float,
        lower: float = 0.0,
        slide: float = 0.0,
        rest: float = 0.0,
        **how: Unpack[Hanging],
    ) -> PartDraft:
        """Add a part that turns between ``lower`` and ``upper`` [rad] and is left at ``rest``."""
        limits = (lower - rest, upper - rest)
        part = self._hung(name, JointKind.REVOLUTE, axis, at, limits, slide, **how)
        if rest:
            turn = Joint(name, part.kind, 0, 1, part.axis, part.origin).motion(rest)
            part.pose = _after(turn, part.pose)
            part.carry = _after(turn, part.carry)
        return part

    def swung(
        self, name: str, side: str, x: Span, z: Span, y: float, upper: float, **how: Unpack[Hanging]
    ) -> PartDraft:
        """Add a door or flap over ``x`` and ``z`` [m] that turns about an edge, towards -Y.

        ``side`` is the edge of the hinge, seen from the front: ``left``, ``right``, ``top`` or
        ``bottom``; its axis is at ``y`` [m], ``upper`` fully open [rad].
        """
        along = {"left": x[0], "right": x[1]}.get(side, mid(x))
        level = {"bottom": z[0], "top": z[1]}.get(side, mid(z))
        return self.hinge(name, EDGES[side], (along, y, level), upper, **how)

    def spin(
        self, name: str, axis: Vector, at: Vector, slide: float = 0.0, **how: Unpack[Hanging]
    ) -> PartDraft:
        """Add a part that turns without end, and slides along its axis by up to ``slide`` [m]."""
        return self._hung(name, JointKind.CONTINUOUS, axis, at, (-np.pi, np.pi), slide, **how)

    def slider(
        self, name: str, axis: Vector, at: Vector, upper: float, **how: Unpack[Hanging]
    ) -> PartDraft:
        """Return a part that slides by up to ``upper`` [m]."""
        return self._hung(name, JointKind.PRISMATIC, axis, at, (0.0, upper), **how)

    def screw(
        self, name: str, axis: Vector, at: Vector, reach: float, spin: float, **how: Unpack[Hanging]
    ) -> PartDraft:
        """Add a part that slides by up to ``reach`` [m], in a share ``spin`` of cases turns too."""
        if self.happens(spin):
            return self.spin(name, axis, at, reach, **how)
        return self.slider(name, axis, at, reach, **how)

    def _hung(
        self,
        name: str,
        kind: JointKind,
        axis: Vector,
        at: Vector,
        limits: Span,
        slide: float = 0.0,
        on: PartDraft | None = None,
        look: Material | None = None,
        place: Place | None = None,
    ) -> PartDraft:
        parent = on or self.root
        carry = _after(parent.pose, place)
        way = np.asarray(axis, dtype=np.float64)
        origin = np.asarray(at, dtype=np.float64)
        if carry is not None:
            way = carry[:3, :3] @ way
            origin = carry[:3, :3] @ origin + carry[:3, 3]
        joint = (kind, way, origin, *limits, slide)
        part = PartDraft(name, look or parent.look, parent, *joint, parent.pose, carry)
        self.parts.append(part)
        return part

    def articulation(self) -> Articulation:
        """Return the object, standing on z = 0, centred over the origin, everything at rest."""
        drafts = [self.root, *self.parts]
        looked = (each for draft in drafts for each in draft.forms)
        short = ((_shrunk(form.vertices, self.hairline), form.faces, look) for form, look in looked)
        whole = concatenate([Mesh.from_triangles(*each) for each in short])
        low, high = whole.bounds
        middle = (low + high) / 2
        offset = -np.array([middle[0], middle[1], low[2]])
        mesh = replace(whole, vertices=whole.vertices + offset, corner_uv=laid_over(whole))
        parts: list[Part] = []
        joints: list[Joint] = []
        number: dict[int, int] = {}
        start = 0
        for draft in drafts:
            if draft.parent:
                joints += _joints(draft, number[id(draft.parent)], len(parts), offset)
            if draft.slide > 0.0:
                parts.append(Part(f"{draft.name}_carrier", np.zeros(0, dtype=np.int64)))
            number[id(draft)] = len(parts)
            end = start + sum(len(form.faces) for form, _ in draft.forms)
            parts.append(Part(draft.name, np.arange(start, end)))
            start = end
        return Articulation(mesh, tuple(parts), tuple(joints), "procedural")


#: Describes one object of a kind, by adding to an empty assembly.
Maker = Callable[[Assembly], None]


def _after(second: FloatArray | None, first: FloatArray | None) -> FloatArray | None:
    """Return one motion after another, where ``None`` is no motion."""
    if first is None or second is None:
        return second if first is None else first
    return second @ first


def _joints(draft: PartDraft, parent: int, child: int, offset: FloatArray) -> list[Joint]:
    """Return the joint of a part, or its carrier's and its own; ``child`` is the first's."""
    name = f"{draft.name}_joint"
    line = (draft.axis, draft.origin + offset)
    if draft.slide <= 0.0:
        return [Joint(name, draft.kind, parent, child, *line, draft.lower, draft.upper)]
    return [
        Joint(f"{name}_turn", draft.kind, parent, child, *line, draft.lower, draft.upper),
        Joint(name, JointKind.PRISMATIC, child, child + 1, *line, 0.0, draft.slide),
    ]


def _shrunk(corners: FloatArray, reach: float) -> FloatArray:
    """Return a form that ends ``reach`` short of its box on every side [m]."""
    if not reach:
        return corners
    low = corners.min(axis=0)
    half = (corners.max(axis=0) - low) / 2
    middle = low + half
    return np.asarray(middle + (corners - middle) * np.maximum(1.0 - reach / half, 0.5))
