"""A model is shown the sides, asked by a protocol, corrected and paid once, never just believed."""

import io
import json
import threading
import time
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from one_piece import fridge
from PIL import Image
from refusing import refusal
from werkzeug import Request, Response
from werkzeug.serving import make_server

from asset_factory.factory.articulate.asking import endpoint, question
from asset_factory.factory.articulate.asking.articulator import VlmArticulator
from asset_factory.factory.articulate.asking.drawing import drawn_side
from asset_factory.factory.articulate.asking.endpoint import require_endpoint
from asset_factory.factory.articulate.asking.sheet import largest_side, sheet_of
from asset_factory.factory.articulation import rotation_about
from asset_factory.factory.cli.commands import run
from asset_factory.factory.config import VlmConfig
from asset_factory.factory.errors import ConfigError, Unjudged
from asset_factory.factory.mesh import Material
from asset_factory.factory.views.raster import Side

DOOR = {"kind": "door", "side": "front", "box": [0, 0.68, 1, 1], "hinge": "right"}
GOOD = json.dumps({"parts": [DOOR]})
KEY = "sk-very-secret"


def completion(text):
    usage = {"prompt_tokens": 1200, "completion_tokens": 34}
    body = {"choices": [{"message": {"role": "assistant", "content": text}}], "usage": usage}
    return 200, json.dumps(body).encode()


class Server:
    """Answers one request after the other as it was told; the last answer for ever."""

    def __init__(self):
        self.asked = []
        self.answers = []
        self.wait_s = 0.0
        self.http = make_server("127.0.0.1", 0, Request.application(self.answer), threaded=True)
        threading.Thread(target=self.http.serve_forever, daemon=True).start()
        self.url = f"http://127.0.0.1:{self.http.server_port}/v1"

    def answer(self, request):
        self.asked.append((request.path, dict(request.headers), request.json))
        time.sleep(self.wait_s)
        status, body = self.answers[min(len(self.asked), len(self.answers)) - 1]
        return Response(body, status, {"Retry-After": "0"})


@pytest.fixture
def server(monkeypatch):
    monkeypatch.setenv("ASSET_FACTORY_VLM_KEY", KEY)
    monkeypatch.setattr(endpoint, "LONGEST_PAUSE_S", 0.0)
    made = Server()
    yield made
    made.http.shutdown()
    made.http.server_close()


@pytest.fixture(scope="module")
def drawn():
    """A fridge and its sheet of pictures, which takes two seconds to draw."""
    mesh = fridge()
    return mesh, sheet_of(mesh)


@pytest.fixture
def ask(server, drawn, tmp_path, monkeypatch):
    sheets = {id(drawn[0]): drawn[1]}
    monkeypatch.setattr(question, "sheet_of", lambda mesh: sheets[id(mesh)])

    def asked(*answers, model="eyes-1", **settings):
        server.answers = list(answers)
        config = VlmConfig(server.url, model, answers=str(tmp_path / "answers"), **settings)
        return VlmArticulator("fridge.glb", config).hypotheses(drawn[0])

    return asked


def test_a_good_answer_is_found_on_the_mesh_and_asked_for_once(server, ask, tmp_path):
    (tree,) = ask(completion(f"```json\n{GOOD}\n```"))
    assert (tree.articulator, [part.kind for part in tree.parts]) == ("vlm", ["body", "door"])
    assert tree.parts[1].source.proposer == "vlm"
    assert tree.notes[-1] == ("eyes-1 at 127.0.0.1 said what opens: 1200 tokens read, 34 written")
    path, headers, body = server.asked[0]
    assert path == "/v1/chat/completions"
    assert headers["Authorization"] == f"Bearer {KEY}"
    assert (body["temperature"], body["response_format"]["type"]) == (0, "json_schema")
    text, picture = body["messages"][0]["content"]
    assert "fridge.glb" in text["text"]
    assert picture["image_url"]["url"].startswith("data:image/png;base64,iVBOR")
    assert ask(completion("never asked"))[0].notes == tree.notes
    assert len(server.asked) == 1
    for kept in (tmp_path / "answers").iterdir():
        assert KEY not in kept.read_text()


@pytest.mark.parametrize(
    ("bad", "wrong"),
    [
        ("I see a fridge.", "not in the form"),
        ('{"parts": [{"kind": "dor"}]}', "did you mean 'door'?"),
        (json.dumps({"parts": [{**DOOR, "hinge": "back"}]}), "is hinged at its back"),
        ("[" * 60_000, "not in the form"),
        ('{"parts": [{"kind": "door", "name": "<script>"}]}', "name is a letter"),
    ],
)
def test_a_bad_answer_is_asked_for_again_with_what_is_wrong(server, ask, bad, wrong):
    (made,) = ask(completion(bad), completion(GOOD))
    assert len(made.parts) == 2
    assert "2400 tokens read" in made.notes[-1]
    _, said, correction = server.asked[1][2]["messages"]
    assert (said["role"], said["content"]) == ("assistant", bad)
    assert wrong in correction["content"]


@pytest.mark.parametrize(
    "lie",
    [
        (200, b"not json"),
        (200, b'{"choices": []}'),
        (200, b"x" * 3_000_000),
        (200, b"[" * 100_000),
        completion(None),
        completion("x" * 500_000),
        completion("{}" * 3),
    ],
)
def test_whoever_never_answers_in_the_form_is_asked_twice_and_kept_nowhere(
    server, ask, tmp_path, lie
):
    found = refusal(ask, lie)
    assert found.code == "bad_answer"
    assert len(server.asked) == 2
    assert len(found.message) < 500
    assert not (tmp_path / "answers").exists()


def test_a_busy_endpoint_is_asked_again_and_a_dead_one_is_no_verdict(server, ask):
    assert len(ask((429, b"slow down"), (503, b""), completion(GOOD))) == 1
    with pytest.raises(Unjudged, match="no answer in 3 tries; HTTP 500: broken") as caught:
        ask((500, b"broken"), model="eyes-2")
    assert caught.value.finding.code == "model_unavailable"
    server.wait_s = 0.5
    with pytest.raises(Unjudged, match="ReadTimeout"):
        ask(completion(GOOD), wait_s=0.1, model="eyes-2")


def test_an_endpoint_that_knows_no_forms_is_asked_without(server, ask):
    assert len(ask((400, b"response_format?"), completion(GOOD))) == 1
    assert "response_format" not in server.asked[1][2]


def test_a_refusal_names_no_key(ask):
    with pytest.raises(ConfigError, match="HTTP 401: bad key") as caught:
        ask((401, f"bad key {KEY}".encode()))
    assert KEY not in str(caught.value)


@pytest.mark.parametrize(
    ("url", "model", "said"),
    [
        ("", "m", "--vlm-url"),
        ("file:///etc/passwd", "m", "--vlm-url"),
        ("http://me:secret@host/v1", "m", "holds a password"),
        ("http://host/v1", "", "--vlm-model"),
    ],
)
def test_an_endpoint_that_cannot_be_is_said_before_anything_is_asked(url, model, said):
    with pytest.raises(ConfigError, match=said):
        require_endpoint(VlmConfig(url, model))


def test_a_seam_is_dark_at_its_share_of_the_side():
    for picture in drawn_side(fridge(), Side.FRONT, 400, 400):
        rows, columns = picture.shape[:2]
        assert rows == 400
        assert abs(columns - 400 * 0.6 / 1.6) <= 2
        ink = picture[:, int(0.8 * columns)].mean(axis=1)
        darkest = 20 + int(ink[slice(20, -20)].argmin())
        assert abs((1.0 - darkest / rows) - 1.1 / 1.6) < 0.01


def test_the_side_that_shows_most_is_large():
    turned = [fridge().turned(rotation_about([0.0, 0.0, 1.0], -np.pi / 2.0 * k)) for k in range(4)]
    assert [largest_side(mesh) for mesh in turned] == [Side.FRONT, Side.LEFT, Side.BACK, Side.RIGHT]


def test_a_dark_object_is_drawn_lighter():
    black = replace(fridge(), materials=(Material("black", (0.02, 0.02, 0.02, 1.0)),))
    colored, _ = drawn_side(black, Side.FRONT, 200, 200)
    assert np.median(colored) > 60


def test_the_same_mesh_gives_the_same_sheet(drawn):
    mesh, first = drawn
    assert first == sheet_of(mesh)
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
    assert "'fridge.stl'" in (tmp_path / "asked" / "instruction.txt").read_text()
    json.loads((tmp_path / "asked" / "parts.schema.json").read_text())
