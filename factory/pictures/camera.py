"""Where the camera stands: in front of what opens, a little to the side and above."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..mesh import FloatArray
from ..scene.scene import Scene, Surface

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
        """Directions through places in the picture, not normalised: depth is along the lens.

        Args:
            pixels: column and row, 0.5 in the middle of the first, shape [count, 2].
        """
        scale = 2.0 * self.spread / self.height
        right = (pixels[:, :1] - self.width / 2.0) * scale
        up = (self.height / 2.0 - pixels[:, 1:]) * scale
        return np.asarray(right * self.axes[0] + up * self.axes[1] - self.axes[2])

    def places(self, points: FloatArray) -> FloatArray:
        """Column, row and depth [m] of points in the root frame, shape [count, 3]."""
        local = (points - self.eye) @ self.axes.T
        depth = np.maximum(-local[:, 2], 1e-9)
        scale = self.height / (2.0 * self.spread * depth)
        return np.stack(
            [
                self.width / 2.0 + local[:, 0] * scale,
                self.height / 2.0 - local[:, 1] * scale,
                depth,
            ],
            axis=1,
        )


def box_corners(surfaces: Sequence[Surface]) -> FloatArray:
    """Corners of the box around surfaces of one link, link frame [m], shape [8, 3]."""
    low = np.min([surface.vertices.min(axis=0) for surface in surfaces], axis=0)
    high = np.max([surface.vertices.max(axis=0) for surface in surfaces], axis=0)
    picks = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, -1).T
    return np.asarray(np.where(picks, high, low), dtype=np.float64)


def camera_for(
    scene: Scene, width: int, height: int, poses: Sequence[Mapping[str, float]] = ()
) -> Camera:
    """A camera that sees the whole object from its front.

    Args:
        scene: what it sees.
        width: of the picture [pixels].
        height: of the picture [pixels].
        poses: in which all of the object is in the picture; none: closed, open and between.
    """
    surfaces = [each for each in scene.visuals or scene.hulls if len(each.vertices)]
    front, side = _front(scene, surfaces)
    turn = side * ASIDE
    flat = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]) @ front
    backward = np.array([*(flat * np.cos(ABOVE)), np.sin(ABOVE)])
    right = np.cross([0.0, 0.0, 1.0], backward)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(backward, right), backward])
    poses = poses or [scene.opened(amount) for amount in (0.0, 0.5, 1.0)]
    points = np.concatenate([_reached(scene, surfaces, values) for values in poses])
    return _fitted(points, axes, width, height)


def _reached(scene: Scene, surfaces: Sequence[Surface], values: Mapping[str, float]) -> FloatArray:
    """Corners of all links' boxes in a pose, root frame [m], shape [count, 3]."""
    poses = scene.poses(values)
    found = [np.zeros((1, 3))] if not surfaces else []
    for index, pose in enumerate(poses):
        own = [surface for surface in surfaces if surface.link == index]
        if own:
            found.append(box_corners(own) @ pose[:3, :3].T + pose[:3, 3])
    return np.concatenate(found)


def _front(scene: Scene, surfaces: Sequence[Surface]) -> tuple[FloatArray, float]:
    """The side that opens, a horizontal unit direction, shape [2], and where to stand of it.

    A door that opens comes forward first and swings aside later; 1: its inside is seen from the
    right, -1: from the left.
    """
    rest = scene.opened(0.0)
    ajar = {name: value + AJAR * (scene.opened(1.0)[name] - value) for name, value in rest.items()}
    shift = _shift(scene, surfaces, rest, ajar)
    agree = np.round(_FRONTS @ shift, 6)
    front = _FRONTS[int(np.argmax(agree))] if agree.max() > 0.0 else _FRONTS[0]
    aside = _shift(scene, surfaces, rest, scene.opened(1.0)) @ [-front[1], front[0]]
    return front, -1.0 if aside > 1e-3 else 1.0


def _shift(
    scene: Scene,
    surfaces: Sequence[Surface],
    before: Mapping[str, float],
    after: Mapping[str, float],
) -> FloatArray:
    """How far surfaces move between two poses, summed, horizontally, shape [2]."""
    start = scene.poses(before)
    end = scene.poses(after)
    shift = np.zeros(2)
    for surface in surfaces:
        middle = np.ptp(surface.vertices, axis=0) / 2.0 + surface.vertices.min(axis=0)
        moved = (end - start)[surface.link]
        shift += (moved[:3, :3] @ middle + moved[:3, 3])[:2]
    return shift


def _fitted(points: FloatArray, axes: FloatArray, width: int, height: int) -> Camera:
    """The nearest camera of those directions that holds all points."""
    spread = float(np.tan(HALF_FIELD))
    half = np.array([spread * width / height, spread]) * (1.0 - MARGIN)
    local = points @ axes.T
    eye = np.zeros(3)
    distances = []
    for axis in (0, 1):
        # A point on the border of the picture has |offset| = half * distance from the eye.
        outer = np.max(local[:, axis] + half[axis] * local[:, 2])
        inner = np.max(-local[:, axis] + half[axis] * local[:, 2])
        eye[axis] = (outer - inner) / 2.0
        distances.append((outer + inner) / (2.0 * half[axis]))
    nearest = float(local[:, 2].max()) + 1e-3
    eye[2] = max(*distances, nearest)
    return Camera(eye @ axes, axes, width, height, spread)
