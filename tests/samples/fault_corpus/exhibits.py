"""What the fault corpus shows: a file, and what the judge must say of it."""

import xml.etree.ElementTree as ET
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from .things import Thing, write_mjcf, write_urdf

ENGINES = ("sapien", "mujoco", "pybullet")
#: Writes a file into an empty folder and returns the description's path.
Builder = Callable[[Path], Path]
Severity = Literal["error", "warning", "note"]


@dataclass(frozen=True)
class Exhibit:
    """One file, sound or broken in one way.

    Attributes:
        name: unique in the corpus; ends with the format.
        build: writes it into an empty folder and returns the description's path.
        code: what is wrong, in the judge's word; ``None`` for a sound one.
        severity: of that finding.
        seen_by: the detectors that must find it by this code.
        engines: engines that must find it by another code of their own, hard.
    """

    name: str
    build: Builder
    code: str | None = None
    severity: Severity = "error"
    seen_by: tuple[str, ...] = ("static",)
    engines: Mapping[str, str] = field(default_factory=dict)

    @property
    def rejected(self) -> bool:
        """Whether the judge as a whole must reject it."""
        return bool(self.engines) or (self.code is not None and self.severity == "error")

    def expected(self, detector: str) -> str | None:
        """The code that a detector must find; ``None`` where it need not say anything."""
        return self.engines.get(detector, self.code if detector in self.seen_by else None)


def urdf(thing: Thing) -> Builder:
    """Writes the thing as URDF."""
    return lambda folder: write_urdf(thing, folder)


def mjcf(thing: Thing) -> Builder:
    """Writes the thing as MJCF."""
    return lambda folder: write_mjcf(thing, folder)


def listed(
    *rows: tuple[str, str | None, Builder],
    severity: Severity = "error",
    engines: Mapping[str, Mapping[str, str]] | None = None,
) -> tuple[Exhibit, ...]:
    """Exhibits by name, code and builder; ``engines`` find some, by name, by codes of their own."""
    own = engines or {}
    return tuple(
        Exhibit(name, build, code, severity, ("static",) if code else (), own.get(name, {}))
        for name, code, build in rows
    )


def both(
    name: str, thing: Thing, code: str | None, severity: Severity = "error", **engines: str
) -> tuple[Exhibit, ...]:
    """The same thing in both formats, which the static checks must see alike."""
    files = {f"{name}.urdf": urdf(thing), f"{name}.mjcf": mjcf(thing)}
    rows = ((file, code, build) for file, build in files.items())
    return listed(*rows, severity=severity, engines=dict.fromkeys(files, engines))


def edited(build: Builder, *edits: tuple[str, str], count: int = 1) -> Builder:
    """Writes and then edits the text; every edit must find what it replaces.

    Args:
        build: writes the sound file.
        *edits: pairs of old and new text, applied in order.
        count: how many places of each; -1 for all.
    """

    def write(folder: Path) -> Path:
        path = build(folder)
        text = path.read_text()
        for old, new in edits:
            if old not in text:
                raise ValueError(f"nothing to edit: {old}")
            text = text.replace(old, new, count)
        path.write_text(text)
        return path

    return write


def filed(build: Builder, files: Mapping[str, str | bytes | None], home: str = ".") -> Builder:
    """Writes, in a folder of the one given, and gives files other content there; none removes."""

    def write(folder: Path) -> Path:
        (folder / home).mkdir(exist_ok=True)
        path = build(folder / home)
        for name, content in files.items():
            target = folder / home / name
            if content is None:
                target.unlink()
            else:
                target.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write


def reworked(build: Builder, find: str, change: Callable[[ET.Element], object]) -> Builder:
    """Writes, then changes an XPath's first element."""

    def write(folder: Path) -> Path:
        path = build(folder)
        document = ET.parse(path)
        element = document.find(find)
        if element is None:
            raise ValueError(f"no element to change: {find}")
        change(element)
        document.write(path)
        return path

    return write


def restated(build: Builder, find: str, **attributes: str) -> Builder:
    """Writes, then sets attributes of an XPath's first element."""
    return reworked(build, find, lambda element: element.attrib.update(attributes))
