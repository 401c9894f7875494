"""A real S3 server on this machine, and a line to it that can be cut."""

import logging
import os
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

BUCKET = "bucket"
SECRET = "kX9secretsecretsecret"  # noqa: S105 - of a server that lives for one test
KEY = "AKIAEXAMPLEEXAMPLE"


@contextmanager
def s3_server(listens_on: str = "127.0.0.1") -> Iterator[str]:
    """Its address; this process's fsspec and its children use it. Skips where moto is missing."""
    import pytest

    pytest.importorskip("s3fs")
    server_module = pytest.importorskip("moto.server")
    logging.getLogger("werkzeug").setLevel(logging.ERROR)
    server = server_module.ThreadedMotoServer(ip_address=listens_on, port=0, verbose=False)
    server.start()
    _, port = server.get_host_and_port()
    told = {
        "AWS_ENDPOINT_URL": f"http://{listens_on}:{port}",
        "AWS_ACCESS_KEY_ID": KEY,
        "AWS_SECRET_ACCESS_KEY": SECRET,
        "AWS_DEFAULT_REGION": "us-east-1",
    }
    before = {name: os.environ.get(name) for name in told}
    os.environ.update(told)
    try:
        yield told["AWS_ENDPOINT_URL"]
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
        server.stop()


class Line:
    """A TCP line to an address that breaks after so many bytes sent, as often as it is told to.

    Attributes:
        url: of this end.
        cut_after: bytes that a connection may carry towards the server; ``None``: any number.
        cuts: how often it broke.
    """

    def __init__(self, target: str) -> None:
        host, port = target.removeprefix("http://").split(":")
        self._target = (host, int(port))
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.url = f"http://127.0.0.1:{self._listener.getsockname()[1]}"
        self.cut_after: int | None = None
        self.cuts = 0
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self) -> None:
        """No more connections."""
        self._listener.close()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                near, _ = self._listener.accept()
                far = socket.create_connection(self._target)
                for ends in ((near, far, True), (far, near, False)):
                    threading.Thread(target=self._carry, args=ends, daemon=True).start()

    def _carry(self, source: socket.socket, target: socket.socket, there: bool) -> None:
        carried = 0
        with suppress(OSError), source, target:
            while data := source.recv(65536):
                carried += len(data)
                if there and self.cut_after is not None and carried > self.cut_after:
                    self.cuts += 1
                    return
                target.sendall(data)
