"""Whatever a child does, its caller gets an answer or a named failure.

A child that is asked again and again answers as well as a new one.
"""

import ctypes
import gc
import os
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from waiting import alive, until

from asset_factory.sim_checks.processes.isolation import Limits, WarmChild, run_isolated
from asset_factory.sim_checks.processes.scratch import scratch

GENEROUS = Limits(wall_s=30.0)


def crash():
    os.write(2, b"native words")
    ctypes.string_at(0)


def spin():
    while True:
        pass


def leave():
    os._exit(7)


def refuse():
    raise ValueError("no")


def allocate():
    return len(bytearray(2_000_000_000))


def answer_with_a_closure():
    return lambda: None


class TellsTwoThings(Exception):
    def __init__(self, one, other):
        super().__init__(one + other)


def raise_what_does_not_come_back():
    raise TellsTwoThings("one", "other")


def start_grandchild(path):
    child = subprocess.Popen(["sleep", "60"])  # noqa: S607
    Path(path).write_text(str(child.pid))
    spin()


def nest(path):
    Path(path).write_text("started")
    return run_isolated(note_pid_and_spin, path, limits=Limits(wall_s=60.0))


def note_pid_and_spin(path):
    Path(path).write_text(str(os.getpid()))
    spin()


def keep_idle_child(path):
    with WarmChild() as child:
        child.call(abs, -1, limits=GENEROUS)
        Path(path).write_text(str(child.pid))
        spin()


SEEN = []


def remember(value):
    """How many were asked before: what a verdict must not depend on."""
    SEEN.append(value)
    return len(SEEN)


def first_or_nothing(path):
    """Works in a new child only, as a library does that was worn out by earlier calls."""
    SEEN.append(0)
    if len(SEEN) > 1:
        crash()
    return Path(path).name


def hold(size):
    SEEN.append(b"x" * size)
    return os.getpid()


def burn(seconds):
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass
    return os.getpid()


def leave_a_file_and_die():
    tempfile.mkdtemp(prefix="left-behind-")
    crash()


@pytest.mark.parametrize(
    ("function", "wall_s", "failure", "words", "output"),
    [
        (crash, 30.0, "crashed", "SIGSEGV", "native words"),
        (leave, 30.0, "crashed", "exit code 7", ""),
        (spin, 0.3, "timeout", "0.3 s", ""),
        (answer_with_a_closure, 30.0, "raised", "answer_with_a_closure", ""),
        (raise_what_does_not_come_back, 30.0, "raised", "cannot be read", ""),
    ],
)
def test_whatever_goes_wrong_is_named_and_last_words_are_kept(
    function, wall_s, failure, words, output
):
    outcome = run_isolated(function, limits=Limits(wall_s=wall_s))
    assert (outcome.failure, outcome.value) == (failure, None)
    assert words in outcome.detail
    assert output in outcome.output


def wait_until_gone(pid):
    until(lambda: not alive(pid), 5.0)


def pid_in(note):
    until(lambda: note.exists() and note.read_text().isdigit())
    return int(note.read_text())


@pytest.mark.parametrize("function", [start_grandchild, nest])
def test_whatever_a_killed_child_has_started_dies_too(function, tmp_path):
    note = tmp_path / "pid"
    with WarmChild() as child, ThreadPoolExecutor(1) as pool:
        called = pool.submit(child.call, function, str(note), limits=Limits(wall_s=60.0))
        pid = pid_in(note)
        child.abandon()
        outcome = called.result()
    assert (outcome.failure, outcome.tries) == ("crashed", 1)
    wait_until_gone(pid)


def test_an_abandoned_child_is_not_asked_again():
    with WarmChild() as child:
        assert child.call(abs, -1, limits=GENEROUS).value == 1
        child.abandon()
        outcome = child.call(abs, -1, limits=GENEROUS)
        assert (outcome.failure, outcome.tries) == ("crashed", 1)
        assert "SIGKILL" in outcome.detail


def test_a_hang_takes_down_what_it_has_started(tmp_path):
    note = tmp_path / "pid"
    # The first call has the child running before the clock does.
    with WarmChild() as child:
        child.call(abs, -1, limits=GENEROUS)
        child.call(start_grandchild, str(note), limits=Limits(wall_s=1.0))
    wait_until_gone(pid_in(note))


@pytest.mark.parametrize(
    "work",
    ["run_isolated(t.note_pid_and_spin, {!r}, limits=t.GENEROUS)", "keep_idle_child({!r})"],
    ids=["busy", "idle"],
)
def test_no_child_survives_a_killed_job(work, tmp_path):
    note = tmp_path / "pid"
    script = tmp_path / "job.py"
    script.write_text(
        "import sys\n"
        f"sys.path[:0] = {sys.path!r}\n"
        "import test_isolation as t\n"
        "if __name__ == '__main__':\n"
        f"    t.{work.format(str(note))}\n"
    )
    with subprocess.Popen([sys.executable, str(script)]) as job:
        pid = pid_in(note)
        job.kill()
    wait_until_gone(pid)


@pytest.mark.parametrize(("most", "seen"), [({}, [1, 2, 3, 4, 5]), ({"calls": 2}, [1, 2, 1, 2, 1])])
def test_one_process_answers_many_calls_and_is_replaced_after_so_many(most, seen):
    with WarmChild(**most) as child:
        assert [child.call(remember, i, limits=GENEROUS).unwrap() for i in range(5)] == seen


def test_after_a_crash_a_new_process_answers():
    with WarmChild() as child:
        before = child.call(os.getpid, limits=GENEROUS).unwrap()
        assert "SIGSEGV" in child.call(crash, limits=GENEROUS).detail
        assert child.pid is None
        assert child.call(os.getpid, limits=GENEROUS).unwrap() not in (before, os.getpid())


def test_memory_is_limited_by_call():
    tight = Limits(wall_s=5.0, memory_bytes=1_000_000_000)
    with WarmChild() as child:
        outcome = child.call(allocate, limits=tight)
        assert "0.931 GiB" in outcome.detail
        with pytest.raises(MemoryError):
            outcome.unwrap()
        assert child.call(allocate, limits=GENEROUS).value == 2_000_000_000


def test_processor_time_is_counted_by_call():
    limits = Limits(wall_s=30.0, cpu_s=1.0)
    with WarmChild() as child:
        burners = {child.call(burn, 0.6, limits=limits).unwrap() for _ in range(2)}
        assert len(burners) == 1
        assert "1 s of processor time" in child.call(spin, limits=limits).detail


def test_a_failure_in_a_used_child_is_not_believed(tmp_path):
    with WarmChild() as child:
        for _ in range(3):
            outcome = child.call(first_or_nothing, str(tmp_path), limits=GENEROUS)
            assert outcome.value == tmp_path.name


def die():
    os.kill(os.getpid(), signal.SIGKILL)


def die_once(path):
    """Killed the first time, as by somebody who looks for memory."""
    if not Path(path).exists():
        Path(path).touch()
        die()
    return "alive"


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
    killed, crashed = (run_isolated(function, limits=GENEROUS) for function in (die, crash))
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
        for words in ("first", "second"):
            assert child.call(print, words, limits=GENEROUS).output == words


def test_a_refusal_and_a_question_that_cannot_travel_cost_no_child():
    with WarmChild() as child:
        first = child.call(os.getpid, limits=GENEROUS).unwrap()
        with pytest.raises((AttributeError, TypeError)):
            child.call(lambda: None, limits=GENEROUS)
        assert isinstance(child.call(refuse, limits=GENEROUS).error, ValueError)
        assert child.call(os.getpid, limits=GENEROUS).unwrap() == first


def resources():
    """Scratch files, open descriptors and shared memory (mapped semaphores) of this process."""
    gc.collect()
    files = os.listdir(scratch())
    descriptors = os.listdir("/proc/self/fd")
    return len(files), len(descriptors), Path("/proc/self/maps").read_text().count("/dev/shm")  # noqa: S108


def test_nothing_is_left_behind():
    run_isolated(abs, -1, limits=GENEROUS)
    before = resources()
    with WarmChild(calls=3) as child:
        pids = {child.call(os.getpid, limits=GENEROUS).unwrap() for _ in range(4)}
        for function in (refuse, leave_a_file_and_die, spin):
            child.call(function, limits=Limits(wall_s=0.5))
            pids.add(child.call(os.getpid, limits=GENEROUS).unwrap())
        assert resources() > before
    child.close()
    assert resources() == before
    assert len(pids) >= 4
    for pid in pids:
        wait_until_gone(pid)


def test_a_script_that_starts_children_while_it_is_imported_is_told_so(tmp_path):
    script = tmp_path / "unguarded.py"
    script.write_text(
        "import os\n"
        "from asset_factory.sim_checks.processes.isolation import Limits, run_isolated\n"
        "print(run_isolated(os.getpid, limits=Limits(wall_s=60.0)).detail)\n"
    )
    told = subprocess.check_output([sys.executable, script], text=True, timeout=120)
    assert "if __name__ == '__main__'" in told
