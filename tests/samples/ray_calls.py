"""Calls for the Ray executor: nodes find them by the path that the test sets."""

import os
import signal
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from random_network import cloud_of

from asset_factory.factory.articulate.particulate import load_articulator
from asset_factory.factory.models.service import Address, asking


@dataclass(frozen=True)
class Filled:
    bundle: Path
    files: int


def square(number):
    return number * number


def slow_square(number, seconds, log):
    """Says in ``log`` that it began, and in which process."""
    (Path(log) / f"{number}-{os.getpid()}").touch()
    time.sleep(seconds)
    return number * number


def behave(how):
    if how == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    if how == "hang":
        time.sleep(600)
    if how == "raise":
        raise LookupError("nothing there")
    return how


def fill(source, staging, size):
    inner = staging / "bundle"
    (inner / "meshes").mkdir(parents=True)
    (inner / "meshes" / "a.bin").write_bytes(bytes(range(256)) * size)
    (inner / "robot.urdf").write_text(f"<robot name='{source}'/>")
    return Filled(inner, 2)


def answer(config, address):
    """What the network says of some points, whether it was loaded here, and where it was asked."""
    cloud = cloud_of(300)
    with asking(address if isinstance(address, Address) else None):
        network = load_articulator(config).network
    said = network(cloud, cloud).mask_logits.tobytes()
    return said, "torch" in sys.modules, getattr(address, "path", "")
