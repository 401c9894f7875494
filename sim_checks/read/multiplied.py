"""How much a short MJCF becomes once MuJoCo has multiplied it, counted before it compiles."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterable
from functools import cached_property
from pathlib import Path

from ..description import DescriptionError
from .document import inside, parse_document
from .references import ModelWalk, MujocoModel

#: A line of text can make a million. Copies are elements that stand in a ``replicate``, or in a
#: model that is attached; the compiler takes time by their square, 16 s for so many.
MOST = {"bodies": 10_000, "geoms": 20_000, "copies": 20_000}
_COUNTED = {"body": "bodies", "geom": "geoms"}
#: Elements that make a body of every point of a grid.
_GRIDS = ("composite", "flexcomp")
_LARGEST = 10**12


def refuse_multiplied(path: Path, document: ET.Element) -> None:
    """Refuse an MJCF that becomes too much: by ``replicate``, grids, includes, attached models.

    The outermost file is given with its root element.

    Raises:
        DescriptionError: ``too_large``, or the fault of an inner document.
    """
    folder = path.parent.resolve()
    walk = ModelWalk(lambda place: inside(place, folder))
    model = walk.model(folder / path.name, document)
    counts = _ElementCount(model, {}).all
    for what, most in MOST.items():
        if counts[what] > most:
            becomes = f"{counts[what]:,} {what} once compiled"
            message = f"{path.name}: {becomes}, at most {most:,} are read"
            raise DescriptionError("too_large", message)


class _ElementCount:
    """Counts what a model becomes, each document once however often it is named.

    Attributes:
        all: as in :data:`MOST`, and ``elements``.
    """

    def __init__(self, model: MujocoModel, attached: dict[Path, Counter[str]]) -> None:
        self._model = model
        self._attached = attached
        self._documents = dict(model.documents)
        self._known: dict[Path, Counter[str]] = {}
        self.all = self._of(model.documents[0][0])

    def _of(self, path: Path) -> Counter[str]:
        """Return what a document of the model becomes."""
        if path not in self._known:
            # A document that holds itself ends here; others refuse it.
            self._known[path] = Counter()
            self._known[path] = self._counted(path)
        return self._known[path]

    def _counted(self, path: Path) -> Counter[str]:
        counts: Counter[str] = Counter()
        waiting = [(self._documents[path], 1)]
        while waiting:
            element, times = waiting.pop()
            if element.tag == "replicate":
                times = min(times * _whole(element.get("count", "")), _LARGEST)
            own = self._own(element, path)
            if times != 1:
                own["copies"] = own["elements"]
            for what, number in own.items():
                counts[what] = min(counts[what] + times * number, _LARGEST)
            waiting += [(inner, times) for inner in element]
        return counts

    def _own(self, element: ET.Element, path: Path) -> Counter[str]:
        """Return what one element becomes, without those written in it."""
        own = Counter(elements=1)
        if element.tag in _COUNTED:
            own[_COUNTED[element.tag]] = 1
        elif element.tag in _GRIDS:
            own["bodies"] = math.prod(map(_whole, element.get("count", "").split()))
        elif element.tag == "include":
            inner = self._model.inner(element, path)
            own |= _most(self._of(each) for each in inner if each in self._documents)
        elif element.tag == "attach":
            own |= self._attachable
            own["copies"] = own["elements"]
        return own

    @cached_property
    def _attachable(self) -> Counter[str]:
        """Return the most that an ``attach`` brings: it may mean any model that is named."""
        return _most(map(self._of_model, self._model.attached()))

    def _of_model(self, file: Path) -> Counter[str]:
        if file not in self._attached:
            self._attached[file] = Counter()
            model = ModelWalk(self._model.allows).model(file, parse_document(file))
            self._attached[file] = _ElementCount(model, self._attached).all
        return self._attached[file]


def _most(counts: Iterable[Counter[str]]) -> Counter[str]:
    most: Counter[str] = Counter()
    for each in counts:
        most |= each
    return most


def _whole(text: str) -> int:
    """Return a whole number as written; any other counts once, and the compiler refuses it."""
    word = text.strip()
    return min(int(word[:13]), _LARGEST) if word.isdecimal() else 1
