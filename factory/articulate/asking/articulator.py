"""The articulator that asks a vision-language model what opens, and finds it on the mesh."""

from __future__ import annotations

import base64
import json
import re
from dataclasses import dataclass, replace
from typing import Any
from urllib.parse import urlsplit

from ...articulation import Articulation
from ...config import BuildConfig, VlmConfig
from ...errors import ConfigError, InputRejected
from ...intake.intake import Intake
from ...intake.stated import stated_from
from ...mesh import Mesh
from ...part import Proposer
from ..annotated import annotated_articulator
from ..articulator import Articulator, HypothesisMaker
from ..stated import StatedArticulator
from .answers import answer_path, keep_answer, kept_answer
from .endpoint import Reply, ask, require_endpoint
from .question import Question, question_of

NAME = "vlm"
#: Longer answers are not read [letters].
LONGEST = 64 * 1024
_FENCED = re.compile(r"\s*```(?:json)?\s*(.*?)\s*```\s*", re.DOTALL)


@dataclass(frozen=True)
class VlmArticulator(HypothesisMaker):
    """Asks a model once, once more with the fault, and never again about the same pictures.

    Attributes:
        input_name: of the input's file, which is told.
        config: which model, and where.
    """

    name = NAME

    input_name: str
    config: VlmConfig

    def hypotheses(self, mesh: Mesh) -> tuple[Articulation, ...]:
        """Return the articulations that fit the model's answer, the likeliest first.

        Raises:
            InputRejected: ``bad_answer``, ``stated_part_not_found``: of the last answer.
            Unjudged: ``model_unavailable``.
            ConfigError: the endpoint refuses the key, the model or the question.
        """
        question = question_of(mesh, self.input_name)
        path = answer_path(self.config, question)
        kept = kept_answer(path)
        if kept is not None:
            return self._noted(_found(kept.text, mesh), kept)
        messages = [_first_message(question)]
        reply = ask(self.config, messages)
        try:
            found = _found(reply.text, mesh)
        except InputRejected as fault:
            again = ask(self.config, [*messages, *_corrections(reply, fault)])
            found = _found(again.text, mesh)
            reply = Reply(again.text, reply.read + again.read, reply.written + again.written)
        keep_answer(path, reply)
        return self._noted(found, reply)

    def _noted(self, found: tuple[Articulation, ...], kept: Reply) -> tuple[Articulation, ...]:
        """Return hypotheses that say who proposed them, and what that cost."""
        host = urlsplit(self.config.url).hostname
        note = (
            f"{self.config.model} at {host} said what opens: "
            f"{kept.read} tokens read, {kept.written} written"
        )
        return tuple(replace(each, articulator=NAME, notes=(*each.notes, note)) for each in found)


def articulator_for(intake: Intake, config: BuildConfig) -> Articulator:
    """Return who is asked for one input: a person's word and joints that came with it are believed.

    Raises:
        ConfigError: no model is named, or no endpoint.
    """
    if intake.stated is not None:
        return StatedArticulator(intake.stated)
    annotated = annotated_articulator(intake)
    if annotated is not None:
        return annotated
    require_endpoint(config.vlm)
    return VlmArticulator(intake.provenance.input, config.vlm)


def _found(text: str, mesh: Mesh) -> tuple[Articulation, ...]:
    """Return the articulations that an answer states.

    Raises:
        InputRejected: ``bad_answer``: not in the form; ``stated_part_not_found``.
    """
    fenced = _FENCED.fullmatch(text[:LONGEST])
    try:
        stated = stated_from(json.loads(fenced[1] if fenced else text[:LONGEST]))
    except (ConfigError, ValueError, RecursionError) as fault:
        raise InputRejected(
            "bad_answer", f"the model's answer is not in the form: {fault}"
        ) from fault
    return StatedArticulator(stated, proposer=Proposer.VLM).hypotheses(mesh)


def _first_message(question: Question) -> dict[str, Any]:
    picture = base64.b64encode(question.sheet).decode()
    url = {"url": f"data:image/png;base64,{picture}", "detail": "high"}
    return {
        "role": "user",
        "content": [
            {"type": "text", "text": question.instruction},
            {"type": "image_url", "image_url": url},
        ],
    }


def _corrections(reply: Reply, fault: InputRejected) -> list[dict[str, Any]]:
    """Return an answer that cannot be used and its fault, as messages."""
    wrong = f"That cannot be used: {fault.message}. Answer with the corrected JSON object alone."
    said = reply.text[:LONGEST] or "(nothing)"
    return [{"role": "assistant", "content": said}, {"role": "user", "content": wrong}]
