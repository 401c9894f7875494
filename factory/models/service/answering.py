"""The network's side: a question as bytes in, its answer as bytes out."""

from __future__ import annotations

import itertools
import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import fields

import numpy as np

from ...config import ParticulateConfig
from ..particulate.device import device_for
from ..particulate.inference import Network
from ..particulate.prediction import ClosestPoints, Prediction
from ..particulate.sampling import Cloud
from .wire import Message, WireError, pack, unpack

Answer = Callable[[bytes], bytes]

#: Answers of which closest points may still be asked; the oldest is dropped first.
HELD = 64


class Answering:
    """Answers questions; for several threads at once.

    Args:
        network: answers for one cloud.
        identity: of that network; whoever asks for another one is refused.
        at_once: how many clouds are worked on at the same time; the others wait.
    """

    def __init__(self, network: Network, identity: str, at_once: int) -> None:
        self._network = network
        self._identity = identity
        self._working = threading.BoundedSemaphore(at_once)
        self._held: OrderedDict[str, ClosestPoints] = OrderedDict()
        self._holding = threading.Lock()
        self._numbers = itertools.count()

    def __call__(self, question: bytes) -> bytes:
        """Return the answer to a packed question; an error is an answer of the kind ``refused``."""
        try:
            asked = unpack(question)
            if asked.texts.get("identity") != self._identity:
                raise WireError("another network is asked for")
            with self._working:
                answer = self._closest(asked) if asked.kind == "closest" else self._predict(asked)
            return pack(answer)
        except Exception as error:  # noqa: BLE001 - who asks will ask itself, and meet the same error at home
            return refusal(error)

    def _predict(self, asked: Message) -> Message:
        prediction = self._network(_cloud(asked, "cloud"), _cloud(asked, "context"))
        texts = {}
        if prediction.closest_points is not None:
            texts["token"] = str(next(self._numbers))
            with self._holding:
                self._held[texts["token"]] = prediction.closest_points
                if len(self._held) > HELD:
                    self._held.popitem(last=False)
        told = {each.name: getattr(prediction, each.name) for each in fields(Prediction)}
        del told["closest_points"]
        arrays = {name: values for name, values in told.items() if values is not None}
        return Message("prediction", texts, arrays)

    def _closest(self, asked: Message) -> Message:
        with self._holding:
            closest = self._held.get(asked.texts["token"])
        if closest is None:
            raise WireError("that answer is not held any more")
        points = closest(asked.arrays["part_ids"], asked.arrays["rows"])
        return Message("points", {}, {"points": points})


class LateAnswering:
    """Answers by a network loaded at the first question, as the cache may answer all of a job."""

    def __init__(self, load: Callable[[], Answering]) -> None:
        self._load = load
        self._loading = threading.Lock()
        self._answering: Answering | None = None

    def __call__(self, question: bytes) -> bytes:
        """See :class:`Answering`; a refusal while the network cannot be loaded."""
        try:
            with self._loading:
                if self._answering is None:
                    self._answering = self._load()
        except Exception as error:  # noqa: BLE001 - who asks will ask at home
            return refusal(error)
        return self._answering(question)


def refusal(error: Exception) -> bytes:
    """Return the answer of who has none."""
    return pack(Message("refused", {"why": f"{type(error).__name__}: {error}"[:2000]}))


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
