"""What opens is found from geometry alone and moves as such things do; what does not stays."""

import numpy as np
import pytest
import trimesh
from one_piece import mesh_of
from plain_solids import box_between as box
from plain_solids import carcass
from stated_parts import block

from asset_factory.factory.articulate.geometric import GeometricArticulator
from asset_factory.factory.articulation import JointKind, rotation_about
from asset_factory.factory.mesh import Mesh, concatenate
from asset_factory.learn.objects import make_object


def lathe(profile, center=(0.0, 0.0), axis=2):
    """A closed solid of revolution of (radius, height) pairs, about z or an axis at ``center``."""
    outline = [(0.0, profile[0][1]), *profile, (0.0, profile[-1][1])]
    made = trimesh.creation.revolve(np.array(outline), sections=24)
    turned = np.asarray(made.vertices)[:, {1: [1, 2, 0], 2: [0, 1, 2]}[axis]]
    turned[:, [other for other in range(3) if other != axis]] += center
    return Mesh.from_triangles(turned, made.faces)


def knob_at(x, y):
    return lathe([(0.025, 0.0501), (0.02, 0.08)], (x, y))


def disc_at(x):
    return lathe([(0.025, 0.0501), (0.025, 0.055)], (x, 0.06))


def tub(grip):
    """A drawer as one surface, open at the top; perhaps with a bump fused to its front."""
    solid = block((0.03, 0.0, 0.03), (0.57, 0.4, 0.15)) - block((0.04, 0.01, 0.04), (0.56, 0.39, 1))
    if grip:
        solid += block((0.25, -0.06, 0.08), (0.35, 0.01, 0.1))
    return mesh_of(solid, edge=1.0)


CARCASS = carcass(0.6, 0.5, 0.8)
DOOR = box((0.001, -0.02, 0.001), (0.599, -0.001, 0.799))
GRIP_RIGHT = box((0.54, -0.06, 0.3), (0.56, -0.021, 0.5))
GRIP_TOP = box((0.1, -0.06, 0.7), (0.5, -0.021, 0.72))
LOWER_DOOR = [
    box((0.001, -0.02, 0.001), (0.599, -0.001, 0.4)),
    box((0.54, -0.06, 0.15), (0.56, -0.021, 0.3)),
]
DRAWER = [
    box((0.001, -0.02, 0.402), (0.599, -0.001, 0.799)),
    box((0.25, -0.06, 0.59), (0.35, -0.021, 0.61)),
    box((0.03, -0.001, 0.45), (0.04, 0.45, 0.7)),
    box((0.56, -0.001, 0.45), (0.57, 0.45, 0.7)),
    box((0.04, -0.001, 0.44), (0.56, 0.45, 0.45)),
    box((0.04, 0.44, 0.45), (0.56, 0.45, 0.7)),
]
SHELVES = [
    box((0.03, -0.001, 0.1), (0.04, 0.45, 0.4)),
    box((0.56, -0.001, 0.1), (0.57, 0.45, 0.4)),
    box((0.04, -0.001, 0.1), (0.56, 0.45, 0.11)),
]
SHELVED_DOOR = [
    box((0.001, -0.03, 0.001), (0.599, -0.001, 0.799)),
    box((0.55, -0.06, 0.3), (0.565, -0.031, 0.5)),
]
BAR_ON_POSTS = [
    box((0.001, -0.02, 0.001), (0.399, -0.001, 0.399)),
    *(box((0.34, -0.09, z), (0.36, -0.021, z + 0.02)) for z in (0.08, 0.3)),
    box((0.335, -0.12, 0.06), (0.365, -0.089, 0.34)),
]
#: A room's door and its frame.
FRAME = [
    box((0.0, 0.0, 0.0), (0.06, 0.12, 2.1)),
    box((0.94, 0.0, 0.0), (1.0, 0.12, 2.1)),
    box((0.06, 0.0, 2.04), (0.94, 0.12, 2.1)),
]
LEAF = box((0.065, 0.01, 0.005), (0.935, 0.05, 2.035))
LEAVES = [box((x, 0.01, 0.005), (x + 0.434, 0.05, 2.035)) for x in (0.065, 0.501)]
KNOB = box((0.85, -0.04, 1.0), (0.9, 0.01, 1.05))
#: A case whose door closes it, and a plate that lies in it.
CASE = carcass(0.5, 0.4, 0.3)
CASE_DOOR = [
    box((0.001, -0.03, 0.001), (0.499, -0.001, 0.299)),
    box((0.45, -0.06, 0.05), (0.46, -0.031, 0.25)),
]
PLATE = lathe([(0.12, 0.03), (0.12, 0.035)], (0.25, 0.2))
TWO_PLATES = [lathe([(0.09, 0.03), (0.09, 0.035)], (x, 0.2)) for x in (0.13, 0.36)]
BOTTLE = lathe([(0.04, 0.0), (0.04, 0.2), (0.03, 0.22)])
CAP = lathe([(0.033, 0.215), (0.033, 0.25)])
POT = lathe([(0.15, 0.0), (0.15, 0.15)])
POT_LID = lathe([(0.14, 0.151), (0.13, 0.17), (0.02, 0.18), (0.02, 0.21)])
POST = lathe([(0.045, 0.0), (0.045, 0.1)])
LEVER = [lathe([(0.032, 0.1), (0.032, 0.14)]), box((0.03, -0.015, 0.105), (0.18, 0.015, 0.135))]
CART = [box((0.0, 0.0, 0.12), (0.8, 0.5, 0.16)), box((0.0, 0.0, 0.16), (0.03, 0.5, 0.8))]
WHEELS = {(x, y): lathe([(0.06, y), (0.06, y + 0.03)], (x, 0.06), axis=1)
          for y in (0.02, 0.45) for x in (0.1, 0.7)}  # fmt: skip
HOB = box((0.0, 0.0, 0.0), (0.6, 0.5, 0.05))
#: Axes of hinges at those edges and about the vertical, and the way of a drawer.
LEFT = (0, 0, -1)
RIGHT = UP = (0, 0, 1)
BELOW = (1, 0, 0)
OUT = (0, -1, 0)
#: What stays, and by joint what moves, its axis, and a point on that.
OPENS = {
    "a door, across from its handle": (
        CARCASS,
        {"door_0_hinge": ([DOOR, GRIP_RIGHT], LEFT, (0.001, -0.001, 0.0))},
    ),
    "a wide door with its handle at the top": (
        CARCASS,
        {"door_0_hinge": ([DOOR, GRIP_TOP], BELOW, (0.0, -0.001, 0.001))},
    ),
    "a drawer with its box, and a door": (
        CARCASS,
        {
            "drawer_0_slide": (DRAWER, OUT, None),
            "door_0_hinge": (LOWER_DOOR, LEFT, (0.001, -0.001, 0.0)),
        },
    ),
    "a drawer in one piece, with a grip": (
        carcass(0.6, 0.5, 0.2),
        {"drawer_0_slide": ([tub(grip=True)], OUT, None)},
    ),
    "a door with a bar on two posts": (
        carcass(0.4, 0.5, 0.4),
        {"door_0_hinge": (BAR_ON_POSTS, LEFT, (0.001, -0.001, 0.0))},
    ),
    "a door with a side handle before shelves": (
        [*CARCASS, *SHELVES],
        {"door_0_hinge": (SHELVED_DOOR, LEFT, (0.001, -0.001, 0.0))},
    ),
    "a room's door, to its flush side": (
        FRAME,
        {"door_0_hinge": ([LEAF, KNOB], LEFT, (0.065, 0.03, 0.0))},
    ),
    "two leaves, away from each other": (
        FRAME,
        {
            "door_0_hinge": (LEAVES[:1], LEFT, (0.065, 0.03, 0.0)),
            "door_1_hinge": (LEAVES[1:], RIGHT, (0.935, 0.03, 0.0)),
        },
    ),
    "the cap of a bottle": ([BOTTLE], {"cap_0_turn": ([CAP], UP, (0.0, 0.0, 0.0))}),
    "the lid of a pot": ([POT], {"lid_0_slide": ([POT_LID], UP, None)}),
    "a lever on a round body": ([POST], {"lever_0_hinge": (LEVER, UP, (0.0, 0.0, 0.0))}),
    "a round plate in a closed case": (
        CASE,
        {
            "door_0_hinge": (CASE_DOOR, LEFT, (0.001, -0.001, 0.0)),
            "turntable_0_turn": ([PLATE], UP, (0.25, 0.2, 0.0)),
        },
    ),
    "no plates in a row": (
        [*CASE, *TWO_PLATES],
        {"door_0_hinge": (CASE_DOOR, LEFT, (0.001, -0.001, 0.0))},
    ),
    "the wheels of a cart": (
        CART,
        {
            f"wheel_{number}_turn": ([wheel], (0, 1, 0), (x, 0.0, 0.06))
            for number, ((x, _), wheel) in enumerate(WHEELS.items())
        },
    ),
    "knobs in a row on a cooktop": (
        [HOB],
        {
            f"knob_{k}_turn": ([knob_at(0.1 * (k + 1), 0.06)], LEFT, (0.1 * (k + 1), 0.06, 0.0))
            for k in range(4)
        },
    ),
    "flat knobs with their bars": (
        [HOB],
        {
            f"knob_{k}_turn": (
                [disc_at(x), box((x - 0.004, 0.04, 0.055), (x + 0.004, 0.08, 0.075))],
                LEFT,
                (x, 0.06, 0.0),
            )
            for k, x in enumerate((0.1, 0.2, 0.3))
        },
    ),
}
TABLE = [
    box((0, 0, 0.7), (1.2, 0.8, 0.74)),
    *(box((x, y, 0), (x + 0.05, y + 0.05, 0.7)) for x in (0, 1.15) for y in (0, 0.75)),
    box((0.05, 0, 0.6), (1.15, 0.02, 0.7)),
    box((0.05, 0.78, 0.6), (1.15, 0.8, 0.7)),
]
CHAIR = [
    box((0, 0, 0.42), (0.45, 0.45, 0.46)),
    *(box((x, y, 0), (x + 0.04, y + 0.04, 0.42)) for x in (0, 0.41) for y in (0, 0.41)),
    box((0, 0.41, 0.46), (0.45, 0.45, 0.95)),
]
VASE = lathe([(0.08, 0.74), (0.1, 0.85), (0.05, 1.0)], (0.6, 0.4))
FEET = [lathe([(0.05, 0.0), (0.05, 0.1)], (x, y)) for x in (0.1, 0.7) for y in (0.1, 0.4)]
STAYS = {
    "a table": TABLE,
    "a chair": CHAIR,
    "an open shelf": [*CARCASS, box((0.02, 0.02, 0.4), (0.58, 0.48, 0.42))],
    "a rug": [box((0, 0, 0), (2, 1.4, 0.01)), box((0.1, 0.1, 0.01), (1.9, 1.3, 0.012))],
    "a vase on a table": [TABLE[0], box((0.5, 0.3, 0.0), (0.7, 0.5, 0.7)), VASE],
    "a round table": [lathe([(0.05, 0.0), (0.05, 0.7)]), lathe([(0.5, 0.7), (0.5, 0.73)])],
    "a plate on a board": [box((0, 0, 0), (0.5, 0.4, 0.02)), PLATE],
    "round feet": [box((0.0, 0.0, 0.1), (0.8, 0.5, 0.5)), *FEET],
    "round things strewn over a board": [
        HOB,
        *(knob_at(*at) for at in ((0.1, 0.1), (0.4, 0.15), (0.2, 0.35), (0.5, 0.42))),
    ],
    "flat discs on a cooktop": [HOB, *(disc_at(x) for x in (0.1, 0.2, 0.3))],
    "a picture on its back board": [
        box((0.0, 0.05, 0.0), (1.0, 0.07, 0.8)),
        box((0.1, 0.03, 0.1), (0.9, 0.05, 0.7)),
    ],
    "a leaf without a frame": [LEAF, KNOB],
    "a drawer in one piece without a grip": [
        *carcass(0.6, 0.5, 0.2),
        tub(grip=False),
    ],
}
KINDS = {"hinge": JointKind.REVOLUTE, "slide": JointKind.PRISMATIC, "turn": JointKind.CONTINUOUS}


def articulate(*meshes):
    return GeometricArticulator().articulate(concatenate(list(meshes)))


def only_joint(articulation):
    assert len(articulation.joints) == 1, articulation.notes
    return articulation.joints[0]


@pytest.mark.parametrize("name", OPENS)
def test_what_opens_moves_as_a_whole_about_its_axis(name):
    still, moving = OPENS[name]
    found = articulate(*still, *(mesh for own, *_ in moving.values() for mesh in own))
    assert {joint.name for joint in found.joints} == set(moving)
    first = sum(len(mesh.faces) for mesh in still)
    for joint_name, (own, axis, point) in moving.items():
        joint = found.joint(joint_name)
        assert joint.kind is KINDS[joint_name.rpartition("_")[2]]
        assert joint.axis == pytest.approx(axis, abs=1e-6)
        if point is not None:
            assert np.cross(joint.origin - point, axis) == pytest.approx(np.zeros(3), abs=1e-6)
        last = first + sum(len(mesh.faces) for mesh in own)
        assert np.array_equal(found.parts[joint.child].faces, np.arange(first, last))
        first = last


@pytest.mark.parametrize("name", STAYS)
def test_what_does_not_open_stays_rigid(name):
    articulation = articulate(*STAYS[name])
    assert [part.name for part in articulation.parts] == ["base"]
    assert len(articulation.notes) == 1


COLUMN = box((0.05, -0.5, 0.0), (0.15, -0.4, 0.8))


@pytest.mark.parametrize(
    ("meshes", "name", "upper", "within"),
    [
        ([*CARCASS, DOOR, GRIP_RIGHT], "door_0_hinge", np.pi / 2, 1e-6),
        ([*CARCASS, COLUMN, DOOR, GRIP_RIGHT], "door_0_hinge", 1.2, 0.3),
        ([*CARCASS, *DRAWER, *LOWER_DOOR], "drawer_0_slide", 0.92 * 0.451, 0.008),
        ([POT, POT_LID], "lid_0_slide", 0.03, 0.03),
    ],
)
def test_nothing_opens_further_than_it_can(meshes, name, upper, within):
    joint = articulate(*meshes).joint(name)
    assert joint.lower == 0.0 < joint.upper == pytest.approx(upper, abs=within)


@pytest.mark.parametrize(("thickness", "degrees"), [(0.06, 180.0), (0.02, 90.0)])
def test_a_thick_upright_door_opens_further_than_a_thin_one(thickness, degrees):
    door = box((0.001, -thickness, 0.001), (0.599, -0.001, 1.599))
    grip = box((0.53, -thickness - 0.04, 0.6), (0.55, -thickness - 0.001, 1.1))
    joint = only_joint(articulate(*carcass(0.6, 0.6, 1.6), door, grip))
    assert np.degrees(joint.upper) == pytest.approx(degrees, abs=5.0)


def test_guesses_are_said():
    leaves = (box((x, -0.02, 0.001), (x + 0.298, -0.001, 0.799)) for x in (0.001, 0.301))
    assert articulate(*CARCASS, *leaves).notes == (
        "door_0 has no handle; hinge side assumed left, away from its neighbour",
        "door_1 has no handle; hinge side assumed right, away from its neighbour",
    )
    assert articulate(BOTTLE, CAP).notes == (
        "cap_0 tops a round body; assumed to turn without end",
    )


@pytest.mark.parametrize("degrees", [90, 180, 270, 30])
def test_the_front_is_found_whichever_way_it_faces(degrees):
    mesh = concatenate([*CARCASS, DOOR, GRIP_RIGHT])
    turn = rotation_about([0, 0, 1], np.radians(degrees))
    at_rest = only_joint(GeometricArticulator().articulate(mesh))
    turned = only_joint(GeometricArticulator().articulate(mesh.turned(turn)))
    assert np.allclose(turned.axis, at_rest.axis)
    assert np.allclose(turned.origin[:2], (turn @ at_rest.origin)[:2], atol=1e-3)


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [
        (np.zeros((0, 3)), np.zeros((0, 3))),
        (np.zeros((6, 3)), [[0, 1, 2], [3, 4, 5]]),
        (np.eye(3)[[0, 1, 2, 0, 1, 2]] + np.repeat([[0], [3]], 3, axis=0), [[0, 1, 2], [3, 4, 5]]),
        (np.random.default_rng(0).random((600, 3)), np.arange(600).reshape(-1, 3)),
    ],
    ids=["empty", "points", "flat", "soup"],
)
def test_any_mesh_gets_an_answer(vertices, faces):
    articulation = GeometricArticulator().articulate(Mesh.from_triangles(vertices, faces))
    assert articulation.joints == ()
    assert articulation.notes


@pytest.mark.parametrize("category", ["cabinet", "fridge", "oven", "microwave", "dishwasher"])
def test_generated_furniture_opens_as_it_was_made(category):
    truth = make_object(category, 1)
    found = articulate(truth.mesh)
    for joint in truth.movable_joints:
        faces = truth.parts[joint.child].faces
        if joint.name.startswith("pedal"):
            continue
        matches = [j for j in found.joints if _overlap(found.parts[j.child].faces, faces) > 0.5]
        assert len(matches) == 1, (joint.name, found.notes)
        assert (matches[0].kind is JointKind.PRISMATIC) == (joint.kind is JointKind.PRISMATIC)
        turn = 1.0 if joint.upper >= -joint.lower else -1.0
        assert matches[0].axis @ joint.axis * turn > 0.99
    # The generator's microwave ovens have plates that stay, real ones turn theirs.
    opening = [j for j in found.joints if not j.name.startswith("turntable")]
    assert len(opening) <= len(truth.movable_joints)


def _overlap(a, b):
    return len(np.intersect1d(a, b)) / max(len(np.union1d(a, b)), 1)
