"""Whatever a loader is known to drop, swap or invent without a word, somebody here says it."""

from dataclasses import replace

import numpy as np
import pytest
from faithful_engine import faithful, found, with_joint, with_link
from small_cabinet import write_urdf

from asset_factory.sim_checks.checks.agreement import pose_samples
from asset_factory.sim_checks.checks.loading import check_loading
from asset_factory.sim_checks.config import CheckConfig, MotionConfig
from asset_factory.sim_checks.description import Mimic
from asset_factory.sim_checks.read.read import read_description
from asset_factory.sim_checks.simulators.catalog import simulator
from asset_factory.sim_checks.simulators.simulator import LoadedJoint, Observation, PoseSample

LIMITS = 'lower="0.0" upper="0.3"'
LIMIT = f'<limit {LIMITS} effort="50" velocity="2"/>'
MASS = '<mass value="3.0"/>'
END = 'upper="1.57" effort="50" velocity="2"/></joint>'
MIMIC = {END: f'{END[:-8]}<mimic joint="slide" multiplier="5" offset="0.01"/></joint>'}
MASSLESS = {MASS: '<mass value="0"/>'}
OTHER_RATE = Mimic("slide", 0.2, 0.01)
NO_OFFSET = Mimic("slide", 5.0)


def joint(name, **told):
    return lambda observation: with_joint(observation, name, **told)


def link(name, **told):
    return lambda observation: with_link(observation, name, **told)


def scaled(observation):
    links = tuple(replace(link, mass=8.0 * link.mass) for link in observation.model.links)
    joints = tuple(replace(joint, upper=2.0 * joint.upper) for joint in observation.model.joints)
    return replace(observation, model=replace(observation.model, links=links, joints=joints))


def with_extra_dofs(observation):
    extra = (LoadedJoint(f"planar{i}", "prismatic", 0.0, 1.0, 0.0, 0.0) for i in range(2))
    joints = (*observation.model.joints, *extra)
    return replace(observation, model=replace(observation.model, joints=joints))


def without_root(observation):
    links = tuple(link for link in observation.model.links if link.name != "carcass")
    return replace(observation, model=replace(observation.model, links=links))


DYNAMICS = {LIMIT: f'{LIMIT}<dynamics damping="2" friction="3"/>'}


@pytest.mark.parametrize(
    ("drop", "changes", "lie", "code"),
    [
        ("limits lost", {}, joint("slide", lower=-np.inf, upper=np.inf), "limit_mismatch"),
        ("limits swapped", {}, joint("slide", lower=0.3, upper=0.0), "limit_mismatch"),
        ("three joints for one", {}, with_extra_dofs, "joint_added"),
        ("root fused into the world", {}, without_root, "link_missing"),
        ("friction dropped", DYNAMICS, joint("slide", friction=None), "friction_ignored"),
        ("friction replaced", DYNAMICS, joint("slide", friction=0.05), "friction_ignored"),
        ("damping dropped", DYNAMICS, joint("slide", damping=0.0), "damping_ignored"),
        ("mass invented", MASSLESS, link("drawer", mass=9.0), "inertia_invented"),
        ("scale applied", {}, scaled, "limit_mismatch"),
        ("scale applied", {}, scaled, "mass_mismatch"),
        ("mimic dropped", MIMIC, joint("hinge", mimic=None), "mimic_ignored"),
        ("mimic by the judge alone", MIMIC, joint("hinge", forced_by_judge=True), "mimic_ignored"),
        ("mimic at another rate", MIMIC, joint("hinge", mimic=OTHER_RATE), "mimic_mismatch"),
        ("mimic without offset", MIMIC, joint("hinge", mimic=NO_OFFSET), "mimic_mismatch"),
        ("mimic of another", MIMIC, joint("hinge", mimic=Mimic("hinge")), "mimic_mismatch"),
    ],
)
def test_what_the_engine_made_of_it(tmp_path, drop, changes, lie, code):
    description = read_description(write_urdf(tmp_path, replace=changes))
    honest = faithful(description)
    assert code not in found(description, honest) or code == "inertia_invented"
    assert code in found(description, lie(honest)), drop


def loaded(description, name):
    """What a real engine holds, and where it puts links; nothing is driven."""
    world = simulator(name).open(description.path, MotionConfig())
    samples = []
    for values in pose_samples(description):
        world.place(np.array([values[joint.name] for joint in world.joints]))
        samples.append(PoseSample(values, world.link_poses()))
    return Observation(world.model, tuple(samples))


@pytest.mark.parametrize("name", ["sapien", "mujoco", "pybullet"])
def test_real_engines_agree_on_poses_and_tell_whether_they_couple_joints(tmp_path, name):
    pytest.importorskip(name)
    description = read_description(write_urdf(tmp_path, replace=MIMIC))
    observation = loaded(description, name)
    result = check_loading(description, name, observation, CheckConfig())
    codes = {finding.code for finding in result.findings}
    assert not codes & {"pose_mismatch", "axis_mismatch", "limit_mismatch"}
    assert not codes & {"link_added", "joint_added", "mimic_mismatch"}
    (hinge,) = (joint for joint in observation.model.joints if joint.name == "hinge")
    assert hinge.follows == "slide"
    # SAPIEN's loader couples two joints of one link the wrong way round, PyBullet's none.
    assert ("mimic_ignored" in codes) == hinge.forced_by_judge == (name != "mujoco")
    assert result.measurements["worst_position_m"] < 1e-5
    assert result.measurements["worst_angle_rad"] < 1e-4
    assert result.measurements["links_compared"] == 3
