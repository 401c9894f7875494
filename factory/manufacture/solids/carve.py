"""Panels' slabs, and what they leave of the rest: gaps, hollows, drawers' boxes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import reduce

import numpy as np
from scipy import ndimage

from ...articulate.seams.placing import SLIDE
from ...articulation import Joint
from ...asset import Hull
from ...config import SolidsConfig
from ...geometry.rows import distinct_rows
from ...mesh import BoolArray, FloatArray
from ..decompose.outside import outside
from ..hinges import ALIKE
from .boards import drawer_box, shelf_boards
from .box import Box
from .cavity import hollow
from .frame import turned_hull
from .knobs import clear_of_bumps, keep_clear
from .lattice import closed_up, marked
from .matter import INSIDE, PATH
from .panel import FlatPanel, hinge_edge
from .reach import FAR_M, covering
from .slab import FLUSH_M, FrontRelief, handles, relief
from .work import Workpiece

#: A free edge of a door passes its frame at least this far off [m].
PASSING_M = 0.001
#: Lids thicker than this are hollow [m].
THICK_LID_M = 0.05
LID_WALL_M = 0.012
#: Share of what lies right behind a panel that is filled, below which the input has an inside.
FILLED = 0.5
#: What lies this close behind a panel's back is its own inner side [m].
BEHIND_BACK_M = 0.05
MOST_PIECES = 10
MOST_FITTED = 12
#: Share of a panel's surface behind its slab that is worth pieces of its own.
BARE_SHARE = 0.1
#: Points of a skin lie no further apart than this share of a cell.
SPACING = 1.5


def gaps(panel: FlatPanel, joint: Joint, gap: float) -> FloatArray:
    """Return how far the carving reaches beyond each edge of a panel [m], shape [4]."""
    margin = np.full(4, gap)
    if panel.slides:
        return margin
    edge = hinge_edge(panel, joint)
    across = edge // 2
    width = float(panel.high[across] - panel.low[across])
    swing = panel.thickness**2 / (2.0 * width)
    margin[2 * across : 2 * across + 2] += PASSING_M + swing
    if panel.through:
        # So thick a leaf would take its post away.
        margin[edge] -= swing
    return margin


def planes_of_panels(
    panels: dict[int, FlatPanel], joints: list[Joint], config: SolidsConfig
) -> Iterator[tuple[int, float]]:
    """Yield the axes of the working frame that the lattice has planes across, and where [m]."""
    for part, panel in panels.items():
        margin = gaps(panel, joints[part - 1], config.gap_m)
        for box in (
            panel.reach(-config.gap_m, panel.back),
            panel.within(0.0, panel.front, panel.back),
            panel.reach(margin, panel.back + config.behind_m),
            panel.reach(-config.wall_m, panel.back + config.behind_m),
        ):
            turned = box.turned(panel.side.frame.T)
            yield from enumerate(turned.low.tolist())
            yield from enumerate(turned.high.tolist())


def surface_points(work: Workpiece, part: int) -> FloatArray:
    """Return the points of a part's surface, close enough for its pieces [m], shape [n, 3]."""
    if part in work.points:
        return work.points[part]
    corners = work.skin.of_part(part)
    if not len(corners):
        return np.zeros((0, 3))
    step = SPACING * work.lattice.step
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    parts = np.clip(np.ceil(longest / step).astype(np.int64), 1, 64)
    found = [corners.reshape(-1, 3)]
    for count in np.unique(parts[parts > 1]):
        some = corners[parts == count]
        grid = [(i, j, count - i - j) for i in range(count + 1) for j in range(count + 1 - i)]
        weights = np.array(grid) / count
        found.append(np.einsum("kc,ncd->nkd", weights, some).reshape(-1, 3))
    points = np.asarray(np.round(np.concatenate(found), 7), dtype=np.float64)
    return work.points.setdefault(part, points[distinct_rows(points)[0]])


def carve_panel(work: Workpiece, part: int) -> None:
    """Make a panel's slab, and keep its column free for it."""
    panel = work.panels[part]
    config = work.config
    margin = gaps(panel, work.joints[part - 1], config.gap_m)
    end = np.inf if panel.through else panel.back + config.behind_m
    carved = work.cells_of(panel, panel.reach(margin, end))
    work.clear_way(0, carved)
    for other in work.rest:
        work.block(other, carved, PATH)
    inner = work.cells_of(panel, panel.reach(-config.gap_m, panel.back))
    work.owner[inner][work.whole[inner] & (work.owner[inner] == -1)] = part


def make_slab(work: Workpiece, part: int) -> None:
    """Make a panel's pieces: its slab, hollowed where it is thick, and its handles."""
    panel = work.panels[part]
    frame = panel.side.frame
    points = surface_points(work, part)
    local = points[clear_of_bumps(work, part, points)] @ frame.T
    slab = panel.reach(-work.config.gap_m, panel.back)
    within = slab.holds(local, 1e-9)
    behind = local[~within]
    local = local[within]
    face = relief(work.views[panel.side], panel)
    proud = handles(face, local)
    kept = local[face.above(local) < FLUSH_M]
    solid, whole = _behind_face(work, panel, face)
    if work.config.interior:
        work.lids[part] = _lid_hollow(work, panel)
        for box in work.lids[part]:
            work.block(part, work.cells_of(panel, box), INSIDE)
    for box in work.lids.get(part, ()):
        kept = kept[~box.holds(kept, -1e-9)]
    pieces = covering(work, part, solid, kept @ frame, MOST_PIECES, whole)
    hulls = [*pieces, *(turned_hull(hull, frame.T) for hull in proud)]
    hulls += _behind_slab(work, part, hulls, behind @ frame, len(points))
    work.hulls[part] = tuple(hulls)
    keep_clear(work, part)


def _behind_slab(
    work: Workpiece, part: int, hulls: list[Hull], points: FloatArray, whole: int
) -> tuple[Hull, ...]:
    """Return the pieces of a panel's own parts there: shelves in a door, a knife's other side.

    Of ``whole`` points of all its surface some lie behind its slab [m], shape [n, 3].
    """
    bare = points[outside(hulls, points) > FAR_M]
    if len(bare) < BARE_SHARE * whole:
        return ()
    return covering(work, part, marked(work.lattice, bare), bare, MOST_FITTED)


def _behind_face(
    work: Workpiece, panel: FlatPanel, face: FrontRelief
) -> tuple[BoolArray, BoolArray]:
    """Return a slab's cells, between its face and its back, and all cells behind its face."""
    frame = panel.side.frame
    lattice = work.lattice
    inside = np.zeros(lattice.shape, dtype=bool)
    inside[work.cells_of(panel, panel.within(0.0))] = True
    cells = np.argwhere(inside)
    behind = face.above(lattice.centers(cells) @ frame.T)
    inside[tuple(cells.T)] = np.isfinite(behind) & (behind < 0.0)
    slab = work.cells_of(panel, panel.reach(-work.config.gap_m, panel.back))
    solid = np.zeros_like(inside)
    solid[slab] = inside[slab]
    return solid, inside


def _lid_hollow(work: Workpiece, panel: FlatPanel) -> tuple[Box, ...]:
    if not panel.is_lid or panel.thickness < THICK_LID_M:
        return ()
    frame = panel.side.frame * np.array([[1.0], [1.0], [-1.0]])
    room = _inner(work, (panel.part, 0), LID_WALL_M)
    column = panel.reach(-work.config.wall_m, panel.back)
    inner = column.shared(panel.within(LID_WALL_M))
    inner = inner.between(-panel.back, -panel.front - LID_WALL_M)
    boxes = hollow(work.lattice, room, inner, frame)
    turn = np.diag([1.0, 1.0, -1.0])
    return tuple(box.turned(turn) for box in boxes)


def _inner(work: Workpiece, owners: tuple[int, ...], wall: float) -> BoolArray:
    """Return the cells of some owners at least a wall below everything that is not theirs."""
    mine = np.isin(work.owner, owners)
    lattice = work.lattice
    for part in owners:
        # A panel's gap is open to what lies behind the panel.
        if part in work.panels:
            panel = work.panels[part]
            column = panel.reach(0.004, panel.back + work.config.behind_m)
            span = work.cells_of(panel, column)
            mine[span] |= work.whole[span]
    step = float(np.median(np.diff(lattice.lines[int(np.argmax(lattice.shape))])))
    rounds = max(round(wall / step), 1)
    return np.asarray(ndimage.binary_erosion(mine, iterations=rounds))


def hollow_behind(work: Workpiece, part: int) -> None:
    """Hollow out the space behind a panel, and give a drawer its box."""
    panel = work.panels[part]
    if panel.through:
        return
    frame = panel.side.frame
    wall = work.config.wall_m
    start = panel.back + work.config.behind_m
    far = float((work.source.mesh.bounds @ frame.T)[:, 2].max())
    column = panel.within(wall, start, far)
    if column.empty:
        return
    cells = work.whole[work.cells_of(panel, column.between(start, start + 0.03))]
    work.filled[part] = bool(cells.size and cells.mean() > FILLED)
    if work.filled[part]:
        room = _inner(work, (0, part), wall)
    else:
        block_insides(work, 0, surface_points(work, 0), work.whole)
        if not panel.slides:
            return
        # A drawer's box need not be shut in. Lines of matter without a surface are none: rays that
        # an open mesh let through.
        full = marked(work.lattice, surface_points(work, 0)) | ndimage.binary_opening(work.whole)
        room = np.asarray(~full & (work.owner <= 0))
        room[work.cells_of(panel, column.between(start, start + BEHIND_BACK_M))] = True
    for taken in _taken(work, part):
        room[work.lattice.span(taken.grown(wall))] = False
    boxes = hollow(work.lattice, room, column, frame)
    if not boxes:
        return
    work.hollows[part] = boxes
    for box in boxes:
        work.clear_way(0, work.cells_of(panel, box), PATH if panel.slides else INSIDE)
    clear = reduce(Box.shared, boxes).between(boxes[0].low[2], boxes[-1].high[2])
    if panel.slides:
        _give_box(work, panel, clear)
    elif work.usual.shelves is not None and (upward := np.abs(frame[:2, 2])).max() > ALIKE:
        # What lies has none.
        work.shelves[part] = shelf_boards(clear, work.usual.shelves, int(upward.argmax()))


def _taken(work: Workpiece, part: int) -> Iterator[Box]:
    """Yield the boxes, in the working frame, that other parts and their hollows fill."""
    for other, boxes in work.hollows.items():
        if other != part:
            yield from (box.turned(work.panels[other].side.frame.T) for box in boxes)
    for other in work.rest:
        corners = work.skin.of_part(other).reshape(-1, 3)
        if len(corners):
            yield Box.around(corners)


def block_insides(work: Workpiece, part: int, points: FloatArray, solid: BoolArray) -> None:
    """Keep a part's pieces out of space that a surface and solid cells shut in on five sides.

    Points of the surface have shape [n, 3] [m].
    """
    walls = marked(work.lattice, points)
    empty = closed_up(solid | walls) & ~walls & ~work.whole
    work.block(part, ndimage.binary_erosion(empty), INSIDE)


def _give_box(work: Workpiece, panel: FlatPanel, room: Box) -> None:
    """Give a drawer its box; it slides out no further than that is deep: nothing would hold it."""
    up = int(np.abs(panel.side.frame[:2, 2]).argmax())
    boards = drawer_box(room, panel.back, up)
    work.boards[panel.part] = boards
    work.add_boards(panel.part, boards, panel)
    depth = max((float(board.high[2]) for board in boards), default=np.inf) - panel.back
    joint = work.joints[panel.part - 1]
    if joint.upper > depth:
        held = replace(joint, upper=SLIDE * depth)
        work.notes.append(
            f"{work.name(panel.part)!r} slides {held.upper:.3g} m out, not {joint.upper:.3g}: its "
            f"box is {depth:.3g} m deep"
        )
        work.joints[panel.part - 1] = held
