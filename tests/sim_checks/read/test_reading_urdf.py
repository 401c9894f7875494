"""URDF is read as written, and nothing outside its folder is opened."""

import numpy as np
import pytest
import trimesh
from refusing import judges_refusal

from asset_factory.sim_checks.geometry.hull import convex_hull
from asset_factory.sim_checks.read.read import read_description

LINK = '<link name="base"><collision><geometry>{}</geometry></collision></link>'
MESH = LINK.format('<mesh filename="{}"/>')
SCALED = LINK.format('<mesh filename="part.obj" scale="{}"/>')


def urdf(folder, content):
    path = folder / "asset.urdf"
    path.write_text(f'<?xml version="1.0"?><robot name="r">{content}</robot>')
    return path


def code_of(path):
    return judges_refusal(read_description, path).code


def test_everything_written_is_read(tmp_path):
    (tmp_path / "meshes").mkdir()
    trimesh.creation.box(extents=(1, 2, 3)).export(tmp_path / "meshes" / "part.obj")
    content = """
      <link name="base"><inertial>
        <origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/><mass value="2"/>
        <inertia ixx="1" iyy="2" izz="2.5" ixy="0.1" ixz="0.2" iyz="0.3"/></inertial>
        <visual name="handle_0"><geometry><sphere radius="0.5"/></geometry></visual></link>
      <link name="door"><collision><origin xyz="0 0 1"/><geometry>
        <mesh filename="package://robot/meshes/part.obj" scale="0.1 0.1 0.1"/></geometry>
        </collision></link>
      <joint name="hinge" type="revolute"><parent link="base"/><child link="door"/>
        <origin xyz="0 1 0"/><axis xyz="0 0 1"/>
        <limit lower="-0.5" upper="1" effort="1" velocity="1"/>
        <dynamics damping="0.1" friction="0.2"/></joint>"""
    description = read_description(urdf(tmp_path, content))
    base, door = description.links
    assert base.inertia.center == pytest.approx([1, 0, 0])
    # A quarter turn about z: x is y, and y is minus x.
    turned = np.array([[2.0, -0.1, -0.3], [-0.1, 1.0, 0.2], [-0.3, 0.2, 2.5]])
    assert base.inertia.tensor == pytest.approx(turned)
    assert (base.visuals[0].name, base.visuals[0].kind) == ("handle_0", "sphere")
    shape = door.collisions[0]
    assert (shape.kind, shape.file) == ("mesh", "meshes/part.obj")
    assert shape.vertices.max(axis=0) == pytest.approx([0.05, 0.1, 1.15])
    (hinge,) = description.joints
    assert (hinge.kind, hinge.lower, hinge.upper) == ("revolute", -0.5, 1.0)
    assert (hinge.damping, hinge.friction) == (0.1, 0.2)
    assert hinge.origin[:3, 3] == pytest.approx([0, 1, 0])


@pytest.mark.parametrize("suffix", ["obj", "stl", "glb", "ply"])
def test_every_mesh_format_gives_the_same_triangles(tmp_path, suffix):
    trimesh.creation.box(extents=(1, 2, 3)).export(tmp_path / f"part.{suffix}")
    description = read_description(urdf(tmp_path, MESH.format(f"part.{suffix}")))
    shape = description.links[0].collisions[0]
    assert len(shape.faces) == 12
    assert np.ptp(shape.vertices, axis=0) == pytest.approx([1, 2, 3])


@pytest.mark.parametrize("scale", ["1e200 1 1", "nan 1 1", "1e7 1 1"])
def test_a_mesh_scaled_beyond_all_measure_is_refused(tmp_path, scale):
    trimesh.creation.box().export(tmp_path / "part.obj")
    assert code_of(urdf(tmp_path, SCALED.format(scale))) == "not_finite"


def test_a_mesh_far_beyond_all_measure_is_refused(tmp_path):
    mesh = trimesh.creation.box()
    mesh.apply_scale(1e5).export(tmp_path / "part.obj")
    assert code_of(urdf(tmp_path, SCALED.format("100 1 1"))) == "not_finite"
    fair = read_description(urdf(tmp_path, SCALED.format("1e-5 1e-5 1e-5")))
    assert np.ptp(fair.links[0].collisions[0].vertices, axis=0) == pytest.approx([1, 1, 1])


@pytest.mark.parametrize(
    "where", ['<origin xyz="1e300 0 0"/>', '<origin rpy="0 inf 0"/>', '<axis xyz="0 nan 1"/>']
)
def test_a_joint_that_is_nowhere_is_refused(tmp_path, where):
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/>{}</joint>'
    links = '<link name="a"/><link name="b"/>'
    assert code_of(urdf(tmp_path, links + joint.format(where))) == "not_finite"
    somewhere = joint.format('<origin xyz="1 2 3" rpy="1 2 3"/>')
    assert read_description(urdf(tmp_path, links + somewhere)).joints


def test_what_may_drive_a_joint_is_kept(tmp_path):
    content = '<link name="a"/><link name="b"/>' + "".join(
        f'<joint name="{name}" type="prismatic"><parent link="a"/><child link="b"/>'
        f'<limit upper="1"{more}/></joint>'
        for name, more in (("driven", ' effort="5" velocity="0"'), ("free", ""))
    )
    driven, free = read_description(urdf(tmp_path, content)).joints
    assert (driven.effort, driven.velocity, free.effort, free.velocity) == (5.0, 0.0, None, None)


def test_primitives_have_their_sizes(tmp_path):
    shapes = {
        '<box size="1 2 3"/>': (1, 2, 3),
        '<cylinder radius="0.5" length="2"/>': (1, 1, 2),
        '<sphere radius="0.25"/>': (0.5, 0.5, 0.5),
        '<capsule radius="0.5" length="1"/>': (1, 1, 2),
    }
    for text, size in shapes.items():
        shape = read_description(urdf(tmp_path, LINK.format(text))).links[0].collisions[0]
        assert np.ptp(shape.vertices, axis=0) == pytest.approx(size)
        closed = trimesh.Trimesh(shape.vertices, shape.faces)
        assert closed.is_watertight
        assert closed.volume > 0


def test_entities_are_refused(tmp_path):
    """In any encoding; the fault corpus has them in the usual one."""
    path = tmp_path / "bomb.urdf"
    robot = '<robot name="&a;"><link name="base"/></robot>'
    path.write_bytes(f'<!DOCTYPE r [<!ENTITY a "aaaa">]>{robot}'.encode("utf-16"))
    assert code_of(path) == "forbidden_doctype"


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (LINK.format('<box size="1 nan 3"/>'), "not_finite"),
        (LINK.format('<box size="1 -1 3"/>'), "invalid_size"),
        (LINK.format('<box size="1 1e7 3"/>'), "not_finite"),
        (LINK.format('<box size="1 2"/>'), "invalid_number"),
        (LINK.format('<sphere radius="0"/>'), "invalid_size"),
        (LINK.format('<capsule radius="-1" length="1"/>'), "invalid_size"),
    ],
)
def test_sizes_that_are_none_say_why(tmp_path, content, code):
    """The fault corpus has one file for every code; these are its neighbours."""
    assert code_of(urdf(tmp_path, content)) == code


@pytest.mark.parametrize(
    ("text", "volume"),
    [
        ('<sphere radius="0.5"/>', np.pi / 6.0),
        ('<cylinder radius="0.5" length="2"/>', np.pi / 2.0),
        ('<capsule radius="0.5" length="1"/>', np.pi / 4.0 + np.pi / 6.0),
    ],
)
def test_round_primitives_sag_by_a_thousandth_of_their_radius_at_most(tmp_path, text, volume):
    shape = read_description(urdf(tmp_path, LINK.format(text))).links[0].collisions[0]
    hull = convex_hull(shape.vertices)
    # The nearest faces to the middle are on the round side, at the radius but for what they sag.
    assert 0.5 * (1.0 - 1e-3) <= hull.offsets.min() <= 0.5
    assert volume * (1.0 - 3e-3) < hull.volume <= volume
    assert len(hull.vertices) < 3500
