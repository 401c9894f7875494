"""Bring a dataset into the cache: ``python -m asset_factory.learn.datasets --help``."""

import argparse
import sys
import time
from pathlib import Path

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
    settings = SourceSettings(
        points=asked.points, max_parts=asked.max_parts, front=asked.front, wall_s=asked.wall
    )
    try:
        if asked.write_split is not None:
            names = [item.name for item in find_all(asked.kind, asked.path)]
            say("\n".join(map(str, write_split(asked.write_split, names, asked.held_out))))
            return 0
        started = time.monotonic()
        prepared = prepare(
            asked.kind,
            asked.path,
            asked.cache,
            split=asked.split,
            settings=settings,
            workers=asked.workers,
            on_progress=_progress if sys.stderr.isatty() else None,
        )
    except ConfigError as error:
        complain(error)
        return 2
    say("\n".join(prepared.report.lines()))
    known = source(asked.kind).front if asked.front == "auto" else asked.front
    say(f"  {front_advice(prepared.sampled_objects, known)}")
    say(f"  {time.monotonic() - started:.1f} s; sampled objects in {asked.cache}")
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="sources", description="Bring a dataset into the cache of sampled objects."
    )
    kinds = "; ".join(f"{kind}: {known.wants}" for kind, known in SOURCES.items())
    parser.add_argument("--kind", required=True, choices=list(SOURCES), help=kinds)
    parser.add_argument("--path", required=True, type=Path, help="the dataset's folder")
    parser.add_argument(
        "--cache",
        type=Path,
        default=Path("out/.cache/sampled objects"),
        help="where sampled objects are kept",
    )
    parser.add_argument(
        "--split", type=Path, help="a file with the names of the objects wanted, one per line"
    )
    parser.add_argument(
        "--points",
        type=int,
        default=SourceSettings.points,
        help="of the surface, per sampled object",
    )
    parser.add_argument(
        "--max-parts",
        type=int,
        default=SourceSettings.max_parts,
        help="pass over objects with more",
    )
    parser.add_argument(
        "--front", choices=["auto", *FRONTS], default="auto", help="where the objects' fronts look"
    )
    parser.add_argument(
        "--wall", type=float, default=SourceSettings.wall_s, help="longest for one object [s]"
    )
    parser.add_argument("--workers", type=int, help="processes at once")
    parser.add_argument(
        "--write-split",
        type=Path,
        metavar="STEM",
        help="write STEM.train.txt, STEM.held_out.txt; no more",
    )
    parser.add_argument(
        "--held-out",
        type=float,
        default=0.1,
        help="share of the objects that --write-split holds out",
    )
    return parser


def _progress(done: int, count: int) -> None:
    complain(f"{done} of {count}", end="\r" if done < count else "\n")


if __name__ == "__main__":
    sys.exit(main())
