"""A mesh that lies as it is read is stood up if only so it opens, and never against its owner."""

from functools import cache

import numpy as np
import pytest
import trimesh
from one_piece import bar_across, bumpy
from one_piece import fridge as plain_fridge

from asset_factory.factory.articulate.predict import predict
from asset_factory.factory.articulate.standing import standing_hypotheses
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.intake.orientation import rotation_to_z_up
from asset_factory.factory.intake.source import Source
from asset_factory.factory.runtime.stages import Stages


@cache
def fridge():
    return bumpy(plain_fridge(edge=0.03))


@cache
def oven():
    return bumpy(bar_across(edge=0.03))


def write(path, mesh, up="z"):
    """The mesh with that axis up, without a word of it."""
    vertices = mesh.vertices @ rotation_to_z_up(up)
    trimesh.Trimesh(vertices, mesh.faces, process=False).export(path)


def read(path, mesh, up="z"):
    write(path, mesh, up)
    config = BuildConfig()
    origin = Source(path, config)
    return standing_hypotheses(origin.load(), origin, Stages(config))


@pytest.mark.parametrize(("suffix", "up"), [("glb", "z"), ("obj", "y")])
def test_two_doors_that_show_only_with_the_other_axis_up_stand_it_up(tmp_path, suffix, up):
    mesh = fridge()
    intake, hypotheses = read(tmp_path / f"fridge.{suffix}", mesh, up)
    assert len(hypotheses[0].movable_joints) == 2
    assert intake.provenance.up == up
    assert intake.provenance.up_source == "sides"
    assert any("opens" in note and "2 doors" in note for note in intake.provenance.notes)
    size = intake.mesh.extents / intake.mesh.extents[2]
    np.testing.assert_allclose(size, mesh.extents / mesh.extents[2], rtol=1e-5)


def test_what_is_predicted_stands_up_too_and_says_so(tmp_path):
    path = tmp_path / "fridge.glb"
    write(path, fridge())
    told = predict(path, BuildConfig())
    assert [joint["type"] for joint in told["joints"]] == ["revolute"] * 2
    assert any("up its sides show 2 doors" in note for note in told["notes"])


def test_who_said_which_axis_is_up_is_believed(tmp_path):
    (tmp_path / "fridge.toml").write_text('up = "y"\n')
    with pytest.raises(InputRejected, match="nothing moves"):
        read(tmp_path / "fridge.glb", fridge())


def test_one_panel_is_no_reason_to_turn_a_mesh_over(tmp_path):
    with pytest.raises(InputRejected, match="nothing moves"):
        read(tmp_path / "oven.glb", oven())
    _, hypotheses = read(tmp_path / "upright.glb", oven(), "y")
    assert sum(part.kind.closes_side for part in hypotheses[0].parts) == 1
