"""The generator: exact ground truth, nothing interpenetrates, same seed same bytes; varied."""

import hashlib
import io
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from manifold3d import Error, Manifold, Mesh64, OpType
from PIL import Image

from asset_factory.factory.articulation import JointKind
from asset_factory.factory.geometry.triangles import face_areas
from asset_factory.learn.objects import make_object
from asset_factory.learn.objects.catalog import CATEGORIES, DEMO_CATEGORIES
from asset_factory.learn.objects.kit.looks import wood

EXAMPLES = Path(__file__).parents[3] / "examples" / "meshes"
#: Of every file in the folder of demo meshes, its name and its bytes.
DIGEST = "55b135de42397744bc1896a5c9fa7b538a6e3d32c8577aa308a2a30fc350c691"
#: What objects promise [m]: overlaps at most, and gaps of the demo's at least.
OVERLAP_M = 0.0005
CLEARANCE_M = 0.0009
#: What lies on what: whoever opens the first takes the second along, so the two are not kept apart.
LIES_UNDER = {("seat", "lid"), ("magazine", "cover"), ("flap_x", "flap_y")}
TO_THE_FRONT = ("door_", "flap_", "drawer_", "inner_")
#: What slides aside, swings both ways or opens upwards instead.
OTHERWISE = ("sliding_door", "window", "swing_bin", "push_bin", "flap_box")


def pieces_of(mesh):
    """One solid for each set of faces that share vertices; each is closed and faces outwards."""
    whole = Manifold(Mesh64(np.array(mesh.vertices), mesh.faces.astype(np.uint64)))
    assert whole.status() == Error.NoError
    pieces = whole.decompose()
    assert all(piece.volume() > 0.0 for piece in pieces)
    return pieces


def united(mesh):
    """All pieces of a mesh as one solid; an empty one of a mesh without faces."""
    return Manifold.batch_boolean(pieces_of(mesh), OpType.Add) if len(mesh.faces) else Manifold()


def depth(overlap):
    """How thick an overlap is: a plate of thickness t has 2 V / A of nearly t."""
    pieces = [piece for piece in overlap.decompose() if piece.surface_area() > 0]
    return max((2 * piece.volume() / piece.surface_area() for piece in pieces), default=0.0)


def kept_apart(one, other):
    """Whether two solids need be compared: their boxes meet, and neither lies on the other."""
    (name, solid), (other_name, other_solid) = one, other
    low, high = (np.reshape(each.bounding_box(), (2, 3)) for each in (solid, other_solid))
    pairs = LIES_UNDER | {pair[::-1] for pair in LIES_UNDER}
    lies = any(name.startswith(a) and other_name.startswith(b) for a, b in pairs)
    return not lies and bool((low[0] <= high[1]).all() and (high[0] <= low[1]).all())


def rest_of_others(articulation, name):
    """Everything closed; for what lies behind a door, the doors open."""
    if not name.startswith("inner_"):
        return {}
    return {j.name: j.upper for j in articulation.joints if "door" in j.name or "flap" in j.name}


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("category", CATEGORIES)
def test_parts_never_meet_anywhere_along_a_joint(category, seed):
    articulation = make_object(category, seed)
    demo = category in DEMO_CATEGORIES
    names = [part.name for part in articulation.parts]
    solids = [united(articulation.part_mesh(i)) for i in range(len(names))]
    for joint in articulation.movable_joints:
        moving = articulation.carried(joint.child)
        others = rest_of_others(articulation, joint.name)
        for value in np.linspace(joint.lower, joint.upper, 17 if demo else 9):
            poses = articulation.poses(others | {joint.name: float(value)})
            moved = (solid.transform(pose[:3]) for solid, pose in zip(solids, poses, strict=True))
            placed = list(zip(names, moved, strict=True))
            for i in moving:
                for k in set(range(len(solids))).difference(moving):
                    where = (joint.name, float(value), names[i], names[k])
                    if demo:
                        assert placed[i][1].min_gap(placed[k][1], 0.005) > CLEARANCE_M, where
                    if kept_apart(placed[i], placed[k]):
                        assert depth(placed[i][1] ^ placed[k][1]) < OVERLAP_M, where


@pytest.mark.parametrize("category", CATEGORIES)
def test_objects_stand_on_the_ground_over_the_origin_and_open_towards_the_front(category):
    for seed in range(4):
        articulation = make_object(category, seed)
        low, high = articulation.mesh.bounds
        np.testing.assert_allclose([low[2], *(low + high)[:2]], 0.0, atol=1e-9)
        assert 0.02 < (high - low).max() < 4.5
        for joint in articulation.movable_joints:
            assert joint.lower <= 0.0 < joint.upper
            if joint.kind is JointKind.CONTINUOUS:
                assert (joint.lower, joint.upper) == (-np.pi, np.pi)
            demo = category in DEMO_CATEGORIES
            aside = category in OTHERWISE or "handle" in joint.name
            ahead = joint.name.startswith(TO_THE_FRONT) and not aside
            if ahead or demo:
                assert joint.lower == 0.0
            if ahead or (demo and not joint.name.startswith(("knob", "pedal"))):
                rest = articulation.part_mesh(joint.child).vertices
                motion = joint.motion(0.5 * joint.upper)
                moved = rest @ motion[:3, :3].T + motion[:3, 3]
                opens_ahead = moved[:, 1].min() < rest[:, 1].min() - 0.01
                opens_up = moved[:, 2].max() > rest[:, 2].max() + 0.01
                assert opens_ahead or (demo and opens_up), (category, seed, joint.name)


@pytest.mark.parametrize("category", DEMO_CATEGORIES)
def test_every_component_is_a_closed_convex_solid_with_corners_of_its_own(category):
    mesh = make_object(category, 0).mesh
    for solid in pieces_of(mesh):
        assert solid.hull().volume() == pytest.approx(solid.volume(), rel=1e-9)
    assert len(np.unique(np.round(mesh.vertices, 6), axis=0)) == len(mesh.vertices)


# The opening of a swing bin's hood is cut into needles.
@given(st.integers(0, 2**31), st.sampled_from([name for name in CATEGORIES if name != "swing_bin"]))
@settings(max_examples=150, deadline=None)
def test_any_seed_gives_an_object_without_a_face_of_no_area(seed, category):
    articulation = make_object(category, seed)
    assert face_areas(articulation.mesh).min() > 5e-11
    assert articulation.movable_joints


LAYOUTS = {"toilet": 5, "faucet": 8, "office_chair": 4, "toaster": 8}
LAYOUTS |= dict.fromkeys(("switch_panel", "coffee_machine", "storage_unit"), 20)


@pytest.mark.parametrize(("category", "count"), LAYOUTS.items())
def test_a_category_has_many_layouts(category, count):
    made = [make_object(category, seed) for seed in range(40)]
    assert len({tuple((j.kind, j.parent) for j in each.joints) for each in made}) >= count


@pytest.mark.parametrize(("category", "part"), [("safe", "door"), ("door", "door_0")])
def test_what_sits_on_a_door_moves_with_it(category, part):
    nested = 0
    for seed in range(10):
        articulation = make_object(category, seed)
        names = [p.name for p in articulation.parts]
        nested += sum(joint.parent == names.index(part) for joint in articulation.joints)
    assert nested >= 5


def test_a_desk_lamp_is_a_chain_and_a_castor_carries_its_wheel():
    lamp = make_object("desk_lamp", 0)
    assert lamp.parts[lamp.joint("shade_joint").parent].name.startswith("arm_")
    chairs = [make_object("office_chair", seed) for seed in range(8)]
    on_castors = [chair for chair in chairs if len(chair.joints) > 8]
    assert on_castors
    for chair in on_castors:
        for joint in chair.joints:
            if joint.name.startswith("castor") and joint.name.endswith("_wheel_joint"):
                assert joint.name == f"{chair.parts[joint.parent].name}_wheel_joint"
                assert abs(joint.axis[2]) < 1e-12


def test_screw_caps_turn_and_lift():
    kinds = [{j.kind for j in make_object("bottle", seed).joints} for seed in range(12)]
    assert {JointKind.CONTINUOUS, JointKind.PRISMATIC} in kinds


def test_an_object_takes_milliseconds():
    took = []
    for category in CATEGORIES:
        start = time.process_time()
        make_object(category, 0)
        took.append(time.process_time() - start)
    assert np.median(took) < 0.015


def test_a_cabinet_has_doors_and_drawers():
    for seed in range(6):
        kinds = {joint.kind for joint in make_object("cabinet", seed).joints}
        assert kinds == {JointKind.REVOLUTE, JointKind.PRISMATIC}


def test_same_seed_same_object_and_other_seed_another():
    for category in CATEGORIES:
        one, again, other = (make_object(category, seed) for seed in (3, 3, 4))
        np.testing.assert_array_equal(one.mesh.vertices, again.mesh.vertices)
        np.testing.assert_array_equal(one.mesh.faces, again.mesh.faces)
        assert [j.upper for j in one.joints] == [j.upper for j in again.joints]
        assert not np.array_equal(one.mesh.vertices, other.mesh.vertices)


def test_an_unknown_category_names_the_known_ones():
    with pytest.raises(ValueError, match="want one of cabinet, fridge"):
        make_object("sofa", 0)
    with pytest.raises(ValueError, match="at least 0"):
        make_object("oven", -1)


def test_the_texture_is_a_valid_png_of_the_stated_size():
    with Image.open(io.BytesIO(wood(3, size=32).texture.data)) as image:
        image.load()
        assert (image.format, image.mode, image.size) == ("PNG", "RGB", (32, 32))


def test_the_shipped_demo_meshes_are_fixed_data():
    """An earlier version of the generator made them; a demo of other meshes is another demo."""
    meshes = {path.stem for path in EXAMPLES.iterdir() if path.suffix in (".glb", ".obj")}
    assert meshes == set(DEMO_CATEGORIES)
    digest = hashlib.sha256()
    for path in sorted(EXAMPLES.iterdir()):
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    assert digest.hexdigest() == DIGEST
