"""Joints driven at the same time: only where nothing that they move can meet."""

import pytest
from box_world import built, sliding, turning

from asset_factory.sim_checks.description import Mimic
from asset_factory.sim_checks.geometry.apart import joints_apart

SIZE = (0.1, 0.1, 0.1)
UP = (0.0, 0.0, 1.0)


def slide(name, x, parent="base", **more):
    return sliding(name, [((x, 0.0, 0.0), SIZE)], UP, 0.3, parent, **more)


SPUN = turning("a", [((0.0, 0.0, 0.0), SIZE)], (0.0, 0.0, 0.0), UP, 0.3)


@pytest.mark.parametrize(
    ("parts", "found"),
    [
        ([slide("a", 0.0), slide("b", 0.104)], ()),
        ([slide("a", 0.0), slide("b", 0.106)], (("a", "b"),)),
        ([slide(name, 0.102 * i) for i, name in enumerate("abcde")], (("a", "c", "e"), ("b", "d"))),
        # The corner of a box that turns about its centre comes nearer than its side.
        ([SPUN, slide("b", 0.107)], ()),
        ([SPUN, slide("b", 0.13)], (("a", "b"),)),
        (
            [slide("a", 0.0), slide("rider", 0.2, "a"), slide("b", 0.5), slide("c", 0.8)],
            (("rider", "b", "c"),),
        ),
        ([slide("a", 0.0), slide("led", 0.2, mimic=Mimic("a")), slide("b", 0.5)], ()),
    ],
    ids=["nearer than the margin", "further than the margin", "neighbours in different groups",
         "a hinge without room for its turn", "a hinge with room", "what carries another joint",
         "what follows another joint"],
)  # fmt: skip
def test_joints_are_grouped_by_what_can_meet(parts, found):
    assert joints_apart(built(*parts)) == found
