"""Panels that stand open: found where they stick out of the body, and closed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ...articulation import Articulation, JointKind
from ...geometry.posing import face_parts, posed
from ...geometry.welding import welded
from ...mesh import FloatArray
from ...models.detector.canvas import KINDS
from ...models.detector.detect import Detection
from ...part import PartKind, Proposer
from ...views.raster import Side, side_facing
from ...views.view import View, Views
from ..assembly import JOINT_SUFFIX
from ..closing import note_open
from ..proposal import Motion
from ..seams.cutting import Region
from ..seams.placing import TURN, OpeningPart, cut_out
from .plates import Plate, Silhouette, sticking_out

#: Kinds of object that have panels on a side, and those that have a lid.
PANELLED = (
    "cabinet", "drawer_unit", "wardrobe", "fridge", "oven", "microwave", "dishwasher", "washer",
    "bin", "safe", "lockers", "kitchen",
)  # fmt: skip
LIDDED = ("chest", "case", "bin", "toilet", "crate", "barrel")
#: From this probability on an object is such a one, and has something that opens.
SURE = 0.8
#: Sides along which hinges lie, and how thick is thin; later ones only where nothing is found.
ALONG = (Side.RIGHT, Side.TOP, Side.FRONT)
THIN = (0.045, 0.07)
#: A plate stands open by such an angle [rad], from a face that it begins so near to, and that is
#: longer than it but for so much; share of the longer extent.
ANGLES = (np.radians(15.0), np.radians(150.0))
NEAR = 0.17
#: Of what it covers so much is hollow: deeper than its own thickness and this share of the longest
#: extent.
HOLLOW = 0.4
DEEP = 0.03
#: What is nearer to a face than this share of the longer extent stays with the body.
MARGIN = 0.004
#: Of 40 that were closed so on objects whose joints are known 39 were right.
CHANCE = 0.9


@dataclass(frozen=True, eq=False)
class _Closing:
    """How a plate closes, in the frame of the side that it is seen from.

    Attributes:
        plate: that stands open.
        outward: of the face that it closes, shape [2].
        toward: along the face, where its far end comes to lie, shape [2].
        face: where the face lies along ``outward`` [m].
        angle: by which it stands open [rad].
        hollow: share of what it covers that lies deeper.
    """

    plate: Plate
    outward: FloatArray
    toward: FloatArray
    face: float
    angle: float
    hollow: float


def open_panels(views: Views, detection: Detection, *, one_piece: bool) -> Articulation | None:
    """Return the object with the panels that stand open; ``None`` if none does.

    Their joints' lower limits close them; ``posing.closed`` does it.

    Args:
        views: of a mesh whose sides look along the axes.
        detection: what the detector says of it.
        one_piece: that it is such a mesh. Of others only lids are looked for: pieces that somebody
            modelled tell doors and flaps, and ``closing`` tells which of them stand open.
    """
    panelled, lidded = (
        float(detection.kinds[[KINDS.index(kind) for kind in kinds]].sum()) >= SURE
        for kinds in (PANELLED, LIDDED)
    )
    panelled = panelled and one_piece
    if detection.opens < SURE or not (panelled or lidded):
        return None
    for thin in THIN:
        seen = [each for side in ALONG if (each := sticking_out(views[side], thin)) is not None]
        found = [
            _opening(silhouette, closing)
            for silhouette in seen
            for plate in silhouette.plates
            if (closing := _closing(views, silhouette, plate, lids=lidded, panels=panelled))
        ]
        if found:
            made = cut_out(views.mesh, found, "", Proposer.DETECTOR, CHANCE)
            notes = tuple(
                note_open(f"a {made.parts[each.child].kind}", float(np.degrees(-each.lower)))
                for each in made.joints
            )
            return replace(made, notes=notes) if notes and len(made.parts[0].faces) else None
    return None


def _closing(
    views: Views, silhouette: Silhouette, plate: Plate, *, lids: bool, panels: bool
) -> _Closing | None:
    """Return how a plate closes best; ``None`` if it closes nothing."""
    likely = [
        each
        for each in _closings(views, silhouette, plate)
        if (lids if _faces(silhouette, each.outward) is Side.TOP else panels)
        and each.hollow >= HOLLOW
    ]
    return max(likely, key=lambda each: each.hollow, default=None)


def _faces(silhouette: Silhouette, outward: FloatArray) -> Side:
    """Return the side of the object that a face of the body looks to."""
    return side_facing(outward @ silhouette.side.frame[:2])


def _closings(views: Views, silhouette: Silhouette, plate: Plate) -> Iterator[_Closing]:
    """Yield the faces of a body that a plate may close, whatever they are like."""
    corners = np.stack([silhouette.low, silhouette.high])
    for outward in np.array([[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]]):
        side = _faces(silhouette, outward)
        face = float((corners @ outward).max())
        for toward in np.array([[-outward[1], outward[0]], [outward[1], -outward[0]]]):
            # From where the face begins to where it ends, seen from where the plate does.
            begin, end = np.sort(corners @ toward) - float(plate.root @ toward)
            off = abs(float(plate.inner(toward) @ outward) - face)
            beyond = max(off, begin, plate.length - end)
            angle = float(np.arccos(np.clip(plate.along @ toward, -1.0, 1.0)))
            if (
                side is not Side.BOTTOM
                and beyond < NEAR * silhouette.longest
                and plate.along @ outward > 0.0
                and ANGLES[0] < angle < ANGLES[1]
            ):
                closing = _Closing(plate, outward, toward, face, angle, 0.0)
                yield _looked_into(views[side], silhouette, closing)


def _looked_into(view: View, silhouette: Silhouette, closing: _Closing) -> _Closing:
    """Return a closing with how hollow what it covers is, and the depth of the rim around that."""
    plate = closing.plate
    *plane, away = silhouette.side.frame
    toward, outward = np.stack([closing.toward, closing.outward]) @ plane
    start = float(plate.root @ closing.toward)
    corners = view.raster.pixels(
        np.array(
            [
                reach * toward + closing.face * outward + depth * away
                for reach in (start, start + plate.length)
                for depth in plate.span
            ]
        )
    )
    low = np.maximum(np.floor(corners[:, :2].min(axis=0)).astype(np.int64), 0)
    high = np.ceil(corners[:, :2].max(axis=0)).astype(np.int64) + 1
    window = tuple(map(slice, low, high))
    depth = view.depth[window] - corners[0, 2]
    shallow = DEEP * float(view.mesh.extents.max())
    deep = max(shallow, float(np.ptp(plate.leaf)))
    # What is before the face, as the open panel is, hides what is behind it.
    known = depth > -shallow
    rim = depth[known & (depth <= deep)]
    hollow = 1.0 - len(rim) / max(int(known.sum()), 1)
    sunk = float(np.median(rim)) if len(rim) > 0.02 * depth.size else 0.0
    return replace(closing, hollow=hollow, face=closing.face - sunk)


def _opening(silhouette: Silhouette, closing: _Closing) -> OpeningPart:
    """Return the part that a plate is: what it fills, and how it turns from closed to open.

    It turns about where its inner side meets the face, or so much beside that it closes onto the
    face and not past its end.
    """
    plate = closing.plate
    *plane, away = silhouette.side.frame
    on = plate.inner(closing.toward)
    slope = float(plate.along @ closing.outward)
    pivot = on + (closing.face - float(on @ closing.outward)) / slope * plate.along
    # Turns a plate back: in the plane, as the pairs (along, across) -> (toward, its left).
    cosine = float(plate.along @ closing.toward)
    sine = float(plate.along[0] * closing.toward[1] - plate.along[1] * closing.toward[0])
    turn = np.array([[cosine, -sine], [sine, cosine]])
    root = turn @ (plate.root - pivot) + pivot
    start = min(silhouette.low @ closing.toward, silhouette.high @ closing.toward)
    past = max(float(start - root @ closing.toward), 0.0)
    pivot = pivot + np.linalg.solve(np.eye(2) - turn, past * closing.toward)
    across = plate.across @ plane
    # To the right and up run clockwise about what points away from the viewer.
    axis = -away if sine < 0.0 else away
    middle = float(plate.root @ plate.across)
    margin = MARGIN * silhouette.longest
    region = Region(
        np.stack([across, -across, -closing.outward @ plane, away, -away]),
        np.array(
            [
                middle + plate.whole[1],
                -middle - plate.whole[0],
                -closing.face - margin,
                plate.span[1] + margin,
                margin - plate.span[0],
            ]
        ),
    )
    motion = Motion(
        JointKind.REVOLUTE,
        axis,
        pivot @ plane + float(plate.span.mean()) * away,
        -closing.angle,
        max(TURN - closing.angle, 0.0),
    )
    if _faces(silhouette, closing.outward) is Side.TOP:
        kind = PartKind.LID
    else:
        kind = PartKind.DOOR if silhouette.side is Side.TOP else PartKind.FLAP
    return OpeningPart(kind, region, motion)


def reopened(made: Articulation, drawn: Articulation) -> Articulation:
    """Return an articulation with the panels that stand open as they are drawn."""
    values = {
        joint.name: min(-panel.lower, joint.upper)
        for panel in drawn.joints
        for joint in made.joints
        if np.allclose([joint.axis, joint.origin], [panel.axis, panel.origin])
    }
    return posed(made, values)


def with_closed(guess: Articulation, closed: Articulation) -> Articulation:
    """Return what a guess moves, and the closed panels in place of all that is where they are.

    Of a guess on another mesh than that of the panels nothing is taken.
    """
    if guess.mesh is not closed.mesh:
        return closed
    taken = face_parts(closed) > 0
    covered = [each.name for each in guess.joints if taken[guess.parts[each.child].faces].any()]
    guess = welded(guess, covered)
    parts = [replace(part, faces=part.faces[~taken[part.faces]]) for part in guess.parts]
    joints = list(guess.joints)
    for joint in closed.joints:
        part = closed.parts[joint.child]
        known = {each.name for each in parts}
        names = (f"{part.kind}_{count}" for count in range(len(parts)))
        name = next(each for each in names if each not in known)
        joints.append(replace(joint, name=f"{name}_{JOINT_SUFFIX[joint.kind]}", child=len(parts)))
        parts.append(replace(part, name=name))
    return replace(guess, parts=tuple(parts), joints=tuple(joints))
