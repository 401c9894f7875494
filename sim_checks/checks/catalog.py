"""The checks that need no simulator: one file each, one line here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..config import CheckConfig
from ..description import Description
from .attachment import check_attachment
from .lint import check_lint
from .penetration import check_penetration
from .result import CheckResult
from .standing import check_standing


@dataclass(frozen=True)
class StaticCheck:
    """A check.

    Attributes:
        name: of its measurements in a report.
        run: asks a description, by the settings that are its own.
        native: whether native code runs in it, so that it may take its process down.
    """

    name: str
    run: Callable[[Description, CheckConfig], CheckResult]
    native: bool = True


def _penetration(file: Description, config: CheckConfig) -> CheckResult:
    return check_penetration(file, config.penetration, config.work.looks)


#: Every check, in the order in which they speak.
CHECKS = (
    StaticCheck("lint", lambda file, config: check_lint(file, config.lint), native=False),
    StaticCheck("attachment", lambda file, config: check_attachment(file, config.lint)),
    StaticCheck("standing", lambda file, config: check_standing(file, config.standing)),
    StaticCheck("penetration", _penetration),
)
