"""How inputs reach nodes that do not see them: all files of one packed, told by their digest."""

from __future__ import annotations

import errno
import hashlib
import io
import shutil
import tarfile
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from asset_factory.sim_checks.processes.scratch import scratch
from asset_factory.sim_checks.read.regular import read_regular

from ...intake.companions import companions
from ...intake.reads import Reads, digest_now, leads_out
from .exchange import MOST_BYTES, ExchangeError, unpacked

#: Where links lead that led out of an input's folder: nothing is there, and it is outside.
_NOWHERE = "/nowhere"


@dataclass(frozen=True)
class SentInput:
    """What a node must know of an input beside its bytes.

    Attributes:
        folder: name of its folder, from which a category may be guessed.
        name: of its main file.
        links: files that are links to outside its folder; the reader is to refuse them there too.
        digest: SHA-256 of its bytes.
    """

    folder: str
    name: str
    links: tuple[str, ...]
    digest: str

    @contextmanager
    def unpacked(self, data: bytes) -> Iterator[Path]:
        """Yield the input's path on this machine, where it lies within this.

        Raises:
            ExchangeError: other bytes were sent.
            OSError: there is no room for it.
        """
        if hashlib.sha256(data).hexdigest() != self.digest:
            raise ExchangeError("an input is not the one that was sent: its digest is another")
        around = Path(tempfile.mkdtemp(prefix="input-", dir=scratch()))
        # One folder more, for a folder may be called "..".
        folder = around / "in" / self.folder
        try:
            (around / "in").mkdir()
            folder.mkdir(exist_ok=True)
            with tarfile.open(fileobj=io.BytesIO(data), mode="r:") as archive:
                unpacked(archive, folder)
            for name in self.links:
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                (folder / name).symlink_to(_NOWHERE)
            yield folder / self.name
        finally:
            shutil.rmtree(around, ignore_errors=True)


@dataclass(frozen=True)
class PackedInput:
    """An input as it was sent.

    Attributes:
        source: where it lies.
        sent: what its receiver must know.
        data: its files as a tar archive.
        names: of all files that were looked for, relative to its folder.
    """

    source: Path
    sent: SentInput
    data: bytes = field(repr=False)
    names: frozenset[str]

    def lacking(self, reads: Reads) -> frozenset[str]:
        """Return the files that its reader missed on a node, and that are here."""
        other = {name: digest for name, digest in reads.items() if name not in self.names}
        return frozenset(n for n, digest in other.items() if digest_now(self.source, n) != digest)


def pack_input(source: Path, more: frozenset[str]) -> PackedInput:
    """Return an input with what it seems to refer to, and ``more`` that belongs to it.

    Raises:
        ValueError: it has too many bytes.
    """
    names = companions(source, more)
    links = sorted(name for name in names if leads_out(source, name) and _inside(name))
    data = _archived(source, sorted(names - set(links)))
    digest = hashlib.sha256(data).hexdigest()
    sent = SentInput(source.parent.name, source.name, tuple(links), digest)
    return PackedInput(source, sent, data, names)


def _inside(name: str) -> bool:
    return not Path(name).is_absolute() and ".." not in Path(name).parts


def _archived(source: Path, names: list[str]) -> bytes:
    """Return those of an input's files that are there, without owners, times and modes."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w:", format=tarfile.PAX_FORMAT) as archive:
        for name in names:
            if not (_inside(name) and (source.parent / name).is_file()):
                continue
            left = MOST_BYTES - packed.tell()
            try:
                content = read_regular(source.parent / name, left)
            except OSError as error:
                if error.errno != errno.EFBIG:
                    # Nobody can read it there either.
                    continue
                message = f"{source}: its files have more than {MOST_BYTES} bytes"
                raise ValueError(message) from error
            member = tarfile.TarInfo(Path(name).as_posix())
            member.size = len(content)
            archive.addfile(member, io.BytesIO(content))
    return packed.getvalue()
