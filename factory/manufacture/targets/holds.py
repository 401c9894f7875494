"""Whether a hand can do it: close around a thing, hook behind it, or push."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ...articulation import Joint
from ...asset import Target
from ...mesh import FloatArray
from .gripper import GRIPPER
from .poses import Pose
from .shape import Moving
from .surroundings import HandView, Surroundings

#: What the kinds are worth beside each other.
WORTH = {"grasp": 1.0, "hook": 0.6, "push": 0.55}
#: Of the worth, for what is a little harder: not on a handle, by a hand that leans, or hardly
#: filling a grip; and for what is hard: a blocked palm, or coming from below.
HARDER = 0.8
HARD = 0.5
#: For widths that only the widest hand takes; a blocked arm; a hold by friction alone; and so low
#: that the hand would be in the ground.
WIDE = 0.6
ARM = 0.4
FRICTION = 0.75
IN_THE_GROUND = 0.3
#: Upward component of a normal below which a hand would have to come from below.
STRAIGHT_UP = -0.8
#: A hand that cannot come straight along an edge leans [rad]; past the edge, the tip reaching
#: behind it [m].
TILT = float(np.pi / 4)
EDGE_M = 0.012
TIP_M = 0.014
#: A hand that comes within this of the middle of a thing is centred by its fingers [m].
CENTRED_M = 1e-4
#: What the whole opening costs: of two ways to hold a thing the narrower is the surer.
NARROWER = 0.1
#: Thinner than this hardly fills a grip [m].
THIN_M = 0.002


@dataclass(frozen=True)
class HoldSearch:
    """A joint, the links that it moves, and their surroundings.

    Attributes:
        moving: the joint, and the part's surface.
        everything: around it.
    """

    moving: Moving
    everything: Surroundings

    def view(self, point: FloatArray, axes: FloatArray, reach: float = GRIPPER.reach) -> HandView:
        """Look at what a hand may meet at a point [m], shape [3], in a frame whose axes are rows.

        Things further off than ``reach`` along an axis of the object frame [m] are not seen.
        """
        low, high = self.everything.boxes
        rows = np.flatnonzero(((low <= point + reach) & (high >= point - reach)).all(axis=1))
        own = np.isin(self.everything.parts[rows], self.moving.shape.parts)
        return HandView(self.everything, point, axes, self.everything.triangles[rows], own)

    def target(
        self,
        kind: str,
        point: FloatArray,
        normal: FloatArray,
        fingers: FloatArray,
        worth: float,
        *,
        opening: float = 0.0,
        at: FloatArray | None = None,
    ) -> Target:
        """Return a place to hold, which a hand comes to against ``normal``.

        Args:
            kind: of the hold.
            point: where [m], shape [3].
            normal: unit, shape [3].
            fingers: unit direction along which they close, shape [3].
            worth: 0 to 1, wherever it is.
            opening: of the gripper [m].
            at: what of the part is pulled [m], shape [3]; by default the point.
        """
        pulled = point if at is None else at
        pull = self.moving.pull(pulled)
        score = WORTH[kind] * worth * self.worth(pulled, normal)
        held = (self.moving.joint.name, self.moving.shape.part)
        return Target(*held, kind, point, normal, pull, fingers, opening, score)

    def worth(self, point: FloatArray, normal: FloatArray) -> float:
        """Rate a place, 0 to 1: how well it is pulled there, and how easily reached."""
        worth = 0.25 + 0.75 * float(self.moving.place(point))
        if normal[2] < STRAIGHT_UP:
            worth *= HARD
        hand = point + normal * GRIPPER.length
        above_ground = hand[2] >= self.everything.bounds[0, 2] + GRIPPER.palm[1]
        return worth * (1.0 if above_ground else IN_THE_GROUND)

    def arm_is_free(self, point: FloatArray, axes: FloatArray) -> bool:
        """Tell whether what follows a palm gets out of the object, along the third axis."""
        low, high = self.everything.bounds
        ahead = axes[2]
        # Nothing lies further on in that direction than the box around everything.
        farthest = np.where(ahead > 0.0, high, low)
        end = min(float((farthest - point) @ ahead), GRIPPER.arm_reach)
        if end <= GRIPPER.length:
            return True
        half = GRIPPER.arm
        view = self.view(point, axes, GRIPPER.arm_reach)
        return view.free((-half, -half, GRIPPER.length), (half, half, end))


def grasp(task: HoldSearch, pose: Pose) -> Target | None:
    """Return the best way to close two fingers at a pose; ``None`` if there is none."""
    axes = [np.stack([each, np.cross(pose.normal, each), pose.normal]) for each in pose.fingers]
    view = task.view(pose.point, axes[0])
    return _best(_closed(task, pose, view.turned(each)) for each in axes)


def _closed(task: HoldSearch, pose: Pose, view: HandView) -> Target | None:
    half = GRIPPER.finger_width / 2.0
    window = GRIPPER.widest / 2.0 + GRIPPER.finger_thickness
    room = GRIPPER.finger_thickness + 2.0 * GRIPPER.play
    for depth, depth_worth in GRIPPER.depths:
        spans = view.spans((-window, -half, -depth), (window, half, GRIPPER.play), room)
        held = spans[(spans[:, 0] <= GRIPPER.play) & (spans[:, 1] >= -GRIPPER.play)]
        if len(held) != 1:
            continue
        low, high = held[0].tolist()
        if high - low > GRIPPER.widest - 2.0 * GRIPPER.play:
            continue
        sides = ((high, high + room), (low - room, low))
        if all(view.free((a, -half, -depth), (b, half, GRIPPER.length)) for a, b in sides):
            return _rated_grasp(task, pose, view, (low, high, depth), depth_worth)
    return None


def _rated_grasp(
    task: HoldSearch, pose: Pose, view: HandView, grip: tuple[float, float, float], worth: float
) -> Target | None:
    """Return a grip (lower and upper end between the fingers, and its depth [m]) as a hold."""
    low, high, depth = grip
    middle = (low + high) / 2.0
    width = high - low
    fingers = view.axes[0]
    normal = view.axes[2]
    point = pose.point if abs(middle) < CENTRED_M else _surface_at(view, middle, depth)
    # What turns between the fingers is held as well there as at its rim.
    spins = bool(task.moving.joint.turns and task.moving.lever(point) < width / 2.0)
    reach = point + fingers * width / 2.0 if spins else point
    if not task.moving.far_enough(reach):
        return None
    pull = task.moving.pull(reach)
    firm = max(
        abs(float(fingers @ pull)),
        float(normal @ pull) if pose.protrudes else 0.0,
        1.0 if spins else 0.0,
    )
    worth *= FRICTION + (1.0 - FRICTION) * firm
    worth *= 1.0 - NARROWER * width / GRIPPER.opening
    worth *= WIDE if width > GRIPPER.opening - 2.0 * GRIPPER.play else 1.0
    worth *= HARDER if width < THIN_M else 1.0
    worth *= 1.0 if pose.protrudes else HARDER
    if not _fits(view, GRIPPER.palm, middle, GRIPPER.finger_length - depth):
        worth *= HARD
    if not task.arm_is_free(point, view.axes):
        worth *= ARM
    return task.target("grasp", point, normal, fingers, worth, opening=width, at=reach)


def _surface_at(view: HandView, middle: float, depth: float) -> FloatArray:
    """Return the outermost own surface in the middle between the fingers [m], object frame."""
    sliver = 1e-3
    top = view.within((middle - sliver, -sliver, -depth), (middle + sliver, sliver, depth))
    height = float(top[:, :, 2].max()) if len(top) else 0.0
    return np.asarray(view.point + view.axes[0] * middle + view.axes[2] * height)


def exposed(task: HoldSearch, point: FloatArray, outward: FloatArray) -> bool:
    """Return whether there is any room for a fingertip before a point of the surface."""
    room = min(gap for gap, _ in GRIPPER.gaps)
    view = task.view(point, hand_axes(task.moving.joint, outward), 2.0 * room)
    half = room / 4.0
    return view.free((-half, -half, GRIPPER.off), (half, half, room))


def poke(task: HoldSearch, point: FloatArray, outward: FloatArray) -> Target | None:
    """Return how to push a place that faces against the opening: straight, hooked, or ``None``.

    ``point`` is on the surface [m] and ``outward`` its normal there, shape [3] each.
    """
    axes = hand_axes(task.moving.joint, outward)
    view = task.view(point, axes)
    half = GRIPPER.finger_width / 2.0
    if view.free((-half, -half, GRIPPER.off), (half, half, GRIPPER.length)):
        if not task.arm_is_free(point, axes):
            return None
        palms = (GRIPPER.palm, GRIPPER.palm[::-1])
        fits = any(_fits(view, palm, 0.0, GRIPPER.finger_length) for palm in palms)
        return task.target("push", point, outward, axes[0], 1.0 if fits else HARD)
    across = (axes[0], -axes[0], axes[1], -axes[1])
    return _best(_hooked(task, view, outward, ahead, 0.0) for ahead in across) or _best(
        _hooked(task, view, outward, ahead, TILT) for ahead in across
    )


def _best(holds: Iterable[Target | None]) -> Target | None:
    """Return the first hold that no later one beats; ``None`` if there is none."""
    found = [hold for hold in holds if hold is not None]
    return max(found, key=lambda hold: round(hold.score, 6), default=None)


def _hooked(
    task: HoldSearch, near: HandView, outward: FloatArray, ahead: FloatArray, tilt: float
) -> Target | None:
    """Return a finger that comes against ``ahead``, its side towards the surface.

    The hand comes from ``ahead``, across the surface's normal ``outward``, and leans out over the
    edge that it hooks by ``tilt`` [rad], as it must in a hollow.
    """
    away = np.cos(tilt) * ahead - np.sin(tilt) * outward
    axes = np.stack([np.cos(tilt) * outward + np.sin(tilt) * ahead, np.cross(ahead, outward), away])
    view = near.turned(axes)
    half = GRIPPER.finger_width / 2.0
    # Points lie within the edge; a leaning finger passes just outside it.
    start = (EDGE_M * np.sin(tilt), EDGE_M * np.cos(tilt)) if tilt else (0.0, 0.0)
    tip = start[1] - (TIP_M if tilt else 0.5 * half)
    side = start[0] + GRIPPER.off
    for gap, gap_worth in GRIPPER.gaps:
        # The tip passes the point: it hooks, rather than touches.
        if not view.free((side, -half, tip), (side + gap, half, GRIPPER.length)):
            continue
        if not task.arm_is_free(near.point, axes):
            return None
        free = _fits(view, GRIPPER.palm[::-1], start[0], tip + GRIPPER.finger_length)
        worth = gap_worth * (1.0 if free else HARD) * (HARDER if tilt else 1.0)
        return task.target("hook", near.point, away, axes[1], worth)
    return None


def _fits(view: HandView, palm: tuple[float, float], aside: float, base: float) -> bool:
    """Return whether a palm, half its sizes given, fits in from ``base`` on, ``aside`` [m]."""
    across, along = palm
    end = base + GRIPPER.palm_depth
    return view.free((aside - across, -along, base), (aside + across, along, end))


def hand_axes(joint: Joint, outward: FloatArray) -> FloatArray:
    """Return a hand's axes, as rows: across ``outward`` to fit a joint, and ``outward``."""
    for candidate in (joint.axis, *np.eye(3)[[2, 0, 1]]):
        side = candidate - (candidate @ outward) * outward
        if np.linalg.norm(side) > 0.3:
            side = side / np.linalg.norm(side)
            return np.stack([side, np.cross(outward, side), outward])
    raise AssertionError("three axes, one normal")
