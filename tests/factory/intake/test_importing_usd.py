"""A USD asset with physics joints is an input as a URDF is; nothing outside its folder is read."""

import zipfile

import numpy as np
import pytest

pytest.importorskip("pxr")
from refusing import refusal
from usda import CABINET, stage, write

from asset_factory.factory.articulate.annotated import articulator_for
from asset_factory.factory.config import BuildConfig, IntakeConfig
from asset_factory.factory.intake.importers import usd
from asset_factory.factory.intake.importers.usd import import_usd
from asset_factory.factory.intake.load import load
from asset_factory.factory.intake.reads import ReadLog

CONFIG = BuildConfig(articulator="annotated")


@pytest.fixture(autouse=True)
def read_here(request, monkeypatch):
    """Spare every read a child process but the first test's."""
    if request.function is not test_its_parts_joints_and_sidecar_come_with_it_in_metres_and_z_up:
        monkeypatch.setattr(usd, "ask_of", lambda _child, _name, ask, *given: ask(*given))


def test_its_parts_joints_and_sidecar_come_with_it_in_metres_and_z_up(tmp_path):
    path = write(tmp_path, stage(CABINET, 'metersPerUnit = 0.01\nupAxis = "Y"'))
    assert load(path, CONFIG.intake).provenance.scale == pytest.approx(0.01)
    stated = 'category = "fridge"\nheight = 1.24\nlicense = "MIT"\ndensity = 300.0\n'
    path.with_suffix(".toml").write_text(stated)
    intake = load(path, CONFIG.intake)
    told = intake.provenance
    assert (told.category, told.license, told.density) == ("fridge", "MIT", 300.0)
    assert (told.scale_source, told.scale) == ("sidecar", pytest.approx(2.0))
    assert intake.mesh.extents[2] == pytest.approx(1.24)
    made = articulator_for(intake, CONFIG).articulate(intake.mesh)
    assert [part.name for part in made.parts] == ["base", "door"]
    (hinge,) = made.movable_joints
    np.testing.assert_allclose([hinge.lower, hinge.upper], [0.0, np.pi / 2.0], atol=1e-6)
    np.testing.assert_allclose(np.abs(hinge.axis), [0.0, 1.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(hinge.origin[[0, 2]], [-1.0, -0.62], atol=1e-6)


def prim(how, inside=""):
    return f'#usda 1.0\ndef Xform "obj" ({how})\n{{\n{inside}}}\n'


OUTSIDE = ("../outside.usda", "./../thing/../outside.usda", "ABSOLUTE", "file:///x.usda")
CLIPS = "clips = {dictionary default = {asset[] assetPaths = [@../x.usda@]}}"
VARIANT = (
    'variantSet "v" = {\n"a" { def Xform "x" (prepend references = @../outside.usda@)\n{\n}\n}\n}\n'
)
#: What a layer is or leads to -> its text, and the code with which it is refused.
REFUSED = {
    **{
        f"{how} {place}": (prim(f"prepend {how} = @{place}@"), "external_reference")
        for how in ("references", "payload")
        for place in OUTSIDE
    },
    "sublayer": ("#usda 1.0\n(\nsubLayers = [@../outside.usda@]\n)\n", "external_reference"),
    "variant": (
        prim('variants = {string v = "a"}\nprepend variantSets = "v"', VARIANT),
        "external_reference",
    ),
    "a layer's layer": (prim("references = @./parts/inner.usda@"), "external_reference"),
    "link": (prim("references = @./link.usda@"), "external_reference"),
    "computed": (prim("references = @`${WHERE}`@"), "unsupported"),
    "clips": (prim(CLIPS), "unsupported"),
    "another format": (prim("references = @./shape.abc@"), "unsupported"),
    "absent": (prim("references = @./absent.usda@"), "missing_file"),
    "absent below": (prim("references = @parts/absent.usda@"), "missing_file"),
    "nonsense": ("nonsense", "unreadable"),
}


def refused(main, **limits):
    return refusal(import_usd, main, IntakeConfig(**limits), ReadLog())


@pytest.mark.parametrize("what", REFUSED)
def test_a_layer_that_leads_out_or_nowhere_is_refused(tmp_path, what):
    text, code = REFUSED[what]
    # It is no USD, so opening it would be noticed.
    outside = write(tmp_path, "secret", "outside.usda")
    folder = tmp_path / "thing"
    write(folder / "parts", prim("references = @../../outside.usda@"), "inner.usda")
    (folder / "link.usda").symlink_to(outside)
    assert refused(write(folder, text.replace("ABSOLUTE", str(outside)))).code == code


def test_a_package_that_leads_out_is_refused(tmp_path):
    outside = write(tmp_path, "secret", "outside.usda")
    package = tmp_path / "thing" / "thing.usdz"
    package.parent.mkdir()
    with zipfile.ZipFile(package, "w", zipfile.ZIP_STORED) as archive:
        archive.writestr("inner.usda", prim(f"references = @{outside}@"))
    assert refused(package).code == "external_reference"


def test_own_layers_and_looks_elsewhere_are_fine_up_to_a_limit(tmp_path):
    write(tmp_path / "parts", stage(CABINET), "inner.usda")
    looks = "asset map = @../../outside.png@\n"
    main = write(tmp_path, prim("references = @parts/inner.usda@</obj>", looks))
    import_usd(main, IntakeConfig(), ReadLog())
    assert "limit" in refused(main, max_bytes=1000).message
