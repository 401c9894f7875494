"""What a URDF or MJCF file says, before any simulator has had a chance to drop some of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]

#: No position [m], angle [rad] or ratio of a household thing is larger; whatever is, is a slip or
#: an attack.
ABSURD = 1e6


def sensible(values: npt.ArrayLike) -> bool:
    """Return whether every number is finite and no larger than :data:`ABSURD`."""
    # NaN compares as false.
    return bool((np.abs(np.asarray(values, dtype=np.float64)) <= ABSURD).all())


class DescriptionError(ValueError):
    """A file that cannot be read as a description.

    Attributes:
        code: stable reason code, e.g. ``missing_file``, ``outside_folder``, ``invalid_xml``.
        message: one sentence: what, where, what would work.
        places: where a file was looked for that is missing, or that is not to be read.
    """

    def __init__(self, code: str, message: str, places: Sequence[Path] = ()) -> None:
        super().__init__(code, message, places)
        self.code = code
        self.message = message
        self.places = tuple(places)

    def __str__(self) -> str:
        return f"{self.code}: {self.message}"


@dataclass(frozen=True)
class DescribedShape:
    """One visual or collision geometry, in its link's frame.

    Attributes:
        name: file name, or the primitive's kind.
        kind: ``mesh``, ``box``, ``cylinder``, ``sphere``, ``capsule``, ``ellipsoid``...
        vertices: [m], link frame, shape [vertex_count, 3]; primitives are tessellated.
        faces: triangles, shape [face_count, 3]. A mesh is kept as the file has it; engines collide
            with its convex hull.
        file: where a mesh came from, relative to the description's folder; ``None`` for primitives.
    """

    name: str
    kind: str
    vertices: FloatArray
    faces: IntArray
    file: str | None = None

    @property
    def corners(self) -> FloatArray:
        """Return the vertices that are a corner of some face [m], shape [corner_count, 3]."""
        return self.vertices[np.unique(self.faces)]


@dataclass(frozen=True)
class LinkInertia:
    """Mass [kg], centre of mass [m] and inertia about it [kg m2], in the link's frame and axes."""

    mass: float
    center: FloatArray
    tensor: FloatArray


@dataclass(frozen=True)
class Link:
    """A rigid body.

    Attributes:
        name: as in the file.
        inertia: ``None`` where the file gives none.
        collisions, visuals: in file order.
        virtual: True for a frame that the file does not name as a body, such as the place of an
            MJCF joint that does not pass through its body's origin.
    """

    name: str
    inertia: LinkInertia | None
    collisions: tuple[DescribedShape, ...]
    visuals: tuple[DescribedShape, ...]
    virtual: bool = False


@dataclass(frozen=True)
class Mimic:
    """A joint that follows another: ``value = multiplier * leader + offset`` [rad] or [m]."""

    leader: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class JointLine:
    """A joint as written.

    Attributes:
        name: as in the file.
        kind: ``fixed``, ``revolute``, ``continuous``, ``prismatic``, or the file's word for
            anything else.
        parent, child: link names.
        origin: child link frame in the parent link frame at joint value 0, shape [4, 4].
        axis: as written, not normalised, child frame, shape [3].
        lower, upper: [rad] or [m]; ``None`` where the file gives no limit.
        damping, friction: [N m s/rad, N m] or [N s/m, N]; 0 where absent.
        mimic: the joint that it follows (URDF ``<mimic>``, MJCF joint equality); ``None`` for a
            free one.
        effort, velocity: of a URDF limit, [N] or [N m], [m/s] or [rad/s]; ``None`` where absent.
    """

    name: str
    kind: str
    parent: str
    child: str
    origin: FloatArray
    axis: FloatArray
    lower: float | None
    upper: float | None
    damping: float = 0.0
    friction: float = 0.0
    mimic: Mimic | None = None
    effort: float | None = None
    velocity: float | None = None

    @property
    def unit(self) -> str:
        """Return the unit of its values."""
        return "m" if self.kind == "prismatic" else "rad"


@dataclass(frozen=True)
class Description:
    """A whole file.

    Attributes:
        path: where it was read from.
        format: ``urdf`` or ``mjcf``.
        links: in file order.
        joints: in file order; a file may hold anything, so this may be no tree.
        excluded: pairs of link names that the file forbids to collide (MJCF ``<exclude>``, SRDF).
    """

    path: Path
    format: str
    links: tuple[Link, ...]
    joints: tuple[JointLine, ...]
    excluded: frozenset[frozenset[str]] = frozenset()
