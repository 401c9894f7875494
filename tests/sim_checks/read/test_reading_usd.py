"""A USD asset is judged as the URDF that says the same."""

import numpy as np
import pytest

pytest.importorskip("pxr")
import usda
from export_samples import PROVENANCE, box, boxes_asset, cabinet
from plain_solids import signed_volume
from refusing import judges_refusal

from asset_factory.factory.articulation import Joint
from asset_factory.factory.export import export_bundle
from asset_factory.sim_checks import Status
from asset_factory.sim_checks.description import DescriptionError
from asset_factory.sim_checks.geometry.kinematics import build_tree
from asset_factory.sim_checks.read.read import read_here
from asset_factory.sim_checks.read.usd.as_urdf import write_as_urdf


def read(path, folder):
    folder.mkdir()
    return read_here(write_as_urdf(path, folder))


def askew():
    """Three boxes behind joints along no principal direction, one fixed."""
    meshes = [box([0.3 * i, 0.1 * i, -0.2 * i], [0.1, 0.2, 0.3]) for i in range(4)]
    axis = np.array([0.6, 0.0, 0.8])
    joints = (
        Joint("turns", "revolute", 0, 1, axis, [0.1, 0.2, 0.3], -0.2, 1.3),
        Joint("slides", "prismatic", 1, 2, -axis[::-1], [0.4, -0.2, 0.3], 0.0, 0.2),
        Joint("stays", "fixed", 0, 3, [0, 0, 1.0], [0.4, 0.5, 0.3], 0.0, 0.0),
    )
    return boxes_asset(meshes, joints)


@pytest.mark.parametrize("make", [cabinet, askew])
def test_what_is_written_in_both_formats_reads_alike(make, tmp_path):
    export_bundle(make(), PROVENANCE, tmp_path, formats=("urdf", "usd"))
    urdf = read_here(tmp_path / "asset.urdf")
    usd = read(tmp_path / "asset.usd", tmp_path / "usd")
    assert [link.name for link in usd.links] == [link.name for link in urdf.links]
    for one, other in zip(urdf.links, usd.links, strict=True):
        assert other.inertia.mass == pytest.approx(one.inertia.mass, rel=1e-5)
        moments = np.linalg.eigvalsh(one.inertia.tensor)
        assert np.allclose(np.linalg.eigvalsh(other.inertia.tensor), moments, rtol=1e-4)
        assert len(other.collisions) == len(one.collisions)
        assert len(other.visuals) == len(one.visuals)
    for share in (0.0, 0.4, 1.0):
        for points, same in zip(posed(urdf, share), posed(usd, share), strict=True):
            assert np.allclose(points, same, atol=2e-5)


def posed(description, share):
    """Corners of every link's collision geometry, and its centre of mass, in the root's frame."""
    moving = [j for j in description.joints if j.lower is not None and j.kind != "fixed"]
    values = {joint.name: joint.lower + share * (joint.upper - joint.lower) for joint in moving}
    poses = build_tree(description).link_poses(values)
    for link in description.links:
        own = [shape.vertices for shape in link.collisions]
        points = np.vstack([*own, link.inertia.center[None]])
        yield np.sort(points @ poses[link.name][:3, :3].T + poses[link.name][:3, 3], axis=0)


def test_units_and_the_up_axis_of_a_stage_are_heeded(tmp_path):
    door = usda.HINGE + "point3f physics:localPos1 = (-0.5, 0, 0)\n"
    text = usda.BASE + usda.DOOR + usda.joint("hinge", "Revolute", "/obj/base", "/obj/door", door)
    path = usda.write(tmp_path, usda.stage(text, 'metersPerUnit = 0.01\nupAxis = "Y"'))
    description = read(path, tmp_path / "urdf")
    (hinge,) = description.joints
    assert (hinge.kind, hinge.upper) == ("revolute", 0.0)
    assert hinge.lower == pytest.approx(-np.pi / 2)
    base, door_link = description.links
    # What was 0.8 along z, in centimetres, lies along -y now.
    assert np.allclose(np.ptp(base.visuals[0].vertices, axis=0), [0.01, 0.008, 0.006])
    assert np.allclose(np.ptp(door_link.visuals[0].vertices, axis=0), [0.01, 0.0002, 0.008])
    assert not base.collisions


def test_mirrored_and_left_handed_meshes_face_as_the_file_means_and_holes_are_none(tmp_path):
    size = (1.0, 0.6, 0.8)
    left = usda.mesh("left", size, 'uniform token orientation = "leftHanded"')
    scale = 'float3 xformOp:scale = (-1, 1, 1)\nuniform token[] xformOpOrder = ["xformOp:scale"]'
    mirrored = usda.mesh("mirrored", size).replace(usda.CUBE, f"{scale}\n{usda.CUBE}")
    holed = usda.mesh("holed", size, "int[] holeIndices = [2, 4]")
    path = usda.write(tmp_path, usda.stage(usda.body("base", (0, 0, 0), left + mirrored + holed)))
    (base,) = read(path, tmp_path / "urdf").links
    shapes = {shape.name: shape for shape in base.visuals}
    assert signed_volume(shapes["mirrored"]) == pytest.approx(0.48, rel=1e-6)
    assert len(shapes["holed"].faces) == 8
    # The cube is written counter-clockwise, so a file that calls it left-handed has it inside out.
    assert signed_volume(shapes["left"]) == pytest.approx(-0.48, rel=1e-6)


def test_a_joint_may_hold_something_inside_a_body_or_the_world_of_a_stage_with_y_up(tmp_path):
    grip = (
        'def Xform "grip"\n{\ndouble3 xformOp:translate = (0.1, 0.2, 0)\n'
        'uniform token[] xformOpOrder = ["xformOp:translate"]\n}\n'
    )
    door = usda.body("door", (0, 0, 0), usda.mesh("panel", (1.0, 0.02, 0.8)) + grip)
    where = "point3f physics:localPos0 = (0, 3, 0)\npoint3f physics:localPos1 = (0, 0, 0)\n"
    hinge = usda.joint("hinge", "Revolute", "", "/obj/door/grip", where)
    path = usda.write(tmp_path, usda.stage(door + hinge, 'metersPerUnit = 1\nupAxis = "Y"'))
    description = read(path, tmp_path / "urdf")
    (line,) = description.joints
    # Three along y in the file is three up; the panel's middle is (-0.1, -0.2) from the grip.
    assert np.allclose(line.origin[:3, 3], [0.0, 0.0, 3.0])
    panel = description.links[-1].visuals[0].vertices
    assert np.allclose((panel.max(axis=0) + panel.min(axis=0)) / 2, [-0.1, -0.2, 0.0])


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("#usda 1.0\n(\nsubLayers = [@../outside.usda@]\n)\n", "outside_folder"),
        ("no usd", "unreadable"),
        (usda.stage(""), "no_links"),
    ],
)
def test_an_asset_that_leads_out_of_its_folder_or_is_none_is_refused(text, code, tmp_path):
    usda.write(tmp_path, usda.stage(usda.CABINET), "outside.usda")
    path = usda.write(tmp_path / "inside", text)
    assert judges_refusal(write_as_urdf, path, tmp_path).code == code


@pytest.mark.parametrize("end", ["body0", "body1"])
def test_a_joint_that_holds_what_is_not_there_is_named_with_it(end, tmp_path):
    ends = {"body0": "/obj/base", "body1": "/obj/door", end: "/obj/gone"}
    hinge = usda.joint("hinge", "Revolute", *ends.values(), usda.HINGE)
    path = usda.write(tmp_path, usda.stage(usda.BASE + usda.DOOR + hinge))
    with pytest.raises(DescriptionError, match=f"joint 'hinge': its {end} names /obj/gone"):
        read(path, tmp_path / "urdf")


def test_the_judge_says_of_usd_what_it_says_of_the_same_urdf(tmp_path, judge):
    export_bundle(cabinet(), PROVENANCE, tmp_path, formats=("urdf", "usd"))
    urdf = judge.check(tmp_path / "asset.urdf", ())
    usd = judge.check(tmp_path / "asset.usd", ())
    assert usd.description == "asset.usd"
    assert usd.findings[0].code == "read_as_urdf"
    assert usd.status is urdf.status is Status.PASSED
    told = [(finding.code, finding.parts) for finding in usd.findings[1:]]
    assert told == [(finding.code, finding.parts) for finding in urdf.findings]
