"""An interrupted or killed job leaves no process, loses nothing, and the next does the rest."""

import os
import signal
import subprocess
import sys
import time

import pytest
from job_samples import MADE, job, made, pretend, write_inputs
from repository import SAMPLES
from waiting import alive, until

from asset_factory.factory.jobs.signals import Terminated, interruptible, undisturbed
from asset_factory.factory.registry import Registry

SCRIPT = SAMPLES / "slow_job.py"
PATIENCE_S = 60.0


def started(folder, output, *flags):
    """A job on a folder of inputs, in a process of its own."""
    command = [sys.executable, str(SCRIPT), str(folder), str(output), *flags]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True)


def begun(folder, output, *flags):
    """One that has finished three inputs and hangs in the fourth."""
    write_inputs(folder, 3, "zz_slow")
    process = started(folder, output, *flags)
    assert process.stdout is not None
    for _ in range(3):
        assert process.stdout.readline() == "passed\n"
    until(lambda: "zz_slow.stl" in made(folder))
    return process


def workers(folder):
    return {int(line.split()[1]) for line in (folder / MADE).read_text().splitlines()}


@pytest.mark.parametrize(
    ("number", "code"),
    [(signal.SIGTERM, 143), pytest.param(signal.SIGINT, 130, marks=pytest.mark.full)],
)
def test_an_interrupted_job_has_registered_what_was_finished(number, code, tmp_path):
    with begun(tmp_path / "in", tmp_path / "out") as process:
        process.send_signal(number)
        assert process.wait(PATIENCE_S) == code
        assert process.stdout.read() == "interrupted 0\n"
    assert not any(alive(worker) for worker in workers(tmp_path / "in"))
    assert {entry.status for entry in Registry(tmp_path / "out").entries()} == {"passed"}
    assert len(Registry(tmp_path / "out").entries()) == 3
    for name in (".staging", ".claims"):
        assert list((tmp_path / "out" / name).iterdir()) == []


def test_the_first_ctrl_c_finishes_what_is_begun_and_the_second_stops(tmp_path):
    with begun(tmp_path / "in", tmp_path / "out", "--wind-up") as process:
        process.send_signal(signal.SIGINT)
        time.sleep(0.5)
        assert process.poll() is None
        assert all(alive(worker) for worker in workers(tmp_path / "in"))
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE_S) == 130
    assert len(Registry(tmp_path / "out").entries()) == 3


def test_a_job_that_winds_up_begins_nothing_more(tmp_path, builds_are):
    builds_are(pretend)
    inputs = write_inputs(tmp_path / "in", 8)
    winding = job(inputs, tmp_path / "out")
    finished = []
    for result in winding.run():
        finished.append(result)
        winding.wind_up()
    assert 1 <= len(finished) < 8
    assert (winding.left, winding.state) == (8 - len(finished), "interrupted")
    assert len(list(job(inputs, tmp_path / "out").run())) == 8


def test_a_job_out_of_time_stops_what_runs_and_registers_nothing_of_it(tmp_path):
    write_inputs(tmp_path / "in", 0, "slow")
    with started(tmp_path / "in", tmp_path / "out", "--max-s", "8") as process:
        assert process.wait(PATIENCE_S) == 0
        assert process.stdout.read() == "out_of_time 1\n"
    assert Registry(tmp_path / "out").entries() == ()


def test_with_one_worker_ctrl_c_builds_what_is_begun_and_no_more(tmp_path):
    write_inputs(tmp_path / "in", 0, "nap_0", "nap_1", "nap_2")
    with started(tmp_path / "in", tmp_path / "out", "--wind-up", "--one") as process:
        until(lambda: (tmp_path / "in" / MADE).exists() and made(tmp_path / "in"))
        process.send_signal(signal.SIGINT)
        assert process.stdout.read() == "passed\ninterrupted 2\n"
    assert made(tmp_path / "in") == ["nap_0.stl"]


def test_a_killed_job_leaves_no_orphans_and_the_next_one_does_the_rest(tmp_path, builds_are):
    with begun(tmp_path / "in", tmp_path / "out") as process:
        process.kill()
        assert process.wait(PATIENCE_S) == -signal.SIGKILL
    until(lambda: not any(alive(worker) for worker in workers(tmp_path / "in")))
    # What it had claimed is free again.
    (tmp_path / "in" / "zz_slow.stl").rename(tmp_path / "in" / "zz.stl")
    builds_are(pretend)
    inputs = tuple(sorted((tmp_path / "in").glob("*.stl")))
    assert [result.attempts for result in job(inputs, tmp_path / "out").run()] == [0, 0, 0, 1]


def test_a_signal_waits_until_it_does_no_harm():
    steps = []

    def register():
        with undisturbed():
            os.kill(os.getpid(), signal.SIGTERM)
            time.sleep(0.01)
            steps.append("registered")
        steps.append("not reached")

    with pytest.raises(Terminated), interruptible():
        register()
    assert steps == ["registered"]
    assert signal.getsignal(signal.SIGTERM) == signal.SIG_DFL
