"""The editor answers its own page alone, reads strictly, and writes nothing but the sidecar."""

import http.client
import json

import pytest
from edited_mesh import write_oven
from waiting import running

from asset_factory.factory.config import BuildConfig
from asset_factory.factory.edit.builds import Builds
from asset_factory.factory.edit.editor import editing
from asset_factory.factory.edit.subject import Subject
from asset_factory.factory.intake.stated import MOST_BYTES
from asset_factory.factory.report.site.server import HOST

DOOR = {"kind": "flap", "side": "front", "box": [0.0, 0.0, 1.0, 0.82], "hinge": "bottom"}
KNOB = {"kind": "knob", "side": "front", "box": [0.4, 0.85, 0.6, 0.95]}


class Served:
    """A running editor, asked as a browser would."""

    def __init__(self, subject, url):
        self.subject = subject
        self.port, self.token = int(url.split(":")[2].split("/")[0]), url.split("/")[3]

    def ask(self, method, name, body=None, *, token=None, **headers):
        connection = http.client.HTTPConnection(HOST, self.port, timeout=60)
        token = self.token if token is None else token
        connection.request(method, f"/{token}/{name}", body, headers)
        answer = connection.getresponse()
        return answer.status, answer.read()

    def post(self, name, statement, **headers):
        status, body = self.ask("POST", name, json.dumps(statement), **headers)
        return status, body if body[:4] == b"glTF" else json.loads(body or "null")


@pytest.fixture(scope="module")
def editor(tmp_path_factory):
    folder = tmp_path_factory.mktemp("edited")
    (folder / "secret.txt").write_text("secret")
    subject = Subject(write_oven(folder), folder / "out")
    builds = Builds(("build", "--no-such-flag"))
    with editing(subject, BuildConfig(), builds) as server, running(server):
        yield Served(subject, server.url)


@pytest.mark.parametrize("name", ["", "state", "edit.js", "sides/-y/front.png", "model.glb"])
def test_what_the_page_needs_is_there_for_who_knows_the_token(editor, name):
    status, body = editor.ask("GET", name)
    assert (status, bool(body)) == (200, True)
    for token in ("", "wrong", editor.token[:-1], "%C3%BC"):
        assert editor.ask("GET", name, token=token) == (404, b"")
    for host in ("attacker.example", f"attacker.example:{editor.port}", ""):
        assert editor.ask("GET", name, Host=host) == (404, b"")


@pytest.mark.parametrize(
    "path",
    [
        "../secret.txt",
        "%2e%2e/secret.txt",
        "sides/../../secret.txt",
        "sides/-y/../../secret.txt",
        "sides/z/front.png",
        "oven.glb",
        "/etc/passwd",
        "static/edit.js",
        "state/",
        "edit.html.j2",
    ],
)
def test_no_other_file_is_within_reach(editor, path):
    assert editor.ask("GET", path) == (404, b"")


def test_another_page_cannot_have_anything_written(editor):
    statement = {"parts": [DOOR]}
    for headers in ({"Origin": "http://attacker.example"}, {"Origin": "null"}, {"Host": "a.b"}):
        assert editor.post("save", statement, **headers) == (404, None)
    assert editor.ask("GET", "save")[0] == 404
    assert editor.ask("PUT", "save", b"{}")[0] == 501
    assert not editor.subject.sidecar.exists()


def test_bodies_are_bounded_before_they_are_read(editor):
    assert editor.ask("POST", "save", **{"Content-Length": str(MOST_BYTES + 1)})[0] == 413
    assert editor.ask("POST", "save", **{"Content-Length": "9" * 5000})[0] == 413
    assert editor.ask("POST", "save", **{"Content-Length": "-1"})[0] == 411
    assert editor.ask("POST", "save", **{"Transfer-Encoding": "chunked"})[0] == 411


@pytest.mark.parametrize(
    ("statement", "said"),
    [
        ({"parts": [{**DOOR, "kind": "dor"}]}, "$.parts[0].kind is 'dor'; did you mean 'door'?"),
        ({"parts": [DOOR, {**DOOR, "box": [0.5, 0, 0.5, 1]}]}, "$.parts[1]"),
        ([], "Expected `object`"),
        ("[" * 100_000, "Expected `object`"),
    ],
)
def test_a_wrong_statement_is_told_in_the_readers_words_and_not_written(editor, statement, said):
    for name in ("preview", "save", "build"):
        status, told = editor.post(name, statement)
        assert status == 422
        assert said in told["sentence"]
    assert editor.ask("POST", "save", b"{")[0] == 422
    beside = sorted(path.name for path in editor.subject.mesh.parent.iterdir())
    assert beside == ["oven.glb", "secret.txt"]


def test_a_part_that_is_not_there_says_which(editor):
    status, told = editor.post("preview", {"parts": [KNOB, {**DOOR, "hinge": "back"}]})
    assert status == 422
    assert "parts[1] (flap): is hinged at its back" in told["sentence"]


def test_a_preview_opens_what_is_stated(editor):
    status, model = editor.post("preview", {"parts": [DOOR]})
    assert status == 200
    extras = json.loads(model[20 : model.index(b"BIN\x00") - 4])["extras"]
    assert extras["links"] == ["base", "stated.0"]
    assert [joint["kind"] for joint in extras["joints"]] == ["revolute"]


def test_the_sidecar_is_written_whole_or_not_at_all(editor):
    sidecar = editor.subject.sidecar
    body = json.dumps({"parts": [DOOR]})
    sidecar.mkdir()
    status, answer = editor.ask("POST", "save", body)
    assert (status, b"oven.parts.json: cannot be written" in answer) == (422, True)
    sidecar.rmdir()
    assert editor.ask("POST", "save", body)[0] == 200
    assert sidecar.read_text() == body
    assert not list(sidecar.parent.glob(".writing-*"))
    assert json.loads(editor.ask("GET", "state")[1])["stated"] == json.loads(body)
    sidecar.write_text('{"parts": [{"kind": "dor"}]}')
    state = json.loads(editor.ask("GET", "state")[1])
    assert "did you mean 'door'?" in state["sentence"]
    assert state["text"] == sidecar.read_text()
    sidecar.unlink()


def test_a_build_that_fails_says_why_and_one_that_is_stopped_is_gone(editor):
    assert editor.post("build", {"parts": [DOOR]})[0] == 200
    told = {"state": "running"}
    while told["state"] == "running":
        told = json.loads(editor.ask("GET", "verdict")[1])
    assert (told["state"], "--no-such-flag" in told["sentence"]) == ("failed", True)
    assert editor.ask("GET", "built.glb")[0] == 422
    editor.post("build", {"parts": [DOOR]})
    editor.post("stop", {})
    while told["state"] == "running" or "stopped" not in told["sentence"]:
        told = json.loads(editor.ask("GET", "verdict")[1])
    editor.subject.sidecar.unlink()


def test_a_statement_in_toml_is_kept_and_outranked(tmp_path):
    subject = Subject(tmp_path / "oven.glb", tmp_path)
    (tmp_path / "oven.parts.toml").touch()
    assert (subject.existing.name, subject.sidecar.name) == ("oven.parts.toml", "oven.parts.json")
    (tmp_path / "oven.glb.parts.json").touch()
    assert subject.sidecar.name == "oven.glb.parts.json"
