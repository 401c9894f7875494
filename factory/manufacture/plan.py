"""How an object is made differently from the plain way, because a repair asks for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

Pair = tuple[str, str]


@dataclass(frozen=True)
class Plan:
    """How the next round is made differently from the plain one.

    Attributes:
        separate: pairs of part names whose hulls are cut apart, where the meshes themselves allow
            it.
        exclude: pairs that MuJoCo is told not to collide: the knuckles of hinges, which other
            engines ignore.
        upper: joint name -> shortened upper limit [rad] or [m].
        frozen: dispensable joints that cannot move, made fixed.
        given_up: guessed joints whose parts cannot be parts of their own, made one with what they
            hang on.
        steps: what was decided, one sentence each, oldest first.
    """

    separate: frozenset[Pair] = frozenset()
    exclude: frozenset[Pair] = frozenset()
    upper: Mapping[str, float] = field(default_factory=dict)
    frozen: frozenset[str] = frozenset()
    given_up: frozenset[str] = frozenset()
    steps: tuple[str, ...] = ()


@dataclass(frozen=True)
class Spare:
    """What the object is still worth having without.

    Attributes:
        joints: that may be frozen.
        guesses: part -> its joint, where both are guesses and there is a surer one; the least sure
            first.
    """

    joints: frozenset[str] = frozenset()
    guesses: Mapping[str, str] = field(default_factory=dict)
