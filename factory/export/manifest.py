"""What an asset is, as data: ``asset.json``, written and read here."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

from asset_factory.sim_checks.description import Mimic

from ..articulation import JointKind, Weights
from ..asset import InnerSurface, StandingPlace
from ..runtime.packing import from_json

#: Raised when the meaning of a field changes.
SCHEMA = 1

Row = tuple[float, ...]


@dataclass(frozen=True)
class ManifestHandle:
    """Where to take hold of what a joint moves.

    Attributes:
        frame: name of the link in whose frame the point is.
        point: on its surface [m].
        normal: outward there, object frame.
        pull: in which direction a pull there opens the joint, object frame.
        source: how it was found.
    """

    frame: str
    point: Row
    normal: Row
    pull: Row
    source: str


@dataclass(frozen=True)
class ManifestJoint:
    """A joint; metres, radians, object frame with every joint at 0.

    Attributes:
        name, kind, parent, child: as in the URDF; the parts by their links' names.
        axis, origin: unit direction and a point of the axis [m].
        lower, upper, unit: limits [rad] or [m]; lower is closed.
        confidence: of whoever guessed it; ``None`` where it was stated.
        inertia, damping, friction: about or along the axis, SI units.
        default_damping, default_friction: whether the input said nothing of them.
        handle: where to take hold; ``None`` where nothing was found.
        placement: where a robot may stand to open it; ``None`` where nowhere was found.
        mimic: the joint that it moves with, at which ratio; the file leaves it out where it moves
            by itself.
    """

    name: str
    kind: JointKind
    parent: str
    child: str
    axis: Row
    origin: Row
    lower: float
    upper: float
    unit: str
    confidence: float | None
    inertia: float
    damping: float
    friction: float
    default_damping: bool
    default_friction: bool
    handle: ManifestHandle | None
    placement: StandingPlace | None
    mimic: Mimic | None = None

    @property
    def movable(self) -> bool:
        """Return whether it has a degree of freedom."""
        return self.kind is not JointKind.FIXED


@dataclass(frozen=True)
class ManifestTarget:
    """A way to open a joint, see :class:`~..asset.Target`; in the frame of the link ``part``."""

    joint: str
    part: str
    kind: str
    point: Row
    normal: Row
    pull: Row
    fingers: Row
    opening_m: float
    score: float


@dataclass(frozen=True)
class ManifestProposal:
    """Why a part moves, so that what becomes of it can be traced back.

    Attributes:
        id: of the proposal; the same on every machine.
        proposer: who made it.
        kind: what the part is.
        probability: of the proposal; ``None`` where it was stated, or not rated.
        signs: what spoke for it, by name.
    """

    id: str
    proposer: str
    kind: str
    probability: float | None
    signs: dict[str, float]

    @property
    def told(self) -> str:
        """Return it for people: who proposed it, how probable it is, and what spoke for it."""
        rated = "" if self.probability is None else f", probability {self.probability:.2f}"
        signs = ", ".join(f"{name} {value:g}" for name, value in self.signs.items())
        return f"{self.kind} {self.id} by {self.proposer}{rated}{f' ({signs})' if signs else ''}"


@dataclass(frozen=True)
class ManifestLink:
    """A link: its mass [kg], hulls and visual meshes, and their errors.

    ``proposal`` is ``None`` for what nobody proposed, as the body.
    """

    name: str
    confidence: float | None
    mass: float
    hulls: int
    max_hull_vertices: int
    max_hull_aspect: float
    visuals: int
    decomposition: str
    degraded: tuple[str, ...]
    proposal: ManifestProposal | None = None


@dataclass(frozen=True)
class ManifestProvenance:
    """The asset's origin, and assumptions about it; see :class:`~..intake.Provenance`."""

    input: str
    digest: str
    up: str
    up_source: str
    scale: float
    scale_source: str
    density: float | None
    dropped_degenerate: int
    dropped_non_finite: int
    weights: tuple[Weights, ...]


@dataclass(frozen=True)
class Manifest:
    """An asset; metres, kilograms, radians, object frame unless a field says otherwise.

    Attributes:
        name, category, license: of the input; ``None`` if unknown.
        urdf, mjcf: the descriptions' files.
        articulator: the source of parts and joints.
        proposers: whose proposals became its moving parts, sorted.
        scale: to be applied by a loader.
        fixed_base: whether the base is held in place.
        mass: of everything [kg].
        bounds, closed_bounds: box around the visible surface, every joint at 0 and at lower [m].
        ground_offset: height of the object frame at which the object stands on the ground [m].
        hulls: how many convex pieces.
        joints: parents first.
        links: in the URDF's order.
        targets: ways to open the joints.
        excluded_pairs: links that MuJoCo does not collide.
        provenance: where it came from.
        tools: versions of the libraries that made it; ``None``: not installed.
        notes: assumptions and changes, a sentence each.
        invented: surfaces that the input does not have; the file leaves the field out where there
            are none.
    """

    schema: int
    name: str
    category: str | None
    license: str | None
    urdf: str
    mjcf: str
    articulator: str
    scale: float
    fixed_base: bool
    mass: float
    bounds: tuple[Row, ...]
    closed_bounds: tuple[Row, ...]
    ground_offset: float
    hulls: int
    joints: tuple[ManifestJoint, ...]
    links: tuple[ManifestLink, ...]
    targets: tuple[ManifestTarget, ...]
    excluded_pairs: tuple[tuple[str, str], ...]
    provenance: ManifestProvenance
    tools: dict[str, str | None]
    notes: tuple[str, ...]
    invented: tuple[InnerSurface, ...] = ()
    proposers: tuple[str, ...] = ()

    @property
    def proposed(self) -> dict[str, ManifestProposal]:
        """Return the proposal of every link that somebody proposed, by the link's name."""
        return {link.name: link.proposal for link in self.links if link.proposal is not None}

    @property
    def movable(self) -> dict[str, ManifestJoint]:
        """Return every joint with a degree of freedom, by name."""
        return {joint.name: joint for joint in self.joints if joint.movable}

    @property
    def size(self) -> str:
        """Return width, depth and height of the closed object for people, in metres."""
        low, high = self.closed_bounds
        return " x ".join(f"{b - a:.2g}" for a, b in zip(low, high, strict=True))

    def to_json(self) -> str:
        """Return the file's text."""
        fields = asdict(self)
        sparing = [(joint, "mimic") for joint in fields["joints"]]
        sparing += [(weights, "outputs") for weights in fields["provenance"]["weights"]]
        for entry, name in [(fields, "invented"), *sparing]:
            if not entry[name]:
                del entry[name]
        return json.dumps(fields, indent=2, allow_nan=False) + "\n"

    @classmethod
    def from_json(cls, text: str | bytes) -> Manifest:
        """Return the inverse of :meth:`to_json`.

        Raises:
            ValueError: it is no manifest of this version; says why.
        """
        return from_json(cls, json.loads(text))
