"""A Slurm of one controller and two node daemons on this machine, without any rights."""

import getpass
import os
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

NODES = ("n1", "n2")
_COMES_UP_S = 30.0

_CONFIGURATION = """
ClusterName=here
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
AuthType=auth/none
CredType=cred/none
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/controller.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/controller.log
SlurmdLogFile={folder}/%n.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=2 RealMemory=1000
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=2 RealMemory=1000
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


@contextmanager
def slurm_cluster(folder: Path) -> Iterator[dict[str, str]]:
    """The environment in which ``sbatch`` finds it. Skips, with a word, where it does not run."""
    for program in ("slurmctld", "slurmd", "sbatch"):
        if shutil.which(program) is None:
            pytest.skip(f"no {program} here: apt-get install slurmctld slurmd slurm-client")
    (folder / "state").mkdir()
    configuration = folder / "slurm.conf"
    host = socket.gethostname().split(".")[0]
    told = {"host": host, "ports": _free_ports(3), "folder": folder, "user": getpass.getuser()}
    configuration.write_text(_CONFIGURATION.format(**told))
    daemons = [["slurmctld", "-D", "-f", configuration]]
    daemons += [["slurmd", "-D", "-N", node, "-f", configuration] for node in NODES]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    running = [subprocess.Popen(daemon, **quiet) for daemon in daemons]
    environment = {**os.environ, "SLURM_CONF": str(configuration)}
    try:
        _await_nodes(environment, folder)
        yield environment
    finally:
        for process in reversed(running):
            process.terminate()
        for process in running:
            with suppress(subprocess.TimeoutExpired):
                process.wait(10.0)
            process.kill()
            process.wait()


def _await_nodes(environment: dict[str, str], folder: Path) -> None:
    until = time.monotonic() + _COMES_UP_S
    while time.monotonic() < until:
        asked = ["sinfo", "--noheader", "--format=%t %D"]
        told = subprocess.run(asked, env=environment, capture_output=True, text=True, check=False)
        if told.stdout.split() == ["idle", str(len(NODES))]:
            return
        time.sleep(0.2)
    log = folder / "controller.log"
    said = log.read_text().splitlines()[-1:] if log.is_file() else []
    pytest.skip(f"Slurm's daemons do not run here: {''.join(said) or told.stderr.strip()}")


def _free_ports(count: int) -> list[int]:
    listeners = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [listener.getsockname()[1] for listener in listeners]
    for listener in listeners:
        listener.close()
    return ports
