"""What is made of an object's parts, its stages kept in a folder."""

import numpy as np

from asset_factory.factory.config import BuildConfig
from asset_factory.factory.intake.intake import Intake, Provenance
from asset_factory.factory.manufacture.plan import Plan
from asset_factory.factory.manufacture.stage import manufacture
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.runtime.store import Store


def manufactured(whole, kept, plan=None, config=None, **known):
    """The asset, what is found of it, and the stages that made it of what is known."""
    provenance = Provenance("thing.glb", "0" * 64, **known)
    intake = Intake("thing", whole.mesh, np.arange(len(whole.mesh.faces)), np.eye(4), provenance)
    stages = Stages(config or BuildConfig(), Store(kept))
    return *manufacture(whole, plan or Plan(), intake, stages), stages
