"""What is articulated is kept as it was cut; where nothing moves, a sentence says what helps."""

import json
from dataclasses import replace

import numpy as np
import trimesh
from one_piece import fridge
from refusing import refusal

from asset_factory.factory.articulate import stage
from asset_factory.factory.articulate.rigid import rigid_articulation
from asset_factory.factory.articulate.stage import hypotheses, hypotheses_of
from asset_factory.factory.config import BuildConfig, IntakeConfig
from asset_factory.factory.intake.load import load
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.runtime.store import Store

DOOR = {"kind": "door", "side": "front", "box": [0, 0.68, 1, 1], "hinge": "right"}
CONFIG = BuildConfig(articulator="stated")


def test_a_cut_mesh_comes_back_from_the_cache(tmp_path, monkeypatch):
    mesh = fridge()
    file = tmp_path / "fridge.obj"
    plain = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    file.write_text(trimesh.exchange.obj.export_obj(plain, include_normals=True))
    (tmp_path / "fridge.parts.json").write_text(json.dumps({"parts": [DOOR]}))
    intake = load(file, IntakeConfig(up="z"))
    first = hypotheses(intake, "key", Stages(CONFIG, Store(tmp_path / "cache")))[0]
    assert len(first.mesh.faces) > len(intake.mesh.faces)
    monkeypatch.setattr(stage, "hypotheses_of", None)
    again = hypotheses(intake, "key", Stages(CONFIG, Store(tmp_path / "cache")))[0]
    assert first.mesh.corner_normals is not None
    for name in ("vertices", "faces", "face_material", "corner_normals"):
        assert np.array_equal(getattr(again.mesh, name), getattr(first.mesh, name))
    assert [part.faces.tolist() for part in again.parts] == [p.faces.tolist() for p in first.parts]
    assert again.mesh.materials == intake.mesh.materials


def test_what_an_object_looks_like_comes_back_too(tmp_path, monkeypatch):
    file = tmp_path / "thing.stl"
    trimesh.creation.box().export(file)
    intake = load(file, IntakeConfig(up="z"))
    seen = replace(rigid_articulation(intake.mesh, "auto", ()), looks_like="fridge")
    monkeypatch.setattr(stage, "hypotheses_of", lambda *_: (seen,))
    for _ in range(2):
        (found,) = hypotheses(intake, "key", Stages(CONFIG, Store(tmp_path / "cache")))
        assert found.looks_like == "fridge"


TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n"
TETRAHEDRON = f"{TRIANGLE}v 1 1 0\nf 1 2 4\nf 2 3 4\nf 1 3 4\n"


def rejected(tmp_path, text):
    path = tmp_path / "shape.obj"
    path.write_text(text)
    found = refusal(hypotheses_of, load(path, IntakeConfig()), BuildConfig(articulator="geometric"))
    assert found.code == "no_movable_joint"
    return found.message


def test_something_flat_is_told_that_it_has_no_inside(tmp_path):
    wanted = "in one plane; want a solid object, with parts that open"
    assert rejected(tmp_path, TRIANGLE).endswith(f"nothing moves: its one triangle is {wanted}")
    two = f"{TRIANGLE}v 1 1 1\nf 2 4 3\n"
    assert rejected(tmp_path, two).endswith(f"all its 2 triangles are {wanted}")


def test_a_solid_is_told_its_size_and_every_way_to_say_more(tmp_path):
    message = rejected(tmp_path, TETRAHEDRON)
    seen = "the mesh is one connected surface: nothing can be told apart; kept rigid"
    assert f"nothing moves, says geometric (it is 1 x 1 x 1 m): {seen}; " in message
    for way in ("sidecar", "factory edit", "--config lenient", "--checkpoint paper"):
        assert way in message
