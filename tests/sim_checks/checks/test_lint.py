"""The static lint where the fault corpus, one broken thing for each code, does not look."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from box_world import body, box_shape, cabinet, described, joint, with_joint, with_link

from asset_factory.sim_checks.checks.lint import check_lint
from asset_factory.sim_checks.config import LintConfig
from asset_factory.sim_checks.description import DescribedShape, LinkInertia
from asset_factory.sim_checks.geometry.placing import joined
from asset_factory.sim_checks.report import Report, Severity

HARD = Severity.ERROR
SOFT = Severity.WARNING


def found(description):
    return {each.code: each.severity for each in check_lint(description, LintConfig()).findings}


def inertia(mass=2.0, moments=(0.01, 0.01, 0.01), at=-0.2):
    value = LinkInertia(mass, np.array([0.0, at, 0.2]), np.diag(moments))
    return lambda item: with_link(item, "drawer", inertia=value)


def drawer_collisions(change):
    def broken(item):
        shapes = next(link for link in item.links if link.name == "drawer").collisions
        return with_link(item, "drawer", collisions=change(shapes))

    return broken


def hollow(shapes):
    mesh = joined((shape, np.eye(4)) for shape in shapes)
    return (DescribedShape("drawer.obj", "mesh", *mesh),)


def scaled(shape, factor):
    return replace(shape, vertices=shape.vertices * factor)


def drawer_scaled(factor):
    return drawer_collisions(lambda shapes: tuple(scaled(shape, factor) for shape in shapes))


def with_fine_ball(shapes):
    ball = trimesh.creation.icosphere(subdivisions=5, radius=0.05)
    faces = ball.faces.astype(np.int64)
    return (*shapes, DescribedShape("ball", "mesh", np.array(ball.vertices), faces))


def test_a_sound_cabinet_has_no_findings():
    assert found(cabinet()) == {}


@pytest.mark.parametrize(
    ("broken", "code", "severity"),
    [
        (lambda d: with_joint(d, "hinge", axis=np.array([0.0, 0.0, 1.005])), "axis_not_unit", SOFT),
        (inertia(moments=(0.16, 0.28, 0.4)), "inertia_implausible", SOFT),
        (inertia(moments=(0.6, 0.6, 0.6)), "inertia_impossible", HARD),
        (inertia(moments=(10.0, 10.0, 10.0)), "inertia_impossible", HARD),
        (inertia(mass=1e300), "inertia_not_finite", HARD),
        (inertia(mass=1e-300, moments=(1e-5, 1e-5, 1e-5)), "inertia_impossible", HARD),
        (drawer_collisions(with_fine_ball), "many_hull_vertices", HARD),
        (drawer_scaled(0.001), "collision_scale", HARD),
        (drawer_scaled(1000.0), "collision_scale", HARD),
        (drawer_scaled(1e-200), "collision_scale", HARD),
        (drawer_scaled(1e-200), "degenerate_collision", HARD),
    ],
)
def test_numbers_at_the_end_of_their_range_have_a_code_too(broken, code, severity):
    assert found(broken(cabinet())).get(code) is severity


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
    told = result.measurements["links"][0]["covered"]
    assert told == pytest.approx(covered, abs=0.05)
    codes = {finding.code for finding in result.findings if finding.severity is HARD}
    assert codes == ({"collision_gap"} if covered < 0.9 else set())


def test_the_ratio_of_hull_to_mesh_volume_is_told():
    result = check_lint(drawer_collisions(hollow)(cabinet()), LintConfig())
    finding = next(item for item in result.findings if item.code == "nonconvex_collision")
    assert finding.value == pytest.approx(4.5, abs=1.5)


def test_a_file_without_any_collision_is_told_once():
    description = cabinet()
    for name in ("carcass", "drawer", "door"):
        description = with_link(description, name, collisions=())
    findings = check_lint(description, LintConfig()).findings
    assert [each.parts for each in findings if each.code == "no_collision"] == [()]


def test_a_free_root_is_no_fault_but_a_free_limb_is():
    cubes = [body(name, [((0, 0, 0), (0.1, 0.1, 0.1))]) for name in ("world", "body", "limb")]
    free = joint("free", "floating", "world", "body", (0, 0, 0), (1, 0, 0), None)
    assert found(described(cubes[:2], [free]))["unknown_joint_type"] is SOFT
    limb = joint("limb", "floating", "body", "limb", (0, 0, 0), (1, 0, 0), None)
    severities = [
        each.severity for each in check_lint(described(cubes, [free, limb]), LintConfig()).findings
    ]
    assert HARD in severities


@pytest.mark.parametrize(
    ("factor", "code"), [(0.2, None), (0.09, "collision_scale"), (11.0, "collision_scale")]
)
def test_only_a_collision_shape_of_another_scale_is_another_s(factor, code):
    findings = check_lint(drawer_scaled(factor)(cabinet()), LintConfig()).findings
    told = [(each.code, each.value) for each in findings if each.code == "collision_scale"]
    assert told == ([(code, pytest.approx(factor, rel=1e-3))] if code else [])


def test_every_number_told_of_a_link_shrunk_to_nothing_can_be_written():
    light = inertia(mass=1e-300, moments=(1e-5, 1e-5, 1e-5))
    result = check_lint(light(drawer_scaled(1e-200)(cabinet())), LintConfig())
    text = Report("x", (), result.findings, result.measurements).to_json()
    assert "collision_scale" in text
