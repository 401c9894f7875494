"""What goes with a mover, and which little pieces are none."""

import numpy as np
from modelled_furniture import board, drawer_chest

from asset_factory.factory.articulate.auto.articulator import AutoArticulator
from asset_factory.factory.articulate.auto.hidden import without_hidden
from asset_factory.factory.articulate.auto.trust import load_trust
from asset_factory.factory.articulate.proposal import Motion, Proposal
from asset_factory.factory.articulation import JointKind
from asset_factory.factory.config import AutoConfig, BuildConfig
from asset_factory.factory.geometry.components import connected_components
from asset_factory.factory.mesh import concatenate
from asset_factory.factory.part import PartKind, Proposer
from asset_factory.factory.views.view import Views

OUT = Motion(JointKind.PRISMATIC, np.array([0.0, -1.0, 0.0]), np.zeros(3), 0.0, 0.3)
SURE = {"learned": 1.0, "confidence": 4.0, "moves": 4.0, "agreement": 1.0}


def decided(mesh, *movers):
    """Return what becomes of movers of which the network is sure."""
    settings = BuildConfig().particulate
    nobody = AutoArticulator(None, (), load_trust(), settings, AutoConfig(least_confidence=0))
    sure = {"signs": SURE, "proposer": Proposer.NETWORK}
    return nobody.decide(
        Views(mesh), [Proposal(PartKind.PART, each, OUT, **sure) for each in movers]
    )


def test_a_knob_goes_with_the_plate_that_it_alone_touches():
    mesh = drawer_chest()
    pieces = connected_components(mesh)
    found = decided(mesh, pieces == 1)
    assert set(pieces[found.parts[1].faces]) == {1, 3}


def test_a_little_piece_that_no_side_shows_is_no_mover_by_the_networks_word_alone():
    chest = drawer_chest()
    mesh = concatenate([chest, board((0.1, 0.1, 0.3), (0.12, 0.4, 0.32))])
    runner = np.arange(len(mesh.faces)) >= len(chest.faces)
    knob = connected_components(mesh) == 3
    found = decided(mesh, runner, knob)
    (joint,) = found.movable_joints
    assert knob[found.parts[joint.child].faces].all()


def test_a_rack_behind_a_door_may_move_and_a_pair_of_runners_may_not():
    oven = board((0.0, 0.0, 0.0), (0.6, 0.6, 0.8))
    bars = [board((x, 0.1, 0.4), (x + 0.01, 0.5, 0.41)) for x in np.linspace(0.1, 0.49, 9)]
    for pieces, kept in ((bars, True), (bars[::8], False)):
        mesh = concatenate([oven, *pieces])
        faces = np.arange(len(mesh.faces)) >= len(oven.faces)
        said = Proposal(PartKind.PART, faces, OUT, proposer=Proposer.NETWORK)
        assert (without_hidden(Views(mesh), [said]) == [said]) is kept
