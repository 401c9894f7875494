"""What holds a part is told from movable neighbours; ranges come in the right unit."""

import numpy as np
import pytest
from evidence_worlds import WOOD, chest, cupboard, partition
from plain_solids import box

from asset_factory.factory.articulate.evidence import NOTHING, Partition
from asset_factory.factory.articulate.evidence.body import body_of
from asset_factory.factory.articulate.evidence.candidates import find_candidates
from asset_factory.factory.articulate.evidence.numbers import NAMES, measure
from asset_factory.factory.articulate.evidence.setting import (
    SLIDE_SETTING,
    TURN_SETTING,
    setting_of,
)
from asset_factory.factory.mesh import concatenate

OUT = np.array([0.0, -1.0, 0.0])


def _with_box(whole, x, y, z):
    """One more part, a box on the root."""
    extra = box(x, y, z, WOOD)
    labels = np.append(whole.face_part, np.full(len(extra.faces), len(whole.parents)))
    return Partition(concatenate([whole.mesh, extra]), labels, np.append(whole.parents, 0))


def _tried(whole, part, axis):
    """The slide of a part along an axis: its body, itself, and its evidence."""
    body = body_of(whole, part)
    found = find_candidates(body, NOTHING)
    best = int(np.argmax(found.slides * (found.axis @ axis)))
    return body, found.at([best]), measure(body, found, NOTHING)[best]


def test_a_closed_door_is_in_the_way_but_does_not_hold():
    whole = _with_box(partition(cupboard()), (-0.25, 0.25), (0.01, 0.45), (0.1, 0.3))
    body, _, evidence = _tried(whole, 2, OUT)
    named = dict(zip(NAMES, evidence, strict=True))
    assert body.crowded
    assert named["slide_hit_4"] > 0.2
    assert named["slide_held_4"] == 0.0
    assert named["slide_ways"] > 0.05


def test_what_is_alone_in_its_holder_is_not_crowded():
    body, _, evidence = _tried(partition(chest()), 1, OUT)
    assert not body.crowded
    assert body.holder is body.grid
    assert evidence[NAMES.index("slide_hit_4")] == evidence[NAMES.index("slide_held_4")]


def test_a_drawer_is_measured_by_its_length_and_a_front_by_the_object():
    whole = partition(chest())
    body, chosen, evidence = _tried(whole, 1, OUT)
    long = setting_of(body, chosen, evidence)
    assert long.slides
    assert long.unit == pytest.approx(0.47, abs=0.05)
    assert np.isinf(long.stop)
    bare = _with_box(partition(cupboard()), (-0.29, 0.29), (-0.06, -0.03), (0.05, 0.35))
    front = setting_of(*_tried(bare, 2, OUT))
    assert front.unit == pytest.approx(float(np.ptp(bare.mesh.vertices[:, 1])), rel=0.02)


def test_the_way_in_is_stopped_by_the_back():
    whole = partition(chest())
    setting = setting_of(*_tried(whole, 1, -OUT))
    assert setting.stop * setting.unit < 0.15


def test_settings_are_named_finite_numbers():
    body, chosen, evidence = _tried(partition(cupboard()), 1, OUT)
    assert setting_of(body, chosen, evidence).numbers.shape == (len(SLIDE_SETTING),)
    found = find_candidates(body, NOTHING)
    turn = int(np.flatnonzero(~found.slides)[0])
    setting = setting_of(body, found.at([turn]), measure(body, found, NOTHING)[turn])
    assert setting.numbers.shape == (len(TURN_SETTING),)
    assert np.isfinite(setting.numbers).all()
    with pytest.raises(ValueError, match="read-only"):
        setting.numbers[0] = 1.0
