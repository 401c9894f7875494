"""Charts as inline SVG; numbers are in their labels, and in a tip over each mark."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor

from ...jobs.nightly.night import Night
from ...jobs.nightly.words import percent
from .markup import text

WIDTH = 760
#: Nights in the trend; earlier ones are in the list of nights.
NIGHTS = 60
_LEFT, _RIGHT = 48, 62
_TOP, _YIELD, _GAP, _COUNTS = 12, 130, 18, 56
_ROW, _BAR, _LABEL, _TOLD = 24, 14, 170, 310


@dataclass(frozen=True)
class Bar:
    """One bar.

    Attributes:
        label: on its left.
        value: its length, in any unit.
        told: on its right.
        kind: a verdict, which gives its colour; or empty.
    """

    label: str
    value: float
    told: str
    kind: str = ""


def bars(rows: Sequence[Bar], title: str) -> str:
    """Horizontal bars, from the top in the order given."""
    if not rows:
        return ""
    longest = max(row.value for row in rows) or 1.0
    room = WIDTH - _LABEL - _TOLD
    marks = []
    for number, row in enumerate(rows):
        top, length = number * _ROW + (_ROW - _BAR) / 2, max(1.0, room * row.value / longest)
        base = top + _BAR - 3
        kind = f"bar {row.kind}".strip()
        marks.append(
            f"<g><title>{text(row.label)}: {text(row.told)}</title>"
            f'<text x="{_LABEL - 10}" y="{base:g}" text-anchor="end">{text(row.label, 26)}</text>'
            f'<rect class="{kind}" x="{_LABEL}" y="{top:g}" width="{length:.1f}" height="{_BAR}" rx="2"/>'
            f'<text class="strong" x="{_LABEL + length + 8:.1f}" y="{base:g}">{text(row.told)}</text></g>'
        )
    return _svg(len(rows) * _ROW, title, marks)


def trend(nights: Sequence[Night]) -> str:
    """The share that passed over the last nights, and below it how many inputs had each verdict."""
    recent = [night for night in nights if night.attempted][-NIGHTS:]
    if len(recent) < 2:
        return ""
    step = (WIDTH - _LEFT - _RIGHT) / len(recent)
    centres = [_LEFT + step * (number + 0.5) for number in range(len(recent))]
    height = _TOP + _YIELD + _GAP + _COUNTS + 22
    marks = [
        *_curve(recent, centres),
        *_stacks(recent, centres, step),
        *_names(recent, centres, height - 6),
    ]
    return _svg(height, "Yield and number of inputs, night by night", marks)


def _curve(nights: Sequence[Night], centres: Sequence[float]) -> list[str]:
    shares = [night.passed / night.attempted for night in nights]
    least = max(0.0, floor(min(shares) * 10.0 - 0.5) / 10.0)
    least = min(least, 0.8)
    heights = [_TOP + _YIELD * (1.0 - (share - least) / (1.0 - least)) for share in shares]
    marks = []
    for part in (0.0, 0.5, 1.0):
        y, told = _TOP + _YIELD * (1.0 - part), f"{100 * (least + part * (1.0 - least)):.0f} %"
        marks.append(
            f'<line class="grid" x1="{_LEFT}" x2="{WIDTH - _RIGHT}" y1="{y:g}" y2="{y:g}"/>'
        )
        marks.append(f'<text x="{_LEFT - 8}" y="{y + 4:g}" text-anchor="end">{told}</text>')
    corners = " ".join(f"{x:.1f},{y:.1f}" for x, y in zip(centres, heights, strict=True))
    marks.append(f'<polyline class="curve" points="{corners}"/>')
    for night, x, y in zip(nights, centres, heights, strict=True):
        marks.append(
            f'<circle class="dot" cx="{x:.1f}" cy="{y:.1f}" r="4"><title>{_tip(night)}</title></circle>'
        )
    marks.append(
        f'<text class="strong" x="{centres[-1] + 9:.1f}" y="{heights[-1] + 4:.1f}">{percent(shares[-1])}</text>'
    )
    return marks


def _stacks(nights: Sequence[Night], centres: Sequence[float], step: float) -> list[str]:
    floor_y, most = _TOP + _YIELD + _GAP + _COUNTS, max(night.attempted for night in nights)
    width = min(26.0, 0.7 * step)
    marks = [
        f'<line class="grid" x1="{_LEFT}" x2="{WIDTH - _RIGHT}" y1="{floor_y}" y2="{floor_y}"/>',
        f'<text x="{_LEFT - 8}" y="{floor_y - _COUNTS + 8}" text-anchor="end">{most:,}</text>',
        f'<text x="{_LEFT - 8}" y="{floor_y + 4}" text-anchor="end">0</text>',
    ]
    for night, x in zip(nights, centres, strict=True):
        top, blocks = float(floor_y), []
        for kind in ("passed", "rejected", "unjudged"):
            height = _COUNTS * getattr(night, kind) / most
            top -= height
            if height:
                blocks.append(
                    f'<rect class="bar {kind}" x="{x - width / 2:.1f}" y="{top:.2f}" '
                    f'width="{width:.1f}" height="{height:.2f}"/>'
                )
        marks.append(f"<g><title>{_tip(night)}</title>{''.join(blocks)}</g>")
    return marks


def _names(nights: Sequence[Night], centres: Sequence[float], y: float) -> list[str]:
    every = max(1, -(-len(nights) // 8))
    told = [number for number in range(len(nights)) if (len(nights) - 1 - number) % every == 0]
    return [
        f'<text x="{centres[n]:.1f}" y="{y:g}" text-anchor="middle">{text(nights[n].name, 10)}</text>'
        for n in told
    ]


def _tip(night: Night) -> str:
    counts = f"{night.passed:,} passed, {night.rejected:,} rejected, {night.unjudged:,} unjudged"
    return f"{text(night.name)}: {percent(night.yielded)}; {counts}"


def _svg(height: float, title: str, marks: Sequence[str]) -> str:
    body = "\n".join(marks)
    return f'<svg viewBox="0 0 {WIDTH} {height:g}" role="img" aria-label="{text(title)}">\n{body}\n</svg>'
