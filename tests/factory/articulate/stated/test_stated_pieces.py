"""Stated parts of meshes of several pieces are the pieces that their boxes mean."""

import numpy as np
import pytest
from manifold3d import CrossSection, Manifold
from one_piece import mesh_of
from stated_parts import FINE, articulated, block, box_of


def test_a_piece_that_a_box_means_is_the_part_and_nothing_is_cut():
    body = block([0.0, 0.02, 0.0], [0.5, 0.4, 1.0])
    fronts = [block([0.03, -0.01, z], [0.47, 0.01, z + 0.4]) for z in (0.05, 0.55)]
    mesh = mesh_of(body + fronts[0] + fronts[1], 0.05)
    part = {"kind": "door", "side": "front", "box": [0.09, 0.02, 0.97, 0.42], "hinge": "left"}
    made, cut = articulated(mesh, part)
    assert len(made.parts[0].faces) + len(made.parts[1].faces) == len(made.mesh.faces)
    assert box_of(made, 1) == pytest.approx(np.array([[0.03, -0.01, 0.05], [0.47, 0.01, 0.45]]))
    assert made.joints[0].origin[0] == pytest.approx(0.03, abs=FINE / 4.0)
    # Where the piece is not it, all that is in the region of its box is.
    assert box_of(cut, 1)[1][1] > 0.015


def test_boxes_drawn_over_one_another_are_the_pieces_that_they_mean():
    fronts = [block([0.01, -0.02, z], [0.49, 0.0, z + 0.18]) for z in (0.01, 0.21, 0.41)]
    mesh = mesh_of(block([0.0, 0.001, 0.0], [0.5, 0.4, 1.0]) + Manifold.compose(fronts), 0.1)
    boxes = [[0.0, 0.0, 1.0, 0.24], [0.05, 0.17, 1.0, 0.43], [0.0, 0.37, 0.95, 0.55]]
    drawers = [{"kind": "drawer", "side": "front", "box": box} for box in boxes]
    made = articulated(mesh, *drawers)[0]
    lows = [box_of(made, part)[0][2] for part in (1, 2, 3)]
    assert lows == pytest.approx([0.01, 0.21, 0.41])


def test_a_door_in_its_frame_takes_pane_and_handles_along():
    # As deep as all of the object, by its handles.
    frame = block([0.0, 0.0, 0.0], [1.0, 0.1, 2.0]) - block([0.06, -1.0, -1.0], [0.94, 1.0, 1.94])
    leaf = block([0.07, 0.02, 0.0], [0.93, 0.06, 1.93]) - block([0.2, -1, 0.2], [0.5, 1, 1.7])
    handles = block([0.8, -0.05, 0.9], [0.85, 0.15, 1.0])
    pane = block([0.21, 0.035, 0.21], [0.49, 0.045, 1.69])
    behind = block([0.8, 0.065, 1.1], [0.85, 0.14, 1.2])
    mesh = mesh_of(frame + (leaf + handles) + pane + behind, 0.1)
    part = {"kind": "door", "side": "front", "box": [0.07, 0.0, 0.93, 0.97], "hinge": "left"}
    made = articulated(mesh, part)[0]
    leaf_box = np.array([[0.07, -0.05, 0.0], [0.93, 0.15, 1.93]])
    assert box_of(made, 1) == pytest.approx(leaf_box)
    assert box_of(made, 0) == pytest.approx(np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 2.0]]))
    left = made.mesh.vertices[made.mesh.faces[made.parts[0].faces]]
    assert not ((left[..., 0] > 0.2) & (left[..., 0] < 0.9) & (left[..., 2] < 1.9)).any()


@pytest.mark.parametrize("off", [-0.02, 0.0, 0.02])
def test_panes_between_a_windows_bars_turn_with_it_about_its_edge(off):
    frame = block([0.0, 0.0, 0.0], [0.7, 0.08, 1.1]) - block([0.04, -1, 0.04], [0.66, 1, 1.06])
    ends = [(0.05, 0.12, 0.05, 1.05), (0.58, 0.65, 0.05, 1.05)]
    ends += [(0.121, 0.579, 0.05, 0.12), (0.121, 0.579, 0.98, 1.05)]
    bars = [block([x0, 0.01, z0], [x1, 0.05, z1]) for x0, x1, z0, z1 in ends]
    pane = block([0.122, 0.028, 0.122], [0.578, 0.032, 0.978])
    mesh = mesh_of(frame + bars[0] + bars[1] + bars[2] + bars[3] + pane, 0.1)
    box = [0.07 + off, 0.05 + off, 0.93 + off, 0.95 + off]
    made = articulated(mesh, {"kind": "door", "side": "front", "box": box, "hinge": "left"})[0]
    sash = np.array([[0.05, 0.01, 0.05], [0.65, 0.05, 1.05]])
    assert box_of(made, 1) == pytest.approx(sash)
    assert made.joints[0].origin[0] == pytest.approx(0.05)
    assert len(made.parts[0].faces) == len(mesh_of(frame, 0.1).faces)


def test_a_glass_within_the_ring_of_a_door_is_the_doors_and_a_lever_before_it_is_not():
    body = block([0.0, 0.0, 0.0], [0.6, 0.6, 0.8]) - block([0.2, -1, 0.3], [0.4, 0.5, 0.5])
    circle = CrossSection.circle(0.04, 24).translate((0.16, 0.0))
    ring = circle.revolve(48).rotate((90, 0, 0)).translate((0.3, -0.041, 0.4))
    glass = Manifold.sphere(0.11, 48).scale((1.0, 0.3, 1.0)).translate((0.3, -0.061, 0.4))
    lever = block([0.25, -0.2, 0.38], [0.3, -0.15, 0.4])
    part = {"kind": "door", "side": "front", "box": [1 / 6, 0.25, 5 / 6, 0.75], "hinge": "left"}
    made = articulated(mesh_of(body + ring + glass + lever, 0.1), part)[0]
    assert box_of(made, 1) == pytest.approx(np.array([[0.1, -0.094, 0.2], [0.5, -0.001, 0.6]]))


def test_a_drawer_takes_its_bottom_along_and_stays_in_its_rails():
    case = block([0.0, 0.0, 0.0], [0.6, 0.9, 0.5]) - block([0.05, -1.0, 0.3], [0.55, 0.85, 0.45])
    tray = block([0.06, -0.02, 0.31], [0.54, 0.4, 0.44]) - block([0.08, 0.02, 0.0], [0.52, 0.38, 1])
    bottom = block([0.09, 0.1, 0.32], [0.51, 0.37, 0.325])
    ceiling = block([0.09, 0.1, 0.4395], [0.51, 0.37, 0.44])
    mesh = mesh_of(case + tray + bottom + ceiling, 0.1)
    part = {"kind": "drawer", "side": "front", "box": [0.1, 0.62, 0.9, 0.88]}
    made = articulated(mesh, part)[0]
    assert made.joints[0].upper == pytest.approx(0.42, abs=FINE)
    moved = made.part_mesh(1).vertices
    assert ((moved[:, 0] > 0.085) & (moved[:, 2] < 0.326) & (moved[:, 2] > 0.315)).any()
    assert not (moved[:, 2] == np.float32(0.4395)).any()
    ranged = articulated(mesh, {**part, "range": [0, 600]})[0]
    assert ranged.joints[0].upper == pytest.approx(0.6)
