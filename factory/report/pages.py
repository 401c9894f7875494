"""Pages from templates (the only file that says ``jinja2``); all that is put in is escaped."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import ConfigError

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup

#: Colours, type and tables of every page.
BASE_CSS = Path(__file__).parent / "site" / "static" / "base.css"
_LONGEST = 1200
#: What pages with pictures need.
PICTURE_LIBRARIES = ("embreex", "jinja2", "PIL")


def require_libraries(
    purpose: str = "the report", libraries: Sequence[str] = PICTURE_LIBRARIES, extra: str = "build"
) -> None:
    """Raise ConfigError where a library is missing: before the work, not after it.

    ``purpose`` is what needs them, and ``extra`` is ours that installs them.
    """
    for library in libraries:
        if find_spec(library) is None:
            hint = f"pip install 'asset-factory[{extra}]'"
            raise ConfigError(f"{purpose} needs {library}: {hint}")


@cache
def environment(package: str, **known: object) -> Environment:
    """Return the templates of a package and of all reports; an unknown name is an error."""
    from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined

    made = Environment(
        loader=ChoiceLoader([PackageLoader(package), PackageLoader(__package__)]),
        autoescape=True,
        finalize=_shown,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.globals |= known
    made.filters["script"] = script
    return made


def script(data: Any) -> Markup:
    """Return JSON that may stand in a script element: nothing in it ends the element."""
    from markupsafe import Markup

    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return Markup(text.replace("<", "\\u003c").replace("&", "\\u0026"))  # noqa: S704 - escaped here


def trusted(text: str) -> Markup:
    """Return a text of our own, put in as it is."""
    from markupsafe import Markup

    return Markup(text)  # noqa: S704 - never an input's


def _shown(value: object) -> object:
    """Show characters that turn or break lines in texts from inputs; cut long ones."""
    if not isinstance(value, str) or hasattr(value, "__html__"):
        return value
    shown = "".join(c if c.isprintable() else "\ufffd" for c in value)
    return shown if len(shown) <= _LONGEST else shown[: _LONGEST - 1] + "…"
