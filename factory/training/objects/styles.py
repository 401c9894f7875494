"""Looks and proportions of casework, drawn at random."""

from __future__ import annotations

import numpy as np

from ...mesh import Material
from .casework import Style
from .grips import any_grip
from .looks import BLACK, BLUE, BRASS, GLASS, GREEN, OAK, RED, STEEL, WALNUT, WHITE, pick
from .panels import OPEN_STYLES

#: How often doors wear each style.
PANELS: dict[str, float] = {
    "slab": 0.42, "bevel": 0.08, "shaker": 0.16, "raised": 0.09, "glazed": 0.06, "mullion": 0.03,
    "louvre": 0.04, "planks": 0.05, "bowed": 0.02, "two_fields": 0.05,
}  # fmt: skip


def drawn(rng: np.random.Generator, weights: dict[str, float]) -> str:
    """One of the names, by weight."""
    names = list(weights)
    weight = np.array(list(weights.values()))
    return names[int(rng.choice(len(names), p=weight / weight.sum()))]


def any_color(rng: np.random.Generator) -> Material:
    """A plain look for wood, paint or metal."""
    return pick(rng, WHITE, WHITE, OAK, WALNUT, BLACK, GREEN, BLUE, RED, STEEL)


def any_metal(rng: np.random.Generator) -> Material:
    """A plain look for handles."""
    return pick(rng, STEEL, BLACK, BRASS)


def any_style(
    rng: np.random.Generator,
    panels: dict[str, float] | None = None,
    inset: float = 0.3,
    hollow: float = 0.76,
    grip_at: tuple[float, ...] = (0.5, 0.75, 0.3, 0.85),
) -> Style:
    """A style of casework.

    Args:
        rng: where it comes from.
        panels: styles of the doors and their weights; :data:`PANELS` if not given.
        inset: share whose fronts lie in their openings.
        hollow: share that has an inside.
        grip_at: heights of grips to choose from, as shares of a door's height.
    """
    style = drawn(rng, panels or PANELS)
    body = any_color(rng)
    is_inset = bool(rng.random() < inset)
    is_hollow = bool(rng.random() < hollow)
    upper = style if panels or rng.random() < 0.85 else drawn(rng, PANELS)
    drawer = style if rng.random() < 0.7 and style not in (*OPEN_STYLES, "bowed") else "slab"
    return Style(
        board=float(rng.choice([0.012, 0.016, 0.018, 0.02, 0.025, 0.032])),
        front=float(rng.choice([0.012, 0.016, 0.018, 0.02, 0.022, 0.026])),
        gap=float(np.exp(rng.uniform(np.log(0.0005), np.log(0.006)))),
        behind=float(rng.choice([0.0, 0.0005, 0.002, 0.003])),
        reveal=float(rng.choice([0.0, 0.0, 0.0, 0.002, 0.008])),
        inset=is_inset,
        recess=float(rng.choice([0.0, 0.0, 0.002, 0.006])) if is_inset else 0.0,
        hollow=is_hollow or style in OPEN_STYLES or upper in OPEN_STYLES,
        bare=bool(rng.random() < 0.45),
        panel=style,
        upper=upper,
        drawer=drawer,
        rail=float(rng.uniform(0.035, 0.085)),
        grip=any_grip(rng, any_metal(rng)),
        grip_at=float(rng.choice(grip_at)),
        drawer_grip_at=float(rng.choice([0.5, 0.5, 0.65, 0.8])),
        pairs=bool(rng.random() < 0.35),
        taste=float(rng.choice([0.0, 0.0, 0.0, 0.5, 0.5, 1.0, -0.2])),
        slide=float(rng.choice([0.45, 0.6, 0.75, 0.85, 0.95, 1.0])),
        solid=bool(rng.random() < 0.15),
        shelves=int(rng.integers(0, 6)),
        covered=False,
        crowded=False,
        body=body,
        face=body if rng.random() < 0.55 else any_color(rng),
        glass=GLASS,
        inside=body if rng.random() < 0.7 else WHITE,
    )
