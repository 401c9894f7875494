"""The page's own server: a fixed table of addresses, and nothing else."""

from __future__ import annotations

import json
import secrets
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from http import HTTPStatus
from pathlib import Path
from threading import Lock, Thread
from typing import Any, TypeVar

from asset_factory.sim_checks.processes.isolation import Limits, WarmChild, preload

from ..config import BuildConfig
from ..errors import AssetFactoryError, ConfigError
from ..intake.stated import MOST_BYTES, Hinge, Stated, StatedKind, decoded, form_of, stated_from
from ..report.pages import environment
from ..report.site.render import STATIC
from ..report.site.server import NOT_FOUND, PageRequest, PageResponse, PageServer, serve
from ..runtime.store import write_whole
from . import work
from .builds import Builds
from .pictures import SidePicture
from .subject import Subject

T = TypeVar("T")

JSON = "application/json"
GLB = "model/gltf-binary"
_OWN = Path(__file__).parent / "static"
_KINDS = {".css": "text/css", ".js": "text/javascript"}
_SHARED = tuple(STATIC / name for name in ("base.css", "site.css", "asset.js"))
#: By name: nothing else of any folder is within a browser's reach.
STATIC_FILES = {path.name: path for path in (*_SHARED, *sorted(_OWN.iterdir()))}
FRONTS = ("-y", "y", "-x", "x")
#: A light preview, or a picture [s]: whoever waits longer has left.
PREVIEW_S = 120.0


class AskedChild:
    """A child process that holds the mesh, asked by one thread at a time."""

    def __init__(self, config: BuildConfig, wall_s: float) -> None:
        self._limits = Limits(wall_s=wall_s, memory_bytes=config.asset_memory_bytes)
        self._child = WarmChild()
        self._lock = Lock()

    def ask(self, function: Callable[..., T], *arguments: object) -> T:
        """Return what a function returns there.

        Raises:
            AssetFactoryError: what it raised, or that no answer came.
        """
        with self._lock:
            outcome = self._child.call(function, *arguments, limits=self._limits)
        if isinstance(outcome.error, AssetFactoryError):
            raise outcome.error
        if outcome.failure is not None:
            raise ConfigError(f"no answer: {outcome.detail}")
        return outcome.value  # type: ignore[return-value]

    def end(self) -> None:
        """Kill it."""
        self._child.abandon()
        with self._lock:
            self._child.close()


class Editor:
    """What a page is told about one mesh, and what it may change: its sidecar.

    Args:
        subject: the mesh to edit.
        config: how it is loaded, and who guesses.
        builds: what its Build does.
    """

    def __init__(self, subject: Subject, config: BuildConfig, builds: Builds) -> None:
        self.token = secrets.token_urlsafe(24)
        self._subject = subject
        self._config = config
        self._builds = builds
        self._quick = AskedChild(config, PREVIEW_S)
        self._slow = AskedChild(config, config.asset_wall_s)
        self._opened = self._quick.ask(work.open_mesh, subject.mesh, config, subject.asset)
        self._sides = {"-y": self._pictures("-y")}
        self._verdict: work.ShownModel | None = None
        self._gets: dict[str, Callable[[], PageResponse]] = {
            "": self._page,
            "state": lambda: _json(self._state()),
            "model.glb": lambda: PageResponse(self._opened.model, GLB),
            "built.glb": lambda: PageResponse(self._shown().model, GLB),
            "verdict": lambda: _json(self._told()),
        }
        self._posts: dict[str, Callable[[bytes], PageResponse]] = {
            "preview": self._preview,
            "guess": lambda _: _json(self._slow.ask(work.guess, subject.mesh, config)),
            "save": self._save,
            "build": self._build,
            "stop": self._stop,
        }

    def answer(self, asked: PageRequest) -> PageResponse:
        """Answer a request; an unknown address, or one without the token, is not found."""
        _, token, name = (*asked.path.split("/", 2), "", "")[:3]
        if not secrets.compare_digest(token.encode(), self.token.encode()):
            return NOT_FOUND
        try:
            if asked.method == "POST":
                return self._posts[name](asked.body) if name in self._posts else NOT_FOUND
            return self._got(name)
        except AssetFactoryError as error:
            return _json({"sentence": str(error)}, HTTPStatus.UNPROCESSABLE_ENTITY)
        except OSError as error:
            sentence = f"{self._subject.sidecar.name}: cannot be written: {error.strerror}"
            return _json({"sentence": sentence}, HTTPStatus.UNPROCESSABLE_ENTITY)

    def _got(self, name: str) -> PageResponse:
        if name in self._gets:
            return self._gets[name]()
        if name in STATIC_FILES:
            path = STATIC_FILES[name]
            return PageResponse(path.read_bytes(), _KINDS[path.suffix])
        return self._picture(name)

    def _page(self) -> PageResponse:
        template = environment(__package__).get_template("edit.html.j2")
        html = template.render(name=self._subject.mesh.name, top="", alone=None)
        return PageResponse(html.encode())

    def look(self) -> None:
        """Have the first preview prepared, while somebody looks at the page."""
        Thread(target=self._look, daemon=True).start()

    def end(self) -> None:
        """Kill all that was started."""
        self._builds.stop()
        self._quick.end()
        self._slow.end()

    def _look(self) -> None:
        # The preview says what is wrong.
        with suppress(AssetFactoryError, OSError):
            self._quick.ask(work.look, self._subject.mesh, self._config, "-y")

    def _pictures(self, front: str) -> dict[str, SidePicture]:
        drawn = self._quick.ask(work.pictures_of, self._subject.mesh, self._config, front)
        return {str(picture.side): picture for picture in drawn}

    def _picture(self, name: str) -> PageResponse:
        """Return ``sides/FRONT/SIDE.png``, or where the mesh is in them: ``sides/FRONT``."""
        place, front, side = (*name.split("/"), "", "", "")[:3]
        if place != "sides" or front not in FRONTS:
            return NOT_FOUND
        if front not in self._sides:
            self._sides[front] = self._pictures(front)
        if not side:
            sides = self._sides[front].values()
            return _json([{"side": p.side, "size": p.size, "frame": p.frame} for p in sides])
        picture = self._sides[front].get(side.removesuffix(".png"))
        return NOT_FOUND if picture is None else PageResponse(picture.png, "image/png")

    def _state(self) -> dict[str, Any]:
        existing = self._subject.existing
        text = ""
        sentence = ""
        values: object = None
        if existing is not None:
            text = existing.read_bytes()[:MOST_BYTES].decode("utf-8", "replace")
            try:
                values = decoded(text.encode(), form_of(existing))
                stated_from(values)
            except ConfigError as error:
                sentence = f"{existing.name}: {error}"
        return {
            "name": self._subject.mesh.stem,
            "output": str(self._subject.output),
            "sidecar": self._subject.sidecar.name,
            "existing": existing.name if existing else "",
            "text": text,
            "stated": values if isinstance(values, dict) else None,
            "sentence": sentence,
            "found": self._opened.told,
            "asset": self._subject.asset.name if self._subject.asset else "",
            "kinds": tuple(StatedKind),
            "hinges": tuple(Hinge),
            "fronts": FRONTS,
        }

    def _preview(self, body: bytes) -> PageResponse:
        stated = _stated(body)
        made = self._quick.ask(work.preview, self._subject.mesh, self._config, stated)
        return PageResponse(made, GLB)

    def _save(self, body: bytes) -> PageResponse:
        _stated(body)
        write_whole(self._subject.sidecar, body)
        return _json({"saved": self._subject.sidecar.name})

    def _build(self, body: bytes) -> PageResponse:
        saved = self._save(body)
        self._verdict = None
        self._builds.start()
        return saved

    def _stop(self, _: bytes) -> PageResponse:
        self._builds.stop()
        return _json({})

    def _told(self) -> dict[str, Any]:
        run = self._builds.last
        if run is None:
            return {"state": "none", "sentence": ""}
        if run.asset:
            return {"state": "done", **self._shown().told}
        return {"state": "failed", "sentence": run.said} if run.said else {"state": "running"}

    def _shown(self) -> work.ShownModel:
        """Return the last verdict. Raises ConfigError: there is none."""
        run = self._builds.last
        if run is None or not run.asset:
            raise ConfigError("nothing was built yet")
        if self._verdict is None:
            self._verdict = self._slow.ask(work.verdict_of, self._subject.output, run.asset)
        return self._verdict


@contextmanager
def editing(
    subject: Subject, config: BuildConfig, builds: Builds, port: int = 0
) -> Iterator[PageServer]:
    """Yield the server of a page on which a mesh is edited.

    Raises:
        AssetFactoryError: the mesh cannot be loaded, or the port is taken.
    """
    preload(("asset_factory.factory.edit.work",))
    editor = Editor(subject, config, builds)
    try:
        with serve(editor.answer, port, MOST_BYTES) as server:
            editor.look()
            yield replace(server, url=f"{server.url}{editor.token}/")
    finally:
        editor.end()


def _stated(body: bytes) -> Stated:
    """Return what a page states, read as strictly as its file will be. Raises ConfigError."""
    return stated_from(decoded(body))


def _json(data: object, status: HTTPStatus = HTTPStatus.OK) -> PageResponse:
    return PageResponse(json.dumps(data).encode(), JSON, status)
