"""A panel and the part that it belongs to turn with the object."""

import numpy as np

from asset_factory.factory.articulation import rotation_about
from asset_factory.factory.part import OpensBy, Panel, Part, PartKind, PartSource, Proposer
from asset_factory.factory.runtime.packing import pack, unpack

FRAME = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
DOOR = Part(
    "door_0",
    np.arange(3),
    0.7,
    kind=PartKind.DOOR,
    panel=Panel(FRAME, [0.1, 0.2], [0.5, 0.8], -0.3, 0.02, OpensBy.LEFT),
    source=PartSource("0123456789ab", Proposer.SIDES, 0.7, {"shown": 1.5}),
)


def test_a_panel_knows_where_it_is_and_turns_with_its_part_and_handle():
    panel = DOOR.panel
    np.testing.assert_allclose(panel.center, [0.3, -0.3, 0.5])
    np.testing.assert_allclose(panel.outward, [0.0, -1.0, 0.0])
    np.testing.assert_allclose(panel.size, [0.4, 0.6])
    turn = rotation_about([0.0, 0.0, 1.0], 0.3)
    turned = DOOR.turned(turn)
    np.testing.assert_allclose(turned.panel.center, turn @ panel.center)
    np.testing.assert_allclose(turned.panel.outward, turn @ panel.outward)
    back = turned.turned(turn.T)
    np.testing.assert_allclose(back.panel.frame, panel.frame, atol=1e-15)


def test_a_part_is_remembered_with_all_that_it_is():
    kept = unpack(Part, pack(DOOR))
    assert kept.kind is PartKind.DOOR
    assert kept.panel.opens is OpensBy.LEFT
    assert kept.source == DOOR.source
    np.testing.assert_array_equal(kept.panel.frame, DOOR.panel.frame)
    plain = unpack(Part, pack(Part("base", np.arange(2))))
    assert plain.kind is PartKind.PART
    assert plain.panel is None
    assert plain.source is None
