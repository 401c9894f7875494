"""MJCF -> Intake, read back from MuJoCo's own compiler."""

import numpy as np
import pytest
from laid import laid
from refusing import refusal
from test_importing_urdf import articulated

from asset_factory.factory.articulation import JointKind
from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.intake.importers.mjcf import shown
from asset_factory.factory.intake.load import load_description
from asset_factory.factory.intake.reads import ABSENT, ReadLog
from asset_factory.sim_checks.read.mjcf_model import CompiledGeom

# Neither centred nor aligned with its principal axes: MuJoCo stores it moved and turned.
LOPSIDED = "v 5 0 0\nv 6 0.1 0\nv 5 2 0.2\nv 5.3 0 3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


def write(folder, text):
    return laid(folder / "thing.xml", f"<mujoco>{text}</mujoco>")


def load(folder, text):
    return load_description(write(folder, text), IntakeConfig())


def test_joints_of_every_kind_come_back_in_the_world_frame(tmp_path):
    intake = load(
        tmp_path,
        """
        <compiler angle="degree"/>
        <default><geom rgba="1 0 0 1"/>
          <default class="door"><joint damping="2" frictionloss="0.5"/></default></default>
        <worldbody><body name="base"><freejoint/><geom type="box" size=".5 .5 .5"/>
          <body name="door" pos="1 0 0" euler="0 0 90" childclass="door">
            <joint name="hinge" type="hinge" axis="1 0 0" pos="0 1 0" range="0 90"/>
            <geom type="box" size=".1 .2 .3" pos="0 0 1"/>
          </body></body></worldbody>""",
    )
    result = articulated(intake)
    joint = result.joint("hinge")
    assert [part.name for part in result.parts] == ["base", "door"]
    assert joint.kind is JointKind.REVOLUTE
    assert (joint.lower, joint.upper) == pytest.approx((0.0, np.pi / 2.0))
    assert (joint.damping, joint.friction) == (2.0, 0.5)
    np.testing.assert_allclose(joint.axis, [0.0, 1.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(np.cross(joint.origin, joint.axis), 0.0, atol=1e-9)
    bounds = [[0.8, -0.1, 0.7], [1.2, 0.1, 1.3]]
    np.testing.assert_allclose(result.part_mesh(1).bounds, bounds, atol=1e-9)
    assert intake.mesh.materials[0].color == (1.0, 0.0, 0.0, 1.0)
    assert any("floats freely" in note for note in intake.provenance.notes)


def test_a_recentred_mesh_lands_where_the_file_had_it(tmp_path):
    laid(tmp_path / "assets" / "lopsided.obj", LOPSIDED)
    intake = load(
        tmp_path,
        """<compiler meshdir="assets" angle="radian"/>
        <asset><mesh name="m" file="lopsided.obj" scale="2 1 1"/></asset>
        <worldbody><body pos="0 0 7">
          <geom type="mesh" mesh="m" euler="0 0 1.5707963267948966"/></body></worldbody>""",
    )
    original = np.array([[5, 0, 0], [6, 0.1, 0], [5, 2, 0.2], [5.3, 0, 3]]) * [2.0, 1.0, 1.0]
    expected = np.stack([-original[:, 1], original[:, 0], original[:, 2] + 7.0], axis=1)
    found = np.unique(intake.mesh.vertices.round(4), axis=0)
    np.testing.assert_allclose(found, np.unique(expected.round(4), axis=0), atol=2e-4)


def test_joints_of_one_body_become_a_chain_and_limits_count_from_the_reference_pose(tmp_path):
    intake = load(
        tmp_path,
        """<worldbody><geom type="box" size=".5 .5 .5"/>
        <body name="knob" pos="0 0 1">
          <joint name="turn" type="hinge" axis="0 0 1" limited="false"/>
          <joint name="slide" type="slide" axis="1 0 0" ref=".2" range=".2 .5"/>
          <geom type="sphere" size=".1"/></body></worldbody>""",
    )
    result = articulated(intake)
    assert [joint.name for joint in result.joints] == ["turn", "slide"]
    assert (result.joints[1].lower, result.joints[1].upper) == pytest.approx((0.0, 0.3))
    assert len(result.parts[1].faces) == 0
    pose = result.poses({"turn": np.pi / 2.0, "slide": 0.3})[2]
    np.testing.assert_allclose(pose[:3, 3], [0.0, 0.3, 0.0], atol=1e-12)


def geom(group, collides, alpha=1.0):
    place = {"size": np.ones(3), "pose": np.eye(4), "rgba": (1.0, 1.0, 1.0, alpha)}
    return CompiledGeom("", 1, shape="box", contact_type=int(collides), group=group, **place)


@pytest.mark.parametrize(
    ("geoms", "visible"),
    [
        ([geom(0, True), geom(0, True)], [0, 1]),
        ([geom(1, False), geom(0, True)], [0]),
        ([geom(2, False), geom(3, True)], [0]),
        ([geom(1, False), geom(3, False)], [0]),
        ([geom(0, False), geom(0, True)], [0, 1]),
        ([geom(1, False), geom(1, True), geom(0, True)], [0, 1]),
        ([geom(0, True), geom(4, True)], [0]),
        ([geom(4, True)], [0]),
        ([geom(1, True), geom(0, False, alpha=0.0)], [0]),
    ],
)
def test_what_a_viewer_would_show_is_visual(geoms, visible):
    assert [id(geom) for geom in shown(geoms)] == [id(geoms[i]) for i in visible]


def test_bodies_without_joints_are_judged_and_merged_with_what_holds_them(tmp_path):
    intake = load(
        tmp_path,
        """<worldbody><geom type="plane" size="1 1 .1"/>
        <body name="case"><geom type="box" size=".5 .5 .5" contype="0" conaffinity="0" group="1"/>
          <body name="bumper"><geom type="box" size=".6 .6 .6"/></body>
          <body name="lid" pos="0 0 .5"><joint type="hinge" axis="0 1 0" range="0 90"/>
            <geom type="box" size=".5 .5 .01"/></body></body></worldbody>""",
    )
    result = articulated(intake)
    assert [(part.name, len(part.faces)) for part in result.parts] == [("case", 12), ("lid", 12)]
    assert result.joints[0].name == "lid_joint"


SPHERE = '<geom type="sphere" size="1"/>'


@pytest.mark.parametrize(
    ("code", "text"),
    [
        ("unreadable", "<worldbody><nonsense/></worldbody>"),
        ("unreadable", '<worldbody><include file="thing.xml"/></worldbody>'),
        ("missing_file", '<asset><mesh name="m" file="no.stl"/></asset>'),
        ("missing_file", '<worldbody><include file="no.xml"/></worldbody>'),
        ("external_reference", '<asset><mesh name="m" file="../no.stl"/></asset>'),
        ("external_reference", '<worldbody><include file="../no.xml"/></worldbody>'),
        ("unsupported_joint", f'<worldbody><body><joint type="ball"/>{SPHERE}</body></worldbody>'),
        ("empty", "<worldbody><body name='b'/></worldbody>"),
    ],
)
def test_what_cannot_be_used_is_refused(tmp_path, code, text):
    error = refusal(load, tmp_path, text)
    assert error.code == code
    assert str(tmp_path) not in error.message


def test_a_body_too_light_for_mujoco_is_lifted_all_the_same(tmp_path):
    flat = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.000001\nf 1 2 3\nf 2 4 3\n"
    (tmp_path / "flat.obj").write_text(flat)
    intake = load(
        tmp_path,
        f"""<asset><mesh name="m" file="flat.obj"/></asset><worldbody>{SPHERE}
        <body pos="0 0 2"><joint type="slide" range="0 1"/>
        <geom type="mesh" mesh="m"/></body></worldbody>""",
    )
    assert len(articulated(intake).movable_joints) == 1


def test_where_a_missing_file_was_looked_for_is_noted(tmp_path):
    asset = '<asset><mesh name="m" file="no.stl"/></asset>'
    path = write(tmp_path, f'<compiler meshdir="meshes"/>{asset}')
    log = ReadLog()
    refusal(load_description, path, IntakeConfig(), log)
    reads = log.reads_of(path)
    assert reads["meshes/no.stl"] == ABSENT
    assert not any(name.startswith("..") for name in reads)


def test_a_range_that_is_switched_off_is_taken_as_meant_and_a_note_says_so(tmp_path):
    body = (
        f'<worldbody>{SPHERE}<body name="b" pos="0 0 2">'
        '<joint name="j" type="hinge" axis="1 0 0" limited="false" range="0 90"/>'
        '<geom type="sphere" size="0.5"/></body></worldbody>'
    )
    intake = load(tmp_path, body)
    assert articulated(intake).joint("j").upper == pytest.approx(np.pi / 2.0)
    assert any("'j' has a range that the file switches off" in n for n in intake.provenance.notes)
