"""Doors, drawers' fronts and lids, measured straight from the side that they close."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import ndimage

from ...articulation import Articulation, Joint, JointKind
from ...geometry.triangles import doubled_normals
from ...mesh import BoolArray, FloatArray, IntArray, Mesh
from ...part import Panel
from ...views.raster import Side
from ...views.view import View
from ..hinges import ALIKE
from .box import Box

#: A part that fills less of its rectangle is no panel.
LEAST_FILL = 0.5
#: Rows and columns that hold fewer of its pixels than this share of the fullest are its frayed rim.
FRAYED = 0.3
#: Where nothing lies beyond an edge within this distance, no frame does, and panels no further
#: apart share a seam [m].
BESIDE_M = 0.012
#: How much further a panel without a frame reaches: nothing may be left standing there [m]. The
#: post that one leaves which goes through is twice as wide.
BEYOND_M = 0.015
#: An axis lies across a direction to less than this cosine.
ACROSS = 0.35
#: A rim of a door is believed between these [m].
THINNEST_M = 0.015
THICKEST_M = 0.09
#: Or up to this share of the object's depth, where that is more.
THICKEST_SHARE = 0.12
#: What a panel whose rim is not seen is made [m].
DOOR_M = 0.022
LID_M = 0.03
#: Backs lie at least this far behind most of the front [m].
SOLID_M = 0.008
#: Of an object this thin, as a share of what a hinge opens in it, a door or window is all there is.
THIN_SHARE = 0.16


@dataclass(frozen=True)
class FlatPanel:
    """A flat part that closes an opening, in the frame of the side that it faces.

    Attributes:
        part: index.
        slides: whether it is a drawer's front; else a door's, or a lid.
        side: that it faces.
        low, high: its rectangle (right, up) [m], shape [2] each.
        front: depth at which most of it begins [m].
        back: depth of its plane back [m].
        rule: where the back comes from.
        frame: depth at which the frame begins beyond its left, right, lower and upper edge [m],
            shape [4]; infinite where there is none.
        shared: whether another panel begins at each edge, shape [4].
        through: whether it is as thick as the object, so that nothing lies behind it.
    """

    part: int
    slides: bool
    side: Side
    low: FloatArray
    high: FloatArray
    front: float
    back: float
    rule: str
    frame: FloatArray
    shared: BoolArray
    through: bool = False

    @property
    def open(self) -> BoolArray:
        """Return whether no frame lies beyond each edge, shape [4]."""
        return np.isinf(self.frame)

    @property
    def is_lid(self) -> bool:
        """Return whether it closes an object from above."""
        return self.side is Side.TOP

    @property
    def thickness(self) -> float:
        """Return how far its back lies behind most of its front [m]."""
        return self.back - self.front

    def reach(self, margin: FloatArray | float, back: float) -> Box:
        """Return the column before ``back`` [m], framed edges moved out by ``margin`` [m], [4]."""
        out = np.where(self.open, BEYOND_M, margin)
        return Box(
            np.array([self.low[0] - out[0], self.low[1] - out[2], -np.inf]),
            np.array([self.high[0] + out[1], self.high[1] + out[3], back]),
        )

    def within(self, inset: float, start: float = -np.inf, end: float = np.inf) -> Box:
        """Return the room within its edges by ``inset``, from one depth to another [m]."""
        return Box(np.append(self.low + inset, start), np.append(self.high - inset, end))


def opens(joint: Joint, panel: Panel) -> bool:
    """Tell whether a joint moves a panel out of the side that it closes."""
    if joint.kind is JointKind.PRISMATIC:
        return float(joint.axis @ panel.outward) > ALIKE
    motion = np.cross(joint.axis, panel.center - joint.origin) * (joint.upper + joint.lower)
    swings = float(motion @ panel.outward) > ACROSS * float(np.linalg.norm(motion))
    across = abs(float(joint.axis @ panel.outward)) < ACROSS
    return joint.kind is JointKind.REVOLUTE and across and swings


def find_panel(
    articulation: Articulation, part: int, view: View, opposite: View | None
) -> FlatPanel | None:
    """Measure a part that is a panel, on the view of the side on which it opens.

    The view of the side across is ``None`` of a lid. Returns ``None`` where the part is no panel
    after all: ragged, or thicker than wide.
    """
    mesh = articulation.mesh
    joint = articulation.joints[part - 1]
    seen = view.part == part
    rectangle = _rectangle(view, seen)
    if rectangle is None:
        return None
    low, high = rectangle
    rows, columns = view.raster.window(low, high)
    if seen[rows, columns].size == 0 or seen[rows, columns].mean() < LEAST_FILL:
        return None
    face = smoothed(view, seen)[rows, columns]
    known = np.isfinite(face)
    front = float(np.percentile(face[known], 20))
    deepest = float(np.percentile(face[known], 95))
    is_lid = view.side is Side.TOP
    rim = _rim(mesh, articulation.parts[part].faces, view, (low, high), whole=is_lid)
    far = float((mesh.bounds @ view.side.frame.T)[:, 2].max())
    slides = joint.kind is JointKind.PRISMATIC and not is_lid
    end = np.inf if slides or opposite is None else _end(opposite, low, high)
    thin = THIN_SHARE * float((high - low).min())
    # Handles of the other side stand out; a case that is open behind is not thin.
    through = end - front <= thin and far - front <= 2.0 * thin
    given = articulation.parts[part].panel
    back, rule = (end, "through") if through else _back(is_lid, front, deepest, rim, far, given)
    if back - front > float((high - low).max()) and not is_lid:
        return None
    frame = _frames(view, part, low, high, back)
    shared = np.zeros(4, dtype=bool)
    panel = FlatPanel(part, slides, view.side, low, high, front, back, rule, frame, shared, through)
    return _hung_on_post(panel, joint) if through else panel


def smoothed(view: View, seen: BoolArray) -> FloatArray:
    """Return the depth of a part without its protrusions, [rows, columns]; NaN: not seen.

    A grey closing of depth: a handle is nearer than what surrounds it.
    """
    rows, columns = np.nonzero(seen)
    least = min(int(np.ptp(rows)), int(np.ptp(columns))) + 1
    size = int(np.clip(0.3 * least, 3, 41)) | 1
    window = tuple(slice(max(at.min() - size, 0), at.max() + size + 1) for at in (rows, columns))
    inner = seen[window]
    filled = spread_out(view.away[window], inner)
    closed = ndimage.grey_closing(filled, size=(size, size))
    result = np.full(seen.shape, np.nan)
    result[window] = np.where(inner, closed, np.nan)
    return result


def spread_out(values: FloatArray, seen: BoolArray) -> FloatArray:
    """Return at each pixel the value of the nearest one that is seen, [rows, columns]."""
    nearest = ndimage.distance_transform_edt(~seen, return_distances=False, return_indices=True)
    return np.asarray(values[tuple(nearest)])


def _rectangle(view: View, seen: BoolArray) -> tuple[FloatArray, FloatArray] | None:
    label, count = ndimage.label(ndimage.binary_closing(seen, np.ones((5, 5), dtype=bool)))
    if not count:
        return None
    sizes = np.bincount(label[seen], minlength=count + 1)
    sizes[0] = 0
    kept = seen & np.isin(label, np.flatnonzero(sizes >= 0.05 * sizes.max()))
    ends = np.zeros((2, 2))
    for axis, at in ((0, view.raster.right), (1, view.raster.up)):
        profile = kept.sum(axis=axis)
        full = np.flatnonzero(profile >= FRAYED * np.percentile(profile[profile > 0], 90))
        ends[:, axis] = at[full[[0, -1]]]
    half = view.raster.pixel / 2.0
    return ends[0] - half, ends[1] + half


def _rim(
    mesh: Mesh,
    faces: IntArray,
    view: View,
    rectangle: tuple[FloatArray, FloatArray],
    whole: bool,
) -> float:
    """Return the depth down to which nine tenths of the faces around a part's rim reach [m].

    If ``whole``, down to which all would, were the last tenth as even as the four before: a ragged
    end does not count, and a lid ends at its seam.
    """
    corners = (mesh.vertices @ view.side.frame.T)[mesh.faces[faces]]
    normals = doubled_normals(corners)
    area = np.linalg.norm(normals, axis=1)
    middle = corners.mean(axis=1)
    low, high = rectangle
    inset = np.minimum(middle[:, :2] - low, high - middle[:, :2]).min(axis=1)
    near = np.abs(inset) < max(THINNEST_M, 3.0 * view.raster.pixel)
    level = np.abs(normals[:, 2]) < 0.5 * area
    chosen = near & level
    if area[chosen].sum() <= 0.0:
        return np.inf
    # A modelled door's side is two triangles from its front to its back: where those end counts.
    deep = np.ptp(corners[chosen, :, 2], axis=1) > THINNEST_M
    depth = np.where(deep, corners[chosen, :, 2].max(axis=1), middle[chosen, 2])
    order = np.argsort(depth)
    share = np.cumsum(area[chosen][order]) / area[chosen].sum()
    half, most = (float(depth[order][np.searchsorted(share, part)]) for part in (0.5, 0.9))
    if not whole:
        return most
    return min(most + (most - half) / 4.0, float(corners[..., 2].max()))


def _back(
    is_lid: bool, front: float, deepest: float, rim: float, far: float, given: Panel | None
) -> tuple[float, str]:
    room = far - front
    most = 0.8 * room if is_lid else min(max(THICKEST_M, THICKEST_SHARE * room), 0.4 * room)
    thickness = (given and given.thickness) or 0.0
    # A fridge's door may be thicker than any other: two ways to measure it agree.
    most = room if abs(rim - front - thickness) <= SOLID_M else most
    if THINNEST_M <= rim - front <= most:
        back = rim
        rule = "rim"
    else:
        back = front + min(LID_M if is_lid else DOOR_M, 0.4 * room)
        rule = "kind"
    if back < deepest + SOLID_M:
        back = min(deepest + SOLID_M, front + 0.7 * room)
        rule = "front"
    return back, rule


def _end(opposite: View, low: FloatArray, high: FloatArray) -> float:
    """Return how far away an object ends behind a rectangle, but for handles [m]."""
    mirrored = np.array([[-high[0], low[1]], [-low[0], high[1]]])
    window = opposite.raster.window(*mirrored)
    away = opposite.away[window][opposite.seen[window]]
    return -float(np.percentile(away, 5)) if len(away) else np.inf


def hinge_edge(panel: FlatPanel, joint: Joint) -> int:
    """Return at which edge a panel is hinged: 0 to 3 for left, right, lower and upper."""
    flat = panel.side.frame[:2]
    across = int(np.argmin(np.abs(flat @ joint.axis)))
    ends = np.array([panel.low[across], panel.high[across]])
    return 2 * across + int(np.argmin(np.abs(ends - (flat @ joint.origin)[across])))


def ended_at(panel: FlatPanel, edge: int, at: float) -> FlatPanel:
    """Return a panel with an edge elsewhere [m], and a frame beyond it from its front on."""
    across, above = divmod(edge, 2)
    ends = np.stack([panel.low, panel.high])
    ends[above, across] = at
    frame = panel.frame.copy()
    frame[edge] = min(frame[edge], panel.front)
    return replace(panel, frame=frame, low=ends[0], high=ends[1])


def _hung_on_post(panel: FlatPanel, joint: Joint) -> FlatPanel:
    """Return a panel that leaves a post of the object to hang on where it has no frame."""
    edge = hinge_edge(panel, joint)
    if not panel.open[edge]:
        return panel
    across, above = divmod(edge, 2)
    post = 2.0 * BEYOND_M
    return ended_at(panel, edge, panel.high[across] - post if above else panel.low[across] + post)


def _frames(view: View, part: int, low: FloatArray, high: FloatArray, back: float) -> FloatArray:
    """Return the depth beyond each edge, before the panel's back; infinite: nothing there."""
    step = max(BESIDE_M, 3.0 * view.raster.pixel)
    inner = 0.05 * (high - low)
    frames = np.full(4, np.inf)
    for edge in range(4):
        axis, upper = divmod(edge, 2)
        start = low + inner
        end = high - inner
        gap = 0.5 * view.raster.pixel
        start[axis] = high[axis] + gap if upper else low[axis] - step
        end[axis] = high[axis] + step if upper else low[axis] - gap
        window = view.raster.window(start, end)
        depth = view.away[window]
        beside = (depth < back + SOLID_M) & (view.part[window] != part)
        if beside.size and beside.mean() > 0.2:
            frames[edge] = float(np.percentile(depth[beside], 10))
    return frames
