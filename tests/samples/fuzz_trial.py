"""One reading of one hostile folder, watched: what came of it, and what it touched."""

import ctypes
import os
import shutil
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from multiprocessing import forkserver
from pathlib import Path
from typing import Any

from fuzz_cases import OUTSIDE, Case
from mesh_cube import png

from asset_factory.sim_checks.processes.isolation import preload

#: Longest that a reading may take [s], and how much memory it may add [bytes].
MOST_SECONDS = 20.0
MOST_BYTES = 2 * 2**30
#: Of what starts a process for each file, which takes seconds on a busy machine.
MOST_SECONDS_COMPILED = 60.0
_COMPILED = ("mjcf", "usd")
_SOURCES = Path(__file__).resolve().parents[2]
_OURS = (_SOURCES / name for name in ("factory", "sim_checks", "configs", "src", "tests"))
_SYSTEMS = (sys.prefix, sys.base_prefix, "/usr/lib", "/usr/share", "/lib", "/proc/self")
_READABLE = tuple(f"{Path(folder).resolve()}{os.sep}" for folder in (*_OURS, *_SYSTEMS))
_RUNS = (
    *("os.system", "os.exec", "os.posix_spawn", "os.spawn"),
    *("subprocess.Popen", "pty.spawn", "webbrowser.open"),
)
_ASKS = ("socket.connect", "socket.getaddrinfo", "socket.sendto", "socket.bind", "urllib.Request")
_CHANGES = (
    "os.remove", "os.rename", "os.rmdir", "os.mkdir", "os.link", "os.symlink", "os.truncate",
    "os.chmod", "os.chown", "os.utime", "shutil.rmtree", "shutil.move", "shutil.copyfile",
)  # fmt: skip
_SECRETS = ("png", "mtl", "bin", "xml", "stl", "obj", "toml", "npz")


@dataclass(frozen=True)
class Trial:
    """What came of one case.

    Attributes:
        name, kind: of the case.
        verdict: ``loaded``, or the code of the refusal; ``failed`` for anything else.
        detail: the refusal's sentence, or what went wrong.
        seconds: wall-clock time [s].
        grown: memory that it took at its height [bytes].
        broke: rules that it broke, one sentence each.
    """

    name: str
    kind: str
    verdict: str
    detail: str
    seconds: float
    grown: int
    broke: tuple[str, ...]

    @property
    def failed(self) -> bool:
        """Whether the readers are at fault."""
        return self.verdict == "failed" or bool(self.broke)


class _Watch:
    """Sees every file this process opens or changes, program it starts and address it asks."""

    def __init__(self) -> None:
        self.folder: Path | None = None
        self.seen: list[str] = []
        sys.addaudithook(self._hear)

    def _hear(self, event: str, args: tuple[Any, ...]) -> None:
        if self.folder is None:
            return
        if event == "open" and isinstance(args[0], str | bytes):
            self._opened(os.fsdecode(args[0]), args[1], args[2])
        elif event in _CHANGES:
            self._changed(event, args)
        elif event in _RUNS:
            self.seen.append(f"{event} {args[:1]!r:.200}")
        elif event in _ASKS and not (
            event == "socket.connect" and isinstance(args[1], str | bytes)
        ):
            # A socket that is a file leads to this machine's own processes.
            self.seen.append(f"{event} {args!r:.200}")

    def _opened(self, path: str, mode: Any, flags: Any) -> None:
        writes = bool((flags or 0) & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)) or any(
            c in str(mode) for c in "wax+"
        )
        with suppress(OSError, ValueError):
            real = os.path.realpath(path)
            scratch = os.environ.get("TMPDIR", tempfile.gettempdir())
            mine = real.startswith((f"{scratch}{os.sep}", "/dev/")) or "__pycache__" in real
            inside = self.folder is not None and real.startswith(f"{self.folder}{os.sep}")
            if mine or (not writes and (inside or real.startswith(_READABLE))):
                return
            self.seen.append(f"{'wrote' if writes else 'read'} {real}")

    def _changed(self, event: str, args: tuple[Any, ...]) -> None:
        paths = [
            os.path.realpath(arg) for arg in args if isinstance(arg, str | bytes | os.PathLike)
        ]
        if any(
            not str(path).startswith(tempfile.gettempdir()) for path in paths
        ) and "__pycache__" not in str(paths):
            self.seen.append(f"{event} {paths!r:.200}")


@cache
def _watch() -> _Watch:
    return _Watch()


class _Alarm:
    """Hears of every look into a folder by any process, native code included (inotify)."""

    _OPENED = 0x20 | 0x1 | 0x2 | 0x100
    _NONBLOCK = 0o4000

    def __init__(self, folder: Path) -> None:
        libc = ctypes.CDLL(None, use_errno=True)
        self._descriptor = libc.inotify_init1(self._NONBLOCK)
        libc.inotify_add_watch(self._descriptor, str(folder).encode(), self._OPENED)

    def rang(self) -> bool:
        try:
            return bool(os.read(self._descriptor, 65536))
        except (BlockingIOError, OSError):
            return False


@cache
def _grounds() -> tuple[Path, Path, _Alarm]:
    """Where cases are laid out, the folder outside and its alarm; the working folder is apart."""
    base = Path(tempfile.mkdtemp(prefix="fuzz-")).resolve()
    outside = base / "outside"
    for folder in (base / "case", outside, base / "cwd"):
        folder.mkdir()
    for suffix in _SECRETS:
        content = png() if suffix == "png" else b"newmtl secret\nKd 1 0 0\n"
        (outside / f"secret.{suffix}").write_bytes(content)
    os.chdir(base / "cwd")
    # What compiles MJCF and reads checkpoints starts its children from here; it is up before
    # anybody watches.
    preload(("asset_factory.sim_checks.read.mjcf_compiler", "mujoco", "pxr.Usd", "torch"))
    forkserver.ensure_running()
    return base, outside, _Alarm(outside)


def try_case(case: Case) -> Trial:
    """Lay a case out, read it, and look at what that touched; no error of the reading is raised."""
    base, outside, alarm = _grounds()
    folder = base / "case"
    _lay_out(case, folder, outside)
    before = _listing(folder)
    watch = _watch()
    read = _READERS[case.verb]
    entry = os.fsdecode(os.path.join(os.fsencode(folder), os.fsencode(case.entry)))
    held = _forget_peak()
    watch.seen = []
    started = time.monotonic()
    with _watched(watch, folder):
        verdict, detail = read(Path(entry), folder)
    seconds = time.monotonic() - started
    grown = _peak() - held
    broke = list(dict.fromkeys(watch.seen))
    if alarm.rang():
        broke.append("looked into the folder outside")
    if (outside / "executed").exists():
        (outside / "executed").unlink()
        broke.append("ran code of the file")
    if _listing(folder) != before:
        broke.append("changed the input's folder")
    for path in Path.cwd().iterdir():
        broke.append(f"wrote {path.name} into the working folder")
        path.unlink()
    compiled = case.kind.startswith(_COMPILED)
    if seconds > (MOST_SECONDS_COMPILED if compiled else MOST_SECONDS):
        broke.append(f"took {seconds:.0f} s")
    if grown > MOST_BYTES:
        broke.append(f"took {grown / 2**30:.1f} GiB of memory")
    if case.least is not None and verdict not in (case.least, "failed"):
        broke.append(f"was {verdict}, want {case.least}")
    return Trial(case.name, case.kind, verdict, detail[-3000:], seconds, grown, tuple(broke))


@contextmanager
def _watched(watch: _Watch, folder: Path) -> Iterator[None]:
    watch.folder = folder
    try:
        yield
    finally:
        watch.folder = None


def _lay_out(case: Case, folder: Path, outside: Path) -> None:
    shutil.rmtree(folder)
    folder.mkdir()
    for name, data in case.files.items():
        path = os.path.join(os.fsencode(folder), os.fsencode(name))
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as stream:
            stream.write(data.replace(OUTSIDE, os.fsencode(outside)))
    for name, target in case.links.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        os.symlink(target.replace(OUTSIDE.decode(), str(outside)), folder / name)


def _listing(folder: Path) -> list[tuple[bytes, int]]:
    return sorted(
        (e.name, e.stat(follow_symlinks=False).st_size) for e in os.scandir(os.fsencode(folder))
    )


def _load(path: Path, folder: Path) -> tuple[str, str]:
    """As ``factory build`` does: find, load, and articulate what came with the input."""
    from asset_factory.factory.articulate.catalog import choose
    from asset_factory.factory.config import BuildConfig, IntakeConfig
    from asset_factory.factory.errors import InputRejected
    from asset_factory.factory.intake.discover import find_inputs
    from asset_factory.factory.intake.load import load

    def read() -> str:
        find_inputs((folder,))
        intake = load(path, IntakeConfig())
        if intake.annotation is not None or intake.annotation_path is not None:
            choose(intake, BuildConfig(articulator="annotated")).articulate(intake.mesh)
        return ""

    return _judged(read, InputRejected)


def _check(path: Path, folder: Path) -> tuple[str, str]:
    """As ``factory check`` does, MJCF and USD in a child that may die."""
    from asset_factory.sim_checks.description import DescriptionError
    from asset_factory.sim_checks.processes.isolation import WarmChild
    from asset_factory.sim_checks.read.native import ask_of
    from asset_factory.sim_checks.read.read import read_description
    from asset_factory.sim_checks.read.usd.as_urdf import write_as_urdf
    from asset_factory.sim_checks.read.usd.layers import is_usd

    def read() -> str:
        if not is_usd(path):
            return read_description(path).format
        with tempfile.TemporaryDirectory() as made, WarmChild() as child:
            urdf = ask_of(child, path.name, write_as_urdf, path, Path(made))
            return read_description(urdf).format

    return _judged(read, DescriptionError)


def _weights(path: Path, folder: Path) -> tuple[str, str]:
    """As ``factory weights info`` does."""
    from asset_factory.factory.errors import ConfigError
    from asset_factory.factory.models.weights.checkpoint import describe

    return _judged(lambda: str(describe(path).network), ConfigError)


def _judged(read: Callable[[], str], refusal: type[Exception]) -> tuple[str, str]:
    try:
        return "loaded", read()
    except refusal as error:
        return str(getattr(error, "code", "refused")), str(error)
    except Exception:  # noqa: BLE001 - what escapes is what is looked for
        return "failed", traceback.format_exc()


_READERS = {"load": _load, "check": _check, "weights": _weights}


def _forget_peak() -> int:
    """Memory held now [bytes]; the highest mark starts there."""
    with suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")
    return _status("VmRSS")


def _peak() -> int:
    return _status("VmHWM")


def _status(key: str) -> int:
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(f"{key}:"):
            return int(line.split()[1]) * 1024
    return 0
