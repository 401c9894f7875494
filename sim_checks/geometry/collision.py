"""Do two hulls or surfaces meet, and if not, how far apart are they?

FCL is asked only what it answers reliably. Its own depths are never used: measured wrong by up to
the size of the objects. Its signed distance is never switched on: on exact touching it aborts the
process.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..description import FloatArray, IntArray
from .depth import HullOverlap, overlap, overlap_along, widest_gap
from .hull import CollisionHull
from .placing import box_around, placed

#: FCL's distances are good to about this [m]; a claimed gap smaller than it is settled exactly.
TRUSTED_GAP = 1e-7
#: Its directions are off by up to 1e-4, which long hulls have as a lever: a gap that their corners
#: confirm to less than this share of it is measured again.
TRUSTED_SHARE = 1e-5


class TooManyLooks(Exception):
    """More exact looks than one file may take."""


class LookBudget:
    """How many exact looks a file may take, and how many it took."""

    def __init__(self, most: float = math.inf) -> None:
        self._most = most
        self._taken = 0

    def take(self, count: int = 1) -> None:
        """Count looks about to be taken.

        Raises:
            TooManyLooks: there would be more than may be.
        """
        self._taken += count
        if self._taken > self._most:
            raise TooManyLooks


class Collider:
    """One hull held ready: built once, in its own frame, and moved in place."""

    def __init__(self, hull: CollisionHull) -> None:
        import fcl

        self._fcl = fcl
        self.local = hull
        self.pose: FloatArray = np.eye(4)
        self._placed: CollisionHull | None = hull
        self._bounds: FloatArray | None = None
        triangles = np.column_stack([np.full(len(hull.triangles), 3), hull.triangles]).ravel()
        geometry = fcl.Convex(hull.vertices, len(hull.triangles), triangles)
        self._object: Any = fcl.CollisionObject(geometry, fcl.Transform())

    @property
    def hull(self) -> CollisionHull:
        """Return the hull where it is placed."""
        if self._placed is None:
            self._placed = self.local.moved(self.pose)
        return self._placed

    @property
    def bounds(self) -> FloatArray:
        """Return lowest and highest corner of the box around the placed hull [m], shape [2, 3]."""
        if self._bounds is None:
            self._bounds = box_around([placed(self.local.vertices, self.pose)])
        return self._bounds

    def place(self, pose: FloatArray) -> None:
        """Put the hull's own frame at ``pose``, shape [4, 4]."""
        if pose is self.pose or np.array_equal(pose, self.pose):
            return
        self.pose = pose
        # Most hulls are placed only to see that they are far from everything.
        self._placed = None
        self._bounds = None
        self._object.setTransform(self._fcl.Transform(pose[:3, :3], pose[:3, 3]))

    def stand(self, other: Collider) -> HullOverlap:
        """Return how the two placed hulls stand: exact depth, or a gap along a direction.

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
                if reach < 0.0 and distance + reach <= TRUSTED_SHARE * distance:
                    return HullOverlap(reach, direction)
                if reach < 0.0:
                    return widest_gap(self.hull, other.hull, direction)
        found = overlap(self.hull, other.hull)
        # FCL was seen to point beside a ball; any direction that separates will do to start from.
        return found if found.depth >= 0.0 else widest_gap(self.hull, other.hull, found.direction)


class Skin:
    """Triangles held ready, closed or not: built once, shifted in place.

    Args:
        vertices: corners [m], shape [vertex_count, 3].
        faces: at least one triangle, shape [face_count, 3].
    """

    def __init__(self, vertices: FloatArray, faces: IntArray) -> None:
        import fcl

        self._fcl = fcl
        model = fcl.BVHModel()
        model.beginModel(len(vertices), len(faces))
        model.addSubModel(np.ascontiguousarray(vertices), np.ascontiguousarray(faces))
        model.endModel()
        self._object: Any = fcl.CollisionObject(model, fcl.Transform())

    def shift(self, by: FloatArray) -> None:
        """Put the triangles ``by`` [m] beside where they were built, shape [3]."""
        self._object.setTransform(self._fcl.Transform(np.eye(3), by))

    def meets(self, other: Skin) -> bool:
        """Tell whether triangles of the two cut or touch; one that swallows the other does not."""
        request = self._fcl.CollisionRequest(num_max_contacts=1, enable_contact=False)
        result = self._fcl.CollisionResult()
        return bool(self._fcl.collide(self._object, other._object, request, result))

    def distance(self, other: Skin) -> float:
        """Return the distance of the two surfaces [m]; 0 where they meet."""
        request = self._fcl.DistanceRequest()
        result = self._fcl.DistanceResult()
        return max(0.0, float(self._fcl.distance(self._object, other._object, request, result)))

    def touching(self, other: Skin, most: int) -> IntArray:
        """Return the faces that meet, as pairs (this one's, the other's), shape [pair_count, 2].

        At most so many.
        """
        result = self._fcl.CollisionResult()
        request = self._fcl.CollisionRequest(num_max_contacts=most, enable_contact=True)
        self._fcl.collide(self._object, other._object, request, result)
        pairs = sorted({(int(contact.b1), int(contact.b2)) for contact in result.contacts})
        return np.array(pairs, dtype=np.int64).reshape(-1, 2)
