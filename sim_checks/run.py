"""Validate one file: one call of :class:`~asset_factory.sim_checks.judge.Judge`."""

from collections.abc import Sequence
from pathlib import Path

from .config import CheckConfig
from .judge import DEFAULT_CONFIG, Examination, Judge
from .report import Report


def run_checks(
    description: Path,
    simulators: Sequence[str] = ("sapien",),
    config: CheckConfig = DEFAULT_CONFIG,
    examined: Examination | None = None,
) -> Report:
    """Validate a URDF or MJCF file from anyone.

    Native code runs in killable children; whatever the file does to them becomes a finding.

    Args:
        description: the file; its meshes lie in the same folder or below.
        simulators: which engines to ask, by name, in this order; none for the static checks alone.
        config: every threshold.
        examined: of this same, unchanged file, by :meth:`Judge.examine`, so as not to be done
            again.

    Returns:
        As :meth:`Judge.check`.

    Raises:
        ValueError: for a simulator that does not exist, with those that do.
    """
    with Judge(config) as judge:
        return judge.check(description, simulators, examined)
