"""A composed stage: rigid bodies with what is seen and touched of them, and joints between them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...description import DescriptionError, FloatArray, LinkInertia
from ..urdf import MAX_TRIANGLES
from .bodies import WORLD, PhysicsBody, rotation_of
from .joints import PhysicsJoint, read_joint
from .prims import is_joint_in_use, is_on, is_rigid_body, is_shown, list_prims
from .shapes import read_surface


@dataclass(frozen=True)
class PhysicsStage:
    """A stage in metres, kilograms and radians, turned so that z is up.

    Attributes:
        bodies: by path, :data:`WORLD` first.
        joints: between them.
    """

    bodies: dict[str, PhysicsBody]
    joints: tuple[PhysicsJoint, ...]


def read_stage(path: Path) -> PhysicsStage:
    """Compose a stage and read its physics; call it within :func:`.refusing.refusing`.

    Raises:
        DescriptionError: ``invalid_number``, ``not_finite``, ``too_large``.
    """
    from pxr import Usd, UsdGeom, UsdPhysics

    stage = Usd.Stage.Open(str(path.resolve()))
    metres = float(UsdGeom.GetStageMetersPerUnit(stage))
    kilograms = float(UsdPhysics.GetStageKilogramsPerUnit(stage))
    if not (0.0 < metres < np.inf and 0.0 < kilograms < np.inf):
        raise DescriptionError(
            "invalid_number", f"{path.name}: its units are {metres} m, {kilograms} kg"
        )
    world = np.diag([metres, metres, metres, 1.0])
    if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y:
        world = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]]) @ world
    cache = UsdGeom.XformCache()

    def pose_of(prim: Any) -> FloatArray:
        return np.asarray(world @ np.array(cache.GetLocalToWorldTransform(prim)).T)

    prims = list_prims(stage, path.name)
    bodies = {WORLD: PhysicsBody(WORLD, np.eye(4), np.full(3, metres))}
    for prim in prims:
        if is_rigid_body(prim):
            pose, scale = _rigid(pose_of(prim))
            name = str(prim.GetPath())
            bodies[name] = PhysicsBody(name, pose, scale, _inertia(prim, scale, kilograms))
    triangles = 0
    for prim in prims:
        if prim.IsA(UsdGeom.Gprim):
            triangles += _add_surface(prim, bodies[_body_of(prim, bodies)], pose_of(prim))
            if triangles > MAX_TRIANGLES:
                words = f"{path.name}: over {MAX_TRIANGLES:,} triangles, at most so many are read"
                raise DescriptionError("too_large", words)
    joints = tuple(read_joint(prim, bodies) for prim in prims if is_joint_in_use(prim))
    return PhysicsStage(bodies, joints)


def _body_of(prim: Any, bodies: dict[str, PhysicsBody]) -> str:
    """Return the nearest body above a prim, itself included."""
    path = prim.GetPath()
    while str(path) not in bodies:
        path = path.GetParentPath()
    return str(path)


def _add_surface(prim: Any, body: PhysicsBody, pose: FloatArray) -> int:
    """Add what is seen or touched of a prim to its body; how many triangles that are."""
    from pxr import UsdPhysics

    seen = is_shown(prim)
    touched = prim.HasAPI(UsdPhysics.CollisionAPI) and is_on(
        UsdPhysics.CollisionAPI(prim).GetCollisionEnabledAttr()
    )
    surface = read_surface(prim, np.linalg.inv(body.pose) @ pose) if seen or touched else None
    if surface is None:
        return 0
    if seen:
        body.visuals.append(surface)
    if touched:
        body.collisions.append(surface)
    return len(surface.faces)


def _rigid(pose: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return a pose without its scale, and the scale, shape [3]."""
    scale = np.linalg.norm(pose[:3, :3], axis=0)
    if not (np.isfinite(pose).all() and (scale > 0.0).all()):
        raise DescriptionError("not_finite", "a body's place is not finite, or its scale is 0")
    u, _, v = np.linalg.svd(pose[:3, :3] / scale)
    turn = u @ np.diag([1.0, 1.0, float(np.sign(np.linalg.det(u @ v)))]) @ v
    rigid = np.eye(4)
    rigid[:3, :3] = turn
    rigid[:3, 3] = pose[:3, 3]
    return rigid, scale


def _inertia(prim: Any, scale: FloatArray, kilograms: float) -> LinkInertia | None:
    """Return the mass, centre and tensor as stated; ``None`` where an engine would make them up."""
    from pxr import UsdPhysics

    if not prim.HasAPI(UsdPhysics.MassAPI):
        return None
    api = UsdPhysics.MassAPI(prim)
    mass = float(api.GetMassAttr().Get() or 0.0) * kilograms
    moments = np.array(api.GetDiagonalInertiaAttr().Get() or (0.0, 0.0, 0.0), dtype=np.float64)
    center = np.array(api.GetCenterOfMassAttr().Get() or (0.0, 0.0, 0.0), dtype=np.float64)
    if mass == 0.0 or not moments.any() or not np.isfinite(center).all():
        return None
    axes = rotation_of(api.GetPrincipalAxesAttr().Get())
    unit = float(np.cbrt(np.prod(scale)))
    tensor = axes @ np.diag(moments * kilograms * unit**2) @ axes.T
    return LinkInertia(mass, center * scale, tensor)
