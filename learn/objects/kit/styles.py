"""Looks and proportions of casework, drawn at random."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from asset_factory.factory.mesh import Material

from .chance import Chance
from .looks import BLACK, BLUE, BRASS, GREEN, OAK, RED, STEEL, WALNUT, WHITE
from .panels import OPEN_STYLES
from .pulls import Pull, any_pull

#: How often doors wear each style.
PANELS: dict[str, float] = {
    "slab": 0.42, "bevel": 0.08, "shaker": 0.16, "raised": 0.09, "glazed": 0.06, "mullion": 0.03,
    "louvre": 0.04, "planks": 0.05, "bowed": 0.02, "two_fields": 0.05,
}  # fmt: skip
#: Heights of pulls on doors below a worktop, as shares of a door's.
HIGH = (0.85, 0.8)


@dataclass(frozen=True)
class Style:
    """What all fronts of one case share.

    Attributes:
        board, front: thickness of the case's boards, and of doors and drawer fronts [m].
        gap: between fronts that lie beside each other [m].
        behind: between a front and what it covers [m].
        reveal: how much of the case's edge an overlaid front leaves bare [m].
        inset: fronts lie in their openings instead of covering the case's edges.
        recess: how far inset fronts lie behind the case's edges [m].
        hollow: the case has an inside; else its cells are filled, as those of generated ones.
        bare: stacked drawers have no boards between them.
        panel, upper, drawer: styles of doors, of those in the upper half, of drawer fronts.
        rail: width of frames [m].
        pull: worn by all of them.
        pull_at, drawer_pull_at: heights of pulls as shares of their doors' and drawers'.
        pairs: wide drawers have two pulls.
        taste: place of hinge axes in thicknesses behind the face.
        slide: how far drawers come out, in depths.
        solid: drawers are blocks instead of boxes.
        shelves: at most so many per cell.
        body, face, inside: looks.
        covered: something stands out above the fronts, so that flaps stop early.
        crowded: other fronts lie to the left and the right of the case.
        backless: the case is a frame, as of a window.
        sill: the case has a board at its foot.
    """

    board: float
    front: float
    gap: float
    behind: float
    reveal: float
    inset: bool
    recess: float
    hollow: bool
    bare: bool
    panel: str
    upper: str
    drawer: str
    rail: float
    pull: Pull
    pull_at: float
    drawer_pull_at: float
    pairs: bool
    taste: float
    slide: float
    solid: bool
    shelves: int
    body: Material
    face: Material
    inside: Material
    covered: bool = False
    crowded: bool = False
    backless: bool = False
    sill: bool = True

    @property
    def proud(self) -> float:
        """Return how far fronts stand out of the case's edges [m]; below 0 where within."""
        return -self.recess if self.inset else self.behind + self.front


def any_color(chance: Chance) -> Material:
    """Return a plain look for wood, paint or metal."""
    return chance.pick(WHITE, WHITE, OAK, WALNUT, BLACK, GREEN, BLUE, RED, STEEL)


def any_metal(chance: Chance) -> Material:
    """Return a plain look for handles."""
    return chance.pick(STEEL, BLACK, BRASS)


def any_style(
    chance: Chance,
    panels: Mapping[str, float] | None = None,
    inset: float = 0.3,
    hollow: float = 0.76,
    pull_at: tuple[float, ...] = (0.5, 0.75, 0.3, 0.85),
) -> Style:
    """Return a style of casework.

    ``panels`` are styles of the doors and their weights (:data:`PANELS` if not given), ``inset``
    and ``hollow`` shares of cases, ``pull_at`` heights to choose from as shares of a door's height.
    """
    pick = chance.pick
    happens = chance.happens
    style = chance.weighted(panels or PANELS)
    body = any_color(chance)
    is_inset = happens(inset)
    upper = style if panels or happens(0.85) else chance.weighted(PANELS)
    plain = style in (*OPEN_STYLES, "bowed") or happens(0.3)
    return Style(
        board=pick(0.012, 0.016, 0.018, 0.02, 0.025, 0.032),
        front=pick(0.012, 0.016, 0.018, 0.02, 0.022, 0.026),
        gap=float(np.exp(chance.draw(np.log(0.0005), np.log(0.006)))),
        behind=pick(0.0, 0.0005, 0.002, 0.003),
        reveal=pick(0.0, 0.0, 0.0, 0.002, 0.008),
        inset=is_inset,
        recess=pick(0.0, 0.0, 0.002, 0.006) if is_inset else 0.0,
        hollow=happens(hollow) or style in OPEN_STYLES or upper in OPEN_STYLES,
        bare=happens(0.45),
        panel=style,
        upper=upper,
        drawer="slab" if plain else style,
        rail=chance.draw(0.035, 0.085),
        pull=any_pull(chance, any_metal(chance)),
        pull_at=pick(*pull_at),
        drawer_pull_at=pick(0.5, 0.5, 0.65, 0.8),
        pairs=happens(0.35),
        taste=pick(0.0, 0.0, 0.0, 0.5, 0.5, 1.0, -0.2),
        slide=pick(0.45, 0.6, 0.75, 0.85, 0.95, 1.0),
        solid=happens(0.15),
        shelves=chance.count(0, 5),
        body=body,
        face=body if happens(0.55) else any_color(chance),
        inside=body if happens(0.7) else WHITE,
    )


def convex_style(chance: Chance, skin: Material, **changes: Any) -> Style:
    """Return the demo's style: convex forms only, gaps that leave no doubt about parts."""
    style = any_style(chance, {"slab": 0.5, "shaker": 0.5}, 0.0, 1.0, (0.75, 0.85))
    kind = chance.pick("bar", "rail", "knob")
    reach = 0.03 if kind == "knob" else 0.041
    pull = Pull(kind, chance.draw(0.13, 0.16), reach, 0.012, any_metal(chance), root=0.0)
    demo = replace(
        style, gap=0.003, behind=0.003, reveal=0.0, taste=0.0, bare=False, solid=False, pull=pull,
        body=skin, inside=skin, face=skin, slide=0.85, upper=style.panel, drawer="slab",
    )  # fmt: skip
    return replace(demo, **changes)
