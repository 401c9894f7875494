"""Exported files: targets in link frames, places to stand, and handle visuals on all that moves."""

import json
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from export_samples import PROVENANCE
from plain_solids import parted
from target_worlds import BAR, BODY, HINGE, PANEL, SLIDE, asset_of, world

from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.export import export_bundle
from asset_factory.factory.export.manifest import Manifest


def test_the_manifest_holds_targets_in_their_links_frame_and_places_to_stand(tmp_path):
    bundle = export_bundle(asset_of(world([PANEL, *BAR])), PROVENANCE, tmp_path)
    text = (tmp_path / "asset.json").read_text()
    assert Manifest.from_json(text) == bundle.manifest
    manifest = json.loads(text)
    first = manifest["targets"][0]
    directions = {"point", "normal", "pull", "fingers"}
    assert set(first) == {"joint", "part", "kind", "opening_m", "score", *directions}
    assert (first["joint"], first["part"], first["kind"]) == ("j", "front", "grasp")
    middle = np.array([0.356, -0.062, 0.3])
    np.testing.assert_allclose(first["point"], middle - HINGE.origin, atol=1e-6)
    assert first["opening_m"] == pytest.approx(0.012, abs=1e-6)
    placement = manifest["joints"][0]["placement"]
    assert placement["position"][1] < -0.3
    assert -np.pi <= placement["yaw"] <= np.pi


def test_an_asset_without_targets_has_an_empty_list_and_no_place_to_stand(tmp_path):
    asset = replace(asset_of(world([PANEL])), targets=())
    manifest = export_bundle(asset, PROVENANCE, tmp_path).manifest
    assert manifest.targets == ()
    assert manifest.joints[0].placement is None


@pytest.mark.parametrize("moving", [[PANEL, *BAR], [PANEL]], ids=["bar", "slab"])
@pytest.mark.parametrize("joint", [HINGE, SLIDE], ids=["hinge", "slide"])
def test_every_moving_link_shows_a_handle_and_no_face_is_lost(moving, joint, tmp_path):
    asset = asset_of(world(moving, joint))
    bundle = export_bundle(asset, PROVENANCE, tmp_path)
    links = {link.get("name"): link for link in ElementTree.parse(bundle.urdf).iter("link")}
    # The stock cabinet tasks look for "handle" in the names of the visuals of the links that move.
    assert any("handle" in visual.get("name", "") for visual in links["front"].iter("visual"))
    assert not any("handle" in visual.get("name", "") for visual in links["body"].iter("visual"))
    meshes = links["front"].findall("visual/geometry/mesh")
    texts = ((tmp_path / mesh.get("filename", "")).read_text() for mesh in meshes)
    assert sum(text.count("\nf ") for text in texts) == len(asset.articulation.parts[1].faces)


def test_a_handle_that_is_a_part_of_its_own_is_called_one_too(tmp_path):
    fixed = Joint("f", JointKind.FIXED, 1, 2, np.array([0.0, 0.0, 1.0]), np.zeros(3))
    gripped = parted({"body": [BODY], "front": [PANEL], "grip": BAR}, HINGE, fixed)
    bundle = export_bundle(asset_of(gripped), PROVENANCE, tmp_path)
    links = {link.get("name"): link for link in ElementTree.parse(bundle.urdf).iter("link")}
    names = {name: [each.get("name", "") for each in links[name].iter("visual")] for name in links}
    assert all(name.startswith("handle") for name in names["grip"])
    assert any(name.startswith("handle") for name in names["front"])


def test_a_flat_handle_is_a_mesh_that_mujoco_loads(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    bundle = export_bundle(asset_of(world([PANEL])), PROVENANCE, tmp_path)
    for path in (bundle.mjcf, bundle.urdf):
        assert mujoco.MjModel.from_xml_path(str(path)).njnt == 1
