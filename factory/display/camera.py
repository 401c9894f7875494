"""Where the camera stands: in front of what opens, a little to the side and above."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..mesh import FloatArray
from .scene import SceneGraph, SceneSurface

#: To the side of the front, and above [rad].
ASIDE = 0.60
ABOVE = 0.38
#: Half the vertical field of view [rad]: a long lens, so that upright edges stay nearly upright.
HALF_FIELD = 0.20
#: Free space around the object, a share of the picture's half.
MARGIN = 0.06
#: How far joints are opened to see which side is the front, a share of their ranges.
AJAR = 0.15
_FRONTS = np.array([[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])


@dataclass(frozen=True)
class Camera:
    """A perspective camera.

    Attributes:
        eye: where it stands, root frame [m], shape [3].
        axes: its right, up and backward directions as rows, shape [3, 3].
        width, height: of the picture [pixels].
        spread: half the picture's height at a distance of 1 m [m].
    """

    eye: FloatArray
    axes: FloatArray
    width: int
    height: int
    spread: float

    def rays(self, pixels: FloatArray) -> FloatArray:
        """Return directions through places in the picture, not normalised: depth is along the lens.

        Args:
            pixels: column and row, 0.5 in the middle of the first, shape [count, 2].
        """
        scale = 2.0 * self.spread / self.height
        corner = scale * (self.height * self.axes[1] - self.width * self.axes[0]) / 2.0
        steps = scale * np.stack([self.axes[0], -self.axes[1]])
        return np.asarray(pixels @ steps + (corner - self.axes[2]))

    def places(self, points: FloatArray) -> FloatArray:
        """Return column, row and depth [m] of points in the root frame, shape [count, 3]."""
        local = (points - self.eye) @ self.axes.T
        depth = np.maximum(-local[:, 2], 1e-9)
        scale = self.height / (2.0 * self.spread * depth)
        column = self.width / 2.0 + local[:, 0] * scale
        row = self.height / 2.0 - local[:, 1] * scale
        return np.stack([column, row, depth], axis=1)


def box_corners(surfaces: Sequence[SceneSurface]) -> FloatArray:
    """Return the corners of the box around surfaces of one link, link frame [m], shape [8, 3]."""
    low = np.min([surface.vertices.min(axis=0) for surface in surfaces], axis=0)
    high = np.max([surface.vertices.max(axis=0) for surface in surfaces], axis=0)
    picks = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, -1).T
    return np.asarray(np.where(picks, high, low), dtype=np.float64)


class Viewpoint:
    """In front of what opens, to the side from which its inside is seen, and above.

    Attributes:
        axes: right, up and backward directions of every camera there, as rows, shape [3, 3].
    """

    def __init__(self, scene: SceneGraph) -> None:
        self._scene = scene
        shown = [each for each in scene.visuals or scene.hulls if len(each.vertices)]
        links = sorted({surface.link for surface in shown})
        self._boxes = {
            link: box_corners([each for each in shown if each.link == link]) for link in links
        }
        front, side = self._front()
        self.axes = _axes_turned(side * ASIDE, front)

    def camera(
        self, width: int, height: int, *poses: Mapping[str, float], turn: float | None = None
    ) -> Camera:
        """Return the nearest camera that has all of the object in its picture.

        Args:
            width: of the picture [pixels].
            height: of the picture [pixels].
            poses: joint values [rad] or [m] of every pose to be seen; none: all from closed to
                open.
            turn: stand elsewhere: so far around from +X, counterclockwise from above [rad].
        """
        wanted = poses or tuple(self._scene.opened(amount) for amount in (0.0, 0.5, 1.0))
        boxes = [box for values in wanted for box in self._placed(values)]
        corners = np.concatenate(boxes or [np.zeros((1, 3))])
        axes = self.axes if turn is None else _axes_turned(turn, np.array([1.0, 0.0]))
        return _fitted(corners, axes, width, height)

    def _placed(self, values: Mapping[str, float]) -> list[FloatArray]:
        """Return the corners of each link's box in a pose, root frame [m], shape [8, 3] each."""
        poses = self._scene.poses(values)
        boxes = self._boxes.items()
        return [box @ poses[link, :3, :3].T + poses[link, :3, 3] for link, box in boxes]

    def _front(self) -> tuple[FloatArray, float]:
        """Return the side that opens, a horizontal unit direction, shape [2], and where to stand.

        Moving parts are in front, and come forward first; a door swings aside later. A part that
        rises first is a lid, and goes back. 1: seen from the right, -1: from the left.
        """
        rest = self._scene.opened(0.0)
        opened = self._scene.opened(1.0)
        ajar = {name: value + AJAR * (opened[name] - value) for name, value in rest.items()}
        poses = [self._placed(values) for values in (rest, ajar, opened)]
        pairs = enumerate(zip(poses[0], poses[2], strict=True))
        moved = [index for index, (box, end) in pairs if not np.allclose(box, end)]
        if not moved:
            return _FRONTS[0], 1.0
        of_moved = ([pose[index] for index in moved] for pose in poses)
        start, first, end = (np.mean(boxes, axis=(0, 1)) for boxes in of_moved)
        step = first - start
        forward = step[:2] if step[2] <= np.hypot(*step[:2]) else (start - end)[:2]
        whole = np.concatenate(poses[0])[:, :2]
        offset = start[:2] - (whole.min(axis=0) + whole.max(axis=0)) / 2.0
        agree = np.round(_FRONTS @ (forward + offset), 6)
        front = _FRONTS[int(np.argmax(agree))] if agree.max() > 0.0 else _FRONTS[0]
        aside = (end - start)[:2] @ [-front[1], front[0]]
        return front, -1.0 if aside > 1e-3 else 1.0


def _axes_turned(turn: float, front: FloatArray) -> FloatArray:
    """Return a camera's axes, turned from a horizontal direction by an angle [rad], and above."""
    flat = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]) @ front
    backward = np.array([*(flat * np.cos(ABOVE)), np.sin(ABOVE)])
    right = np.cross([0.0, 0.0, 1.0], backward)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(backward, right), backward])


def _fitted(points: FloatArray, axes: FloatArray, width: int, height: int) -> Camera:
    """Return the nearest camera of those directions that holds all points."""
    spread = float(np.tan(HALF_FIELD))
    half = np.array([spread * width / height, spread]) * (1.0 - MARGIN)
    local = points @ axes.T
    # A point on the border of the picture has |offset| = half * distance from the eye.
    outer = np.max(local[:, :2] + half * local[:, 2:], axis=0)
    inner = np.max(-local[:, :2] + half * local[:, 2:], axis=0)
    distances = (outer + inner) / (2.0 * half)
    nearest = float(local[:, 2].max()) + 1e-3
    eye = np.array([*(outer - inner) / 2.0, max(*distances, nearest)])
    return Camera(eye @ axes, axes, width, height, spread)
