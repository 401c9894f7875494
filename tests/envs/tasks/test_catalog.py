"""The list of tasks: known to gymnasium at once, loaded when one is made."""

import json
import subprocess
import sys

import pytest

IDS = {"OpenDrawer-v1", "OpenDoor-v1", "OpenJoint-v1", "CloseJoint-v1", "SetJoint-v1"}


def test_importing_the_package_names_the_tasks_and_loads_no_simulator():
    pytest.importorskip("gymnasium", reason="gymnasium is not installed")
    code = (
        "import sys, json, asset_factory.envs, gymnasium\n"
        "print(json.dumps([sorted(sys.modules), sorted(gymnasium.registry)]))"
    )
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=120
    )
    modules, registered = json.loads(run.stdout.splitlines()[-1])
    assert not {"torch", "sapien", "mani_skill"} & set(modules)
    assert set(registered) >= IDS
