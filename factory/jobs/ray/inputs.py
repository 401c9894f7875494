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
class PackedInput:
    """An input as it was sent.

    Attributes:
        source: where it lies for who sent it; a category may be guessed from its folder's name.
        names: of all files that were looked for, relative to its folder.
        links: files that are links to outside its folder; the reader is to refuse them there too.
        digest: SHA-256 of its bytes.
        data: its files as a tar archive; empty where those go beside it.
    """

    source: Path
    names: frozenset[str]
    links: tuple[str, ...]
    digest: str
    data: bytes = field(default=b"", repr=False)

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
        folder = around / "in" / self.source.parent.name
        try:
            (around / "in").mkdir()
            folder.mkdir(exist_ok=True)
            with tarfile.open(fileobj=io.BytesIO(data), mode="r:") as archive:
                unpacked(archive, folder)
            for name in self.links:
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                (folder / name).symlink_to(_NOWHERE)
            yield folder / self.source.name
        finally:
            shutil.rmtree(around, ignore_errors=True)

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
    return PackedInput(source, names, tuple(links), hashlib.sha256(data).hexdigest(), data)


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
