"""Looks of generated meshes, drawn anew each time that an object is learned from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import torch  # noqa: TID253 - this module is only imported to train
from torch.nn import functional  # noqa: TID253

from asset_factory.factory.models.detector.canvas import CANVAS, LONGEST, SIDES
from asset_factory.factory.models.detector.network import closed, heights_of, stacked_cues

from .sides import BOX, VIEW, WAY

Tensor = Any
#: Gaps up to so many pixels are closed, as a mesh of one piece closes them.
GAP = 5
#: Longest row of a blur [pixels].
BLUR = 9
#: Things stuck on a side that are no seams: boards, bands, frames, plates.
STUCK = 7
#: Parts of one object that have a surface of their own.
LOOKS = 256
VIEWS = len(SIDES)


@dataclass(frozen=True, eq=False)
class ObjectBatch:
    """Objects to learn from.

    Attributes:
        color: uint8, [n, 5, rows, columns, 3].
        depth: int16, [n, 5, rows, columns].
        part: uint8, [n, 5, rows, columns]; 0 all over for real objects.
        table: of moving parts, [n, most, ``COLUMNS``]; view -1 where there is nothing.
        whole: truths about them as wholes, columns as :class:`WholeTruth` has fields, [n, 4].
    """

    color: Tensor
    depth: Tensor
    part: Tensor
    table: Tensor
    whole: Tensor


@dataclass(frozen=True, eq=False)
class Shown:
    """What the network is given of a batch, [n, 5, CUES, rows, columns], and the truth there.

    ``front`` is the number of the side that is the front now; the rest is as in a batch.
    """

    cues: Tensor
    part: Tensor
    table: Tensor
    front: Tensor


def show(batch: ObjectBatch, textures: Tensor, generator: Any) -> Shown:
    """Return a batch as some image-to-3D tool would make it.

    ``textures`` are uint8, [m, 3, size, size]; ``generator`` is on the batch's device.
    """
    count = len(batch.color)
    draw = Drawing(generator, batch.color.device, count)
    real = batch.whole[:, 3] > 0
    color, depth, part, table, front = _placed(batch, real, draw)
    seen = depth.flatten(0, 1) >= 0
    part = part.flatten(0, 1)
    height = heights_of(depth.flatten(0, 1), seen)
    made = (~real).repeat_interleave(VIEWS)
    border = _borders(part)
    height, light = _shaped(height, seen, border, made, draw)
    paint = color.flatten(0, 1).permute(0, 3, 1, 2).float() / 255.0
    paint = _painted(paint, part, made, textures, draw)
    paint = _lit(paint, height, light, border, made, draw)
    cues = stacked_cues(paint, height, seen).unflatten(0, (count, VIEWS))
    return Shown(cues, part.reshape(count, VIEWS, CANVAS, CANVAS), table, front)


class Drawing:
    """Random numbers on a device, for so many objects."""

    def __init__(self, generator: Any, device: Any, count: int) -> None:
        self.generator = generator
        self.device = device
        self.count = count
        self.views = count * VIEWS

    def uniform(self, low: float, high: float, *shape: int) -> Tensor:
        """Return evenly drawn numbers."""
        drawn = torch.rand(shape, generator=self.generator, device=self.device)
        return low + (high - low) * drawn

    def normal(self, *shape: int) -> Tensor:
        """Return normally drawn numbers."""
        return torch.randn(shape, generator=self.generator, device=self.device)

    def happens(self, share: float, *shape: int) -> Tensor:
        """Return true with this probability."""
        return self.uniform(0.0, 1.0, *shape) < share

    def whole(self, high: int, *shape: int) -> Tensor:
        """Return whole numbers below ``high``."""
        return torch.randint(high, shape, generator=self.generator, device=self.device)

    def each(self, low: float, high: float) -> Tensor:
        """Return a number per object, the same for all its sides, [views of all, 1, 1]."""
        return self.uniform(low, high, self.count).repeat_interleave(VIEWS)[:, None, None]

    def some(self, share: float) -> Tensor:
        """Return a truth per object, [views of all, 1, 1]."""
        return self.each(0.0, 1.0) < share

    def wavy(self, cells: int) -> Tensor:
        """Return smooth random fields of standard deviation 1/2 or so, [views, rows, columns]."""
        knots = self.normal(self.views, 1, cells, cells)
        field = functional.interpolate(knots, (CANVAS, CANVAS), mode="bicubic", align_corners=False)
        return 0.6 * field[:, 0]


def _placed(batch: ObjectBatch, real: Tensor, draw: Drawing) -> tuple[Tensor, ...]:
    """Return objects stretched, mirrored and turned by quarters, with their tables."""
    count = draw.count
    stretch = torch.exp(draw.uniform(-0.3, 0.3, count, 3))
    stretch = torch.where(real[:, None], stretch**0.5, stretch)
    mirrored = draw.happens(0.5, count)
    seen = batch.depth >= 0
    extents = _extents(seen)
    grown = extents * stretch
    stretch = stretch * (LONGEST / grown.amax(1, keepdim=True)).clamp(max=1.6)
    grown = extents * stretch
    stretch = stretch * (LONGEST / grown.amax(1, keepdim=True)).clamp(max=1.0)
    x, y, z = stretch.unbind(1)
    across = torch.stack([x, y, x, y, x], 1)
    up = torch.stack([z, z, z, z, y], 1)
    behind = torch.stack([y, x, y, x, z], 1)
    steps = torch.arange(CANVAS, device=draw.device) + 0.5 - CANVAS / 2
    flip = torch.where(mirrored, -1.0, 1.0)[:, None, None]
    columns = (steps / across[..., None] * flip + CANVAS / 2).floor().long()[:, :, None]
    rows = (steps / up[..., None] + CANVAS / 2).floor().long()[..., None]
    inside = (columns >= 0) & (columns < CANVAS) & (rows >= 0) & (rows < CANVAS)
    index = (rows.clamp(0, CANVAS - 1) * CANVAS + columns.clamp(0, CANVAS - 1)).flatten(2)
    shape = (count, VIEWS, CANVAS, CANVAS)
    depth = batch.depth.flatten(2).gather(2, index).view(shape)
    deep = (depth.float() * behind[..., None, None]).round()
    depth = torch.where(inside & (depth >= 0), deep, -1.0)
    part = batch.part.flatten(2).gather(2, index).view(shape)
    part = torch.where(inside, part, 0)
    color = batch.color.flatten(2, 3).gather(2, index[..., None].expand(-1, -1, -1, 3))
    color = color.view(*shape, 3)
    table = _moved(batch.table, across, up, mirrored)
    swap = torch.tensor([0, 3, 2, 1, 4], device=draw.device)
    order = torch.where(mirrored[:, None], swap, torch.arange(VIEWS, device=draw.device))
    turn = draw.whole(4, count)
    round_ = torch.arange(4, device=draw.device)
    source = torch.cat([(round_ + turn[:, None]) % 4, torch.full_like(turn, 4)[:, None]], 1)
    order = order.gather(1, source)
    pick = torch.arange(count, device=draw.device)[:, None]
    color, depth, part = color[pick, order], depth[pick, order], part[pick, order]
    target = torch.argsort(order, 1)
    view = table[..., VIEW].long()
    table[..., VIEW] = torch.where(view >= 0, target.gather(1, view.clamp(min=0)), -1).float()
    front = target.gather(1, batch.whole[:, 2:3])[:, 0]
    return *_top_turned(color, depth, part, table, turn), front


def _extents(seen: Tensor) -> Tensor:
    """Return the extents of objects in pixels along x, y and z, [n, 3]."""
    wide = seen.any(2).sum(2).float()
    high = seen.any(3).sum(2).float()
    return torch.stack([wide[:, 0], wide[:, 1], high[:, 0]], 1).clamp(min=1.0)


def _moved(table: Tensor, across: Tensor, up: Tensor, mirrored: Tensor) -> Tensor:
    """Return tables of stretched and mirrored objects; sides are exchanged by the caller."""
    table = table.clone()
    view = table[..., VIEW].long().clamp(min=0)
    middle = CANVAS / 2
    factors = torch.stack([across.gather(1, view), up.gather(1, view)] * 2, -1)
    left, low, right, high = ((table[..., BOX] - middle) * factors).unbind(-1)
    flip = mirrored[:, None]
    ends = torch.where(flip, -right, left), low, torch.where(flip, -left, right), high
    table[..., BOX] = torch.stack(ends, -1) + middle
    way = table[..., WAY]
    swapped = torch.where(way == 0, 1.0, torch.where(way == 1, 0.0, way))
    table[..., WAY] = torch.where(flip, swapped, way)
    return table


def _top_turned(
    color: Tensor, depth: Tensor, part: Tensor, table: Tensor, turn: Tensor
) -> tuple[Tensor, ...]:
    """Return objects whose tops are turned as their sides are.

    After one quarter the right side is the front: the right of the top is at its lower edge.
    """
    color, depth, part, table = color.clone(), depth.clone(), part.clone(), table.clone()
    for quarters in (1, 2, 3):
        chosen = (turn == quarters).nonzero()[:, 0]
        if not len(chosen):
            continue
        for picture in (color, depth, part):
            # Row 0 is the lowest, so that this turns the way in which the hands of a clock go.
            picture[chosen, 4] = torch.rot90(picture[chosen, 4], quarters, (1, 2))
        rows = table[chosen]
        above = rows[..., VIEW] == 4
        for _ in range(quarters):
            box = rows[..., BOX]
            left, low, right, high = box.unbind(-1)
            turned = torch.stack([low, CANVAS - right, high, CANVAS - left], -1)
            rows[..., BOX] = torch.where(above[..., None], turned, box)
            way = rows[..., WAY]
            following = torch.tensor([3.0, 2.0, 0.0, 1.0, 4.0, 5.0, -1.0], device=way.device)
            rows[..., WAY] = torch.where(above, following[way.long()], way)
        table[chosen] = rows
    return color, depth, part, table


def _borders(part: Tensor) -> Tensor:
    """Return pixels at which two parts meet, [flat, rows, columns]."""
    differs = torch.zeros_like(part, dtype=torch.bool)
    level = (part[:, 1:] != part[:, :-1]) & (part[:, 1:] > 0) & (part[:, :-1] > 0)
    upright = (part[:, :, 1:] != part[:, :, :-1]) & (part[:, :, 1:] > 0) & (part[:, :, :-1] > 0)
    differs[:, 1:] |= level
    differs[:, :, 1:] |= upright
    return differs


def _blurred(pictures: Tensor, sigma: Tensor) -> Tensor:
    """Return pictures [n, c, rows, columns] blurred by sigma [n] pixels each."""
    steps = torch.arange(BLUR, device=pictures.device) - BLUR // 2
    kernel = torch.exp(-0.5 * (steps / sigma[:, None].clamp(min=0.05)) ** 2)
    kernel = kernel / kernel.sum(1, keepdim=True)
    count, channels = pictures.shape[:2]
    kernel = kernel.repeat_interleave(channels, 0)
    groups = count * channels
    flat = pictures.reshape(1, groups, CANVAS, CANVAS)
    pad = BLUR // 2
    flat = functional.pad(flat, (pad, pad, pad, pad), mode="replicate")
    flat = functional.conv2d(flat, kernel[:, None, None, :], groups=groups)
    flat = functional.conv2d(flat, kernel[:, None, :, None], groups=groups)
    return flat.view(count, channels, CANVAS, CANVAS)


def _shaped(
    height: Tensor, seen: Tensor, border: Tensor, made: Tensor, draw: Drawing
) -> tuple[Tensor, Tensor]:
    """Return surfaces with gaps closed, grooves, bumps and things stuck on, and brightness."""
    keep = made[:, None, None]
    height = torch.where(keep, closed(height[:, None], GAP)[:, 0], height)
    deep = draw.each(0.2, 2.5) * draw.some(0.8)
    wide = draw.some(0.5)
    groove = border.float()[:, None]
    groove = torch.where(wide[:, None], functional.max_pool2d(groove, 3, 1, 1), groove)[:, 0]
    patchy = (1.0 + 0.8 * draw.wavy(12)).clamp(0.2, 1.5)
    height = height - torch.where(keep, deep * patchy * groove, 0.0)
    stuck, light = _stuck(draw)
    stuck = torch.where(keep, stuck, 0.3 * stuck * draw.some(0.3))
    light = torch.where(keep, light, 1.0)
    height = height + stuck
    bumps = draw.each(0.0, 0.4) * draw.some(0.6) * draw.wavy(28)
    bumps = bumps + draw.each(0.0, 0.15) * draw.some(0.4) * draw.normal(*height.shape)
    sigma = torch.where(keep, draw.each(0.3, 1.3), draw.each(0.05, 0.7))
    height = _blurred((height + bumps)[:, None], sigma[:, 0, 0])[:, 0]
    lowest = torch.where(seen, height, 1e9).amin((1, 2), keepdim=True)
    return torch.where(seen, height, lowest - 4.0), light


def _stuck(draw: Drawing) -> tuple[Tensor, Tensor]:
    """Return heights [pixels] and brightness of boards, bands, frames and plates on each side."""
    flat = draw.views
    steps = torch.arange(CANVAS, device=draw.device, dtype=torch.float32)
    height = torch.zeros(flat, CANVAS, CANVAS, device=draw.device)
    light = torch.ones(flat, CANVAS, CANVAS, device=draw.device)
    busy = draw.some(0.6)
    for _ in range(STUCK):
        there = draw.happens(0.3, flat)[:, None, None] & busy
        middle = draw.uniform(0.1, 0.9, flat, 2) * CANVAS
        half = torch.exp(draw.uniform(0.7, 4.8, flat, 2))
        level = (steps - middle[:, :1]).abs() - half[:, :1]
        upright = (steps - middle[:, 1:]).abs() - half[:, 1:]
        outside = torch.maximum(level[:, :, None], upright[:, None, :])
        frame = draw.happens(0.4, flat)[:, None, None]
        rim = draw.uniform(1.0, 4.0, flat)[:, None, None]
        here = there & (outside < 0) & (~frame | (outside > -rim))
        step = draw.uniform(-1.5, 3.0, flat)[:, None, None]
        tone = draw.uniform(0.5, 1.3, flat)[:, None, None]
        height = height + step * here
        light = light * torch.where(here & draw.happens(0.6, flat)[:, None, None], tone, 1.0)
    planks = draw.some(0.25)
    apart = draw.each(10.0, 50.0)
    across = draw.some(0.5)
    phase = torch.where(across, steps[:, None], steps[None, :]) + draw.each(0.0, 50.0)
    line = planks & ((phase % apart) < draw.each(0.8, 2.2))
    painted = draw.some(0.5)
    height = height - line * draw.each(0.2, 1.5)
    return height, light * torch.where(line & painted, draw.each(0.5, 0.9), 1.0)


def _painted(paint: Tensor, part: Tensor, made: Tensor, textures: Tensor, draw: Drawing) -> Tensor:
    """Return colours with textures, or one colour all over; real ones keep their own."""
    flat = draw.views
    count = draw.count
    size = textures.shape[-1]
    whole = draw.whole(len(textures), count)[:, None].expand(-1, LOOKS)
    own = draw.whole(len(textures), count, LOOKS)
    few = own[:, :3].gather(1, draw.whole(3, count, LOOKS))
    choice = draw.uniform(0.0, 1.0, count)[:, None]
    chosen = torch.where(choice < 0.4, whole, torch.where(choice < 0.85, few, own))
    chosen = chosen.repeat_interleave(VIEWS, 0).gather(1, part.flatten(1).long())
    steps = torch.arange(CANVAS, device=draw.device, dtype=torch.float32)
    scale = draw.each(0.3, 2.0)
    turned = draw.some(0.5)
    rows = (steps[:, None] * scale + draw.uniform(0.0, size, flat)[:, None, None]).long() % size
    columns = (steps[None, :] * scale + draw.uniform(0.0, size, flat)[:, None, None]).long() % size
    at = torch.where(turned, columns * size + rows, rows * size + columns)
    bank = textures.flatten(2).permute(0, 2, 1).reshape(-1, 3)
    grain = bank[(chosen * size * size + at.flatten(1))].float() / 255.0
    grain = grain.view(flat, CANVAS, CANVAS, 3).permute(0, 3, 1, 2)
    plain = draw.uniform(0.1, 0.95, count, 3)
    gray = draw.happens(0.5, count)[:, None]
    plain = torch.where(gray, plain[:, :1].expand(-1, 3), plain)
    plain = plain.repeat_interleave(VIEWS, 0)[:, :, None, None]
    mode = draw.each(0.0, 1.0)[:, None]
    base = torch.where(mode < 0.3, plain.expand_as(paint), paint)
    textured = torch.where(mode < 0.45, grain, (base * (0.4 + grain)).clamp(0.0, 1.0))
    use = draw.some(0.55)[:, None]
    made_paint = torch.where(use, textured, base)
    washed = draw.some(0.15)[:, None] & ~made[:, None, None, None]
    real_paint = torch.where(washed, plain.expand_as(paint), paint)
    worn = draw.some(0.15)[:, None]
    real_paint = torch.where(worn, (real_paint * (0.4 + grain)).clamp(0.0, 1.0), real_paint)
    return torch.where(made[:, None, None, None], made_paint, real_paint)


def _lit(
    paint: Tensor, height: Tensor, light: Tensor, border: Tensor, made: Tensor, draw: Drawing
) -> Tensor:
    """Return colours with baked light, dark lines at seams, noise and another white balance."""
    dark = torch.where(draw.some(0.7), draw.each(0.3, 0.9), 1.0)
    light = light * torch.where(made[:, None, None] & border, dark, 1.0)
    slope_up = functional.pad(height[:, 2:] - height[:, :-2], (0, 0, 1, 1)).clamp(-4, 4)
    slope_right = functional.pad(height[:, :, 2:] - height[:, :, :-2], (1, 1)).clamp(-4, 4)
    baked = 1.0 + draw.each(-0.12, 0.12) * slope_up
    baked = baked + draw.each(-0.12, 0.12) * slope_right
    sunken = (closed(height[:, None], GAP)[:, 0] - height).clamp(0.0, 5.0)
    baked = baked * (1.0 - draw.each(0.0, 0.1) * sunken)
    light = light * baked.clamp(0.3, 1.7) * (1.0 + 0.2 * draw.some(0.6) * draw.wavy(5))
    light = light * (1.0 + 0.06 * draw.some(0.3) * draw.normal(*height.shape))
    gain = draw.uniform(0.7, 1.3, draw.count, 3).repeat_interleave(VIEWS, 0)[:, :, None, None]
    shaded = draw.uniform(0.15, 1.2, draw.views)[:, None, None]
    light = light * torch.where(draw.some(0.4), shaded, 1.0)
    paint = (paint * light[:, None] * gain).clamp(0.0, 1.0)
    gamma = draw.each(0.7, 1.4)[:, None]
    paint = paint.clamp(min=1e-4) ** gamma
    faded = draw.each(0.0, 1.0)[:, None] ** 3
    paint = paint + faded * (paint.mean(1, keepdim=True) - paint)
    return _blurred(paint, draw.each(0.05, 1.2)[:, 0, 0])
