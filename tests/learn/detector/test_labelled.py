"""Labels of real meshes as their sides show them, and the meshes of Sweet Home 3D."""

import csv
import json
import zipfile

import numpy as np
import pytest

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.intake.load import load
from asset_factory.factory.models.detector.canvas import KINDS, WAYS, PanelWay, Sort
from asset_factory.factory.views.raster import Side
from asset_factory.learn import labelled
from asset_factory.learn.detector import sweethome3d
from asset_factory.learn.detector.real import real_objects
from asset_factory.learn.labelled import EITHER, LabelledPart, labelled_objects


def test_every_label_of_the_package_can_be_learned_from():
    assert len(labelled_objects()) > 400
    for name, each in labelled_objects().items():
        assert each.kind in KINDS, name
        assert each.opens is bool(each.parts), name
        for part in each.parts:
            assert part.box[0] < part.box[2], name
            assert part.box[1] < part.box[3], name
            assert EITHER <= part.way < len(WAYS), name


@pytest.mark.parametrize(
    ("side", "sort", "hinge", "way"),
    [
        (Side.FRONT, Sort.DOOR, "left", PanelWay.LEFT),
        (Side.LEFT, Sort.FLAP, "bottom", PanelWay.BOTTOM),
        (Side.FRONT, Sort.DRAWER, None, PanelWay.OUT),
        (Side.FRONT, Sort.CONTROL, None, PanelWay.OTHER),
        (Side.FRONT, Sort.LID, "back", PanelWay.TOP),
        (Side.BACK, Sort.LID, "back", PanelWay.BOTTOM),
        (Side.TOP, Sort.LID, "back", PanelWay.TOP),
        (Side.RIGHT, Sort.LID, "back", PanelWay.RIGHT),
        (Side.TOP, Sort.LID, "left", PanelWay.LEFT),
        (Side.FRONT, Sort.DOOR, None, None),
    ],
)
def test_a_hinge_is_where_its_side_shows_it_or_at_either_edge(side, sort, hinge, way):
    wanted = EITHER if way is None else WAYS.index(way)
    assert LabelledPart(side, sort, (0.1, 0.2, 0.6, 0.9), hinge).way == wanted


@pytest.fixture
def furniture(tmp_path, monkeypatch):
    """Return a folder made of libraries with one labelled model, that lies on its side."""
    library = tmp_path / "furniture"
    library.mkdir()
    labels = tmp_path / "labels"
    labels.mkdir()
    monkeypatch.setattr(labelled, "LABELS", labels)
    part = {"side": "front", "sort": "door", "box": [0, 0, 1, 1], "hinge": "right"}
    label = {"scopia__red_box": {"kind": "cabinet", "opens": True, "parts": [part]}}
    (labels / "one.json").write_text(json.dumps(label))
    corners = "".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 2) for z in (0, 4))
    faces = "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n"
    for name in sweethome3d.LIBRARIES:
        with zipfile.ZipFile(library / name, "w") as file:
            lines = ["model#1=/a/other.obj", "creator#1=A"]
            if name.startswith("Scopia"):
                lines += ["model#2=/b/red-box.obj", "creator#2=B C"]
                lines += ["modelRotation#2=1 0 0 0 0 1 0 -1 0"]
                file.writestr("b/red-box.obj", "mtllib m.mtl\nusemtl red\n" + corners + faces)
                file.writestr("b/m.mtl", "newmtl red\nKd 1 0 0\n")
            file.writestr(sweethome3d.CATALOGUE, "\n".join(lines))
    labelled_objects.cache_clear()
    sweethome3d.main(library, tmp_path / "out")
    yield tmp_path / "out"
    labelled_objects.cache_clear()


def test_labelled_models_are_written_upright_with_their_authors(furniture):
    rows = list(csv.DictReader((furniture / "INVENTORY.csv").read_text().splitlines()))
    assert rows == [{"file": "scopia__red_box.glb", "license": "CC-BY-3.0", "author": "B C"}]
    mesh = load(furniture / "scopia__red_box.glb", IntakeConfig()).mesh
    assert mesh.extents / mesh.extents[0] == pytest.approx([1.0, 2.0, 4.0])
    (found,) = real_objects(furniture)
    assert found.label == labelled.LabelledObject("cabinet", True, Side.FRONT, found.label.parts)
    (row,) = found.sides.table
    assert WAYS[int(row[7])] is PanelWay.RIGHT
    front = found.sides.color[0].reshape(-1, 3)
    assert (np.unique(front[front.any(axis=1)], axis=0) == [[255, 0, 0]]).all()
