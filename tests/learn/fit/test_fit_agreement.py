"""How far the detector is believed is fitted to what is right and what is not."""

from dataclasses import replace

import numpy as np
import pytest
from says import Says

pytest.importorskip("torch")

from asset_factory.factory.articulate.detected.agreement import SIGNS, agreement_of
from asset_factory.factory.articulate.rigid import RigidArticulator
from asset_factory.factory.models.detector.canvas import CANVAS
from asset_factory.factory.part import PartKind
from asset_factory.learn.detector.sides import BOX, COLUMNS, IGNORED, VIEW, labelled_sides
from asset_factory.learn.fit import agreement
from asset_factory.learn.fit.agreement import LabelledMesh, fit_agreement, rate_parts
from asset_factory.learn.objects import make_object

FRIDGE = make_object("fridge", 4)


@pytest.fixture(scope="module", autouse=True)
def detected():
    """The detector looks at the one fridge of these tests once."""
    detection = agreement.detect(FRIDGE.mesh)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(agreement, "detect", lambda mesh: detection)
        yield


def rated_as(table, guess):
    return rate_parts(guess, [LabelledMesh(FRIDGE.mesh, table)])


def test_what_is_a_true_door_or_panel_is_right_and_where_nothing_opens_nothing_is():
    sure = tuple(replace(part, kind=PartKind.DOOR) for part in FRIDGE.parts)
    proposed = Says(replace(FRIDGE, parts=sure))
    rated = rated_as(labelled_sides(FRIDGE).table, proposed)
    assert all(len(row) == len(SIGNS[name]) + 1 for name, rows in rated.items() for row in rows)
    assert {row[-1] for row in rated["proposed"]} == {1.0}
    assert max(row[0] for row in rated["panel"] if row[-1] == 1.0) > 0.5
    shut = rated_as(np.zeros((0, COLUMNS)), proposed)
    assert {row[-1] for row in (*shut["proposed"], *shut["panel"])} == {0.0}


def test_where_nobody_knows_what_opens_nothing_counts():
    unknown = np.zeros((5, COLUMNS))
    unknown[:, VIEW] = range(5)
    # Boxes that the detector believes may reach beyond the picture.
    unknown[:, BOX] = (-CANVAS, -CANVAS, 2 * CANVAS, 2 * CANVAS)
    unknown[:, IGNORED] = 1.0
    assert rated_as(unknown, RigidArticulator()) == {name: [] for name in SIGNS}


def test_what_is_fitted_believes_what_was_right():
    rng = np.random.default_rng(0)
    rated = {}
    for name, signs in SIGNS.items():
        rows = rng.random((200, len(signs)))
        right = (rows[:, 0] + 0.1 * rng.normal(size=200) > 0.5).astype(float)
        rated[name] = [tuple(row) for row in np.column_stack([rows, right]).tolist()]
    fitted = agreement_of(fit_agreement(rated))
    assert fitted.lid.chance(np.array([0.9])) > 0.9
    assert fitted.lid.chance(np.array([0.1])) < 0.1
    for believed in (fitted.panel.chance, fitted.proposed.chance):
        assert believed(np.array([0.9, 0.5, 0.5, 0.5])) > 0.9
