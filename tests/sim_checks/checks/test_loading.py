"""Every difference between what the file says and what an engine holds has its own code."""

from dataclasses import replace

import numpy as np
import pytest
from faithful_engine import faithful, found, with_joint, with_link
from small_cabinet import write_urdf

from asset_factory.sim_checks.checks import in_simulator
from asset_factory.sim_checks.checks.agreement import pose_samples
from asset_factory.sim_checks.checks.loading import check_loading
from asset_factory.sim_checks.config import CheckConfig, ChildConfig
from asset_factory.sim_checks.description import LinkInertia, Mimic
from asset_factory.sim_checks.geometry.kinematics import sound_mimics
from asset_factory.sim_checks.read.read import read_description
from asset_factory.sim_checks.report import UNJUDGED_CODES, Report, Severity
from asset_factory.sim_checks.simulators.catalog import SIMULATORS, install_line, simulator
from asset_factory.sim_checks.simulators.simulator import LoadedLink, PoseSample

NAN = float("nan")


@pytest.fixture
def description(tmp_path):
    return read_description(write_urdf(tmp_path))


def test_a_faithful_engine_has_no_findings(description):
    assert found(description, faithful(description)) == []


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"shapes": 0}, "shape_dropped"),
        ({"shapes": 2}, "shape_added"),
        ({"mass": 3.001}, "mass_mismatch"),
        ({"moments": (1.0, 1.0, 1.0)}, "inertia_mismatch"),
        ({"center": (0.0, 0.0, 0.0)}, "center_mismatch"),
    ],
)
def test_each_lie_about_a_link_is_named(description, changes, code):
    assert found(description, with_link(faithful(description), "drawer", **changes)) == [code]


@pytest.mark.parametrize(
    ("held", "codes"), [(3, []), (2, ["shape_dropped"]), (1, ["shape_dropped"])]
)
def test_one_shape_of_many_that_is_dropped_is_named_too(description, held, codes):
    links = tuple(replace(link, collisions=3 * link.collisions) for link in description.links)
    threefold = replace(description, links=links)
    observation = with_link(faithful(threefold), "drawer", shapes=held)
    assert found(threefold, observation) == codes


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"kind": "revolute"}, "joint_kind"),
        ({"upper": 0.30001}, "limit_mismatch"),
        ({"lower": float("-inf")}, "limit_mismatch"),
        ({"upper": NAN}, "limit_mismatch"),
        ({"axis": (1.0, 0.0, 0.0)}, "axis_mismatch"),
        ({"axis": (-1.0, 0.001, 0.0)}, "axis_mismatch"),
        ({"axis": (0.0, 0.0, 0.0)}, "axis_mismatch"),
        ({"mimic": Mimic("hinge")}, "mimic_mismatch"),
    ],
)
def test_each_lie_about_a_joint_is_named(description, changes, code):
    assert found(description, with_joint(faithful(description), "slide", **changes)) == [code]


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
    observation = faithful(description)
    poses = {name: pose.copy() for name, pose in observation.poses[0].poses.items()}
    poses["door"][0, 3] += offset
    moved = replace(observation, poses=(PoseSample(observation.poses[0].values, poses),))
    assert found(description, moved) == expected


def test_a_base_put_elsewhere_is_no_disagreement(description):
    observation = faithful(description)
    shift = np.eye(4)
    shift[:3, 3] = (1.0, 2.0, 3.0)
    poses = {name: shift @ pose for name, pose in observation.poses[0].poses.items()}
    elsewhere = replace(observation, poses=(PoseSample(observation.poses[0].values, poses),))
    assert found(description, elsewhere) == []


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
    observation = faithful(description)
    for nowhere, lost in (("door", ["door"]), ("carcass", ["carcass", "drawer", "door"])):
        poses = {name: pose.copy() for name, pose in observation.poses[0].poses.items()}
        poses[nowhere][0, 3] = NAN
        moved = replace(observation, poses=(PoseSample(observation.poses[0].values, poses),))
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
    links = tuple(
        replace(x, inertia=inertia if x.name == "drawer" else x.inertia) for x in description.links
    )
    assert found(replace(description, links=links), faithful(description)) == []


@pytest.mark.parametrize(
    "mimic", [Mimic("hinge", float("inf")), Mimic("hinge", 1.0, NAN), Mimic("hinge", 1e300)]
)
def test_a_joint_that_follows_by_no_number_follows_nothing(description, mimic):
    joints = tuple(replace(x, mimic=mimic) if x.name == "slide" else x for x in description.joints)
    broken = replace(description, joints=joints)
    assert sound_mimics(broken) == {}
    assert found(broken, with_joint(faithful(description), "slide", mimic=Mimic("hinge"))) == []
    assert all(np.isfinite(list(sample.values())).all() for sample in pose_samples(broken))


@pytest.mark.parametrize("upper", [NAN, float("inf"), 1e308])
def test_poses_are_compared_where_there_are_any(description, upper):
    joints = tuple(replace(x, upper=upper) if x.name == "slide" else x for x in description.joints)
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


def test_an_unknown_engine_is_answered_with_the_ones_there_are():
    with pytest.raises(
        ValueError, match=r"sapien, mujoco, pybullet, newton; did you mean 'mujoco'\?"
    ):
        simulator("mujcoo")


def test_every_engine_has_an_install_line():
    assert [install_line(name) for name in SIMULATORS] == [
        f"pip install 'asset-factory[{name}]'"
        for name in ("sapien", "mujoco", "pybullet", "newton")
    ]
