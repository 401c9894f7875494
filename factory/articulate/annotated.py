"""The articulator that believes an annotation: a imported URDF or MJCF, or a prediction file."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from asset_factory.sim_checks.description import ABSURD, Mimic, sensible

from ..articulation import RESERVED_PART_NAME, Articulation, Joint, JointKind, Part
from ..config import BuildConfig
from ..errors import InputRejected, InvalidArticulation
from ..geometry.posing import UP
from ..intake.annotation import AnnotatedJoint, Annotation
from ..intake.importers.prediction import read_prediction
from ..intake.intake import Intake
from ..mesh import FloatArray, IntArray, Mesh, distinct_names, freeze
from ..part import Proposer
from .coupling import moving_together, resting_values, with_common_motion, with_sound_mimics
from .draft import Draft, ordered
from .locate import sourced
from .ranges import closed_at_lower, sound_limits, with_zero_inside, without_still_joints
from .welding import unlabelled_to_root, welded, without_empty_leaves

#: Annotations of this source may speak of several trees; a description may not.
FORESTS = ("pred.npz",)
#: Shorter axes have no direction.
MIN_AXIS = 1e-9
#: Letters of a part's or joint's name that are kept.
LONGEST_NAME = 200
#: A slide whose limits are missing goes by this share of the length of what it moves.
TRAVEL_SHARE = 0.5


def annotation_of(intake: Intake) -> Annotation | None:
    """Return the parts and joints that came with an input; ``None`` if none did.

    Raises:
        InputRejected: ``bad_annotation``: a file of them lies there and cannot be used.
    """
    if intake.annotation is not None or intake.annotation_path is None:
        return intake.annotation
    faces = int(intake.source_faces.max()) + 1
    return read_prediction(intake.annotation_path, faces, intake.annotation_data)


def annotated_articulator(intake: Intake) -> AnnotatedArticulator | None:
    """Return the articulator that believes what came with an input; ``None`` if nothing did.

    Raises:
        InputRejected: as :func:`annotation_of` does.
    """
    annotation = annotation_of(intake)
    if annotation is None:
        return None
    return AnnotatedArticulator(annotation, intake.transform, intake.source_faces, lenient=True)


def articulator_for(intake: Intake, config: BuildConfig) -> AnnotatedArticulator:
    """Return who believes the annotation of an input. Raises InputRejected ``no_annotation``."""
    articulator = annotated_articulator(intake)
    if articulator is None:
        raise InputRejected(
            "no_annotation",
            f"{intake.provenance.input}: has no parts and joints of its own; want a URDF, an MJCF, "
            "or a sidecar naming a pred.npz, or another articulator",
        )
    return articulator


@dataclass(frozen=True)
class AnnotatedArticulator:
    """Makes a valid tree of an annotation; every departure from it is a note.

    Attributes:
        annotation: parts and joints in the input's frame and units.
        transform: input frame to object frame (rotation, uniform scale, translation), shape [4, 4].
        source_faces: for each face of the mesh its index in the input's face order, shape
            [face_count].
        lenient: a slide whose limits are missing gets usual ones, instead of a rejection.
    """

    name = "annotated"

    annotation: Annotation
    transform: FloatArray
    source_faces: IntArray
    lenient: bool = False

    def __post_init__(self) -> None:
        freeze(self, "transform")
        freeze(self, "source_faces", dtype=np.int64)
        linear = self.transform[:3, :3]
        scale = self.scale
        if not scale > 0.0 or not np.allclose(linear @ linear.T / scale**2, np.eye(3), atol=1e-6):
            raise ValueError("transform: want a rotation with a uniform, positive scale")

    @property
    def scale(self) -> float:
        """Return object units per input unit of length."""
        return float(np.cbrt(np.linalg.det(self.transform[:3, :3])))

    def articulate(self, mesh: Mesh) -> Articulation:
        """Return the annotated tree: object frame [m], input pose at zero, lower = closed.

        Args:
            mesh: object frame [m]; its faces are those that ``source_faces`` speaks of.

        Raises:
            InputRejected: ``not_a_tree``, ``no_limits``, ``bad_axis``, ``unsupported_joint``,
                ``bad_annotation``.
        """
        try:
            with np.errstate(all="ignore"):
                return self._articulated(mesh)
        except InvalidArticulation as error:
            raise InputRejected(
                "bad_annotation", f"its parts and joints make no tree that moves: {error}"
            ) from error

    def _articulated(self, mesh: Mesh) -> Articulation:
        draft = self._drafted(mesh)
        draft = ordered(draft, forest=self.annotation.source in FORESTS)
        draft = unlabelled_to_root(draft)
        draft = with_sound_mimics(draft)
        draft, moved = resting_values(draft)
        draft = with_zero_inside(draft, moved)
        draft = without_still_joints(draft)
        draft = welded(draft)
        draft = without_empty_leaves(draft)
        draft = with_common_motion(draft)
        draft = closed_at_lower(draft, frozenset(moved))
        draft = moving_together(draft)
        if not draft.joints:
            draft = draft.noting("nothing in this object moves")
        return sourced(_finished(draft, self.name), Proposer.ANNOTATION)

    def _drafted(self, mesh: Mesh) -> Draft:
        if len(self.source_faces) != len(mesh.faces):
            raise ValueError(f"{len(mesh.faces)} faces for {len(self.source_faces)} source faces")
        labels = self.annotation.face_part[self.source_faces]
        names = list(self.annotation.part_names)
        single: list[AnnotatedJoint] = []
        notes: list[str] = []
        for joint in self.annotation.joints:
            if joint.kind == "both":
                single += _turn_then_slide(joint, carrier=len(names))
                names.append(f"{names[joint.child]}_carrier")
                notes.append(
                    f"joint {joint.name!r} turns and slides: "
                    "made two joints with an empty part between them"
                )
            else:
                single.append(joint)
        joints = []
        single = _with_leaders_limits(single)
        unique = _unique([joint.name for joint in single], "joint")
        for joint, name in zip(single, unique, strict=True):
            travel = self._usual_travel(mesh, labels, joint) if self.lenient else None
            ended = joint if travel is None else replace(joint, lower=0.0, upper=travel)
            if travel is not None:
                notes.append(
                    f"joint {name!r} has no limits: taken to slide by {travel * self.scale:.4g} m, "
                    f"{TRAVEL_SHARE:.0%} of the length of what it moves"
                )
            made, said = self._joint(ended, name)
            joints.append(made)
            notes += said
        joints = _coupled(single, joints, self.scale)
        if self.scale != 1.0 and any(j.damping or j.friction for j in joints):
            notes.append(f"scaled by {self.scale:.6g}; damping and friction are kept as annotated")
        return Draft(mesh, labels, tuple(names), tuple(joints), tuple(notes))

    def _usual_travel(self, mesh: Mesh, labels: IntArray, joint: AnnotatedJoint) -> float | None:
        """Return how far a slide without limits goes, in input units; ``None`` if it has some."""
        faces = mesh.faces[labels == joint.child]
        absent = joint.lower is None and joint.upper is None
        if joint.kind != "prismatic" or not absent or not len(faces):
            return None
        along = mesh.vertices[np.unique(faces)] @ self._direction(joint.axis, joint.name)
        return TRAVEL_SHARE * float(np.ptp(along)) / self.scale or None

    def _joint(self, joint: AnnotatedJoint, name: str) -> tuple[Joint, list[str]]:
        kind, lower, upper, notes = sound_limits(
            name, joint.kind, _limit(joint.lower), _limit(joint.upper)
        )
        axis = UP if kind is JointKind.FIXED else self._direction(joint.axis, name)
        length = self.scale if kind is JointKind.PRISMATIC else 1.0
        for what, said in (("damping", joint.damping), ("friction", joint.friction)):
            if said is not None and _usable(said) is None:
                notes.append(
                    f"joint {name!r}: {what} of {said} is ignored; "
                    "want a finite number of at least 0"
                )
        made = Joint(
            name=name,
            kind=kind,
            parent=joint.parent,
            child=joint.child,
            axis=axis,
            origin=self._place(joint.origin, name),
            lower=lower * length,
            upper=upper * length,
            damping=_usable(joint.damping),
            friction=_usable(joint.friction),
        )
        return made, notes

    def _direction(self, axis: npt.ArrayLike, name: str) -> FloatArray:
        given = np.asarray(axis, dtype=np.float64)
        length = float(np.linalg.norm(given))
        if not (np.isfinite(given).all() and length > MIN_AXIS):
            raise InputRejected(
                "bad_axis", f"joint {name!r}: its axis is {given.tolist()}, want a direction"
            )
        turned = self.transform[:3, :3] @ (given / length)
        return np.asarray(turned / np.linalg.norm(turned))

    def _place(self, origin: FloatArray, name: str) -> FloatArray:
        place = self.transform[:3, :3] @ origin + self.transform[:3, 3]
        if not sensible(place):
            raise InputRejected(
                "bad_axis",
                f"joint {name!r}: its axis lies at {place.tolist()} m; want up to {ABSURD:g}",
            )
        return np.asarray(place)


def _turn_then_slide(joint: AnnotatedJoint, carrier: int) -> tuple[AnnotatedJoint, AnnotatedJoint]:
    """Return ``both`` as two joints: the part slides in a carrier that turns, so that turns too."""
    if joint.slide_axis is None:
        raise InputRejected(
            "bad_axis", f"joint {joint.name!r}: turns and slides but has no direction to slide in"
        )
    turn = replace(
        joint, name=f"{joint.name}_turn", kind="revolute", child=carrier, slide_axis=None
    )
    slide = replace(
        joint,
        name=f"{joint.name}_slide",
        kind="prismatic",
        parent=carrier,
        axis=joint.slide_axis,
        lower=joint.slide_lower,
        upper=joint.slide_upper,
        slide_axis=None,
    )
    return turn, slide


def _with_leaders_limits(joints: list[AnnotatedJoint]) -> list[AnnotatedJoint]:
    """Return the joints; a follower without limits has those that its leader's give it."""
    named = {joint.name: joint for joint in joints}

    def limited(joint: AnnotatedJoint) -> AnnotatedJoint:
        mimic = joint.mimic
        leader = named.get(mimic.leader) if mimic is not None else None
        unlimited = joint.lower is None and joint.upper is None
        if mimic is None or leader is None or not unlimited or joint.kind == "fixed":
            return joint
        if leader.lower is None or leader.upper is None:
            return joint
        lower, upper = sorted(
            mimic.multiplier * end + mimic.offset for end in (leader.lower, leader.upper)
        )
        kind = "revolute" if joint.kind == "continuous" else joint.kind
        return replace(joint, kind=kind, lower=lower, upper=upper)

    return [limited(joint) for joint in joints]


def _coupled(annotated: list[AnnotatedJoint], joints: list[Joint], scale: float) -> list[Joint]:
    """Return the joints with what they follow, by the leaders' new names and in metres."""
    made = {each.name: joint for each, joint in zip(annotated, joints, strict=True)}

    def unit(joint: Joint) -> float:
        return scale if joint.kind is JointKind.PRISMATIC else 1.0

    result = []
    for each, joint in zip(annotated, joints, strict=True):
        mimic = each.mimic
        if mimic is not None:
            leader = made.get(mimic.leader)
            rate = 1.0 if leader is None else unit(joint) / unit(leader)
            name = "" if leader is None else leader.name
            mimic = Mimic(name, mimic.multiplier * rate, mimic.offset * unit(joint))
        result.append(replace(joint, mimic=mimic))
    return result


def _limit(value: float | None) -> float | None:
    """Return a limit as annotated; one that nothing ever reaches is none."""
    return value if value is None or abs(value) <= ABSURD else float("inf") * np.sign(value)


def _usable(value: float | None) -> float | None:
    return value if value is not None and np.isfinite(value) and value >= 0.0 else None


def _unique(names: list[str], fallback: str) -> list[str]:
    """Return names of allowed characters, with numbers where they are equal or reserved."""
    clean = (re.sub(r"[^A-Za-z0-9_.-]", "_", name[:LONGEST_NAME]) or fallback for name in names)
    return distinct_names(clean, (RESERVED_PART_NAME,))


def _finished(draft: Draft, articulator: str) -> Articulation:
    """Return the parts in tree order, link origins beside their geometry."""
    order = [draft.root, *(joint.child for joint in draft.joints)]
    position = {part: index for index, part in enumerate(order)}
    names = _unique([draft.names[part] for part in order], "part")
    parts = tuple(
        Part(name, np.flatnonzero(draft.face_part == part))
        for part, name in zip(order, names, strict=True)
    )
    joints = tuple(
        replace(
            joint,
            parent=position[joint.parent],
            child=position[joint.child],
            axis=joint.axis / np.linalg.norm(joint.axis),
            origin=_origin(draft, joint),
        )
        for joint in draft.joints
    )
    called = [
        f"{old!r} is {new!r}"
        for old, new in zip((draft.names[part] for part in order), names, strict=True)
        if old != new
    ]
    notes = (*draft.notes, *([f"parts renamed: {', '.join(called)}"] if called else []))
    return Articulation(draft.mesh, parts, joints, articulator, notes)


def _origin(draft: Draft, joint: Joint) -> FloatArray:
    """Return the centre of what the joint carries first; of a hinge, its axis' nearest point."""
    own = draft.face_part == joint.child
    faces = own if own.any() else np.isin(draft.face_part, list(draft.subtree(joint.child)))
    points = draft.mesh.vertices[np.unique(draft.mesh.faces[faces])]
    center = (points.min(axis=0) + points.max(axis=0)) / 2.0
    if not joint.turns:
        return np.asarray(center)
    return np.asarray(joint.origin + joint.axis * float(joint.axis @ (center - joint.origin)))
