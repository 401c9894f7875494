"""Pictures show where a box's shares are, the same ones each time."""

import io
import json

import numpy as np
from one_piece import fridge
from PIL import Image

from asset_factory.factory.articulate.asking.drawing import drawn_side
from asset_factory.factory.articulate.asking.sheet import sheet_of
from asset_factory.factory.cli.commands import run
from asset_factory.factory.geometry.crossings import Side


def test_a_seam_is_dark_at_its_share_of_the_side():
    for picture in drawn_side(fridge(), Side.FRONT, 400, 400):
        rows, columns = picture.shape[:2]
        assert rows == 400
        assert abs(columns - 400 * 0.6 / 1.6) <= 2
        ink = picture[:, int(0.8 * columns)].mean(axis=1)
        inner = slice(20, -20)
        darkest = 20 + int(ink[inner].argmin())
        assert abs((1.0 - darkest / rows) - 1.1 / 1.6) < 0.01


def test_the_same_mesh_gives_the_same_sheet():
    first = sheet_of(fridge())
    assert first == sheet_of(fridge())
    with Image.open(io.BytesIO(first)) as opened:
        assert np.asarray(opened).std() > 10
        assert max(opened.size) < 2000


def test_propose_writes_what_is_asked_and_what_may_be_answered(tmp_path, capsys):
    mesh = tmp_path / "fridge.stl"
    made = fridge()
    corners = made.vertices[made.faces]
    records = np.zeros(len(corners), dtype=[("n", "<3f4"), ("c", "<9f4"), ("a", "<u2")])
    records["c"] = corners.reshape(-1, 9)
    head = bytes(80) + np.uint32(len(corners)).tobytes()
    mesh.write_bytes(head + records.tobytes())
    assert run(["propose", str(mesh), "--to", str(tmp_path / "asked")]) == 0
    assert "fridge.parts.json" in capsys.readouterr().out
    assert {path.name for path in (tmp_path / "asked").iterdir()} == {
        "sheet.png",
        "instruction.txt",
        "parts.schema.json",
    }
    told = (tmp_path / "asked" / "instruction.txt").read_text()
    assert "'fridge.stl'" in told
    json.loads((tmp_path / "asked" / "parts.schema.json").read_text())
