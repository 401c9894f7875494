"""One page, served to this machine's own browsers and to nobody else."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from ...errors import ConfigError

HOST = "127.0.0.1"


@dataclass(frozen=True)
class PageServer:
    """A server that waits for its page to be asked for.

    Attributes:
        url: where the page is.
    """

    url: str
    _server: ThreadingHTTPServer

    def run(self) -> None:
        """Serve until somebody interrupts."""
        with suppress(KeyboardInterrupt):
            self._server.serve_forever()

    def stop(self) -> None:
        """End :meth:`run` from another thread."""
        self._server.shutdown()


@contextmanager
def serve(page: bytes, port: int = 0) -> Iterator[PageServer]:
    """Yield a server of one page; nothing of the file system is within its reach.

    Args:
        page: HTML.
        port: 0: any that is free.

    Raises:
        ConfigError: the port is taken.
    """

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            # Of another name, the request comes from a page that wants to read what is shown here.
            name = self.headers.get("Host", "").rsplit(":", 1)[0]
            found = name in (HOST, "localhost") and self.path in ("/", "/index.html")
            body = page if found else b""
            self.send_response(HTTPStatus.OK if found else HTTPStatus.NOT_FOUND)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.send_header("Content-Length", str(len(body)))
            self.send_header("Cache-Control", "no-store")
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, format: str, *args: object) -> None:
            """Say nothing."""

    try:
        server = ThreadingHTTPServer((HOST, port), Handler)
    except OSError as error:
        raise ConfigError(f"--port: {port} cannot be used: {error.strerror}") from error
    with server:
        yield PageServer(f"http://{HOST}:{server.server_address[1]}/", server)
