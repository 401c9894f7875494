"""Which files an input is made of is found out once, and every one of them counts."""

import numpy as np
import pytest
from mesh_cube import write_glb, write_gltf, write_obj
from refusing import refusal

from asset_factory.factory.build import build_asset
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.intake import reads as reads_module
from asset_factory.factory.intake import source as source_module
from asset_factory.factory.intake.reads import ReadLog
from asset_factory.factory.intake.source import Source
from asset_factory.factory.jobs.probe import KnownReads
from asset_factory.factory.registry.keys import source_key

CONFIG = BuildConfig(articulator="geometric", simulators=())


def load(path):
    source = Source(path, CONFIG)
    source.load()
    return source


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
    source = load(path)
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
        if before is None:
            file.unlink()
        else:
            file.write_bytes(before)
    assert known.probe(path).key == source_key(source)


def present(source):
    return {name for name, digest in source.reads.items() if digest}


def urdf(folder):
    (folder / "meshes").mkdir(parents=True)
    write_obj(folder / "meshes")
    shape = '<visual><geometry><mesh filename="meshes/cube.obj"/></geometry></visual>'
    (folder / "box.urdf").write_text(f'<robot name="box"><link name="base">{shape}</link></robot>')
    (folder / "box.toml").write_text('category = "box"')
    return folder / "box.urdf"


def test_every_file_of_a_description_counts_and_so_does_an_annotation(tmp_path):
    source = load(urdf(tmp_path))
    meshes = {f"meshes/{name}" for name in ("cube.obj", "cube.mtl", "wood.png")}
    assert present(source) == {"box.urdf", "box.toml", *meshes}
    path = write_glb(tmp_path)
    np.savez(tmp_path / "pred.npz", face_part_ids=np.zeros(12, dtype=int))
    (tmp_path / "cube.toml").write_text('annotation = "pred.npz"')
    assert {"pred.npz", "cube.toml"} <= present(load(path))


def test_the_key_knows_names_and_folders_only_as_far_as_they_matter(tmp_path):
    keys = {}
    for folder in ("a", "b", "fridge"):
        (tmp_path / folder).mkdir()
        keys[folder] = source_key(load(write_glb(tmp_path / folder)))
    assert keys["a"] == keys["b"] != keys["fridge"]
    assert source_key(load(write_glb(tmp_path / "a", "other.glb"))) not in keys.values()


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
    source = load(path)
    assert mine.renewed(probe) is probe
    theirs.note(path, source.reads)
    assert probe.key != source_key(source)
    assert mine.renewed(probe).key == source_key(source)
    assert mine.renewed(probe).claim == probe.claim


def test_the_same_bytes_with_another_sidecar_are_made_of_other_files(tmp_path):
    known = KnownReads(tmp_path / "cache", CONFIG)
    sources = []
    for name in ("plain", "annotated"):
        (tmp_path / name).mkdir()
        path = write_glb(tmp_path / name)
        if name == "annotated":
            np.savez(tmp_path / name / "pred.npz", face_part_ids=np.zeros(12, dtype=int))
            path.with_suffix(".toml").write_text('annotation = "pred.npz"')
        sources.append(load(path))
    for source in (*sources, *sources[::-1]):
        known.note(source.path, source.reads)
        assert all(known.probe(other.path).key == source_key(other) for other in sources[:1])
    assert all(known.probe(source.path).key == source_key(source) for source in sources)


@pytest.mark.parametrize(
    ("error", "code"), [(TimeoutError, "reading_timeout"), (ChildProcessError, "reading_killed")]
)
def test_a_reader_that_was_stopped_gives_no_verdict(error, code, tmp_path, monkeypatch):
    path = write_obj(tmp_path)

    def stopped(*arguments):
        raise error(f"{path.name}: no answer within 60 s")

    monkeypatch.setattr(source_module, "load", stopped)
    result = build_asset(path, tmp_path / "out", CONFIG)
    assert (result.entry.status, result.entry.reason) == ("unjudged", code)
    assert "no answer within 60 s" in result.entry.message
    monkeypatch.undo()
    assert build_asset(path, tmp_path / "out", CONFIG).entry.status == "rejected"
