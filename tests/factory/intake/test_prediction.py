"""pred.npz -> Annotation."""

import numpy as np
import pytest
from refusing import refusal

from asset_factory.factory.articulate.annotated import AnnotatedArticulator
from asset_factory.factory.articulation import JointKind
from asset_factory.factory.intake.importers.prediction import point_on_line, read_prediction
from asset_factory.factory.mesh import Mesh

FACES = 8


def save(folder, **changes):
    """Labels of four boxes: part 0 carries a hinge (1), a slider (2) and a part with both (3)."""
    axis = np.array([0.0, 0.0, 1.0])
    point = np.array([1.0, 2.0, 0.0])
    line = np.concatenate([axis, np.cross(axis, point)])
    result = {
        "face_part_ids": np.repeat(np.arange(4), 2),
        "motion_hierarchy": np.array([[0, 1], [0, 2], [0, 3]]),
        "is_part_revolute": np.array([False, True, False, True]),
        "is_part_prismatic": np.array([False, False, True, True]),
        "revolute_plucker": np.stack([np.zeros(6), line, np.zeros(6), line]),
        "revolute_range": np.array([[0, 0], [0, 1.5], [0, 0], [0, 1.0]]),
        "prismatic_axis": np.array([[0, 0, 0], [0, 0, 0], [0, 2, 0], [1, 0, 0]], dtype=np.float32),
        "prismatic_range": np.array([[0, 0], [0, 0], [0, 0.3], [0, 0.2]], dtype=np.float32),
    }
    result.update(changes)
    path = folder / "pred.npz"
    np.savez(path, **{name: value for name, value in result.items() if value is not None})
    return path


def articulate(path, count=FACES):
    """What is read of loose triangles side by side, one above another."""
    annotation = read_prediction(path, count)
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=np.float64)
    vertices = np.concatenate([corners + np.array([0, 0, i]) for i in range(count)])
    strip = Mesh.from_triangles(vertices, np.arange(3 * count).reshape(-1, 3))
    return AnnotatedArticulator(annotation, np.eye(4), np.arange(count)).articulate(strip)


def test_moments_are_axis_cross_point():
    random = np.random.default_rng(0)
    for _ in range(20):
        axis = random.normal(size=3)
        point = random.normal(size=3)
        found = point_on_line(axis, np.cross(axis, point))
        np.testing.assert_allclose(np.cross(axis, found - point), 0.0, atol=1e-12)


def test_all_four_motions_become_joints(tmp_path):
    result = articulate(save(tmp_path))
    turns, slides = JointKind.REVOLUTE, JointKind.PRISMATIC
    kinds = {joint.name: joint.kind for joint in result.joints}
    both = {"joint_3_turn": turns, "joint_3_slide": slides}
    assert kinds == {"joint_1": turns, "joint_2": slides, **both}
    assert result.joint("joint_2").upper == pytest.approx(0.3)
    np.testing.assert_allclose(result.joint("joint_1").origin[:2], [1.0, 2.0], atol=1e-12)


def test_what_turns_and_slides_slides_along_the_turned_direction(tmp_path):
    ranges = np.array([[0, 0], [0, 1.5], [0, 0], [0, np.pi / 2]])
    result = articulate(save(tmp_path, revolute_range=ranges))
    part = [p.name for p in result.parts].index("part_3")
    start = np.array([2.0, 2.0, 0.0, 1.0])
    moved = result.poses({"joint_3_turn": np.pi / 2.0, "joint_3_slide": 0.2})[part] @ start
    np.testing.assert_allclose(moved[:3], [1.0, 3.2, 0.0], atol=1e-6)


def test_further_trees_are_attached_to_the_largest_and_a_note_names_them(tmp_path):
    result = articulate(save(tmp_path, motion_hierarchy=np.array([[0, 1], [0, 2]])))
    assert len(result.movable_joints) == 2
    assert len(result.parts[0].faces) == 4
    assert any("'part_3'" in note and "'part_0'" in note for note in result.notes)


def test_faces_without_a_part_go_to_the_root(tmp_path):
    result = articulate(save(tmp_path, face_part_ids=np.array([0, 0, 1, 1, 2, 2, 3, -1])))
    assert result.parts[0].faces.tolist() == [0, 1, 7]
    assert any("1 faces belong to no part" in note for note in result.notes)


def test_labels_of_faces_that_were_dropped_do_not_matter(tmp_path):
    path = save(tmp_path, face_part_ids=np.array([0, 0, 1, 1, 2, 2, 3, 3, 3]))
    assert len(read_prediction(path, FACES).face_part) == 9


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"revolute_range": None}, "revolute_range"),
        ({"face_part_ids": np.zeros(FACES - 1, dtype=int)}, "8 faces"),
        ({"face_part_ids": np.zeros(FACES)}, "float64"),
        ({"face_part_ids": np.full(FACES, 4)}, "4"),
        ({"face_part_ids": np.full(FACES, -2)}, "-2"),
        ({"motion_hierarchy": np.array([[0, 9]])}, "part 9"),
        ({"motion_hierarchy": np.array([0, 1, 2])}, "motion_hierarchy"),
        ({"prismatic_axis": np.zeros((4, 2))}, "prismatic_axis"),
        ({"revolute_plucker": np.full((4, 6), np.nan)}, "revolute_plucker"),
        ({"is_part_revolute": np.array(True)}, "parts"),
        ({"revolute_range": np.array([[object()] * 2] * 4, dtype=object)}, "plain arrays"),
    ],
)
def test_unknown_shapes_are_refused_by_name(tmp_path, changes, says):
    found = refusal(read_prediction, save(tmp_path, **changes), FACES)
    assert (found.code, says in found.message) == ("bad_annotation", True)


def test_files_that_are_no_archives_are_refused(tmp_path):
    path = tmp_path / "pred.npz"
    assert refusal(read_prediction, path, FACES).code == "missing_file"
    for content in (b"", b"PK\x03\x04 broken", b"\x80\x04K\x01."):
        path.write_bytes(content)
        assert refusal(read_prediction, path, FACES).code == "bad_annotation"


@pytest.mark.parametrize(
    "edges", [[[0, 1], [1, 2], [2, 1]], [[0, 1], [0, 2], [3, 2]], [[1, 0], [2, 1], [3, 2], [0, 3]]]
)
def test_hierarchies_that_are_no_forest_are_refused(tmp_path, edges):
    path = save(tmp_path, motion_hierarchy=np.array(edges))
    assert refusal(articulate, path).code == "not_a_tree"


@pytest.mark.parametrize("name", ["strict_induced_tree", "nonstrict"])
def test_published_predictions_become_trees(fixtures, name):
    path = fixtures / "postprocess_e2e" / name / "pred.npz"
    stored = np.load(path, allow_pickle=False)
    result = articulate(path, len(stored["face_part_ids"]))
    assert len(result.joints) == len(stored["motion_hierarchy"])
    # Posing a joint inside its range turns the axes it carries; those of the root's children stay.
    for joint in (j for j in result.joints if j.parent == 0):
        child = int(joint.name.rsplit("_", 1)[-1])
        line = stored["revolute_plucker"][child] if joint.turns else stored["prismatic_axis"][child]
        assert abs(joint.axis @ line[:3]) == pytest.approx(np.linalg.norm(line[:3]), rel=1e-5)
