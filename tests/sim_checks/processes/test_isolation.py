"""Whatever a child does, its caller gets an answer or a named failure."""

import ctypes
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from waiting import alive, until

from asset_factory.sim_checks.processes.isolation import Limits, WarmChild, run_isolated

GENEROUS = Limits(wall_s=30.0)


def double(value):
    return 2 * value


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
        child.call(double, 1, limits=GENEROUS)
        Path(path).write_text(str(child.pid))
        spin()


def test_a_segmentation_fault_is_named_and_its_last_words_kept():
    outcome = run_isolated(crash, limits=GENEROUS)
    assert (outcome.failure, outcome.value) == ("crashed", None)
    assert "SIGSEGV" in outcome.detail
    assert "native words" in outcome.output


def test_a_hang_ends_at_the_wall_limit():
    outcome = run_isolated(spin, limits=Limits(wall_s=0.3))
    assert outcome.failure == "timeout"
    assert "0.3 s" in outcome.detail


def test_leaving_without_an_answer_is_a_crash():
    assert "exit code 7" in run_isolated(leave, limits=GENEROUS).detail


def test_an_answer_that_cannot_travel_is_told():
    assert "answer_with_a_closure" in run_isolated(answer_with_a_closure, limits=GENEROUS).detail


def wait_until_gone(pid):
    until(lambda: not alive(pid), 5.0)


def pid_in(note):
    until(lambda: note.exists() and note.read_text().isdigit())
    return int(note.read_text())


def abandoned(function, note):
    """The outcome of a call whose child is abandoned as soon as it has noted a process."""
    with WarmChild() as child, ThreadPoolExecutor(1) as pool:
        outcome = pool.submit(child.call, function, str(note), limits=Limits(wall_s=60.0))
        pid_in(note)
        child.abandon()
        return outcome.result()


@pytest.mark.parametrize("function", [start_grandchild, nest])
def test_whatever_a_killed_child_has_started_dies_too(function, tmp_path):
    outcome = abandoned(function, tmp_path / "pid")
    assert (outcome.failure, outcome.tries) == ("crashed", 1)
    wait_until_gone(pid_in(tmp_path / "pid"))


def test_an_abandoned_child_is_not_asked_again():
    with WarmChild() as child:
        assert child.call(double, 1, limits=GENEROUS).value == 2
        child.abandon()
        outcome = child.call(double, 1, limits=GENEROUS)
        assert (outcome.failure, outcome.tries) == ("crashed", 1)
        assert "SIGKILL" in outcome.detail


def test_a_hang_takes_down_what_it_has_started(tmp_path):
    note = tmp_path / "pid"
    # The first call has the child running before the clock does.
    with WarmChild() as child:
        child.call(double, 1, limits=GENEROUS)
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
