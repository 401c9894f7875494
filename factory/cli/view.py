"""``factory view``: one file of anybody's, in the viewer of the report."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tyro.conf import Positional

from ..config import BuildConfig
from ..errors import ConfigError, Exit, InputRejected
from ..registry import Registry
from ..runtime.store import write_whole
from ..runtime.terminal import say
from .flags import in_own_process, require_files, require_page


@dataclass(frozen=True)
class ViewFile:
    """Look at an asset, a URDF, an MJCF or a mesh, and move its joints.

    The page is served on this machine only, until Ctrl-C; other files, or a folder, can be dropped
    on it. With --save it becomes one file that needs nothing else: it can be mailed, and opened
    without a network.
    """

    file: Positional[Path]
    """A URDF, MJCF or mesh file, an asset's folder, or its id with --output."""
    output: Path | None = None
    """The registry's folder, for an id."""
    save: Path | None = None
    """Write the page to this file, and serve nothing."""
    port: int = 0
    """Port of the page; 0: any that is free."""


def run(command: ViewFile) -> int:
    """Serve or save the page; returns the exit code."""
    from ..report.site.alone import MOST_BYTES, DroppedFiles
    from ..report.site.server import serve

    require_page(command.port)
    file = command.file
    if command.output is not None and not file.exists():
        registry = Registry(command.output)
        file = registry.folder(registry.named(str(file)))
    if not file.exists():
        want = "want a URDF, an MJCF, a mesh, or --output of an id"
        raise ConfigError(f"{file}: no such file; {want}")
    require_files(command.save)
    html = _drawn(file, live=command.save is None)
    if html is None:
        return Exit.UNJUDGED
    if command.save is None:
        answer = DroppedFiles(html, lambda dropped: _drawn(dropped, live=True))
        with serve(answer, command.port, MOST_BYTES) as server:
            say(f"{file.name} is shown at {server.url} until Ctrl-C")
            server.run()
        return Exit.OK
    try:
        write_whole(command.save, html.encode())
    except OSError as error:
        raise ConfigError(f"--save: {command.save}: {error.strerror}") from error
    say(command.save)
    return Exit.OK


def _drawn(file: Path, live: bool) -> str | None:
    """Return the page of a file; ``None`` where no answer came, which is said."""
    from ..report.site.alone import page_of_file

    # A file of anybody's may take any time and memory to read.
    try:
        return in_own_process(page_of_file, file, live, limits=BuildConfig())
    except InputRejected as rejection:
        raise ConfigError(f"{file}: {rejection.code}: {rejection.message}") from rejection
