"""Bring a dataset into the cache: ``python -m asset_factory.learn.datasets --help``."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from asset_factory.factory.cli.console import counted
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.runtime.terminal import complain, say

from .cache import find_all, prepare
from .catalog import SOURCES, source
from .fronts import front_advice
from .settings import FRONTS, SourceSettings
from .split import write_split


def main(arguments: list[str] | None = None) -> int:
    """Parse, prepare, print; 0, or 2 where the question makes no sense."""
    asked = _parser().parse_args(arguments)
    settings = SourceSettings(points=asked.points, front=asked.front, wall_s=asked.wall)
    try:
        if asked.write_split is not None:
            names = [item.name for item in find_all(asked.kind, asked.path)]
            say("\n".join(map(str, write_split(asked.write_split, names, asked.held_out))))
            return 0
        started = time.monotonic()
        with counted("objects") as on_progress:
            report = prepare(
                asked.kind,
                asked.path,
                asked.cache,
                split=asked.split,
                settings=settings,
                workers=asked.workers,
                on_progress=on_progress,
            )
    except ConfigError as error:
        complain(error)
        return 2
    say("\n".join(report.lines()))
    known = source(asked.kind).front if asked.front == "auto" else asked.front
    say(f"  {front_advice(report.read.values(), known)}")
    say(f"  {time.monotonic() - started:.1f} s; sampled objects in {asked.cache}")
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="sources", description="Bring a dataset into the cache of sampled objects."
    )
    kinds = "; ".join(f"{kind}: {known.wants}" for kind, known in SOURCES.items())
    add = parser.add_argument
    default = SourceSettings()
    add("--kind", required=True, choices=list(SOURCES), help=kinds)
    add("--path", required=True, type=Path, help="the dataset's folder")
    kept = Path("out/.cache/sampled")
    add("--cache", type=Path, default=kept, help="where sampled objects are kept")
    add("--split", type=Path, help="a file with the names of the objects wanted, one per line")
    add("--points", type=int, default=default.points, help="of the surface, per sampled object")
    fronts = ["auto", *FRONTS]
    add("--front", choices=fronts, default="auto", help="where the objects' fronts look")
    add("--wall", type=float, default=default.wall_s, help="longest for one object [s]")
    add("--workers", type=int, help="processes at once")
    names = "write STEM.train.txt, STEM.held_out.txt; no more"
    add("--write-split", type=Path, metavar="STEM", help=names)
    share = "share of the objects that --write-split holds out"
    add("--held-out", type=float, default=0.1, help=share)
    return parser


if __name__ == "__main__":
    sys.exit(main())
