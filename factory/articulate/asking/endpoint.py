"""One question to an endpoint that speaks OpenAI's chat-completions protocol."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from http import HTTPStatus
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

from msgspec import DecodeError, Struct
from msgspec.json import decode

from asset_factory.sim_checks import Finding
from asset_factory.sim_checks.report import OUT_OF_TIME, Severity

from ...config import VlmConfig
from ...errors import ConfigError, Unjudged
from ...intake.stated import schema

if TYPE_CHECKING:
    import httpx

#: The environment's variable with the endpoint's key. It is neither stored nor logged.
KEY = "ASSET_FACTORY_VLM_KEY"
#: Longer answers are not read on [bytes].
MOST_BYTES = 1024 * 1024
#: How often an endpoint that is busy or gone is asked, and the longest wait in between [s].
TRIES = 3
LONGEST_PAUSE_S = 30.0
#: Letters of an endpoint's own words that a sentence quotes.
_QUOTED = 200


class _Message(Struct):
    content: str | None = None


class _Choice(Struct):
    message: _Message


class _Usage(Struct):
    prompt_tokens: int = 0
    completion_tokens: int = 0


class _Completion(Struct):
    choices: tuple[_Choice, ...]
    usage: _Usage | None = None


class Reply(Struct, frozen=True):
    """What a model said.

    Attributes:
        text: its words; empty where it said nothing.
        read, written: tokens that it cost, as the endpoint counts them.
    """

    text: str
    read: int
    written: int


def require_endpoint(config: VlmConfig) -> None:
    """Raise ConfigError where nobody says which model is to be asked, or where."""
    parts = urlsplit(config.url)
    if parts.scheme not in ("http", "https") or not parts.hostname:
        raise ConfigError(f"--vlm-url must be http(s)://host/v1, not {config.url!r}")
    if parts.username or parts.password:
        raise ConfigError(f"--vlm-url: holds a password; want it in {KEY}")
    if not config.model:
        raise ConfigError("--vlm-model: none is named, want the name of a model that sees")
    if not (config.wait_s > 0.0 and config.most_tokens > 0):
        raise ConfigError("vlm: wait_s and most_tokens want more than 0")
    try:
        import httpx  # noqa: F401
    except ImportError as missing:
        raise ConfigError("vlm: wants httpx: pip install 'asset-factory[vlm]'") from missing


def ask(config: VlmConfig, messages: Sequence[dict[str, Any]]) -> Reply:
    """Return a model's answer, with no sampling noise and in the form of stated parts.

    Args:
        config: where, and which model.
        messages: of the conversation, as the protocol has them.

    Raises:
        Unjudged: ``model_unavailable``: no answer, however often it was asked.
        ConfigError: the endpoint refuses the key, the model or the question.
    """
    import httpx

    form = {"type": "json_schema", "json_schema": {"name": "parts", "schema": schema()}}
    body: dict[str, Any] = {
        "model": config.model,
        "messages": list(messages),
        "temperature": 0,
        "max_tokens": config.most_tokens,
        "response_format": form,
    }
    key = os.environ.get(KEY, "")
    headers = {"Authorization": f"Bearer {key}"} if key else {}
    why = ""
    with httpx.Client(timeout=config.wait_s, headers=headers) as client:
        for number in range(TRIES):
            try:
                status, answer, pause = _post(client, config, body)
            except httpx.HTTPError as fault:
                why = f"{type(fault).__name__}: {fault}"
                pause = 2.0**number
            else:
                said = answer[:_QUOTED].decode("utf-8", "replace")
                said = " ".join((said.replace(key, "***") if key else said).split())
                why = f"HTTP {status}: {said}"
                if status < HTTPStatus.BAD_REQUEST:
                    return _reply(answer)
                if (
                    status == HTTPStatus.BAD_REQUEST
                    and body.pop("response_format", None) is not None
                ):
                    continue
                if (
                    status != HTTPStatus.TOO_MANY_REQUESTS
                    and status < HTTPStatus.INTERNAL_SERVER_ERROR
                ):
                    raise ConfigError(f"{config.url}: {why}")
            if number + 1 < TRIES:
                time.sleep(min(pause, LONGEST_PAUSE_S))
    sentence = f"{config.url}: no answer in {TRIES} tries; {why}"
    raise Unjudged(Finding("model_unavailable", Severity.ERROR, sentence, cause=OUT_OF_TIME))


def _post(
    client: httpx.Client, config: VlmConfig, body: dict[str, Any]
) -> tuple[int, bytes, float]:
    """Return an answer's status, what of it is read, and the pause that it asks for [s]."""
    read = b""
    url = f"{config.url.rstrip('/')}/chat/completions"
    with client.stream("POST", url, json=body) as response:
        for chunk in response.iter_bytes():
            read += chunk
            if len(read) > MOST_BYTES:
                break
        after = response.headers.get("retry-after", "")
    return response.status_code, read[: MOST_BYTES + 1], float(after) if after.isdigit() else 1.0


def _reply(answer: bytes) -> Reply:
    """Return what a completion says; nothing where it is none, or longer than allowed."""
    try:
        completion = decode(answer, type=_Completion)
    except (DecodeError, RecursionError):
        return Reply("", 0, 0)
    usage = completion.usage or _Usage()
    text = completion.choices[0].message.content if completion.choices else None
    return Reply(text or "", usage.prompt_tokens, usage.completion_tokens)
