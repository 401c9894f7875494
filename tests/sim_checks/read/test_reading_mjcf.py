"""MJCF is read as MuJoCo compiles it, and gives the same kinematics."""

import pytest
import trimesh

from asset_factory.sim_checks.geometry.kinematics import build_tree
from asset_factory.sim_checks.read.read import read_description, read_here

mujoco = pytest.importorskip("mujoco")

MODEL = """<mujoco><compiler angle="radian"/><asset><mesh name="part" file="part.stl"/></asset>
  <worldbody><geom type="plane" size="1 1 1"/>
  <body name="base" pos="0 0 1" euler="0.1 0.2 0.3">
    <geom name="slab" type="box" size="0.1 0.2 0.3"/>
    <geom type="sphere" size="0.1" contype="0" conaffinity="0"/>
    <geom type="mesh" mesh="part" contype="0" conaffinity="0"/>
    <body name="door" pos="0.4 0 0" euler="0 0.5 0"><geom type="capsule" size="0.05 0.2"/>
      <joint name="hinge" type="hinge" axis="0 1 1" pos="0.1 0.2 0.3" range="-1 2"
        limited="true" ref="0.3" damping="0.5" frictionloss="0.25"/>
      <body name="bolt" pos="0 0.1 0">
        <geom type="ellipsoid" size="0.1 0.05 0.02" contype="2" conaffinity="4"/>
        <joint name="slide" type="slide" axis="1 0 0" range="0 0.2" limited="true"/>
        <joint name="twist" type="hinge" axis="1 0 0"/></body></body></body></worldbody>
  <contact><exclude body1="base" body2="door"/></contact></mujoco>"""


@pytest.fixture
def model_path(tmp_path):
    box = trimesh.creation.box(extents=(0.1, 0.2, 0.3))
    box.apply_translation((1.0, 2.0, 3.0))
    box.export(tmp_path / "part.stl")
    path = tmp_path / "model.xml"
    path.write_text(MODEL)
    return path


def test_bodies_joints_and_geoms_arrive(model_path):
    description = read_description(model_path)
    names = [link.name for link in description.links if not link.virtual]
    assert names == ["world", "base", "door", "bolt"]
    kinds = {joint.name: joint.kind for joint in description.joints if joint.kind != "fixed"}
    assert kinds == {"hinge": "revolute", "slide": "prismatic", "twist": "continuous"}
    hinge = next(joint for joint in description.joints if joint.name == "hinge")
    assert (hinge.lower, hinge.upper, hinge.damping, hinge.friction) == (-1.0, 2.0, 0.5, 0.25)
    base = next(link for link in description.links if link.name == "base")
    assert [shape.kind for shape in base.collisions] == ["box"]
    assert [shape.kind for shape in base.visuals] == ["sphere", "mesh"]
    # It lies where it was drawn, though MuJoCo keeps it centred.
    drawn = base.visuals[1].vertices
    assert drawn.min(axis=0) == pytest.approx([0.95, 1.9, 2.85], abs=1e-6)
    assert drawn.max(axis=0) == pytest.approx([1.05, 2.1, 3.15], abs=1e-6)
    # The bolt's contact bits never meet another's.
    apart = ["base door", "base bolt", "door bolt", "world bolt"]
    assert description.excluded == {frozenset(pair.split()) for pair in apart}


@pytest.mark.parametrize("values", [(0.0, 0.0, 0.0), (1.2, 0.1, -2.0), (-0.7, 0.2, 0.5)])
def test_link_poses_are_mujocos_own(model_path, values):
    names = ("hinge", "slide", "twist")
    poses = build_tree(read_here(model_path)).link_poses(dict(zip(names, values, strict=True)))
    model = mujoco.MjModel.from_xml_path(str(model_path))
    data = mujoco.MjData(model)
    for name, value in zip(names, values, strict=True):
        data.qpos[model.jnt_qposadr[model.joint(name).id]] = value
    mujoco.mj_kinematics(model, data)
    for body in ("base", "door", "bolt"):
        assert poses[body][:3, 3] == pytest.approx(data.body(body).xpos, abs=1e-9)
        assert poses[body][:3, :3] == pytest.approx(data.body(body).xmat.reshape(3, 3), abs=1e-9)
