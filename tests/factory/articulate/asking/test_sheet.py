"""Pictures show where a box's shares are, the same ones each time."""

import io
import json
from dataclasses import replace

import numpy as np
import trimesh
from one_piece import fridge
from PIL import Image

from asset_factory.factory.articulate.asking.drawing import drawn_side
from asset_factory.factory.articulate.asking.sheet import largest_side, sheet_of
from asset_factory.factory.articulation import rotation_about
from asset_factory.factory.cli.commands import run
from asset_factory.factory.mesh import Material
from asset_factory.factory.views.raster import Side


def test_a_seam_is_dark_at_its_share_of_the_side():
    for picture in drawn_side(fridge(), Side.FRONT, 400, 400):
        rows, columns = picture.shape[:2]
        assert rows == 400
        assert abs(columns - 400 * 0.6 / 1.6) <= 2
        ink = picture[:, int(0.8 * columns)].mean(axis=1)
        inner = slice(20, -20)
        darkest = 20 + int(ink[inner].argmin())
        assert abs((1.0 - darkest / rows) - 1.1 / 1.6) < 0.01


def test_the_side_that_shows_most_is_large():
    turned = [fridge().turned(rotation_about([0.0, 0.0, 1.0], -np.pi / 2.0 * k)) for k in range(4)]
    assert [largest_side(mesh) for mesh in turned] == [Side.FRONT, Side.LEFT, Side.BACK, Side.RIGHT]


def test_a_dark_object_is_drawn_lighter():
    black = replace(fridge(), materials=(Material("black", (0.02, 0.02, 0.02, 1.0)),))
    colored, _ = drawn_side(black, Side.FRONT, 200, 200)
    assert np.median(colored) > 60


def test_the_same_mesh_gives_the_same_sheet():
    first = sheet_of(fridge())
    assert first == sheet_of(fridge())
    with Image.open(io.BytesIO(first)) as opened:
        assert np.asarray(opened).std() > 10
        assert max(opened.size) < 2000


def test_propose_writes_what_is_asked_and_what_may_be_answered(tmp_path, capsys):
    mesh = tmp_path / "fridge.stl"
    made = fridge()
    trimesh.Trimesh(made.vertices, made.faces, process=False).export(mesh)
    assert run(["propose", str(mesh), "--to", str(tmp_path / "asked")]) == 0
    assert "fridge.parts.json" in capsys.readouterr().out
    written = {path.name for path in (tmp_path / "asked").iterdir()}
    assert written == {"sheet.png", "instruction.txt", "parts.schema.json"}
    told = (tmp_path / "asked" / "instruction.txt").read_text()
    assert "'fridge.stl'" in told
    json.loads((tmp_path / "asked" / "parts.schema.json").read_text())
