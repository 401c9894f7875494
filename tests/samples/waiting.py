"""What other processes and threads do, waited for."""

import time
from contextlib import contextmanager
from pathlib import Path
from threading import Thread


def until(true, seconds=60.0):
    """Wait for something to be true; fail where it is not in time."""
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end
        time.sleep(0.02)


@contextmanager
def running(server):
    """A server that answers from a thread, until nobody asks any more."""
    thread = Thread(target=server.run)
    thread.start()
    yield server
    server.stop()
    thread.join()


def alive(pid):
    """Whether a process runs: one that ended and was not asked after does not."""
    try:
        status = Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return False
    return status.rsplit(")", 1)[1].split()[0] != "Z"
