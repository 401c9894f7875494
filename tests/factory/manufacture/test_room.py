"""Hulls fill what matters to nobody, and never where another part is or passes."""

import numpy as np
import pytest
import trimesh
from held_parts import held
from manufactured import decomposed

from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.config import DecomposeConfig
from asset_factory.factory.manufacture.decompose.convex import depth_below
from asset_factory.factory.manufacture.decompose.decompose import error_for

CONFIG = DecomposeConfig(resolution=300, iterations=20, nodes=5)


def box(size, at):
    return trimesh.creation.box(size).apply_translation(at)


def two_parts(fixed, moving, upper=0.2):
    """The second part slides along +x."""
    slide = Joint("slide", JointKind.PRISMATIC, 0, 1, [1, 0, 0], np.zeros(3), 0.0, upper)
    return held([fixed], [moving], slide)


def grooved():
    """A plate of 2 m with a groove along x, 60 mm wide and 9 mm deep, in its top at z = 0."""
    plate = box((1.0, 2.0, 0.05), (0.5, 0.0, -0.025))
    groove = box((1.2, 0.06, 0.018), (0.5, 0.0, 0.0))
    return trimesh.boolean.difference([plate, groove], engine="manifold")


def deepest(result, points):
    return max(float(depth_below(hull, np.asarray(points)).max()) for hull in result.hulls)


IN_GROOVE = [[x, 0.0, -0.003] for x in np.linspace(0.05, 0.95, 10)]


def test_a_shallow_groove_of_a_large_part_is_filled_where_nobody_is():
    elsewhere = two_parts(grooved(), box((0.05, 0.05, 0.05), (0.5, 0.0, 0.5)))
    assert error_for(elsewhere.part_mesh(0), CONFIG) == pytest.approx(0.012)
    fixed = decomposed(elsewhere, CONFIG)[0]
    assert len(fixed.hulls) == 1
    assert deepest(fixed, IN_GROOVE) > 0.0


def test_a_groove_that_another_part_runs_in_stays_open_all_its_way():
    # A tongue, at one end of the groove at rest, that slides to the other.
    tongue = box((0.1, 0.05, 0.05), (0.06, 0.0, 0.018))
    fixed = decomposed(two_parts(grooved(), tongue, upper=0.85), CONFIG)[0]
    assert deepest(fixed, IN_GROOVE) < 0.001


def cap(radius=0.04, height=0.025):
    """A round cap with its opening down."""
    made = trimesh.creation.cylinder(radius, height, sections=24)
    made.update_faces(~(made.vertices[made.faces][:, :, 2] < 0.0).all(axis=1))
    return made


def test_a_knob_with_a_shaft_in_it_keeps_its_hollow():
    plate = box((0.5, 0.5, 0.02), (0, 0, -0.05))
    shaft = box((0.01, 0.01, 0.045), (0.0, 0.0, -0.0175))
    knob = decomposed(two_parts(trimesh.util.concatenate([plate, shaft]), cap()), CONFIG)[1]
    assert len(knob.hulls) > 1
    assert deepest(knob, [[0.0, 0.0, 0.0]]) < 0.0


@pytest.mark.parametrize(
    ("radius", "height", "turned", "filled"),
    [
        (0.04, 0.025, False, True),
        (0.2, 0.025, False, True),
        (0.2, 0.025, True, False),
        (0.04, 0.6, True, False),
    ],
    ids=[
        "a knob",
        "a tray upside down",
        "a tray",
        "a bottle, whose mouth is a fiftieth of its surface",
    ],
)
def test_what_is_open_towards_the_top_holds_things(radius, height, turned, filled):
    vessel = cap(radius, height)
    if turned:
        vessel.apply_transform(trimesh.transformations.rotation_matrix(np.pi, [1, 0, 0]))
    part = decomposed(two_parts(box((0.5, 0.5, 0.02), (0, 0, -0.5)), vessel), CONFIG)[1]
    assert (part.method == "single") is filled
    assert (deepest(part, [[0.0, 0.0, 0.0], [0.0, 0.0, height / 3.0]]) > 0.0) is filled


def test_the_gap_behind_a_handle_stays_open_on_a_large_door():
    # 16 mm wide: a finger gets in.
    door = box((2.0, 0.05, 1.0), (0.0, 0.0, 0.0))
    bar = box((0.02, 0.02, 0.2), (0.8, -0.051, 0.0))
    feet = [box((0.02, 0.016, 0.02), (0.8, -0.033, z)) for z in (-0.09, 0.09)]
    whole = trimesh.boolean.union([door, bar, *feet], engine="manifold")
    part = decomposed(two_parts(box((0.1, 0.1, 0.1), (0, 3, 0)), whole), CONFIG)[1]
    assert deepest(part, [[0.8, -0.033, 0.0]]) < 0.0
