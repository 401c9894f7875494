"""The command, and other programs, in a process of their own."""

import os
import subprocess
import sys

COMMAND = (sys.executable, "-m", "asset_factory.factory.cli")


def ran(*command, **settings):
    """What a program prints that has to succeed."""
    words = [os.fspath(word) for word in command]
    settings |= {"capture_output": True, "text": True, "timeout": 1200.0}
    done = subprocess.run(words, check=False, **settings)
    assert done.returncode == 0, "\n".join((settings.get("input", ""), done.stdout, done.stderr))
    return done.stdout
