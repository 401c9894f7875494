"""What articulators say: parts that may move, and how they move."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..articulation import Articulation, Joint, JointKind
from ..mesh import BoolArray, FloatArray, freeze
from ..part import Panel, PartKind, PartSource, Proposer

#: Digits of a metre or a radian, and of a proposal's digest, that its id depends on.
ID_DECIMALS = 6
ID_LENGTH = 12


@dataclass(frozen=True)
class Motion:
    """How a part moves, in the words of :class:`~asset_factory.factory.articulation.Joint`.

    Attributes:
        kind: revolute, continuous or prismatic.
        axis: unit direction, object frame, shape [3]; positive opens.
        origin: a point of the axis [m], shape [3].
        lower, upper: limits [rad] or [m]; 0 is the pose seen, the closed one unless a slide was
            seen to stand open.
    """

    kind: JointKind
    axis: FloatArray
    origin: FloatArray
    lower: float
    upper: float

    def __post_init__(self) -> None:
        freeze(self, "axis", "origin")

    @classmethod
    def endless(cls, axis: FloatArray, origin: FloatArray) -> Motion:
        """Return a turn without stops about an axis."""
        return cls(JointKind.CONTINUOUS, axis, origin, -np.pi, np.pi)

    def turned(self, rotation: FloatArray) -> Motion:
        """Return the motion turned about the origin by ``rotation``, shape [3, 3]."""
        return replace(self, axis=self.axis @ rotation.T, origin=self.origin @ rotation.T)


@dataclass(frozen=True)
class Proposal:
    """One part that may move, and how.

    Attributes:
        kind: what it is; names the part.
        faces: whether each face of the mesh belongs to it, shape [face_count].
        motion: relative to what it hangs on.
        signs: evidence for it, by name; see :data:`.auto.trust.SIGNS`.
        notes: assumptions, each the end of a sentence that starts with the part's name.
        slide: how it slides in what it turns with, if it does both; ``None`` if not.
        proposer: who makes it.
        panel: as in :class:`~asset_factory.factory.part.Part`, as far as it is known.
        existence: probability that there is such a part, 0 to 1; ``None`` if nobody rated it.
        probability: that there is such a part and that it moves so, likewise.
        name: of the part, where somebody says it; one of its own.
    """

    kind: PartKind
    faces: BoolArray = field(repr=False)
    motion: Motion
    signs: Mapping[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    slide: Motion | None = None
    proposer: Proposer = Proposer.RULES
    panel: Panel | None = None
    existence: float | None = None
    probability: float | None = None
    name: str | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "kind", PartKind(self.kind))
        freeze(self, "faces", dtype=np.bool_)

    @property
    def rated(self) -> float:
        """Return the probability; 0 until somebody rated it."""
        return self.probability or 0.0

    @property
    def source(self) -> PartSource:
        """Return what a part remembers of the proposal."""
        motions = [self.motion] if self.slide is None else [self.motion, self.slide]
        name = proposal_id(self.proposer, np.flatnonzero(self.faces), motions)
        return PartSource(name, self.proposer, self.probability, dict(self.signs))


def proposal_id(
    proposer: Proposer, faces: np.ndarray, motions: Sequence[Motion] | Sequence[Joint]
) -> str:
    """Return the id of a proposal: the same for the same part and motion on every machine.

    Args:
        proposer: who makes it.
        faces: indices of the part's faces, ascending.
        motions: of the part; two if it turns and slides.
    """
    digest = hashlib.sha256(np.asarray(faces, dtype="<i8").tobytes())
    for motion in motions:
        numbers = np.array([*motion.axis, *motion.origin, motion.lower, motion.upper])
        digest.update(motion.kind.encode())
        # Adding zero makes -0 and 0 one number.
        digest.update((np.round(numbers, ID_DECIMALS) + 0.0).astype("<f8").tobytes())
    return f"{proposer}-{digest.hexdigest()[:ID_LENGTH]}"


def probability_of(articulation: Articulation) -> float:
    """Return the probability that every joint is right, as if they were independent, 0 to 1.

    Joints that nobody rated count as certain.
    """
    rated = (joint.confidence for joint in articulation.movable_joints)
    return float(np.prod([chance for chance in rated if chance is not None]))
