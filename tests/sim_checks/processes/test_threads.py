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


def threads_of_children(folder, **given):
    script = folder / "asks.py"
    script.write_text(SCRIPT)
    environment = {name: value for name, value in os.environ.items() if name not in VARIABLES}
    command = [sys.executable, script]
    told = subprocess.check_output(command, env={**environment, **given}, text=True, timeout=120)
    return [int(count) for count in told.split()]


# On one processor OpenBLAS has one thread whatever it is told.
several = pytest.mark.skipif(len(os.sched_getaffinity(0)) < 2, reason="takes two processors")


@several
def test_linear_algebra_in_children_and_theirs_has_one_thread(tmp_path):
    assert threads_of_children(tmp_path) == [1, 1]


@several
def test_a_number_of_threads_that_the_user_set_stays(tmp_path):
    assert threads_of_children(tmp_path, OPENBLAS_NUM_THREADS="2") == [2, 2]
