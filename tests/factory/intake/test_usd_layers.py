"""USD: no file outside the object's folder is composed, however it is named."""

import zipfile

import pytest

pytest.importorskip("pxr")
from refusing import refusal
from usda import CABINET, stage, write

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.intake.importers import usd
from asset_factory.factory.intake.importers.usd import import_usd
from asset_factory.factory.intake.reads import ReadLog


@pytest.fixture(autouse=True)
def read_here(monkeypatch):
    """Spare every read a child process, which other tests prove."""
    monkeypatch.setattr(usd, "ask_of", lambda _child, _name, ask, *given: ask(*given))


def refused(main):
    return refusal(import_usd, main, IntakeConfig(), ReadLog()).code


@pytest.fixture
def outside(tmp_path):
    """A file that no layer may lead to; it is no USD, so opening it would be noticed."""
    return write(tmp_path, "secret", "outside.usda")


def referring(folder, reference, how="references"):
    text = f'#usda 1.0\n(\n)\ndef Xform "obj" (prepend {how} = @{reference}@)\n{{\n}}\n'
    return write(folder, text)


@pytest.mark.parametrize("how", ["references", "payload"])
@pytest.mark.parametrize(
    "reference", ["../outside.usda", "./../thing/../outside.usda", "ABSOLUTE", "file:///x.usda"]
)
def test_reference_out_of_the_folder_is_refused(tmp_path, outside, how, reference):
    main = referring(tmp_path / "thing", reference.replace("ABSOLUTE", str(outside)), how)
    assert refused(main) == "external_reference"


def test_sublayer_and_variant_out_of_the_folder_are_refused(tmp_path, outside):
    sublayer = write(tmp_path / "a", "#usda 1.0\n(\nsubLayers = [@../outside.usda@]\n)\n")
    assert refused(sublayer) == "external_reference"
    variant = (
        '#usda 1.0\ndef Xform "obj" (variants = {string v = "a"}\nprepend variantSets = "v")\n{\n'
        'variantSet "v" = {\n'
        '"a" { def Xform "x" (prepend references = @../outside.usda@)\n{\n}\n}\n}\n}\n'
    )
    assert refused(write(tmp_path / "b", variant)) == "external_reference"


def test_layer_of_a_layer_and_a_link_are_followed(tmp_path, outside):
    folder = tmp_path / "thing"
    text = f'#usda 1.0\ndef Xform "obj" (references = @../../{outside.name}@)\n{{\n}}\n'
    write(folder / "parts", text, "inner.usda")
    assert refused(referring(folder, "./parts/inner.usda")) == "external_reference"
    (folder / "link.usda").symlink_to(outside)
    assert refused(referring(folder, "./link.usda")) == "external_reference"


def test_package_that_leads_out_is_refused(tmp_path, outside):
    folder = tmp_path / "thing"
    inner = referring(folder, str(outside))
    with zipfile.ZipFile(folder / "thing.usdz", "w", zipfile.ZIP_STORED) as archive:
        archive.write(inner, "inner.usda")
    assert refused(folder / "thing.usdz") == "external_reference"


def test_computed_references_clips_other_formats_and_absent_files_are_refused(tmp_path):
    computed = "`${WHERE}`"
    assert refused(referring(tmp_path / "a", computed)) == "unsupported"
    clips = (
        '#usda 1.0\ndef Xform "obj" (clips = {dictionary default = {asset[] assetPaths = '
        "[@../x.usda@]}})\n{\n}\n"
    )
    assert refused(write(tmp_path / "b", clips)) == "unsupported"
    assert refused(referring(tmp_path / "c", "./shape.abc")) == "unsupported"
    assert refused(referring(tmp_path / "d", "./absent.usda")) == "missing_file"
    assert refused(referring(tmp_path / "e", "parts/absent.usda")) == "missing_file"
    assert refused(write(tmp_path / "f", "nonsense")) == "unreadable"


def test_own_layers_and_looks_elsewhere_are_fine(tmp_path):
    folder = tmp_path / "thing"
    write(folder / "parts", stage(CABINET), "inner.usda")
    main = write(
        folder,
        (
            '#usda 1.0\ndef Xform "obj" (references = @parts/inner.usda@</obj>)\n{\n'
            "asset map = @../../outside.png@\n}\n"
        ),
    )
    import_usd(main, IntakeConfig(), ReadLog())
    with pytest.raises(InputRejected, match="limit"):
        import_usd(main, IntakeConfig(max_bytes=1000), ReadLog())
