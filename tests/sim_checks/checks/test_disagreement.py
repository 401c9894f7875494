"""Where engines disagree, the report says who said what.

It says why only where the judge's own numbers bear it out.
"""

import pytest
from fault_corpus.things import Body, Move, Thing, at, box, write_urdf

from asset_factory.sim_checks import Finding, Report, Severity
from asset_factory.sim_checks.checks.disagreement import disagreements
from asset_factory.sim_checks.checks.disagreement_reasons import UNKNOWN
from asset_factory.sim_checks.simulators.catalog import installed

ALL = ("sapien", "mujoco", "pybullet")
FINE = {"reached": 1.0, "returned": 0.0, "overshoot": 0.0, "others_moved": 0.0}
NO = {"jammed": {"reached": 0.2}, "not_returned": {"returned": 0.4}}


def motion(joint="slide", **changes):
    return {"joint": joint, **FINE, "finite": True, "range": 0.3, "pushed": None, **changes}


def said(*motions, coupled=()):
    rest = [
        {"joint": entry["joint"], "drift": 0.0, "share": 0.0, "finite": True} for entry in motions
    ]
    moving = {"joints": list(motions), "rest": rest, "moved_with_others": list(coupled)}
    return {"loading": {"worst_position_m": 0.0}, "motion": moving}


def contact(depth, *, links=("drawer", "shell"), excess=0.0, **more):
    told = {"links": links, "shapes": ["a", "b"], "depth_mm": depth, "excess_mm": excess}
    return {**told, "kind": "plain", **more}


def measured(*pairs, unit="m", **engines):
    sweep = {"joint": "slide", "unit": unit, "pairs": list(pairs)}
    return {"penetration": {"rest": list(pairs), "joints": [sweep]}, **engines}


def no(code, *simulators, joint="slide", joints=()):
    parts = ("shell", "drawer") if joint else ()
    return [
        Finding(code, Severity.ERROR, "", simulator, joint, parts, joints=joints)
        for simulator in simulators
    ]


def engines(code, *failing):
    return {name: said(motion(**(NO[code] if name in failing else {}))) for name in ALL}


def only(findings, measurements):
    (found,) = disagreements(findings, measurements, ALL)
    return found


def jam(*failing, pairs=(), unit="m"):
    return only(no("jammed", *failing), measured(*pairs, unit=unit, **engines("jammed", *failing)))


def test_engines_that_agree_are_not_spoken_of():
    assert disagreements([], measured(**engines("jammed")), ALL) == ()
    assert disagreements(no("jammed", *ALL), measured(**engines("jammed", *ALL)), ALL) == ()


def test_who_said_what_with_its_number():
    found = jam("mujoco")
    assert (found.question, found.joint, found.unit) == ("opens", "slide", "of range")
    assert found.verdicts == {"sapien": "pass", "mujoco": "jammed", "pybullet": "pass"}
    assert found.values == {"sapien": 1.0, "mujoco": 0.2, "pybullet": 1.0}
    assert found.reason == UNKNOWN


def test_an_engine_that_did_not_open_a_joint_has_no_say_on_its_return():
    findings = [*no("jammed", "mujoco"), *no("not_returned", "pybullet")]
    stuck = said(motion(reached=0.2, returned=0.2))
    measurements = engines("not_returned", "pybullet") | {"mujoco": stuck}
    opens, returns = disagreements(findings, measurements, ALL)
    assert opens.question == "opens"
    assert returns.verdicts == {"sapien": "pass", "pybullet": "not_returned"}


@pytest.mark.parametrize("absent", ["simulator_missing", "crashed"])
def test_an_engine_that_took_no_part_is_left_out(absent):
    findings = no("jammed", "mujoco")
    measurements = engines("jammed", "mujoco") | {"pybullet": {}}
    if absent == "simulator_missing":
        findings += no("simulator_missing", "pybullet", joint=None)
    assert only(findings, measurements).verdicts == {"sapien": "pass", "mujoco": "jammed"}


PARENT_CHILD = "PhysX never collides"
SLIDE = "no force for overlap across a slide's axis"
MARGIN = "wraps every mesh hull in 1 mm"
SOFT = "soft contacts give way"


@pytest.mark.parametrize(
    ("failing", "pair", "unit", "reason"),
    [
        (("mujoco", "pybullet"), contact(3.0, excess=3.0), "m", PARENT_CHILD),
        (("mujoco",), contact(3.0), "m", SLIDE),
        (("mujoco",), contact(3.0), "rad", PARENT_CHILD),
        (("sapien", "mujoco"), contact(3.0, links=("one", "two")), "m", SLIDE),
        (("sapien", "mujoco"), contact(3.0, links=("one", "two"), excess=1.0), "m", UNKNOWN),
        (("mujoco", "pybullet"), contact(3.0, links=("one", "two"), excess=3.0), "m", UNKNOWN),
        (("mujoco", "pybullet"), contact(-3.0), "m", UNKNOWN),
        (("pybullet",), contact(-1.9), "rad", MARGIN),
        (("pybullet",), contact(-2.1), "rad", UNKNOWN),
        (("pybullet",), contact(-1.5, shapes=["a", "box"]), "rad", UNKNOWN),
        (("pybullet",), contact(-0.5, shapes=["a", "box"]), "rad", MARGIN),
        (("mujoco", "pybullet"), contact(-1.0), "rad", UNKNOWN),
        (("sapien", "pybullet"), contact(0.3, links=("one", "two"), excess=0.3), "m", SOFT),
        (("sapien", "pybullet"), contact(0.7, links=("one", "two"), excess=0.7), "m", UNKNOWN),
        (("pybullet",), contact(3.0, kind="excluded"), "rad", "only MuJoCo reads"),
    ],
)
def test_a_known_trait_is_the_reason_only_where_depths_and_gaps_bear_it_out(
    failing, pair, unit, reason
):
    found = jam(*failing, pairs=(pair,), unit=unit).reason
    assert reason in found
    if reason in (PARENT_CHILD, SLIDE, MARGIN, SOFT):
        assert f"{max(0.0, abs(pair['depth_mm'])):.2f} mm" in found


def test_the_parts_that_block_the_joint_count_and_not_the_deepest_of_all():
    pairs = (contact(9.0, links=("one", "two")), contact(-1.5))
    measurements = measured(*pairs, unit="rad", **engines("jammed", "pybullet"))
    assert only(no("jammed", "pybullet"), measurements).reason == UNKNOWN
    measurements["pybullet"]["motion"]["joints"][0]["blocked_by"] = ["shell", "drawer"]
    assert MARGIN in only(no("jammed", "pybullet"), measurements).reason


def test_a_soft_limit_is_mujoco_s_only_while_it_is_a_spring():
    for overshoot, reason in ((0.009, "gave way by 3.0% of the range"), (0.3, UNKNOWN)):
        measurements = engines("jammed") | {"mujoco": said(motion(overshoot=overshoot))}
        found = only(no("limit_overshoot", "mujoco"), measurements)
        assert found.question == "keeps_limits"
        assert found.values["mujoco"] == round(overshoot / 0.3, 6)
        assert reason in found.reason


def test_dropped_friction_is_the_reason_where_nothing_is_in_the_way():
    measurements = engines("not_returned", "mujoco", "pybullet")
    findings = no("not_returned", "mujoco", "pybullet")
    assert only(findings, measurements).reason == UNKNOWN
    findings += no("friction_ignored", "sapien", joint=None, joints=("slide",))
    assert "drops the file's joint friction" in only(findings, measurements).reason


def test_a_joint_that_follows_in_one_engine_and_not_in_another():
    coupled = said(motion(), coupled=("leaf",))
    pushed = said(motion(others_moved=0.6, pushed="leaf"))
    measurements = {"sapien": coupled, "mujoco": coupled, "pybullet": pushed}
    found = only(no("others_moved", "pybullet"), measurements)
    assert found.question == "leaves_others"
    obeyed = "the file couples joints, which SAPIEN and MuJoCo obeyed and PyBullet did not"
    assert found.reason == obeyed


def test_nan_in_one_engine_is_its_verdict():
    measurements = engines("jammed") | {"pybullet": said(motion(finite=False))}
    first = disagreements(no("not_finite", "pybullet"), measurements, ALL)[0]
    assert (first.verdicts["pybullet"], first.values["pybullet"]) == ("not_finite", None)


@pytest.mark.parametrize(("gap", "told"), [(0.0, True), (-0.3, False)])
def test_parts_that_touch_flush_are_a_matter_of_rounding(gap, told):
    held = engines("jammed", "mujoco")
    held["mujoco"]["motion"]["joints"][0]["blocked_by"] = ["shell", "drawer"]
    found = only(no("jammed", "mujoco"), measured(contact(gap), **held))
    assert ("touch without a gap" in found.reason) is told


def test_parts_in_one_another_drive_a_joint_past_its_limit():
    wild = engines("jammed") | {"pybullet": said(motion(overshoot=0.3 * 0.9))}
    found = only(no("limit_overshoot", "pybullet"), measured(contact(13.0, excess=2.0), **wild))
    assert found.question == "keeps_limits"
    assert PARENT_CHILD in found.reason


def test_damping_that_explodes_in_bullet_alone():
    stiff = Finding("damping_stiff", Severity.WARNING, "", None, "slide", ("shell", "drawer"), 13.5)
    found = only([stiff, *no("jammed", "pybullet")], measured(**engines("jammed", "pybullet")))
    assert "13.5 times the speed" in found.reason
    assert jam("pybullet").reason == UNKNOWN


def test_loading_and_link_poses_are_questions_of_the_whole_file():
    loading = {"mujoco": said(), "sapien": said(), "pybullet": {}}
    found = only(no("load_failed", "pybullet", joint=None), loading)
    assert (found.question, found.joint) == ("loads", None)
    assert "the loader of PyBullet asks more of a file" in found.reason
    measurements = engines("jammed")
    measurements["sapien"]["loading"]["worst_position_m"] = 0.02
    poses = only(no("pose_mismatch", "sapien", joint=None), measurements)
    assert (poses.question, poses.values["sapien"], poses.reason) == ("link_poses", 0.02, UNKNOWN)


def test_who_cannot_read_the_format_gave_no_verdict_to_disagree_with():
    findings = no("format_not_loaded", "sapien", "pybullet", joint=None)
    assert disagreements(findings, {"mujoco": said(), "sapien": {}, "pybullet": {}}, ALL) == ()


def slider(folder, shell, drawer, upper):
    """Two boxes as meshes, one sliding along x: centre and size [m] each."""
    bodies = tuple(
        Body(name, (box(*place),), at(0, 0, 0), 2.0)
        for name, place in (("shell", shell), ("drawer", drawer))
    )
    slide = Move("slide", "prismatic", "shell", "drawer", (1.0, 0.0, 0.0), 0.0, upper)
    return write_urdf(Thing("slider", bodies, (slide,)), folder)


every_engine = pytest.mark.skipif(
    not all(installed(name) for name in ALL), reason=f"needs {', '.join(ALL)}"
)


@every_engine
def test_a_drawer_stuck_in_its_own_carcass(tmp_path, judge):
    path = slider(tmp_path, ((0, 0.3, 0), (0.4, 0.1, 0.4)), ((0, 0.16, 0), (0.4, 0.2, 0.4)), 0.3)
    report = judge.check(path, ALL)
    (found,) = report.disagreements
    assert found.verdicts == {"sapien": "pass", "mujoco": "jammed", "pybullet": "pass"}
    assert PARENT_CHILD in found.reason
    assert SLIDE in found.reason
    assert "10.00 mm" in found.reason
    for engine, blind_to in (("sapien", "parent and child"), ("pybullet", "across")):
        assert any(blind_to in told for told in report.measurements[engine]["blind_spots"])
    assert Report.from_dict(report.to_dict()).to_json() == report.to_json()


@every_engine
def test_a_button_a_millimetre_before_its_panel(tmp_path, judge):
    path = slider(tmp_path, ((0.1, 0, 0), (0.1, 0.2, 0.2)), ((0.171, 0, 0), (0.04, 0.2, 0.2)), 0.02)
    (found,) = judge.check(path, ALL).disagreements
    assert (found.question, found.verdicts["pybullet"]) == ("rests", "pushed_at_rest")
    assert found.verdicts["mujoco"] == found.verdicts["sapien"] == "pass"
    assert MARGIN in found.reason
    assert "1.00 mm apart" in found.reason
