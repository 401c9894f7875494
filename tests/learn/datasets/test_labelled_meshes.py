"""Real meshes with openings labelled by eye become objects to train on."""

import json

import numpy as np
import pytest
from plain_solids import parted, sized_box

from asset_factory.factory.errors import InputRejected
from asset_factory.factory.mesh import Mesh
from asset_factory.learn import labelled
from asset_factory.learn.datasets.labelled import find_labelled, read_labelled
from asset_factory.learn.datasets.settings import SourceSettings
from asset_factory.learn.evaluate.files import write_obj
from asset_factory.learn.labelled import is_held_out, labelled_objects

NAMES = [name for name in map("cupboard_{}".format, range(40)) if not is_held_out(name)]
KEPT = next(name for name in map("cupboard_{}".format, range(40)) if is_held_out(name))
DOOR = {"side": "front", "sort": "door", "box": [0, 0, 1, 1], "hinge": "left"}
LID = {"side": "front", "sort": "lid", "box": [0, 0.8, 1, 1], "hinge": "back"}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Return a function that writes cubes of 1 m with a slab before a side, and their labels."""
    monkeypatch.setattr(labelled, "LABELS", tmp_path)
    labelled_objects.cache_clear()

    def written(labels, door=((1.0, 0.1, 1.0), (0.0, -0.56, 0.0))):
        whole = {name: {"kind": "cabinet", **label} for name, label in labels.items()}
        (tmp_path / "some.json").write_text(json.dumps(whole))
        files = [f"{name}.obj" for name in labels]
        (tmp_path / "INVENTORY.csv").write_text("\n".join(["file", *files, "other.obj"]))
        boxes = [Mesh.from_triangles(*sized_box(*each)) for each in (((1.0, 1.0, 1.0),), door)]
        for name in labels:
            write_obj(tmp_path / f"{name}.obj", parted({"base": boxes}).mesh)
            (tmp_path / f"{name}.toml").write_text('up = "z"\nscale = 1.0\n')
        return tmp_path

    yield written
    labelled_objects.cache_clear()


def test_only_what_opens_and_is_not_kept_for_measuring_is_learned_from(folder):
    opens = {"opens": True, "parts": [DOOR]}
    labels = {NAMES[0]: opens, NAMES[1]: {"opens": False}, KEPT: opens}
    there = folder(labels)
    assert [item.name for item in find_labelled(there)] == [NAMES[0]]
    (there / f"{NAMES[0]}.obj").unlink()
    (there / f"{NAMES[0]}.obj").symlink_to(__file__)
    assert not find_labelled(there)
    (there / "INVENTORY.csv").unlink()
    assert not find_labelled(there)


def test_the_labelled_part_moves_and_the_front_comes_to_the_front(folder):
    door = ((0.1, 1.0, 1.0), (0.56, 0.0, 0.0))
    label = {"opens": True, "front": "right", "parts": [{**DOOR, "side": "right"}]}
    (item,) = find_labelled(folder({NAMES[0]: label}, door))
    read = read_labelled(item, SourceSettings())
    (joint,) = read.movable_joints
    center = read.mesh.vertices[read.mesh.faces[read.parts[joint.child].faces]].mean(axis=(0, 1))
    np.testing.assert_allclose(center[:2], [0.0, -0.56], atol=0.02)
    assert abs(joint.axis[2]) == pytest.approx(1.0)
    assert joint.origin[0] == pytest.approx(-0.5, abs=0.05)


def test_a_lid_that_several_sides_show_is_one_part(folder):
    shown = [LID, {**LID, "side": "left"}, {**LID, "side": "top", "box": [0, 0, 1, 1]}]
    (item,) = find_labelled(folder({NAMES[0]: {"opens": True, "parts": shown}}))
    (joint,) = read_labelled(item, SourceSettings()).movable_joints
    assert abs(joint.axis[0]) == pytest.approx(1.0)


@pytest.mark.parametrize(
    "part", [{**DOOR, "unsure": True}, {**DOOR, "sort": "other", "hinge": None}]
)
def test_a_label_that_cannot_tell_how_a_part_opens_is_refused(folder, part):
    (item,) = find_labelled(folder({NAMES[0]: {"opens": True, "parts": [LID, part]}}))
    with pytest.raises(InputRejected, match="the label is unsure"):
        read_labelled(item, SourceSettings())
