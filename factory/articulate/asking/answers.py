"""Answers that a model gave, kept by what it was asked."""

from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path

from msgspec import Struct, ValidationError, convert

from ...config import VlmConfig
from ...runtime.store import write_json
from .endpoint import MOST_BYTES
from .question import Question


class KeptAnswer(Struct, frozen=True):
    """An answer that was taken.

    Attributes:
        text: the model's words.
        read, written: tokens that it cost, repeated questions included.
    """

    text: str
    read: int
    written: int


def answer_path(config: VlmConfig, question: Question) -> Path:
    """Return where the answer of a model to a question is kept: the same for the same pictures."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    folder = Path(config.answers) if config.answers else cache / "asset-factory" / "answers"
    digest = hashlib.sha256()
    for part in (config.model.encode(), question.instruction.encode(), question.sheet):
        digest.update(hashlib.sha256(part).digest())
    return folder / f"{digest.hexdigest()}.json"


def kept_answer(path: Path) -> KeptAnswer | None:
    """Return an answer that was kept; ``None`` if there is none that can be read."""
    try:
        if path.stat().st_size > MOST_BYTES:
            return None
        return convert(json.loads(path.read_bytes()), KeptAnswer)
    except (OSError, ValueError, RecursionError, ValidationError):
        return None


def keep_answer(path: Path, answer: KeptAnswer) -> None:
    """Keep an answer, whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_json(path, {"text": answer.text, "read": answer.read, "written": answer.written})
