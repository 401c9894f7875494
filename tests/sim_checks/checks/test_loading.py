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
from asset_factory.sim_checks.read.read import read_description
from asset_factory.sim_checks.report import UNJUDGED_CODES, Report, Severity
from asset_factory.sim_checks.simulators.catalog import simulator
from asset_factory.sim_checks.simulators.simulator import (
    LoadedJoint,
    LoadedLink,
    LoadedModel,
    Observation,
    PoseSample,
)

NAN = float("nan")
LIMIT = '<limit lower="0.0" upper="0.3" effort="50" velocity="2"/>'
DYNAMICS = {LIMIT: f'{LIMIT}<dynamics damping="2" friction="3"/>'}
END = 'upper="1.57" effort="50" velocity="2"/></joint>'
MIMIC = {END: f'{END[:-8]}<mimic joint="slide" multiplier="5" offset="0.01"/></joint>'}


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
    values = tree.completed(
        {"slide": 0.1} if description.joints[-1].mimic else {"slide": 0.1, "hinge": 0.7}
    )
    return Observation(
        LoadedModel(tuple(links), tuple(joints), ()), (PoseSample(values, tree.link_poses(values)),)
    )


def found(description, observation):
    judged = check_loading(description, "engine", observation, CheckConfig())
    return [finding.code for finding in judged.findings]


def with_link(observation, link, /, **changes):
    links = renewed(observation.model.links, link, **changes)
    return replace(observation, model=replace(observation.model, links=links))


def with_joint(observation, joint, /, **changes):
    joints = renewed(observation.model.joints, joint, **changes)
    return replace(observation, model=replace(observation.model, joints=joints))


def shifted(observation, by, *links):
    """The same, but the named links, or all, lie so far away [m]."""
    (sample,) = observation.poses
    poses = {name: pose.copy() for name, pose in sample.poses.items()}
    for name in links or poses:
        poses[name][:3, 3] += by
    return replace(observation, poses=(PoseSample(sample.values, poses),))


@pytest.fixture
def description(tmp_path):
    return read_description(write_urdf(tmp_path))


def test_a_faithful_engine_has_no_findings(description):
    assert found(description, faithful(description)) == []


@pytest.mark.parametrize(
    ("changed", "name", "changes", "code"),
    [
        (with_link, "drawer", {"shapes": 0}, "shape_dropped"),
        (with_link, "drawer", {"shapes": 2}, "shape_added"),
        (with_link, "drawer", {"mass": 3.001}, "mass_mismatch"),
        (with_link, "drawer", {"moments": (1.0, 1.0, 1.0)}, "inertia_mismatch"),
        (with_link, "drawer", {"center": (0.0, 0.0, 0.0)}, "center_mismatch"),
        (with_joint, "slide", {"kind": "revolute"}, "joint_kind"),
        (with_joint, "slide", {"upper": 0.30001}, "limit_mismatch"),
        (with_joint, "slide", {"lower": float("-inf")}, "limit_mismatch"),
        (with_joint, "slide", {"upper": NAN}, "limit_mismatch"),
        (with_joint, "slide", {"axis": (1.0, 0.0, 0.0)}, "axis_mismatch"),
        (with_joint, "slide", {"axis": (-1.0, 0.001, 0.0)}, "axis_mismatch"),
        (with_joint, "slide", {"axis": (0.0, 0.0, 0.0)}, "axis_mismatch"),
        (with_joint, "slide", {"mimic": Mimic("hinge")}, "mimic_mismatch"),
    ],
)
def test_each_lie_about_a_link_or_a_joint_is_named(description, changed, name, changes, code):
    assert found(description, changed(faithful(description), name, **changes)) == [code]


@pytest.mark.parametrize(
    ("held", "codes"), [(3, []), (2, ["shape_dropped"]), (1, ["shape_dropped"])]
)
def test_one_shape_of_many_that_is_dropped_is_named_too(description, held, codes):
    links = tuple(replace(link, collisions=3 * link.collisions) for link in description.links)
    threefold = replace(description, links=links)
    observation = with_link(faithful(threefold), "drawer", shapes=held)
    assert found(threefold, observation) == codes


@pytest.mark.parametrize(
    ("written", "name", "changes", "code"),
    [
        (DYNAMICS, "slide", {"friction": None}, "friction_ignored"),
        (DYNAMICS, "slide", {"friction": 0.05}, "friction_ignored"),
        (DYNAMICS, "slide", {"damping": 0.0}, "damping_ignored"),
        (MIMIC, "hinge", {"mimic": None}, "mimic_ignored"),
        (MIMIC, "hinge", {"forced_by_judge": True}, "mimic_ignored"),
        (MIMIC, "hinge", {"mimic": Mimic("slide", 0.2, 0.01)}, "mimic_mismatch"),
        (MIMIC, "hinge", {"mimic": Mimic("slide", 5.0)}, "mimic_mismatch"),
        (MIMIC, "hinge", {"mimic": Mimic("hinge")}, "mimic_mismatch"),
    ],
    ids=[
        "friction dropped", "friction replaced", "damping dropped", "mimic dropped",
        "mimic by the judge alone", "another rate", "no offset", "another leader",
    ],
)  # fmt: skip
def test_what_loaders_drop_or_replace_without_a_word_is_named(
    tmp_path, written, name, changes, code
):
    description = read_description(write_urdf(tmp_path, replace=written))
    honest = faithful(description)
    assert code not in found(description, honest)
    assert code in found(description, with_joint(honest, name, **changes))


def test_a_mass_for_a_link_that_states_none_is_invented(tmp_path):
    massless = {'<mass value="3.0"/>': '<mass value="0"/>'}
    description = read_description(write_urdf(tmp_path, replace=massless))
    heavy = with_link(faithful(description), "drawer", mass=9.0)
    assert found(description, heavy) == ["inertia_invented"]


def test_what_has_another_name_is_missing_and_too_much(description):
    observation = faithful(description)
    assert found(description, with_link(observation, "drawer", name="other"))[:2] == [
        "link_missing",
        "link_added",
    ]
    assert found(description, with_joint(observation, "slide", name="other")) == [
        "joint_missing",
        "joint_added",
    ]


def test_an_axis_that_is_told_by_none_or_turned_by_rounding_is_no_lie(description):
    observation = faithful(description)
    assert found(description, with_joint(observation, "slide", axis=None)) == []
    assert found(description, with_joint(observation, "slide", axis=(-1.0, 5e-5, 0.0))) == []
    turned = with_joint(observation, "hinge", axis=(0.0, 0.0, -1.0))
    (finding,) = check_loading(description, "engine", turned, CheckConfig()).findings
    assert (finding.code, finding.value, finding.unit) == ("axis_mismatch", 180.0, "deg")


def test_the_ground_is_no_link_too_many(description):
    observation = faithful(description)
    ground = LoadedLink("world", 0.0, 0, None, static=True)
    with_ground = replace(
        observation, model=replace(observation.model, links=(ground, *observation.model.links))
    )
    assert found(description, with_ground) == []


def test_the_mass_of_a_base_that_never_moves_is_compared_where_it_is_held(description):
    lighter = with_link(faithful(description), "carcass", mass=1.0, static=True)
    (finding,) = check_loading(description, "engine", lighter, CheckConfig()).findings
    assert (finding.code, finding.severity) == ("mass_mismatch", Severity.WARNING)


def test_single_precision_is_no_lie(description):
    observation = with_joint(faithful(description), "hinge", upper=float(np.float32(1.57)))
    observation = with_link(observation, "drawer", mass=float(np.float32(3.0)))
    assert found(description, observation) == []


def test_a_static_link_s_mass_is_nobody_s_business(description):
    weightless = with_link(faithful(description), "carcass", mass=0.0, moments=None, static=True)
    assert found(description, weightless) == []


@pytest.mark.parametrize(("offset", "expected"), [(9e-6, []), (1.1e-5, ["pose_mismatch"])])
def test_a_link_a_hundredth_of_a_millimetre_off_is_seen(description, offset, expected):
    moved = shifted(faithful(description), (offset, 0.0, 0.0), "door")
    assert found(description, moved) == expected


def test_a_base_put_elsewhere_is_no_disagreement(description):
    assert found(description, shifted(faithful(description), (1.0, 2.0, 3.0))) == []


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"mass": NAN}, "mass_mismatch"),
        ({"moments": (NAN, 1.0, 1.0)}, "inertia_mismatch"),
        ({"center": (0.0, NAN, 0.0)}, "center_mismatch"),
    ],
)
def test_what_an_engine_makes_no_number_of_is_a_lie_that_can_be_written(description, changes, code):
    result = check_loading(
        description, "engine", with_link(faithful(description), "drawer", **changes), CheckConfig()
    )
    assert [(finding.code, finding.value) for finding in result.findings] == [(code, None)]
    assert Report("x", ("engine",), result.findings, {"engine": result.measurements}).to_json()


def test_a_link_put_nowhere_is_a_lie_that_can_be_written(description):
    for nowhere, lost in (("door", ["door"]), ("carcass", ["carcass", "drawer", "door"])):
        moved = shifted(faithful(description), (NAN, 0.0, 0.0), nowhere)
        result = check_loading(description, "engine", moved, CheckConfig())
        assert [(x.code, x.parts, x.value) for x in result.findings] == [
            ("pose_mismatch", (x,), None) for x in lost
        ]
        assert Report("x", ("engine",), result.findings, {"engine": result.measurements}).to_json()


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
    assert found(replace(description, links=links), faithful(description)) == []


@pytest.mark.parametrize(
    "mimic", [Mimic("hinge", float("inf")), Mimic("hinge", 1.0, NAN), Mimic("hinge", 1e300)]
)
def test_a_joint_that_follows_by_no_number_follows_nothing(description, mimic):
    broken = replace(description, joints=renewed(description.joints, "slide", mimic=mimic))
    assert sound_mimics(broken) == {}
    assert found(broken, with_joint(faithful(description), "slide", mimic=Mimic("hinge"))) == []
    assert all(np.isfinite(list(sample.values())).all() for sample in pose_samples(broken))


@pytest.mark.parametrize("upper", [NAN, float("inf"), 1e308])
def test_poses_are_compared_where_there_are_any(description, upper):
    joints = renewed(description.joints, "slide", upper=upper)
    samples = pose_samples(replace(description, joints=joints))
    assert all(abs(sample["slide"]) <= 1.0 for sample in samples)


def test_an_engine_that_is_not_installed_is_named_with_its_install_line(description, monkeypatch):
    monkeypatch.setattr(in_simulator, "installed", lambda name: False)
    (finding,) = in_simulator.judge_in_simulator(description, "mujoco", CheckConfig()).findings
    assert finding.code == "simulator_missing"
    assert "pip install 'asset-factory[mujoco]'" in finding.message


def test_an_engine_that_does_not_answer_in_time_is_a_finding(description):
    pytest.importorskip("mujoco")
    config = CheckConfig(child=ChildConfig(wall_s=0.01))
    (finding,) = in_simulator.judge_in_simulator(description, "mujoco", config).findings
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
