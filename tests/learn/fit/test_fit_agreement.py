"""How far the detector is believed is fitted to what is right and what is not."""

from dataclasses import replace

import numpy as np
import pytest
from tests.samples.says import Says

pytest.importorskip("torch")

from asset_factory.factory.articulate.detected.agreement import SIGNS, agreement_of
from asset_factory.factory.articulate.rigid import RigidArticulator
from asset_factory.factory.models.detector.canvas import CANVAS
from asset_factory.factory.part import PartKind
from asset_factory.learn.detector.sides import Instances, labelled_sides
from asset_factory.learn.fit.agreement import LabelledMesh, fit_agreement, rate_parts
from asset_factory.learn.objects import make_object


def labelled(made):
    return LabelledMesh(made.mesh, labelled_sides(made).instances)


def test_a_true_door_is_right_and_one_where_nothing_opens_is_not():
    made = make_object("fridge", 4)
    sure = tuple(replace(part, kind=PartKind.DOOR) for part in made.parts)
    proposed = replace(made, parts=sure)
    (rows,) = (rate_parts(Says(proposed), [labelled(made)])["proposed"],)
    assert rows
    assert {row[-1] for row in rows} == {1.0}
    shut = LabelledMesh(made.mesh, Instances.of(np.zeros((0, 10))))
    rated = rate_parts(Says(proposed), [shut])
    assert {row[-1] for row in (*rated["proposed"], *rated["panel"])} == {0.0}


def test_where_nobody_knows_what_opens_nothing_counts():
    made = make_object("fridge", 4)
    unknown = np.zeros((5, 10))
    unknown[:, 0] = range(5)
    # Boxes that the detector believes may reach beyond the picture.
    unknown[:, 1:3] = -CANVAS
    unknown[:, 3:5] = 2 * CANVAS
    unknown[:, 9] = 1.0
    rated = rate_parts(RigidArticulator(), [LabelledMesh(made.mesh, Instances.of(unknown))])
    assert rated == {name: [] for name in SIGNS}


def test_every_sign_is_rated_and_panels_that_are_seen_are_right():
    made = make_object("fridge", 4)
    rated = rate_parts(RigidArticulator(), [labelled(made)])
    assert all(len(row) == len(SIGNS[name]) + 1 for name, rows in rated.items() for row in rows)
    right = [row[0] for row in rated["panel"] if row[-1] == 1.0]
    assert max(right) > 0.5
    assert not rated["proposed"]


def test_what_is_fitted_believes_what_was_right():
    rng = np.random.default_rng(0)
    rated = {}
    for name, signs in SIGNS.items():
        rows = rng.random((200, len(signs)))
        right = (rows[:, 0] + 0.1 * rng.normal(size=200) > 0.5).astype(float)
        rated[name] = [tuple(row) for row in np.column_stack([rows, right]).tolist()]
    agreement = agreement_of(fit_agreement(rated))
    assert agreement.of_lid(0.9) > 0.9
    assert agreement.of_lid(0.1) < 0.1
    assert agreement.of_proposed(0.9) > 0.9
    assert agreement.of_proposed(0.1) < 0.1
    assert agreement.of_panel(np.array([0.9, 0.5, 0.5, 0.5])) > 0.9
