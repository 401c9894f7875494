"""Whatever the mesh, there is an articulation or a reason, in bounded time and memory."""

import resource
import time
from unittest.mock import Mock

import numpy as np
import pytest
import trimesh
from random_network import random_network
from refusing import refusal

from asset_factory.factory.articulate.particulate import ParticulateArticulator
from asset_factory.factory.config import ParticulateConfig
from asset_factory.factory.mesh import Mesh

CONFIG = ParticulateConfig(points=2000, context_points=400, max_faces=5000)


def asked(vertices, faces, config=CONFIG):
    mesh = Mesh.from_triangles(vertices, faces)
    return ParticulateArticulator(random_network, (), config).articulate(mesh)


def of(mesh):
    return np.array(mesh.vertices), np.array(mesh.faces)


def boxes(count):
    places = [[1.5 * (number % 25), 1.5 * (number // 25), 0] for number in range(count)]
    each = [trimesh.creation.box().apply_translation(place) for place in places]
    return of(trimesh.util.concatenate(each))


def triangles_apart(count):
    rng = np.random.default_rng(0)
    corners = rng.uniform(0, 1, (count, 1, 3)) + rng.uniform(0, 0.01, (count, 3, 3))
    return corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


def flat_sheet():
    vertices, faces = of(trimesh.creation.box().subdivide().subdivide())
    return vertices * [1, 1, 0] + [0, 0, 3.0], faces


def with_slivers():
    vertices, faces = of(trimesh.creation.box().subdivide())
    return vertices, np.vstack([faces, faces[:, [0, 1, 0]], faces[:, [0, 0, 1]]])


def on_one_edge(count):
    """A fan of sheets that all share one edge."""
    angle = np.linspace(0, np.pi, count)
    tips = np.stack([np.cos(angle), np.sin(angle), np.full(count, 0.5)], axis=1)
    vertices = np.vstack([[[0, 0, 0], [0, 0, 1]], tips])
    return vertices, np.array([[0, 1, number + 2] for number in range(count)])


MESHES = {
    "one triangle": lambda: (np.eye(3), [[0, 1, 2]]),
    "500 components": lambda: boxes(500),
    "20,000 triangles apart": lambda: triangles_apart(20_000),
    "everything in one plane": flat_sheet,
    "faces without area": with_slivers,
    "no sharp edge": lambda: of(trimesh.creation.icosphere(3)),
    "2,000 faces on one edge": lambda: on_one_edge(2000),
    "a mesh denser than is shown": lambda: of(trimesh.creation.icosphere(6)),
    "both sides of a sheet": lambda: (np.tri(3, k=-1), [[0, 1, 2], [2, 1, 0]]),
    "very small": lambda: (np.eye(3) * 1e-9, [[0, 1, 2]]),
    "very far": lambda: (np.eye(3) + 1e6, [[0, 1, 2]]),
}


@pytest.mark.parametrize("name", MESHES)
def test_every_mesh_gets_an_articulation(name):
    vertices, faces = MESHES[name]()
    started = time.perf_counter()
    found = asked(vertices, faces)
    assert time.perf_counter() - started < 30.0
    assert sum(len(part.faces) for part in found.parts) == len(faces)
    assert len(found.joints) == len(found.parts) - 1
    assert np.array_equal(found.mesh.vertices, np.asarray(vertices, dtype=float))


@pytest.mark.parametrize(
    ("vertices", "faces", "code"),
    [
        (np.random.default_rng(0).normal(size=(50, 3)), np.zeros((0, 3), dtype=int), "empty"),
        (np.zeros((0, 3)), np.zeros((0, 3), dtype=int), "empty"),
        (np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]), [[0, 1, 2]], "zero_size"),
        (np.zeros((3, 3)), [[0, 1, 2]], "zero_size"),
    ],
)
def test_what_has_no_surface_is_rejected_with_a_reason(vertices, faces, code):
    assert refusal(asked, vertices, faces).code == code


def test_points_and_memory_are_bounded_however_many_faces_there_are():
    network = Mock(wraps=random_network)
    articulator = ParticulateArticulator(network, (), CONFIG)
    for vertices, faces in (triangles_apart(30_000), of(trimesh.creation.icosphere(6))):
        articulator.articulate(Mesh.from_triangles(vertices, faces))
    most = CONFIG.points // 2 + CONFIG.max_faces
    for asked in network.call_args_list:
        cloud, context = asked.args[:2]
        assert len(cloud.points) <= most
        assert len(context.points) == CONFIG.context_points


def test_a_dense_mesh_says_that_it_was_shown_lighter():
    found = asked(*of(trimesh.creation.icosphere(6)))
    assert any("the network saw 5000 faces in place of 81920" in note for note in found.notes)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < 4 * 1024**2, "kilobytes"
