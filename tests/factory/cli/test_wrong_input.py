"""Every command with wrong input says what is wrong, leaves with 2, and does nothing."""

import shlex

import pytest
from shown_registry import make_registry

from asset_factory.factory.cli.commands import COMMANDS, run

pytest.importorskip("mani_skill", reason="solve and demos want it")

NO_REGISTRY = "nowhere: no registry here; `factory build --output nowhere ...` makes one"
NO_ASSET = "no asset 'nobody' in out; "
#: What is typed in a folder that has a registry (out), a text and a folder; and what is told.
TABLE = {
    "build --input nowhere.glb --output new": "nowhere.glb: does not exist, want a mesh",
    "build --input folder --output new": "no input in folder; want .glb",
    "build --input text.txt --output text.txt": "no registry can be made here: Not a directory",
    "build --input text.txt --output new --formats stl": "no format 'stl'; there are urdf",
    "build --input text.txt --output new --device cuda": "torch finds no cuda here that works",
    "build --input text.txt --output new --workers two": "must be a whole number, not 'two'",
    "build --input text.txt --output new --height tall": "must be a number, not 'tall'",
    "build --input text.txt --output new --xacro-arg a=b": "--xacro-arg: 'a=b', want name:=value",
    "build --input text.txt": "Missing from factory build",
    "build --input text.txt --output new --colour red": "Unrecognized options: --colour",
    "build --input text.txt --output new --sim gazebo": "no simulator 'gazebo'; there are sapien",
    "build --input text.txt --output new --config strictest": "no preset 'strictest'; there are",
    "build --input text.txt --output new --config x.toml": "'x.toml': No such file or directory",
    "build --input text.txt --output new --config ../presets/strict": "'../presets/strict'",
    "build --input text.txt --output new --ray-address auto": "want --executor ray",
    "build --input text.txt --output new --executor slurm": "invalid choice 'slurm'",
    "build --input text.txt --output new --workers 0": "--workers must be at least 1, not 0",
    "build --input text.txt --output new --articulator magic": "there are auto, stated, annotated",
    "build --input text.txt --output new --up w": "up axis 'w': want one of x, -x, y",
    "build --input text.txt --output new --limit -1": "limit must be 0 or more, not -1",
    "build --input text.txt --output new --max-hours -1": "time must be 0 or more, not -1 h",
    "build --input text.txt --output new --max-hours nan": "time must be 0 or more, not nan h",
    "build --input text.txt --output new --since lately": "--since must be seconds ago, a date",
    "build --input text.txt --input text.txt --output new": "--input is there twice",
    "buidl --output new": "did you mean 'build'?",
    "zzz --output new": "there are build, check",
    "check": "no URDF, MJCF or USD file given",
    "check text.txt --workers 0": "--workers must be at least 1, not 0",
    "check nowhere": "nowhere: no such file; want a URDF, MJCF or USD file",
    "check folder": "no URDF, MJCF or USD file in folder",
    "check text.txt --json folder": "folder: cannot be written; want a file in a folder",
    "check text.txt --format yaml": "--format must be one of text, json, sarif, junit, markdown",
    "check text.txt --format json,sarif": "or FORMAT=FILE, not 'json,sarif'",
    "check text.txt --format text=a.txt": "or FORMAT=FILE, not 'text=a.txt'",
    "check text.txt --format junit=nowhere/x.xml": "nowhere/x.xml: cannot be written; want",
    "check text.txt --write-baseline nowhere/x.json": "nowhere/x.json: cannot be written",
    "check text.txt --srdf nowhere.srdf": "--srdf: nowhere.srdf is no file",
    "check text.txt --baseline nowhere.json": "no baseline (No such file or directory)",
    "check text.txt --baseline text.txt": "no baseline (not written by factory check)",
    "view nowhere.glb": "nowhere.glb: no such file; want a URDF, an MJCF, a mesh, or --output",
    "view text.txt": "text.txt: unsupported: ",
    "view text.txt --save nowhere/x.html": "nowhere/x.html: cannot be written; want",
    "view text.txt --port 70000": "--port must be 0 to 65535, not 70000",
    "view nobody --output out": NO_ASSET,
    "edit nowhere.glb": "nowhere.glb: no such file or asset; want a mesh",
    "edit text.txt": "parts are stated of a mesh, want one of .glb",
    "edit broken.glb --output new": "broken.glb: unreadable",
    "edit broken.glb --port 70000": "--port must be 0 to 65535, not 70000",
    "edit broken.glb --sim unity": "no simulator 'unity'; there are sapien",
    "list --output nowhere": NO_REGISTRY,
    "list --output out --limit -1": "--limit must be at least 0, not -1",
    "list --output out --where colour=red": "no column 'colour'; there are status",
    "list --output out --where 'status = good'": "status is 'good'; there are passed, rejected,",
    "list --output out --where 'catgory = fridge'": "no column 'catgory'; did you mean 'category'?",
    "list --output out --where 'parts = 1 or joints > 1'": "cannot read 'parts = 1 or joints > 1'",
    "list --output out --where 'category = fridge and'": "cannot read 'and'",
    "list --output out --where 'joints > many'": "joints must be a whole number, not 'many'",
    "list --output out --where 'category > fridge'": "is no number",
    "list --output out --where 'category = a and category = b'": "is there twice",
    "list --output out --where 'status = passed; drop table assets'": "cannot read",
    "show nobody --output out": NO_ASSET,
    "solve nobody --output out": NO_ASSET,
    "solve --output out --joint nobody": "no joint 'nobody' in out; there are 'hinge', 'slide'",
    "solve --output out --robot nobody": "invalid choice 'nobody'",
    "solve --output out --workers 0": "--workers must be at least 1, not 0",
    "solve --output out --timeout 0": "--timeout must be more than 0, not 0 s",
    "demos --output out --to text.txt": "--to: text.txt: File exists; want a folder",
    "demos nobody --output out --to new": NO_ASSET,
    "demos --output out --to new --per-joint 0": "--per-joint must be at least 1, not 0",
    "demos --output out --to new --timeout 0": "--timeout must be more than 0, not 0 s",
    "demos --output out --to new --robot fetch --control-mode pd_ee_pose": "no 'pd_ee_pose'",
    "demos --output out --to new --obs-mode smell": "no 'smell'; want state, state_dict, none",
    "demos --output out --to new --control-mode mind": "invalid choice 'mind'",
    "doctor --jsn": "Perhaps you meant",
    "predict nowhere.glb": "nowhere.glb: no such file; want a mesh, a URDF or an MJCF file",
    "predict text.txt --checkpoint nowhere.pt": "nowhere.pt: no such file",
    "predict text.txt --checkpoint text.txt": "text.txt: not safetensors",
    "predict text.txt --samples 0": "samples must be at least 1, not 0",
    "propose nowhere.glb --to new": "nowhere.glb: no such file; want a mesh",
    "report --output nowhere": NO_REGISTRY,
    "report --output out --workers 0": "--workers must be at least 1, not 0",
    "remove --output out": "want ids, or --where with conditions",
    "remove nobody --output out --yes": NO_ASSET,
    "gc --output out --keep-gb -1": "--keep-gb must be at least 0, not -1",
    "registry rebuild --output folder": "folder: no registry here",
    "registry diff out text.txt": "text.txt: cannot be read (no whole archive)",
    "registry export new --output out --where category=none": "no assets with category=none",
    "registry export out --output out": "out: is there already; name a folder that is not",
    "registry sync file:///new --output out --where tag=none": "no assets with tag=none to hand on",
    "registry import nowhere --output new": "nowhere: no such file or folder",
    "registry tag nobody a --output out": NO_ASSET,
    "weights info nowhere.pt": "nowhere.pt: no such file; want a checkpoint, shipped",
    "nightly --config nowhere.toml": "nowhere.toml: No such file or directory",
    "nightly": "inputs: none; name files or folders in the configuration or by --input",
    "nightly --input nowhere --output new": "nowhere: does not exist",
    "nightly --input folder --output new --sim no": "no simulator 'no'; there are sapien",
    "nightly --input text.txt --output new --name a/b": "--name: is 'a/b', want letters, digits",
    "evaluate --output new --set nothing": "invalid choice 'nothing'",
    "train nothing": "no recipe 'nothing'; there are further, laptop, paper",
    "train nowhere.toml": "recipe 'nowhere.toml': No such file or directory",
}


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with a registry, a text and an empty folder."""
    folder = tmp_path_factory.mktemp("place")
    make_registry(folder / "out")
    (folder / "folder").mkdir()
    (folder / "text.txt").write_text("some words", encoding="utf-8")
    (folder / "broken.glb").write_bytes(b"glTF?")
    return folder


def test_the_table_has_every_command():
    assert {typed.split()[0] for typed in TABLE} >= {command.name for command in COMMANDS}


@pytest.mark.parametrize("typed", TABLE)
def test_wrong_input_is_told_and_nothing_is_done(typed, place, monkeypatch, capsys):
    monkeypatch.chdir(place)
    before = sorted(place.rglob("*"))
    try:
        code = run(shlex.split(typed))
    except SystemExit as left:
        code = left.code
    told = " ".join(capsys.readouterr().err.split())
    assert code == 2
    assert TABLE[typed] in told
    assert sorted(place.rglob("*")) == before
