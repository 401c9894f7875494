"""A child that is asked again and again, and whose every answer is as good as a new child's."""

import gc
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest
import test_isolation as cold

from asset_factory.sim_checks.processes.isolation import Limits, WarmChild, run_isolated
from asset_factory.sim_checks.processes.scratch import scratch

GENEROUS = cold.GENEROUS
SEEN = []


def remember(value):
    """How many were asked before: what a verdict must not depend on."""
    SEEN.append(value)
    return len(SEEN)


def process_id():
    return os.getpid()


def first_or_nothing(path):
    """Works in a new child only, as a library does that was worn out by earlier calls."""
    SEEN.append(0)
    if len(SEEN) > 1:
        cold.crash()
    return Path(path).name


def hold(size):
    SEEN.append(len(HELD))
    HELD.append(b"x" * size)
    return os.getpid()


HELD = []


def burn(seconds):
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass
    return os.getpid()


def say(words):
    print(words)


def leave_a_file_and_die():
    tempfile.mkdtemp(prefix="left-behind-")
    cold.crash()


class TellsTwoThings(Exception):
    def __init__(self, one, other):
        super().__init__(one + other)


def raise_what_does_not_come_back():
    raise TellsTwoThings("one", "other")


@pytest.mark.parametrize(("most", "seen"), [({}, [1, 2, 3, 4, 5]), ({"calls": 2}, [1, 2, 1, 2, 1])])
def test_one_process_answers_many_calls_and_is_replaced_after_so_many(most, seen):
    with WarmChild(**most) as child:
        assert [child.call(remember, i, limits=GENEROUS).unwrap() for i in range(5)] == seen


def test_after_a_crash_a_new_process_answers():
    with WarmChild() as child:
        before = child.call(process_id, limits=GENEROUS).unwrap()
        assert "SIGSEGV" in child.call(cold.crash, limits=GENEROUS).detail
        assert child.pid is None
        assert child.call(process_id, limits=GENEROUS).unwrap() not in (before, os.getpid())


def test_memory_is_limited_by_call():
    tight = Limits(wall_s=5.0, memory_bytes=1_000_000_000)
    with WarmChild() as child:
        outcome = child.call(cold.allocate, limits=tight)
        assert "0.931 GiB" in outcome.detail
        with pytest.raises(MemoryError):
            outcome.unwrap()
        assert child.call(cold.allocate, limits=GENEROUS).value == 2_000_000_000


def test_processor_time_is_counted_by_call():
    limits = Limits(wall_s=30.0, cpu_s=1.0)
    with WarmChild() as child:
        burners = {child.call(burn, 0.6, limits=limits).unwrap() for _ in range(3)}
        assert len(burners) == 1
        assert "1 s of processor time" in child.call(cold.spin, limits=limits).detail


def test_a_failure_in_a_used_child_is_not_believed(tmp_path):
    with WarmChild() as child:
        for _ in range(3):
            outcome = child.call(first_or_nothing, str(tmp_path), limits=GENEROUS)
            assert outcome.value == tmp_path.name


def die_once(path):
    """Killed the first time, as by somebody who looks for memory."""
    if not Path(path).exists():
        Path(path).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return "alive"


def die():
    os.kill(os.getpid(), signal.SIGKILL)


def lose_the_fork_server(path):
    """Ask in a child whose fork server is killed at first; the process has a server of its own."""
    with WarmChild() as child:
        return child.call(kill_the_parent_once, path, limits=GENEROUS).unwrap()


def kill_the_parent_once(path):
    if not Path(path).exists():
        Path(path).touch()
        os.kill(os.getppid(), signal.SIGKILL)
        time.sleep(60.0)
    return "alive"


@pytest.mark.parametrize("function", [die_once, lose_the_fork_server])
def test_somebody_who_kills_processes_does_not_change_an_answer(function, tmp_path):
    outcome = run_isolated(function, str(tmp_path / "note"), limits=GENEROUS)
    assert (outcome.value, outcome.killed) == ("alive", False)


def test_who_is_killed_again_and_again_is_told_from_one_that_crashes():
    killed, crashed = (run_isolated(function, limits=GENEROUS) for function in (die, cold.crash))
    assert (killed.failure, killed.killed, killed.tries) == ("crashed", True, 2)
    assert "killed by SIGKILL" in killed.detail
    assert (crashed.failure, crashed.killed, crashed.tries) == ("crashed", False, 1)


def test_a_child_that_has_grown_is_replaced():
    with WarmChild(resident_bytes=400_000_000) as child:
        first = child.call(hold, 1000, limits=GENEROUS).unwrap()
        assert child.call(hold, 500_000_000, limits=GENEROUS).unwrap() == first
        assert child.call(hold, 1000, limits=GENEROUS).unwrap() != first


def test_what_one_call_wrote_does_not_turn_up_in_the_next():
    with WarmChild() as child:
        assert child.call(say, "first", limits=GENEROUS).output == "first"
        assert child.call(say, "second", limits=GENEROUS).output == "second"


def test_an_exception_that_cannot_be_read_is_told_and_not_raised():
    outcome = run_isolated(raise_what_does_not_come_back, limits=GENEROUS)
    assert outcome.failure == "raised"
    assert "cannot be read" in outcome.detail


def test_a_question_that_cannot_travel_is_the_caller_s_mistake_and_costs_nothing():
    with WarmChild() as child:
        first = child.call(process_id, limits=GENEROUS).unwrap()
        with pytest.raises((AttributeError, TypeError)):
            child.call(lambda: None, limits=GENEROUS)
        assert child.call(process_id, limits=GENEROUS).unwrap() == first


def resources():
    """Scratch files, open descriptors and shared memory (mapped semaphores) of this process."""
    gc.collect()
    files = os.listdir(scratch())
    descriptors = os.listdir("/proc/self/fd")
    return len(files), len(descriptors), Path("/proc/self/maps").read_text().count("/dev/shm")  # noqa: S108


def test_nothing_is_left_behind():
    run_isolated(cold.double, 1, limits=GENEROUS)
    before = resources()
    with WarmChild(calls=3) as child:
        pids = {child.call(process_id, limits=GENEROUS).unwrap() for _ in range(4)}
        for function in (cold.refuse, leave_a_file_and_die, cold.spin):
            child.call(function, limits=Limits(wall_s=0.5))
            pids.add(child.call(process_id, limits=GENEROUS).unwrap())
        assert resources() > before
    child.close()
    assert resources() == before
    assert len(pids) >= 4
    for pid in pids:
        cold.wait_until_gone(pid)


def test_a_value_error_is_an_answer_and_costs_no_child():
    with WarmChild() as child:
        pid = child.call(process_id, limits=GENEROUS).unwrap()
        assert isinstance(child.call(cold.refuse, limits=GENEROUS).error, ValueError)
        assert child.call(process_id, limits=GENEROUS).unwrap() == pid


def test_a_script_that_starts_children_while_it_is_imported_is_told_so(tmp_path):
    script = tmp_path / "unguarded.py"
    script.write_text(
        "import os\n"
        "from asset_factory.sim_checks.processes.isolation import Limits, run_isolated\n"
        "print(run_isolated(os.getpid, limits=Limits(wall_s=60.0)).detail)\n"
    )
    told = subprocess.check_output([sys.executable, script], text=True, timeout=120)
    assert "if __name__ == '__main__'" in told
