"""Files that can be read and say something no sound asset says: joints, masses, shapes."""

import numpy as np
import trimesh

from asset_factory.learn.objects.kit.axes import Y
from asset_factory.learn.objects.kit.shapes import prism

from .broken_files import HULL, MJCF, SHAPE, URDF, in_urdf
from .exhibits import both, edited, filed, listed, restated, reworked, urdf
from .good_things import cabinet, kiosk
from .things import box, obj, with_body, with_move

LID = '<link name="lid">'
DOOR_MASS = ".//link[@name='door']/inertial/mass"
DOOR_TENSOR = ".//link[@name='door']/inertial/inertia"
SLIDE = ".//joint[@name='slide']"
LIMIT = f"{SLIDE}/limit"
HINGE = ".//joint[@name='hinge']"
DOOR_CENTER = ".//link[@name='door']/inertial/origin"
DOOR_BODY = ".//body[@name='door']/inertial"
#: 15 % of the door's diagonal before it.
OUTSIDE = "0.3 0.105 0"
#: What engines make of some of these, in their own codes.
HELD = {
    "planar_joint.urdf": {"mujoco": "joint_missing"},
    "limits_swapped.urdf": {"mujoco": "limit_mismatch"},
    "inertia_zero.urdf": {"sapien": "mass_mismatch"},
    "needle_inertia.urdf": {"pybullet": "inertia_mismatch"},
}
STATED = '<limit lower="0.0" upper="0.3" effort="50" velocity="2"/>'
DOOR_FRAME = np.array([-0.3, -0.004, 0.5])


def _touched(*pieces, seen=None):
    """The kiosk with other hulls of its door, and other looks."""
    return with_body(kiosk(), "door", pieces=pieces, looks=(DOOR if seen is None else seen,))


def _wedge(corners, share):
    """A panel that gets thinner along x, to nothing at this share of its width, [8, 3]."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    end = corners[:, 0] > low[0]
    wedge = corners.copy()
    wedge[end, 0] = low[0] + share * (high[0] - low[0])
    wedge[end, 1] = (low[1] + high[1]) / 2.0
    return wedge


def _weighing(mass):
    """The kiosk with a door of 4.3 litres that weighs so much [kg]."""
    return with_body(kiosk(), "door", mass=mass)


def _sliding(**limits):
    """The kiosk with other limits of its drawer."""
    return urdf(with_move(kiosk(), "slide", **limits))


def _bare(build, element):
    """The kiosk with no inertial in that link or body."""
    return reworked(build, element, lambda found: found.remove(found.find("inertial")))


def _dynamics(attributes):
    return edited(URDF, ("<limit ", f"<dynamics {attributes}/><limit "))


def _mimic(leader, more=""):
    return edited(URDF, ("<limit ", f'<mimic joint="{leader}" {more}/><limit '))


def _imported(height):
    door = kiosk().bodies[2].pieces
    below = tuple(np.add(piece, (0.0, -height, 0.0)) for piece in door)
    return with_body(kiosk(), "door", pieces=below, looks=door)


def _filled_drawer():
    thing = cabinet()
    tub = thing.bodies[1].pieces
    return with_body(thing, "drawer", pieces=(np.vstack(tub[:-1]), tub[-1]), looks=tub)


#: A door with a deep notch in its upper edge: closed, and not convex. Its ends are fans about the
#: notch, the first corner.
NOTCH = [(0.3, -0.1), (0.0, 0.198), (0.0, -0.198), (0.6, -0.198), (0.6, 0.198)]
NOTCHED = prism(NOTCH, (-0.018, 0.0), Y)
SECOND = '<joint name="more" type="fixed"><parent link="drawer"/><child link="door"/></joint>'
LOOP = '<link name="a"/><link name="b"/>' + "".join(
    f'<joint name="{a}{b}" type="fixed"><parent link="{a}"/><child link="{b}"/></joint>'
    for a, b in ("ab", "ba")
)
NEEDLE = {"ixx": "0.9", "iyy": "0.01", "izz": "0.01", "ixy": "0", "ixz": "0", "iyz": "0"}
ZERO = dict.fromkeys(NEEDLE, "0")
HOUSE = {"ixx": "9", "iyy": "9", "izz": "9"}
WIDE = {"ixx": "0.176", "iyy": "0.35", "izz": "0.176"}
FIXED = (('"prismatic"', '"fixed"'), ('"revolute"', '"fixed"'))
DOOR = kiosk().bodies[2].pieces[0]
MIDDLE = (DOOR.min(axis=0) + DOOR.max(axis=0)) / 2.0
SCALED = f'{SHAPE[:-2]} scale="1e3 1e3 1e3"/>'
FLAT = obj(
    DOOR * [1.0, 0.0, 1.0] + [0.0, -0.013, 0.0] - DOOR_FRAME,
    np.array([[0, 1, 3], [0, 3, 2], [4, 5, 7]]),
)
SHORT = box((0.0, -0.013, 0.45), (0.6, 0.018, 0.29))
SHEET = box((0.0, -0.013, 0.5), (0.6, 0.006, 0.396))
THICK = box((0.0, -0.064, 0.5), (0.6, 0.12, 0.396))
THIN = box((0.0, -0.013, 0.5), (0.6, 0.002, 0.396))
CRUMBS = tuple(box((x, -0.013, 0.5), (0.008, 0.018, 0.396)) for x in np.linspace(-0.296, 0.296, 65))
BALL = trimesh.creation.icosphere(subdivisions=3, radius=0.05).vertices
ROUND = with_body(kiosk(), "door", pieces=(DOOR, np.add(BALL, (0.2, -0.08, 0.5))))
ERRORS = listed(
    ("two_roots.urdf", "not_a_tree", in_urdf(LID, f'<link name="loose"/>{LID}')),
    ("two_parents.urdf", "not_a_tree", in_urdf("</robot>", f"{SECOND}</robot>")),
    ("loop.urdf", "not_a_tree", in_urdf("</robot>", f"{LOOP}</robot>")),
    ("links_named_alike.urdf", "not_a_tree", in_urdf(LID, '<link name="door">')),
    ("parent_unknown.urdf", "not_a_tree", restated(URDF, f"{HINGE}/parent", link="wall")),
    ("joints_named_alike.urdf", "duplicate_name", in_urdf('"hinge" type', '"slide" type')),
    ("planar_joint.urdf", "unknown_joint_type", in_urdf('"prismatic"', '"planar"')),
    ("box_inside_out.urdf", "invalid_size", in_urdf(SHAPE, '<box size="-1 1 1"/>')),
    ("hinge_axis_of_length_2.urdf", "axis_not_unit", restated(URDF, f"{HINGE}/axis", xyz="0 0 -2")),
    ("axis_zero.urdf", "zero_axis", restated(URDF, f"{SLIDE}/axis", xyz="0 0 0")),
    ("no_limits.urdf", "missing_limits", edited(URDF, (STATED, ""))),
    ("limits_infinite.urdf", "limits_not_finite", restated(URDF, LIMIT, upper="inf")),
    ("limits_nan.urdf", "limits_not_finite", restated(URDF, LIMIT, lower="nan")),
    ("limits_swapped.urdf", "limits_not_ordered", _sliding(lower=0.3, upper=0.0)),
    ("limits_equal.urdf", "limits_not_ordered", _sliding(upper=0.0)),
    ("damping_negative.urdf", "invalid_dynamics", _dynamics('damping="-1"')),
    ("friction_nan.urdf", "invalid_dynamics", _dynamics('friction="nan"')),
    ("rusted.urdf", "friction_excessive", _dynamics('friction="10000"')),
    ("in_honey.urdf", "damping_excessive", _dynamics('damping="10000"')),
    ("mimic_to_nowhere.urdf", "mimic_unknown", _mimic("knob")),
    ("mimic_of_itself.urdf", "mimic_unknown", _mimic("slide")),
    ("mimic_not_finite.urdf", "mimic_not_finite", _mimic("flap", 'multiplier="inf"')),
    ("needle_inertia.urdf", "inertia_triangle", restated(URDF, DOOR_TENSOR, **NEEDLE)),
    ("inertia_indefinite.urdf", "inertia_not_positive", restated(URDF, DOOR_TENSOR, ixy="5")),
    ("inertia_zero.urdf", "inertia_not_positive", restated(URDF, DOOR_TENSOR, **ZERO)),
    ("inertia_nan.urdf", "inertia_not_finite", restated(URDF, DOOR_TENSOR, ixx="nan")),
    ("inertia_of_a_house.urdf", "inertia_impossible", restated(URDF, DOOR_TENSOR, **HOUSE)),
    ("mass_infinite.urdf", "inertia_not_finite", restated(URDF, DOOR_MASS, value="inf")),
    ("mass_negative.urdf", "mass_not_positive", restated(URDF, DOOR_MASS, value="-2.5")),
    ("mass_zero.urdf", "mass_not_positive", restated(URDF, DOOR_MASS, value="0")),
    ("door_of_a_milligram.urdf", "density_implausible", urdf(_weighing(1e-6))),
    ("center_elsewhere.urdf", "center_outside", restated(URDF, DOOR_CENTER, xyz="0 1.4 0")),
    ("center_105_mm_out.urdf", "center_outside", restated(URDF, DOOR_CENTER, xyz=OUTSIDE)),
    ("center_105_mm_out.mjcf", "center_outside", restated(MJCF, DOOR_BODY, pos=OUTSIDE)),
    ("door_without_inertia.urdf", "missing_inertia", _bare(URDF, ".//link[@name='door']")),
    ("collision_in_millimetres.urdf", "collision_scale", in_urdf(SHAPE, SCALED)),
    ("flat_collision.urdf", "degenerate_collision", filed(URDF, {HULL: FLAT})),
    ("collision_too_short.urdf", "collision_gap", urdf(_touched(SHORT))),
    ("collision_shrunk.urdf", "collision_gap", urdf(_touched(0.3 * DOOR + 0.7 * MIDDLE))),
    ("collision_knife_edge.urdf", "collision_gap", urdf(_touched(_wedge(SHEET, 0.5), seen=SHEET))),
    engines=HELD,
)
#: Reported, and no reason to reject.
WARNINGS = listed(
    ("stiff_damping.urdf", "damping_stiff", _dynamics('damping="850"')),
    ("no_effort.urdf", "invalid_effort", restated(URDF, LIMIT, effort="0")),
    ("zero_outside.urdf", "zero_outside_limits", _sliding(lower=0.05)),
    ("nothing_moves.urdf", "no_moving_joint", edited(URDF, *FIXED, count=-1)),
    ("follower_too_short.urdf", "mimic_limits", _mimic("flap", 'multiplier="1"')),
    ("heavier_than_lead.urdf", "density_implausible", urdf(_weighing(80.0))),
    ("lighter_than_air.urdf", "density_implausible", urdf(_weighing(0.001))),
    ("inertia_of_a_gate.urdf", "inertia_implausible", restated(URDF, DOOR_TENSOR, **WIDE)),
    ("center_40_mm_out.urdf", "center_outside", restated(URDF, DOOR_CENTER, xyz="0.3 0.04 0")),
    ("no_inertia_of_the_base.urdf", "missing_inertia", _bare(URDF, "link[@name='carcass']")),
    ("sheet_metal.urdf", "oblong_hull", urdf(_touched(THIN, seen=THIN))),
    ("crumbs.urdf", "many_hulls", urdf(_touched(*CRUMBS))),
    ("round_knob.urdf", "many_hull_vertices", urdf(ROUND)),
    ("notched_mesh.urdf", "nonconvex_collision", filed(URDF, {HULL: obj(*NOTCHED)})),
    ("collision_too_thick.urdf", "collision_gap", urdf(_touched(THICK))),
    severity="warning",
)
BROKEN = (
    *ERRORS,
    *both("no_collision", _touched(), "no_collision"),
    *both("offset_collision", _imported(0.15), "collision_offset"),
    *both("denser_than_osmium", _weighing(100.0), "density_implausible"),
    *both("filled_drawer", _filled_drawer(), "interior_filled"),
    *WARNINGS,
)
#: Close to the faults above and none.
SOUND = (
    *both("steel_door", _weighing(33.0), None),
    *listed(
        ("center_at_the_edge.urdf", None, restated(URDF, DOOR_CENTER, xyz="0.3 0.01 0")),
        ("axis_that_mujoco_normalises.mjcf", None, restated(MJCF, HINGE, axis="0 0 -2")),
        ("inertia_that_mujoco_computes.mjcf", None, _bare(MJCF, ".//body[@name='door']")),
    ),
)
