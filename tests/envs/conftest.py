"""A registry of generated household objects, made once: what a build writes, without checks."""

import numpy as np
import pytest
from openable_samples import HOUSEHOLD, write_registry

from asset_factory.factory.config import BuildConfig
from asset_factory.factory.export import export_bundle
from asset_factory.factory.intake.intake import Intake, Provenance
from asset_factory.factory.manufacture.plan import Plan
from asset_factory.factory.manufacture.stage import manufacture, with_targets
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.runtime.store import Store
from asset_factory.learn.objects import make_object


@pytest.fixture(scope="session")
def household(tmp_path_factory):
    """Four objects: doors and drawers, a lid, an oven's door, a screen."""
    root = write_registry(tmp_path_factory.mktemp("household"))
    store = Store(root / ".cache")
    for category in HOUSEHOLD:
        articulation = make_object(category, seed=0)
        provenance = Provenance(f"{category}.glb", "0" * 64, category=category)
        mesh = articulation.mesh
        intake = Intake(category, mesh, np.arange(len(mesh.faces)), np.eye(4), provenance)
        stages = Stages(BuildConfig(), store)
        asset, _ = manufacture(articulation, Plan(), intake, stages)
        export_bundle(with_targets(asset, stages), provenance, root / "assets" / category)
    return root
