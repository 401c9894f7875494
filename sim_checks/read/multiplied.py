"""How much a short MJCF becomes once MuJoCo has multiplied it, counted before it compiles."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterable
from functools import cache, reduce
from operator import or_
from pathlib import Path

from ..description import DescriptionError
from .references import MujocoModel

#: A line of text can make a million. Copies are elements that stand in a ``replicate``, or in a
#: model that is attached; the compiler takes time by their square, 16 s for so many.
MOST = {"bodies": 10_000, "geoms": 20_000, "copies": 20_000}
_COUNTED = {"body": "bodies", "geom": "geoms"}
#: Elements that make a body of every point of a grid.
_GRIDS = ("composite", "flexcomp")
_LARGEST = 10**12


def refuse_multiplied(name: str, models: Iterable[MujocoModel]) -> None:
    """Refuse an MJCF that becomes too much: by ``replicate``, grids, includes, attached models.

    Args:
        name: of the file, for the sentence.
        models: the file's own and those that it attaches, see :func:`.references.follow_models`.

    Raises:
        DescriptionError: ``too_large``.
    """
    counts = _ElementCount(models).all
    for what, most in MOST.items():
        if counts[what] > most:
            becomes = f"{name}: {counts[what]:,} {what} once compiled"
            raise DescriptionError("too_large", f"{becomes}, at most {most:,} are read")


class _ElementCount:
    """Counts what models become, each document of each once however often it is named.

    Attributes:
        all: of the first model, as in :data:`MOST`, and ``elements``.
    """

    def __init__(self, models: Iterable[MujocoModel]) -> None:
        self._models = {model.main: model for model in models}
        self._roots = {main: dict(model.documents) for main, model in self._models.items()}
        self._of = cache(self._counted)
        self._attachable = cache(self._most_attached)
        first = next(iter(self._models))
        self.all = self._of(first, first)

    def _counted(self, main: Path, path: Path) -> Counter[str]:
        """Return what a document of the model with that main file becomes."""
        counts: Counter[str] = Counter()
        waiting = [(self._roots[main][path], 1)]
        while waiting:
            element, times = waiting.pop()
            if element.tag == "replicate":
                times = min(times * _whole(element.get("count", "")), _LARGEST)
            own = self._own(element, main)
            if times != 1:
                own["copies"] = own["elements"]
            for what, number in own.items():
                counts[what] = min(counts[what] + times * number, _LARGEST)
            waiting += [(inner, times) for inner in element]
        return counts

    def _own(self, element: ET.Element, main: Path) -> Counter[str]:
        """Return what one element of a model becomes, without those written in it."""
        own = Counter(elements=1)
        if element.tag in _COUNTED:
            own[_COUNTED[element.tag]] = 1
        elif element.tag in _GRIDS:
            own["bodies"] = math.prod(map(_whole, element.get("count", "").split()))
        elif element.tag == "include":
            own |= _most(self._of(main, each) for each in self._models[main].inner.get(element, ()))
        elif element.tag == "attach":
            own |= self._attachable(main)
            own["copies"] = own["elements"]
        return own

    def _most_attached(self, main: Path) -> Counter[str]:
        """Return the most that an ``attach`` brings: it may mean any model that is named."""
        return _most(self._of(model, model) for model in self._models[main].attached)


def _most(counts: Iterable[Counter[str]]) -> Counter[str]:
    return reduce(or_, counts, Counter())


def _whole(text: str) -> int:
    """Return a whole number as written; any other counts once, and the compiler refuses it."""
    word = text.strip()
    return min(int(word[:13]), _LARGEST) if word.isdecimal() else 1
