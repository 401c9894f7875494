"""The same examples every time: a failure that depends on a seed or on load proves nothing."""

import os
from multiprocessing import forkserver
from pathlib import Path

import pytest
from browser import CHROMIUM, SOFTWARE
from hypothesis import settings

# As in the children of a job, and before anything loads numpy: threads of two workers that wait
# for one another take three times as long.
for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")

BESIDE_THE_REPOSITORY = Path(__file__).resolve().parents[1].parent / "shared" / "fixtures"


def pytest_addoption(parser):
    """``pytest tests --fixtures DIR``: outputs of the original networks, too large for the repo."""
    # pytest's own --fixtures lists fixtures, as --funcargs still does; here the name means a
    # folder.
    group = parser.optparser.add_argument_group("parity", conflict_handler="resolve")
    group.add_argument(
        "--fixtures", dest="fixtures_dir", type=Path, default=BESIDE_THE_REPOSITORY, metavar="DIR"
    )


@pytest.fixture(scope="session", autouse=True)
def _children():
    """Fork children of all tests from one process, which loads these once for all of them."""
    from asset_factory.sim_checks.judge import COMMON_MODULES
    from asset_factory.sim_checks.processes.isolation import preload

    named = ("asset_factory.factory.jobs.worker", "asset_factory.sim_checks.simulators.warm")
    preload((*COMMON_MODULES, *named, "mujoco", "pytest"))
    forkserver.ensure_running()


@pytest.fixture(scope="session")
def fixtures(request):
    """The folder of parity fixtures; tests that need it are skipped where there is none."""
    folder = request.config.getoption("fixtures_dir")
    if not folder.is_dir():
        pytest.skip(f"{folder} is not there; name the folder of parity fixtures with --fixtures")
    return folder


@pytest.fixture(scope="module")
def browser():
    api = pytest.importorskip("playwright.sync_api")
    if CHROMIUM is None:
        pytest.skip("no Chromium here; name one in CHROMIUM")
    with api.sync_playwright() as playwright:
        made = playwright.chromium.launch(executable_path=CHROMIUM, args=SOFTWARE)
        yield made
        made.close()
