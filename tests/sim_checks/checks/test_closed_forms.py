"""Depth and gap of two shapes whose distance is known in closed form, in any pose, from a file."""

import tempfile
from pathlib import Path

import numpy as np
import pytest
import trimesh
from fault_corpus.things import words
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from asset_factory.sim_checks.checks.penetration import check_penetration
from asset_factory.sim_checks.config import PenetrationConfig
from asset_factory.sim_checks.read.read import read_here

#: Measure gaps up to a quarter metre.
WIDE = PenetrationConfig(clearance_m=0.25)
#: What a round primitive of the reader sags below its true surface, as a share of its radius.
SAG = 1e-3

#: Overlaps and gaps from 0.01 mm to 10 cm.
depths = st.builds(
    lambda sign, power: sign * 10.0**power, st.sampled_from((-1.0, 1.0)), st.floats(-5.0, -1.0)
)
rotations = st.integers(0, 2**32 - 1).map(
    lambda seed: Rotation.random(random_state=np.random.default_rng(seed))
)
sizes = st.floats(0.3, 0.8)


def measured(first, second, whole):
    """Depth at rest [m] as the judge reads it from a URDF, the whole turned; negative is a gap.

    Each of the two is an element, its rotation and its centre [m].
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        origins = []
        for element, rotation, center in (first, second):
            turn = whole * rotation
            xyz = words(whole.apply(np.asarray(center, dtype=float)))
            rpy = words(turn.as_euler("xyz"))
            origins.append(
                f'<collision><origin xyz="{xyz}" rpy="{rpy}"/>'
                f"<geometry>{element}</geometry></collision>"
            )
        for part in (first, second):
            _write_mesh(part[0], folder)
        path = folder / "pair.urdf"
        path.write_text(
            f'<robot name="pair"><link name="a">{origins[0]}</link>'
            f'<link name="b">{origins[1]}</link>'
            '<joint name="j" type="prismatic"><parent link="a"/>'
            '<child link="b"/><axis xyz="0 0 1"/>'
            '<limit lower="0" upper="0.001" effort="1" velocity="1"/></joint></robot>'
        )
        (contact,) = check_penetration(read_here(path), WIDE).measurements["rest"]
        return float(contact["depth_mm"]) / 1000.0


def mesh(kind, *numbers):
    """The same body as a mesh file, named by what it is."""
    return f'<mesh filename="{kind}_{"_".join(repr(number) for number in numbers)}.obj"/>'


def _write_mesh(element, folder):
    if "filename" not in element:
        return
    file = element.split('"')[1]
    kind, *numbers = file.removesuffix(".obj").split("_")
    sizes = [float(number) for number in numbers]
    made = {
        "box": lambda: trimesh.creation.box(extents=sizes),
        "ball": lambda: trimesh.creation.icosphere(subdivisions=3, radius=sizes[0]),
        "rod": lambda: trimesh.creation.cylinder(radius=sizes[0], height=sizes[1], sections=96),
    }[kind]()
    (folder / file).write_text(made.export(file_type="obj", digits=12))


def box_element(size, as_mesh):
    return mesh("box", *size) if as_mesh else f'<box size="{words(size)}"/>'


def half_height(rotation, size):
    """How far a turned box reaches below its centre [m]."""
    return 0.5 * float(np.abs(rotation.as_matrix()[2]) @ np.asarray(size))


def lying(element):
    """At the world's origin as it is."""
    return element, UPRIGHT, (0, 0, 0)


def agrees(found, true, sag=0.0):
    """Within 2 % or 0.02 mm, and short by a tessellation's sag at most [m]."""
    slack = max(2e-5, 0.02 * abs(true))
    return true - sag - slack <= found <= true + slack


SLAB = (4.0, 4.0, 1.0)
UPRIGHT = Rotation.identity()


@settings(max_examples=40)
@given(depths, rotations, rotations, st.tuples(sizes, sizes, sizes), st.booleans())
def test_a_box_in_any_pose_on_a_slab(depth, whole, turn, size, as_mesh):
    height = 0.5 + half_height(turn, size) - depth
    slab = lying(box_element(SLAB, not as_mesh))
    block = (box_element(size, as_mesh), turn, (0.1, -0.2, height))
    assert agrees(measured(slab, block, whole), depth)


@settings(max_examples=25)
@given(depths, rotations, rotations, st.floats(0.02, 0.5), st.booleans())
def test_a_ball_on_a_slab(depth, whole, turn, radius, as_mesh):
    # A ball sunk deeper than its centre still has its shortest way out upwards.
    ball = mesh("ball", radius) if as_mesh else f'<sphere radius="{radius!r}"/>'
    sag = radius * (0.02 if as_mesh else SAG)
    resting = (ball, turn, (0, 0, 0.5 + radius - depth))
    assert agrees(measured(lying(box_element(SLAB, False)), resting, whole), depth, sag)


@settings(max_examples=25)
@given(depths, rotations, rotations, st.floats(0.05, 0.3), st.booleans())
def test_a_rod_at_any_slant_on_a_slab(depth, whole, turn, radius, as_mesh):
    length = 0.7
    lean = abs(float(turn.as_matrix()[2, 2]))
    reach = radius * np.sqrt(1.0 - lean**2) + 0.5 * length * lean
    primitive = f'<cylinder radius="{radius!r}" length="{length}"/>'
    rod = mesh("rod", radius, length) if as_mesh else primitive
    resting = (rod, turn, (0.3, 0.1, 0.5 + reach - depth))
    found = measured(lying(box_element(SLAB, True)), resting, whole)
    assert agrees(found, depth, radius * SAG)


@pytest.mark.parametrize("depth", [1e-5, 1e-4, 1e-3, 1e-2, 0.1])
def test_a_ball_with_a_thousand_corners_in_another(depth):
    """Many edge pairs take another road to the depth; it must lead to the same place."""
    ball = mesh("ball", 0.2)
    lifted = (ball, UPRIGHT, (0.0, 0.0, 0.4 - depth))
    found = measured(lying(ball), lifted, Rotation.from_euler("xyz", (0.3, 0.5, 0.7)))
    # Both have a corner at the pole, so nothing sags along the line between them.
    assert found <= depth + 2e-5
    assert found >= depth - 0.4 * 0.02
