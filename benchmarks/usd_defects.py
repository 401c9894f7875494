"""Defects in a USD file of the factory, those of ``simcheck``'s kinds that USD can state.

A mass or an inertia of zero, or none, is no defect in USD: the engine computes it then.
"""

from __future__ import annotations

import math
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any


def plant(file: Path, defect: str, to: Path) -> None:
    """Write a copy of a USD file whose first moving link, or its joint, has a defect."""
    from pxr import Usd, UsdPhysics

    shutil.copyfile(file, to)
    stage = Usd.Stage.Open(str(to))
    kinds = (UsdPhysics.RevoluteJoint, UsdPhysics.PrismaticJoint)
    joint = next(each for each in stage.Traverse() if any(each.IsA(kind) for kind in kinds))
    link = stage.GetPrimAtPath(joint.GetRelationship("physics:body1").GetTargets()[0])
    DEFECTS[defect](stage, joint, link)
    stage.Save()


def _scaled(prim: Any, name: str, *factors: float) -> None:
    value = prim.GetAttribute(name)
    vector = [each * factor for each, factor in zip(value.Get(), factors, strict=True)]
    value.Set(type(value.Get())(*vector))


def _size(prim: Any) -> float:
    """Return the diagonal of what is below a prim [m]."""
    return float(_bounds(prim).GetSize().GetLength())


def _bounds(prim: Any) -> Any:
    from pxr import Usd, UsdGeom

    purposes = [UsdGeom.Tokens.default_, UsdGeom.Tokens.guide, UsdGeom.Tokens.proxy]
    cache = UsdGeom.BBoxCache(Usd.TimeCode.Default(), purposes, useExtentsHint=False)
    return cache.ComputeWorldBound(prim).ComputeAlignedRange()


def _unit(metres: float) -> Callable[[Any, Any, Any], None]:
    return lambda stage, joint, link: stage.SetMetadata("metersPerUnit", metres)


def _flip(stage: Any, joint: Any, link: Any) -> None:
    """Turn both frames of the joint by half a turn about an axis across its own."""
    from pxr import Gf

    across = Gf.Vec3f(0, 1, 0) if joint.GetAttribute("physics:axis").Get() != "Y" else (1, 0, 0)
    for name in ("physics:localRot0", "physics:localRot1"):
        turn = joint.GetAttribute(name)
        turn.Set(turn.Get() * Gf.Quatf(0.0, Gf.Vec3f(across)))


def _limits(change: Callable[[float, float], tuple[float, float]]) -> Callable[..., None]:
    def write(stage: Any, joint: Any, link: Any) -> None:
        names = ("physics:lowerLimit", "physics:upperLimit")
        lower, upper = (joint.GetAttribute(name).Get() for name in names)
        for name, value in zip(names, change(lower, upper), strict=True):
            joint.GetAttribute(name).Set(value)

    return write


def _inertia(*factors: float) -> Callable[[Any, Any, Any], None]:
    return lambda stage, joint, link: _scaled(link, "physics:diagonalInertia", *factors)


def _mass(stage: Any, joint: Any, link: Any) -> None:
    mass = link.GetAttribute("physics:mass")
    mass.Set(1000.0 * mass.Get())


def _centre(stage: Any, joint: Any, link: Any) -> None:
    from pxr import Gf

    centre = link.GetAttribute("physics:centerOfMass")
    centre.Set(centre.Get() + Gf.Vec3f(3.0 * _size(link), 0, 0))


def _bare(stage: Any, joint: Any, link: Any) -> None:
    stage.RemovePrim(link.GetPath().AppendChild("collisions"))


def _offset(stage: Any, joint: Any, link: Any) -> None:
    from pxr import Gf, UsdGeom

    below = stage.GetPrimAtPath(link.GetPath().AppendChild("collisions"))
    for shape in below.GetChildren():
        moved = UsdGeom.Xformable(shape).AddTranslateOp(opSuffix="planted")
        moved.Set(Gf.Vec3d(0, 0, _size(link)))


def _missing(stage: Any, joint: Any, link: Any) -> None:
    link.GetReferences().AddReference("no_such_file.usd")


def _inward(stage: Any, joint: Any, link: Any) -> None:
    """Move the link with its joint into the middle of what carries it."""
    from pxr import Gf

    targets = joint.GetRelationship("physics:body0").GetTargets()
    parent = stage.GetPrimAtPath(targets[0]) if targets else link.GetParent()
    way = _bounds(parent).GetMidpoint() - _bounds(link).GetMidpoint()
    for prim, name in ((link, "xformOp:translate"), (joint, "physics:localPos0")):
        place = prim.GetAttribute(name)
        place.Set(place.Get() + type(place.Get())(Gf.Vec3d(way)))


def _unattached(stage: Any, joint: Any, link: Any) -> None:
    joint.GetRelationship("physics:body1").SetTargets(["/no/such/body"])


DEFECTS: Mapping[str, Callable[[Any, Any, Any], None]] = {
    "scale_mm": _unit(1000.0),
    "scale_small": _unit(0.001),
    "flip_axis": _flip,
    "swap_limits": _limits(lambda lower, upper: (upper, lower)),
    "degrees": _limits(lambda lower, upper: (math.degrees(lower), math.degrees(upper))),
    "triangle": _inertia(1.0, 1.0, 100.0),
    "negative_inertia": _inertia(-1.0, 1.0, 1.0),
    "mass_grams": _mass,
    "no_collision": _bare,
    "collision_offset": _offset,
    "com_outside": _centre,
    "missing_mesh": _missing,
    "joint_into_parent": _inward,
    "no_body": _unattached,
}
