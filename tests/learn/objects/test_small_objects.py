"""Small and odd objects: closed solids, nothing interpenetrates, same seed same bytes; varied."""

import numpy as np
import pytest
from solid_pieces import united

from asset_factory.factory.articulation import JointKind
from asset_factory.learn.objects.catalog import DEMO_CATEGORIES
from asset_factory.learn.objects.kinds import (
    bins,
    boxes,
    carts,
    coffee,
    fans,
    fittings,
    gadgets,
    hand_tools,
    lamps,
    screens,
    seats,
    vessels,
)
from asset_factory.learn.objects.kit.assembly import Assembly

FILES = (
    bins, boxes, carts, coffee, fans, fittings, gadgets, hand_tools, lamps, screens, seats, vessels,
)  # fmt: skip
MAKERS = {
    name: maker
    for file in FILES
    for name, maker in file.MAKERS.items()
    if name not in DEMO_CATEGORIES
}
#: What lies on what: whoever opens the first takes the second along, so the two are not kept apart.
LIES_UNDER = {"seat": ("lid",), "magazine": ("cover",), "flap_x": ("flap_y",)}
#: Shared volume that is rounding [m3].
TOUCH_M3 = 1e-10


def made(category, seed):
    assembly = Assembly(np.random.default_rng([7, seed]))
    MAKERS[category](assembly)
    return assembly.articulation()


def kept_apart(one, other):
    pairs = ((one, other), (other, one))
    return not any(
        a.startswith(low) and b.startswith(up)
        for low, ups in LIES_UNDER.items()
        for up in ups
        for a, b in pairs
    )


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("category", MAKERS)
def test_parts_never_meet_anywhere_along_a_joint(category, seed):
    articulation = made(category, seed)
    names = [part.name for part in articulation.parts]
    shapes = [united(articulation.part_mesh(i)) for i in range(len(names))]
    for joint in articulation.movable_joints:
        for value in np.linspace(joint.lower, joint.upper, 9):
            poses = articulation.poses({joint.name: float(value)})
            still = [np.allclose(pose, np.eye(4)) for pose in poses]
            placed = [shape.transform(pose[:3]) for shape, pose in zip(shapes, poses, strict=True)]
            for i in np.flatnonzero(~np.array(still)):
                for k in np.flatnonzero(still):
                    if kept_apart(names[i], names[k]):
                        assert (placed[i] ^ placed[k]).volume() < TOUCH_M3, (
                            joint.name,
                            value,
                            names[i],
                            names[k],
                        )


@pytest.mark.parametrize("category", MAKERS)
def test_objects_stand_on_the_ground_over_the_origin_with_ordered_limits(category):
    for seed in range(4):
        articulation = made(category, seed)
        low, high = articulation.mesh.bounds
        assert low[2] == 0.0
        np.testing.assert_allclose((low + high)[:2], 0.0, atol=1e-9)
        assert 0.02 < articulation.mesh.extents.max() < 2.5
        assert articulation.movable_joints
        for joint in articulation.movable_joints:
            assert joint.lower <= 0.0 <= joint.upper
            if joint.kind is JointKind.CONTINUOUS:
                assert (joint.lower, joint.upper) == (-np.pi, np.pi)


@pytest.mark.parametrize(
    ("category", "count"),
    [
        ("toilet", 5),
        ("faucet", 8),
        ("switch_panel", 20),
        ("coffee_machine", 20),
        ("office_chair", 4),
        ("toaster", 8),
    ],
)
def test_a_category_has_many_layouts(category, count):
    layouts = {tuple((j.kind, j.parent) for j in made(category, seed).joints) for seed in range(40)}
    assert len(layouts) >= count


def test_a_desk_lamp_is_a_chain_and_a_castor_carries_its_wheel():
    lamp = made("desk_lamp", 0)
    shade = lamp.joint("shade_joint")
    assert lamp.parts[shade.parent].name.startswith("arm_")
    chairs_on_castors = [
        c for c in (made("office_chair", s) for s in range(8)) if len(c.joints) > 8
    ]
    assert chairs_on_castors
    for chair in chairs_on_castors:
        for joint in chair.joints:
            if joint.name.startswith("castor") and joint.name.endswith("_wheel_joint"):
                fork = chair.parts[joint.parent].name
                assert joint.name == f"{fork}_wheel_joint"
                assert abs(joint.axis[2]) < 1e-12


def test_screw_caps_turn_and_lift():
    kinds = [{j.kind for j in made("bottle", seed).joints} for seed in range(12)]
    assert {JointKind.CONTINUOUS, JointKind.PRISMATIC} in kinds
