"""Two inputs are one only if all their files are the same; what changes meanwhile is found out."""

from dataclasses import replace
from datetime import UTC, datetime
from unittest.mock import Mock

import numpy as np
import pytest
import trimesh
from fuzz_cases import MJCF, cube_files
from laid import laid
from mesh_cube import write_glb, write_gltf, write_obj
from refusing import refusal

from asset_factory.factory.articulate.stage import hypotheses_of
from asset_factory.factory.build import build_asset, make_asset
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.intake import reads as reads_module
from asset_factory.factory.intake import source as source_module
from asset_factory.factory.intake.importers import mjcf
from asset_factory.factory.intake.reads import ReadLog
from asset_factory.factory.intake.source import Source, asset_id
from asset_factory.factory.jobs.probe import KnownReads
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.keys import source_key
from asset_factory.factory.registry.rebuild import rebuild
from asset_factory.factory.registry.registration import register
from asset_factory.factory.report.nightly.night import attempt_of
from asset_factory.factory.runtime.store import digest_file
from asset_factory.sim_checks.judge import Judge

CONFIG = BuildConfig(simulators=())


def loaded(path):
    source = Source(path, CONFIG)
    source.load()
    return source


def refused(path, config=CONFIG):
    source = Source(path, config)
    refusal(source.load)
    return source


def placed(folder, name="thing.glb", sidecar=""):
    folder.mkdir(parents=True, exist_ok=True)
    path = write_glb(folder).rename(folder / name)
    if sidecar:
        path.with_suffix(".toml").write_text(sidecar)
    return path


def urdf(folder, mesh, sidecar=""):
    """A description beside that mesh."""
    shape = f'<visual><geometry><mesh filename="{mesh}"/></geometry></visual>'
    text = f'<robot name="box"><link name="base">{shape}</link></robot>'
    path = laid(folder / "box.urdf", text)
    if sidecar:
        path.with_suffix(".toml").write_text(sidecar)
    return path


def predicted(path):
    """The mesh, with an annotation beside it."""
    np.savez(path.with_name("pred.npz"), face_part_ids=np.zeros(12, dtype=int))
    path.with_suffix(".toml").write_text('annotation = "pred.npz"')
    return path


def test_a_single_file_is_known_by_its_bytes_wherever_it_lies_and_by_what_its_names_tell(tmp_path):
    here = loaded(placed(tmp_path / "here"))
    there = loaded(placed(tmp_path / "there"))
    assert here.id == there.id == asset_id("thing", digest_file(here.path))
    assert source_key(here) == source_key(there)
    # Some of these names become the same safe name.
    names = ["it.glb", "a b.glb", "a_b.glb", "a(b.glb", "x" * 70 + ".glb", "x" * 71 + ".glb"]
    others = [placed(tmp_path / "fridges"), placed(tmp_path / "ovens")]
    others += [placed(tmp_path, name) for name in names]
    sources = [here, *map(loaded, others)]
    assert len({each.id for each in sources}) == len(set(map(source_key, sources))) == 9


def test_a_description_with_another_sidecar_is_another_input(tmp_path):
    sources = []
    for number, sidecar in enumerate(["", "scale = 1.0", "scale = 0.5"]):
        folder = tmp_path / str(number)
        path = urdf(folder, "cube.obj", sidecar)
        write_obj(folder)
        sources.append(loaded(path))
    assert len({each.id for each in sources}) == 3


def write_untextured(folder):
    path = write_obj(folder)
    (folder / "wood.png").unlink()
    return path


OBJ_FILES = {"cube.obj", "cube.mtl", "wood.png", "cube.toml", "cube.obj.toml"}


@pytest.mark.parametrize(
    ("write", "files"),
    [
        (write_obj, OBJ_FILES),
        (write_untextured, OBJ_FILES),
        (write_gltf, {"cube.gltf", "cube data.bin", "wood.png", "cube.toml", "cube.gltf.toml"}),
        (write_glb, {"cube.glb", "cube.toml", "cube.glb.toml"}),
    ],
)
def test_every_file_of_a_mesh_counts(write, files, tmp_path):
    (tmp_path / "in").mkdir()
    path = write(tmp_path / "in")
    source = loaded(path)
    stated = {f"{name}.parts.{form}" for name in (path.name, "cube") for form in ("json", "toml")}
    files = files | stated
    assert set(source.reads) == files
    known = KnownReads(tmp_path / "cache", CONFIG)
    known.note(path, source.reads)
    probe = known.probe(path)
    assert (probe.reads, probe.key) == (source.reads, source_key(source))
    for name in sorted(files):
        file = path.parent / name
        before = file.read_bytes() if file.exists() else None
        file.write_bytes((before or b"") + b"\n")
        assert known.probe(path).key != source_key(source), name
        file.unlink() if before is None else file.write_bytes(before)
    assert known.probe(path).key == source_key(source)


def test_every_file_of_a_description_counts_and_so_does_an_annotation(tmp_path):
    def present(path):
        return {name for name, digest in loaded(path).reads.items() if digest}

    (tmp_path / "meshes").mkdir()
    write_obj(tmp_path / "meshes")
    meshes = {f"meshes/{name}" for name in ("cube.obj", "cube.mtl", "wood.png")}
    described = urdf(tmp_path, "meshes/cube.obj", 'category = "box"')
    assert present(described) == {"box.urdf", "box.toml", *meshes}
    assert {"pred.npz", "thing.toml"} <= present(predicted(placed(tmp_path)))


def test_a_rejected_input_does_not_take_the_place_of_the_same_mesh_that_passed(tmp_path):
    good = placed(tmp_path / "good")
    bad = placed(tmp_path / "bad", sidecar="colour = 1")
    wrong = refused(bad).id
    assert wrong != loaded(good).id
    # Its own rejection is forgotten once it is loaded.
    bad.with_suffix(".toml").write_text("scale = 1.0")
    assert wrong in loaded(bad).unloaded_ids


def test_what_was_read_to_its_end_and_then_refused_is_the_asset_that_it_was(tmp_path):
    path = placed(tmp_path, sidecar='license = "CC-BY-NC-4.0"')
    strict = replace(CONFIG, intake=replace(CONFIG.intake, allowed_licenses=("CC0-1.0",)))
    before = loaded(path)
    now = refused(path, strict)
    assert now.id == before.id
    assert source_key(now) != source_key(before)
    # What the input is made into is the same as before, and not made again.
    assert now.loaded_key == before.loaded_key


def test_an_input_that_somebody_writes_is_read_again_and_then_refused(tmp_path, monkeypatch):
    path = write_glb(tmp_path)
    original = reads_module.content_digest
    looked = []

    def restless(times):
        def digest(file):
            if file.suffix == ".glb" and len(looked) < times:
                looked.append(file)
                return "0" * 64
            return original(file)

        return digest

    monkeypatch.setattr(reads_module, "content_digest", restless(1))
    assert Source(path, CONFIG).load().name == "cube"
    assert len(looked) == 1
    looked.clear()
    monkeypatch.setattr(reads_module, "content_digest", restless(99))
    source = Source(path, CONFIG)
    found = refusal(source.load)
    assert found.code == "input_changed"
    assert "somebody wrote its files each of the 3 times" in found.message
    assert source_key(source) == ""


def test_a_mesh_changed_while_an_mjcf_is_compiled_is_compiled_again(tmp_path, monkeypatch):
    def write_box(size):
        trimesh.creation.box((size, size, size)).export(tmp_path / "cube.stl")

    for name, data in cube_files().items():
        (tmp_path / name).write_bytes(data)
    asset = "<asset><mesh name='cube' file='cube.stl'/></asset>"
    inline = MJCF.replace('<include file="assets.xml"/>', asset).replace('material="wood"', "")
    (tmp_path / "robot.xml").write_text(inline)
    write_box(1.0)
    sizes = []
    read = mjcf.read_apart

    def meddled(compiled, path):
        model = read(compiled, path)
        sizes.append(model.meshes[0].vertices.max())
        write_box(2.0)
        return model

    monkeypatch.setattr(mjcf, "read_apart", meddled)
    source = loaded(tmp_path / "robot.xml")
    assert sizes == pytest.approx([0.5, 1.0])
    assert source.reads["cube.stl"] == digest_file(tmp_path / "cube.stl")


def test_an_annotation_counts_as_it_was_when_it_was_loaded(tmp_path):
    path = predicted(placed(tmp_path))
    intake = Source(path, CONFIG).load()
    path.with_name("pred.npz").write_bytes(b"somebody is writing it")
    found = refusal(hypotheses_of, intake, BuildConfig(articulator="annotated"))
    assert "a field is missing: motion_hierarchy" in found.message


@pytest.mark.parametrize("form", ["texture", "sidecar", "urdf"])
def test_a_link_that_led_out_is_noticed_when_the_file_itself_takes_its_place(form, tmp_path):
    folder = tmp_path / "in"
    folder.mkdir()
    path = write_obj(folder)
    file = {"texture": "wood.png", "sidecar": "cube.toml", "urdf": "cube.obj"}[form]
    if form == "sidecar":
        (folder / file).write_text("scale = 1.0")
    if form == "urdf":
        path = urdf(folder, file)
    (folder / file).rename(tmp_path / file)
    (folder / file).symlink_to(f"../{file}")
    source = refused(path)
    known = KnownReads(tmp_path / "cache", CONFIG)
    known.note(path, source.reads)
    assert known.probe(path).key == source_key(source)
    (folder / file).unlink()
    (folder / file).write_bytes((tmp_path / file).read_bytes())
    assert known.probe(path).key != source_key(source)
    loaded(path)


def test_what_was_seen_first_counts_unless_it_was_not_there(tmp_path):
    log = ReadLog()
    for digest in ("", "1", "2"):
        log.note(tmp_path / "b", digest)
    assert log.reads_of(tmp_path / "input") == {"b": "1"}


def test_what_somebody_else_found_out_meanwhile_is_looked_at_again(tmp_path):
    (tmp_path / "in").mkdir()
    path = write_obj(tmp_path / "in")
    mine = KnownReads(tmp_path / "cache", CONFIG)
    theirs = KnownReads(tmp_path / "cache", CONFIG)
    probe = mine.probe(path)
    source = loaded(path)
    assert mine.renewed(probe) is probe
    theirs.note(path, source.reads)
    assert probe.key != source_key(source)
    assert mine.renewed(probe).key == source_key(source)
    assert mine.renewed(probe).claim == probe.claim


def test_the_same_bytes_with_another_sidecar_are_made_of_other_files(tmp_path):
    known = KnownReads(tmp_path / "cache", CONFIG)
    plain = loaded(placed(tmp_path / "plain"))
    sources = (plain, loaded(predicted(placed(tmp_path / "annotated"))))
    for source in (*sources, *sources[::-1]):
        known.note(source.path, source.reads)
        assert known.probe(plain.path).key == source_key(plain)
    assert all(known.probe(source.path).key == source_key(source) for source in sources)


@pytest.mark.parametrize(
    ("error", "code"), [(TimeoutError, "reading_timeout"), (ChildProcessError, "reading_killed")]
)
def test_a_reader_that_was_stopped_gives_no_verdict(error, code, tmp_path, monkeypatch):
    path = write_obj(tmp_path)
    config = replace(CONFIG, articulator="geometric")
    late = error(f"{path.name}: no answer within 60 s")
    monkeypatch.setattr(source_module, "load", Mock(side_effect=late))
    result = build_asset(path, tmp_path / "out", config)
    assert (result.entry.status, result.entry.reason) == ("unjudged", code)
    assert "no answer within 60 s" in result.entry.message
    monkeypatch.undo()
    assert build_asset(path, tmp_path / "out", config).entry.status == "rejected"


def test_a_name_that_is_no_utf8_is_an_input_like_any_other(tmp_path):
    path = laid(tmp_path / b"bad\xff.glb".decode("utf-8", "surrogateescape"), "junk")
    registry = Registry(tmp_path / "out", create=True)
    with registry.staging_folder() as staging, Judge(CONFIG.checks) as judge:
        result = register(registry, make_asset(path, staging, CONFIG, None, judge))
    assert result.entry.status == "rejected"
    assert r"bad\udcff.glb" in registry.entry(result.entry.id).message
    assert attempt_of(result, datetime.now(UTC)).input.encode().endswith(rb"bad\udcff.glb")
    rebuild(registry.root)
    assert registry.entry(result.entry.id).reason == result.entry.reason
