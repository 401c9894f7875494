"""What non-commercial weights helped to make says so wherever it goes."""

import json
from dataclasses import replace

import pytest
from repository import FRIDGE
from tiny_checkpoint import write_checkpoint

from asset_factory.factory import build as pipeline
from asset_factory.factory.articulate.particulate import load_articulator
from asset_factory.factory.articulation import Weights
from asset_factory.factory.build import build_asset
from asset_factory.factory.cli.commands import run
from asset_factory.factory.config import BuildConfig, ParticulateConfig
from asset_factory.factory.intake.licenses import combined
from asset_factory.factory.jobs.nightly.licenses import Licenses
from asset_factory.factory.registry import Registry

BOUND = "LicenseRef-NonCommercial"


def test_weights_bind_what_they_make_by_their_header(tmp_path):
    about = {"terms": "Ask first.", "outputs": BOUND}
    file = write_checkpoint(tmp_path / "own.safetensors", base=7, metadata=about)
    (weights,) = load_articulator(ParticulateConfig(checkpoint=str(file))).weights
    assert (weights.license, weights.outputs) == ("Ask first.", BOUND)


def test_licenses_are_combined_once():
    assert combined("CC0-1.0", ()) == "CC0-1.0"
    assert combined(None, [BOUND]) == f"unknown; {BOUND}"
    assert combined(f"CC0-1.0; {BOUND}", [BOUND]) == f"CC0-1.0; {BOUND}"


@pytest.fixture
def bound(monkeypatch):
    """Has all that is built made with the help of such weights."""
    standing = pipeline.standing_hypotheses
    weights = (Weights("paper.pt", "0" * 64, "Not for sale.", BOUND),)

    def helped(*arguments):
        intake, found = standing(*arguments)
        return intake, tuple(replace(each, weights=weights) for each in found)

    monkeypatch.setattr(pipeline, "standing_hypotheses", helped)


def test_an_asset_carries_the_terms_of_weights_to_every_export(bound, tmp_path, capsys):
    out = tmp_path / "out"
    config = replace(BuildConfig(), articulator="geometric", simulators=())
    entry = build_asset(FRIDGE, out, config).entry
    assert entry.license.endswith(f"; {BOUND}")
    manifest = json.loads((out / "assets" / entry.id / "asset.json").read_text())
    assert manifest["license"] == entry.license
    assert manifest["provenance"]["weights"][0]["outputs"] == BOUND
    for gate in (Licenses(("Apache-2.0",)), Licenses(("Apache-2.0", "unknown"))):
        assert not gate.allow(entry.license)
    capsys.readouterr()
    assert run(["list", "--output", str(out), "--where", f'license = "{entry.license}"']) == 0
    assert entry.id in capsys.readouterr().out
    assert run(["list", "--output", str(out), "--where", "license = Apache-2.0"]) == 0
    assert entry.id not in capsys.readouterr().out
    folder = tmp_path / "dataset"
    told = ["registry", "export", str(folder), "--output", str(out), "--layout", "huggingface"]
    assert run(told) == 0
    assert "license: other" in (folder / "README.md").read_text()
    assert BOUND in (folder / "LICENSES.md").read_text()
    assert BOUND in (folder / "entries.jsonl").read_text()
    again = Registry(tmp_path / "again", create=True)
    assert run(["registry", "import", str(folder), "--output", str(again.root)]) == 0
    assert Registry(again.root).entry(entry.id).license == entry.license


def test_a_gate_refuses_what_such_weights_made(bound, tmp_path):
    config = replace(BuildConfig(), articulator="geometric", simulators=())
    gated = replace(
        config, intake=replace(config.intake, allowed_licenses=("Apache-2.0", "unknown"))
    )
    entry = build_asset(FRIDGE, tmp_path / "out", gated).entry
    assert (entry.status, entry.reason) == ("rejected", "license_disallowed")
    assert BOUND in entry.message
