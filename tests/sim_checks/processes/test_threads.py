"""A child computes with one thread, unless the user says otherwise."""

import os
import subprocess
import sys

import pytest

from asset_factory.sim_checks.processes.threads import VARIABLES

SCRIPT = """
import ctypes
import os
from pathlib import Path

from asset_factory.sim_checks.processes.isolation import Limits, preload, run_isolated


def blas_threads():
    import numpy

    numpy.ones((300, 300)) @ numpy.ones((300, 300))
    libraries = sorted(Path(numpy.__file__).parents[1].glob("numpy.libs/*openblas*"))
    return ctypes.CDLL(libraries[0]).scipy_openblas_get_num_threads64_()


def nested():
    return run_isolated(blas_threads, limits=Limits(wall_s=60.0)).unwrap()


if __name__ == "__main__":
    preload(("numpy",))
    before = dict(os.environ)
    counts = [run_isolated(f, limits=Limits(wall_s=60.0)).unwrap() for f in (blas_threads, nested)]
    assert dict(os.environ) == before
    print(*counts)
"""


# On one processor OpenBLAS has one thread whatever it is told.
@pytest.mark.skipif(len(os.sched_getaffinity(0)) < 2, reason="takes two processors")
@pytest.mark.parametrize(("given", "threads"), [({}, 1), ({"OPENBLAS_NUM_THREADS": "2"}, 2)])
def test_children_and_theirs_compute_with_one_thread_or_as_many_as_the_user_set(
    tmp_path, given, threads
):
    script = tmp_path / "asks.py"
    script.write_text(SCRIPT)
    environment = {name: value for name, value in os.environ.items() if name not in VARIABLES}
    command = [sys.executable, script]
    told = subprocess.check_output(command, env=environment | given, text=True, timeout=120)
    assert [int(count) for count in told.split()] == [threads, threads]
