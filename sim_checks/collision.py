"""Do two hulls meet, and if not, how far apart are they: FCL, asked only what it answers reliably.

FCL's own depths are never used: measured wrong by up to the size of the objects. Its signed distance is never
switched on: on exact touching it aborts the process.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .depth import Overlap, overlap, overlap_along
from .description import FloatArray
from .hull import Hull

#: FCL's distances are good to about this [m]; a claimed gap smaller than it is settled exactly.
TRUSTED_GAP = 1e-7


class Collider:
    """One hull held ready: built once, moved in place.

    Args:
        hull: in its own frame.
    """

    def __init__(self, hull: Hull) -> None:
        import fcl

        self._fcl = fcl
        self.local = hull
        self.hull = hull
        self.pose: FloatArray = np.eye(4)
        triangles = np.column_stack([np.full(len(hull.triangles), 3), hull.triangles]).ravel()
        geometry = fcl.Convex(hull.vertices, len(hull.triangles), triangles)
        self._object: Any = fcl.CollisionObject(geometry, fcl.Transform())

    def place(self, pose: FloatArray) -> None:
        """Put the hull's own frame at ``pose``, shape [4, 4]."""
        self.pose = pose
        self.hull = self.local.moved(pose)
        self._object.setTransform(self._fcl.Transform(pose[:3, :3], pose[:3, 3]))

    def stand(self, other: Collider) -> Overlap:
        """How this hull and the other stand where they are placed: exact depth, or a gap along a direction.

        A positive gap is the distance between the two.
        """
        result = self._fcl.DistanceResult()
        request = self._fcl.DistanceRequest(enable_nearest_points=True)
        distance = self._fcl.distance(self._object, other._object, request, result)
        if distance > TRUSTED_GAP:
            near, far = (np.asarray(point) for point in result.nearest_points)
            along = far - near
            length = float(np.linalg.norm(along))
            if length > TRUSTED_GAP:
                direction = along / length
                reach = float(overlap_along(self.hull, other.hull, direction[None])[0])
                # The gap is believed only as far as the hulls' own corners confirm it.
                if reach < 0.0 and -reach > 0.5 * distance:
                    return Overlap(reach, direction)
        return overlap(self.hull, other.hull)
