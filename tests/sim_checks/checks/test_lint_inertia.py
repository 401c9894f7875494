"""From which degree on masses, centres of mass and missing inertias reject."""

from dataclasses import replace

import numpy as np
import pytest
from box_world import body, box_shape, described, joint, linted

from asset_factory.sim_checks.description import Link, LinkInertia

#: Of a block of 0.144 m3, its diagonal 1.3 m.
SIZE = (0.3, 0.4, 1.2)
VOLUME = 0.144
DIAGONAL = 1.3


def block(mass=50.0, center=(0.0, 0.0, 0.0), **changes):
    inertia = LinkInertia(mass, np.array(center), mass * np.diag([1.6, 1.53, 0.25]) / 12.0)
    return replace(body("block", [((0.0, 0.0, 0.0), SIZE)]), **{"inertia": inertia, **changes})


def thing(moved, *more, kind="prismatic"):
    """A post, what slides on it, and what is fixed to that."""
    links = [body("post", [((0.0, -1.0, 0.0), (0.5,) * 3)]), moved, *more]
    joints = [joint("slide", kind, "post", moved.name, (0.0,) * 3, (1, 0, 0), (0.0, 0.3))]
    joints += [
        joint(f"{link.name}_fixed", "fixed", moved.name, link.name, (0,) * 3, (1, 0, 0), None)
        for link in more
    ]
    return described(links, joints)


def beside(outside):
    """The block with its centre so much of its diagonal outside of it."""
    return block(center=(0.15 + outside * DIAGONAL, 0.0, 0.0))


def crumb(outside):
    """A cube of 3 cm with its centre so far outside of it [m]."""
    small = body("block", [((0.0, 0.0, 0.0), (0.03, 0.03, 0.03))])
    center = np.array([0.015 + outside, 0.0, 0.0])
    return replace(small, inertia=replace(small.inertia, center=center))


OUTSIDE = block(center=(0.5, 0.0, 0.0))
LEG = box_shape((0.5, 0.0, 0.0), (0.8, 0.1, 0.1))


#: An eighth of the block, as hulls that are cut back leave it.
CUT = (box_shape((0.0, 0.0, 0.0), (0.15, 0.2, 0.6)),)
#: A square metre of 1 mm steel weighs 7.8 kg; its hull here is a tenth of that thick.
SHEET = (box_shape((0.0, 0.0, 0.0), (1.0, 1.0, 1e-4)),)
STEEL = LinkInertia(7.8, np.zeros(3), np.diag([0.65, 0.65, 1.29]))


@pytest.mark.parametrize(
    ("moved", "code", "severity", "value"),
    [
        (beside(0.049), "center_outside", None, None),
        (beside(0.051), "center_outside", "warning", 51 * DIAGONAL),
        (beside(0.099), "center_outside", "warning", 99 * DIAGONAL),
        (beside(0.101), "center_outside", "error", 101 * DIAGONAL),
        # Of a thing of centimetres, ten millimetres are a warning.
        (crumb(0.009), "center_outside", "warning", 9.0),
        (crumb(0.011), "center_outside", "error", 11.0),
        # A centre within what is only visible is inside.
        (OUTSIDE, "center_outside", "error", 350.0),
        (replace(OUTSIDE, visuals=(*OUTSIDE.visuals, LEG)), "center_outside", None, None),
        (block(0.04 * VOLUME), "density_implausible", "error", 0.04),
        (block(0.06 * VOLUME), "density_implausible", "warning", 0.06),
        (block(6.0 * VOLUME), "density_implausible", None, None),
        (block(11_900.0 * VOLUME), "density_implausible", None, None),
        (block(12_100.0 * VOLUME), "density_implausible", "warning", 12_100.0),
        (block(22_500.0 * VOLUME), "density_implausible", "warning", 22_500.0),
        (block(22_700.0 * VOLUME), "density_implausible", "error", 22_700.0),
        # An eighth of what is visible: 40,000 kg/m3, but 5,000 where there is room.
        (block(720.0, collisions=CUT), "density_implausible", "warning", 5000.0),
        (block(7200.0, collisions=CUT), "density_implausible", "error", 50_000.0),
        (Link("block", STEEL, SHEET, SHEET), "density_implausible", "warning", 7800.0),
    ],
)
def test_a_centre_of_mass_or_a_density_rejects_from_a_degree_on(moved, code, severity, value):
    found = [(str(item.severity), item.value) for item in linted(thing(moved), code)]
    assert found == ([(severity, pytest.approx(value, rel=1e-3))] if severity else [])


BARE = block(inertia=None)
FRAME = Link("frame", None, (), ())
HANDLE = replace(body("handle", [((0.0, 0.3, 0.0), (0.1,) * 3)]), inertia=None)


@pytest.mark.parametrize(
    ("built", "severity", "parts"),
    [
        (thing(BARE), "error", ("block",)),
        (thing(BARE, kind="fixed"), "warning", ("block",)),
        (replace(thing(BARE), format="mjcf"), None, None),
        (thing(block(), HANDLE, FRAME), "error", ("handle",)),
        (thing(FRAME), "error", ("frame",)),
        (replace(thing(BARE), joints=()), "warning", ("block",)),
    ],
    ids=["what moves", "what does not", "an MJCF", "a solid link of a moving part",
         "a bare frame that moves by itself", "without a tree nobody knows what moves"],
)  # fmt: skip
def test_what_moves_must_state_its_inertia(built, severity, parts):
    found = [(str(item.severity), item.parts) for item in linted(built, "missing_inertia")]
    assert found == ([(severity, parts)] if severity else [])
