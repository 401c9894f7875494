"""Depth and gap of two shapes whose distance is known in closed form, in any pose, from a file."""

import numpy as np
import pytest
import trimesh
from fault_corpus.things import words
from hypothesis import given, settings
from hypothesis import strategies as st
from ros_packages import SLIDE
from scipy.spatial.transform import Rotation

from asset_factory.sim_checks.checks.penetration import check_penetration
from asset_factory.sim_checks.config import PenetrationConfig
from asset_factory.sim_checks.read.read import read_here

#: Measure gaps up to a quarter metre.
WIDE = PenetrationConfig(clearance_m=0.25)
#: What a round primitive of the reader sags below its true surface, as a share of its radius.
SAG = 1e-3
SLAB = trimesh.creation.box(extents=(4.0, 4.0, 1.0))
UPRIGHT = Rotation.identity()

#: Overlaps and gaps from 0.01 mm to 10 cm.
depths = st.builds(
    lambda sign, power: sign * 10.0**power, st.sampled_from((-1.0, 1.0)), st.floats(-5.0, -1.0)
)
rotations = st.integers(0, 2**32 - 1).map(
    lambda seed: Rotation.random(random_state=np.random.default_rng(seed))
)
shares = st.floats(0.0, 1.0)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("pairs")


def measured(folder, whole, *solids):
    """Depth at rest [m] as the judge reads it from a URDF, the whole turned; negative is a gap.

    Each of the two is a mesh or an element, its rotation and its centre [m].
    """
    links = ""
    for name, (shape, turn, center) in zip(("shell", "drawer"), solids, strict=True):
        element = shape
        if isinstance(shape, trimesh.Trimesh):
            (folder / f"{name}.obj").write_text(shape.export(file_type="obj", digits=12))
            element = f'<mesh filename="{name}.obj"/>'
        origin = f'xyz="{words(whole.apply(center))}" rpy="{words((whole * turn).as_euler("xyz"))}"'
        collision = f"<origin {origin}/><geometry>{element}</geometry>"
        links += f'<link name="{name}"><collision>{collision}</collision></link>'
    path = folder / "pair.urdf"
    path.write_text(f'<robot name="pair">{links}{SLIDE}</robot>')
    (contact,) = check_penetration(read_here(path), WIDE).measurements["rest"]
    return float(contact["depth_mm"]) / 1000.0


def block(up, shares, as_mesh):
    """The box, how far it reaches below its centre [m], and by how much less at most."""
    size = 0.3 + 0.5 * shares
    shape = trimesh.creation.box(extents=size) if as_mesh else f'<box size="{words(size)}"/>'
    return shape, 0.5 * np.abs(up) @ size, 0.0


def ball(up, shares, as_mesh):
    # Sunk deeper than its centre, it still has its shortest way out upwards.
    radius = 0.02 + 0.48 * shares[0]
    if as_mesh:
        return trimesh.creation.icosphere(subdivisions=3, radius=radius), radius, 0.02 * radius
    return f'<sphere radius="{radius}"/>', radius, SAG * radius


def rod(up, shares, as_mesh):
    length = 0.7
    radius = 0.05 + 0.25 * shares[0]
    reach = radius * np.sqrt(1.0 - up[2] ** 2) + 0.5 * length * abs(up[2])
    shape = f'<cylinder radius="{radius}" length="{length}"/>'
    if as_mesh:
        shape = trimesh.creation.cylinder(radius=radius, height=length, sections=96)
    return shape, reach, SAG * radius


@pytest.mark.parametrize("solid", [block, ball, rod])
@settings(max_examples=20)
@given(depths, rotations, rotations, st.tuples(shares, shares, shares), st.booleans())
def test_a_solid_in_any_pose_on_a_slab(folder, solid, depth, whole, turn, shares, as_mesh):
    shape, reach, sag = solid(turn.as_matrix()[2], np.array(shares), as_mesh)
    resting = (shape, turn, (0.1, -0.2, 0.5 + reach - depth))
    found = measured(folder, whole, (SLAB, UPRIGHT, (0.0, 0.0, 0.0)), resting)
    slack = max(2e-5, 0.02 * abs(depth))
    assert depth - sag - slack <= found <= depth + slack


@pytest.mark.parametrize("depth", [1e-5, 1e-4, 1e-3, 1e-2, 0.1])
def test_a_ball_with_a_thousand_corners_in_another(folder, depth):
    """Many edge pairs take another road to the depth; it must lead to the same place."""
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.2)
    whole = Rotation.from_euler("xyz", (0.3, 0.5, 0.7))
    lifted = (ball, UPRIGHT, (0.0, 0.0, 0.4 - depth))
    found = measured(folder, whole, (ball, UPRIGHT, (0.0, 0.0, 0.0)), lifted)
    # Both have a corner at the pole, so nothing sags along the line between them.
    assert depth - 0.4 * 0.02 <= found <= depth + 2e-5
