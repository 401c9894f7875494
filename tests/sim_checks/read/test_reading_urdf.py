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
        <limit lower="-0.5" upper="1" effort="5" velocity="0"/>
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
    assert (hinge.effort, hinge.velocity) == (5.0, 0.0)
    assert hinge.origin[:3, 3] == pytest.approx([0, 1, 0])


@pytest.mark.parametrize("suffix", ["obj", "stl", "glb", "ply"])
def test_every_mesh_format_gives_the_same_triangles(tmp_path, suffix):
    trimesh.creation.box(extents=(1, 2, 3)).export(tmp_path / f"part.{suffix}")
    shape = read_description(urdf(tmp_path, MESH.format(f"part.{suffix}"))).links[0].collisions[0]
    assert len(shape.faces) == 12
    assert np.ptp(shape.vertices, axis=0) == pytest.approx([1, 2, 3])


HELD = (
    '<link name="a"/><link name="b"/>'
    '<joint name="j" type="fixed"><parent link="a"/><child link="b"/>{}</joint>'
)


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (LINK.format('<box size="1 nan 3"/>'), "not_finite"),
        (LINK.format('<box size="1 -1 3"/>'), "invalid_size"),
        (LINK.format('<box size="1 1e7 3"/>'), "not_finite"),
        (LINK.format('<box size="1 2"/>'), "invalid_number"),
        (LINK.format('<sphere radius="0"/>'), "invalid_size"),
        (LINK.format('<capsule radius="-1" length="1"/>'), "invalid_size"),
        (SCALED.format("nan 1 1"), "not_finite"),
        (SCALED.format("1e7 1 1"), "not_finite"),
        (LINK.format('<mesh filename="huge.obj" scale="100 1 1"/>'), "not_finite"),
        (HELD.format('<origin rpy="0 inf 0"/>'), "not_finite"),
        (HELD.format('<axis xyz="0 nan 1"/>'), "not_finite"),
    ],
)
def test_numbers_that_are_none_say_why(tmp_path, content, code):
    """The fault corpus has one file for every code; these are its neighbours."""
    mesh = trimesh.creation.box()
    mesh.export(tmp_path / "part.obj")
    mesh.apply_scale(1e5).export(tmp_path / "huge.obj")
    assert judges_refusal(read_description, urdf(tmp_path, content)).code == code
    fair = LINK.format('<mesh filename="huge.obj" scale="1e-5 1e-5 1e-5"/>')
    held = HELD.format('<origin xyz="1 2 3" rpy="1 2 3"/><axis xyz="0 1 0"/>')
    description = read_description(urdf(tmp_path, fair + held))
    assert (description.joints[0].effort, description.joints[0].velocity) == (None, None)
    assert np.ptp(description.links[0].collisions[0].vertices, axis=0) == pytest.approx([1, 1, 1])


@pytest.mark.parametrize(
    ("text", "size", "volume"),
    [
        ('<box size="1 2 3"/>', (1, 2, 3), 6.0),
        ('<sphere radius="0.5"/>', (1, 1, 1), np.pi / 6.0),
        ('<cylinder radius="0.5" length="2"/>', (1, 1, 2), np.pi / 2.0),
        ('<capsule radius="0.5" length="1"/>', (1, 1, 2), np.pi / 4.0 + np.pi / 6.0),
    ],
)
def test_primitives_have_their_sizes_and_sag_by_a_thousandth_of_their_radius_at_most(
    tmp_path, text, size, volume
):
    shape = read_description(urdf(tmp_path, LINK.format(text))).links[0].collisions[0]
    assert np.ptp(shape.vertices, axis=0) == pytest.approx(size)
    closed = trimesh.Trimesh(shape.vertices, shape.faces)
    assert closed.is_watertight
    assert volume * (1.0 - 3e-3) < closed.volume <= volume * (1.0 + 1e-12)
    # The nearest faces to the middle are on the round side, at the radius but for what they sag.
    assert 0.5 * (1.0 - 1e-3) <= convex_hull(shape.vertices).offsets.min() <= 0.5
    assert len(shape.vertices) < 3500
