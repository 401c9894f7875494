"""Choose the reader by what the file says it is."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from ..description import ABSURD, Description, DescriptionError, sensible
from .document import parse_document
from .mjcf import read_mjcf
from .native import read_apart
from .urdf import read_urdf


def read_description(path: Path) -> Description:
    """Read a URDF or MJCF file; MJCF is compiled by MuJoCo in a child that may crash.

    Args:
        path: a ``<robot>`` (URDF) or ``<mujoco>`` (MJCF) document; its meshes lie in the same
            folder or below.

    Raises:
        DescriptionError: with a stable code, whatever is wrong with the file.
        TimeoutError, ChildProcessError: nobody can say; see :func:`.native.ask_of`.
    """
    document = parse_document(path)
    if _format(document, path) == "urdf":
        return _read(path, document)
    return read_apart(read_here, path)


def read_here(path: Path) -> Description:
    """Read as :func:`read_description` does, in this process, which must be a killable child."""
    return _read(path, parse_document(path))


def _read(path: Path, document: ET.Element) -> Description:
    read = read_urdf if _format(document, path) == "urdf" else read_mjcf
    # What is made of numbers that are none is refused, not warned of.
    with np.errstate(all="ignore"):
        description = read(path, document)
    _refuse_senseless(description)
    return description


def _refuse_senseless(description: Description) -> None:
    """Refuse places and shapes that are nowhere: whoever computes with them is lost."""
    for joint in description.joints:
        if not (sensible(joint.origin) and sensible(joint.axis)):
            words = f"joint {joint.name!r} has its origin at {joint.origin[:3, 3].tolist()} m"
            message = f"{words}, axis {joint.axis.tolist()}; want finite numbers up to {ABSURD:g}"
            raise DescriptionError("not_finite", message)
    for link in description.links:
        for shape in (*link.collisions, *link.visuals):
            if not sensible(shape.vertices):
                where = f"a corner that is not finite, or more than {ABSURD:g} m away"
                message = f"shape {shape.name!r} of link {link.name!r} has {where}"
                raise DescriptionError("not_finite", message)


def format_of(path: Path) -> str:
    """Return ``urdf`` or ``mjcf``, by the document's root element.

    Raises:
        DescriptionError: if it is no XML document, or of another kind.
    """
    return _format(parse_document(path), path)


def _format(document: ET.Element, path: Path) -> str:
    found = {"robot": "urdf", "mujoco": "mjcf"}.get(document.tag)
    if found is None:
        message = f"{path.name}: root element is <{document.tag}>, want <robot> or <mujoco>"
        raise DescriptionError("unknown_format", message)
    return found
