"""Where a moving part passes: poses along its joint, cells it enters, where its hinge may be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...articulation import Joint, JointKind
from ...asset import Hull
from ...mesh import BoolArray, FloatArray
from ..poses import moved
from .box import Box
from .lattice import Lattice
from .panel import FlatPanel, hinge_edge

#: Around what turns or slides within what holds it, before the exact cut [m].
CLEAR_M = 0.003
#: Poses along a joint.
POSES = 40
#: They lie closer where a joint begins to open: this power of even steps.
DENSER = 1.7
#: A hinge that lets a panel enter less than this of what stands still is left where it is [m3].
GRAZED_M3 = 2e-6
#: The hinge's line lies this far behind a slab without a frame [m].
BEHIND_M = 0.0015


def motions(joint: Joint, count: int = POSES) -> list[FloatArray]:
    """Return motions along a joint from closed to open, [4, 4] each; the smaller lie closer."""
    if joint.kind is JointKind.FIXED:
        return [np.eye(4)]
    share = np.linspace(0.0, 1.0, count)
    even = joint.kind is JointKind.CONTINUOUS or joint.lower < 0.0
    values = joint.lower + (share if even else share**DENSER) * joint.range
    return [joint.motion(float(value)) for value in values]


def entered(
    lattice: Lattice, hulls: Sequence[Hull], poses: list[FloatArray], margin: float
) -> BoolArray:
    """Return cells whose centres come within ``margin`` [m] of moving hulls."""
    marked = np.zeros(lattice.shape, dtype=bool)
    for hull in hulls:
        planes = hull.planes
        for pose in poses:
            span = lattice.span(Box.around(moved(hull.vertices, pose)).grown(margin))
            if not marked[span].size:
                continue
            normals = planes[:, :3] @ pose[:3, :3].T
            offsets = planes[:, 3] + normals @ pose[:3, 3]
            marked[span] |= lattice.below(np.column_stack([normals, -offsets]), span, margin)
    return marked


def hung(
    panel: FlatPanel, joint: Joint, slab: Hull, standing: BoolArray, lattice: Lattice
) -> tuple[Joint, str]:
    """Return the joint about that line on which a panel swings free, and which line that is.

    ``given`` where the input's own line does; else at the outer edge by the hinge, at the depth of
    the frame beside it, or behind a slab that has none; whichever enters the fixed parts least.
    """
    if not joint.turns or panel.slides:
        return joint, "given"
    best = (np.inf, joint, "given")
    for candidate, rule in [(joint, "given"), *_lines(panel, joint)]:
        cells = entered(lattice, [slab], motions(candidate, 16), -0.002) & standing
        volume = float(lattice.volumes[cells].sum())
        if volume < best[0] - GRAZED_M3:
            best = (volume, candidate, rule)
        if best[0] < GRAZED_M3:
            break
    return best[1], best[2]


def _lines(panel: FlatPanel, joint: Joint) -> list[tuple[Joint, str]]:
    frame = panel.side.frame
    at = frame @ joint.origin
    edge = hinge_edge(panel, joint)
    across, above = divmod(edge, 2)
    depths = {"slab back": panel.back + BEHIND_M, "slab front": panel.front}
    # What stands further before a panel is no frame, but a cistern behind a seat.
    if panel.front - panel.thickness <= panel.frame[edge] < np.inf:
        depths = {"frame": min(float(panel.frame[edge]), panel.back), **depths}
    lines = []
    for rule, depth in depths.items():
        there = at.copy()
        there[across] = panel.high[across] if above else panel.low[across]
        there[2] = depth
        lines.append((replace(joint, origin=there @ frame), rule))
    return lines
