"""What the connected component around a point looks like: features without a second network.

A small network cannot learn from few examples what belongs together, and PartField, which can tell
it, is large and not
free to use. In meshes that people modelled, what hangs together belongs together: each point is
told the box, the place and the spread of its component. On a mesh of one piece the features say so,
and nothing else.
"""

import numpy as np
import numpy.typing as npt

from ...mesh import Float32Array, IntArray

COMPONENT_FEATURES = 27
WHOLE_SHARE = 0.9
"""A component with more of the points is the object itself and tells nothing about its parts."""
_LEAST = 1e-6


def component_features(
    points: npt.ArrayLike, normals: npt.ArrayLike, components: IntArray
) -> Float32Array:
    """Return the features of every point of a cloud that covers the object.

    Args:
        points: network frame, shape [point_count, 3].
        normals: there, shape [point_count, 3].
        components: number of each point's component, any integers of at least 0, shape
            [point_count].

    Returns:
        Shape [point_count, 27]. Of the component, in the network's frame: lower and upper corner of
        its box, mean and standard deviation of its points, mean normal and mean of its absolute
        components, logarithm of its share of the points; then the point's place in that box (-1 to
        1), the sides of the object's box, logarithm of the number of components, and 1 where the
        component is the whole object.
    """
    cloud = np.asarray(points, dtype=np.float32)
    directions = np.asarray(normals, dtype=np.float32)
    given = np.asarray(components)
    present = np.zeros(int(given.max()) + 1, dtype=np.int64)
    present[given] = 1
    of_point = (np.cumsum(present) - 1)[given]
    number = int(present.sum())
    order = np.argsort(of_point, kind="stable")
    points_each = np.bincount(of_point, minlength=number)
    start = np.concatenate([[0], np.cumsum(points_each)[:-1]])
    count = points_each.astype(np.float32)[:, None]
    # A row of memory for each number: sums along rows take half the time of sums along columns.
    told = np.empty((12, len(cloud)), dtype=np.float32)
    told[:3] = cloud[order].T
    told[6:9] = directions[order].T
    np.square(told[:3], out=told[3:6])
    np.abs(told[6:9], out=told[9:])
    low = np.minimum.reduceat(told[:3], start, axis=1).T
    high = np.maximum.reduceat(told[:3], start, axis=1).T
    mean = np.add.reduceat(told, start, axis=1).T / count
    spread = np.sqrt(np.maximum(mean[:, 3:6] - mean[:, :3] ** 2, 0.0))
    share = count / len(cloud)
    of_component = np.concatenate(
        [low, high, mean[:, :3], spread, mean[:, 6:], np.log10(share) / 3.0], axis=1
    )
    half = np.maximum((high - low) / 2.0, _LEAST)
    found = np.empty((len(cloud), COMPONENT_FEATURES), dtype=np.float32)
    found[:, :19] = of_component[of_point]
    found[:, 19:22] = np.clip((cloud - ((low + high) / 2.0)[of_point]) / half[of_point], -1.0, 1.0)
    found[:, 22:25] = told[:3].max(axis=1) - told[:3].min(axis=1)
    found[:, 25] = np.log10(number) / 3.0
    found[:, 26] = (share > WHOLE_SHARE)[of_point, 0]
    return found
