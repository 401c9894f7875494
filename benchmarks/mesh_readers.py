"""Our mesh readers beside libraries': what each makes of real files and of hostile ones.

python benchmarks/mesh_readers.py [--data DIR] [--most FILES] [--hostile CASES] [--format FORMAT]

meshio, plyfile and pygltflib are asked where they are installed. Without a folder of meshes only
the cube of the tests is read. There are few OFF and PLY files about: up to a hundred are made of
the STL files found. One JSON line for each format and library:

- real files: how many are read, and of how many faces, their order, texture coordinates,
  normals, colours (to 8 bits) and pixels of textures are the same as ours; seconds for all, and
  memory that the largest takes.
- hostile files: those of the tests, in a child with 4 GiB and a minute. A failure is a crash,
  20 s, 2 GiB, or a file opened elsewhere; ``taken`` are those that a library reads and we refuse.
- awkward files: a text STL of two solids and polygons of several sizes in OFF and PLY. Whether the
  faces are the same, and in how many of a hundred places the file can be cut off so that a smaller
  mesh is read without a word.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from importlib.util import find_spec
from itertools import islice
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / folder) for folder in ("tests/samples", "benchmarks/libraries")]
sys.path.append(str(ROOT / "benchmarks" / "soak"))

import fuzz_trial  # noqa: E402 - the attacks live with the tests
from fuzz_cases import Case, seeds  # noqa: E402
from fuzz_hostile import MESH_PAGES  # noqa: E402
from fuzz_mutations import mutated  # noqa: E402
from hostile_meshes import LONG_PAGES  # noqa: E402
from mesh_libraries import OURS, READERS, Seen, agreed, awkward_files, ours  # noqa: E402

from asset_factory.factory.errors import InputRejected  # noqa: E402
from asset_factory.sim_checks.processes.isolation import Limits, WarmChild  # noqa: E402

LIBRARIES = {
    "obj": ("trimesh", "meshio"),
    "stl": ("trimesh", "meshio"),
    "off": ("trimesh", "meshio"),
    "ply": ("trimesh", "plyfile", "meshio"),
    "glb": ("trimesh", "pygltflib"),
}
LIMITS = Limits(wall_s=3600.0, memory_bytes=8 * 2**30)
ALONE = Limits(wall_s=60.0, cpu_s=25.0, memory_bytes=4 * 2**30)
MADE = 100
CUTS = 100
BY_PATH = ("obj", "ply", "glb")


def compare(library: str, paths: list[Path], root: Path) -> dict[str, float]:
    """In the child: a library's readings of files beside ours."""
    count: dict[str, float] = defaultdict(int, files=len(paths))
    for path in paths:
        mine = _timed(OURS, path, root, count)
        other = _timed(library, path, root, count)
        if mine is None or other is None:
            continue
        for name in agreed(mine, other):
            count[name] += 1
    return dict(count)


def _timed(reader: str, path: Path, root: Path, count: dict[str, float]) -> Seen | None:
    started = time.process_time()
    try:
        seen = READERS[reader](path, root)
    except (Exception, SystemExit):  # noqa: BLE001 - libraries raise whatever they trip over
        seen = None
    count[f"seconds_{reader}"] += time.process_time() - started
    count[f"read_{reader}"] += seen is not None
    return seen


def peak(library: str, path: Path, root: Path) -> int:
    """In a fresh child: memory that one reading adds [bytes], once libraries are loaded."""
    _warm(library, path.suffix[1:])
    held = fuzz_trial._forget_peak()
    with suppress(Exception, SystemExit):
        READERS[library](path, root)
    return fuzz_trial._peak() - held


def _warm(library: str, form: str) -> None:
    with suppress(Exception, SystemExit), tempfile.TemporaryDirectory() as folder:
        READERS[library](_cube(form, Path(folder)), Path(folder))


def _cube(form: str, folder: Path) -> Path:
    for name, data in seeds()[form].files.items():
        (folder / name).write_bytes(data)
    return folder / seeds()[form].entry


def try_hostile(library: str, form: str, numbers: list[int], most: int) -> list[tuple[str, bool]]:
    """In the child, for each hostile file: what was broken, and whether only we refuse it."""
    exits: list[str] = []

    def read(path: Path, _folder: Path) -> tuple[str, str]:
        try:
            READERS[library](path, path.parent)
        except SystemExit:
            exits.append("exits the process")
            return "unreadable", "exit"
        except InputRejected as error:
            return error.code, ""
        except Exception as error:  # noqa: BLE001 - a refusal in its way
            return "unreadable", str(error)
        return "loaded", ""

    fuzz_trial._READERS[library] = read
    # Tracebacks and warnings quote sources.
    fuzz_trial._READABLE += tuple(f"{os.path.realpath(place)}{os.sep}" for place in sys.path)
    _warm(library, form)
    cases = list(_hostile(form, most))
    found = []
    for number in numbers:
        exits.clear()
        case = replace(cases[number], verb=library, least=None)
        trial = fuzz_trial.try_case(case)
        taken = trial.verdict == "loaded" and _refused(case)
        found.append(("; ".join((*trial.broke, *exits)), taken))
    return found


def _refused(case: Case) -> bool:
    with tempfile.TemporaryDirectory() as folder:
        try:
            for name, data in case.files.items():
                (Path(folder) / name).parent.mkdir(parents=True, exist_ok=True)
                (Path(folder) / name).write_bytes(data)
            ours(Path(folder) / case.entry, Path(folder))
        except Exception:  # noqa: BLE001 - what intake turns into a refusal
            return True
    return False


def _hostile(form: str, most: int) -> Iterator[Case]:
    forms = ("glb", "gltf") if form == "glb" else (form,)
    for page in (MESH_PAGES | LONG_PAGES).values():
        yield from (case for case in page() if case.entry.rpartition(".")[2] in forms)
    for kind, seed in seeds().items():
        if seed.verb == "load" and seed.entry.rpartition(".")[2] in forms:
            yield from (mutated(seeds()[kind], number) for number in range(1, most))


def hostile(library: str, form: str, most: int) -> dict[str, Any]:
    """Failures of a library on hostile files, by what was broken."""
    total = sum(1 for _ in _hostile(form, most))
    batch = 10
    broke: dict[str, int] = defaultdict(int)
    names = [case.name for case in _hostile(form, most)]
    failed: list[str] = []
    taken = 0
    with WarmChild() as child:
        for start in range(0, total, batch):
            numbers = list(range(start, min(total, start + batch)))
            found = _tried(child, library, form, numbers, most)
            for number, (broken, was_taken) in zip(numbers, found, strict=True):
                taken += was_taken
                if broken:
                    broke[_short(broken)] += 1
                    failed.append(names[number])
    return {
        "cases": total,
        "failed": len(failed),
        "taken": taken,
        "broke": dict(broke),
        "first": failed[:3],
    }


def _short(broken: str) -> str:
    words = broken.split()
    return " ".join(words[:2]) if words[0] != "took" else f"took {words[2]}"


def _tried(
    child: WarmChild, library: str, form: str, numbers: list[int], most: int
) -> list[tuple[str, bool]]:
    outcome = child.call(try_hostile, library, form, numbers, most, limits=ALONE)
    if outcome.value is not None:
        return outcome.value
    if len(numbers) > 1:
        return [t for n in numbers for t in _tried(child, library, form, [n], most)]
    return [(outcome.failure or "failed", False)]


def awkward(library: str, form: str) -> Iterator[dict[str, Any]]:
    """A library's readings of awkward files, whole and cut off."""
    for name, data in awkward_files():
        if name.endswith(form):
            with WarmChild() as child:
                outcome = child.call(read_awkward, library, name, data, limits=ALONE)
            yield {"file": name, **(outcome.value or {"failure": outcome.detail})}


def read_awkward(library: str, name: str, data: bytes) -> dict[str, Any]:
    """In the child: whether the faces are ours, and where the file can be cut off quietly."""
    count: dict[str, float] = defaultdict(int)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_bytes(data)
        mine = ours(path, path.parent)
        whole = _timed(library, path, path.parent, count)
        same = [] if whole is None else list(agreed(mine, whole))[:2]
        quiet = 0
        for place in range(1, CUTS + 1):
            path.write_bytes(data[: len(data) * place // (CUTS + 1)])
            part = _timed(library, path, path.parent, count)
            quiet += part is not None and 0 < len(part.corners) < len(mine.corners)
    return {"read": whole is not None, "same": same, "cuts": CUTS, "cut_quietly": quiet}


def _files(form: str, data: Path | None, most: int, folder: Path) -> tuple[list[Path], Path]:
    if data is None:
        return [_cube(form, folder)], folder
    if form in ("off", "ply"):
        return _made(form, data, folder), folder
    paths = sorted(path for path in data.rglob(f"*.{form}") if path.stat().st_size)
    step = max(1, len(paths) // most) if most else 1
    return paths[::step], data


def _made(form: str, data: Path, folder: Path) -> list[Path]:
    import trimesh

    made = []
    for number, path in enumerate(islice(sorted(data.rglob("*.stl")), MADE)):
        mesh = trimesh.load(path, process=False)
        options = {"encoding": ("binary", "ascii")[number % 2]} if form == "ply" else {}
        made.append(folder / f"{number}.{form}")
        mesh.export(made[-1], **options)
    return made


def main() -> None:
    """Print a line of JSON for each format, library and claim."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path)
    parser.add_argument("--most", type=int, default=0, help="files a format; 0: all")
    parser.add_argument("--hostile", type=int, default=20, help="damaged files a seed")
    parser.add_argument("--format", choices=sorted(LIBRARIES), action="append")
    asked = parser.parse_args()
    for form in asked.format or LIBRARIES:
        with tempfile.TemporaryDirectory() as folder:
            paths, root = _files(form, asked.data, asked.most, Path(folder))
            largest = max(paths, key=os.path.getsize)
            for library in LIBRARIES[form]:
                about = {"format": form, "library": library}
                if find_spec(library) is None:
                    continue
                with WarmChild() as child:
                    counts = child.call(compare, library, paths, root, limits=LIMITS).unwrap()
                for name in (OURS, library):
                    with WarmChild() as child:
                        grown = child.call(peak, name, largest, root, limits=LIMITS).unwrap()
                    counts[f"peak_MB_{name}"] = grown / 2**20
                rounded = {key: round(value, 2) for key, value in sorted(counts.items())}
                print(json.dumps({"claim": "real files", **about, **rounded}), flush=True)
        more = ("trimesh by path",) if form in BY_PATH else ()
        for library in (OURS, *LIBRARIES[form], *more):
            if library == OURS or find_spec(library.split()[0]) is not None:
                about = {"format": form, "library": library}
                for line in awkward(library, form) if library not in more else ():
                    print(json.dumps({"claim": "awkward files", **about, **line}), flush=True)
                found = hostile(library, form, asked.hostile)
                line = {"claim": "hostile files", "format": form, "library": library, **found}
                print(json.dumps(line), flush=True)


if __name__ == "__main__":
    main()
