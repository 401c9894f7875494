"""The configuration of nights: what is shipped, what is refused, and what flags change."""

import tomllib
from dataclasses import asdict
from pathlib import Path

import fsspec  # noqa: TID253
import pytest
from laid import laid
from repository import ROOT

from asset_factory.factory.cli.nightly import Nightly, night_config
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.jobs.nightly.licenses import Licenses, sort_out
from asset_factory.factory.jobs.nightly.settings import NightConfig, load_night
from asset_factory.factory.jobs.nightly.work import Work

SHIPPED = ROOT / "configs" / "nightly.toml"


def written(folder, text):
    return laid(folder / "night.toml", text)


def test_the_shipped_file_states_every_setting_and_its_tables_the_defaults():
    config = night_config(Nightly(SHIPPED))
    assert config.build.simulators == ("sapien", "mujoco", "pybullet")
    assert config.inputs == (ROOT / "examples" / "meshes",)
    for table in ("budget", "licenses", "upkeep", "failure"):
        assert getattr(config, table) == getattr(NightConfig(), table)
    stated = tomllib.loads(SHIPPED.read_text())
    assert set(stated) == set(asdict(NightConfig()))
    for table in ("budget", "licenses", "upkeep", "failure"):
        assert set(stated[table]) == set(asdict(getattr(NightConfig(), table)))


def test_paths_start_from_the_file_and_flags_from_here(tmp_path, monkeypatch):
    text = "inputs = ['../meshes', '/data/more']\noutput = '../out'\npreset = 'own.toml'\n"
    path = written(tmp_path / "configs", text)
    laid(tmp_path / "configs" / "own.toml", "[decompose]\nerror_m = 0.002\n")
    monkeypatch.chdir(tmp_path)
    config = night_config(Nightly(path))
    assert config.inputs == (tmp_path / "meshes", Path("/data/more"))
    assert config.output == tmp_path / "out"
    assert config.build.decompose.error_m == 0.002
    flags = {"output": Path("there"), "workers": 3, "limit": 5, "sim": "mujoco"}
    flagged = night_config(Nightly(path, input=(Path("mine"),), **flags))
    assert flagged.inputs == (tmp_path / "mine",)
    assert flagged.output == tmp_path / "there"
    assert (flagged.workers, flagged.budget.limit, flagged.build.simulators) == (3, 5, ("mujoco",))
    assert flagged.budget.max_hours == config.budget.max_hours


def test_the_build_table_changes_what_it_names(tmp_path):
    text = "[build]\narticulator = 'geometric'\n[build.decompose]\nerror_m = 0.01\n"
    text += "[build.particulate]\nfeatures = 'f.ckpt'\n"
    build = load_night(written(tmp_path, text)).build
    assert (build.articulator, build.decompose.error_m) == ("geometric", 0.01)
    assert build.particulate.features == str(tmp_path / "f.ckpt")
    assert build.particulate.checkpoint == BuildConfig().particulate.checkpoint


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("outputs = 'x'\n", "no setting 'outputs'; there are .*; did you mean 'output'"),
        ("[build.decompose]\nerror = 1\n", "build: decompose: no setting 'error'"),
        ("[failure]\nyield_drop = 5\n", "failure.yield_drop must be a share from 0 to 1, not 5"),
        ("[failure]\nyield_drop = nan\n", "failure.yield_drop"),
        ("[failure]\nover = 'some'\n", "failure.over must be all or shared, not 'some'"),
        ("[budget]\nmax_hours = -1.0\n", "budget.max_hours must be at least 0, not -1"),
        ("workers = -2\n", "workers must be"),
        ("sim = 'sapien,unity'\n", "no simulator 'unity'"),
        ("inputs = 'meshes'\n", "inputs must be"),
        ("inputs = []\n", "inputs: none"),
        ("build = 3\n", "must be a table"),
        ("preset = 'slow'\n", "no preset 'slow'"),
        ("executor = 'slurm'\n", "executor must be local or ray, not 'slurm'"),
        ("[build]\narticulator = 'magic'\n", "build.articulator must be"),
        ("[licenses]\nallowed = [3]\n", "licenses.allowed"),
        (
            "[licenses]\nallowed = ['a']\n[build.intake]\nallowed_licenses = ['b']\n",
            "want one of them",
        ),
        ("a = = 3\n", "night.toml"),
    ],
)
def test_mistakes_are_named(tmp_path, text, sentence):
    path = written(tmp_path, text if "inputs" in text else f"inputs = ['.']\n{text}")
    with pytest.raises(ConfigError, match=sentence):
        night_config(Nightly(path))


@pytest.mark.parametrize(
    ("text", "allowed"),
    [
        ("", ()),
        ("[licenses]\nallowed = ['CC0-1.0']\n", ("CC0-1.0", "unknown")),
        ("[licenses]\nallowed = ['CC0-1.0']\nunknown = false\n", ("CC0-1.0",)),
        ("[licenses]\nunknown = false\n", ("*",)),
        ("[build.intake]\nallowed_licenses = ['CC0-1.0']\n", ("CC0-1.0",)),
    ],
)
def test_the_build_refuses_what_only_loading_tells(tmp_path, text, allowed):
    config = night_config(Nightly(written(tmp_path, f"inputs = ['.']\n{text}")))
    assert config.build.intake.allowed_licenses == allowed


def test_inputs_with_another_license_are_left_out(tmp_path):
    sidecars = {"free": "license = 'CC0-1.0'\n", "sold": "license = 'Proprietary'\n"}
    sidecars |= {"bare": None, "broken": "license = ="}
    paths = []
    for name, text in sidecars.items():
        paths.append(tmp_path / f"{name}.glb")
        if text is not None:
            (tmp_path / f"{name}.toml").write_text(text)
    kept, left = sort_out(paths, Licenses(("cc0-1.0",)))
    assert [path.stem for path in kept] == ["free", "bare", "broken"]
    assert [(Path(item.input).stem, item.license) for item in left] == [("sold", "Proprietary")]
    assert sort_out(paths, Licenses()) == (tuple(paths), ())


def test_inputs_may_lie_behind_urls(tmp_path):
    fsspec.filesystem("memory").pipe_file("/nightly/in/a.stl", b"solid a")
    text = "inputs = ['memory://nightly/in', 'meshes']\noutput = 'out'\n"
    (tmp_path / "meshes").mkdir()
    config = night_config(Nightly(written(tmp_path, text)))
    assert config.inputs == ("memory://nightly/in", tmp_path / "meshes")
    (found,) = Work(config).find()
    assert found.read_bytes() == b"solid a"
    assert found.is_relative_to(tmp_path / "out" / ".inputs")
    flagged = night_config(Nightly(written(tmp_path, text), input=("memory://x", "here")))
    assert flagged.inputs == ("memory://x", Path.cwd() / "here")
    with pytest.raises(ConfigError, match="output must be"):
        load_night(written(tmp_path, "output = 's3://b/out'\n"))
