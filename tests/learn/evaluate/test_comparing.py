"""Many scores become means; two methods are compared where both have something to compare."""

import numpy as np
import pytest

from asset_factory.factory.config import ParticulateConfig
from asset_factory.learn.evaluate.cases import Request
from asset_factory.learn.evaluate.methods import Method
from asset_factory.learn.evaluate.score import Score
from asset_factory.learn.evaluate.summary import compared, summarised
from asset_factory.learn.evaluate.trial import Row, Trial


def scored(score, method="naive", case="a", repeat=0):
    trial = Trial(Request(case, "made", "box"), Method(method, ParticulateConfig()), repeat)
    return Row(trial, score)


def row(method, case, *right, failed=False):
    score = None if failed else Score({}, {"type_accuracy": right, "axis_angle_deg": ()})
    return scored(score, method, case)


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


def test_repetitions_are_told_apart_and_their_spread_is_told():
    scores = (Score({"a": value}, {"b": (value,)}) for value in (1.0, 3.0))
    overall = summarised(scored(score, repeat=number) for number, score in enumerate(scores))[0]
    assert overall["objects"] == 1
    assert overall["values"]["a"] == 2.0
    assert overall["spread"] == pytest.approx({"a": np.sqrt(2.0), "b": np.sqrt(2.0)}, abs=1e-6)


def test_one_object_of_many_parts_does_not_outvote_the_others():
    rows = [scored(Score({}, {"b": values})) for values in ((0.0,) * 9, (1.0,))]
    assert summarised(rows)[0]["parts"]["b"] == {"count": 10, "mean": 0.1, "of_objects": 0.5}
