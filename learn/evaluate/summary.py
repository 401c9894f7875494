"""Rows to tables: means over objects, pooled numbers over parts, by groups; methods in pairs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import combinations
from typing import Any

import numpy as np

from .trial import Row

#: Numbers of parts that have long tails: their median is told as well.
ERRORS = ("axis_angle_deg", "axis_offset", "range_error_rad", "range_error_size")
#: Figures of joints that were found; those of all joints can be compared as they are.
COMPARED = ("type_accuracy", "axis_angle_deg", "axis_offset", "opens_right_way")
DIGITS = 6

GROUPS: dict[str, Callable[[Row], str]] = {
    "overall": lambda row: "all",
    "setting": lambda row: f"{row.trial.request.pose}, {row.trial.request.yaw}",
    "source": lambda row: row.trial.request.source,
    "category": lambda row: row.trial.request.category,
}


def summarised(rows: Iterable[Row]) -> list[dict[str, Any]]:
    """Return one entry per grouping, group and method, in that order.

    Dicts have ``by``, ``group``, ``method``, ``objects`` (cases), ``failures``, ``unscored``,
    ``values``: means over cases and repetitions, ``parts``: ``{name: {count, mean, of_objects,
    median}}``, pooled over all parts but for ``of_objects``, the mean of the objects' means, in
    which a keyboard does not outvote all cabinets, and ``spread``: standard deviation over
    repetitions of ``values`` and ``of_objects``, where there are several.
    """
    ordered = in_order(rows)
    entries: list[dict[str, Any]] = []
    for by, key in GROUPS.items():
        groups: dict[tuple[str, str], list[Row]] = {}
        for row in ordered:
            groups.setdefault((key(row), row.trial.method.name), []).append(row)
        entries += [
            {"by": by, "group": group, "method": method, **_figures(groups[group, method])}
            for group, method in sorted(groups)
        ]
    return entries


def in_order(rows: Iterable[Row]) -> list[Row]:
    """Sort rows by method, case and repetition."""
    return sorted(rows, key=lambda r: (r.trial.method.name, r.trial.request.name, r.trial.repeat))


def _figures(rows: Sequence[Row]) -> dict[str, Any]:
    repeats = sorted({row.trial.repeat for row in rows})
    figures: dict[str, Any] = {
        "objects": len({row.trial.request.name for row in rows}),
        "failures": sum(bool(row.failure) for row in rows),
        "unscored": sum(row.score is None for row in rows),
        "values": _means(rows),
        "parts": _pooled(rows),
    }
    if len(repeats) > 1:
        single = []
        for repeat in repeats:
            own = [row for row in rows if row.trial.repeat == repeat]
            parts = {name: part["of_objects"] for name, part in _pooled(own).items()}
            single.append(_means(own) | parts)
        shared = sorted(set.intersection(*map(set, single)))
        spread = {name: np.std([each[name] for each in single], ddof=1) for name in shared}
        figures["spread"] = {name: rounded(value) for name, value in spread.items()}
    return figures


def _means(rows: Sequence[Row]) -> dict[str, float]:
    scores = [row.score for row in rows if row.score is not None]
    names = scores[0].values if scores else {}
    return {name: rounded(np.mean([score.values[name] for score in scores])) for name in names}


def _pooled(rows: Sequence[Row]) -> dict[str, dict[str, float]]:
    scores = [row.score for row in rows if row.score is not None]
    found: dict[str, dict[str, float]] = {}
    for name in scores[0].pooled if scores else ():
        of_objects = [score.pooled[name] for score in scores if score.pooled[name]]
        values = [value for numbers in of_objects for value in numbers]
        if values:
            mean = np.mean([np.mean(numbers) for numbers in of_objects])
            found[name] = {"count": len(values), "mean": rounded(np.mean(values))}
            found[name]["of_objects"] = rounded(mean)
            if name in ERRORS:
                found[name]["median"] = rounded(np.median(values))
    return found


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
            cases = figures.setdefault((name, method), {})
            cases.setdefault(row.trial.request.name, []).extend(values)
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


def rounded(value: float | np.floating[Any]) -> float:
    """Round to ``DIGITS``, without a negative zero."""
    return round(float(value), DIGITS) + 0.0
