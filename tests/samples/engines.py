"""Engines as parameters of tests, each skipped where it is not installed."""

import pytest

from asset_factory.sim_checks.simulators.catalog import installed


def skipped_if_missing(*names: str) -> list[object]:
    """One parameter per engine."""
    return [
        pytest.param(
            name, marks=pytest.mark.skipif(not installed(name), reason=f"{name} is not installed")
        )
        for name in names
    ]
