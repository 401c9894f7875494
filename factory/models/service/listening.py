"""A Unix socket at which questions arrive: bounded in number, in size and in time."""

import os
import socket
import threading
import time
from contextlib import suppress

from .answering import Answer
from .wire import WireError, receive, send

#: Askers at a time; the next one is turned away, and asks its own network.
MOST_ASKERS = 256
#: Longest that a question may take to arrive, and an answer to be taken [s].
PATIENCE_S = 30.0


def listening_socket(path: str) -> socket.socket:
    """Return a socket that accepts askers on return, of this user only; replaces a dead one's."""
    with suppress(FileNotFoundError):
        os.unlink(path)
    listening = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    mask = os.umask(0o177)
    try:
        listening.bind(path)
    finally:
        os.umask(mask)
    listening.listen(MOST_ASKERS)
    return listening


def answer_all(listening: socket.socket, answer: Answer, most_askers: int = MOST_ASKERS) -> None:
    """Answer one question per asker, each in its own thread, until the socket is closed."""
    places = threading.BoundedSemaphore(most_askers)
    while True:
        try:
            asker, _ = listening.accept()
        except OSError:
            return
        if not places.acquire(blocking=False):
            asker.close()
            continue
        threading.Thread(target=_answer_one, args=(asker, answer, places), daemon=True).start()


def _answer_one(asker: socket.socket, answer: Answer, places: threading.BoundedSemaphore) -> None:
    try:
        with asker, suppress(OSError, WireError):
            reply = answer(receive(asker, time.monotonic() + PATIENCE_S))
            send(asker, reply, time.monotonic() + PATIENCE_S)
    finally:
        places.release()
