"""What other processes do, waited for."""

import time
from pathlib import Path


def until(true, seconds=60.0):
    """Wait for something to be true; fail where it is not in time."""
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end
        time.sleep(0.02)


def alive(pid):
    """Whether a process runs: one that ended and was not asked after does not."""
    try:
        status = Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return False
    return status.rsplit(")", 1)[1].split()[0] != "Z"
