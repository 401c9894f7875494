"""How folders that calls fill elsewhere return: by a path all nodes see, or a URL of fsspec's."""

from __future__ import annotations

import errno
import hashlib
import shutil
import tarfile
import tempfile
import uuid
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import IO, Any, Generic, TypeVar

from asset_factory.sim_checks.processes.isolation import Outcome

from ...runtime.remote import located, shown, told

T = TypeVar("T")

#: Most that one call may send back [bytes]: a finished asset has a few megabytes.
MOST_BYTES = 4 * 1024**3
MOST_FILES = 100_000
BLOCK = 1 << 20
#: Errors of a disk that is full.
FULL = (errno.ENOSPC, errno.EDQUOT)


class ExchangeError(Exception):
    """Other bytes arrived than were sent, or none could be sent."""


def with_own_folder(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments of a try, with a ``staging`` folder of its own within the one given.

    So it meets nothing that another try left or still writes.
    """
    return {**arguments, "staging": Path(arguments["staging"]) / uuid.uuid4().hex}


def begin_transfer(
    url: str, function: Callable[..., Any], arguments: Mapping[str, Any]
) -> tuple[dict[str, Any], Transfer]:
    """Return the arguments of :func:`make_and_send` for a call, and what opens its answer.

    The ``bundle`` of the call's value lies in its ``staging`` folder and comes back, unless it is
    ``None``. ``cache`` names a place that only the caller sees: nodes get ``None`` for it.

    Args:
        url: of a folder that all nodes can write and the caller can read, as fsspec names it; one
            file is sent there, which is removed when it was read.
        function: to be called.
        arguments: of it, as :func:`with_own_folder` gives them.
    """
    folder: Path = arguments["staging"]
    target = f"{url.rstrip('/')}/{folder.name}.tar"
    seen = {name: None if name == "cache" else value for name, value in arguments.items()}
    asked = {"target": target, "function": function, "arguments": seen}
    return asked, Transfer(folder, target)


@dataclass(frozen=True)
class Sent(Generic[T]):
    """A node's answer.

    Attributes:
        value: of the function.
        folder: that it filled, where that was.
        digest: SHA-256 of the file that was sent; empty if there was nothing to send.
        size: of that file [bytes].
    """

    value: T
    folder: str
    digest: str = ""
    size: int = -1


@dataclass(frozen=True)
class Transfer:
    """One try's folder, as the caller awaits it.

    Attributes:
        folder: where it should be; not there yet.
        url: of the file that brings it.
    """

    folder: Path
    url: str

    def opened(self, outcome: Outcome[Sent[T]]) -> Outcome[T]:
        """Return the function's own outcome, with its folder here: the ``bundle`` lies there.

        Raises:
            OSError: the file that brings it is not there any more, or is another one.
        """
        answer: Any = outcome
        if outcome.value is None:
            self.drop()
            return answer  # type: ignore[no-any-return]
        sent = outcome.value
        value: Any = sent.value
        if sent.digest:
            try:
                there = value.bundle.relative_to(sent.folder)
                value = replace(value, bundle=self._fetched(sent) / there)
            except OSError:
                raise
            except Exception as error:
                # Each file system has errors of its own.
                raise OSError(f"{shown(self.url)}: {told(error, self.url)}") from error
            finally:
                self.drop()
        return replace(answer, value=value)

    def drop(self) -> None:
        """Remove the file that brings it, if there is one."""
        with suppress(Exception):
            file_system, path = located(self.url)
            file_system.rm_file(path)

    def _fetched(self, sent: Sent[T]) -> Path:
        if not 0 <= sent.size <= MOST_BYTES:
            raise ExchangeError(f"it has {sent.size} bytes, at most {MOST_BYTES} are taken")
        file_system, path = located(self.url)
        self.folder.mkdir(parents=True)
        self.folder.chmod(0o755)
        with tempfile.TemporaryFile(dir=self.folder) as local:
            digest = hashlib.sha256()
            size = 0
            with file_system.open(path, "rb") as remote:
                while size <= sent.size and (block := remote.read(BLOCK)):
                    digest.update(block)
                    local.write(block)
                    size += len(block)
            if (size, digest.hexdigest()) != (sent.size, sent.digest):
                why = "its size or digest is another"
                raise ExchangeError(f"it is not the file that was sent: {why}")
            local.seek(0)
            with tarfile.open(fileobj=local, mode="r:") as archive:
                unpacked(archive, self.folder)
        return self.folder


def make_and_send(
    target: str,
    function: Callable[..., T],
    arguments: Mapping[str, Any],
    here: Mapping[str, Any] | None = None,
) -> Sent[T]:
    """Let the function fill a local folder, and send the ``bundle`` of its value; on a node.

    Arguments in ``here`` are others on this node.
    """
    with tempfile.TemporaryDirectory(prefix="made-") as folder:
        value: Any = function(**{**arguments, **(here or {}), "staging": Path(folder)})
        bundle = value.bundle
        if bundle is None:
            return Sent(value, folder)
        with tempfile.TemporaryFile() as packed:
            with tarfile.open(fileobj=packed, mode="w:", format=tarfile.PAX_FORMAT) as archive:
                archive.add(bundle, bundle.relative_to(folder).as_posix())
            size = packed.tell()
            packed.seek(0)
            digest = hashlib.file_digest(packed, "sha256").hexdigest()
            packed.seek(0)
            _send(packed, target)
        return Sent(value, folder, digest, size)


def _send(packed: IO[bytes], target: str) -> None:
    """Write all of a file to a URL.

    Raises:
        ExchangeError: that failed, which is no fault of the content.
        OSError: a disk is full.
    """
    try:
        file_system, place = located(target)
        with file_system.open(place, "wb") as remote:
            shutil.copyfileobj(packed, remote, BLOCK)
    except Exception as error:
        if isinstance(error, OSError) and error.errno in FULL:
            raise
        # Errors of some file systems do not pickle, and say more than anybody may know.
        raise ExchangeError(f"{shown(target)}: {told(error, target)}") from None


def unpacked(archive: tarfile.TarFile, folder: Path) -> None:
    """Unpack files and folders of an archive, nothing else and nowhere else.

    Raises:
        ExchangeError: it holds something else, a path that leaves the folder, or too much.
    """
    files = 0
    size = 0
    for member in archive:
        name = PurePosixPath(member.name)
        if name.is_absolute() or ".." in name.parts or not (member.isfile() or member.isdir()):
            raise ExchangeError(f"{member.name!r} is no file or folder below the one that was sent")
        files = files + 1
        size = size + member.size
        if files > MOST_FILES or size > MOST_BYTES:
            raise ExchangeError(f"more than {MOST_FILES} files or {MOST_BYTES} bytes")
        target = folder / name
        if member.isdir():
            target.mkdir(parents=True, exist_ok=True)
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        content = archive.extractfile(member)
        assert content is not None, "it is a file"  # noqa: S101
        with target.open("xb") as file:
            shutil.copyfileobj(content, file, BLOCK)
