"""The network's side: a question as bytes in, its answer as bytes out."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np

from ...config import ParticulateConfig
from ..particulate.device import device_for
from ..particulate.inference import Network
from ..particulate.prediction import Prediction
from ..particulate.sampling import Cloud
from .wire import Message, WireError, pack, unpack

Answer = Callable[[bytes], bytes]


@dataclass(frozen=True)
class LoadedNetwork:
    """A network, ready for questions.

    Attributes:
        network: answers for one cloud.
        identity: of that network; whoever asks for another one is refused.
        places: as many as clouds are worked on at the same time; the others wait.
    """

    network: Network
    identity: str
    places: threading.BoundedSemaphore


class Answering:
    """Answers questions, for several threads at once.

    Args:
        load: loads the network at the first question, as the cache may answer all of a job; once
            more at the next one, where it fails.
    """

    def __init__(self, load: Callable[[], LoadedNetwork]) -> None:
        self._load = load
        self._loading = threading.Lock()
        self._loaded: LoadedNetwork | None = None

    def __call__(self, question: bytes) -> bytes:
        """Return the answer to a packed question; an error is an answer too, a refusal."""
        try:
            with self._loading:
                if self._loaded is None:
                    self._loaded = self._load()
            asked = unpack(question)
            if asked.texts.get("identity") != self._loaded.identity:
                raise WireError("another network is asked for")
            clouds = _cloud(asked, "cloud"), _cloud(asked, "context")
            with self._loaded.places:
                told = self._loaded.network(*clouds, float(asked.texts["least_confidence"]))
            named = {each.name: getattr(told, each.name) for each in fields(Prediction)}
            return pack(
                Message({}, {name: said for name, said in named.items() if said is not None})
            )
        except Exception as error:  # noqa: BLE001 - who asks will ask itself, and meet the same error at home
            return refusal(error)


def refusal(error: Exception) -> bytes:
    """Return the answer of who has none."""
    return pack(Message({"refused": f"{type(error).__name__}: {error}"[:2000]}))


def _cloud(asked: Message, name: str) -> Cloud:
    """Return what a network looks at of a cloud; which faces its points lie on is nothing to it."""
    points = asked.arrays[f"{name}.points"]
    components = asked.arrays[f"{name}.components"]
    normals = asked.arrays[f"{name}.normals"]
    nowhere = np.zeros(len(points), dtype=np.int64)
    return Cloud(points, normals, nowhere, nowhere.astype(np.bool_), components)


def identity_of(config: ParticulateConfig, digests: tuple[str, ...]) -> str:
    """Return what tells a network's answers: the same identity, the same bits."""
    return "/".join((*digests, config.precision, device_for(config.device), str(config.driving)))
