"""The static lint where the fault corpus, one broken thing for each code, does not look."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from box_world import body, box_shape, cabinet, described, joint, linted, with_joint, with_link

from asset_factory.sim_checks.checks.lint import check_lint
from asset_factory.sim_checks.config import LintConfig
from asset_factory.sim_checks.description import DescribedShape, LinkInertia
from asset_factory.sim_checks.geometry.placing import joined
from asset_factory.sim_checks.report import Report, Severity

HARD = Severity.ERROR
SOFT = Severity.WARNING


def found(description):
    return {each.code: each.severity for each in linted(description)}


def inertia(mass=2.0, moments=(0.01, 0.01, 0.01)):
    return {"inertia": LinkInertia(mass, np.array([0.0, -0.2, 0.2]), np.diag(moments))}


DRAWER = cabinet().links[1].collisions
HOLLOW = DescribedShape("drawer.obj", "mesh", *joined((shape, np.eye(4)) for shape in DRAWER))
BALL = trimesh.creation.icosphere(subdivisions=5, radius=0.05)
FINE = DescribedShape("ball", "mesh", np.array(BALL.vertices), BALL.faces.astype(np.int64))
LIGHT = inertia(mass=1e-300, moments=(1e-5, 1e-5, 1e-5))


def scaled(factor):
    shapes = (replace(shape, vertices=shape.vertices * factor) for shape in DRAWER)
    return {"collisions": tuple(shapes)}


def test_a_sound_cabinet_has_no_findings():
    assert found(cabinet()) == {}


@pytest.mark.parametrize(
    ("changes", "code", "severity"),
    [
        (inertia(moments=(0.16, 0.28, 0.4)), "inertia_implausible", SOFT),
        (inertia(moments=(0.6, 0.6, 0.6)), "inertia_impossible", HARD),
        (inertia(mass=1e300), "inertia_not_finite", HARD),
        (LIGHT, "inertia_impossible", HARD),
        ({"collisions": (*DRAWER, FINE)}, "many_hull_vertices", HARD),
        (scaled(0.2), "collision_scale", None),
        (scaled(0.09), "collision_scale", HARD),
        (scaled(11.0), "collision_scale", HARD),
        (scaled(1e-200), "collision_scale", HARD),
        (scaled(1e-200), "degenerate_collision", HARD),
        (scaled(1e-200) | LIGHT, "collision_scale", HARD),
    ],
)
def test_numbers_at_the_end_of_their_range_have_a_code_too(changes, code, severity):
    result = check_lint(with_link(cabinet(), "drawer", **changes), LintConfig())
    assert {item.code: item.severity for item in result.findings}.get(code) is severity
    assert Report("x", (), result.findings, result.measurements).to_json()


@pytest.mark.parametrize("factor", [0.09, 11.0])
def test_of_a_collision_shape_of_another_scale_the_scale_is_told(factor):
    (finding,) = linted(with_link(cabinet(), "drawer", **scaled(factor)), "collision_scale")
    assert finding.value == pytest.approx(factor, rel=1e-3)


def test_an_axis_nearly_of_length_1_is_only_warned_of():
    nearly = with_joint(cabinet(), "hinge", axis=np.array([0.0, 0.0, 1.005]))
    assert found(nearly).get("axis_not_unit") is SOFT


def wedge(start, end):
    """A panel of 600 x 6 x 400 mm, thinner from one x to another [m], an edge there."""
    shape = box_shape((0.0, 0.0, 0.0), (0.6, 0.006, 0.4))
    far = shape.vertices[:, 0] > 0.0
    vertices = shape.vertices * np.where(far, 0.0, 1.0)[:, None] ** [0.0, 1.0, 0.0]
    vertices[:, 0] = np.where(far, end, start)
    return replace(shape, vertices=vertices)


@pytest.mark.parametrize(
    ("wedges", "covered"),
    [([(-0.3, 0.0)], 0.5167), ([(-0.3, 0.0), (0.3, 0.0)], 1.0), ([(-0.3, 0.3)], 1.0)],
    ids=["half of it", "two that meet", "all of it"],
)
def test_what_lies_beyond_a_knife_s_edge_is_not_covered(wedges, covered):
    panel = body("panel", [((0.0, 0.0, 0.0), (0.6, 0.006, 0.4))])
    panel = replace(panel, collisions=tuple(wedge(*ends) for ends in wedges))
    result = check_lint(described([panel], []), LintConfig())
    assert result.measurements["links"][0]["covered"] == pytest.approx(covered, abs=0.05)
    codes = {finding.code for finding in result.findings if finding.severity is HARD}
    assert codes == ({"collision_gap"} if covered < 0.9 else set())


def test_the_ratio_of_hull_to_mesh_volume_is_told():
    (finding,) = linted(with_link(cabinet(), "drawer", collisions=(HOLLOW,)), "nonconvex_collision")
    assert finding.value == pytest.approx(4.5, abs=1.5)


def test_a_file_without_any_collision_is_told_once():
    description = cabinet()
    for name in ("carcass", "drawer", "door"):
        description = with_link(description, name, collisions=())
    assert [each.parts for each in linted(description, "no_collision")] == [()]


def test_a_free_root_is_no_fault_but_a_free_limb_is():
    cubes = [body(name, [((0, 0, 0), (0.1, 0.1, 0.1))]) for name in ("world", "body", "limb")]
    free = joint("free", "floating", "world", "body", (0, 0, 0), (1, 0, 0), None)
    assert found(described(cubes[:2], [free]))["unknown_joint_type"] is SOFT
    limb = joint("limb", "floating", "body", "limb", (0, 0, 0), (1, 0, 0), None)
    assert HARD in [each.severity for each in linted(described(cubes, [free, limb]))]
