"""Published descriptions with joints, each with its source and license."""

from __future__ import annotations

import csv
import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

import numpy as np


@dataclass(frozen=True)
class Published:
    """One file as its authors publish it; ``license`` is empty where it is not known."""

    path: Path
    source: str
    license: str = ""


def inventory(data: Path) -> Iterator[Published]:
    """Yield files of ``INVENTORY.csv``, one of each source in turn, always in the same order."""
    by_source = defaultdict(list)
    with (data / "INVENTORY.csv").open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            folder, source, *_ = row["path"].split("/")
            if folder == "articulated":
                path = data / row["path"] / row["main_file"]
                by_source[source].append(Published(path, source, in_short(row["license"])))
    chooser = np.random.default_rng(0)
    drawn = [
        [files[index] for index in chooser.permutation(len(files))]
        for _, files in sorted(by_source.items())
    ]
    yield from (each for turn in zip_longest(*drawn) for each in turn if each is not None)


def in_short(license_: str) -> str:
    """Return what binds whoever uses the object: its own terms, not its repository's."""
    bound = "NON-COMMERCIAL" in license_
    return "non-commercial research only" if bound else re.split(r" \(|;", license_)[0]


def listed(file: Path) -> Iterator[Published]:
    """Yield the files of a list: a line each, the path, source and license apart by tabs.

    A path alone counts for the folder above its own.
    """
    for line in file.read_text(encoding="utf-8").splitlines():
        path, *others = line.split("\t")
        if path.strip():
            source = others[0] if others else Path(path).absolute().parent.parent.name
            yield Published(Path(path), source, *others[1:2])
