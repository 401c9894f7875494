"""Fronts of doors and drawers, in the styles that joiners and appliance makers give them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from asset_factory.factory.mesh import Material

from .assembly import PartDraft
from .axes import X, Y
from .boards import frame
from .looks import GLASS
from .shapes import Form, box, frustum, prism
from .spans import Span, about, between, mid, shares, size, within

#: Narrower than this, a front has no room for a frame [m].
FRAMED_FROM = 0.16
#: Makes a front of its spans x, y (face to back) and z and the width of its frame [m].
PanelMaker = Callable[[Span, Span, Span, float], list[Form]]


def _slab(x: Span, y: Span, z: Span, width: float) -> list[Form]:
    return [box(x, y, z)]


def _bevel(x: Span, y: Span, z: Span, width: float) -> list[Form]:
    edge = min(0.006, 0.4 * size(y))
    slope = frustum((within(x, edge), within(z, edge)), (x, z), (y[0], y[0] + edge), Y)
    return [box(x, within(y, edge, 0.0), z), slope]


def _shaker(x: Span, y: Span, z: Span, width: float) -> list[Form]:
    raised = y[0] + 0.35 * size(y)
    return [box(x, (raised, y[1]), z), *frame(x, (y[0], raised), z, width)]


def _raised(x: Span, y: Span, z: Span, width: float) -> list[Form]:
    deep = y[0] + 0.45 * size(y)
    foot = (within(x, width + 0.01), within(z, width + 0.01))
    tip = (within(foot[0], 0.02), within(foot[1], 0.02))
    forms = [*frame(x, y, z, width), box(within(x, width), (deep, y[1]), within(z, width))]
    if min(size(tip[0]), size(tip[1])) > 0.01:
        forms.append(frustum(tip, foot, (y[0] + 0.001, deep), Y))
    return forms


def _mullion(x: Span, y: Span, z: Span, width: float) -> list[Form]:
    inner_x = within(x, width)
    inner_z = within(z, width)
    bars = [box(about(0.008, v), y, inner_z) for v in between(inner_x, round(size(x) / 0.22))]
    bars += [box(inner_x, y, about(0.008, v)) for v in between(inner_z, round(size(z) / 0.22))]
    return [*frame(x, y, z, width), *bars]


def _louvre(x: Span, y: Span, z: Span, width: float) -> list[Form]:
    inner = within(z, width)
    low, high = within(y, 0.1 * size(y))
    slats = []
    for bay in shares(inner, max(2, min(24, int(size(inner) / 0.035)))):
        foot, top = within(bay, 0.1 * size(bay))
        section = [(low, foot), (low + 0.006, foot), (high, top), (high - 0.006, top)]
        slats.append(prism(section, within(x, width), X))
    return [*frame(x, y, z, width), *slats]


def _planks(x: Span, y: Span, z: Span, width: float) -> list[Form]:
    groove = y[0] + 0.3 * size(y)
    count = max(2, round(size(x) / max(0.05, width)))
    planks = [box(within(plank, 0.0015), (y[0], groove), z) for plank in shares(x, count)]
    return [box(x, (groove, y[1]), z), *planks]


def _bowed(x: Span, y: Span, z: Span, width: float) -> list[Form]:
    t = np.linspace(-1.0, 1.0, 9)
    front = np.stack([mid(x) + t * size(x) / 2, y[0] + 0.6 * size(y) * t**2], axis=1)
    return [prism([*front, (x[1], y[1]), (x[0], y[1])], z)]


def _two_fields(x: Span, y: Span, z: Span, width: float) -> list[Form]:
    rail = box(within(x, width), (y[0], y[0] + 0.35 * size(y)), about(width / 2, mid(z)))
    return [*_shaker(x, y, z, width), rail]


#: Every style by its name; a glazed front is a frame around its pane.
STYLES: dict[str, PanelMaker] = {
    "slab": _slab, "bevel": _bevel, "shaker": _shaker, "raised": _raised, "glazed": frame,
    "mullion": _mullion, "louvre": _louvre, "planks": _planks, "bowed": _bowed,
    "two_fields": _two_fields,
}  # fmt: skip
#: Styles that one looks through, and those of them with a pane.
OPEN_STYLES = ("glazed", "mullion", "louvre")
PANES = ("glazed", "mullion")


def panel(
    part: PartDraft, kind: str, x: Span, y: Span, z: Span, rail: float, look: Material | None = None
) -> None:
    """Add a front that fills its spans [m] and never leaves them.

    Its kind is one of :data:`STYLES`, a slab if too small for a frame of ``rail`` width [m].
    """
    framed = kind not in ("slab", "bevel", "bowed")
    if framed and min(size(x), size(z)) < max(FRAMED_FROM, 3 * rail):
        kind = "slab"
    part.add(*STYLES[kind](x, y, z, rail), look=look)
    if kind in PANES:
        glass = about(0.002, mid(y))
        part.add(box(within(x, rail - 0.004), glass, within(z, rail - 0.004)), look=GLASS)
