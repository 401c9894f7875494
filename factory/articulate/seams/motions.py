"""How a panel opens: hinged at one of its edges, or sliding out."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...mesh import FloatArray
from ...part import OpensBy
from .candidates import FrontScene
from .company import said_by_company
from .features import ALIGNED, MOTION_NAMES, motion_features
from .groups import FrontPanel
from .handles import GripShape, Protrusion
from .learned import load_judge
from .relief import Relief
from .sight import Sight

#: What is less deep than this share of a panel's shorter side holds no drawer.
SHALLOW = 0.3


@dataclass(frozen=True, eq=False)
class Opening:
    """A panel with the ways it may open.

    Attributes:
        panel: which.
        ways: with the probability of each, the likeliest first.
    """

    panel: FrontPanel
    ways: tuple[tuple[OpensBy, float], ...]

    @property
    def way(self) -> OpensBy:
        """Return the likeliest."""
        return self.ways[0][0]


def openings_of(
    scene: FrontScene, panels: Sequence[FrontPanel], sight: Sight
) -> tuple[Opening, ...]:
    """Weigh the ways in which each panel may open by three opinions that count alike.

    Rules, a model of rectangles, and the picture network; then its company.
    """
    if not panels:
        return ()
    every = [panel.rectangle for panel in panels]
    rows = np.stack([motion_features(scene, each, every) for each in every])
    learned = load_judge("motion", MOTION_NAMES).scores(rows)
    has_controls = any(handle.control for handle in scene.face.handles)
    company = said_by_company(panels, has_controls=has_controls)
    found = []
    for panel, said, told in zip(panels, learned, company, strict=True):
        ruled = _weights(scene.relief, panel, panels)
        values = np.array([ruled[way] for way in OpensBy])
        seen = np.log(sight.ways_of(panel.rectangle))
        weights = dict(zip(OpensBy, (_logs(values) + _logs(said) + seen) / 3.0, strict=True))
        weights = {way: weight + told.get(way, 0.0) for way, weight in weights.items()}
        found.append(Opening(panel, _ranked(_possible(scene.relief, panel, weights))))
    return tuple(found)


def _possible(
    relief: Relief, panel: FrontPanel, weights: dict[OpensBy, float]
) -> dict[OpensBy, float]:
    """Return the weights without drawers where there is no depth for one."""
    short = float(panel.rectangle.size.min()) * relief.raster.pixel
    if relief.depth < SHALLOW * short:
        return {way: weight for way, weight in weights.items() if way is not OpensBy.OUT}
    return weights


def _logs(values: FloatArray) -> FloatArray:
    """Return the logarithms of the probabilities that log-weights stand for."""
    return np.asarray(values - np.logaddexp.reduce(values))


def _ranked(weights: Mapping[OpensBy, float]) -> tuple[tuple[OpensBy, float], ...]:
    """Return the ways with their probabilities, the likeliest first."""
    shares = np.exp(_logs(np.array(list(weights.values()))))
    ways = zip(weights, shares.tolist(), strict=True)
    return tuple(sorted(ways, key=lambda each: -each[1]))


def _weights(
    relief: Relief, panel: FrontPanel, panels: Sequence[FrontPanel]
) -> dict[OpensBy, float]:
    if panel.handle is None:
        return _without_handle(relief, panel, panels)
    across, up = _place(panel, panel.handle)
    # A bar along an edge belongs to that edge, wherever its middle lies.
    rows, columns = panel.handle.size / panel.rectangle.size
    wide = panel.aspect
    beside = abs(across - 0.5)
    weights = {
        OpensBy.LEFT: 8.0 * (across - 0.6),
        OpensBy.RIGHT: 8.0 * (0.4 - across),
        OpensBy.BOTTOM: -1.5,
        OpensBy.TOP: -2.5,
        OpensBy.OUT: 1.2 - 9.0 * max(beside - 0.06, 0.0) + 1.2 * np.log(wide),
    }
    tall = float(panel.rectangle.size[0] / max(np.ptp(relief.box[:2]), 1))
    if up > 0.75 and beside < 0.12:
        # Across the whole width, or on something taller than a drawer.
        bar = 1.0 if wide < 1.1 else min(float(columns) / 0.4, 1.0)
        weights[OpensBy.BOTTOM] = 6.0 * (up - 0.75) / 0.25 * bar + 5.0 * (min(tall, 0.6) - 0.4)
        weights[OpensBy.BOTTOM] -= 1.5 * max(np.log(wide / 1.8), 0.0)
    if up < 0.2 and beside < 0.12 and panel.rectangle.low[0] > relief.box[0] + 8:
        weights[OpensBy.TOP] = 0.5
    if panel.handle.grip is GripShape.UPRIGHT:
        weights[OpensBy.OUT] -= 3.0
        weights[OpensBy.LEFT] += 1.0 + 3.0 * (across - 0.5)
        weights[OpensBy.RIGHT] += 1.0 + 3.0 * (0.5 - across)
    elif panel.handle.grip is GripShape.LEVEL:
        weights[OpensBy.OUT] += 1.0
        weights[OpensBy.LEFT] -= 1.0
        weights[OpensBy.RIGHT] -= 1.0
    elif rows < 0.5:
        weights[OpensBy.OUT] += 0.3
    return weights


def _place(panel: FrontPanel, handle: Protrusion) -> tuple[float, float]:
    """Return where the handle is: across from the left and up from the bottom, 0 to 1."""
    low = panel.rectangle.low
    size = np.maximum(panel.rectangle.size, 1)
    up, across = (handle.center - low) / size
    mates = [h for h in panel.handles[1:] if h.height >= 0.5 * handle.height]
    for mate in mates:
        # Two handles of one drawer pull in its middle.
        if abs(mate.center[0] - handle.center[0]) <= ALIGNED:
            across = ((handle.center[1] + mate.center[1]) / 2.0 - low[1]) / size[1]
    return float(across), float(up)


def _without_handle(
    relief: Relief, panel: FrontPanel, panels: Sequence[FrontPanel]
) -> dict[OpensBy, float]:
    """Weigh the ways by the shape, and by what the panels beside it do."""
    box = relief.box
    middle = (panel.rectangle.low[1] + panel.rectangle.high[1]) / 2.0
    to_left = float(np.clip((middle - box[2]) / max(box[3] - box[2], 1), 0.0, 1.0))
    weights = {
        OpensBy.LEFT: 1.5 * (0.5 - to_left),
        OpensBy.RIGHT: 1.5 * (to_left - 0.5),
        OpensBy.OUT: 2.0 * float(np.log(panel.aspect / 1.3)),
        OpensBy.BOTTOM: -2.0,
        OpensBy.TOP: -3.0,
    }
    for other in panels:
        if other is panel or other.handle is None:
            continue
        theirs = max(_weights(relief, other, panels).items(), key=lambda each: each[1])[0]
        apart = other.rectangle.low - panel.rectangle.low
        if abs(apart[0]) <= ALIGNED and theirs in (OpensBy.LEFT, OpensBy.RIGHT):
            weights[OpensBy.LEFT if theirs is OpensBy.RIGHT else OpensBy.RIGHT] += 2.0
        if abs(apart[1]) <= ALIGNED:
            weights[theirs] = weights.get(theirs, 0.0) + 2.0
    return weights
