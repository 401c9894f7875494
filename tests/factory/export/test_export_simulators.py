"""What was exported moves in every simulator exactly as the articulation says."""

import json
from dataclasses import replace

import mujoco  # noqa: TID253
import numpy as np
import pytest
from export_samples import PROVENANCE, box, boxes_asset, cabinet, image, inertial_of

from asset_factory.factory.articulation import Joint, JointKind, Part
from asset_factory.factory.asset import Asset
from asset_factory.factory.export import export_bundle
from asset_factory.factory.mesh import Material, Mesh, concatenate
from asset_factory.sim_checks.processes.isolation import Limits, run_isolated

LIMITS = Limits(wall_s=120.0)


@pytest.fixture
def in_mujoco(tmp_path):
    """A function that has MuJoCo load what an asset is exported as."""

    def load(asset):
        path = export_bundle(asset, PROVENANCE, tmp_path).mjcf
        return mujoco.MjModel.from_xml_path(str(path))

    return load


def pybullet_turned(path):
    """Runs in a child: friction of the first joint, and where three times it takes the joint."""
    import pybullet

    pybullet.connect(pybullet.DIRECT)
    body = pybullet.loadURDF(path, useFixedBase=True, flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
    friction = pybullet.getJointInfo(body, 0)[7]
    # A motor at rest is Bullet's own idiom for friction.
    pybullet.setJointMotorControl2(body, 0, pybullet.VELOCITY_CONTROL, force=friction)
    for _ in range(24):
        pybullet.setJointMotorControl2(body, 0, pybullet.TORQUE_CONTROL, force=3.0 * friction)
        pybullet.stepSimulation()
    return friction, pybullet.getJointState(body, 0)[0]


def test_pybullet_opens_a_flap_of_five_grams(tmp_path):
    hinge = Joint("hinge", JointKind.REVOLUTE, 0, 1, [0, 0, 1], [-0.004, 0.0, 2.0], 0.0, 2.5)
    plate = box([0, 0, 2], [0.008, 0.001, 0.012])
    asset = boxes_asset([box([0, 0, 0], [1, 1, 1]), plate], (hinge,))
    flap = replace(asset.bodies[1], inertial=inertial_of(plate, 0.005))
    bundle = export_bundle(replace(asset, bodies=(asset.bodies[0], flap)), PROVENANCE, tmp_path)
    friction, turned = run_isolated(pybullet_turned, str(bundle.urdf), limits=LIMITS).unwrap()
    assert friction > 0.0
    assert turned > 2.4


def test_mujoco_sees_each_parts_own_texture_and_only_hulls_collide(in_mujoco):
    colors = ((255, 0, 0), (0, 255, 0), (0, 0, 255))
    textures = map(image, colors, ("PNG", "JPEG", "PNG"))
    model = in_mujoco(cabinet([Material("wood", texture=texture) for texture in textures]))
    pixels = model.tex_data.reshape(3, 16, -1)[:, 0, :3].astype(int)
    assert np.abs(pixels - np.array(colors)).max() <= 2
    collides = model.geom_contype > 0
    assert collides.sum() == 4
    assert set(model.geom_group[collides]) == {3}
    assert set(model.geom_group[~collides]) == {2}


def test_mujoco_holds_what_friction_should_hold(in_mujoco):
    down = Joint("press", JointKind.PRISMATIC, 0, 1, [0, 0, -1], [0, 0, -1], 0.0, 0.02)
    asset = boxes_asset([box([0, 0, 0], [1, 1, 1]), box([0, 0, -1], [0.1, 0.1, 0.02])], (down,))
    model = in_mujoco(asset)
    model.opt.timestep = 1.0 / 240.0
    data = mujoco.MjData(model)
    data.joint("press").qpos = 0.01
    for _ in range(480):
        mujoco.mj_step(model, data)
    # With MuJoCo's own solimpfriction it is at its limit by then.
    assert data.joint("press").qpos[0] - 0.01 == pytest.approx(2e-5, rel=0.1)


def test_mujoco_takes_flat_visuals_lone_triangles_and_carriers(in_mujoco, tmp_path):
    triangle = Mesh.from_triangles([[0, 0, 1], [1, 0, 1], [0, 1, 1]], [[0, 1, 2]])
    solid = box([0, 0, 1], [0.2, 0.2, 0.2])
    empty = Mesh.from_triangles(np.zeros((0, 3)), np.zeros((0, 3)))
    slide = Joint("slide", JointKind.PRISMATIC, 0, 1, [0, 0, 1], [0, 0, 0], 0.0, 0.1)
    turn = Joint("turn", JointKind.REVOLUTE, 1, 2, [0, 0, 1], [0, 0, 0], 0.0, 1.0)
    body = box([0, 0, 0], [1, 1, 1])
    asset = boxes_asset([body, empty, solid], (slide, turn))
    parts = (*asset.articulation.parts[:2], Part("flat", np.array([12])))
    flat = replace(asset.articulation, mesh=concatenate([body, triangle]), parts=parts)
    model = in_mujoco(Asset("flat", flat, asset.bodies))
    assert (model.nbody, model.njnt) == (4, 2)
    assert json.loads((tmp_path / "asset.json").read_text())["links"][1]["hulls"] == 0
