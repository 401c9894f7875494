"""A USD asset with physics joints is an input as a URDF is; nothing outside its folder is read."""

import zipfile

import numpy as np
import pytest
from refusing import refusal
from usda import BASE, CABINET, DOOR, HINGE, body, joint, mesh, stage, write

from asset_factory.factory.articulate.stage import hypotheses_of
from asset_factory.factory.config import BuildConfig, IntakeConfig
from asset_factory.factory.geometry.posing import posed
from asset_factory.factory.intake.importers import usd
from asset_factory.factory.intake.importers.usd import import_usd
from asset_factory.factory.intake.load import load
from asset_factory.factory.intake.reads import ReadLog

CONFIG = BuildConfig(articulator="annotated")


@pytest.fixture(autouse=True)
def read_here(request, monkeypatch):
    """Spare every read a child process but the first test's."""
    if request.function is not test_its_parts_joints_and_sidecar_come_with_it_in_metres_and_z_up:
        monkeypatch.setattr(usd, "ask_of", lambda _child, _name, ask, *given: ask(*given))


def test_its_parts_joints_and_sidecar_come_with_it_in_metres_and_z_up(tmp_path):
    path = write(tmp_path, stage(CABINET, 'metersPerUnit = 0.01\nupAxis = "Y"'))
    assert load(path, CONFIG.intake).provenance.scale == pytest.approx(0.01)
    stated = 'category = "fridge"\nheight = 1.24\nlicense = "MIT"\ndensity = 300.0\n'
    path.with_suffix(".toml").write_text(stated)
    intake = load(path, CONFIG.intake)
    told = intake.provenance
    assert (told.category, told.license, told.density) == ("fridge", "MIT", 300.0)
    assert (told.scale_source, told.scale) == ("sidecar", pytest.approx(2.0))
    assert intake.mesh.extents[2] == pytest.approx(1.24)
    (made,) = hypotheses_of(intake, CONFIG)
    assert [part.name for part in made.parts] == ["base", "door"]
    (hinge,) = made.movable_joints
    np.testing.assert_allclose([hinge.lower, hinge.upper], [0.0, np.pi / 2.0], atol=1e-6)
    np.testing.assert_allclose(np.abs(hinge.axis), [0.0, 1.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(hinge.origin[[0, 2]], [-1.0, -0.62], atol=1e-6)


def read(folder, text):
    return hypotheses_of(load(write(folder, text), CONFIG.intake), CONFIG)[0]


def test_lengths_on_a_scaled_body_are_scaled_and_its_door_opens_to_the_front(tmp_path):
    base = body("base", (0, 0, 0), mesh("box", (0.5, 0.3, 0.4)), scale=2.0)
    hinge = HINGE.replace("(-0.5, -0.31, 0)", "(-0.25, -0.155, 0)")
    held = joint("hinge", "Revolute", "/obj/base", "/obj/door", hinge)
    scaled = read(tmp_path, stage(base + DOOR + held))
    (line,) = scaled.joints
    np.testing.assert_allclose(line.origin[:2], [-0.5, -0.31], atol=1e-6)
    opened = posed(scaled, {line.name: line.upper})
    np.testing.assert_allclose(opened.part_mesh(1).bounds[0], [-0.51, -1.31, -0.4], atol=1e-6)


def test_joint_named_from_the_door_to_the_base_is_the_same_joint(tmp_path):
    limits = (
        'uniform token physics:axis = "Z"\npoint3f physics:localPos0 = (-0.5, 0, 0)\n'
        "float physics:lowerLimit = 0\nfloat physics:upperLimit = 90\n"
    )
    held = joint("held", "Fixed", "", "/obj/base")
    text = stage(BASE + DOOR + held + joint("hinge", "Revolute", "/obj/door", "/obj/base", limits))
    cabinet = read(tmp_path, text)
    assert [part.name for part in cabinet.parts] == ["base", "door"]
    np.testing.assert_allclose(cabinet.joints[0].axis, [0.0, 0.0, -1.0], atol=1e-6)


@pytest.mark.parametrize(
    ("value", "second"), [(-0.2, "(0, 0, -0.2)"), (0.1, "(0, 0, 0.1)"), (0.0, "(0, 0.3, 0)")]
)
def test_value_at_the_authored_pose_is_taken_off_the_limits(tmp_path, value, second):
    inside = (
        'uniform token physics:axis = "Z"\npoint3f physics:localPos0 = (0, -0.31, 0)\n'
        f"point3f physics:localPos1 = {second}\n"
        "quatf physics:localRot1 = (1, 0, 0, 0)\nfloat physics:lowerLimit = -0.2\n"
        "float physics:upperLimit = 0.3\n"
    )
    held = joint("slide", "Prismatic", "/obj/base", "/obj/door", inside)
    slide = read(tmp_path, stage(BASE + DOOR + held)).joints[0]
    ends = sorted(abs(value) for value in (slide.lower, slide.upper))
    np.testing.assert_allclose(ends, sorted((abs(-0.2 - value), abs(0.3 - value))), atol=1e-6)


def test_turned_joint_frames_shift_a_hinge(tmp_path):
    half = np.radians(15.0)
    inside = HINGE.replace("-90", "-60") + (
        "point3f physics:localPos1 = (-0.5, 0, 0)\n"
        f"quatf physics:localRot1 = ({np.cos(half):.8f}, 0, 0, {-np.sin(half):.8f})\n"
    )
    held = joint("hinge", "Revolute", "/obj/base", "/obj/door", inside)
    hinge = read(tmp_path, stage(BASE + DOOR + held)).joints[0]
    ends = sorted(abs(value) for value in (hinge.lower, hinge.upper))
    np.testing.assert_allclose(ends, np.radians([30.0, 30.0]), atol=1e-5)


def test_hinge_without_limits_is_continuous_and_a_slide_goes_as_far_as_usual(tmp_path):
    free = joint("hinge", "Revolute", "/obj/base", "/obj/door")
    assert read(tmp_path / "a", stage(BASE + DOOR + free)).joints[0].kind == "continuous"
    endless = joint("slide", "Prismatic", "/obj/base", "/obj/door")
    assert read(tmp_path / "b", stage(BASE + DOOR + endless)).joints[0].upper > 0.0


def test_fixed_bodies_are_one_part_and_loose_ones_stand_still(tmp_path):
    handle = body("handle", (0.4, -0.34, 0), mesh("grip", (0.02, 0.04, 0.2)))
    foot = body("foot", (0, 0, -0.45), mesh("block", (0.2, 0.2, 0.1)))
    fixed = joint("screw", "Fixed", "/obj/door", "/obj/handle")
    cabinet = read(tmp_path, stage(CABINET + handle + foot + fixed))
    assert [len(part.faces) for part in cabinet.parts] == [24, 24]


def test_bodies_in_bodies_and_surfaces_that_are_no_body(tmp_path):
    inner = body("door", (0, -0.31, 0), mesh("panel", (1.0, 0.02, 0.8)))
    outer = body("base", (0, 0, 0), mesh("box", (1.0, 0.6, 0.8)) + inner)
    hinge = joint("hinge", "Revolute", "/obj/base", "/obj/base/door", HINGE)
    nested = read(tmp_path / "a", stage(outer + hinge))
    assert [len(part.faces) for part in nested.parts] == [12, 12]
    shelf = mesh("shelf", (1.0, 0.6, 0.02))
    held = joint("hinge", "Revolute", "", "/obj/door", HINGE)
    static = read(tmp_path / "b", stage(shelf + DOOR + held))
    assert [part.name for part in static.parts] == ["base", "door"]


def test_colliders_guides_and_hidden_surfaces_are_not_seen(tmp_path):
    extra = (
        mesh("guide", (2, 2, 2), 'uniform token purpose = "guide"')
        + mesh("hidden", (2, 2, 2), 'token visibility = "invisible"')
        + 'def Xform "collisions"\n{\n'
        + mesh("hull", (2, 2, 2))
        + "}\n"
    )
    base = body("base", (0, 0, 0), mesh("box", (1.0, 0.6, 0.8)) + extra)
    hinge = joint("hinge", "Revolute", "/obj/base", "/obj/door", HINGE)
    parts = read(tmp_path, stage(base + DOOR + hinge)).parts
    assert [len(part.faces) for part in parts] == [12, 12]


def test_instances_and_primitives(tmp_path):
    shape = '\nclass Xform "_shape"\n{\n' + mesh("panel", (1.0, 0.02, 0.8)) + "}\n"
    made = 'def Xform "made" (instanceable = true\n references = </_shape>)\n{\n}\n'
    door = body("door", (0, -0.31, 0), made)
    base = body("base", (0, 0, 0), 'def Cube "box"\n{\ndouble size = 0.6\n}\n')
    hinge = joint("hinge", "Revolute", "/obj/base", "/obj/door", HINGE)
    read_back = read(tmp_path, stage(base + door + hinge) + shape)
    assert [len(part.faces) for part in read_back.parts] == [12, 12]


LOOP = joint("again", "Revolute", "/obj/base", "/obj/door", HINGE)


def test_joint_outside_the_articulation_is_none(tmp_path):
    outside = "bool physics:excludeFromArticulation = true\nrel physics:body1"
    text = stage(CABINET + LOOP.replace("rel physics:body1", outside))
    assert len(read(tmp_path, text).joints) == 1


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (CABINET + LOOP, "not_a_tree"),
        (BASE + DOOR + joint("ball", "Spherical", "/obj/base", "/obj/door"), "unsupported_joint"),
        (CABINET.replace("[4, 4, 4, 4, 4, 4]", "[4, 4, 4, 4, 4, 9]"), "unreadable"),
        (CABINET.replace("[0, 1, 3, 2", "[0, 1, 99, 2"), "unreadable"),
        (BASE + DOOR, "no_movable_joint"),
        ("", "empty"),
    ],
    ids=["loop", "ball", "counts", "corners", "still", "empty"],
)
def test_what_nothing_can_be_learned_from_is_refused(tmp_path, text, code):
    assert refusal(read, tmp_path, stage(text)).code == code


def prim(how, inside=""):
    return f'#usda 1.0\ndef Xform "obj" ({how})\n{{\n{inside}}}\n'


OUTSIDE = ("../outside.usda", "./../thing/../outside.usda", "ABSOLUTE", "file:///x.usda")
CLIPS = "clips = {dictionary default = {asset[] assetPaths = [@../x.usda@]}}"
VARIANT = (
    'variantSet "v" = {\n"a" { def Xform "x" (prepend references = @../outside.usda@)\n{\n}\n}\n}\n'
)
#: What a layer is or leads to -> its text, and the code with which it is refused.
REFUSED = {
    **{
        f"{how} {place}": (prim(f"prepend {how} = @{place}@"), "external_reference")
        for how in ("references", "payload")
        for place in OUTSIDE
    },
    "sublayer": ("#usda 1.0\n(\nsubLayers = [@../outside.usda@]\n)\n", "external_reference"),
    "variant": (
        prim('variants = {string v = "a"}\nprepend variantSets = "v"', VARIANT),
        "external_reference",
    ),
    "a layer's layer": (prim("references = @./parts/inner.usda@"), "external_reference"),
    "link": (prim("references = @./link.usda@"), "external_reference"),
    "computed": (prim("references = @`${WHERE}`@"), "unsupported"),
    "clips": (prim(CLIPS), "unsupported"),
    "another format": (prim("references = @./shape.abc@"), "unsupported"),
    "absent": (prim("references = @./absent.usda@"), "missing_file"),
    "absent below": (prim("references = @parts/absent.usda@"), "missing_file"),
    "nonsense": ("nonsense", "unreadable"),
}


def refused(main, **limits):
    return refusal(import_usd, main, IntakeConfig(**limits), ReadLog())


@pytest.mark.parametrize("what", REFUSED)
def test_a_layer_that_leads_out_or_nowhere_is_refused(tmp_path, what):
    text, code = REFUSED[what]
    # It is no USD, so opening it would be noticed.
    outside = write(tmp_path, "secret", "outside.usda")
    folder = tmp_path / "thing"
    write(folder / "parts", prim("references = @../../outside.usda@"), "inner.usda")
    (folder / "link.usda").symlink_to(outside)
    assert refused(write(folder, text.replace("ABSOLUTE", str(outside)))).code == code


def test_a_package_that_leads_out_is_refused(tmp_path):
    outside = write(tmp_path, "secret", "outside.usda")
    package = tmp_path / "thing" / "thing.usdz"
    package.parent.mkdir()
    with zipfile.ZipFile(package, "w", zipfile.ZIP_STORED) as archive:
        archive.writestr("inner.usda", prim(f"references = @{outside}@"))
    assert refused(package).code == "external_reference"


def test_own_layers_and_looks_elsewhere_are_fine_up_to_a_limit(tmp_path):
    write(tmp_path / "parts", stage(CABINET), "inner.usda")
    looks = "asset map = @../../outside.png@\n"
    main = write(tmp_path, prim("references = @parts/inner.usda@</obj>", looks))
    import_usd(main, IntakeConfig(), ReadLog())
    assert "limit" in refused(main, max_bytes=1000).message
