"""Parts that somebody states: ``fridge.parts.json`` or ``.parts.toml`` beside ``fridge.glb``.

A person, a vision-language model or a script says which parts open; where exactly they are is found
on the mesh. The classes here are the file's format, and its JSON schema is made from them.
"""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, Literal

from msgspec import Meta, Struct, ValidationError, convert
from msgspec.structs import replace

from ..errors import ConfigError
from ..part import PartKind
from ..views.raster import Side
from .files import InputFiles
from .sidecar import bad_sidecar, find_beside, read_beside

MOST_BYTES = 256 * 1024
MOST_PARTS = 128
SLIDES = "a drawer slides, so that it has no hinge"
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_.-]{0,63}")

#: Names that no stated part may have.
RESERVED = ("base", "world")
#: Degrees or millimetres that a part moves.
Amount = Annotated[float, Meta(ge=-10_000.0, le=10_000.0)]
Share = Annotated[float, Meta(ge=0.0, le=1.0)]
#: Left, lower, right and upper edge, in shares of a side's picture: x to the right, y up.
Box = tuple[Share, Share, Share, Share]


class Hinge(StrEnum):
    """Edge at which a part is hinged: of its side's picture, or of the object seen from above."""

    LEFT = "left"
    RIGHT = "right"
    TOP = "top"
    BOTTOM = "bottom"
    FRONT = "front"
    BACK = "back"


class StatedKind(StrEnum):
    """What somebody may say that opens: the kinds of parts, and everyday words for some."""

    DOOR = "door"
    DRAWER = "drawer"
    FLAP = "flap"
    LID = "lid"
    SEAT = "seat"
    SCREEN = "screen"
    RACK = "rack"
    KNOB = "knob"
    BUTTON = "button"
    LEVER = "lever"
    CAP = "cap"
    WHEEL = "wheel"
    SAIL = "sail"
    TURNTABLE = "turntable"

    @property
    def part(self) -> PartKind:
        """Return the kind of the part."""
        return _EVERYDAY.get(self) or PartKind(self.value)


_EVERYDAY: Mapping[StatedKind, PartKind] = {
    StatedKind.SEAT: PartKind.LID,
    StatedKind.SAIL: PartKind.WHEEL,
}


class StatedView(Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Where a part is seen on one side.

    Attributes:
        side: as somebody sees it who stands before the object's front.
        box: the part's rectangle there.
    """

    side: Side
    box: Box

    def __post_init__(self) -> None:
        if self.box[0] >= self.box[2] or self.box[1] >= self.box[3]:
            raise ValueError("box is [x0, y0, x1, y1] with x0 < x1 and y0 < y1")


class StatedAlternative(Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Another way in which a part may open.

    Attributes:
        kind: what else it may be; as stated, if left out.
        hinge: where else it may be hinged; ``None``: wherever fits.
    """

    kind: StatedKind | None = None
    hinge: Hinge | None = None

    def __post_init__(self) -> None:
        if self.kind is None and self.hinge is None:
            raise ValueError("an alternative has a kind, a hinge or both")
        if self.kind is StatedKind.DRAWER and self.hinge is not None:
            raise ValueError(SLIDES)


class StatedPart(Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """One part that opens; everything but its kind may be left out.

    Attributes:
        kind: ``door``, ``drawer``, ``flap``, ``lid``, ``knob`` ...
        side: on which it is seen.
        box: its rectangle on that side; a lid on top is stated by a side's box above its seam.
        hinge: edge of the box, or, of a lid, edge of the object; left out: wherever fits.
        name: of the link.
        range: joint limits [deg] or [mm], with 0 as drawn.
        parent: name of the part that carries it.
        count: of alike parts whose places are not stated.
        drawn: how far it stands open in the mesh [deg] or [mm], or ``"open"``.
        alternatives: other ways in which it may open, tried after this one.
        also: where further sides show it, which bounds its depth.
    """

    kind: StatedKind
    side: Side | None = None
    box: Box | None = None
    hinge: Hinge | None = None
    name: str | None = None
    range: tuple[Amount, Amount] | None = None
    parent: str | None = None
    count: Annotated[int, Meta(ge=1, le=MOST_PARTS)] = 1
    drawn: Annotated[float, Meta(gt=0.0, le=10_000.0)] | Literal["open"] | None = None
    alternatives: tuple[StatedAlternative, ...] = ()
    also: tuple[StatedView, ...] = ()

    def __post_init__(self) -> None:
        for broken in _faults_of(self):
            raise ValueError(broken)

    @property
    def view(self) -> StatedView | None:
        """Return where it is seen, if that is stated."""
        if self.side is None or self.box is None:
            return None
        return StatedView(self.side, self.box)

    @property
    def others(self) -> tuple[StatedPart, ...]:
        """Return the part as each of its alternatives has it."""
        return tuple(
            replace(self, kind=other.kind or self.kind, hinge=other.hinge, alternatives=())
            for other in self.alternatives
        )


class Stated(Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """All that a file states of one object.

    Attributes:
        front: axis of the object frame (z up) towards which its front looks.
        opens: ``false``: nothing does.
        size: width, depth and height of the mesh that it was written for, in any unit: one whose
            sides are otherwise to one another is refused.
        parts: that open.
    """

    front: Literal["-y", "y", "-x", "x"] = "-y"
    opens: bool = True
    size: tuple[float, float, float] | None = None
    parts: Annotated[tuple[StatedPart, ...], Meta(max_length=MOST_PARTS)] = ()

    def __post_init__(self) -> None:
        if self.size is not None and not all(0.0 < each < math.inf for each in self.size):
            raise ValueError("size is three positive numbers: width, depth and height")
        if not self.opens and self.parts:
            raise ValueError("opens is false and parts are stated, want one of the two")
        names = [part.name for part in self.parts if part.name is not None]
        for name in sorted(set(names)):
            if names.count(name) > 1:
                raise ValueError(f"{names.count(name)} parts are named {name!r}, want one each")
        parents = {part.name: part.parent for part in self.parts if part.name is not None}
        for part in self.parts:
            if part.parent is not None and part.parent not in names:
                near = _meant(part.parent, names)
                raise ValueError(f"parent {part.parent[:64]!r} is no part's name{near}")
            above = part.parent
            for _ in parents:
                above = parents.get(above or "")
            if above is not None:
                raise ValueError(f"parent {above!r} is carried by what it carries")


_CHOICES: Mapping[str, tuple[str, ...]] = {
    "kind": tuple(StatedKind),
    "side": tuple(side for side in Side if side is not Side.BOTTOM),
    "hinge": tuple(Hinge),
}
_INNER: Mapping[str, type[Struct]] = {
    "parts": StatedPart,
    "alternatives": StatedAlternative,
    "also": StatedView,
}


def read_stated(path: Path, files: InputFiles) -> Stated | None:
    """Return the parts that are stated beside mesh file ``path``; ``None`` if there is no file.

    Raises:
        InputRejected: ``bad_sidecar``, with the place and what it may contain.
    """
    found = find_beside(stated_paths(path), files)
    return None if found is None else _parse(found, files)


def stated_paths(path: Path) -> tuple[Path, ...]:
    """Return where the stated parts of mesh file ``path`` may be, the one that wins first."""
    stems = (path.name, path.stem)
    return tuple(path.with_name(stem + end) for stem in stems for end in _ENDS)


_ENDS = (".parts.json", ".parts.toml")


def stated_from(values: object) -> Stated:
    """Return the statement that a decoded JSON or TOML document makes.

    Raises:
        ConfigError: with the place, the fault and a remedy.
    """
    for fault in _wrong_words(values, Stated, "$"):
        raise ConfigError(fault)
    try:
        return convert(values, Stated)
    except ValidationError as error:
        raise ConfigError(str(error)) from error


def decoded(text: bytes, form: str = "JSON") -> object:
    """Return what a document of stated parts holds, before it is understood.

    Raises:
        ConfigError: it is not in that form, ``JSON`` or ``TOML``.
    """
    try:
        written = text.decode("utf-8")
        return tomllib.loads(written) if form == "TOML" else json.loads(written)
    except (ValueError, RecursionError) as error:
        raise ConfigError(f"is not {form}: {error}") from error


def form_of(path: Path) -> str:
    """Return in what form a file of stated parts is written, by its name."""
    return "TOML" if path.suffix == ".toml" else "JSON"


def _parse(path: Path, files: InputFiles) -> Stated:
    text = read_beside(path, files, MOST_BYTES)
    try:
        return stated_from(decoded(text, form_of(path)))
    except ConfigError as error:
        raise bad_sidecar(path, str(error)) from error


def _wrong_words(values: object, form: type[Struct], place: str) -> Iterator[str]:
    """Yield each unknown name, and the name that may be meant."""
    if not isinstance(values, dict):
        return
    for key, value in values.items():
        known = form.__struct_fields__
        if key not in known:
            yield f"{place} does not know {str(key)[:64]!r}{_meant(str(key), known)}"
        elif key in _CHOICES and value is not None and value not in _CHOICES[key]:
            yield f"{place}.{key} is {str(value)[:64]!r}{_meant(str(value), _CHOICES[key])}"
        elif key in _INNER and isinstance(value, list):
            for number, entry in enumerate(value):
                yield from _wrong_words(entry, _INNER[key], f"{place}.{key}[{number}]")


def _meant(word: str, known: tuple[str, ...] | list[str]) -> str:
    near = get_close_matches(word, known, n=1)
    if near:
        return f"; did you mean {str(near[0])!r}?"
    return f"; known are {', '.join(known)}" if known else ""


def _faults_of(part: StatedPart) -> Iterator[str]:
    """Yield what of a part contradicts itself."""
    if part.name is not None and not NAME.fullmatch(part.name):
        yield "name is a letter and then at most 63 letters, digits, '_', '-' or '.'"
    if part.name in RESERVED:
        yield f"name is not {' or '.join(RESERVED)}, which are links of every asset"
    if (part.side is None) != (part.box is None):
        yield "side and box come together"
    if part.box is not None and (part.box[0] >= part.box[2] or part.box[1] >= part.box[3]):
        yield "box is [x0, y0, x1, y1] with x0 < x1 and y0 < y1"
    if part.count > 1 and (part.box is not None or part.name is not None):
        yield "count is for parts without a box or a name"
    if part.kind is StatedKind.DRAWER and part.hinge is not None:
        yield SLIDES
    if part.range is not None and not part.range[0] <= 0.0 <= part.range[1]:
        yield "range is [lower, upper] with lower <= 0 <= upper, since 0 is as drawn"
    if part.range is not None and part.range[0] == part.range[1]:
        yield "range is [lower, upper] with lower < upper"
    if part.range is not None and part.drawn is not None and part.range[0] == 0.0:
        yield "range starts below 0 where a part is drawn open: it is closed there"


def schema() -> dict[str, Any]:
    """Return the JSON schema of the file."""
    from msgspec.json import schema as schema_of

    return schema_of(Stated)
