"""What is shown of an asset stays with it, and with what was rejected."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from export_samples import PROVENANCE, box, cabinet
from registry_samples import BAD_REPORT, REJECTED

from asset_factory.factory.config import BuildConfig
from asset_factory.factory.display.glb import scene_from
from asset_factory.factory.export.bundle import export_bundle, write_input, write_model
from asset_factory.factory.intake.source import Source
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.product import SHOWN, finished
from asset_factory.factory.registry.registration import register
from asset_factory.factory.registry.verify import verify
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.verify.validate import Verdict
from asset_factory.sim_checks import Finding, Report, Severity


def test_an_input_that_became_nothing_can_be_looked_at(tmp_path):
    folder = write_input(box([0, 0, 1], [1, 2, 3]), tmp_path / "input")
    scene = scene_from((folder / "view.glb").read_bytes())
    assert (scene.links, scene.movable, len(scene.visuals)) == (("object",), (), 1)
    with pytest.raises(FileExistsError):
        write_input(box([0, 0, 0], [1, 1, 1]), tmp_path)


def test_what_was_rejected_keeps_what_is_shown_and_no_asset(tmp_path):
    registry = Registry(tmp_path / "out", create=True)
    source = tmp_path / "cabinet.stl"
    source.write_bytes(b"solid\nendsolid\n")
    asset = cabinet()
    bad = Finding("rest_penetration", Severity.ERROR, "5 mm deep")
    with registry.staging_folder() as staging:
        bundle = export_bundle(asset, PROVENANCE, staging / "0")
        write_model(asset, bundle.folder)
        verdict = Verdict(Report("asset.urdf", findings=(bad,)))
        config = BuildConfig()
        origin = Source(source, config)
        intake = SimpleNamespace(name="cabinet", provenance=PROVENANCE)
        product = finished(origin, intake, bundle, verdict, (), Stages(config, None))
        result = register(registry, product)
    kept = {path.name for path in registry.folder(result.entry).iterdir()}
    assert kept == {*SHOWN, "report.json"}
    # Of what became nothing there is the report alone.
    folder = registry.add(replace(REJECTED, id="chest-1"), BAD_REPORT)
    assert [path.name for path in folder.iterdir()] == ["report.json"]
    assert verify(registry) == ()
