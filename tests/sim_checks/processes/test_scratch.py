"""What a process leaves when it is killed is found and removed; what a living one has is not."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from asset_factory.sim_checks.processes.scratch import PREFIX, SHORT, sweep

SCRIPT = (
    "import os\n"
    "from multiprocessing.util import get_temp_dir\n"
    "from asset_factory.sim_checks.processes.isolation import Limits, WarmChild\n"
    "if __name__ == '__main__':\n"
    "    with WarmChild() as child:\n"
    "        child.call(os.getpid, limits=Limits(wall_s=60.0))\n"
    "        print('asked', flush=True)\n"
    "        input()\n"
)


@pytest.fixture
def asker(tmp_path):
    """A process that asked a child and waits; its temporary files in ``tmp_path / "tmp"``."""
    (tmp_path / "tmp").mkdir()
    script = tmp_path / "asks.py"
    script.write_text(SCRIPT)
    environment = {**os.environ, "TMPDIR": str(tmp_path / "tmp")}
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen([sys.executable, script], env=environment, **pipes) as process:
        assert process.stdout.readline() == "asked\n"
        yield process
        process.kill()


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_whoever_ends_leaves_nothing(asker, tmp_path):
    (own,) = names(tmp_path / "tmp")
    assert own.startswith(PREFIX)
    assert sweep(tmp_path / "tmp") == 0
    asker.communicate("\n")
    assert asker.returncode == 0
    assert names(tmp_path / "tmp") == []


def test_what_a_killed_process_leaves_is_swept(asker, tmp_path):
    (tmp_path / "tmp" / "of-somebody-else").mkdir()
    asker.send_signal(signal.SIGKILL)
    asker.wait()
    assert len(names(tmp_path / "tmp")) == 2
    assert sweep(tmp_path / "tmp") == 1
    assert names(tmp_path / "tmp") == ["of-somebody-else"]


def test_sockets_have_a_short_way_where_temporary_files_have_a_long_one(tmp_path):
    far = tmp_path / ("deep" * 25)
    far.mkdir()
    script = tmp_path / "asks.py"
    script.write_text(SCRIPT.replace("'asked'", "get_temp_dir()"))
    environment = {**os.environ, "TMPDIR": str(far)}
    told = {"input": "\n", "capture_output": True, "text": True}
    asked = subprocess.run([sys.executable, script], env=environment, check=False, **told)
    assert asked.returncode == 0, asked.stderr
    sockets = Path(asked.stdout.strip())
    assert sockets.parent == SHORT
    assert not sockets.exists()
    assert names(far) == []
