"""What counts as an object of a dataset, what it is called, and what it consists of."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from laid import laid
from plain_solids import parted, sized_box

from asset_factory.factory.articulation import Joint
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.mesh import Mesh
from asset_factory.learn.datasets.description import find_descriptions, find_partnet
from asset_factory.learn.datasets.predictions import find_predictions, read_prediction_item
from asset_factory.learn.datasets.settings import SourceSettings
from asset_factory.learn.datasets.split import is_held_out
from asset_factory.learn.evaluate.files import write_obj
from asset_factory.learn.objects.export import write_annotation, write_sidecar


def test_folder_with_a_description_is_one_object(tmp_path):
    laid(tmp_path / "kitchen" / "fridge_1" / "a.urdf")
    laid(tmp_path / "kitchen" / "fridge_1" / "fridge_1.urdf")
    laid(tmp_path / "kitchen" / "fridge_1" / "parts" / "door.urdf")
    laid(tmp_path / "lamp-2" / "lamp.xml", "<mujoco/>")
    laid(tmp_path / "lamp-2" / "notes.xml", "<notes/>")
    laid(tmp_path / ".hidden" / "x.urdf")
    items = find_descriptions(tmp_path)
    names = [(item.name, item.main.name) for item in items]
    assert names == [("kitchen/fridge_1", "fridge_1.urdf"), ("lamp-2", "lamp.xml")]
    assert {path.name for path in items[0].files} == {"a.urdf", "fridge_1.urdf", "door.urdf"}


def test_files_in_the_datasets_own_folder_are_an_object_each(tmp_path):
    for name in ("b", "a"):
        laid(tmp_path / f"{name}.urdf")
    assert [item.name for item in find_descriptions(tmp_path)] == ["a", "b"]


def test_links_out_of_the_dataset_do_not_exist(tmp_path):
    inside = tmp_path / "data" / "box_1"
    laid(inside / "box.urdf")
    (inside / "secret.obj").symlink_to(laid(tmp_path / "secret.obj"))
    (tmp_path / "data" / "box_2").mkdir()
    (tmp_path / "data" / "box_2" / "box.urdf").symlink_to(laid(tmp_path / "box.urdf"))
    (item,) = find_descriptions(tmp_path / "data")
    assert [path.name for path in item.files] == ["box.urdf"]


def test_digest_is_of_contents_and_not_of_looks(tmp_path):
    main = laid(tmp_path / "data" / "box_1" / "box.urdf")
    image = laid(main.parent / "wood.png", "a")
    mesh = laid(main.parent / "box.obj", "v 0 0 0")
    before = find_descriptions(tmp_path / "data")[0].digest()
    image.write_text("b")
    assert find_descriptions(tmp_path / "data")[0].digest() == before
    mesh.write_text("v 0 0 1")
    assert find_descriptions(tmp_path / "data")[0].digest() != before


def test_partnet_objects_are_called_by_their_numbers(tmp_path):
    for folder, file in (("123", "mobility.urdf"), ("124", "mobility.urdf"), ("125", "other.urdf")):
        laid(tmp_path / folder / file)
    assert [item.name for item in find_partnet(tmp_path)] == ["123", "124"]


def chest():
    hinge = Joint("lid", "revolute", 0, 1, [-1.0, 0, 0], [0, 0.5, 0.5], 0.0, 1.5)
    sides, lid = sized_box((1, 1, 1)), sized_box((1, 1, 0.1), (0.0, 0.0, 0.55))
    boxes = {"base": sides, "lid": lid}
    return parted({name: [Mesh.from_triangles(*each)] for name, each in boxes.items()}, hinge)


@pytest.mark.parametrize("named", ["sidecar", "stem", "alone"])
def test_labels_beside_a_mesh(tmp_path, named):
    folder = tmp_path / "chest_1"
    folder.mkdir()
    write_obj(folder / "chest.obj", chest().mesh)
    labels = {"sidecar": "truth.npz", "stem": "chest.pred.npz", "alone": "pred.npz"}[named]
    write_annotation(chest(), folder / labels)
    if named == "sidecar":
        write_sidecar(folder / "chest.toml", {"scale": 1.0, "annotation": labels})
    (item,) = find_predictions(tmp_path)
    assert item.name == "chest_1"
    read = read_prediction_item(item, SourceSettings())
    assert [len(part.faces) for part in read.parts] == [12, 12]
    np.testing.assert_allclose(np.abs(read.joints[0].axis), [1, 0, 0], atol=1e-9)
    (folder / labels).write_bytes(b"torn")
    with pytest.raises(InputRejected):
        read_prediction_item(item, SourceSettings())


def test_generated_meshes_in_one_folder_do_not_share_files(tmp_path):
    for name in ("chest_a", "chest_b"):
        write_obj(tmp_path / f"{name}.obj", chest().mesh)
        laid(tmp_path / f"{name}.mtl", "")
        write_annotation(chest(), tmp_path / f"{name}.pred.npz")
    items = find_predictions(tmp_path)
    assert [item.name for item in items] == ["chest_a", "chest_b"]
    names = {path.name for path in items[0].files}
    assert names == {"chest_a.obj", "chest_a.mtl", "chest_a.pred.npz"}


@given(st.sets(st.text(min_size=1), min_size=1), st.floats(0.0, 1.0))
def test_growth_moves_no_object_between_lists(names, share):
    assert all(is_held_out(name, 1.0) and not is_held_out(name, 0.0) for name in names)
    kept = {name for name in names if not is_held_out(name, share)}
    assert {name for name in kept if is_held_out(name, share / 2.0)} == set()


def test_about_the_share_is_held_out():
    held = sum(is_held_out(f"box_{number}", 0.2) for number in range(5000))
    assert held == pytest.approx(1000, abs=120)
