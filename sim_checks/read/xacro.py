"""xacro: macros that make a URDF, expanded by the library of that name in a process of its own."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from contextlib import suppress
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from threading import Timer
from typing import Any

from ..description import DescriptionError
from .document import MAX_DOCUMENT_BYTES, parse_xml
from .roots import ReadOptions

SUFFIX = ".xacro"
#: What its elements' names begin with.
NAMESPACES = ("{http://www.ros.org/wiki/xacro}", "{http://ros.org/wiki/xacro}")
INSTALL = "pip install 'asset-factory[xacro]'"
#: Time only ends what hangs [s].
WALL_S = 120.0
#: JSON writes no character in more than six bytes.
MOST_ANSWERED = 6 * MAX_DOCUMENT_BYTES
_RUN = "import sys; sys.path.insert(0, sys.argv[1]); from {} import main; main()"


def is_xacro(path: Path, document: ET.Element) -> bool:
    """Return whether a file has to be expanded before it is read."""
    made = any(str(item.tag).startswith(NAMESPACES) for item in document.iter())
    return made or path.suffix.lower() == SUFFIX


def parse_arguments(given: tuple[str, ...]) -> dict[str, str]:
    """Return arguments written as ``name:=value``. Raises ValueError: one is written otherwise."""
    pairs = [item.partition(":=") for item in given]
    for name, sign, value in pairs:
        if not (name and sign):
            raise ValueError(f"{name + sign + value!r}, want name:=value")
    return {name: value for name, _, value in pairs}


def expand_xacro(path: Path, options: ReadOptions) -> tuple[ET.Element, tuple[Path, ...]]:
    """Return the document that a xacro file makes, and the files that it includes.

    Raises:
        DescriptionError: ``unknown_format``: the library is missing; ``invalid_xacro``.
        TimeoutError: it hung.
    """
    if find_spec("xacro") is None:
        message = f"{path.name}: xacro is read with the library of that name: {INSTALL}"
        raise DescriptionError("unknown_format", message)
    question = {
        "path": str(path.absolute()),
        "roots": [str(root) for root in options.roots],
        "outside": options.allow_outside,
        "given": parse_arguments(options.arguments),
    }
    answer = _asked(question, path.name)
    text = answer.get("text")
    if not isinstance(text, str):
        words = answer.get("error", "it ends without an answer")
        message = f"{path.name}: xacro cannot expand it: {words}".replace(str(path.parent), "")
        raise DescriptionError("invalid_xacro", message)
    return parse_xml(text.encode(), path.name), tuple(map(Path, answer.get("files", [])))


def _asked(question: Mapping[str, object], name: str) -> dict[str, Any]:
    """Ask a process that may not be trusted; what it says is text and no more."""
    source = str(Path(sys.modules[str(__package__).partition(".")[0]].__path__[0]).parent)
    code = _RUN.format(f"{__package__}.xacro_child")
    with subprocess.Popen(  # noqa: S603 - this interpreter, with this package's own code
        [sys.executable, "-I", "-c", code, source, json.dumps(question)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env={},
        start_new_session=True,
    ) as process:
        timer = Timer(WALL_S, process.kill)
        timer.start()
        said = (process.stdout or BytesIO()).read(MOST_ANSWERED)
        timer.cancel()
        process.kill()
        code_of_end = process.wait()
    if not said and code_of_end in (-signal.SIGKILL, -signal.SIGXCPU):
        raise TimeoutError(f"{name}: xacro gave no answer in {WALL_S:g} s")
    with suppress(ValueError):
        answer = json.loads(said)
        return answer if isinstance(answer, dict) else {}
    return {}
