"""One-piece meshes: doors, drawers, flaps and lids read from their sides; what does not open."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from tests.samples import one_piece

from asset_factory.factory.articulate.seams import SeamsArticulator
from asset_factory.factory.articulation import JointKind, rotation_about
from asset_factory.factory.mesh import Mesh

UP = np.array([0.0, 0.0, 1.0])
HINGED = JointKind.REVOLUTE
SLIDES = JointKind.PRISMATIC
TURNS = JointKind.CONTINUOUS
#: What opens: kind, axis (sign matters: positive opens) and a point on the axis; the mirror is x.
OPENS = {
    "fridge": [(HINGED, (0, 0, 1), (0.6, 0, 0)), (HINGED, (0, 0, 1), (0.6, 0, 0))],
    "drawers": [(SLIDES, (0, -1, 0), None)] * 3,
    "doors": [(HINGED, (0, 0, -1), (0.03, 0, 0)), (HINGED, (0, 0, 1), (0.87, 0, 0))],
    "stove": [
        (HINGED, (1, 0, 0), (0, 0, 0.12)),
        *((TURNS, (0, 1, 0), (x, 0, 0.78)) for x in (0.28, 0.35, 0.42)),
    ],
    "chest": [(HINGED, (-1, 0, 0), (0, 0.5, 0.36))],
    "thick_doors": [(HINGED, (0, 0, -1), (0, 0, 0)), (HINGED, (0, 0, 1), (0.9, 0, 0))],
    "pair_with_level_bars": [(HINGED, (0, 0, -1), (0.03, 0, 0)), (HINGED, (0, 0, 1), (0.87, 0, 0))],
    "tall_drawers": [(SLIDES, (0, -1, 0), None)] * 3,
    "filing_cabinet": [(SLIDES, (0, -1, 0), None)] * 5,
    "microwave": [
        (HINGED, (0, 0, -1), (0.015, 0, 0)),
        *((TURNS, (0, 1, 0), (0.525, 0, z)) for z in (0.1, 0.16, 0.22)),
    ],
    "doors_with_grown_knobs": [
        (HINGED, (0, 0, -1), (0.03, 0, 0)),
        (HINGED, (0, 0, 1), (0.87, 0, 0)),
    ],
    "bar_across": [(HINGED, (1, 0, 0), (0, 0, 0))],
    "proud_drawers": [(SLIDES, (0, -1, 0), None)] * 2,
    "cooktop": [(TURNS, (0, 0, -1), (x, 0.06, 0)) for x in (0.2, 0.3, 0.4, 0.5)],
}
STAYS = ("plain_box", "table", "buttons", "moulding")
#: Turned so far about the vertical [degrees], then scaled along x, y and z.
PLACES = {
    "as modelled": (0.0, (1.0, 1.0, 1.0)),
    "a quarter, mirrored": (90.0, (-1.0, 1.0, 1.0)),
    "half, tiny": (180.0, (0.05, 0.05, 0.05)),
    "three quarters, huge": (270.0, (30.0, 30.0, 30.0)),
    "a little askew": (-7.0, (1.0, 1.0, 1.0)),
    "askew": (20.0, (1.0, 1.0, 1.0)),
    "far askew, mirrored": (40.0, (-1.0, 1.0, 1.0)),
}


@cache
def sample(name):
    mesh: Mesh = getattr(one_piece, name)()
    return mesh


def read(mesh):
    return SeamsArticulator().articulate(mesh)


def require(found, name, linear):
    """What opens is what was modelled, moved along by ``linear``, shape [3, 3]; none is certain."""
    assert all(0.0 < (part.confidence or 0.0) < 1.0 for part in found.parts[1:])
    assert all(0.0 < (joint.confidence or 0.0) < 1.0 for joint in found.joints)
    wanted = list(OPENS[name])
    assert len(found.joints) == len(wanted), found.joints
    mirrored = np.linalg.det(linear) < 0.0
    size = float(found.mesh.extents.max())
    for joint in found.joints:
        match = None
        for index, (kind, axis, point) in enumerate(wanted):
            along = linear @ np.array(axis, dtype=float) / np.cbrt(abs(np.linalg.det(linear)))
            if mirrored and kind is HINGED:
                along = -along
            if joint.kind is not kind or float(along @ joint.axis) < 0.99:
                continue
            if point is not None:
                off = joint.origin - linear @ np.array(point, dtype=float)
                off = off - (off @ joint.axis) * joint.axis
                if np.linalg.norm(off) > 0.03 * size:
                    continue
            match = index
        assert match is not None, joint
        wanted.pop(match)


@pytest.mark.parametrize(
    ("name", "placed"),
    # Each place holds two.
    [
        (name, placed)
        for number, name in enumerate(OPENS)
        for turn, placed in enumerate(PLACES)
        if turn == number % len(PLACES)
    ],
)
def test_what_opens_is_found_wherever_it_stands(name, placed):
    degrees, sizes = PLACES[placed]
    linear = rotation_about(UP, np.radians(degrees)) @ np.diag(sizes)
    turn = np.eye(4)
    turn[:3, :3] = np.where(np.abs(linear) < 1e-9, 0.0, linear)
    require(read(sample(name).transformed(turn)), name, turn[:3, :3])


@pytest.mark.parametrize("name", OPENS)
def test_few_triangles_are_enough(name):
    coarse = getattr(one_piece, name)(edge=10.0)
    assert len(coarse.faces) < len(sample(name).faces) / 4
    require(read(coarse), name, np.eye(3))


@pytest.mark.parametrize(
    ("name", "quarters"),
    # Each looks to one side and to the opposite one.
    [(name, (number + half) % 4) for number, name in enumerate(STAYS) for half in (0, 2)],
)
def test_what_does_not_open_stays_rigid(name, quarters):
    turn = np.eye(4)
    turn[:3, :3] = np.rint(rotation_about(UP, quarters * np.pi / 2.0))
    (found,) = SeamsArticulator().hypotheses(sample(name).transformed(turn))
    assert not found.articulation.joints
    assert found.articulation.notes


def test_a_door_is_as_thick_as_the_seam_beside_it_shows():
    found = read(sample("thick_doors"))
    for part in (1, 2):
        assert found.part_mesh(part).bounds[1][1] == pytest.approx(0.1, abs=0.01)


@pytest.mark.parametrize("quarters", range(4))
def test_the_lid_of_a_bin_opens_upwards(quarters):
    turn = np.eye(4)
    turn[:3, :3] = np.rint(rotation_about(UP, quarters * np.pi / 2.0))
    found = read(sample("bin_with_lid").transformed(turn))
    (joint,) = found.joints
    assert joint.kind is HINGED
    assert found.part_mesh(1).bounds[0][2] == pytest.approx(0.86, abs=0.07)
    lid = found.part_mesh(1)
    middle = lid.bounds.mean(axis=0)
    lifted = joint.motion(0.5) @ np.append(middle, 1.0)
    assert lifted[2] > middle[2] + 0.05


def test_long_bars_in_two_rows_are_pulls_and_no_knobs():
    found = read(sample("bars_that_meet"))
    assert len(found.joints) == 4
    assert all(joint.kind is not TURNS for joint in found.joints)


def test_a_panel_ends_at_its_seam_and_takes_its_handle_along():
    found = read(sample("drawers"))
    for part, (low, high) in enumerate(((0.06, 0.32), (0.34, 0.6), (0.62, 0.86)), start=1):
        bounds = found.part_mesh(part).bounds
        assert bounds[:, 0] == pytest.approx([0.04, 0.76], abs=0.006)
        assert bounds[:, 2] == pytest.approx([low, high], abs=0.006)
        assert bounds[0, 1] == pytest.approx(-0.03, abs=1e-6)
        assert found.joints[part - 1].upper == pytest.approx(0.8 * 0.53, rel=0.01)


def test_hypotheses_are_ranked_and_share_one_mesh():
    likeliest_first = SeamsArticulator().hypotheses(sample("fridge"))
    chances = [each.probability for each in likeliest_first]
    assert chances == sorted(chances, reverse=True)
    found = [each.articulation for each in likeliest_first]
    assert 1 <= len(found) <= 4
    first = found[0]
    require(first, "fridge", np.eye(3))
    for other in found[1:]:
        assert other.mesh is first.mesh
        assert len(other.joints) == len(first.joints)
        kinds = [(joint.kind, joint.axis.tolist()) for joint in other.joints]
        assert kinds != [(joint.kind, joint.axis.tolist()) for joint in first.joints]


def test_nothing_is_read_of_a_flat_or_tiny_mesh():
    sheet = Mesh.from_triangles(
        [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], [[0, 1, 2], [0, 2, 3]]
    )
    assert not read(sheet).joints
    lying = Mesh.from_triangles(
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
    )
    assert not read(lying).joints
