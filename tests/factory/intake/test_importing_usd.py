"""A USD asset with physics joints is an input as a URDF is."""

import numpy as np
import pytest

pytest.importorskip("pxr")
from usda import CABINET, stage, write

from asset_factory.factory.articulate.annotated import articulator_for
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.intake.load import load


def test_its_parts_and_joints_come_with_it_in_metres_and_z_up(tmp_path):
    header = 'metersPerUnit = 0.01\nupAxis = "Y"'
    config = BuildConfig(articulator="annotated")
    intake = load(write(tmp_path, stage(CABINET, header)), config.intake)
    assert intake.provenance.scale == pytest.approx(0.01)
    cabinet = articulator_for(intake, config).articulate(intake.mesh)
    assert [part.name for part in cabinet.parts] == ["base", "door"]
    (hinge,) = cabinet.movable_joints
    np.testing.assert_allclose([hinge.lower, hinge.upper], [0.0, np.pi / 2.0], atol=1e-6)


def test_a_sidecar_counts_for_it_as_for_any_input(tmp_path):
    path = write(tmp_path, stage(CABINET, 'metersPerUnit = 0.01\nupAxis = "Y"'))
    stated = 'category = "fridge"\nheight = 1.24\nlicense = "MIT"\ndensity = 300.0\n'
    path.with_suffix(".toml").write_text(stated)
    config = BuildConfig(articulator="annotated")
    intake = load(path, config.intake)
    told = intake.provenance
    assert (told.category, told.license, told.density) == ("fridge", "MIT", 300.0)
    assert (told.scale_source, told.scale) == ("sidecar", pytest.approx(2.0))
    assert intake.mesh.extents[2] == pytest.approx(1.24)
    (hinge,) = articulator_for(intake, config).articulate(intake.mesh).movable_joints
    np.testing.assert_allclose(np.abs(hinge.axis), [0.0, 1.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(hinge.origin[[0, 2]], [-1.0, -0.62], atol=1e-6)
