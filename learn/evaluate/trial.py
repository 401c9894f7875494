"""One method on one case: a question to a child process, and the row that comes of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from asset_factory.factory.errors import ConfigError, InputRejected
from asset_factory.sim_checks.processes.isolation import Failure, Limits, WarmChild, preload

from ..children import ask_children
from .cases import Request, make_case
from .methods import NAIVE, Method
from .physical import physical
from .published.cloud import POINTS, cloud_of
from .published.release import release
from .published.state import paper
from .score import Score
from .transfer import on_mesh

#: Imported once per evaluation instead of once per child.
COMMON_MODULES = ("scipy.optimize", "scipy.spatial", "asset_factory.learn.evaluate.trial")
#: A child that holds more than this after an answer is replaced [bytes].
RESIDENT_BYTES = 3 * 1024**3


@dataclass(frozen=True)
class Trial:
    """What to do: ``convention`` is physical, paper or release, the latter two with so many points.

    ``kept`` is the folder of objects read before; ``None`` to read them anew.
    """

    request: Request
    method: Method
    repeat: int = 0
    convention: str = "physical"
    points: int = POINTS
    kept: Path | None = None


@dataclass(frozen=True)
class Row:
    """What came of it.

    ``score`` is of the answer, or of the naive one where ``failure`` says why there was none;
    ``None`` if the case could not be made, or a clock or somebody stopped the method.
    """

    trial: Trial
    score: Score | None
    failure: str = ""


def score_trial(trial: Trial) -> Score:
    """Make the case, ask the method, compare.

    Raises:
        InputRejected: the method has no answer.
        ConfigError: the case's file is another one, or the method's checkpoint cannot be used.
    """
    truth = make_case(trial.request, trial.kept)
    answer = trial.method.seeded(trial.repeat).answer(truth.mesh, trial.request.name)
    truth = on_mesh(truth, answer.mesh)
    if trial.convention == "physical":
        return physical(truth, answer)
    true = cloud_of(truth, 0, trial.points)
    predicted = cloud_of(answer, 1, trial.points)
    return paper(true, predicted) if trial.convention == "paper" else release(true, predicted)


def run_trials(trials: Iterable[Trial], workers: int, limits: Limits) -> Iterator[Row]:
    """Return the rows of trials as they come, each made in a child that may crash or hang.

    ``limits`` are of one trial, of which ``workers`` run at once.

    Raises:
        ConfigError: as :func:`score_trial`; that is nobody's failure but a wrong request.
    """
    preload(COMMON_MODULES)

    def ask(child: WarmChild, trial: Trial) -> Row:
        outcome = child.call(score_trial, trial, limits=limits)
        if outcome.failure is None:
            return Row(trial, outcome.value)
        error = outcome.error
        if isinstance(error, ConfigError):
            raise error
        reason = f"{outcome.failure}: {outcome.detail}"
        if isinstance(error, InputRejected):
            reason = f"{error.code}: {error}"
        if outcome.failure is Failure.TIMEOUT or outcome.killed:
            return Row(trial, None, reason)
        naively = replace(trial, method=replace(trial.method, name=NAIVE))
        instead = child.call(score_trial, naively, limits=limits)
        return Row(trial, instead.value, reason)

    return ask_children(ask, trials, workers, RESIDENT_BYTES)
