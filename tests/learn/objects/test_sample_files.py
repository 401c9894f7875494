"""What is written reads back as the same object: joints to a micrometre, parts by face."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from plain_solids import box_between, parted

from asset_factory.factory.articulate.catalog import choose
from asset_factory.factory.articulation import Joint, JointKind, Part
from asset_factory.factory.config import BuildConfig, IntakeConfig
from asset_factory.factory.geometry.posing import face_parts, posed
from asset_factory.factory.geometry.triangles import face_areas
from asset_factory.factory.intake.load import load
from asset_factory.factory.runtime.store import folder_digests
from asset_factory.learn.objects import artist_like, fused_like, make_object, write_sample
from asset_factory.learn.objects.__main__ import main


def read(folder):
    intake = load(folder / "object.glb", IntakeConfig())
    return choose(intake, BuildConfig(articulator="annotated")).articulate(intake.mesh)


def same_joint(read_joint, joint):
    assert read_joint.kind == joint.kind
    np.testing.assert_allclose(read_joint.axis, joint.axis, atol=1e-6)
    np.testing.assert_allclose(read_joint.lower, joint.lower, atol=1e-6)
    np.testing.assert_allclose(read_joint.upper, joint.upper, atol=1e-6)
    if joint.turns:
        # Readers put the origin elsewhere on the same line.
        off = np.cross(read_joint.origin - joint.origin, joint.axis)
        np.testing.assert_allclose(off, 0.0, atol=1e-6)


def same_object(found, wanted):
    """Parts may come in another order: they are matched by their faces, which a file groups."""
    written = np.argsort(wanted.mesh.face_material, kind="stable")
    there = wanted.mesh.vertices[wanted.mesh.faces[written]]
    np.testing.assert_allclose(found.mesh.vertices[found.mesh.faces], there, atol=1e-5)
    owner = face_parts(wanted)[written]
    order = [int(owner[part.faces[0]]) for part in found.parts]
    assert sorted(order) == list(range(len(wanted.parts)))
    np.testing.assert_array_equal(np.take(order, face_parts(found)), owner)
    for joint in found.joints:
        match = wanted.joints[order[joint.child] - 1]
        assert order[joint.parent] == match.parent
        same_joint(joint, match)


@pytest.mark.parametrize("category", ["cabinet", "laptop", "oven"])
def test_an_open_sample_reads_back_as_the_object(category, tmp_path):
    original = make_object(category, 1)
    values = {joint.name: 0.4 * joint.upper for joint in original.joints[::2]}
    write_sample(original, tmp_path, values)
    same_object(read(tmp_path), posed(original, values))


@pytest.mark.parametrize("change", [artist_like, fused_like])
def test_a_sample_of_any_character_keeps_its_parts_face_by_face(change, tmp_path):
    sample = change(make_object("microwave", 2), 4)
    write_sample(sample, tmp_path)
    found = read(tmp_path)
    areas = {}
    for key, articulation in (("found", found), ("wanted", sample)):
        area = face_areas(articulation.mesh)
        areas[key] = sorted(float(area[part.faces].sum()) for part in articulation.parts)
    np.testing.assert_allclose(areas["found"], areas["wanted"], rtol=1e-3)
    for joint, match in zip(found.joints, sample.joints, strict=True):
        same_joint(joint, match)


def turning_slider():
    body = box_between((0, 0, 0), (1, 1, 1))
    knob = box_between((0.2, -0.1, 0.2), (0.8, 0, 0.8))
    line = ([0.0, -1.0, 0.0], [0.5, 0.0, 0.5], 0.0)
    turn = Joint("turn", JointKind.REVOLUTE, 0, 1, *line, 2.0)
    slide = Joint("slide", JointKind.PRISMATIC, 1, 2, *line, 0.05)
    return parted({"body": [body], "carrier": [], "knob": [knob]}, turn, slide)


def test_a_part_that_turns_and_slides_is_one_row_of_the_annotation(tmp_path):
    write_sample(turning_slider(), tmp_path, {"slide": 0.02})
    truth = np.load(tmp_path / "pred.npz")
    np.testing.assert_array_equal(truth["motion_hierarchy"], [[0, 1]])
    for moves in ("is_part_revolute", "is_part_prismatic"):
        assert truth[moves].tolist() == [False, True]
    np.testing.assert_allclose(truth["prismatic_range"][1], [-0.02, 0.03], atol=1e-7)
    found = read(tmp_path)
    assert [joint.kind for joint in found.joints] == [JointKind.REVOLUTE, JointKind.PRISMATIC]
    assert len(found.parts[1].faces) == 0
    turn, slide = found.joints
    np.testing.assert_allclose(turn.upper, 2.0, atol=1e-6)
    np.testing.assert_allclose([slide.lower, slide.upper], [-0.02, 0.03], atol=1e-6)


def test_a_carrier_of_two_parts_is_refused(tmp_path):
    one = turning_slider()
    halves = (Part("knob", np.arange(12, 18)), Part("cap", np.arange(18, 24)))
    second = replace(one.joints[1], name="other", child=3)
    both = replace(one, parts=(*one.parts[:2], *halves), joints=(*one.joints, second))
    with pytest.raises(ValueError, match="carry one part"):
        write_sample(both, tmp_path)


def test_the_command_writes_the_same_files_for_the_same_options(tmp_path, monkeypatch, capsys):
    def given(name, *options):
        return [str(tmp_path / name), "--category", "chest", *options]

    options = ("--seed", "2", "--character", "artist", "--open", "0.5")
    module = [sys.executable, "-m", "asset_factory.learn.objects"]
    subprocess.run([*module, *given("one", *options)], check=True)
    monkeypatch.setattr(sys, "argv", ["objects", *given("two", *options)])
    main()
    one, two = (folder_digests(tmp_path / name) for name in ("one", "two"))
    assert {"object.glb", "object.toml", "pred.npz"} == set(one)
    assert one == two
    joint = read(tmp_path / "one").joints[0]
    assert joint.lower == pytest.approx(-joint.upper)
    monkeypatch.setattr(sys, "argv", ["objects", *given("no", "--open", "2")])
    with pytest.raises(SystemExit, match="2"):
        main()
    assert "must be 0 to 1" in capsys.readouterr().err
