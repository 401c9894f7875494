"""A composed stage: rigid bodies with visible and collision geometry, and joints."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from ...description import DescriptionError, FloatArray, LinkInertia
from ..native import READER_BYTES, memory_bounded
from ..urdf import MAX_TRIANGLES
from .bodies import WORLD, PhysicsBody, rotation_of, split_scale
from .joints import PhysicsJoint, joint_ends, read_joint, require_ends
from .multiplied import MOST_PRIMS
from .refusing import refusing
from .shapes import PhysicsSurface, read_triangles


@dataclass(frozen=True)
class PhysicsStage:
    """A stage in metres, kilograms and radians, turned so that z is up.

    Attributes:
        bodies: by path, :data:`WORLD` first.
        surfaces: of all bodies, in the order of the stage.
        joints: between bodies.
        roots: paths of bodies that an articulation begins with.
        metres: of one of the file's units.
        up: the file's up axis, ``y`` or ``z``.
    """

    bodies: dict[str, PhysicsBody]
    surfaces: tuple[PhysicsSurface, ...]
    joints: tuple[PhysicsJoint, ...]
    roots: frozenset[str]
    metres: float
    up: str


def require_library(name: str) -> None:
    """Refuse a USD file, of that name, where the library that reads it is not installed.

    Raises:
        DescriptionError: ``unknown_format``.
    """
    if importlib.util.find_spec("pxr") is None:
        message = f"{name}: reading USD needs usd-core: pip install usd-core"
        raise DescriptionError("unknown_format", message)


def read_stage(path: Path, *, lenient: bool = False) -> PhysicsStage:
    """Compose a stage and read its physics; call it in a killable child.

    Args:
        path: of the root layer; :func:`.layers.require_inside` has seen what it is composed of.
        lenient: read of surfaces only those that are shown; where no prim at all is a rigid body,
            take what the joints hold for bodies.

    Raises:
        DescriptionError: ``invalid_number``, ``missing_element``, ``not_finite``,
            ``unreadable_mesh``, ``too_large``, or ``unreadable`` whatever the library makes of it.
    """
    with refusing(path.name, path.resolve().parent), memory_bounded(READER_BYTES):
        return _Reader(path, lenient=lenient).read()


class _Reader:
    def __init__(self, path: Path, *, lenient: bool) -> None:
        from pxr import Usd, UsdGeom, UsdPhysics

        self._name = path.name
        self._lenient = lenient
        self._stage = Usd.Stage.Open(str(path.resolve()))
        self._cache = UsdGeom.XformCache()
        self._metres = float(UsdGeom.GetStageMetersPerUnit(self._stage))
        self._kilograms = float(UsdPhysics.GetStageKilogramsPerUnit(self._stage))
        if not (0.0 < self._metres < np.inf and 0.0 < self._kilograms < np.inf):
            message = f"{self._name}: its units are {self._metres} m, {self._kilograms} kg"
            raise DescriptionError("invalid_number", message)
        self._up = str(UsdGeom.GetStageUpAxis(self._stage)).lower()
        self._world = np.diag([self._metres, self._metres, self._metres, 1.0])
        if self._up == "y":
            turn = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
            self._world = turn @ self._world
        self._prims = _list_prims(self._stage, self._name)

    def read(self) -> PhysicsStage:
        from pxr import UsdPhysics

        joints = [prim for prim in self._prims if _is_joint_in_use(prim)]
        if not self._lenient:
            for prim in joints:
                require_ends(prim)
        bodies = {WORLD: PhysicsBody(WORLD, np.eye(4), np.full(3, self._metres))}
        for prim in self._body_prims(joints):
            path = str(prim.GetPath())
            pose, scale = split_scale(self._pose_of(prim))
            bodies[path] = PhysicsBody(path, pose, scale, _inertia(prim, scale, self._kilograms))
        roots = (prim for prim in self._prims if prim.HasAPI(UsdPhysics.ArticulationRootAPI))
        return PhysicsStage(
            bodies,
            tuple(self._surfaces(bodies)),
            tuple(read_joint(prim, bodies, self._pose_of) for prim in joints),
            frozenset(_body_of(prim, bodies) for prim in roots if prim not in joints) - {WORLD},
            self._metres,
            self._up,
        )

    def _pose_of(self, prim: Any | None) -> FloatArray:
        """Return a prim's pose in the world, metres and scale included; of ``None`` the stage's."""
        own = np.eye(4) if prim is None else np.array(self._cache.GetLocalToWorldTransform(prim)).T
        return np.asarray(self._world @ own)

    def _body_prims(self, joints: list[Any]) -> list[Any]:
        rigid = [prim for prim in self._prims if _is_rigid_body(prim)]
        if rigid or not self._lenient:
            return rigid
        relations = (relation for prim in joints for relation in joint_ends(prim))
        held = {str(target) for rel in relations for target in rel.GetForwardedTargets()}
        return [prim for prim in self._prims if str(prim.GetPath()) in held - {WORLD}]

    def _surfaces(self, bodies: dict[str, PhysicsBody]) -> Iterator[PhysicsSurface]:
        """Yield visible or collision geometry."""
        from pxr import UsdGeom, UsdPhysics

        triangles = 0
        for prim in self._prims:
            if not prim.IsA(UsdGeom.Gprim):
                continue
            seen = _is_shown(prim)
            touched = prim.HasAPI(UsdPhysics.CollisionAPI) and _is_on(
                UsdPhysics.CollisionAPI(prim).GetCollisionEnabledAttr()
            )
            if not (seen or (touched and not self._lenient)):
                continue
            body = _body_of(prim, bodies)
            found = read_triangles(prim, np.linalg.inv(bodies[body].pose) @ self._pose_of(prim))
            if found is None:
                continue
            triangles += len(found[1])
            if triangles > MAX_TRIANGLES:
                words = f"{self._name}: over {MAX_TRIANGLES:,} triangles, at most so many are read"
                raise DescriptionError("too_large", words)
            yield PhysicsSurface(str(prim.GetPath()), body, seen, touched, *found)


def _body_of(prim: Any, bodies: dict[str, PhysicsBody]) -> str:
    """Return the nearest body above a prim, itself included."""
    path = prim.GetPath()
    while str(path) not in bodies:
        path = path.GetParentPath()
    return str(path)


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


def _list_prims(stage: Any, name: str) -> list[Any]:
    """Return all prims of a composed stage, those of instances among them.

    Raises:
        DescriptionError: ``too_large``, with the file's name.
    """
    from pxr import Usd

    every = Usd.PrimRange(stage.GetPseudoRoot(), Usd.TraverseInstanceProxies())
    prims = list(islice(every, MOST_PRIMS + 1))
    if len(prims) > MOST_PRIMS:
        raise DescriptionError("too_large", f"{name}: over {MOST_PRIMS:,} prims once composed")
    return prims


def _is_on(attribute: Any) -> bool:
    """Return whether a switch is on, as it is where nobody says anything."""
    return attribute.Get() is not False


def _is_rigid_body(prim: Any) -> bool:
    """Return whether it is a body of its own that physics moves."""
    from pxr import UsdPhysics

    enabled = UsdPhysics.RigidBodyAPI(prim).GetRigidBodyEnabledAttr()
    return bool(prim.HasAPI(UsdPhysics.RigidBodyAPI)) and _is_on(enabled)


def _is_joint_in_use(prim: Any) -> bool:
    """Tell whether it is a joint that is enabled and in the tree; one that closes a loop is not."""
    from pxr import UsdPhysics

    if not prim.IsA(UsdPhysics.Joint):
        return False
    joint = UsdPhysics.Joint(prim)
    left_out = joint.GetExcludeFromArticulationAttr().Get() is True
    return _is_on(joint.GetJointEnabledAttr()) and not left_out


def _is_shown(prim: Any) -> bool:
    """Return whether a surface is visible, and made to be looked at."""
    from pxr import UsdGeom

    image = UsdGeom.Imageable(prim)
    looked_at = image.ComputePurpose() in (UsdGeom.Tokens.default_, UsdGeom.Tokens.render)
    return looked_at and image.ComputeVisibility() != UsdGeom.Tokens.invisible
