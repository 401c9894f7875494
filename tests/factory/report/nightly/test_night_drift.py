"""The yield by source against the last nights."""

import json
from dataclasses import replace
from pathlib import PurePath

import pytest
from nights_made import attempt

from asset_factory.factory.report.nightly.figures import SourceRules, source_yields
from asset_factory.factory.report.nightly.files import SUMMARY, read_sources

ROOTS = (PurePath("meshes"), PurePath("meshes/inner"), PurePath("/single.glb"))


def attempts(passed, rejected, folder=""):
    names = [f"{folder}{number}" for number in range(passed + rejected)]
    return [attempt(n, "passed" if i < passed else "rejected") for i, n in enumerate(names)]


def yields(now, earlier, rules=None):
    return source_yields(now, ROOTS, [{"meshes": each} for each in earlier], rules or SourceRules())


def test_an_input_belongs_to_the_innermost_root_above_it():
    given = [attempt("a"), attempt("inner/b"), attempt("inner/c", "rejected")]
    given += [replace(attempt("d"), input="/single.glb")]
    found = source_yields(given, ROOTS, (), SourceRules())
    counted = [(each.source, each.passed, each.tried) for each in found]
    assert counted == [("/", 1, 1), ("meshes", 1, 1), ("meshes/inner", 1, 2)]


@pytest.mark.parametrize(
    ("now", "earlier", "fell"),
    [
        ((80, 20), [(90, 100)] * 3, False),
        ((79, 21), [(90, 100)] * 3, True),
        ((79, 21), [(90, 100)] * 2, False),
        ((79, 21), [(90, 100), (5, 10), (90, 100)], False),
        ((3, 16), [(90, 100)] * 3, False),
        # One bad night is not what is usual, fourteen are.
        ((79, 21), [(90, 100)] * 10 + [(10, 100)], True),
        ((79, 21), [(90, 100)] * 10 + [(80, 100)] * 14, False),
        # A point a night, of which none is a fall against the night before.
        ((70, 30), [(100 - number, 100) for number in range(30)], False),
        ((64, 36), [(100 - 2 * number, 100) for number in range(18)], True),
    ],
)
def test_a_fall_below_the_median_of_the_last_nights_counts(now, earlier, fell):
    (source,) = yields(attempts(*now), earlier)
    assert source.fell is fell


def test_nothing_is_compared_where_that_is_not_wanted():
    (source,) = yields(attempts(10, 90), [(90, 100)] * 9, SourceRules(nights=0))
    assert (source.usual, source.fell) == (None, False)


@pytest.mark.parametrize("data", [{}, {"sources": 3}, {"sources": [{"source": "a"}]}])
def test_summaries_of_other_versions_tell_nothing(tmp_path, data):
    (tmp_path / SUMMARY).write_text(json.dumps(data))
    assert read_sources(tmp_path) == {}
