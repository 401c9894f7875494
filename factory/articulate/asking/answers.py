"""Answers that a model gave, kept by what it was asked."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

from msgspec import DecodeError, to_builtins
from msgspec.json import decode

from ...config import VlmConfig
from ...runtime.store import write_json
from .endpoint import MOST_BYTES, Reply
from .question import Question


def answer_path(config: VlmConfig, question: Question) -> Path:
    """Return where the answer of a model to a question is kept: the same for the same pictures."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    folder = Path(config.answers) if config.answers else cache / "asset-factory" / "answers"
    digest = hashlib.sha256()
    for part in (config.model.encode(), question.instruction.encode(), question.sheet):
        digest.update(hashlib.sha256(part).digest())
    return folder / f"{digest.hexdigest()}.json"


def kept_answer(path: Path) -> Reply | None:
    """Return an answer that was kept; ``None`` if there is none that can be read."""
    try:
        if path.stat().st_size > MOST_BYTES:
            return None
        return decode(path.read_bytes(), type=Reply)
    except (OSError, DecodeError, RecursionError):
        return None


def keep_answer(path: Path, answer: Reply) -> None:
    """Keep an answer, whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_json(path, to_builtins(answer))
