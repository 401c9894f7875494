"""Choose the reader by what the file says it is."""

from __future__ import annotations

from pathlib import Path

from ..description import Description, DescriptionError
from ..isolation import Limits, run_isolated
from .document import parse_document
from .mjcf import read_mjcf
from .urdf import read_urdf

COMPILE_LIMITS = Limits(wall_s=60.0)


def read_description(path: Path) -> Description:
    """Read a URDF or MJCF file; MJCF is compiled by MuJoCo in a child that may crash.

    Args:
        path: a ``<robot>`` (URDF) or ``<mujoco>`` (MJCF) document; its meshes lie in the same folder or below.

    Raises:
        DescriptionError: with a stable code, whatever is wrong with the file.
    """
    if format_of(path) == "urdf":
        return read_here(path)
    outcome = run_isolated(read_here, path, limits=COMPILE_LIMITS)
    if isinstance(outcome.error, DescriptionError):
        raise outcome.error
    if outcome.failure is not None or outcome.value is None:
        raise DescriptionError("unreadable", f"{path.name}: MuJoCo could not compile it: {outcome.detail}")
    return outcome.value


def read_here(path: Path) -> Description:
    """As :func:`read_description`, in this process: for callers that are a killable child already."""
    return read_urdf(path) if format_of(path) == "urdf" else read_mjcf(path)


def format_of(path: Path) -> str:
    """``urdf`` or ``mjcf``, by the document's root element.

    Raises:
        DescriptionError: if it is no XML document, or of another kind.
    """
    root = parse_document(path).tag
    if root == "robot":
        return "urdf"
    if root == "mujoco":
        return "mjcf"
    raise DescriptionError("unknown_format", f"{path.name}: root element is <{root}>, want <robot> or <mujoco>")
