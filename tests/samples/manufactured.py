"""What is made of an object's parts, its stages kept in a folder."""

import numpy as np

from asset_factory.factory.config import BuildConfig, DecomposeConfig
from asset_factory.factory.intake.intake import Intake, Provenance
from asset_factory.factory.manufacture.decompose.decompose import decompose
from asset_factory.factory.manufacture.decompose.room import rooms_of
from asset_factory.factory.manufacture.plan import Plan
from asset_factory.factory.manufacture.stage import manufacture
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.runtime.store import Store


def intake_of(mesh, **known):
    """A mesh as if it were read, with what is known of it."""
    provenance = Provenance("thing.glb", "0" * 64, **known)
    return Intake("thing", mesh, np.arange(len(mesh.faces)), np.eye(4), provenance)


def decomposed(articulation, config=None, store=None, **known):
    """The hulls of every part, kept in a store if there is one; ``known`` as for the stage."""
    stages = Stages(BuildConfig(decompose=config or DecomposeConfig()), store)
    return decompose(articulation, stages, rooms_of(articulation), **known)


def manufactured(whole, kept, plan=None, config=None, **known):
    """The asset, what is found of it, and the stages that made it of what is known."""
    stages = Stages(config or BuildConfig(), Store(kept))
    return *manufacture(whole, plan or Plan(), intake_of(whole.mesh, **known), stages), stages
