"""Frames follow the edges of things, however these are turned."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from plain_solids import box, cylinder

from asset_factory.factory.articulate.evidence.frames import distinct, level_frame, own_frame
from asset_factory.factory.articulate.evidence.surfels import spread
from asset_factory.factory.articulation import rotation_about
from asset_factory.factory.mesh import Material


def _triangles(mesh, rotation):
    return mesh.vertices[mesh.faces] @ rotation.T


def _same_axes(frame, rotation):
    return np.allclose(np.abs(frame @ rotation).max(axis=1), 1.0, atol=1e-3)


@settings(max_examples=25, deadline=None)
@given(st.floats(-3.1, 3.1))
def test_level_frame_finds_the_heading_of_the_walls(yaw):
    rotation = rotation_about(np.array([0.0, 0.0, 1.0]), yaw)
    frame = level_frame(_triangles(box((0, 2), (0, 1), (0, 1), Material("wood")), rotation))
    assert np.allclose(frame @ frame.T, np.eye(3))
    off = np.degrees(np.arccos(min(np.abs(frame @ rotation)[0].max(), 1.0)))
    assert off <= 0.51


@settings(max_examples=25, deadline=None)
@given(st.floats(-3.1, 3.1), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_own_frame_of_a_plate_is_the_plates(angle, x, y):
    axis = np.array([x, y, 1.0]) / np.linalg.norm([x, y, 1.0])
    rotation = rotation_about(axis, angle)
    plate = _triangles(box((0, 1), (0, 0.6), (0, 0.05), Material("wood")), rotation)
    frame = own_frame(spread(plate, 512))
    assert _same_axes(frame, rotation)
    assert abs(frame[0] @ rotation[:, 2]) > 0.999


def test_own_frame_of_a_bar_starts_with_its_length():
    tilt = rotation_about(np.array([1.0, 0.0, 0.0]), 0.4)
    bar = _triangles(cylinder(2, (0, 0), 0.05, (0, 1.0), Material("steel")), tilt)
    frame = own_frame(spread(bar, 512))
    assert abs(frame[0] @ tilt[:, 2]) > 0.999


def test_distinct_keeps_one_of_frames_that_differ_in_order_only():
    swapped = np.eye(3)[[1, 0, 2]] * [[-1], [1], [1]]
    tilted = rotation_about(np.array([0.0, 0.0, 1.0]), 0.3)
    assert len(distinct([np.eye(3), swapped, tilted])) == 2
