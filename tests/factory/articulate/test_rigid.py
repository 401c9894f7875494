"""The articulator that moves nothing."""

import numpy as np

from asset_factory.factory.articulate.rigid import RigidArticulator
from asset_factory.factory.mesh import Mesh


def test_rigid_gives_one_part_with_every_face_and_no_joint():
    mesh = Mesh.from_triangles(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    )
    articulation = RigidArticulator().articulate(mesh)
    assert [part.name for part in articulation.parts] == ["base"]
    assert np.array_equal(articulation.parts[0].faces, np.arange(4))
    assert articulation.joints == ()
    assert articulation.articulator == RigidArticulator.name == "rigid"
