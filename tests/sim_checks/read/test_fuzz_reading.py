"""What fuzzing found in the judge's readers, each once: a refusal, no hang or other exception."""

import time

import pytest
from refusing import judges_refusal

from asset_factory.sim_checks.read import document, mjcf, references, urdf
from asset_factory.sim_checks.read.multiplied import MOST
from asset_factory.sim_checks.read.read import read_description, read_here

#: Far more than the work takes, far less than what it took.
QUICK_S = 5.0
BOX = '<robot name="r"><link name="l"><visual><geometry>{}</geometry></visual></link></robot>'


def refusal(folder, text, name="a.urdf"):
    (folder / name).write_text(text)
    return judges_refusal(read_here, folder / name)


@pytest.mark.parametrize(
    "reference", ["n" * 300 + ".obj", "d/" * 3000 + "x.obj", "package://" + "d/" * 3000 + "x.obj"]
)
def test_names_that_no_file_has_are_missing(reference, tmp_path):
    error = refusal(tmp_path, BOX.format(f'<mesh filename="{reference}"/>'))
    assert error.code == "missing_file"
    assert len(error.message) < 300
    path = tmp_path / "a.xml"
    path.write_text(f'<mujoco><asset><mesh name="m" file="{reference}"/></asset></mujoco>')
    references.follow_models(path, document.parse_document(path))


def test_includes_that_double_are_counted(tmp_path):
    for k in range(12):
        inner = f'<include file="{k + 1}.xml"/>' * 6
        (tmp_path / f"{k}.xml").write_text(f"<mujoco>{inner}</mujoco>")
    (tmp_path / "12.xml").write_text("<mujoco/>")
    started = time.process_time()
    first = tmp_path / "0.xml"
    refused = judges_refusal(references.follow_models, first, document.parse_document(first))
    assert refused.code == "nested_too_deep"
    assert time.process_time() - started < QUICK_S


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_whoever_declares_a_document_type_is_refused(encoding, tmp_path):
    declared = f'<?xml version="1.0" encoding="{encoding}"?><!DOCTYPE x [<!ENTITY a "b">]>'
    (tmp_path / "m.dae").write_bytes(f"{declared}<COLLADA>&a;</COLLADA>".encode(encoding))
    assert refusal(tmp_path, BOX.format('<mesh filename="m.dae"/>')).code == "forbidden_doctype"
    (tmp_path / "a.urdf").write_bytes(f'{declared}<robot name="&a;"/>'.encode(encoding))
    assert judges_refusal(read_description, tmp_path / "a.urdf").code == "forbidden_doctype"


def test_more_elements_than_any_object_has_are_too_large(monkeypatch, tmp_path):
    monkeypatch.setattr(document, "MAX_ITEMS", 100)
    attributes = " ".join(f'a{k}=""' for k in range(100))
    for text in ("<robot>" + "<a/>" * 100 + "</robot>", f"<robot {attributes}/>"):
        assert refusal(tmp_path, text).code == "too_large"


def test_more_triangles_than_any_object_has_are_too_large(monkeypatch, tmp_path):
    monkeypatch.setattr(urdf, "MAX_TRIANGLES", 30)
    shape = '<box size="1 1 1"/></geometry></visual><visual><geometry>'
    text = BOX.format(shape * 2 + '<box size="1 1 1"/>')
    assert refusal(tmp_path, text).code == "too_large"
    monkeypatch.setattr(urdf, "MAX_TRIANGLES", 36)
    assert len(read_here(tmp_path / "a.urdf").links[0].visuals) == 3


@pytest.mark.parametrize("what", ["bodies", "geoms"])
def test_what_one_line_makes_a_million_of_is_too_large(what, monkeypatch, tmp_path):
    pytest.importorskip("mujoco")
    monkeypatch.setitem(MOST, what, 50)
    # Counted once it is compiled, whatever was counted before.
    monkeypatch.setattr(mjcf, "refuse_multiplied", lambda *_: None)
    many = '<replicate count="60" offset="3 0 0"><body><geom size="1"/></body></replicate>'
    error = refusal(tmp_path, f"<mujoco><worldbody>{many}</worldbody></mujoco>", "a.xml")
    assert error.code == "too_large"
    assert "at most 50" in error.message
