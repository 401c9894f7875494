"""Expands one xacro file, in a process of its own: its expressions are Python from a stranger.

Asked and answered in JSON. Three walls, for the library's own is low (a lambda hides any name from
it): expressions may not touch what begins with an underscore or leads to frames; the interpreter
refuses every act but reading files in the folders allowed; and the process has no environment,
little memory and no way to write.
"""

from __future__ import annotations

import ast
import glob
import json
import os
import re
import resource
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .document import MAX_DOCUMENT_BYTES
from .roots import ReadOptions, Roots

MEMORY_BYTES = 2**30
PROCESSOR_S = 30
#: Attributes that lead from a value to the interpreter: those of frames, their code and classes.
INNER = re.compile(r"(gi|cr|ag)_(frame|code|yieldfrom|await)|(tb|f|func|co)_[a-z]+|mro|__.*")
#: What an interpreter does that only computes and imports.
HARMLESS = re.compile(
    r"import|compile|exec|marshal\.loads|builtins\.id|sys\._getframe|object\.__getattr__|"
    r"(code|function)\.__new__|glob\.glob(/2)?"
)


class NotAllowed(RuntimeError):
    """A file does what a description has no need of."""


def main() -> None:
    """Answer the question that is the last argument, on standard output."""
    asked = json.loads(sys.argv[-1])
    try:
        answer = _expanded(Path(asked["path"]), asked["roots"], asked["outside"], asked["given"])
    except BaseException as error:  # noqa: BLE001 - whatever a stranger's program raises
        answer = {"error": f"{type(error).__name__}: {error}"[:1000]}
    os.write(1, json.dumps(answer).encode())
    os._exit(0)


def _expanded(
    path: Path, folders: list[str], outside: bool, arguments: Mapping[str, str]
) -> dict[str, Any]:
    import xacro
    from xacro import substitution_args

    roots = Roots(path, ReadOptions(tuple(map(Path, folders)), outside))
    substitution_args._eval_find = lambda name: str(roots.package_folder(name))
    xacro.safe_eval = _evaluated
    _close(roots)
    text = xacro.process_file(str(path), mappings=dict(arguments)).toxml()
    files = dict.fromkeys(map(os.path.realpath, xacro.all_includes))
    if len(text) > MAX_DOCUMENT_BYTES:
        raise NotAllowed(f"it makes {len(text)} characters, at most {MAX_DOCUMENT_BYTES} are read")
    return {"text": text, "files": list(files)}


def _evaluated(expression: str, symbols: dict[str, Any], own: Any = None) -> Any:
    """Evaluate an expression in which nothing reaches behind values."""
    tree = ast.parse(expression.strip(), "<expression>", "eval")
    for node in ast.walk(tree):
        name = str(getattr(node, "attr", "") or getattr(node, "id", ""))
        if INNER.fullmatch(name) or (name.startswith("_") and isinstance(node, ast.Attribute)):
            raise NotAllowed(f"use of {name!r}")
    symbols.update(__builtins__={})
    return eval(compile(tree, "<expression>", "eval"), symbols, own)  # noqa: S307


def _close(roots: Roots) -> None:
    """Leave the process nothing but to compute, and to read what its roots hold."""
    os.environ.clear()
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
    resource.setrlimit(resource.RLIMIT_CPU, (PROCESSOR_S, PROCESSOR_S))
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
    own = tuple(os.path.realpath(folder) + os.sep for folder in sys.path if folder)

    def watch(event: str, details: tuple[Any, ...]) -> None:
        place = details[0] if details else None
        # A number is of a file that is open already.
        if HARMLESS.fullmatch(event) or (event == "open" and isinstance(place, int)):
            return
        reads = event in ("os.listdir", "os.scandir") or (
            event == "open" and not (details[2] & (os.O_WRONLY | os.O_RDWR | os.O_CREAT))
        )
        if reads and isinstance(place, str | bytes | Path):
            real = os.path.realpath(os.fsdecode(place))
            # Modules that are imported late.
            if roots.allows(Path(real)) or real.startswith(own):
                return
        raise NotAllowed(f"{event} {str(place)[:160]!r}: only files in the roots are read")

    glob.glob(os.path.join(os.sep, "nowhere*"))
    sys.addaudithook(watch)
