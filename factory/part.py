"""What a part is: its faces, its kind, its panel, and who proposed it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np

from .mesh import FloatArray, IntArray, freeze, read_only


class PartKind(StrEnum):
    """What a part is to whoever uses the object."""

    BODY = "body"
    """Stays where it is; the others hang on it."""
    PART = "part"
    """Moves, and nobody knows what it is."""
    DOOR = "door"
    DRAWER = "drawer"
    FLAP = "flap"
    """A panel of an upright side that is hinged at its lower or upper edge."""
    LID = "lid"
    SCREEN = "screen"
    """Of a laptop: hinged on what lies below it."""
    RACK = "rack"
    KNOB = "knob"
    BUTTON = "button"
    LEVER = "lever"
    CAP = "cap"
    WHEEL = "wheel"
    TURNTABLE = "turntable"

    @property
    def closes_side(self) -> bool:
        """Tell whether it is a panel that closes an upright side of an object."""
        return self in (PartKind.DOOR, PartKind.DRAWER, PartKind.FLAP)


class OpensBy(StrEnum):
    """How a panel opens, as the viewer sees it: the edge of its hinge, or outwards."""

    LEFT = "left"
    RIGHT = "right"
    BOTTOM = "bottom"
    TOP = "top"
    OUT = "out"


class Proposer(StrEnum):
    """Who says that a part moves."""

    ANNOTATION = "annotation"
    SIDECAR = "sidecar"
    RULES = "rules"
    SIDES = "sides"
    NETWORK = "network"
    VLM = "vlm"
    DETECTOR = "detector"


@dataclass(frozen=True)
class Panel:
    """The outline of what opens, in a frame of its own: right, up and away from the viewer.

    Attributes:
        frame: rows: to the right, up, and away from the viewer, unit vectors in the object frame,
            shape [3, 3].
        low, high: its rectangle, right and up [m], shape [2] each.
        front: how far away it begins [m].
        thickness: from its front to its back [m]; ``None`` where nobody knows.
        opens: the edge where it is hinged, or outwards where it slides.
    """

    frame: FloatArray
    low: FloatArray
    high: FloatArray
    front: float
    thickness: float | None
    opens: OpensBy

    def __post_init__(self) -> None:
        freeze(self, "frame", "low", "high")
        object.__setattr__(self, "front", float(self.front))
        object.__setattr__(self, "opens", OpensBy(self.opens))

    def has_box(self, back: float) -> bool:
        """Tell whether a drawer is more than its front: deeper than that is wide or high.

        Args:
            back: how far away the drawer ends [m].
        """
        return back - self.front > float((self.high - self.low).min())

    @property
    def outward(self) -> FloatArray:
        """Return the unit normal that points at the viewer, object frame, shape [3]."""
        return np.asarray(-self.frame[2])

    @property
    def size(self) -> FloatArray:
        """Return the width and the height [m], shape [2]."""
        return np.asarray(self.high - self.low)

    @property
    def center(self) -> FloatArray:
        """Return the middle of the front [m], object frame, shape [3]."""
        middle = (self.low + self.high) / 2.0
        return np.asarray(np.append(middle, self.front) @ self.frame)

    def turned(self, rotation: FloatArray) -> Panel:
        """Return the panel turned about the origin by ``rotation``, shape [3, 3]."""
        return replace(self, frame=self.frame @ rotation.T)


@dataclass(frozen=True)
class PartSource:
    """The proposal that a part comes from, so that a verdict can be traced back to it.

    Attributes:
        id: the same for the same proposal on every machine.
        proposer: who made it.
        probability: that there is such a part and that it moves so, 0 to 1; ``None`` where it was
            stated, or not rated.
        signs: what spoke for it, by name.
    """

    id: str
    proposer: Proposer
    probability: float | None = None
    signs: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "proposer", Proposer(self.proposer))


@dataclass(frozen=True)
class Part:
    """A rigid piece of the mesh, and what it is.

    Attributes:
        name: unique within the articulation; letters, digits, ``_``, ``-`` and ``.``; not
            ``world``.
        faces: indices into the articulation's mesh faces, shape [face_count], sorted. Empty for a
            carrier: the geometry-less link between the two joints of a part that turns *and*
                slides.
        confidence: that these faces are one part, 0 to 1, as the articulator rates itself; ``None``
            if it does not.
        kind: what it is.
        panel: its outline, where it closes an opening; ``None`` for other parts.
        source: the proposal that it comes from; ``None`` for what nobody proposed, as the body.
    """

    name: str
    faces: IntArray
    confidence: float | None = None
    kind: PartKind = PartKind.PART
    panel: Panel | None = None
    source: PartSource | None = None

    def __post_init__(self) -> None:
        object.__setattr__(
            self, "faces", read_only(np.unique(np.asarray(self.faces, dtype=np.int64)), np.int64)
        )
        object.__setattr__(self, "kind", PartKind(self.kind))

    def is_by(self, *proposers: Proposer) -> bool:
        """Tell whether one of these proposed it."""
        return self.source is not None and self.source.proposer in proposers

    def turned(self, rotation: FloatArray) -> Part:
        """Return the part of an object that is turned about the origin by ``rotation``, [3, 3]."""
        return replace(self, panel=None if self.panel is None else self.panel.turned(rotation))
