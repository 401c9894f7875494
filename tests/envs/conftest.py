"""A registry of generated household objects, made once: what a build writes, without checks."""

from dataclasses import replace

import pytest
from export_samples import PROVENANCE
from manufactured import manufactured
from openable_samples import HOUSEHOLD, write_registry

from asset_factory.factory.export import export_bundle
from asset_factory.factory.manufacture.stage import with_targets
from asset_factory.learn.objects import make_object


@pytest.fixture(scope="session")
def household(tmp_path_factory):
    """Four objects: doors and drawers, a lid, an oven's door, a screen."""
    root = write_registry(tmp_path_factory.mktemp("household"))
    for category in HOUSEHOLD:
        made = make_object(category, seed=0)
        asset, _, stages = manufactured(made, root / ".cache", category=category)
        known = replace(PROVENANCE, category=category)
        export_bundle(with_targets(asset, stages), known, root / "assets" / category)
    return root
