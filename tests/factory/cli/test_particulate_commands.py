"""`factory predict` and `factory build --articulator particulate`, with an untrained network."""

import hashlib
import json
from dataclasses import replace

import numpy as np
import pytest
from command_line import COMMAND, ran
from repository import FRIDGE
from tiny_checkpoint import write_checkpoint

from asset_factory.factory.articulate.predict import predict
from asset_factory.factory.articulate.settings import require_usable
from asset_factory.factory.cli.commands import run
from asset_factory.factory.config import BuildConfig, ParticulateConfig
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.jobs.job import asks_network


@pytest.fixture(scope="module")
def checkpoint(tmp_path_factory):
    """One that sees three parts in the fridge."""
    return write_checkpoint(tmp_path_factory.mktemp("weights") / "tiny.safetensors", base=7)


def told_of(source, checkpoint=None, **settings):
    named = {"checkpoint": str(checkpoint)} if checkpoint else {}
    particulate = ParticulateConfig(**named, **settings)
    return predict(source, replace(BuildConfig(), particulate=particulate))


@pytest.fixture(scope="module")
def told(checkpoint):
    """What it says of the fridge."""
    return told_of(FRIDGE, checkpoint, points=1500)


def test_the_articulation_alone(told, checkpoint):
    assert told["articulator"] == "particulate"
    assert sum(part["faces"] for part in told["parts"]) == 384
    assert len(told["parts"]) == 3
    names = [part["name"] for part in told["parts"]]
    for joint in told["joints"]:
        assert {joint["parent"], joint["child"]} <= set(names)
        assert joint["type"] in ("revolute", "prismatic", "continuous", "fixed")
        assert np.linalg.norm(joint["axis"]) == pytest.approx(1.0)
        assert joint["lower"] <= 0.0 <= joint["upper"]
        assert 0.0 <= joint["confidence"] <= 1.0
    (weights,) = told["weights"]
    assert weights["file"] == "tiny.safetensors"
    assert weights["digest"] == hashlib.sha256(checkpoint.read_bytes()).hexdigest()
    assert weights["license"].startswith("Not stated in the file.")


def test_features_are_asked_for_where_the_network_wants_them(fixtures):
    model = fixtures / "pat_tiny" / "weights_seed1.safetensors"
    field = fixtures / "partfield_tiny"
    with pytest.raises(ConfigError, match=r"wants 32 features per point.*NON-COMMERCIAL"):
        require_usable(ParticulateConfig(checkpoint=str(model)), needed=True)
    weights = field / "weights_base0.safetensors"
    told = told_of(FRIDGE, model, features=str(weights), points=600, context_points=300)
    assert [each["file"] for each in told["weights"]] == [model.name, weights.name]
    assert "NON-COMMERCIAL" in told["weights"][1]["license"]
    with pytest.raises(ConfigError, match="weights_seed1"):
        require_usable(ParticulateConfig(checkpoint=str(model), features=str(model)), needed=True)


def test_without_a_checkpoint_the_shipped_network_and_the_shapes_are_asked():
    told = told_of(FRIDGE)
    assert told["articulator"] == "auto"
    files = [each["file"] for each in told["weights"]]
    assert files == ["small.safetensors", "detector.safetensors"]
    assert told["weights"][0]["license"].startswith("Apache-2.0")
    assert {joint["type"] for joint in told["joints"]} == {"revolute"}


def test_without_torch_auto_is_refused_before_anything_is_made(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr("asset_factory.factory.articulate.settings.find_spec", lambda name: None)
    build = ["build", "--input", str(FRIDGE), "--output", str(tmp_path / "out"), "--sim", "mujoco"]
    assert run(build) == 2
    told = capsys.readouterr().err
    assert "needs torch: pip install 'asset-factory[particulate]'" in told
    assert "--articulator geometric" in told
    assert not (tmp_path / "out").exists()
    with pytest.raises(ConfigError, match="needs torch"):
        told_of(FRIDGE)
    # Joints that came with the input, and rules of shape, need none.
    (tmp_path / "box.urdf").write_text("<robot name='box'><link name='box'/></robot>")
    assert not asks_network([tmp_path / "box.urdf"], BuildConfig())
    told = predict(FRIDGE, replace(BuildConfig(), articulator="geometric"))
    assert (told["articulator"], told["weights"]) == ("geometric", [])


def test_predict_prints_what_it_was_told(capsys, told, checkpoint):
    arguments = ["predict", str(FRIDGE), "--checkpoint", str(checkpoint), "--points", "1500"]
    assert run([*arguments, "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == told


def test_predict_refuses_more_faces_than_the_limit_with_both_numbers(capsys, tmp_path):
    limits = tmp_path / "small.toml"
    limits.write_text("[intake]\nmax_faces = 100\n")
    assert run(["predict", str(FRIDGE), "--config", str(limits)]) == 1
    told = capsys.readouterr().out
    assert told.startswith("rejected: too_large: fridge.obj: 101 faces, the limit is 100")


def test_a_build_with_weights_ends_in_a_verdict(tmp_path, checkpoint):
    output = tmp_path / "out"
    command = [*COMMAND, "build", "--input", FRIDGE, "--sim", "mujoco", "--no-report"]
    command += ["--output", output, "--articulator", "particulate"]
    ran(*command, "--checkpoint", checkpoint, "--points", "1500")
    summary = json.loads((output / "summary.json").read_text())
    assert (summary["inputs"], summary["unjudged"]) == (1, 0), summary
    (row,) = summary["assets"]
    assert (row["parts"], row["joints"]) == (3, 2)
    assert row["hulls"] > 2
    place = "assets" if row["status"] == "passed" else "rejected"
    report = json.loads((output / place / row["id"] / "report.json").read_text())
    assert any(finding["code"] == "articulation_note" for finding in report["findings"])
