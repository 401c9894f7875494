"""Every format says the same, to every reader that is installed."""

from dataclasses import replace

import mujoco  # noqa: TID253
import numpy as np
import pytest
from export_samples import PROVENANCE, cabinet, frames, tree_of_boxes
from format_readers import READERS, animated_glb, pxr_usd

from asset_factory.factory.articulate.annotated import annotated_articulator
from asset_factory.factory.articulation import JointKind
from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.export import export_bundle
from asset_factory.factory.export.formats import FORMATS
from asset_factory.factory.export.manifest import Manifest
from asset_factory.factory.geometry.coupling import with_common_ranges
from asset_factory.factory.intake.load import load
from asset_factory.sim_checks import run_checks
from asset_factory.sim_checks.description import Mimic

ALL = tuple(each.name for each in FORMATS)
SHARES = (0.0, 0.25, 0.5, 0.8, 1.0)


@pytest.fixture(scope="module")
def bundles(tmp_path_factory):
    made = [tree_of_boxes(seed) for seed in range(11)]
    made.append(cabinet())
    folder = tmp_path_factory.mktemp("bundles")
    for number, asset in enumerate(made):
        export_bundle(asset, PROVENANCE, folder / str(number), formats=ALL)
    return [(asset, folder / str(number)) for number, asset in enumerate(made)]


@pytest.mark.parametrize("reader", READERS, ids=lambda reader: reader.__name__)
@pytest.mark.filterwarnings("ignore")
def test_every_reader_drives_every_joint_alike(reader, bundles):
    for asset, folder in bundles:
        read = reader(folder)
        articulation = asset.articulation
        for share in SHARES:
            values = {j.name: j.lower + share * j.range for j in articulation.joints}
            seen = read.frames(values)
            for name, frame in frames(articulation, values).items():
                assert np.allclose(seen[name], frame, atol=2e-5), (folder, name, share)
        limited = [j for j in articulation.movable_joints if j.kind is not JointKind.CONTINUOUS]
        assert set(read.limits) == {joint.name for joint in limited}
        for joint in limited:
            assert np.allclose(read.limits[joint.name], (joint.lower, joint.upper), atol=1e-5)
        for part, body in zip(articulation.parts, asset.bodies, strict=True):
            if part.name in read.masses:
                assert read.masses[part.name] == pytest.approx(body.inertial.mass, rel=1e-5)


@pytest.mark.parametrize("reader", [pxr_usd, animated_glb], ids=lambda reader: reader.__name__)
def test_a_joint_that_turns_the_other_way_is_noticed(reader, tmp_path):
    asset = cabinet()
    articulation = asset.articulation
    joints = tuple(replace(joint, axis=-joint.axis) for joint in articulation.joints)
    turned = replace(asset, articulation=replace(articulation, joints=joints))
    export_bundle(turned, PROVENANCE, tmp_path, formats=ALL)
    values = {joint.name: joint.upper for joint in articulation.joints}
    seen = reader(tmp_path).frames(values)
    wanted = frames(articulation, values)
    moved = [articulation.parts[joint.child].name for joint in articulation.movable_joints]
    assert moved
    assert not any(np.allclose(seen[name], wanted[name], atol=1e-3) for name in moved)


def test_the_same_asset_has_the_same_bytes_and_only_what_is_asked_for_is_written(tmp_path):
    asset = cabinet()
    for name in ("one", "other"):
        export_bundle(asset, PROVENANCE, tmp_path / name, formats=ALL)
    for each in FORMATS:
        one = (tmp_path / "one" / each.file).read_bytes()
        assert one == (tmp_path / "other" / each.file).read_bytes(), each.name
    export_bundle(asset, PROVENANCE, tmp_path / "glb", formats=("glb",))
    written = {path.name for path in (tmp_path / "glb").iterdir() if path.is_file()}
    assert written == {"asset.urdf", "asset.xml", "asset.json", "asset.glb"}


def test_a_joint_that_follows_another_does_so_in_every_format_and_back(tmp_path):
    asset = cabinet()
    hinge, slide = asset.articulation.joints
    slide = replace(slide, upper=0.4, mimic=Mimic("hinge", 0.25))
    joints = with_common_ranges([hinge, slide])
    asset = replace(asset, articulation=replace(asset.articulation, joints=joints))
    export_bundle(asset, PROVENANCE, tmp_path / "out", formats=ALL)
    for name in ("asset.urdf", "asset.xml", "asset.usd"):
        intake = load(tmp_path / "out" / name, IntakeConfig())
        mimic = annotated_articulator(intake).articulate(intake.mesh).joint("slide").mimic
        assert mimic is not None, name
        assert mimic.leader == "hinge"
        assert mimic.multiplier == pytest.approx(0.25)
        report = run_checks(tmp_path / "out" / name, ())
        assert not [f for f in report.findings if f.code.startswith("mimic")]
        assert len(report.measurements["penetration"]["joints"]) == 1
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "out" / "asset.xml"))
    assert list(model.eq_data[0, :5]) == [0.0, 0.25, 0.0, 0.0, 0.0]
    sdf = (tmp_path / "out" / "asset.sdf").read_text()
    assert '<sdf version="1.11"' in sdf
    joined = "".join(sdf.split("\n")).replace("  ", "")
    assert '<mimic joint="hinge"><multiplier>0.25</multiplier>' in joined
    manifest = Manifest.from_json((tmp_path / "out" / "asset.json").read_text())
    assert manifest.movable["slide"].mimic == Mimic("hinge", 0.25)
    assert '"mimic"' in (tmp_path / "out" / "asset.json").read_text()
