"""What proved right is trusted: labels in closed form, weights that recover what decides."""

from dataclasses import replace

import numpy as np
import pytest

from asset_factory.factory.articulate.auto.trust import NAME, SIGNS, trust_of
from asset_factory.factory.articulate.proposal import Motion, Proposal
from asset_factory.factory.articulation import JointKind
from asset_factory.factory.geometry.triangles import face_areas
from asset_factory.factory.models.perceptron import linear
from asset_factory.factory.models.shipped import load_arrays
from asset_factory.learn.fit.trust import TrustTrial, fit_signs, is_right, turned_at_random
from asset_factory.learn.fit.writing import Fit, networks_stored, write_fit
from asset_factory.learn.objects import make_object

FRIDGE = make_object("fridge", 0)
AREAS = face_areas(FRIDGE.mesh)
DOOR = next(joint for joint in FRIDGE.joints if joint.turns)


def proposal(**changes):
    """The fridge's door as it is, but for what is changed of its motion."""
    faces = np.zeros(len(AREAS), dtype=bool)
    faces[FRIDGE.parts[DOOR.child].faces] = True
    motion = Motion(DOOR.kind, DOOR.axis, DOOR.origin, DOOR.lower, DOOR.upper)
    return Proposal("door", faces, replace(motion, **changes))


def test_the_door_itself_is_right_whichever_way_its_axis_points_and_however_far_it_goes():
    assert is_right(proposal(), FRIDGE, AREAS)
    assert is_right(proposal(axis=-DOOR.axis, upper=0.3), FRIDGE, AREAS)


WRONG = {
    "another kind": proposal(kind=JointKind.PRISMATIC),
    "another axis": proposal(axis=np.array([1.0, 0.0, 0.0])),
    "another place": proposal(origin=DOOR.origin + np.array([0.3, 0.0, 0.0])),
    "another part": replace(proposal(), faces=np.ones(len(AREAS), dtype=bool)),
}


@pytest.mark.parametrize("wrong", WRONG.values(), ids=WRONG)
def test_what_is_not_the_door_is_wrong(wrong):
    assert not is_right(wrong, FRIDGE, AREAS)


def test_weights_recover_the_sign_that_decides():
    rng = np.random.default_rng(0)
    trials = []
    for _ in range(60):
        signs = rng.normal(size=(5, len(SIGNS)))
        right = rng.random(5) < 1.0 / (1.0 + np.exp(-2.0 * signs[:, SIGNS.index("evidence")]))
        named = [dict(zip(SIGNS, row, strict=True)) for row in signs]
        given = tuple(replace(proposal(), signs=each) for each in named)
        trials.append(TrustTrial(FRIDGE, given, right.astype(float)))
    weights = dict(zip(SIGNS, fit_signs(trials).direct[:, 0], strict=True))
    assert weights.pop("evidence") == pytest.approx(2.0, abs=0.5)
    assert max(abs(weight) for weight in weights.values()) < 0.5


def test_objects_to_fit_on_are_the_same_every_time():
    first, again = (next(turned_at_random([("fridge", FRIDGE)])) for _ in range(2))
    assert np.array_equal(first.mesh.vertices, again.mesh.vertices)
    assert not np.array_equal(first.mesh.vertices, FRIDGE.mesh.vertices)


def test_what_was_fitted_comes_back(tmp_path):
    wanted = linear(np.arange(len(SIGNS), dtype=float))
    stored = networks_stored({NAME: wanted}, {NAME: SIGNS}, {"least": np.array([0.35])})
    fit = Fit(stored, "Trust.", "nothing", "none")
    write_fit(tmp_path / "trust.safetensors", fit, ["trust", "trust.safetensors"], 0)
    trust = trust_of(load_arrays(tmp_path / "trust.safetensors"))
    assert trust.least == 0.35
    assert np.array_equal(trust.network.direct, wanted.direct)
