"""What people copy to have a night every night: systemd's units and Slurm's scripts, run."""

import os
import shutil
import subprocess
import sys

import pytest
from repository import EXAMPLES, ROOT
from slurm_cluster import slurm_cluster
from waiting import until

NIGHTLY = EXAMPLES / "nightly"
#: Smaller than what the scripts ask for.
SMALL = ("--cpus-per-task=1", "--mem=200")

REAL = f"""#!/bin/sh
PYTHONPATH={ROOT}/src exec {sys.executable} -m asset_factory.factory.cli "$@"
"""
NOTING = """#!/bin/sh
echo "$SLURMD_NODENAME $(basename "$0") $*" >> "$HOME/calls"
"""
# The shell hears of a signal while it waits, not while a program runs in front of it.
PATIENT = """
trap 'echo "$SLURMD_NODENAME told to stop" >> "$HOME/calls"; exit 130' TERM
/bin/sleep 60 & wait
"""


@pytest.fixture
def home(tmp_path):
    """A home with the folder that the examples speak of."""
    made = tmp_path / "home"
    (made / "assets" / ".venv" / "bin").mkdir(parents=True)
    (made / "assets" / "in").mkdir()
    (made / "assets" / "nightly.toml").write_text("inputs = ['in']\nsim = 'mujoco'\n")
    return made


def program(home, name, text):
    path = home / "assets" / ".venv" / "bin" / name
    path.write_text(text)
    path.chmod(0o755)


def calls(home):
    path = home / "calls"
    return path.read_text().splitlines() if path.is_file() else []


def test_systemd_takes_the_units_as_they_are(home):
    if shutil.which("systemd-analyze") is None:
        pytest.skip("no systemd-analyze here: apt-get install systemd")
    program(home, "factory", REAL)
    command = ["systemd-analyze", "verify", "--user", "--man=no", "--recursive-errors=no"]
    command += [NIGHTLY / f"factory-nightly.{kind}" for kind in ("service", "timer")]
    environment = {**os.environ, "HOME": str(home), "XDG_RUNTIME_DIR": str(home)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout + done.stderr) == (0, "")


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    with slurm_cluster(tmp_path_factory.mktemp("slurm")) as environment:
        yield environment


def submitted(cluster, home, script, *more, path=""):
    """The exit code of a job, once it ended."""
    environment = {**cluster, "HOME": str(home), "PATH": f"{path}{os.environ['PATH']}"}
    command = ["sbatch", "--wait", f"--output={home}/said", *SMALL, *more, NIGHTLY / script]
    return subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL)


@pytest.mark.cluster
def test_slurm_runs_a_night(cluster, home):
    program(home, "factory", REAL)
    assert submitted(cluster, home, "nightly.sbatch").wait(120.0) == 0
    said = (home / "said").read_text()
    assert "Night 0001: 0 of 0 inputs passed" in said
    assert (home / "assets" / "out" / "nights" / "0001" / "index.html").is_file()


def tell_to_stop(cluster):
    """As Slurm itself does some time before a job's time is up: the script alone."""
    command = ["scancel", "--batch", "--signal=TERM", "--state=RUNNING", f"--user={os.getuid()}"]
    subprocess.run(command, env=cluster, check=True)


@pytest.mark.cluster
def test_a_night_hears_that_its_time_is_up(cluster, home):
    program(home, "factory", NOTING + PATIENT)
    job = submitted(cluster, home, "nightly.sbatch")
    until(lambda: calls(home))
    (called,) = calls(home)
    assert called == "n1 factory nightly --config nightly.toml --workers 1 --max-hours 7.5"
    tell_to_stop(cluster)
    assert job.wait(60.0) == 130
    assert calls(home)[1:] == ["n1 told to stop"]


@pytest.mark.cluster
def test_a_night_over_two_nodes_starts_ray_on_each_and_hears_it_too(cluster, home):
    program(home, "factory", NOTING + PATIENT)
    program(home, "ray", NOTING + PATIENT)
    # The script waits for Ray to come up; what stands for Ray here is up at once.
    program(home, "sleep", "#!/bin/sh\nexec /bin/sleep 1\n")
    path = f"{home}/assets/.venv/bin:"
    job = submitted(cluster, home, "ray.sbatch", "--nodes=2", path=path)
    until(lambda: len(calls(home)) == 3)
    factory = "factory nightly --config nightly.toml --executor ray --ray-address n1:6379"
    assert sorted(calls(home)) == [
        f"n1 {factory} --max-hours 7.5",
        "n1 ray start --head --port=6379 --num-cpus=1 --block",
        "n2 ray start --address=n1:6379 --num-cpus=1 --block",
    ]
    tell_to_stop(cluster)
    assert job.wait(60.0) == 130
    assert "n1 told to stop" in calls(home)
