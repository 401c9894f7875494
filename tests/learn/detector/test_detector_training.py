"""What the detector learns from: sides with their truth, and looks that keep it true."""

from functools import cache

import numpy as np
import pytest

from asset_factory.factory.models.detector.canvas import CANVAS, SIDES, SORTS, WAYS, PanelWay, Sort
from asset_factory.learn.detector.drawn import drawn_one_piece, drawn_sides
from asset_factory.learn.detector.kinds import kind_number
from asset_factory.learn.detector.sides import WholeTruth, labelled_sides
from asset_factory.learn.detector.still import STILL, make_still
from asset_factory.learn.labelled import LabelledObject, LabelledPart
from asset_factory.learn.objects import make_object

torch = pytest.importorskip("torch")

from asset_factory.factory.models.detector.canvas import KINDS  # noqa: E402
from asset_factory.factory.models.detector.decode import Dense, Found  # noqa: E402
from asset_factory.factory.models.detector.network import Detector  # noqa: E402
from asset_factory.factory.views.raster import Side  # noqa: E402
from asset_factory.learn.detector.evaluate import compared  # noqa: E402
from asset_factory.learn.detector.looks import show  # noqa: E402
from asset_factory.learn.detector.pack import read_pack, read_textures, write_pack  # noqa: E402
from asset_factory.learn.detector.stream import Pool  # noqa: E402
from asset_factory.learn.detector.targets import loss_of, targets_of  # noqa: E402

FRONT, TOP = 0, SIDES.index("top")


@cache
def labelled(kind, number):
    return labelled_sides(make_object(kind, number))


def rows_of(sides, sort):
    table = sides.table
    return table[(table[:, 6] == SORTS.index(sort)) & (table[:, 9] == 0)]


def test_doors_are_labelled_on_the_side_where_they_are_and_lids_on_all():
    fridge = rows_of(labelled("fridge", 1), Sort.DOOR)
    assert set(fridge[:, 0]) == {FRONT}
    assert len(fridge) == len(make_object("fridge", 1).movable_joints)
    chest = rows_of(labelled("chest", 1), Sort.LID)
    assert sorted(chest[:, 0]) == [0, 1, 2, 3, 4]
    ways = {SIDES[int(row[0])].value: WAYS[int(row[7])] for row in chest}
    assert ways["front"] is PanelWay.TOP
    assert ways["back"] is PanelWay.BOTTOM
    assert ways["right"] is PanelWay.RIGHT
    assert ways["left"] is PanelWay.LEFT


def test_an_open_lid_is_said_to_be_open():
    chest = make_object("chest", 1)
    (joint,) = chest.movable_joints
    assert rows_of(labelled("chest", 1), Sort.LID)[:, 8].max() == 0.0
    assert rows_of(labelled_sides(chest, {joint.name: 0.8}), Sort.LID)[:, 8] == pytest.approx(0.8)


@pytest.mark.parametrize("kind", STILL)
def test_still_things_have_nothing_that_moves(kind):
    sides = labelled_sides(make_still(kind, np.random.default_rng(1)))
    assert not len(sides.table)
    assert (sides.part > 0).any()


def shown_as(kind, objects, seed):
    """Return objects as an image-to-3D tool would make them."""
    pool = Pool(len(objects), torch.device("cpu"))
    truth = WholeTruth(kind_number(kind), True, FRONT, False)
    for sides in objects:
        pool.add(sides, truth)
    batch = pool.take(torch.arange(len(objects)))
    textures = torch.full((2, 3, 8, 8), 128, dtype=torch.uint8)
    return show(batch, textures, torch.Generator().manual_seed(seed))


@pytest.fixture(scope="module")
def shown():
    return shown_as("dresser", [labelled("dresser", n) for n in range(4)], 3)


def test_boxes_follow_objects_that_are_stretched_mirrored_and_turned(shown):
    assert len(set(shown.front.tolist())) > 1
    for number, front in enumerate(shown.front.tolist()):
        drawers = shown.table[number]
        drawn = (drawers[:, 6] == SORTS.index(Sort.DRAWER)) & (drawers[:, 9] == 0)
        drawers = drawers[drawn & (drawers[:, 0] >= 0)]
        assert len(drawers)
        for row in drawers.numpy():
            assert int(row[0]) == front
            rows, columns = np.nonzero(shown.part[number, front].numpy() == int(row[5]))
            ends = [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]
            assert row[1:5] == pytest.approx(ends, abs=5.0)


def test_tops_turn_with_their_objects():
    made = shown_as("chest", [labelled("chest", 1)] * 8, 0)
    # Where the front is, seen from above, and the edge away from it, where the hinge is.
    hinge = {0: PanelWay.TOP, 1: PanelWay.LEFT, 2: PanelWay.BOTTOM, 3: PanelWay.RIGHT}
    for number, table in enumerate(made.table):
        above = table[(table[:, 0] == TOP) & (table[:, 6] == SORTS.index(Sort.LID))]
        assert WAYS[int(above[0, 7])] is hinge[int(made.front[number])]


def test_answers_that_say_the_truth_cost_less(shown):
    targets = targets_of(shown)
    there = (targets.sort >= 0) & ~targets.ignored
    sort = torch.full((*there.shape[:2], len(SORTS), *there.shape[2:]), -8.0)
    sort = sort.scatter(2, targets.sort.clamp(min=0)[:, :, None], 8.0)
    sort = torch.where(there[:, :, None], sort, -8.0)
    way = torch.nn.functional.one_hot(targets.way.clamp(min=0), len(WAYS)).movedim(-1, 2) * 20.0
    whole = torch.zeros(len(there), 1)

    def cost(scale):
        edges = targets.edges.clamp(min=0.1) * scale
        quality = torch.full(there.shape, 8.0 if scale == 1.0 else 0.0)
        said = Dense(sort, edges, way, quality, targets.opened, whole, whole, whole)
        return float(loss_of(said, targets)[0])

    assert cost(1.0) < 0.2
    assert cost(1.3) > cost(1.0) + 0.1


def test_the_network_learns_one_object_by_heart(shown):
    torch.manual_seed(0)
    network = Detector(len(KINDS))
    optimizer = torch.optim.AdamW(network.parameters(), 1e-3)
    one = type(shown)(shown.cues[:1], shown.part[:1], shown.table[:1], shown.front[:1])
    targets = targets_of(one)
    costs = []
    for _ in range(3):
        loss, _ = loss_of(network(one.cues), targets)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        costs.append(float(loss.detach()))
    assert costs[-1] < 0.9 * costs[0]


def test_a_pack_keeps_objects_and_labels(tmp_path, monkeypatch):
    import trimesh
    from PIL import Image

    real = tmp_path / "real"
    real.mkdir()
    made = make_object("fridge", 2)
    y_up = made.mesh.vertices[:, [0, 2, 1]] * [1, 1, -1]
    trimesh.Trimesh(y_up, made.mesh.faces, process=False).export(real / "cold.glb")
    (real / "INVENTORY.csv").write_text("file\ncold.glb\n")
    door = LabelledPart(Side.FRONT, Sort.DOOR, (0.0, 0.5, 1.0, 1.0), "left")
    label = {"cold": LabelledObject("fridge", True, parts=(door,))}
    monkeypatch.setattr("asset_factory.learn.detector.real.labelled_objects", lambda: label)
    textures = tmp_path / "textures"
    textures.mkdir()
    Image.new("RGB", (8, 8), (10, 200, 30)).save(textures / "green.jpg")
    write_pack(tmp_path / "pack.zip", (real,), textures, one_piece=1, workers=1)
    packed, fused = read_pack(tmp_path / "pack.zip")
    assert not packed.one_piece
    assert fused.one_piece
    assert (fused.truth, fused.held_out) == (packed.truth, packed.held_out)
    assert (fused.sides.table == packed.sides.table).all()
    # One bumpy piece: seen in nearly the same place, and nowhere as flat as it was.
    both = (fused.sides.depth[FRONT] >= 0) & (packed.sides.depth[FRONT] >= 0)
    assert both.mean() > 0.9 * (packed.sides.depth[FRONT] >= 0).mean()
    assert len(np.unique(fused.sides.depth[FRONT])) > 2 * len(np.unique(packed.sides.depth[FRONT]))
    assert packed.truth == WholeTruth(kind_number("fridge"), True, FRONT, True)
    (row,) = packed.sides.table
    assert SORTS[int(row[6])] is Sort.DOOR
    assert WAYS[int(row[7])] is PanelWay.LEFT
    assert row[2] == pytest.approx(CANVAS / 2, abs=2.0)
    assert (packed.sides.depth[FRONT] >= 0).any()
    assert read_textures(tmp_path / "pack.zip").shape == (1, 3, 128, 128)


def test_drawn_objects_are_of_every_sort():
    sorts = set()
    for seed in range(14):
        _, sides = drawn_sides(np.random.default_rng(seed))
        sorts |= {SORTS[int(row[6])] for row in sides.table}
    assert {Sort.DOOR, Sort.DRAWER, Sort.LID, Sort.OTHER} <= sorts


def test_objects_made_one_piece_keep_what_opens():
    drawn = [drawn_one_piece(np.random.default_rng(seed)) for seed in (1, 2, 5)]
    assert [kind in STILL for kind, _ in drawn] == [False, False, True]
    assert [len(sides.table) == 0 for _, sides in drawn] == [False, False, True]


def test_what_is_told_where_nothing_is_known_is_not_held_against_it():
    left = np.eye(6)[WAYS.index(PanelWay.LEFT)]

    def found(box, sort):
        return Found(Side.FRONT, np.array(box, float), sort, 0.9, left)

    door = [FRONT, 10, 10, 50, 90, 1, SORTS.index(Sort.DOOR), WAYS.index(PanelWay.LEFT), 0, 0]
    unknown = [FRONT, 100, 10, 160, 90, 2, SORTS.index(Sort.OTHER), 0, 0, 1]
    table = np.array([door, unknown], float)
    told = [
        found([12, 10, 50, 88], Sort.DOOR),
        found([105, 12, 155, 88], Sort.DRAWER),
        found([180, 10, 220, 90], Sort.DRAWER),
    ]
    counts = compared(told, table)
    assert counts[SORTS.index(Sort.DOOR)].tolist() == [1, 1, 1, 0]
    assert counts[SORTS.index(Sort.DRAWER)].tolist() == [0, 0, 0, 1]
