"""Things to pull at, on a face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asset_factory.factory.mesh import Material

from .assembly import PartDraft
from .axes import BACK, Place, X, Y
from .boards import frame
from .chance import Chance
from .outlines import arc
from .shapes import Form, box, cylinder, lathe, pipe, prism, ribbon
from .spans import Flat, Profile, Span, about, ends, span, within

#: Kinds of pull and how often each is drawn; ``none``: the front is moved by its edge.
KINDS: dict[str, float] = {
    "bar": 0.2, "rail": 0.12, "bow": 0.16, "knob": 0.16, "ball": 0.07, "cup": 0.06,
    "lip": 0.05, "recess": 0.06, "strap": 0.04, "none": 0.08,
}  # fmt: skip


@dataclass(frozen=True)
class Pull:
    """The pull that all fronts of one object wear.

    Attributes:
        kind: one of :data:`KINDS`.
        length: along it [m]; of a knob, nothing.
        reach: how far it stands out [m].
        thickness: of its bar [m].
        look: of all of it.
        root: how far its feet reach into its panel, so that they meet it under any relief [m].
    """

    kind: str
    length: float
    reach: float
    thickness: float
    look: Material
    root: float = 0.008


def any_pull(chance: Chance, look: Material, *kinds: str) -> Pull:
    """Return a pull of the given kinds, or of any."""
    kind = chance.weighted({name: KINDS[name] for name in kinds or KINDS})
    length, reach, thickness = chance.draws((0.08, 0.32), (0.018, 0.045), (0.006, 0.016))
    return Pull(kind, length, reach, thickness, look)


def add_pull(
    part: PartDraft, pull: Pull, at: Flat, place: Place, room: float, upright: bool = False
) -> None:
    """Add a pull about a point of a face, along it or ``upright``.

    It becomes no longer than ``room`` [m] allows.
    """
    length = min(pull.length, 0.9 * room)
    if pull.kind == "none" or length < 0.02:
        return
    for form in _forms(pull, length / 2, upright):
        placed = form.turned(BACK, -np.pi / 2) if upright else form
        part.add(placed.shifted((at[0], 0.0, at[1])).moved(place), look=pull.look)


def _forms(pull: Pull, half: float, upright: bool) -> list[Form]:
    """Return the pull along x, about the origin of its plane y = 0."""
    if pull.kind in ("knob", "ball"):
        return _knob(pull)
    if pull.kind == "bow":
        t = np.linspace(-1.0, 1.0, 9)
        out = pull.root - (pull.reach - pull.thickness / 2 + pull.root) * (1.0 - np.abs(t) ** 3)
        return [pipe(np.stack([half * t, out, 0 * t], axis=1), pull.thickness / 2, 8)]
    if pull.kind == "recess":
        return _recess(pull, about(half))
    if pull.kind == "lip" and not upright:
        return _lip(pull, min(pull.reach, 0.03), about(half))
    if pull.kind == "cup" and not upright:
        return _cup(min(pull.reach, 0.03), about(half))
    return _bar(pull, about(half))


def _bar(pull: Pull, along: Span) -> list[Form]:
    r = pull.thickness / 2
    middle = r - pull.reach
    if pull.kind == "bar":
        forms = [cylinder(X, (middle, 0.0), r, along, 10)]
    else:
        wide = (1.8 if pull.kind == "strap" else 1.0) * r
        forms = [box(along, about(r, middle), about(wide))]
    inset = min(0.02 if pull.kind == "bar" else r, along[1] / 2)
    foot = (middle, pull.root)
    feet = (box(about(0.7 * r, end), foot, about(0.7 * r)) for end in within(along, inset))
    return [*forms, *feet]


def _knob(pull: Pull) -> list[Form]:
    r = 0.8 * pull.thickness + 0.006
    stem = 0.5 * r
    tip = -pull.reach
    if pull.kind == "ball":
        s = np.linspace(0.15, np.pi - 0.3, 6)
        ball: Profile = np.stack([r * np.sin(s), tip + r - r * np.cos(s)], axis=1).tolist()
        ball = [p for p in ball if p[1] < -0.002]
        return [lathe([*ball, (stem, -0.001), (stem, pull.root)], axis=Y, sides=12)]
    head = tip + 0.45 * pull.reach
    disc = [(0.85 * r, tip), (r, tip + 0.003), (r, head)]
    return [lathe(disc, axis=Y, sides=12), cylinder(Y, (0.0, 0.0), stem, (head, pull.root), 12)]


def _recess(pull: Pull, along: Span) -> list[Form]:
    """Return a shell let into the face; its rim stands a hair proud of it."""
    across = about(max(0.012, pull.thickness))
    deep = (-0.0015, 0.004)
    floor = box(within(along, 0.004), (-0.0004, 0.004), within(across, 0.004))
    return [*frame(along, deep, across, 0.004), floor]


def _lip(pull: Pull, reach: float, along: Span) -> list[Form]:
    """Return a lip bent from a plate."""
    return [
        box(along, (-0.002, pull.root), about(0.012)),
        box(along, (-reach, -0.002), (0.009, 0.012)),
        box(along, span(-reach, 0.003), (-0.002, 0.009)),
    ]


def _cup(reach: float, along: Span) -> list[Form]:
    """Return a quarter shell to reach under, with its two cheeks."""
    way = arc((0.0, 0.0), 1.0, np.pi, np.pi / 2, 6)
    outer = way * (reach, 0.03) - (0.0, 0.015)
    shell = ribbon(outer, outer - 0.003 * way, along, X)
    cheek = np.vstack([[(0.001, -0.015)], outer[::-1]])
    return [shell, *(prism(cheek, end, X) for end in ends(along, 0.003))]
