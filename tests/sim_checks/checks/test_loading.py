"""Every difference between what the file says and what an engine holds has its own code."""

from dataclasses import replace

import numpy as np
import pytest
from fault_corpus.things import renewed
from small_cabinet import write_urdf

from asset_factory.sim_checks.checks import in_simulator
from asset_factory.sim_checks.checks.agreement import pose_samples
from asset_factory.sim_checks.checks.loading import check_loading
from asset_factory.sim_checks.config import CheckConfig, ChildConfig, MotionConfig
from asset_factory.sim_checks.description import LinkInertia, Mimic
from asset_factory.sim_checks.geometry.kinematics import build_tree, sound_mimics, unit_axis
from asset_factory.sim_checks.processes.isolation import WarmChild
from asset_factory.sim_checks.read.read import read_description
from asset_factory.sim_checks.report import UNJUDGED_CODES, Report, Severity
from asset_factory.sim_checks.simulators.catalog import simulator
from asset_factory.sim_checks.simulators.simulator import Observation, PoseSample
from asset_factory.sim_checks.simulators.world import LoadedJoint, LoadedLink, LoadedModel

NAN = float("nan")
LIMIT = '<limit lower="0.0" upper="0.3" effort="50" velocity="2"/>'
DYNAMICS = {LIMIT: f'{LIMIT}<dynamics damping="2" friction="3"/>'}
END = 'upper="1.57" effort="50" velocity="2"/></joint>'
MIMIC = {END: f'{END[:-8]}<mimic joint="slide" multiplier="5" offset="0.01"/></joint>'}
LINKS = ("carcass", "drawer", "door")


def faithful(description):
    """What an engine that holds exactly what the file says would report."""
    links = []
    for link in description.links:
        a, b, c = np.linalg.eigvalsh(link.inertia.tensor).tolist()
        x, y, z = link.inertia.center.tolist()
        links.append(
            LoadedLink(link.name, link.inertia.mass, len(link.collisions), (a, b, c), (x, y, z))
        )
    joints = []
    for line in description.joints:
        x, y, z = unit_axis(line).tolist()
        numbers = (line.lower or 0.0, line.upper or 0.0, line.damping, line.friction)
        joints.append(LoadedJoint(line.name, line.kind, *numbers, (x, y, z), line.mimic))
    tree = build_tree(description)
    values = tree.completed({line.name: 0.1 for line in tree.free})
    model = LoadedModel(tuple(links), tuple(joints))
    return Observation(model, (PoseSample(values, tree.link_poses(values)),))


def found(description, observation):
    """What the check says, in words that a report can hold."""
    result = check_loading(description, observation, CheckConfig())
    assert Report("x", ("engine",), result.findings, {"engine": result.measurements}).to_json()
    return result.findings


def codes(description, observation):
    return [finding.code for finding in found(description, observation)]


def held(name, /, **changes):
    """Make an engine hold another link or joint than the file has."""

    def change(observation):
        model = observation.model
        links = renewed(model.links, name, **changes) if name in LINKS else model.links
        joints = renewed(model.joints, name, **changes) if name not in LINKS else model.joints
        return replace(observation, model=replace(model, links=links, joints=joints))

    return change


def shifted(by, *links):
    """Make an engine put the named links, or all, so far away [m]."""

    def change(observation):
        (sample,) = observation.poses
        poses = {name: pose.copy() for name, pose in sample.poses.items()}
        for name in links or poses:
            poses[name][:3, 3] += by
        return replace(observation, poses=(PoseSample(sample.values, poses),))

    return change


def on_the_ground(observation):
    links = (LoadedLink("world", 0.0, 0, None, static=True), *observation.model.links)
    return replace(observation, model=replace(observation.model, links=links))


@pytest.fixture(scope="module")
def description(tmp_path_factory):
    return read_description(write_urdf(tmp_path_factory.mktemp("cabinet")))


@pytest.mark.parametrize(
    ("change", "wanted"),
    [
        (held("drawer", shapes=0), ["shape_dropped"]),
        (held("drawer", shapes=2), ["shape_added"]),
        (held("drawer", mass=3.001), ["mass_mismatch"]),
        (held("drawer", mass=float(np.float32(3.0))), []),
        (held("drawer", moments=(1.0, 1.0, 1.0)), ["inertia_mismatch"]),
        (held("drawer", center=(0.0, 0.0, 0.0)), ["center_mismatch"]),
        (held("drawer", name="other"), ["link_missing", "link_added"]),
        (held("carcass", mass=0.0, moments=None, static=True), []),
        (held("slide", kind="revolute"), ["joint_kind"]),
        (held("slide", upper=0.30001), ["limit_mismatch"]),
        (held("slide", lower=float("-inf")), ["limit_mismatch"]),
        (held("slide", upper=NAN), ["limit_mismatch"]),
        (held("hinge", upper=float(np.float32(1.57))), []),
        (held("slide", axis=(1.0, 0.0, 0.0)), ["axis_mismatch"]),
        (held("slide", axis=(-1.0, 0.001, 0.0)), ["axis_mismatch"]),
        (held("slide", axis=(-1.0, 5e-5, 0.0)), []),
        (held("slide", axis=(0.0, 0.0, 0.0)), ["axis_mismatch"]),
        (held("slide", axis=None), []),
        (held("slide", mimic=Mimic("hinge")), ["mimic_mismatch"]),
        (held("slide", name="other"), ["joint_missing", "joint_added"]),
        (shifted((1.1e-5, 0.0, 0.0), "door"), ["pose_mismatch"]),
        (shifted((9e-6, 0.0, 0.0), "door"), []),
        (shifted((1.0, 2.0, 3.0)), []),
        (on_the_ground, []),
        (lambda observation: observation, []),
    ],
)
def test_each_lie_about_the_file_is_named_and_rounding_is_none(description, change, wanted):
    assert codes(description, change(faithful(description))) == wanted


@pytest.mark.parametrize(
    ("shapes", "wanted"), [(3, []), (2, ["shape_dropped"]), (1, ["shape_dropped"])]
)
def test_one_shape_of_many_that_is_dropped_is_named_too(description, shapes, wanted):
    links = tuple(replace(link, collisions=3 * link.collisions) for link in description.links)
    threefold = replace(description, links=links)
    assert codes(threefold, held("drawer", shapes=shapes)(faithful(threefold))) == wanted


@pytest.mark.parametrize(
    ("written", "change", "code"),
    [
        (DYNAMICS, held("slide", friction=None), "friction_ignored"),
        (DYNAMICS, held("slide", friction=0.05), "friction_ignored"),
        (DYNAMICS, held("slide", damping=0.0), "damping_ignored"),
        (MIMIC, held("hinge", mimic=None), "mimic_ignored"),
        (MIMIC, held("hinge", forced_by_judge=True), "mimic_ignored"),
        (MIMIC, held("hinge", mimic=Mimic("slide", 0.2, 0.01)), "mimic_mismatch"),
        (MIMIC, held("hinge", mimic=Mimic("slide", 5.0)), "mimic_mismatch"),
        (MIMIC, held("hinge", mimic=Mimic("hinge")), "mimic_mismatch"),
    ],
    ids=[
        "friction dropped", "friction replaced", "damping dropped", "mimic dropped",
        "mimic by the judge alone", "another rate", "no offset", "another leader",
    ],
)  # fmt: skip
def test_what_loaders_drop_or_replace_without_a_word_is_named(tmp_path, written, change, code):
    description = read_description(write_urdf(tmp_path, replace=written))
    honest = faithful(description)
    assert code not in codes(description, honest)
    assert code in codes(description, change(honest))


def test_a_mass_for_a_link_that_states_none_is_invented(tmp_path):
    massless = {'<mass value="3.0"/>': '<mass value="0"/>'}
    description = read_description(write_urdf(tmp_path, replace=massless))
    heavy = held("drawer", mass=9.0)(faithful(description))
    assert codes(description, heavy) == ["inertia_invented"]


def test_an_axis_that_is_turned_round_is_told_in_degrees(description):
    (finding,) = found(description, held("hinge", axis=(0.0, 0.0, -1.0))(faithful(description)))
    assert (finding.code, finding.value, finding.unit) == ("axis_mismatch", 180.0, "deg")


def test_the_mass_of_a_base_that_never_moves_is_compared_where_it_is_held(description):
    (finding,) = found(description, held("carcass", mass=1.0, static=True)(faithful(description)))
    assert (finding.code, finding.severity) == ("mass_mismatch", Severity.WARNING)


@pytest.mark.parametrize(
    ("change", "code", "parts"),
    [
        (held("drawer", mass=NAN), "mass_mismatch", ["drawer"]),
        (held("drawer", moments=(NAN, 1.0, 1.0)), "inertia_mismatch", ["drawer"]),
        (held("drawer", center=(0.0, NAN, 0.0)), "center_mismatch", ["drawer"]),
        (shifted((NAN, 0.0, 0.0), "door"), "pose_mismatch", ["door"]),
        (shifted((NAN, 0.0, 0.0), "carcass"), "pose_mismatch", ["carcass", "drawer", "door"]),
    ],
)
def test_what_an_engine_makes_no_number_of_is_a_lie(description, change, code, parts):
    told = [(x.code, x.parts, x.value) for x in found(description, change(faithful(description)))]
    assert told == [(code, (part,), None) for part in parts]


@pytest.mark.parametrize(
    "inertia",
    [
        LinkInertia(NAN, np.zeros(3), np.eye(3)),
        LinkInertia(float("inf"), np.zeros(3), np.eye(3)),
        LinkInertia(3.0, np.array([NAN, 0.0, 0.0]), np.eye(3)),
        LinkInertia(3.0, np.zeros(3), np.diag([NAN, 1.0, 1.0])),
        LinkInertia(3.0, np.zeros(3), np.diag([1e300, 1.0, 1.0])),
    ],
)
def test_an_engine_is_not_held_to_numbers_that_are_none(description, inertia):
    links = renewed(description.links, "drawer", inertia=inertia)
    assert codes(replace(description, links=links), faithful(description)) == []


@pytest.mark.parametrize(
    "mimic", [Mimic("hinge", float("inf")), Mimic("hinge", 1.0, NAN), Mimic("hinge", 1e300)]
)
def test_a_joint_that_follows_by_no_number_follows_nothing(description, mimic):
    broken = replace(description, joints=renewed(description.joints, "slide", mimic=mimic))
    assert sound_mimics(broken) == {}
    assert codes(broken, held("slide", mimic=Mimic("hinge"))(faithful(description))) == []
    assert all(np.isfinite(list(sample.values())).all() for sample in pose_samples(broken))


@pytest.mark.parametrize("upper", [NAN, float("inf"), 1e308])
def test_poses_are_compared_where_there_are_any(description, upper):
    joints = renewed(description.joints, "slide", upper=upper)
    samples = pose_samples(replace(description, joints=joints))
    assert all(abs(sample["slide"]) <= 1.0 for sample in samples)


def test_an_engine_that_is_not_installed_is_named_with_its_install_line(description, monkeypatch):
    monkeypatch.setattr(in_simulator, "installed", lambda name: False)
    result = in_simulator.judge_in_simulator(description, "mujoco", CheckConfig(), None)
    (finding,) = result.findings
    assert finding.code == "simulator_missing"
    assert "pip install 'asset-factory[mujoco]'" in finding.message


def test_an_engine_that_does_not_answer_in_time_is_a_finding(description):
    pytest.importorskip("mujoco")
    config = CheckConfig(child=ChildConfig(wall_s=0.01))
    with WarmChild() as child:
        result = in_simulator.judge_in_simulator(description, "mujoco", config, child)
    (finding,) = result.findings
    assert (finding.code, finding.severity) == ("simulator_timeout", Severity.ERROR)
    assert finding.code in UNJUDGED_CODES


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
    result = check_loading(description, observation, CheckConfig())
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
