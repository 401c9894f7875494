"""What the connected component around a point looks like: features that need no network of their own.

A small network cannot learn from few examples what belongs together, and PartField, which can tell it, is large and not
free to use. In meshes that people modelled, what hangs together belongs together: each point is told the box, the place
and the spread of its component. On a mesh of one piece the features say so, and nothing else.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..mesh.mesh import IntArray
from .prediction import Float32Array

COMPONENT_FEATURES = 27
WHOLE_SHARE = 0.9
"""A component with more of the points is the object itself and tells nothing about its parts."""
_LEAST = 1e-6


def component_features(points: npt.ArrayLike, normals: npt.ArrayLike, components: IntArray) -> Float32Array:
    """Features of every point of a cloud that covers the object.

    Args:
        points: network frame, shape [point_count, 3].
        normals: there, shape [point_count, 3].
        components: number of each point's component, any integers of at least 0, shape [point_count].

    Returns:
        Shape [point_count, 27]. Of the component, in the network's frame: lower and upper corner of its box, mean and
        standard deviation of its points, mean normal and mean of its absolute components, logarithm of its share of the
        points; then the point's place in that box (-1 to 1), the sides of the object's box, logarithm of the number of
        components, and 1 where the component is the whole object.
    """
    cloud = np.asarray(points, dtype=np.float32)
    directions = np.asarray(normals, dtype=np.float32)
    _, of_point = np.unique(components, return_inverse=True)
    order = np.argsort(of_point, kind="stable")
    start = np.searchsorted(of_point[order], np.arange(int(of_point[order[-1]]) + 1))
    count = np.diff(np.append(start, len(order))).astype(np.float32)[:, None]
    sorted_points = cloud[order]
    low = np.minimum.reduceat(sorted_points, start)
    high = np.maximum.reduceat(sorted_points, start)
    told = np.concatenate([sorted_points, sorted_points**2, directions[order], np.abs(directions[order])], axis=1)
    mean = np.add.reduceat(told, start) / count
    spread = np.sqrt(np.maximum(mean[:, 3:6] - mean[:, :3] ** 2, 0.0))
    share = count / len(cloud)
    of_component = np.concatenate([low, high, mean[:, :3], spread, mean[:, 6:], np.log10(share) / 3.0], axis=1)
    half = np.maximum((high - low) / 2.0, _LEAST)
    place = (cloud - ((low + high) / 2.0)[of_point]) / half[of_point]
    whole = np.empty((len(cloud), 5), dtype=np.float32)
    whole[:, :3] = cloud.max(axis=0) - cloud.min(axis=0)
    whole[:, 3] = np.log10(len(count)) / 3.0
    whole[:, 4] = (share > WHOLE_SHARE)[of_point, 0]
    found = np.concatenate([of_component[of_point], np.clip(place, -1.0, 1.0), whole], axis=1)
    return np.asarray(found, dtype=np.float32)
