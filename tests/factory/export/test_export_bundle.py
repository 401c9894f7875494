"""The bundle folder: complete, reproducible, and saying what it holds.

What is shown of an asset stays with it, and with what was rejected.
"""

import json
from dataclasses import replace
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest
from export_samples import PROVENANCE, box, boxes_asset, cabinet, image
from registry_samples import BAD_REPORT, REJECTED

from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part, Weights
from asset_factory.factory.asset import Asset
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.display.glb import scene_from
from asset_factory.factory.export import export_bundle
from asset_factory.factory.export.bundle import write_input, write_model
from asset_factory.factory.export.manifest import Manifest
from asset_factory.factory.intake.source import Source
from asset_factory.factory.manufacture.plan import Plan, as_planned
from asset_factory.factory.mesh import Material
from asset_factory.factory.part import PartKind, PartSource, Proposer
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.product import SHOWN, finished
from asset_factory.factory.registry.registration import register
from asset_factory.factory.registry.verify import verify
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.runtime.store import folder_digests
from asset_factory.factory.verify.validate import Verdict
from asset_factory.sim_checks import Finding, Report, Severity

#: A picture for each part, of one colour each.
PICTURES = [image(color) for color in ((255, 0, 0), (0, 255, 0), (0, 0, 255))]


def textured_cabinet():
    return cabinet([Material("wood", texture=picture) for picture in PICTURES])


def test_exporting_again_leaves_nothing_of_the_bundle_before(tmp_path):
    plain = boxes_asset([box([0, 0, 0], [1, 1, 1])], ())
    export_bundle(textured_cabinet(), PROVENANCE, tmp_path / "bundle")
    export_bundle(plain, PROVENANCE, tmp_path / "bundle")
    export_bundle(plain, PROVENANCE, tmp_path / "fresh")
    assert folder_digests(tmp_path / "bundle") == folder_digests(tmp_path / "fresh")


def test_the_urdf_names_what_is_in_the_folder_asks_for_no_renderer_and_each_part_has_its_texture(
    tmp_path,
):
    tree = ElementTree.parse(export_bundle(textured_cabinet(), PROVENANCE, tmp_path).urdf)
    named = {mesh.get("filename", "") for mesh in tree.iter("mesh")}
    assert named == {name for name in folder_digests(tmp_path) if name.endswith(".obj")}
    assert not list(tree.iter("material"))
    assert {child.tag for geometry in tree.iter("geometry") for child in geometry} == {"mesh"}
    # Also where textures share a name.
    pictures = []
    for part in range(3):
        library = (tmp_path / f"meshes/visual/part_{part}_0.mtl").read_text()
        name = next(line.split()[1] for line in library.splitlines() if line.startswith("map_Kd"))
        pictures.append((tmp_path / "meshes/visual" / name).read_bytes())
    assert pictures == [picture.data for picture in PICTURES]


def test_a_part_of_two_materials_is_written_as_two_visuals(tmp_path):
    two = cabinet([Material("a"), Material("b", (1.0, 0.0, 0.0, 1.0)), Material("c")])
    mesh = two.articulation.mesh
    whole = Articulation(mesh, (Part("all", np.arange(len(mesh.faces))),), (), "t")
    bundle = export_bundle(Asset("merged", whole, two.bodies[:1]), PROVENANCE, tmp_path)
    assert len(ElementTree.parse(bundle.urdf).findall("link/visual")) == 3
    assert bundle.manifest.links[0].visuals == 3


def test_only_handle_geometry_is_called_a_handle(tmp_path):
    bundle = export_bundle(cabinet(), PROVENANCE, tmp_path)
    names = [v.get("name", "") for v in ElementTree.parse(bundle.urdf).iter("visual")]
    assert [n for n in names if "handle" in n] == ["handle_part_1_1"]
    assert (tmp_path / "meshes/visual/part_1_1.obj").read_text().count("\nf ") == 12


def test_a_continuous_joint_has_no_limits_to_hit(tmp_path):
    wheel = Joint("spin", JointKind.CONTINUOUS, 0, 1, [0, 0, 1], [0, 0, 2], -np.pi, np.pi)
    asset = boxes_asset([box([0, 0, 0], [1, 1, 1]), box([0, 0, 2], [1, 1, 1])], (wheel,))
    bundle = export_bundle(asset, PROVENANCE, tmp_path)
    joint = ElementTree.parse(bundle.urdf).find("joint")
    assert joint.get("type") == "continuous"
    assert joint.find("limit").get("lower") is None
    assert ElementTree.parse(bundle.mjcf).find(".//joint").get("range") is None
    assert bundle.manifest.joints[0].upper == pytest.approx(np.pi)


def test_excluded_pairs_reach_mjcf_and_manifest_once_and_are_of_parts_there_are(tmp_path):
    pairs = (("part_1", "part_0"), ("part_0", "part_1"))
    bundle = export_bundle(cabinet(), PROVENANCE, tmp_path, pairs)
    (excluded,) = ElementTree.parse(bundle.mjcf).iter("exclude")
    assert excluded.attrib == {"body1": "part_0", "body2": "part_1"}
    assert bundle.manifest.excluded_pairs == (("part_0", "part_1"),)
    with pytest.raises(ValueError, match=r"no part .lid.; there are .*part_2"):
        export_bundle(cabinet(), PROVENANCE, tmp_path, (("part_0", "lid"),))


def test_the_manifest_is_what_was_written_and_measures_the_object(tmp_path):
    bundle = export_bundle(cabinet(), PROVENANCE, tmp_path)
    manifest = json.loads((tmp_path / "asset.json").read_text())
    assert Manifest.from_json(json.dumps(manifest)) == bundle.manifest
    assert manifest["bounds"] == [[-0.3, -0.252, 0.0], [0.3, 0.2, 0.8]]
    assert manifest["mass"] == pytest.approx(6.0)
    assert manifest["license"] == "CC0-1.0"
    assert manifest["provenance"].items() >= {"input": "cabinet.glb", "digest": "0" * 64}.items()
    assert manifest["links"][1]["hulls"] == 2
    hinge = manifest["joints"][0]
    assert (hinge["lower"], hinge["upper"], hinge["unit"]) == (0.0, 1.6, "rad")
    assert hinge["handle"]["point"] == [0.5, -0.04, 0.0]


def test_the_manifest_says_which_proposal_a_part_comes_from(tmp_path):
    asset = cabinet()
    body, door, drawer = asset.articulation.parts
    source = PartSource("sides-0123456789ab", Proposer.SIDES, 0.70004, {"shown": 1.5, "way": 0.25})
    parts = (body, replace(door, kind=PartKind.DOOR, source=source), drawer)
    made = replace(asset, articulation=replace(asset.articulation, parts=parts))
    bundle = export_bundle(made, PROVENANCE, tmp_path)
    links = json.loads((tmp_path / "asset.json").read_text())["links"]
    assert links[1]["proposal"] == {
        "id": "sides-0123456789ab",
        "proposer": "sides",
        "kind": "door",
        "probability": 0.7,
        "signs": {"shown": 1.5, "way": 0.25},
    }
    assert [link["proposal"] for link in links[::2]] == [None, None]
    assert Manifest.from_json(bundle.manifest.to_json()) == bundle.manifest
    for link in links:
        del link["proposal"]
    older = {**json.loads(bundle.manifest.to_json()), "links": links}
    assert Manifest.from_json(json.dumps(older)).links[1].proposal is None


def test_what_a_network_said_and_which_one_is_in_the_manifest_after_repairs_too(tmp_path):
    plain = cabinet()
    tree = plain.articulation
    joints = tuple(replace(joint, confidence=0.87654321) for joint in tree.joints)
    parts = tuple(replace(part, confidence=0.5) for part in tree.parts)
    weights = {"file": "model.pt", "digest": "cd" * 32, "license": "CC-BY-4.0"}
    learned = replace(tree, parts=parts, joints=joints, weights=(Weights(**weights),))
    repaired = as_planned(learned, Plan(upper={"hinge": 0.8}, frozen=frozenset({"slide"})))
    for each, said, sure, seen in ((tree, [], None, None), (repaired, [weights], 0.8765, 0.5)):
        export_bundle(replace(plain, articulation=each), PROVENANCE, tmp_path)
        manifest = json.loads((tmp_path / "asset.json").read_text())
        assert manifest["provenance"]["weights"] == said
        assert [joint["confidence"] for joint in manifest["joints"]] == [sure] * 2
        assert [link["confidence"] for link in manifest["links"]] == [seen] * 3


def test_the_ground_offset_lifts_an_object_that_closes_below_its_input_pose(tmp_path):
    drop = Joint("drop", JointKind.PRISMATIC, 0, 1, [0, 0, 1], [0, 0, 0], -0.5, 0.5)
    asset = boxes_asset([box([0, 0, 0], [1, 1, 1]), box([3, 0, 0], [1, 1, 1])], (drop,))
    assert export_bundle(asset, PROVENANCE, tmp_path).manifest.ground_offset == 1.0


def test_an_input_that_became_nothing_can_be_looked_at(tmp_path):
    folder = write_input(box([0, 0, 1], [1, 2, 3]), tmp_path / "input")
    scene = scene_from((folder / "view.glb").read_bytes())
    assert (scene.links, scene.movable, len(scene.visuals)) == (("object",), (), 1)
    with pytest.raises(FileExistsError):
        write_input(box([0, 0, 0], [1, 1, 1]), tmp_path)


def test_what_was_rejected_keeps_what_is_shown_and_no_asset(tmp_path):
    registry = Registry(tmp_path / "out", create=True)
    source = tmp_path / "cabinet.stl"
    source.write_bytes(b"solid\nendsolid\n")
    asset = cabinet()
    bad = Finding("rest_penetration", Severity.ERROR, "5 mm deep")
    with registry.staging_folder() as staging:
        bundle = export_bundle(asset, PROVENANCE, staging / "0")
        write_model(asset, bundle.folder)
        verdict = Verdict(Report("asset.urdf", findings=(bad,)))
        config = BuildConfig()
        origin = Source(source, config)
        intake = SimpleNamespace(name="cabinet", provenance=PROVENANCE)
        product = finished(origin, intake, bundle, verdict, (), Stages(config, None))
        result = register(registry, product)
    kept = {path.name for path in registry.folder(result.entry).iterdir()}
    assert kept == {*SHOWN, "report.json"}
    # Of what became nothing there is the report alone.
    folder = registry.add(replace(REJECTED, id="chest-1"), BAD_REPORT)
    assert [path.name for path in folder.iterdir()] == ["report.json"]
    assert verify(registry) == ()
