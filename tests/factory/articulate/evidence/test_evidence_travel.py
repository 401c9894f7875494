"""Moving points here is what joints do elsewhere."""

import numpy as np
import pytest

from asset_factory.factory.articulate.evidence.candidates import Candidates, LineSource
from asset_factory.factory.articulate.evidence.travel import displaced
from asset_factory.factory.articulation import Joint, JointKind


def _candidates(slides, axis, origin):
    count = len(axis)
    return Candidates(
        np.full(count, slides), axis, origin, np.full(count, LineSource.EDGE), np.zeros(count)
    )


@pytest.mark.parametrize("slides", [False, True])
def test_displaced_points_are_where_the_joint_puts_them(slides):
    rng = np.random.default_rng(3)
    axis = rng.normal(size=(4, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    origin = rng.normal(size=(4, 3))
    points = rng.normal(size=(9, 3))
    values = rng.uniform(-1, 1, 4)
    moved, headings, gone = displaced(_candidates(slides, axis, origin), points, values)
    kind = JointKind.PRISMATIC if slides else JointKind.REVOLUTE
    for k in range(4):
        pose = Joint("j", kind, 0, 1, axis[k], origin[k], -1.0, 1.0).motion(values[k])
        assert np.allclose(moved[k], points @ pose[:3, :3].T + pose[:3, 3])
    assert np.allclose(np.linalg.norm(headings, axis=2), 1.0)
    later, _, _ = displaced(_candidates(slides, axis, origin), points, values + 1e-6)
    speed = later - moved
    assert np.allclose(speed / np.linalg.norm(speed, axis=2, keepdims=True), headings, atol=1e-3)
    assert (gone >= np.linalg.norm(moved - points, axis=2) - 1e-9).all()
