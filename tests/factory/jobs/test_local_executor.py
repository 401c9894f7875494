"""Calls that crash, hang or eat memory cost only themselves; a million need no more than ten."""

import os
import signal
import threading
import time

import pytest

from asset_factory.factory.jobs import Call, LocalExecutor
from asset_factory.factory.jobs.executor import AHEAD
from asset_factory.sim_checks.processes.isolation import Limits
from asset_factory.sim_checks.processes.place import at

GENEROUS = Limits(wall_s=60.0)
CALLS = []


def behave(what):
    """Does what it is called."""
    CALLS.append(what)
    match what.split("-", maxsplit=1)[0]:
        case "crash":
            os.kill(os.getpid(), signal.SIGSEGV)
        case "eat":
            return str(len(b"x" * 10**12))
        case "raise":
            raise KeyError(what)
        case "worn" if len(CALLS) > 1:
            os.kill(os.getpid(), signal.SIGSEGV)
    return what


def nap(seconds):
    time.sleep(seconds)
    return seconds


def named(*names):
    return [Call(name, {"what": name}) for name in names]


def test_what_fails_costs_only_itself():
    calls = named("one", "crash", "two", "eat", "three", "raise", "four")
    limits = Limits(wall_s=60.0, memory_bytes=4 * 2**30)
    outcomes = {call.name: outcome for call, outcome in LocalExecutor(2).run(behave, calls, limits)}
    assert set(outcomes) == {call.name for call in calls}
    failures = {name: outcome.failure for name, outcome in outcomes.items() if outcome.failure}
    assert failures == {"crash": "crashed", "eat": "raised", "raise": "raised"}
    assert "SIGSEGV" in outcomes["crash"].detail
    assert "ran out of memory" in outcomes["eat"].detail
    for name in ("one", "two", "three", "four"):
        assert outcomes[name].unwrap() == name


def test_bad_luck_gets_one_more_try_in_a_new_process_and_no_more():
    # The first call of a process, and one that is not: both are tried twice.
    for calls, more in (
        (("crash",), {}),
        (("fine", "crash"), {}),
        (("crash",), {"retries": 0}),
        (("crash",), {"retries": 2}),
    ):
        *_, (_, outcome) = LocalExecutor(1, **more).run(behave, named(*calls), GENEROUS)
        assert (outcome.failure, outcome.tries) == ("crashed", 1 + more.get("retries", 1))
    # What only a worn process fails at is no failure.
    *_, (_, outcome) = LocalExecutor(1).run(behave, named("fine", "worn"), GENEROUS)
    assert (outcome.unwrap(), outcome.tries) == ("worn", 2)


def test_whoever_is_done_comes_first():
    calls = [Call(str(seconds), {"seconds": seconds}) for seconds in (1.0, 0.01)]
    naps = [outcome.value for _, outcome in LocalExecutor(2).run(nap, calls, GENEROUS)]
    assert naps == [0.01, 1.0]


def test_calls_are_taken_as_workers_come_free():
    taken = 0
    ahead = 0

    def endless():
        nonlocal taken
        while True:
            taken += 1
            yield Call(str(taken), {"seconds": 0.0})

    answers = LocalExecutor(2).run(nap, endless(), GENEROUS)
    for answered, _ in zip(range(200), answers, strict=False):
        ahead = max(ahead, taken - answered)
    answers.close()
    assert ahead <= AHEAD * 2


def test_workers_are_kept_and_replaced():
    calls = [Call(str(number), {}) for number in range(6)]
    ran = LocalExecutor(1, calls=3).run(os.getpid, calls, GENEROUS)
    processes = [outcome.unwrap() for _, outcome in ran]
    assert processes[0] == processes[1] == processes[2] != processes[3]
    assert processes[3] == processes[4] == processes[5]


def solids(_):
    with at("solids"):
        time.sleep(1.0)


def test_what_is_under_way_is_told_with_its_stage():
    executor = LocalExecutor(1)
    seen = set()
    done = threading.Event()

    def look():
        while not done.wait(0.05):
            seen.update((each.name, each.place) for each in executor.under_way())

    watcher = threading.Thread(target=look)
    watcher.start()
    list(executor.run(solids, [Call("oven", {"_": 0})], GENEROUS))
    done.set()
    watcher.join()
    assert ("oven", "solids") in seen
    assert executor.under_way() == ()


def test_what_is_not_wanted_or_too_late_is_not_made():
    late = Call("late", {"seconds": 0.0}, until=time.time() - 1.0)
    unwanted = Call("unwanted", {"seconds": 0.0}, wanted=lambda: False)
    for _, outcome in LocalExecutor(1).run(nap, [late, unwanted], GENEROUS):
        assert (outcome.value, outcome.failure) == (None, None)


def test_what_runs_past_its_time_is_ended_also_in_a_used_process():
    started = time.monotonic()

    def calls():
        # The last one is asked for once the first has its answer.
        yield from (Call(str(number), {"seconds": 0.0}) for number in range(AHEAD))
        yield Call("long", {"seconds": 60.0}, until=time.time() + 2.0)

    *_, (_, outcome) = LocalExecutor(1).run(nap, calls(), GENEROUS)
    assert (outcome.value, outcome.failure) == (None, None)
    assert time.monotonic() - started < 40.0


def test_closing_kills_what_is_under_way():
    started = time.monotonic()
    calls = [Call("short", {"seconds": 0.0}), Call("long", {"seconds": 600.0})]
    answers = LocalExecutor(2).run(nap, calls, GENEROUS)
    next(answers)
    answers.close()
    assert time.monotonic() - started < 30.0


def test_no_calls_no_processes_and_what_does_not_pickle_is_told():
    assert list(LocalExecutor(4).run(nap, (), GENEROUS)) == []
    anonymous = lambda: None  # noqa: E731
    ((_, outcome),) = LocalExecutor(1).run(anonymous, [Call("any", {})], GENEROUS)
    assert outcome.failure == "raised"
    assert "pickle" in outcome.detail.lower()


def test_an_error_in_whoever_makes_the_calls_is_its_own():
    def broken():
        yield Call("one", {"seconds": 0.0})
        raise LookupError("no more")

    with pytest.raises(LookupError, match="no more"):
        list(LocalExecutor(1).run(nap, broken(), GENEROUS))
