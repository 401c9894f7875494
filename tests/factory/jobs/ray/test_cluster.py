"""A cluster of one's own is this machine's affair: loopback ports, a token that no file holds."""

import json
import subprocess
import sys

import pytest

pytest.importorskip("ray")

SCRIPT = """
import json, os
from asset_factory.factory.jobs.ray.cluster import LOCAL, connected

with connected(LOCAL, 1) as ray:
    import psutil

    def answered():
        return os.environ["RAY_AUTH_MODE"], len(os.environ["RAY_AUTH_TOKEN"])

    told = ray.get(ray.remote(answered).remote())
    family = [psutil.Process(), *psutil.Process().children(recursive=True)]
    addresses = {
        connection.laddr.ip.removeprefix("::ffff:")
        for process in family
        for connection in process.net_connections("inet")
        if connection.status == psutil.CONN_LISTEN
    }
    print(json.dumps({"told": told, "addresses": sorted(addresses)}))
"""


def test_a_cluster_of_ones_own_listens_to_this_machine_and_this_job_only(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    for name in ("RAY_AUTH_MODE", "RAY_AUTH_TOKEN", "RAY_AUTH_TOKEN_PATH"):
        monkeypatch.delenv(name, raising=False)
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], capture_output=True, text=True, timeout=120, check=True
    )
    assert json.loads(done.stdout) == {"told": ["token", 64], "addresses": ["127.0.0.1"]}
    assert not (tmp_path / ".ray").exists()
