"""Starve a build: full or read-only disks, jumping clocks, unreadable and changing inputs.

python benchmarks/soak/full_disk.py --assets 8

One JSON line with a list of broken promises for each trial (want all empty), and the sentences that
were said. Disks of a few megabytes are mounted, which takes an administrator on Linux; elsewhere
those trials are passed over.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from job import build_command, collected, done
from meshes import write_meshes
from outcome import content, leftovers, rows

from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.verify import verify

YEAR_S = 365 * 86_400.0
#: As root, but without the right to read what the owner may not read.
LIKE_ANYBODY = (
    "setpriv",
    *(f"--{which}=-dac_override,-dac_read_search" for which in ("bounding-set", "inh-caps")),
)
#: Exit codes of ``factory``.
OK = 0
NOT_WRITTEN = 2


@dataclass(frozen=True)
class Place:
    """Where trials happen.

    Attributes:
        meshes: the inputs.
        folder: for outputs and temporary files.
        wanted: every file of the registry that an undisturbed build makes.
        assets: how many.
    """

    meshes: Path
    folder: Path
    wanted: Mapping[str, str]
    assets: int

    @property
    def scratch(self) -> Path:
        """For temporary files."""
        return self.folder / "tmp"

    def build(self, output: Path, inputs: Path | None = None) -> subprocess.CompletedProcess[str]:
        """One build, to its end."""
        return done(build_command(inputs or self.meshes, output, 2), self.scratch)


class Promises:
    """What should hold, and what did not."""

    def __init__(self) -> None:
        self.broken: list[str] = []
        self.said: list[str] = []

    def expect(self, holds: bool, otherwise: str) -> None:
        """Note it if it does not hold."""
        if not holds:
            self.broken.append(otherwise)

    def one_sentence(self, ended: subprocess.CompletedProcess[str], words: str) -> None:
        """A build that could not write says so in a line, and no traceback."""
        last = ended.stderr.strip().splitlines()[-1:] or [""]
        self.said += last
        self.expect(
            ended.returncode == NOT_WRITTEN, f"exit code {ended.returncode}, want {NOT_WRITTEN}"
        )
        self.expect("Traceback" not in ended.stderr, f"a traceback: {ended.stderr[-300:]}")
        self.expect(words in last[0], f"no word of {words!r}")

    def sound(self, output: Path, *, without: str = "") -> None:
        """What is published is whole; problems of one kind may be excepted."""
        found = list(verify(Registry(output, create=True)))
        problems = [problem.message for problem in found if problem.kind != without]
        self.expect(not problems, f"not sound: {problems[:2]}")

    def complete(self, place: Place, output: Path) -> None:
        """Nothing is missing, nothing is another, nothing is left."""
        collected(output, place.scratch)
        self.expect(content(output) == place.wanted, "other files than an undisturbed build's")
        self.expect(not leftovers(output), f"left: {leftovers(output)[:3]}")
        self.expect(not os.listdir(place.scratch), f"temporary: {os.listdir(place.scratch)[:3]}")


def full_disk(place: Place, kib: int) -> Promises:
    """The disk is full in the middle; with more room the same command does the rest."""
    promises = Promises()
    output = place.folder / f"full_{kib}"
    with small_disk(output, kib) as grow:
        ended = place.build(output)
        promises.one_sentence(ended, "No space left on device")
        grow(64 * 1024)
        # There may have been room for a whole folder and none for its row: nobody reads it until it
        # has one.
        promises.sound(output, without="unlisted")
        promises.expect(place.build(output).returncode == OK, "did not finish with more room")
        promises.sound(output)
        promises.complete(place, output)
    return promises


def read_only(place: Place) -> Promises:
    """The output cannot be written: what is known is told, what is new is not built."""
    promises = Promises()
    output = place.folder / "read_only"
    few = place.folder / "few"
    write_meshes(few, 2)
    with small_disk(output, 64 * 1024):
        promises.expect(place.build(output, few).returncode == OK, "the first build failed")
        before = content(output)
        mount("-o", "remount,ro", str(output))
        promises.one_sentence(place.build(output), "Read-only file system")
        promises.one_sentence(place.build(output, few), "Read-only file system")
        promises.expect(content(output) == before, "something changed")
    return promises


def jumping_clocks(place: Place) -> Promises:
    """Files from the future and from 1970 change nothing: no rebuild, nothing alive is removed."""
    promises = Promises()
    output = place.folder / "clocks"
    promises.expect(place.build(output).returncode == OK, "the first build failed")
    for moment in (0.0, time.time() + 10 * YEAR_S):
        for path in (*place.meshes.rglob("*"), *output.rglob("*"), output):
            os.utime(path, (moment, moment))
        (output / ".cache" / ".writing-dead").touch()
        os.utime(output / ".cache" / ".writing-dead", (moment, moment))
        known = place.build(output)
        promises.expect(known.returncode == OK, f"exit code {known.returncode}")
        summary = json.loads((output / "summary.json").read_text())
        promises.expect(
            summary["known"] == place.assets, f"{summary['known']} known, want {place.assets}"
        )
        promises.sound(output)
        promises.complete(place, output)
    return promises


def unreadable(place: Place) -> Promises:
    """An unreadable input is rejected in a sentence, the others are built; with rights, it too."""
    promises = Promises()
    output = place.folder / "unreadable"
    inputs = place.folder / "some"
    shutil.copytree(place.meshes, inputs)
    closed = sorted(inputs.glob("*.glb"))[1]
    closed.chmod(0)
    ended = done([*LIKE_ANYBODY, *build_command(inputs, output, 2)], place.scratch)
    promises.expect(ended.returncode == OK, f"exit code {ended.returncode}: {ended.stderr[-300:]}")
    bad = [row for row in rows(output) if row["status"] != "passed"]
    promises.said += [f"{row['reason']}: {row['message']}" for row in bad]
    promises.expect(
        [row["name"] for row in bad] == [closed.stem], f"not passed: {[row['name'] for row in bad]}"
    )
    closed.chmod(0o644)
    promises.expect(place.build(output, inputs).returncode == OK, "did not build it with rights")
    promises.complete(place, output)
    return promises


def being_written(place: Place) -> Promises:
    """Inputs that are written again and again are built as one version or refused.

    Once at rest, they are built.
    """
    promises = Promises()
    output = place.folder / "written"
    inputs = place.folder / "changing"
    shutil.copytree(place.meshes, inputs)
    paths = sorted(inputs.glob("*.glb"))
    stop = threading.Event()
    whole = {path: path.read_bytes() for path in paths}

    def write() -> None:
        while not stop.is_set():
            for path in paths:
                path.write_bytes(whole[path][: len(whole[path]) // 2])
                time.sleep(0.002)
                path.write_bytes(whole[path])

    writer = threading.Thread(target=write)
    writer.start()
    try:
        ended = place.build(output, inputs)
    finally:
        stop.set()
        writer.join()
    promises.expect(ended.returncode == OK, f"exit code {ended.returncode}: {ended.stderr[-300:]}")
    promises.sound(output)
    built = {name: digest for name, digest in content(output).items() if name.startswith("assets/")}
    promises.expect(built.items() <= place.wanted.items(), "an asset of half a file")
    promises.said += sorted({row["reason"] for row in rows(output) if row["reason"]})
    promises.expect(place.build(output, inputs).returncode == OK, "did not build them at rest")
    passed = {
        name: digest for name, digest in content(output).items() if name.startswith("assets/")
    }
    promises.expect(passed == place.wanted, "other files than an undisturbed build's")
    return promises


@contextmanager
def small_disk(folder: Path, kib: int) -> Iterator[Callable[[int], None]]:
    """A file system of its own, of so many KiB; gives what makes it larger."""
    folder.mkdir()
    mount("-t", "tmpfs", "-o", f"size={kib}k", "small", str(folder))
    try:
        yield lambda more: mount("-o", f"remount,size={more}k", str(folder))
    finally:
        subprocess.run(["umount", "--lazy", str(folder)], check=True)  # noqa: S607 - wherever it is


def mount(*arguments: str) -> None:
    """Call mount. Raises CalledProcessError."""
    subprocess.run(["mount", *arguments], check=True, capture_output=True)  # noqa: S607 - wherever it is


def can_mount(folder: Path) -> bool:
    """Whether small disks are to be had here."""
    try:
        with small_disk(folder / "probe", 64):
            return True
    except (OSError, subprocess.CalledProcessError):
        return False


def main() -> None:
    """Every trial, one after the other."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--assets", type=int, default=8)
    parser.add_argument(
        "--kib", type=int, nargs="+", default=[64, 200, 400, 800, 1200], help="sizes of disks"
    )
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_meshes(folder / "meshes", given.assets)
        done(
            build_command(folder / "meshes", folder / "wanted", 2), folder / "tmp"
        ).check_returncode()
        place = Place(folder / "meshes", folder, content(folder / "wanted"), given.assets)
        trials = {
            "clocks": jumping_clocks,
            "unreadable": unreadable,
            "being_written": being_written,
        }
        results = {trial: run(place) for trial, run in trials.items()}
        skipped = (
            ""
            if can_mount(folder)
            else "no right to mount: full and read-only disks were not tried"
        )
        if not skipped:
            results |= {f"full_at_{kib}_kib": full_disk(place, kib) for kib in given.kib}
            results["read_only"] = read_only(place)
    broken = {trial: promises.broken for trial, promises in results.items()}
    said = {
        trial: [words.replace(name, "") for words in promises.said]
        for trial, promises in results.items()
    }
    print(json.dumps({"assets": given.assets, "broken": broken, "said": said, "skipped": skipped}))


if __name__ == "__main__":
    main()
