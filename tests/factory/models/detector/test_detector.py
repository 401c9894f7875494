"""The detector: what it looks at, how its answers become parts, and what the shipped one sees."""

import numpy as np
import pytest
from openable_samples import RED, box

from asset_factory.factory.mesh import Mesh
from asset_factory.factory.models.detector.canvas import (
    CANVAS,
    DEPTH_STEPS,
    LONGEST,
    NOTHING,
    SORTS,
    STRIDE,
    WAYS,
    PanelWay,
    Sort,
    look_at,
    shares_of,
)
from asset_factory.factory.models.detector.decode import Dense, found_parts, overlaps
from asset_factory.factory.models.detector.detect import detect
from asset_factory.factory.views.raster import Side
from asset_factory.learn.objects import make_object

CELLS = CANVAS // STRIDE


def dense_with(boxes):
    """Return answers that are sure of some boxes: view, box, sort, way."""
    dense = Dense(
        np.full((5, len(SORTS), CELLS, CELLS), -9.0),
        np.ones((5, 4, CELLS, CELLS)),
        np.zeros((5, len(WAYS), CELLS, CELLS)),
        np.full((5, CELLS, CELLS), 3.0),
        np.zeros((5, CELLS, CELLS)),
        *(None,) * 3,
    )
    center = (np.arange(CELLS) + 0.5) * STRIDE
    for view, (left, low, right, high), sort, way in boxes:
        rows = np.flatnonzero((center > low) & (center < high))
        columns = np.flatnonzero((center > left) & (center < right))
        where = np.ix_(rows, columns)
        dense.sort[view, SORTS.index(sort)][where] = 3.0
        dense.way[view, WAYS.index(way)][where] = 5.0
        x, y = np.meshgrid(center[columns], center[rows])
        for k, edge in enumerate((x - left, y - low, right - x, high - y)):
            dense.edges[view, k][where] = edge
    return dense


def test_a_box_stands_in_the_middle_of_its_canvases_at_one_scale():
    canvases = look_at(box([0.0, 0.0, 0.5], [0.5, 0.25, 1.0], RED))
    for view, wide, high in ((0, 120, 240), (1, 60, 240), (4, 120, 60)):
        rows, columns = np.nonzero(canvases.depth[view] != NOTHING)
        assert [np.ptp(rows) + 1, np.ptp(columns) + 1] == pytest.approx([high, wide], abs=1)
        assert [rows.mean(), columns.mean()] == pytest.approx([CANVAS / 2] * 2, abs=1.5)
        assert (canvases.depth[view][canvases.depth[view] != NOTHING] == 0).all()


def test_depth_is_kept_in_shares_of_a_pixel():
    step = Mesh.from_triangles(
        [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1], [1, 0.125, 0], [2, 0.125, 0], [2, 0.125, 1]],
        [(0, 1, 2), (0, 2, 3), (4, 5, 6)],
    )
    depth = look_at(step).depth[0]
    assert set(np.unique(depth)) == {NOTHING, 0, round(0.125 / 2.0 * LONGEST * DEPTH_STEPS)}


def test_shares_of_a_whole_side_are_nought_to_one():
    extents = np.array([120.0, 240.0])
    low = (CANVAS - extents) / 2.0
    assert shares_of(np.concatenate([low, low + extents]), extents) == pytest.approx([0, 0, 1, 1])


def test_each_box_is_found_once_with_its_sort_and_way():
    said = [
        (0, (40.0, 40.0, 120.0, 200.0), Sort.DOOR, PanelWay.LEFT),
        (0, (124.0, 40.0, 200.0, 200.0), Sort.DRAWER, PanelWay.OUT),
        (4, (20.0, 20.0, 220.0, 220.0), Sort.LID, PanelWay.TOP),
    ]
    found = found_parts(dense_with(said), 0.5)
    assert [part.side for part in found] == [Side.FRONT, Side.FRONT, Side.TOP]
    for part, (_, where, sort, way) in zip(found, said, strict=True):
        assert (part.sort, WAYS[int(part.ways.argmax())]) == (sort, way)
        assert overlaps(part.box, np.array([where]))[0] > 0.98
    assert found_parts(dense_with([]), 0.1) == ()


@pytest.mark.parametrize(
    ("kind", "seed", "sort"),
    [("fridge", 3, Sort.DOOR), ("dresser", 3, Sort.DRAWER), ("oven", 3, Sort.FLAP)],
)
def test_the_shipped_weights_know_made_objects(kind, seed, sort):
    detection = detect(make_object(kind, seed).mesh)
    assert detection.opens > 0.9
    assert int(detection.dense.front.argmax()) == 0
    assert any(part.sort is sort and part.side is Side.FRONT for part in detection.parts(0.6))


def test_the_shipped_weights_leave_a_plain_box_shut():
    assert not detect(box([0.0, 0.0, 0.2], [0.5, 0.3, 0.4])).parts(0.6)
