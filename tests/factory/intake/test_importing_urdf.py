"""URDF -> Intake: geometry in place, joints in the root frame, a reason for every refusal."""

import numpy as np
import pytest
from fault_corpus.things import words
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from laid import laid
from plain_solids import signed_volume
from refusing import refusal
from scipy.spatial.transform import Rotation

from asset_factory.factory.articulate.annotated import AnnotatedArticulator
from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.intake.load import load_description
from asset_factory.sim_checks.geometry.placing import rigid

BOX = '<visual><geometry><box size="1 1 1"/></geometry></visual>'
TETRA = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


def write(folder, body):
    return laid(folder / "thing.urdf", f'<?xml version="1.0"?>\n<robot name="r">{body}</robot>')


def link(name, inside=BOX):
    return f'<link name="{name}">{inside}</link>'


def joint(name, kind, parent, child, inside='<limit lower="0" upper="1"/>'):
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{inside}</joint>'


def load(path):
    return load_description(path, IntakeConfig())


def articulated(intake):
    assert intake.annotation is not None
    given = (intake.annotation, intake.transform, intake.source_faces)
    return AnnotatedArticulator(*given).articulate(intake.mesh)


def lift(folder, body):
    return articulated(load(write(folder, body)))


AB = link("a") + link("b")


def test_a_mirroring_mesh_scale_keeps_faces_outward(tmp_path):
    (tmp_path / "tetra.obj").write_text(TETRA)
    visual = '<visual><geometry><mesh filename="tetra.obj" scale="-2 1 1"/></geometry></visual>'
    result = lift(tmp_path, link("base", visual))
    np.testing.assert_allclose(result.mesh.bounds, [[-2.0, 0.0, 0.0], [0.0, 2.0, 3.0]])
    assert signed_volume(result.part_mesh(0)) == pytest.approx(2.0)


def test_commas_between_numbers_are_read_as_others_read_them_and_told(tmp_path):
    (tmp_path / "t.obj").write_text(TETRA, encoding="utf-8")
    shape = '<visual><geometry><mesh filename="t.obj" scale="{}"/></geometry></visual>'
    moved = link("a", shape.format("2.0, 1.0,1.0")) + link("b") + joint("j", "prismatic", "a", "b")
    intake = load(write(tmp_path, moved))
    assert np.ptp(intake.mesh.vertices[:4], axis=0).tolist() == [2, 2, 3]
    assert any("commas" in note for note in intake.provenance.notes)
    wrong = moved.replace("2.0, 1.0,1.0", "2,0 1 1,0")
    assert refusal(lift, tmp_path, wrong).code == "unreadable"


def test_materials_are_found_by_name_and_in_place(tmp_path):
    def colored(material):
        return f'<visual><geometry><box size="1 1 1"/></geometry>{material}</visual>'

    own = colored('<material name="own"><color rgba="0 0 1 0.5"/></material>')
    base = link("base", colored('<material name="red"/>') + own)
    result = lift(tmp_path, '<material name="red"><color rgba="1 0 0 1"/></material>' + base)
    assert [m.color for m in result.mesh.materials] == [(1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 0.5)]
    assert np.bincount(result.mesh.face_material).tolist() == [12, 12]


def test_collision_geometry_stands_in_only_where_nothing_can_be_seen(tmp_path):
    hull = '<collision><geometry><box size="1 1 1"/></geometry></collision>'
    links = link("base", BOX + hull) + link("arm", hull) + link("shield", hull)
    joints = joint("j", "prismatic", "base", "arm") + joint("f", "fixed", "base", "shield")
    intake = load(write(tmp_path, links + joints))
    assert [len(part.faces) for part in articulated(intake).parts] == [12, 12]
    assert any("collision geometry" in note for note in intake.provenance.notes)


def test_repeated_inertials_and_visual_names_do_not_matter(tmp_path):
    inertial = '<inertial><mass value="1"/></inertial>'
    named = '<visual name="v"><geometry><box size="1 1 1"/></geometry></visual>'
    assert len(lift(tmp_path, link("base", inertial * 2 + named * 2)).mesh.faces) == 24


def test_a_mimic_that_cannot_be_read_moves_freely_and_a_note_says_so(tmp_path):
    body = link("a") + link("b") + link("c") + joint("one", "prismatic", "a", "b")
    mimic = '<mimic joint="one" multiplier="fast"/>'
    body += joint("two", "prismatic", "a", "c", f'<limit lower="0" upper="1"/>{mimic}')
    path = write(tmp_path, body)
    assert any("'two': its mimic cannot be read" in note for note in load(path).provenance.notes)
    assert articulated(load(path)).joint("two").mimic is None


def test_a_lid_drawn_outside_its_limits_is_closed_where_the_object_is_smallest(tmp_path):
    """Drawn upright, it can lie down to -1.57 rad; the limit beside the drawing is not closed."""
    lid = '<visual><origin xyz="0 0 0.1"/><geometry><box size="1 0.02 0.2"/></geometry></visual>'
    hinge = '<origin xyz="0 -0.5 0.51"/><axis xyz="1 0 0"/><limit lower="-1.57" upper="-0.2"/>'
    hinged = joint("j", "revolute", "box", "lid", hinge)
    made = lift(tmp_path, link("box") + link("lid", lid) + hinged).joint("j")
    assert made.lower == pytest.approx(-1.37)
    np.testing.assert_allclose(made.axis, [1, 0, 0])


def test_height_and_up_axis_scale_geometry_axes_and_travel_alike(tmp_path):
    slide = joint("j", "prismatic", "a", "b", '<axis xyz="0 1 0"/><limit lower="0" upper="0.5"/>')
    intake = load_description(write(tmp_path, AB + slide), IntakeConfig(up="y", height=2.0))
    result = articulated(intake)
    assert intake.mesh.extents[2] == pytest.approx(2.0)
    np.testing.assert_allclose(result.joint("j").axis, [0.0, 0.0, 1.0], atol=1e-12)
    assert result.joint("j").upper == pytest.approx(1.0)


def test_the_digest_depends_on_every_file_that_was_read(tmp_path):
    (tmp_path / "tetra.obj").write_text(TETRA)
    path = write(tmp_path, seen('<mesh filename="tetra.obj"/>'))
    before = load(path).provenance.digest
    assert load(path).provenance.digest == before
    (tmp_path / "tetra.obj").write_text(TETRA.replace("v 1 0 0", "v 2 0 0"))
    assert load(path).provenance.digest != before


def seen(shape):
    return link("a", f"<visual><geometry>{shape}</geometry></visual>")


@pytest.mark.parametrize(
    ("code", "body", "says"),
    [
        ("not_a_tree", "", "no <link>"),
        ("not_a_tree", AB, "'a', 'b'"),
        ("not_a_tree", link("a") + link("a"), "'a'"),
        ("unsupported_joint", AB + joint("j", "planar", "a", "b"), "'planar'"),
        # What else is no number or no shape, the tests of what reads elements tell.
        ("unreadable", seen('<box size="1 1"/>'), "'1 1'"),
        ("unreadable", seen('<box size="1 -1 1"/>'), "positive"),
        ("unreadable", seen('<box size="1 1e300 1"/>'), "up to 1e+06"),
        ("unreadable", AB + joint("j", "revolute", "a", "b", '<limit lower="x"/>'), "'x'"),
        *(
            ("missing_file", seen(f'<mesh filename="{name}.obj"/>'), name[:9])
            for name in ("no", "a%00b", "loop", "n" * 300, "d/" * 3000 + "x")
        ),
        ("external_reference", seen('<mesh filename="../x.obj"/>'), "../x.obj"),
        ("external_reference", seen('<mesh filename="/etc/passwd"/>'), "/etc"),
        ("external_reference", seen('<mesh filename="http://h/x.obj"/>'), "http"),
        ("empty", link("a", ""), "no link has any geometry"),
        ("no_limits", AB + joint("j", "prismatic", "a", "b", ""), "'j'"),
        ("no_limits", AB + joint("j", "prismatic", "a", "b", '<limit lower="-1e308"/>'), "-inf"),
        ("bad_axis", AB + joint("j", "continuous", "a", "b", '<axis xyz="0 0 0"/>'), "'j'"),
        ("too_large", link("a") + '<link name="l"/>' * 5000, "5,001 links"),
        ("too_large", link("a") + "<a/>" * 1_000_001, "elements and attributes"),
        ("too_large", link("a", BOX * 10_001), "10,001 shapes"),
    ],
    ids=lambda each: each[:40],
)
def test_what_cannot_be_used_is_refused_with_a_code_and_a_name(tmp_path, code, body, says):
    (tmp_path / "loop.obj").symlink_to("loop.obj")
    error = refusal(lift, tmp_path, body)
    assert (error.code, says in error.message) == (code, True)
    assert str(tmp_path) not in error.message
    assert len(error.message) < 400


def test_too_many_faces_or_bytes_are_refused_with_the_number(tmp_path):
    path = write(tmp_path, link("a", BOX * 3))
    found = refusal(load_description, path, IntakeConfig(max_faces=30)).finding
    assert (found.code, found.value) == ("too_large", 36)
    path.write_text(path.read_text() + " " * 70_000_000)
    assert "bytes of XML" in refusal(load, path).message


number = st.floats(-2.0, 2.0).map(lambda x: round(x, 3))
triple = st.tuples(number, number, number)
axes = triple.filter(lambda v: sum(x * x for x in v) > 0.01)
kinds = st.sampled_from(["revolute", "prismatic", "continuous", "fixed"])
edge = st.tuples(
    st.integers(0, 10**6), kinds, triple, triple, axes, st.floats(0.0, 1.0), triple, triple
)


def placed(xyz, angles):
    """The pose that an origin states, independent of the reader, shape [4, 4]."""
    # Roll, then pitch, then yaw, about axes that stand still.
    roll, pitch, yaw = map(Rotation.from_rotvec, np.diag(angles))
    return rigid((yaw * pitch * roll).as_matrix(), np.array(xyz))


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(edge, min_size=1, max_size=6))
def test_random_trees_move_as_a_product_of_matrices_says(tmp_path, edges):
    body = link("l0")
    frames = [np.eye(4)]
    seats = [np.eye(4)]
    for child, (pick, kind, xyz, angles, axis, share, seat, tilt) in enumerate(edges, start=1):
        parent = pick % child
        place, turn, line, at, askew = map(words, (xyz, angles, axis, seat, tilt))
        visual = f'<visual><origin xyz="{at}" rpy="{askew}"/>'
        body += link(f"l{child}", BOX.replace("<visual>", visual))
        seats.append(placed(seat, tilt))
        written = f'<origin xyz="{place}" rpy="{turn}"/><axis xyz="{line}"/>'
        written += '<limit lower="0" upper="1.5"/>'
        body += joint(f"j{child}", kind, f"l{parent}", f"l{child}", written)
        unit = np.array(axis) / np.linalg.norm(axis)
        value = 1.5 * share
        turned = rigid(Rotation.from_rotvec(unit * value).as_matrix(), np.zeros(3))
        slid = rigid(np.eye(3), unit * value)
        motion = {"prismatic": slid, "fixed": np.eye(4)}.get(kind, turned)
        frames.append(frames[parent] @ placed(xyz, angles) @ motion)
    intake = load(write(tmp_path, body))
    result = articulated(intake)
    values = {f"j{n}": 1.5 * e[5] for n, e in enumerate(edges, start=1) if e[1] != "fixed"}
    assert {j.name for j in result.joints} == set(values)
    poses = result.poses(values)
    cube = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    owner = np.concatenate([np.full(len(part.faces), i) for i, part in enumerate(result.parts)])
    owner = owner[np.argsort(np.concatenate([part.faces for part in result.parts]))]
    for index, frame in enumerate(frames):
        faces = np.flatnonzero(intake.annotation.face_part[intake.source_faces] == index)
        pose = poses[owner[faces[0]]]
        corners = np.unique(result.mesh.vertices[result.mesh.faces[faces]].reshape(-1, 3), axis=0)
        moved = corners @ pose[:3, :3].T + pose[:3, 3]
        shown = frame @ seats[index]
        expected = cube @ shown[:3, :3].T + shown[:3, 3]
        distance = np.linalg.norm(moved[:, None] - expected[None], axis=2)
        assert distance.min(axis=1).max() < 1e-9
        assert distance.min(axis=0).max() < 1e-9
