"""The scene of anybody's URDF or MJCF file, or of a mesh."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

import numpy as np

from asset_factory.sim_checks.description import DescribedShape, Description, DescriptionError
from asset_factory.sim_checks.geometry.kinematics import (
    MOVING_KINDS,
    NotATree,
    Tree,
    build_tree,
    sweep_range,
    unit_axis,
)
from asset_factory.sim_checks.read.read import read_description

from ..config import IntakeConfig
from ..errors import InputRejected
from ..intake.loading import Visual, load_mesh, load_visual
from ..mesh import Texture
from .made import plain_surface, scene_of_mesh, surfaces_of
from .scene import UNLIMITED, Color, SceneGraph, SceneJoint, SceneSurface

DESCRIPTIONS = (".urdf", ".xml", ".mjcf")
#: Of parts whose file names no colour: the base, then what moves.
PLAIN = ((0.62, 0.61, 0.58, 1.0), (0.30, 0.42, 0.55, 1.0), (0.55, 0.36, 0.28, 1.0))


def scene_of_file(path: Path) -> SceneGraph:
    """Return what a file shows.

    It is a URDF, an MJCF, or a mesh in any format that is read; what it refers to lies in its
    folder or below.

    Raises:
        InputRejected: it cannot be shown, with a reason code.
    """
    if path.suffix.lower() in DESCRIPTIONS:
        try:
            description = read_description(path)
            return scene_of_description(description, build_tree(description))
        except DescriptionError as error:
            raise InputRejected(error.code, error.message) from error
        except NotATree as error:
            raise InputRejected("not_a_tree", f"{path.name}: {error}") from error
    intake = load_mesh(path, IntakeConfig())
    return scene_of_mesh(intake.name, intake.mesh)


def scene_of_description(description: Description, tree: Tree) -> SceneGraph:
    """Return a description's scene: its links' visuals and hulls, its joints with ranges."""
    names = (tree.root, *(joint.child for joint in tree.order))
    place = {name: index for index, name in enumerate(names)}
    joints = []
    for joint in tree.order:
        moves = joint.kind in MOVING_KINDS
        limits = sweep_range(joint) if joint.kind != "continuous" else None
        low, high = limits or (0.0, UNLIMITED.get(joint.kind, 0.0))
        mimic = tree.mimics.get(joint.name)
        kind = joint.kind if moves else "fixed"
        ends = (place[joint.parent], place[joint.child])
        frame = (joint.origin, unit_axis(joint))
        span = (low, high) if moves else (0.0, 0.0)
        follows = (mimic.leader, mimic.multiplier, mimic.offset) if mimic else ()
        joints.append(SceneJoint(joint.name, kind, *ends, *frame, *span, *follows))
    visual_of = cache(partial(_visual, description.path.parent))
    images: dict[Texture, bytes | None] = {}
    visuals = []
    hulls = []
    for link in description.links:
        index = place[link.name]
        plain = PLAIN[0] if index == 0 else PLAIN[1 + index % 2]
        for shape in link.visuals:
            visuals += _colored(shape, index, visual_of(shape.file), plain, images)
        hulls += [plain_surface(index, s.vertices, s.faces, plain) for s in link.collisions]
    return SceneGraph(description.path.stem, names, tuple(joints), tuple(visuals), tuple(hulls))


def _visual(root: Path, file: str | None) -> Visual | None:
    """Return a mesh file below a folder with its colours; ``None``: there is none to be read."""
    if file is not None:
        with suppress(InputRejected, OSError):
            return load_visual(root / file, root, IntakeConfig())
    return None


def _colored(
    shape: DescribedShape,
    link: int,
    visual: Visual | None,
    plain: Color,
    images: dict[Texture, bytes | None],
) -> list[SceneSurface]:
    """Return a shape's triangles, by the materials that its file gives them."""
    if visual is None or visual.source_face_count != len(shape.faces):
        return [plain_surface(link, shape.vertices, shape.faces, plain)]
    # The validator has the shape where the description puts it, the reader has its colours.
    faces = shape.faces[visual.source_faces]
    posed = replace(visual.mesh, vertices=shape.vertices, faces=faces, corner_normals=None)
    return surfaces_of(posed, link, np.zeros(3), images)
