"""The editor finds a mesh and its parts, answers its own page alone, and writes a sidecar alone."""

import http.client
import json
from pathlib import Path

import pytest
from msgspec import to_builtins
from one_piece import doors, drawers, fridge, write_oven
from shown_registry import make_registry
from waiting import running

from asset_factory.factory.articulate.stated import StatedArticulator
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.display.made import scene_of_articulation
from asset_factory.factory.edit.builds import Builds
from asset_factory.factory.edit.editor import editing
from asset_factory.factory.edit.found import found_parts
from asset_factory.factory.edit.subject import Subject, subject_of
from asset_factory.factory.errors import ConfigError, RegistryError
from asset_factory.factory.intake.stated import MOST_BYTES, stated_from
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


def test_the_input_of_an_asset_is_found_by_the_log(tmp_path):
    registry = make_registry(tmp_path / "out")
    (tmp_path / "chest.glb").touch()
    lines = [{"id": "hitting-2", "input": name} for name in ("old.glb", "chest.glb")]
    log = registry.root / "logs" / "builds.jsonl"
    log.parent.mkdir()
    log.write_text("\n".join(["hitting-2 {", '["hitting-2"]', *map(json.dumps, lines)]))
    folder = registry.rejected / "hitting-2"
    for given, output in ((folder, None), (folder.name, registry.root)):
        found = subject_of(Path(given), output, tmp_path / "usual")
        assert found.mesh.resolve() == (tmp_path / "chest.glb").resolve()
        assert (found.output.resolve(), found.asset) == (registry.root.resolve(), folder)
    (tmp_path / "chest.glb").unlink()
    with pytest.raises(ConfigError, match=r"chest\.glb: hitting-2 was made of it"):
        subject_of(folder, None, tmp_path)
    log.unlink()
    with pytest.raises(RegistryError, match="its log does not say"):
        subject_of(folder, None, tmp_path)


DRAWER = {"kind": "drawer", "side": "front", "box": [0.05, 0.38, 0.95, 0.67]}
HATCH = {"kind": "flap", "side": "right", "box": [0.1, 0.1, 0.9, 0.5], "hinge": "top"}
COFFER = {"kind": "lid", "side": "top", "box": [0.1, 0.2, 0.4, 0.8], "hinge": "back"}
LID = {"kind": "lid", "side": "front", "box": [0.0, 0.67, 1.0, 1.0], "hinge": "back"}
LEAF = {"kind": "door", "side": "front", "box": [0.03, 0.04, 0.5, 0.96], "hinge": "left"}
PULL = {"kind": "knob", "side": "front", "box": [0.42, 0.44, 0.47, 0.71], "parent": "west"}


@pytest.mark.parametrize(
    ("mesh", "parts"),
    [
        (drawers(), [DRAWER]),
        (drawers(), [HATCH]),
        (doors(), [COFFER]),
        (fridge(), [LID]),
        (doors(), [{**LEAF, "name": "west"}, PULL]),
    ],
)
def test_what_was_stated_is_found_in_what_it_became(mesh, parts):
    made = StatedArticulator(stated_from({"parts": parts})).articulate(mesh)
    kinds = {part.name: part.kind for part in made.parts}
    found = to_builtins(found_parts(mesh, scene_of_articulation("it", made), kinds))["parts"]
    for part, again in zip(parts, found, strict=True):
        # Handles belong to their panels, and reach beyond their outlines.
        assert again.pop("box") == pytest.approx(part["box"], abs=0.05)
        assert again == {name: value for name, value in part.items() if name != "box"}
