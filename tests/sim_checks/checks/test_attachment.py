"""What moves has to come near what carries it, somewhere on its way."""

from dataclasses import replace

import pytest
from box_world import body, box_shape, built, joint, sliding, turning, with_joint, with_link

from asset_factory.sim_checks.checks.attachment import check_attachment
from asset_factory.sim_checks.config import LintConfig

T = 0.02
#: An open cabinet, a metre wide and deep, of boards.
CARCASS = body("base", [
    ((-0.49, 0, 0.5), (T, 1, 1)),
    ((0.49, 0, 0.5), (T, 1, 1)),
    ((0, 0.49, 0.5), (1, T, 1)),
    ((0, 0, 0.01), (1, 1, T)),
    ((0, 0, 0.99), (1, 1, T)),
])  # fmt: skip


def board(y, width=0.6):
    """A board before, or within, the cabinet; it slides along -y by 0.1 m."""
    return built(sliding("door", [((0.0, y, 0.5), (width, T, 0.6))], (0, -1, 0), 0.1), base=CARCASS)


def with_handle():
    hung = board(0.0)
    handle = box_shape((0.4, 0.0, 0.5), (0.2, T, T))
    return with_link(hung, "door", visuals=(*hung.links[1].visuals, handle))


def with_frame_between():
    """What carries the board has no shapes and turns itself."""
    far = with_joint(board(0.0), "door", parent="between")
    bare = replace(CARCASS, name="between", collisions=(), visuals=())
    turn = joint("turn", "revolute", "base", "between", (0, 0, 0), (0, 0, 1), (0.0, 0.1))
    return replace(far, links=(*far.links, bare), joints=(turn, *far.joints))


def hinged(behind):
    hinge = (-0.5, -0.5 + behind, 0.5)
    door = turning("door", [((0.0, -0.52, 0.5), (1.0, T, 1.0))], hinge, (0, 0, -1), 1.57)
    return built(door, base=CARCASS)


@pytest.mark.parametrize(
    ("description", "gaps"),
    [
        (board(0.0), [180.0]),
        (board(0.0, width=0.93), []),
        (board(0.2), [180.0]),
        (with_joint(board(0.35), "door", lower=-0.11, upper=0.0), []),
        (with_handle(), []),
        (with_frame_between(), [180.0, 180.0]),
        (hinged(0.0), []),
        (hinged(0.02), []),
        (hinged(0.4), [409.7]),
    ],
    ids=["in the middle of its cabinet", "a finger's width from the walls", "near the back",
         "near the back on its way", "held by a handle that is only seen",
         "on a frame without shapes", "on its hinge", "near its hinge", "far from its hinge"],
)  # fmt: skip
def test_what_moves_hangs_on_what_it_comes_near_to_somewhere(description, gaps):
    found = check_attachment(description, LintConfig()).findings
    assert all((item.code, item.severity) == ("part_detached", "error") for item in found)
    assert [item.value for item in found] == pytest.approx(gaps, rel=1e-3)
