"""Two methods are compared where both have something to compare."""

import pytest

from asset_factory.factory.config import ParticulateConfig
from asset_factory.learn.evaluate.cases import Request
from asset_factory.learn.evaluate.methods import Method
from asset_factory.learn.evaluate.score import Score
from asset_factory.learn.evaluate.summary import compared
from asset_factory.learn.evaluate.trial import Row, Trial


def row(method, case, *right, failed=False):
    request = Request(case, "made", "box", "closed", "front")
    score = None if failed else Score({}, {"type_accuracy": right, "axis_angle_deg": ()})
    return Row(Trial(request, Method(method, ParticulateConfig())), score)


def test_objects_count_alike_and_only_those_where_both_found_something():
    rows = [row("auto", "a", 1.0, 1.0, 0.0, 0.0), row("geometric", "a", 1.0)]
    rows += [row("auto", "b", 1.0), row("geometric", "b", 0.0)]
    rows += [row("geometric", "c", 1.0), row("auto", "c")]
    rows += [row("auto", "d", failed=True), row("geometric", "d", 1.0), row("auto", "e", 0.0)]
    (entry,) = compared(rows)
    assert entry["figure"] == "type_accuracy"
    assert (entry["one"], entry["other"], entry["objects"]) == ("auto", "geometric", 2)
    assert (entry["one_mean"], entry["other_mean"]) == pytest.approx((0.75, 0.5))


def test_nothing_to_compare():
    for rows in ([], [row("auto", "a", 1.0)], [row("auto", "a"), row("naive", "a")]):
        assert compared(rows) == []
