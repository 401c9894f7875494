"""Two methods on the same objects: joint figures are compared only where both found some."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations
from typing import Any

import numpy as np

from .summary import in_order, rounded
from .trial import Row

#: Figures of joints that were found; those of all joints can be compared as they are.
COMPARED = ("type_accuracy", "axis_angle_deg", "axis_offset", "opens_right_way")


def compared(rows: Iterable[Row]) -> list[dict[str, Any]]:
    """Return one entry per pair of methods, and figure that both have of some object.

    Dicts have ``figure``, ``one``, ``other`` (methods), ``objects``: cases in which both have it,
    ``one_mean`` and ``other_mean``: over those cases, of the means over parts and repetitions.
    """
    figures: dict[tuple[str, str], dict[str, list[float]]] = {}
    methods: list[str] = []
    for row in in_order(rows):
        method = row.trial.method.name
        methods += [method] if method not in methods else []
        for name in COMPARED:
            values = () if row.score is None else row.score.pooled.get(name, ())
            figures.setdefault((name, method), {}).setdefault(row.trial.request.name, []).extend(
                values
            )
    found: list[dict[str, Any]] = []
    for one, other in combinations(methods, 2):
        for name in COMPARED:
            ours = figures[name, one]
            theirs = figures[name, other]
            shared = [case for case in ours if ours[case] and theirs.get(case)]
            if shared:
                entry = {"figure": name, "one": one, "other": other, "objects": len(shared)}
                for who, each in (("one_mean", ours), ("other_mean", theirs)):
                    entry[who] = rounded(np.mean([np.mean(each[case]) for case in shared]))
                found.append(entry)
    return found
