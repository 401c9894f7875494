"""Datasets preprocessed by the release say the same as their originals read by us."""

import numpy as np
import pytest
from evidence_worlds import apart
from refusing import refusal

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.geometry.posing import closed
from asset_factory.learn.datasets.description import find_descriptions, find_usd, read_description
from asset_factory.learn.datasets.item import SourceItem
from asset_factory.learn.datasets.making import sampled_item
from asset_factory.learn.datasets.published import find_published, read_published
from asset_factory.learn.datasets.settings import SourceSettings

SETTINGS = SourceSettings(points=256)
DESCRIPTIONS = ("hinge_slider", "dummy_chain_both", "fixed_and_continuous", "offset_limits_nested")
STAGES = ("usd_hinge_slider", "usd_negative_limit")


def original(fixtures, name):
    folder = fixtures / "data_formats" / name / "in"
    if name in STAGES:
        pytest.importorskip("pxr")
        return read_description(find_usd(folder)[0], SETTINGS)
    return read_description(find_descriptions(folder)[0], SETTINGS)


def published(fixtures, name):
    read = read_published(find_published(fixtures / "data_formats" / name / "out")[0], SETTINGS)
    assert isinstance(read, Articulation)
    return read


def normalised(articulation):
    """Closed, as the release poses an object, with the centre and longest side it divides by."""
    shut = closed(articulation)
    return shut, shut.mesh.bounds.mean(axis=0), float(shut.mesh.extents.max())


def corners(articulation, part):
    mesh = articulation.part_mesh(part)
    return np.unique(mesh.vertices[mesh.faces].reshape(-1, 3).round(5), axis=0)


def shown(articulation):
    """The parts that have faces; carriers of joints have none."""
    return [part for part in range(len(articulation.parts)) if len(articulation.parts[part].faces)]


def matched(ours, theirs, centre, side):
    """Part by part, those with the same corners."""
    found = {}
    for part in shown(ours):
        mine = np.sort((corners(ours, part) - centre) / side, axis=0)
        for other in shown(theirs):
            yours = np.sort(corners(theirs, other), axis=0)
            if mine.shape == yours.shape and np.abs(mine - yours).max() < 1e-4:
                found[part] = other
    return found


@pytest.mark.parametrize("name", [*DESCRIPTIONS, *STAGES])
def test_parts_axes_and_ranges_agree(fixtures, name):
    ours, centre, side = normalised(original(fixtures, name))
    theirs = published(fixtures, name)
    pairs = matched(ours, theirs, centre, side)
    assert sorted(pairs) == shown(ours)
    assert sorted(pairs.values()) == shown(theirs)
    for mine in ours.joints:
        child = mine.child
        if child not in pairs:
            child = next(j.child for j in ours.joints if j.parent == child)
        chain = [theirs.parent_joint(pairs[child])]
        if chain[0].parent not in pairs.values():
            chain.append(theirs.parent_joint(chain[0].parent))
        yours = next(joint for joint in chain if joint is not None and joint.kind == mine.kind)
        np.testing.assert_allclose(mine.axis, yours.axis, atol=1e-4)
        scale = 1.0 if mine.turns else side
        limits = [mine.lower / scale, mine.upper / scale]
        np.testing.assert_allclose(limits, [yours.lower, yours.upper], atol=1e-4)
        if mine.turns:
            assert apart((mine.origin - centre) / side, yours.axis, yours.origin) < 1e-4


@pytest.mark.parametrize("name", [*DESCRIPTIONS, *STAGES])
def test_point_cache_is_sampled_from_the_same_tree(fixtures, name):
    file = fixtures / "data_formats" / name / "train_cache.npz"
    cached = sampled_item("particulate", SourceItem(name, file, (file,)), SETTINGS, seed=0)
    folder = find_published(fixtures / "data_formats" / name / "out")[0]
    drawn = sampled_item("particulate", folder, SETTINGS, seed=0)
    assert sorted(cached.motion.tolist()) == sorted(drawn.motion.tolist())
    turning = [sorted(np.ptp(s.turn, axis=1).round(4).tolist()) for s in (cached, drawn)]
    sliding = [sorted(np.ptp(s.slide, axis=1).round(4).tolist()) for s in (cached, drawn)]
    assert turning[0] == turning[1]
    assert sliding[0] == sliding[1]
    assert cached.parents[0] == -1
    assert (cached.parents[1:] < np.arange(1, len(cached.parents))).all()
    assert cached.motion[0] == 0


@pytest.mark.parametrize(
    ("field", "broken"),
    [
        ("point_to_bone", lambda bones: bones[:-1]),
        ("point_to_bone", lambda bones: np.append(bones, 0)),
        ("point_to_bone", lambda bones: np.full_like(bones, -1)),
        ("link_range", lambda ranges: ranges.astype("U9")),
        ("points", lambda points: np.where(points > 0.0, np.nan, points)),
    ],
    ids=["too few labels", "too many labels", "a label below 0", "text", "no number"],
)
def test_a_point_cache_that_contradicts_itself_is_refused(fixtures, tmp_path, field, broken):
    with np.load(fixtures / "data_formats" / DESCRIPTIONS[0] / "train_cache.npz") as archive:
        stored = {name: archive[name] for name in archive.files}
    file = tmp_path / "broken.npz"
    np.savez(file, **stored | {field: broken(stored[field])})
    item = SourceItem("broken", file, (file,))
    assert refusal(read_published, item, SETTINGS).code == "bad_annotation"
