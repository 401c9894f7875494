"""All that somebody is shown and told of one input."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ...config import BuildConfig
from ...errors import InputRejected
from ...intake.source import Source
from ...mesh import Mesh
from .instruction import instruction_for
from .sheet import sheet_of


@dataclass(frozen=True)
class Question:
    """The question about one input.

    Attributes:
        sheet: a PNG of its sides.
        instruction: how to answer.
        rejected: why there is nothing to ask; empty otherwise.
    """

    sheet: bytes = b""
    instruction: str = ""
    rejected: str = ""


def question_of(mesh: Mesh, name: str) -> Question:
    """Return the question about a mesh [m], z up, of a file of that name."""
    return Question(sheet_of(mesh), instruction_for(name))


def question_about(source: Path, config: BuildConfig) -> Question:
    """Return the question about one input.

    Args:
        source: a mesh file.
        config: how to load it.
    """
    try:
        intake = Source(source, config).load()
        return question_of(intake.mesh, intake.provenance.input)
    except InputRejected as rejection:
        return Question(rejected=f"{rejection.code}: {rejection.message}")
