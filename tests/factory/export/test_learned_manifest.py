"""What a trained network said, and which one, stays with the asset."""

import json
from dataclasses import replace

from export_samples import PROVENANCE, cabinet

from asset_factory.factory.articulation import Weights
from asset_factory.factory.asset import Asset
from asset_factory.factory.export import export_bundle
from asset_factory.factory.manufacture.plan import Plan, as_planned

WEIGHTS = Weights("model.pt", "cd" * 32, "CC-BY-4.0")


def learned(articulation):
    joints = tuple(replace(joint, confidence=0.87654321) for joint in articulation.joints)
    parts = tuple(replace(part, confidence=0.5) for part in articulation.parts)
    return replace(articulation, parts=parts, joints=joints, weights=(WEIGHTS,))


def manifest(articulation, folder):
    plain = cabinet()
    export_bundle(Asset(plain.name, articulation, plain.bodies), PROVENANCE, folder)
    return json.loads((folder / "asset.json").read_text())


def test_weights_and_their_terms_are_in_the_manifest(tmp_path):
    written = manifest(learned(cabinet().articulation), tmp_path / "learned")
    (weights,) = written["provenance"]["weights"]
    assert weights == {"file": "model.pt", "digest": "cd" * 32, "license": "CC-BY-4.0"}
    assert [joint["confidence"] for joint in written["joints"]] == [0.8765, 0.8765]
    assert [link["confidence"] for link in written["links"]] == [0.5, 0.5, 0.5]


def test_without_a_network_nothing_is_claimed(tmp_path):
    written = manifest(cabinet().articulation, tmp_path / "plain")
    assert written["provenance"]["weights"] == []
    assert [joint["confidence"] for joint in written["joints"]] == [None, None]


def test_repairs_keep_who_said_so():
    plan = Plan(upper={"hinge": 0.8}, frozen=frozenset({"slide"}))
    repaired = as_planned(learned(cabinet().articulation), plan)
    assert repaired.weights == (WEIGHTS,)
    assert [joint.confidence for joint in repaired.joints] == [0.87654321, 0.87654321]
