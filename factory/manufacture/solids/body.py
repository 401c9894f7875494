"""Parts that are neither panel nor knob, and the body that holds them all."""

from __future__ import annotations

import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree

from ...mesh import BoolArray, FloatArray
from ..decompose.convex import hull_of, limit_vertices
from ..poses import arms_from
from .box import Box
from .carve import block_insides, surface_points
from .knobs import clear_of_bumps, give_way, keep_clear
from .lattice import marked
from .pieces import MOST_CORNERS
from .reach import covering
from .sweep import CLEAR_M, entered, hung, motions
from .work import Workpiece

#: Hinges moved by less than this are not spoken of [m].
MOVED_M = 0.002
#: A part of so few cells along its longest side is one hull.
FEW_CELLS = 5


def share_out(work: Workpiece) -> None:
    """Give each part that is neither panel nor knob the cells next to its surface."""
    if not work.rest:
        return
    skin = work.skin.part
    wanted = np.isin(skin, [0, *work.rest])
    tree = cKDTree(work.skin.middles[wanted])
    labels = skin[wanted]
    for part in work.rest:
        corners = work.skin.of_part(part).reshape(-1, 3)
        around = Box.around(corners) if len(corners) else Box(*np.zeros((2, 3)))
        span = work.lattice.span(around.grown(0.5 * work.lattice.step))
        offset = np.array([each.start for each in span])
        cells = np.argwhere(work.owner[span] == 0) + offset
        if len(cells):
            nearest = labels[tree.query(work.lattice.centers(cells))[1]]
            work.owner[tuple(cells[nearest == part].T)] = part


def make_rest(work: Workpiece, most: int) -> None:
    """Make parts that are neither panel nor knob; their neighbours keep clear of their way."""
    for part in sorted(work.rest, reverse=True):
        points = surface_points(work, part)
        if not len(points):
            continue
        block_insides(work, part, points, work.owner == part)
        small = np.ptp(points, axis=0).max() < FEW_CELLS * work.lattice.step
        whole = hull_of(points) if small else None
        work.hulls[part] = (
            covering(work, part, _cells(work, part, points), points, most)
            if whole is None
            else (limit_vertices(whole, MOST_CORNERS),)
        )
        keep_clear(work, part)
        give_way(work, part)
        way = motions(work.joints[part - 1], 24)
        work.clear_way(work.host(part), entered(work.lattice, work.hulls[part], way, CLEAR_M))


def hang_panels(work: Workpiece) -> None:
    """Hang each panel where it swings free, and clear its way where it does not."""
    points = _standing_points(work)
    for part, panel in work.panels.items():
        joint = work.joints[part - 1]
        hulls = work.hulls[part]
        if not hulls:
            continue
        slab = max(hulls, key=lambda hull: hull.volume)
        standing = _cells(work, 0, points)
        moved, rule = hung(panel, joint, slab, standing, work.lattice)
        if rule != "given":
            distance = float(np.linalg.norm(arms_from(joint, moved.origin[None])))
            if distance > MOVED_M:
                work.notes.append(
                    f"the hinge of {work.name(part)!r} was moved by {1000 * distance:.0f} mm to "
                    f"the {rule}: where it was, the panel would swing into what holds it"
                )
            work.joints[part - 1] = moved
        passed = entered(work.lattice, hulls, motions(moved), 0.0)
        work.clear_way(0, passed & standing)


def make_body(work: Workpiece, most: int) -> None:
    """Make the body: walls around free space."""
    points = _standing_points(work)
    block_insides(work, 0, points, work.owner == 0)
    work.hulls[0] = covering(work, 0, _cells(work, 0, points), points, most)
    keep_clear(work, 0)


def _standing_points(work: Workpiece) -> FloatArray:
    """Return surface points of the body, off the panels and knobs that it holds [m], [n, 3]."""
    points = surface_points(work, 0)
    standing = clear_of_bumps(work, 0, points)
    for part, panel in work.panels.items():
        local = points @ panel.side.frame.T
        column = panel.reach(work.config.gap_m, panel.back + work.config.behind_m)
        for box in (column, *work.hollows.get(part, ())):
            standing &= ~box.holds(local, -1e-9)
    return points[standing]


def _cells(work: Workpiece, part: int, points: FloatArray) -> BoolArray:
    """Return a part's cells, and those that its surface passes where it is thinner than cells."""
    own: BoolArray = work.owner == part
    thin = marked(work.lattice, points) & ~ndimage.binary_dilation(
        own, np.ones((3, 3, 3), dtype=bool)
    )
    return np.asarray(own | (thin & (work.owner <= 0)))
