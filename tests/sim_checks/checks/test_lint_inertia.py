"""From which degree on masses, centres of mass and missing inertias reject."""

from dataclasses import replace

import numpy as np
import pytest
from box_world import body, box_shape, described, joint, with_link

from asset_factory.sim_checks.checks.lint import check_lint
from asset_factory.sim_checks.config import LintConfig
from asset_factory.sim_checks.description import Link, LinkInertia

#: A block of 0.3 x 0.4 x 1.2 m: 144 litres, diagonal 1.3 m.
SIZE = (0.3, 0.4, 1.2)
LITRES = 144.0
DIAGONAL = 1.3


def block(mass=50.0, center=(0.0, 0.0, 0.0)):
    tensor = mass * np.diag([1.6, 1.53, 0.25]) / 12.0
    inertia = LinkInertia(mass, np.array(center), tensor)
    return replace(body("block", [((0.0, 0.0, 0.0), SIZE)]), inertia=inertia)


def thing(moved, *more, kind="prismatic"):
    """A post, what slides on it, and what is fixed to that."""
    links = [body("post", [((0.0, -1.0, 0.0), (0.5,) * 3)]), moved, *more]
    joints = [joint("slide", kind, "post", moved.name, (0.0,) * 3, (1, 0, 0), (0.0, 0.3))]
    joints += [
        joint(f"{link.name}_fixed", "fixed", moved.name, link.name, (0,) * 3, (1, 0, 0), None)
        for link in more
    ]
    return described(links, joints)


def told(description, code):
    return [item for item in check_lint(description, LintConfig()).findings if item.code == code]


def severities(description, code):
    return [str(item.severity) for item in told(description, code)]


@pytest.mark.parametrize(
    ("outside", "severity"),
    [(0.0, []), (0.049, []), (0.051, ["warning"]), (0.099, ["warning"]), (0.101, ["error"])],
)
def test_a_centre_of_mass_counts_by_the_share_of_the_diagonal(outside, severity):
    moved = block(center=(0.15 + outside * DIAGONAL, 0.0, 0.0))
    assert severities(thing(moved), "center_outside") == severity


def test_of_a_thing_of_centimetres_ten_millimetres_are_a_warning():
    small = body("block", [((0.0, 0.0, 0.0), (0.03, 0.03, 0.03))])
    assert small.inertia is not None
    for outside, severity in ((0.009, "warning"), (0.011, "error")):
        center = np.array([0.015 + outside, 0.0, 0.0])
        moved = replace(small, inertia=replace(small.inertia, center=center))
        assert severities(thing(moved), "center_outside") == [severity]


def test_a_centre_within_what_is_only_visible_is_inside():
    moved = block(center=(0.5, 0.0, 0.0))
    leg = box_shape((0.5, 0.0, 0.0), (0.8, 0.1, 0.1))
    assert severities(thing(moved), "center_outside") == ["error"]
    assert severities(thing(replace(moved, visuals=(*moved.visuals, leg))), "center_outside") == []


@pytest.mark.parametrize(
    ("density", "severity"),
    [
        (0.04, ["error"]),
        (0.06, ["warning"]),
        (6.0, []),
        (11900.0, []),
        (12100.0, ["warning"]),
        (22500.0, ["warning"]),
        (22700.0, ["error"]),
        (103000.0, ["error"]),
    ],
)
def test_a_density_rejects_beyond_the_densest_material(density, severity):
    found = told(thing(block(density * LITRES / 1000.0)), "density_implausible")
    assert [str(item.severity) for item in found] == severity
    assert [item.value for item in found] == pytest.approx([density] * len(severity), rel=1e-3)


def test_hulls_cut_back_from_a_heavy_thing_do_not_condemn_it():
    """720 kg of steel in 144 visible litres: 5,000 kg/m3, but 40,000 in an eighth of them."""
    moved = block(720.0)
    cut = replace(moved, collisions=(box_shape((0, 0, 0), (0.15, 0.2, 0.6)),))
    assert severities(thing(cut), "density_implausible") == ["warning"]
    heavier = replace(cut, inertia=block(7200.0).inertia)
    assert severities(thing(heavier), "density_implausible") == ["error"]


def test_sheet_metal_without_thickness_is_no_impossible_density():
    """A square metre of 1 mm steel weighs 7.8 kg; its hull here is a tenth of that thick."""
    sheet = box_shape((0.0, 0.0, 0.0), (1.0, 1.0, 1e-4))
    inertia = LinkInertia(7.8, np.zeros(3), np.diag([0.65, 0.65, 1.29]))
    moved = Link("block", inertia, (sheet,), (sheet,))
    assert severities(thing(moved), "density_implausible") == ["warning"]


def test_what_moves_must_state_its_inertia():
    bare = replace(block(), inertia=None)
    assert severities(thing(bare), "missing_inertia") == ["error"]
    assert severities(thing(bare, kind="fixed"), "missing_inertia") == ["warning"]
    assert severities(replace(thing(bare), format="mjcf"), "missing_inertia") == []


def test_every_solid_link_of_a_moving_part_must_but_not_a_bare_frame():
    handle = replace(body("handle", [((0.0, 0.3, 0.0), (0.1,) * 3)]), inertia=None)
    frame = Link("frame", None, (), ())
    found = told(thing(block(), handle, frame), "missing_inertia")
    assert [(item.parts, str(item.severity)) for item in found] == [(("handle",), "error")]


def test_a_bare_frame_that_moves_by_itself_must_too():
    frame = Link("frame", None, (), ())
    found = told(thing(frame), "missing_inertia")
    assert [(item.parts, str(item.severity)) for item in found] == [(("frame",), "error")]


def test_without_a_tree_nobody_knows_what_moves():
    torn = replace(thing(block()), joints=())
    assert severities(with_link(torn, "block", inertia=None), "missing_inertia") == ["warning"]
