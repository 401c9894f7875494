"""Pages, served to this machine's own browsers and to nobody else."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from ...errors import ConfigError

HOST = "127.0.0.1"
HTML = "text/html; charset=utf-8"
#: For a browser that says nothing more [s].
PATIENCE_S = 30
#: A page shows nothing to another one, and is shown in none.
_GUARDS = {
    "Cache-Control": "no-store",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
}


@dataclass(frozen=True)
class PageRequest:
    """What a browser asks for.

    Attributes:
        method: ``GET`` or ``POST``.
        path: as it was sent; nothing in it was resolved.
        body: what came with it; empty of ``GET``.
    """

    method: str
    path: str
    body: bytes = b""


@dataclass(frozen=True)
class PageResponse:
    """What it gets."""

    body: bytes = b""
    kind: str = HTML
    status: HTTPStatus = HTTPStatus.OK


Answer = Callable[[PageRequest], PageResponse]
NOT_FOUND = PageResponse(status=HTTPStatus.NOT_FOUND)


@dataclass(frozen=True)
class PageServer:
    """A server that waits for its pages to be asked for.

    Attributes:
        url: where the first page is.
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
def serve(answer: Answer, port: int = 0, most_bytes: int = 0) -> Iterator[PageServer]:
    """Yield a server; nothing of the file system is within its reach but by its answers.

    ``answer`` is called from several threads at once. Port 0 is any that is free; a request may
    bring ``most_bytes``.

    Raises:
        ConfigError: the port is taken.
    """

    class Handler(BaseHTTPRequestHandler):
        timeout = PATIENCE_S

        def do_GET(self) -> None:
            self._answer(PageRequest("GET", self.path))

        def do_POST(self) -> None:
            length = self.headers.get("Content-Length", "")
            if not (length.isascii() and length.isdigit()):
                self._send(PageResponse(status=HTTPStatus.LENGTH_REQUIRED))
            elif len(length) > 12 or int(length) > most_bytes:
                self._send(PageResponse(status=HTTPStatus.REQUEST_ENTITY_TOO_LARGE))
            else:
                body = self.rfile.read(int(length))
                self._answer(PageRequest("POST", self.path, body))

        def _answer(self, asked: PageRequest) -> None:
            # Of another name, the request comes from a page that wants to read what is shown here.
            name = self.headers.get("Host", "").rsplit(":", 1)[0]
            origin = self.headers.get("Origin")
            ours = origin is None or origin == f"http://{self.headers['Host']}"
            self._send(answer(asked) if name in (HOST, "localhost") and ours else NOT_FOUND)

        def _send(self, response: PageResponse) -> None:
            self.send_response(response.status)
            self.send_header("Content-Type", response.kind)
            self.send_header("Content-Length", str(len(response.body)))
            for name, value in _GUARDS.items():
                self.send_header(name, value)
            self.end_headers()
            with suppress(ConnectionError):
                self.wfile.write(response.body)

        def log_message(self, format: str, *args: object) -> None:
            """Say nothing."""

    try:
        server = ThreadingHTTPServer((HOST, port), Handler)
    except OSError as error:
        raise ConfigError(f"--port: {port} cannot be used: {error.strerror}") from error
    with server:
        yield PageServer(f"http://{HOST}:{server.server_address[1]}/", server)
