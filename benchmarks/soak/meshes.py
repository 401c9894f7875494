"""Small cabinets for endurance tests: all different, joints stated, each quick to build."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh

from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part
from asset_factory.factory.display.gltf import Y_UP
from asset_factory.factory.geometry.posing import rotated
from asset_factory.factory.mesh import Material, Mesh
from asset_factory.learn.objects.export import write_annotation, write_glb, write_sidecar

UNIT_BOX = trimesh.creation.box(bounds=((0, 0, 0), (1, 1, 1)))
BOARD_M = 0.018
GAP_M = 0.004


def small_cabinet(seed: int) -> Articulation:
    """A box of boards, open to -Y; its front slides out or turns about its left edge."""
    random = np.random.default_rng(seed)
    width, depth, height = random.uniform((0.3, 0.3, 0.25), (0.8, 0.6, 0.9))
    inner = width - 2 * BOARD_M, height - 2 * BOARD_M
    low = BOARD_M + GAP_M
    carcass = [
        ((0.0, 0.0, 0.0), (BOARD_M, depth, height)),
        ((width - BOARD_M, 0.0, 0.0), (BOARD_M, depth, height)),
        ((BOARD_M, 0.0, 0.0), (inner[0], depth, BOARD_M)),
        ((BOARD_M, 0.0, height - BOARD_M), (inner[0], depth, BOARD_M)),
        ((BOARD_M, depth - BOARD_M, BOARD_M), (inner[0], BOARD_M, inner[1])),
    ]
    front = inner[0] - 2 * GAP_M, inner[1] - 2 * GAP_M
    moving = [((low, 0.0, low), (front[0], BOARD_M, front[1]))]
    slides = bool(random.integers(2))
    if slides:
        moving.append(((low, BOARD_M, low), (front[0], 0.7 * depth, 0.3 * front[1])))
        joint = Joint(
            "slide",
            JointKind.PRISMATIC,
            0,
            1,
            np.array([0.0, -1.0, 0.0]),
            np.zeros(3),
            0.0,
            0.6 * depth,
        )
    else:
        hinge = np.array([low, 0.0, 0.0])
        joint = Joint(
            "hinge", JointKind.REVOLUTE, 0, 1, np.array([0.0, 0.0, -1.0]), hinge, 0.0, 1.5
        )
    boxes = carcass + moving
    corners = np.concatenate(
        [np.array(start) + UNIT_BOX.vertices * np.array(size) for start, size in boxes]
    )
    faces = np.concatenate(
        [UNIT_BOX.faces + len(UNIT_BOX.vertices) * index for index in range(len(boxes))]
    )
    split = len(carcass) * len(UNIT_BOX.faces)
    parts = (Part("carcass", np.arange(split)), Part("front", np.arange(split, len(faces))))
    mesh = Mesh(
        corners, faces, None, None, np.zeros(len(faces), dtype=np.int64), (Material("board"),)
    )
    return Articulation(mesh, parts, (joint,), "generated")


def write_meshes(folder: Path, count: int, first: int = 0) -> None:
    """Write ``count`` cabinets into ``folder`` as GLB files with their annotations."""
    folder.mkdir(parents=True, exist_ok=True)
    for seed in range(first, first + count):
        made = small_cabinet(seed)
        name = f"cabinet_{seed:05d}"
        write_glb(made.mesh, folder / f"{name}.glb")
        write_annotation(rotated(made, Y_UP[:3, :3]), folder / f"{name}.pred.npz")
        values = {
            "scale": 1.0,
            "annotation": f"{name}.pred.npz",
            "license": "CC0-1.0",
            "category": "cabinet",
        }
        write_sidecar(folder / f"{name}.toml", values)
