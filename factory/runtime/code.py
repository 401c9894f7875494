"""The digest of the source that a stage runs: a changed line renews its results, no number does.

Imports are found by reading sources: nothing is imported for it, nothing listed by hand. Sources
are read as text, in a few hundredths of a second; to parse them all would take one and more.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from glob import iglob
from importlib.util import find_spec, resolve_name

from .store import digest_bytes

#: An import at any indentation; its names may stand in parentheses, on several lines.
_IMPORT = re.compile(
    r"^[ \t]*(?:from[ \t]+([.\w]+)[ \t]+import[ \t]+(?:\(([^)]*)\)|([^\n]+))"
    r"|import[ \t]+([^\n]+))",
    re.MULTILINE,
)
_COMMENT = re.compile("#[^\n]*")
#: What only type checkers read.
_NEVER_RUN = re.compile(r"^if TYPE_CHECKING:\n(?:[ \t]+[^\n]*\n|\n)+", re.MULTILINE)
_PACKAGE = "__init__.py"


@cache
def code_digest(*names: str) -> str:
    """Return the digest of the source of modules and of what they import of their own package.

    It is the same on every machine, whatever its line ends. Raises ValueError for a module that is
    not there.

    Args:
        names: modules, each with the modules of its top-level package that it imports, transitively
            and inside functions too; a package counts as all of its modules.
    """
    lines = [f"{name} {_module(name).digest}" for name in sorted(modules_run_by(*names))]
    return digest_bytes("\n".join(lines).encode())


def modules_run_by(*names: str) -> frozenset[str]:
    """Return the names of all modules that :func:`code_digest` counts; arguments as there."""
    found: set[str] = set()
    waiting = [module for name in names for module in _modules_within(name)]
    while waiting:
        module = waiting.pop()
        if module not in found:
            found.add(module)
            waiting += _imported_by(module)
    return frozenset(found)


@dataclass(frozen=True)
class _Module:
    """A module's source, as far as keys go.

    Attributes:
        digest: of its text.
        imports: modules, and names in them (empty: the module itself), as written but absolute.
        bound: where names that its imports bind come from.
    """

    digest: str
    imports: tuple[tuple[str, str], ...]
    bound: dict[str, tuple[str, str]]


@cache
def _imported_by(module: str) -> frozenset[str]:
    """Return the modules of its own top-level package that a module imports."""
    found = (_home(source, name) for source, name in _module(module).imports)
    return frozenset(home for home in found if home)


def _home(source: str, name: str) -> str:
    """Return the module in which a name is defined that is imported from ``source``.

    A package that only hands on a name stands for the module that it has it from, so that nobody
    depends on all that a package offers. Empty where there is no such module.
    """
    sources = _sources(source.partition(".")[0])
    if name and f"{source}.{name}" in sources:
        return f"{source}.{name}"
    if source not in sources:
        return ""
    if sources[source].endswith(_PACKAGE) and name in _module(source).bound:
        return _home(*_module(source).bound[name])
    return source


@cache
def _module(name: str) -> _Module:
    """Read a module. Raises ValueError if there is none of that name."""
    top = name.partition(".")[0]
    file = _sources(top).get(name)
    if file is None:
        raise ValueError(f"no source of module {name!r}")
    with open(file, encoding="utf-8") as stream:
        text = stream.read()
    package = name if file.endswith(_PACKAGE) else name.rpartition(".")[0]
    imports: list[tuple[str, str]] = []
    bound: dict[str, tuple[str, str]] = {}
    for source, target, alias in _imports(text):
        absolute = resolve_name(source, package)
        if absolute.partition(".")[0] == top:
            imports.append((absolute, target))
            # A name of its own that is no module is in the package itself.
            if absolute != name:
                bound[alias] = (absolute, target)
    return _Module(digest_bytes(text.encode()), tuple(imports), bound)


def _imports(text: str) -> Iterator[tuple[str, str, str]]:
    """Yield the source of each import, the name taken from it, and the name that it gets."""
    for source, listed, plain, modules in _IMPORT.findall(_NEVER_RUN.sub("", text)):
        for item in _COMMENT.sub("", listed or plain or modules).split(","):
            words = item.split()
            if words:
                yield (source, words[0], words[-1]) if source else (words[0], "", words[-1])


def _modules_within(name: str) -> list[str]:
    """Return a module's name; of a package, those of all modules below it."""
    sources = _sources(name.partition(".")[0])
    if name not in sources:
        raise ValueError(f"no source of module {name!r}")
    return [name, *(module for module in sources if module.startswith(f"{name}."))]


@cache
def _sources(package: str) -> dict[str, str]:
    """Return the file of every module of a top-level package, found without importing it."""
    spec = find_spec(package)
    if spec is None or spec.origin is None:
        return {}
    root = os.path.dirname(spec.origin)
    found = {}
    # A checkout has links in place of folders, which this follows.
    for file in iglob("**/*.py", root_dir=root, recursive=True):
        parts = file.removesuffix(".py").split(os.sep)
        name = ".".join([package, *parts]).removesuffix(".__init__")
        found[name] = os.path.join(root, file)
    return found
