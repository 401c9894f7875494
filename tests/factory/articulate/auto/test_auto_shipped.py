"""The network that ships with the package finds what the rules of shape cannot."""

import numpy as np

from asset_factory.factory.articulate.auto import load_auto
from asset_factory.factory.articulate.geometric import GeometricArticulator
from asset_factory.factory.config import AutoConfig, ParticulateConfig
from asset_factory.learn.evaluate.physical import physical
from asset_factory.learn.objects import make_object

#: Seeds below a million are never trained on.
UNSEEN = [("notebook", 5), ("scissors", 5), ("toilet", 5), ("oven", 5)]


def right(articulator, category, seed):
    truth = make_object(category, seed)
    return float(np.mean(physical(truth, articulator.articulate(truth.mesh)).pooled["joint_right"]))


def test_with_the_network_more_joints_are_right_than_by_shape_alone():
    auto = load_auto(ParticulateConfig(), AutoConfig())
    together = [right(auto, *case) for case in UNSEEN]
    alone = [right(GeometricArticulator(), *case) for case in UNSEEN]
    assert np.mean(together) > np.mean(alone) + 0.3
    assert np.mean(together) > 0.7
