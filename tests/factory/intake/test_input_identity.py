"""Two inputs share an id only if they are the same input; changes meanwhile are found out."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from fuzz_cases import MJCF, cube_files
from mesh_cube import write_glb, write_obj

from asset_factory.factory.articulate.stage import articulate
from asset_factory.factory.build import make_asset
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.intake.importers import mjcf
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
SHAPE = '<visual><geometry><box size="1 1 1"/></geometry></visual>'


def loaded(path):
    source = Source(path, CONFIG)
    source.load()
    return source


def refused(path, config=CONFIG):
    source = Source(path, config)
    with pytest.raises(InputRejected):
        source.load()
    return source


def placed(folder, name="thing.glb"):
    folder.mkdir(parents=True, exist_ok=True)
    return write_glb(folder).rename(folder / name)


def test_a_single_file_is_named_by_its_bytes_wherever_it_lies(tmp_path):
    here = loaded(placed(tmp_path / "here"))
    there = loaded(placed(tmp_path / "there"))
    assert here.id == there.id == asset_id("thing", digest_file(here.path))


def test_names_that_become_the_same_safe_name_are_two_inputs(tmp_path):
    names = ["cab a.glb", "cab_a.glb", "cab(a.glb", "x" * 70 + ".glb", "x" * 71 + ".glb"]
    assert len({loaded(placed(tmp_path, name)).id for name in names}) == len(names)


def test_folders_that_tell_another_category_make_two_inputs(tmp_path):
    assert loaded(placed(tmp_path / "fridges")).id != loaded(placed(tmp_path / "ovens")).id


def test_a_description_with_another_sidecar_is_another_input(tmp_path):
    ids = set()
    for number, sidecar in enumerate([None, "scale = 1.0", "scale = 0.5"]):
        (tmp_path / str(number)).mkdir()
        path = tmp_path / str(number) / "box.urdf"
        path.write_text(f'<robot name="box"><link name="base">{SHAPE}</link></robot>')
        if sidecar:
            path.with_suffix(".toml").write_text(sidecar)
        ids.add(loaded(path).id)
    assert len(ids) == 3


def test_a_rejected_input_does_not_take_the_place_of_the_same_mesh_that_passed(tmp_path):
    good = placed(tmp_path / "good")
    bad = placed(tmp_path / "bad")
    bad.with_suffix(".toml").write_text("colour = 1")
    assert refused(bad).id != loaded(good).id
    # Its own rejection is forgotten once it is loaded.
    wrong = refused(bad).id
    bad.with_suffix(".toml").write_text("scale = 1.0")
    assert wrong in loaded(bad).unloaded_ids


def test_what_was_read_to_its_end_and_then_refused_is_the_asset_that_it_was(tmp_path):
    path = placed(tmp_path)
    path.with_suffix(".toml").write_text('license = "CC-BY-NC-4.0"')
    strict = replace(CONFIG, intake=replace(CONFIG.intake, allowed_licenses=("CC0-1.0",)))
    before = loaded(path)
    now = refused(path, strict)
    assert now.id == before.id
    assert source_key(now) != source_key(before)
    # What the input is made into is the same as before, and not made again.
    assert now.loaded_key == before.loaded_key


def test_a_mesh_changed_while_an_mjcf_is_compiled_is_compiled_again(tmp_path, monkeypatch):
    for name, data in cube_files().items():
        (tmp_path / name).write_bytes(data)
    asset = "<asset><mesh name='cube' file='cube.stl'/></asset>"
    inline = MJCF.replace('<include file="assets.xml"/>', asset).replace('material="wood"', "")
    (tmp_path / "cube.stl").write_bytes(_tetrahedron(1.0))
    (tmp_path / "robot.xml").write_text(inline)
    sizes = []
    compiled = mjcf._compiled

    def meddled(path):
        model = compiled(path)
        sizes.append(model.meshes[0].vertices.max())
        (tmp_path / "cube.stl").write_bytes(_tetrahedron(2.0))
        return model

    monkeypatch.setattr(mjcf, "_compiled", meddled)
    source = loaded(tmp_path / "robot.xml")
    assert len(sizes) == 2
    assert sizes[1] == pytest.approx(2 * sizes[0])
    assert source.reads["cube.stl"] == digest_file(tmp_path / "cube.stl")


def _tetrahedron(size):
    import trimesh

    corners = size * np.concatenate([np.zeros((1, 3)), np.eye(3)])
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    return trimesh.Trimesh(corners, faces).export(file_type="stl")


@pytest.mark.parametrize("form", ["texture", "sidecar", "urdf"])
def test_a_link_that_led_out_is_noticed_when_the_file_itself_takes_its_place(form, tmp_path):
    (tmp_path / "in").mkdir()
    path = write_obj(tmp_path / "in")
    file = {"texture": "wood.png", "sidecar": "cube.toml", "urdf": "cube.obj"}[form]
    if form == "sidecar":
        (tmp_path / "in" / file).write_text("scale = 1.0")
    if form == "urdf":
        path = tmp_path / "in" / "box.urdf"
        shape = SHAPE.replace('<box size="1 1 1"/>', '<mesh filename="cube.obj"/>')
        path.write_text(f'<robot name="box"><link name="base">{shape}</link></robot>')
    (tmp_path / "in" / file).rename(tmp_path / file)
    (tmp_path / "in" / file).symlink_to(f"../{file}")
    source = refused(path)
    known = KnownReads(tmp_path / "cache", CONFIG)
    known.note(path, source.reads)
    assert known.probe(path).key == source_key(source)
    (tmp_path / "in" / file).unlink()
    (tmp_path / "in" / file).write_bytes((tmp_path / file).read_bytes())
    assert known.probe(path).key != source_key(source)
    loaded(path)


def test_an_annotation_counts_as_it_was_when_it_was_loaded(tmp_path):
    path = write_glb(tmp_path)
    np.savez(tmp_path / "pred.npz", face_part_ids=np.zeros(12, dtype=int))
    path.with_suffix(".toml").write_text('annotation = "pred.npz"')
    intake = Source(path, CONFIG).load()
    (tmp_path / "pred.npz").write_bytes(b"somebody is writing it")
    with pytest.raises(InputRejected, match="a field is missing: motion_hierarchy"):
        articulate(intake, BuildConfig(articulator="annotated"))


def test_a_name_that_is_no_utf8_is_an_input_like_any_other(tmp_path):
    path = tmp_path / b"bad\xff.glb".decode("utf-8", "surrogateescape")
    path.write_bytes(b"junk")
    registry = Registry(tmp_path / "out", create=True)
    with registry.staging_folder() as staging, Judge(CONFIG.checks) as judge:
        result = register(registry, make_asset(path, staging, CONFIG, None, judge))
    assert result.entry.status == "rejected"
    assert r"bad\udcff.glb" in registry.entry(result.entry.id).message
    assert attempt_of(result, datetime.now(UTC)).input.encode().endswith(rb"bad\udcff.glb")
    rebuild(registry.root)
    assert registry.entry(result.entry.id).reason == result.entry.reason
