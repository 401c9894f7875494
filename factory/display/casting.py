"""What each ray meets: one acceleration structure per link, which poses only move rays into."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ..mesh import FloatArray
from .camera import Camera, box_corners
from .scene import SceneGraph, SceneSurface

FloatRows = npt.NDArray[np.float32]
#: No triangles are cast beyond so many: a picture is too small to show them.
MOST_FACES = 3_000_000


@dataclass
class Hits:
    """What rays met; rays that met nothing have depth infinity.

    Attributes:
        depth: along the rays' directions, shape [rays].
        link: index, -1 for nothing, shape [rays].
        face: row of the link's faces, shape [rays].
        normal: geometric, unit, root frame, towards the eye, shape [rays, 3].
        u, v: barycentric weights of the second and third corner, shape [rays].
    """

    depth: FloatRows
    link: npt.NDArray[np.int32]
    face: npt.NDArray[np.int32]
    normal: FloatRows
    u: FloatRows
    v: FloatRows

    @classmethod
    def none(cls, count: int) -> Hits:
        """Return hits of rays that met nothing yet."""
        zeros = np.zeros(count, dtype=np.float32)
        return cls(
            np.full(count, np.inf, dtype=np.float32),
            np.full(count, -1, dtype=np.int32),
            np.zeros(count, dtype=np.int32),
            np.zeros((count, 3), dtype=np.float32),
            zeros,
            zeros.copy(),
        )


def lengths(rows: FloatRows) -> FloatRows:
    """Return lengths of vectors, at least a hair, shape [rows]."""
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", rows, rows) + 1e-20), dtype=np.float32)


class LinkCaster:
    """The surfaces of one link, ready to be met."""

    def __init__(self, index: int, surfaces: Sequence[SceneSurface]) -> None:
        self.index = index
        self.surfaces = tuple(surfaces)
        counts = [len(surface.faces) for surface in surfaces]
        self.starts = np.cumsum([0, *counts])
        #: Of each face, which surface it is of.
        self.owner = np.repeat(np.arange(len(counts)), counts)
        #: Of the box around it, link frame [m], shape [8, 3].
        self.corners = box_corners(surfaces)

    @cached_property
    def _scene(self) -> Any:
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        scene = EmbreeScene()
        triangles = [surface.vertices[surface.faces] for surface in self.surfaces]
        TriangleMesh(scene, np.ascontiguousarray(np.concatenate(triangles), dtype=np.float32))
        return scene

    def meet(
        self, eye: FloatArray, directions: FloatArray, pose: FloatArray, rays: Any, into: Hits
    ) -> None:
        """Cast some of the rays, and keep hits that are nearer than earlier ones.

        Args:
            eye: where they start, root frame, shape [3], or one each, shape [count, 3].
            directions: of those rays, root frame, shape [count, 3].
            pose: of the link.
            rays: which of ``into`` they are.
            into: changed in place.
        """
        turn = pose[:3, :3].astype(np.float32)
        origins = np.empty(directions.shape, dtype=np.float32)
        origins[:] = (eye - pose[:3, 3]) @ pose[:3, :3]
        met = self._scene.run(origins, directions.astype(np.float32) @ turn, output=1)
        nearer = (met["primID"] >= 0) & (met["tfar"] < into.depth[rays])
        chosen = rays[nearer]
        normal = met["Ng"][nearer]
        normal /= lengths(normal)[:, None]
        into.depth[chosen] = met["tfar"][nearer]
        into.link[chosen] = self.index
        into.face[chosen] = met["primID"][nearer]
        into.normal[chosen] = normal @ turn.T
        into.u[chosen] = met["u"][nearer]
        into.v[chosen] = met["v"][nearer]


class Caster:
    """A scene's surfaces of one kind, ready to be met in any pose."""

    def __init__(self, scene: SceneGraph, surfaces: Sequence[SceneSurface]) -> None:
        self.scene = scene
        self.links: dict[int, LinkCaster] = {}
        left = MOST_FACES
        for index in range(len(scene.links)):
            own = [surface for surface in surfaces if surface.link == index and len(surface.faces)]
            own = [surface for surface in own if len(surface.faces) <= left]
            left -= sum(len(surface.faces) for surface in own)
            if own:
                self.links[index] = LinkCaster(index, own)


@dataclass(frozen=True)
class Shot:
    """A pose of a scene, as a camera sees it.

    Attributes:
        caster: the surfaces that are seen.
        camera: that sees them.
        values: of joints [rad] or [m].
    """

    caster: Caster
    camera: Camera
    values: Mapping[str, float]

    @cached_property
    def poses(self) -> FloatArray:
        """Return the frames of links in the root's frame, shape [links, 4, 4]."""
        return self.caster.scene.poses(self.values)

    def see(self, known: Hits | None = None, moving: frozenset[int] | None = None) -> Hits:
        """Return what the middle of every pixel meets; arguments as :meth:`cast` has them."""
        camera = self.camera
        middles = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
        return self.cast(np.stack(middles, axis=-1).reshape(-1, 2), known, moving)

    def cast(
        self, places: FloatArray, known: Hits | None = None, moving: frozenset[int] | None = None
    ) -> Hits:
        """Return what places in the picture meet, shape [count, 2].

        ``known`` is what other links look like in this pose already, and only ``moving`` ones are
        cast then.
        """
        camera = self.camera
        hits = Hits.none(len(places)) if known is None else deepcopy(known)
        directions = camera.rays(places)
        across, down = np.ascontiguousarray(places.T)
        for index, caster in self.caster.links.items():
            if moving is not None and index not in moving:
                continue
            pose = self.poses[index]
            box = camera.places(caster.corners @ pose[:3, :3].T + pose[:3, 3])[:, :2]
            # A pixel more on every side.
            left, top = box.min(axis=0) - 1.0
            right, bottom = box.max(axis=0) + 1.0
            wide = (across > left) & (across < right)
            rays = np.flatnonzero(wide & (down > top) & (down < bottom))
            caster.meet(camera.eye, directions[rays], pose, rays, hits)
        return hits
