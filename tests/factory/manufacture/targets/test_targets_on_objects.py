"""Handles that makers gave their objects are found as the best places to hold, without names."""

from dataclasses import replace
from functools import partial

import numpy as np
from trimesh.triangles import closest_point

from asset_factory.factory.manufacture.targets.find import find_targets
from asset_factory.factory.mesh import Material
from asset_factory.learn.objects import make_object
from asset_factory.learn.objects.kinds import openings
from asset_factory.learn.objects.kit import casework

#: A handle under whose material every maker's grips are found again.
MARK = Material("grip", (1.0, 0.0, 1.0, 1.0))
OBJECTS = {"kitchen": 0, "nightstand": 1, "wardrobe": 0, "sideboard": 0}
OBJECTS |= {"desk": 2, "door": 1, "window": 3}
#: A plate set flush into a front gives nothing to hold.
FLUSH = ("recess", "none")


def marked(add_pull, part, pull, *args):
    add_pull(part, pull if pull.kind in FLUSH else replace(pull, look=MARK), *args)


def grips(articulation):
    """Triangles of each moving part's own grip, by joint."""
    mesh = articulation.mesh
    of_grip = np.array([m.name == MARK.name for m in mesh.materials])[mesh.face_material]
    found = {}
    for joint in articulation.movable_joints:
        faces = articulation.parts[joint.child].faces
        if of_grip[faces].any():
            found[joint.name] = mesh.vertices[mesh.faces[faces[of_grip[faces]]]]
    return found


def test_the_best_target_lies_on_the_makers_handle(monkeypatch):
    for module in (casework, openings):
        monkeypatch.setattr(module, "add_pull", partial(marked, module.add_pull))
    on_handle = []
    for category, seed in OBJECTS.items():
        articulation = make_object(category, seed)
        targets = find_targets(articulation, [()] * len(articulation.parts))
        first = {target.joint: target for target in reversed(targets)}
        assert set(first) == {joint.name for joint in articulation.movable_joints}
        for name, triangles in grips(articulation).items():
            point = first[name].point
            near = closest_point(triangles, np.tile(point, (len(triangles), 1)))
            on_handle.append(float(np.linalg.norm(near - point, axis=1).min()) < 1e-3)
    assert len(on_handle) >= 12
    assert np.mean(on_handle) >= 0.9
