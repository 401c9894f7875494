"""Where nothing moves, the sentence says what was seen and what would help."""

from refusing import refusal

from asset_factory.factory.articulate.stage import articulate
from asset_factory.factory.config import BuildConfig, IntakeConfig
from asset_factory.factory.intake.load import load

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n"
TETRAHEDRON = f"{TRIANGLE}v 1 1 0\nf 1 2 4\nf 2 3 4\nf 1 3 4\n"


def rejected(tmp_path, text):
    path = tmp_path / "shape.obj"
    path.write_text(text)
    found = refusal(articulate, load(path, IntakeConfig()), BuildConfig(articulator="geometric"))
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
