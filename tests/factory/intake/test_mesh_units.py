"""Up axis, metric size, category and sidecar."""

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from mesh_cube import write_glb, write_off, write_stl
from refusing import refusal

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.intake.categories import category_table, guess_category
from asset_factory.factory.intake.load import load
from asset_factory.factory.intake.loading import load_mesh
from asset_factory.factory.intake.orientation import UP_AXES, rotation_to_z_up
from asset_factory.factory.intake.sizes import scale_by_size


def _box(folder, name, extents):
    trimesh.creation.box(bounds=[(0.0, 0.0, 0.0), extents]).export(folder / name)
    return folder / name


def _load(path, sidecar=None, **options):
    if sidecar is not None:
        path.with_suffix(".toml").write_text(sidecar)
    return load_mesh(path, IntakeConfig(**options))


@pytest.mark.parametrize("axis", UP_AXES)
def test_the_named_axis_becomes_z_by_a_proper_rotation(axis):
    rotation = rotation_to_z_up(axis)
    direction = np.eye(3)["xyz".index(axis[-1])] * (-1.0 if axis[0] == "-" else 1.0)
    np.testing.assert_array_equal(rotation @ direction, [0, 0, 1])
    np.testing.assert_array_equal(rotation @ rotation.T, np.eye(3))
    assert np.linalg.det(rotation) == pytest.approx(1.0)


@pytest.mark.parametrize("axis", UP_AXES)
def test_rotations_agree_with_the_released_model(fixtures, axis):
    with np.load(fixtures / "postprocess_e2e" / "up_dir.npz") as recorded:
        turned = recorded["in"] @ rotation_to_z_up(axis).T
        low = turned.min(axis=0)
        high = turned.max(axis=0)
        unit = (turned - (low + high) / 2.0) / (high - low).max()
        np.testing.assert_allclose(unit, recorded[axis.upper()], atol=1e-6)


def test_up_is_option_then_sidecar_then_format(tmp_path):
    glb = write_glb(tmp_path)
    stl = write_off(tmp_path, "other.off")
    for path, sidecar, options, wanted in (
        (glb, None, {}, ("y", "format")),
        (stl, None, {}, ("z", "default")),
        (glb, 'up = "+X"', {}, ("x", "sidecar")),
        (glb, None, {"up": "-Z"}, ("-z", "option")),
        (glb, None, {"up": "-z"}, ("-z", "option")),
    ):
        provenance = _load(path, sidecar, **options).provenance
        assert (provenance.up, provenance.up_source) == wanted
    assert any("up axis was taken to be z" in note for note in _load(stl).provenance.notes)


def test_transform_leads_from_the_input_to_the_object(tmp_path):
    intake = _load(write_glb(tmp_path, nodes=[{"mesh": 0, "translation": [1, 2, 3]}]), height=0.5)
    low = np.array([1.0, 2, 3])
    high = np.array([2.0, 3, 4])
    ends = np.stack([low, high]) @ intake.transform[:3, :3].T + intake.transform[:3, 3]
    np.testing.assert_allclose(np.sort(ends, axis=0), intake.mesh.bounds, atol=1e-9)
    assert intake.mesh.extents[2] == pytest.approx(0.5)
    assert intake.provenance.scale == pytest.approx(0.5)


def test_height_is_option_then_sidecar_then_table(tmp_path):
    path = _box(tmp_path, "fridge.obj", (70, 70, 180))
    for sidecar, options, height, source in (
        (None, {}, 1.8, "category"),
        ("height = 1.5", {}, 1.5, "sidecar"),
        ("height = 1.5", {"height": 1.2}, 1.2, "option"),
        ("scale = 0.02", {}, 3.6, "sidecar"),
    ):
        intake = _load(path, sidecar, **options)
        assert intake.mesh.extents[2] == pytest.approx(height)
        assert intake.provenance.scale == pytest.approx(height / 180.0)
        assert (intake.provenance.scale_source, intake.provenance.category) == (source, "fridge")


@pytest.mark.parametrize(
    ("name", "extents", "factor", "source"),
    [
        ("fridge.obj", (0.7, 0.7, 1.8), 1.0, "as_is"),
        ("fridge.obj", (700, 700, 1800), 0.001, "category"),
        ("fridge.obj", (28, 28, 71), 0.0254, "category"),
        ("fridge.obj", (0.07, 0.07, 0.17), 10.0, "category"),
        ("fridge.obj", (0.6, 0.5, 0.999), 1.7 / 0.999, "category"),
        ("fridge.obj", (0.6, 0.5, 0.98), 1.0, "as_is"),
        ("thing.obj", (0.6, 0.5, 1.0), 1.0, "as_is"),
        ("drawer.obj", (1.3, 1.6, 4.15), 0.9 / 4.15, "category"),  # Nobody's drawer of 4 inches.
        ("thing.obj", (0.1, 0.1, 4.9), 1.0, "as_is"),
        ("thing.obj", (10, 10, 490), 0.001, "guess"),
        ("thing.obj", (1e6, 1e6, 1e7), 1e-7, "guess"),
        ("thing.obj", (1e-3, 1e-3, 1e-3), 1000.0, "guess"),
    ],
)
def test_units_are_guessed_from_plausible_sizes(name, extents, factor, source, tmp_path):
    provenance = _load(_box(tmp_path, name, extents)).provenance
    assert provenance.scale == pytest.approx(factor)
    assert provenance.scale_source == source
    notes = " ".join(provenance.notes)
    assert f"{extents[2]:.4g}" in notes
    kind = name.removesuffix(".obj")
    assert (f"category {kind} was guessed" in notes) is (provenance.category == kind)


@pytest.mark.parametrize(
    ("stem", "folder", "category"),
    [
        ("fridge_03", "", "fridge"),
        ("residential_CoffeeTable_01", "", "coffee_table"),
        ("TVCabinet", "", "cabinet"),
        ("kitchencabinet", "", "cabinet"),
        ("kitchentable_sink", "", "sink"),
        ("cabinet_door_left", "", "door"),
        ("model", "refrigerator_12", "fridge"),
        ("mesh_17", "chairs", "chair"),
        ("holder", "furniture_bench_parts", None),
        ("robot", "", None),
        ("tablet", "", "tablet"),
        ("phone_booth", "", "phone_booth"),
        ("mailbox", "", "mailbox"),
    ],
)
def test_category_is_guessed_from_names(stem, folder, category):
    assert guess_category(stem, folder) == category


def test_a_gltf_that_is_only_plausible_z_up_is_kept_y_up_but_pointed_out(tmp_path):
    nodes = [{"mesh": 0, "scale": [0.9, 0.04, 2.0]}]
    provenance = _load(write_glb(tmp_path, "door.glb", nodes=nodes)).provenance
    assert provenance.up == "y"
    assert any("set up to z" in note for note in provenance.notes)
    fine = _load(write_glb(tmp_path, "door.glb", nodes=nodes), up="z").provenance
    assert (fine.scale_source, len(fine.notes)) == ("as_is", 2)


def test_sidecar_says_everything(tmp_path):
    (tmp_path / "pred.npz").write_bytes(b"x")
    size = 'category = "Refrigerator"\nup = "y"\nheight = 2.0\ndensity = 400\n'
    intake = _load(write_glb(tmp_path), f'{size}license = "MIT"\nannotation = "pred.npz"\n')
    provenance = intake.provenance
    assert (provenance.category, provenance.density, provenance.license) == ("fridge", 400.0, "MIT")
    assert intake.annotation_path == tmp_path / "pred.npz"
    assert intake.annotation is None


def test_the_longer_sidecar_name_wins(tmp_path):
    path = write_glb(tmp_path)
    (tmp_path / "cube.toml").write_text('category = "chair"')
    (tmp_path / "cube.glb.toml").write_text('category = "table"')
    assert load_mesh(path, IntakeConfig()).provenance.category == "table"


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("heigth = 1.0", "known are category"),
        ("height = 1.0\nscale = 2.0", "at most one"),
        ("height = -1", "positive"),
        ("scale = true", "positive"),
        ("density = nan", "positive"),
        ('up = "north"', "want one of"),
        ("category = 3", "text"),
        ('category = "firdge"', "did you mean 'fridge'"),
        ('category = "spaceship"', "state its height"),
        ("not toml at all", "TOML"),
        ('annotation = "absent.npz"', "does not exist"),
        ("height = 1" + "0" * 400, "positive"),
        ("height = " + "9" * 5000, "TOML"),
        ("scale = 1e300", "positive"),
        ("density = 1e-300", "positive"),
        (f"annotation = '{'n' * 300}'", "annotation"),
        ("annotation = 'loop'", "does not exist"),
        ("#" * 70_000, "at most"),
    ],
    ids=lambda each: each[:20],
)
def test_a_bad_sidecar_is_rejected_with_what_would_work(content, said, tmp_path):
    (tmp_path / "loop").symlink_to("loop")
    found = refusal(_load, write_stl(tmp_path), content)
    assert (found.code, said in found.message) == ("bad_sidecar", True)


@pytest.mark.parametrize(
    ("sidecar", "height"), [("scale = 1e-9", None), ("scale = 1e9", None), ("", 1e300)]
)
def test_a_size_that_no_object_has_is_absurd(sidecar, height, tmp_path):
    box = '<visual><geometry><box size="1 1 1"/></geometry></visual>'
    (tmp_path / "box.urdf").write_text(f'<robot name="r"><link name="l">{box}</link></robot>')
    for path in (write_glb(tmp_path), tmp_path / "box.urdf"):
        path.with_suffix(".toml").write_text(sidecar)
        assert refusal(load, path, IntakeConfig(height=height)).code == "absurd_size"


def test_an_annotation_outside_the_folder_is_external(tmp_path):
    found = refusal(_load, write_stl(tmp_path), 'annotation = "../pred.npz"')
    assert found.code == "external_reference"


def test_every_typical_size_is_plausible_and_every_alias_unique():
    sizes = {size.name: size for size in category_table().values()}
    assert len(sizes) >= 50
    for size in sizes.values():
        assert size.range[0] <= size.typical <= size.range[1]


@given(st.sampled_from(sorted(category_table())), st.floats(1e-6, 1e6), st.floats(0.1, 10.0))
def test_the_chosen_scale_is_always_plausible(name, height, aspect):
    extents = np.array([height * aspect, height / 2.0, height])
    size = category_table()[name]
    scale = scale_by_size(extents, name)
    measured = scale.factor * (extents.max() if size.measure == "extent" else extents[2])
    assert size.range[0] * (1 - 1e-9) <= measured <= size.range[1] * (1 + 1e-9)
