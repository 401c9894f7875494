"""What a prim of a USD stage is to physics, and whether it is shown."""

from __future__ import annotations

from itertools import islice
from typing import Any

import numpy as np

from ...description import DescriptionError
from .multiplied import MOST_PRIMS

#: Directions that joints' axes are named by.
AXES = dict(zip("XYZ", np.eye(3), strict=True))


def list_prims(stage: Any, name: str) -> list[Any]:
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


def is_on(attribute: Any) -> bool:
    """Return whether a switch is on, as it is where nobody says anything."""
    return attribute.Get() is not False


def is_rigid_body(prim: Any) -> bool:
    """Return whether it is a body of its own that physics moves."""
    from pxr import UsdPhysics

    enabled = UsdPhysics.RigidBodyAPI(prim).GetRigidBodyEnabledAttr()
    return bool(prim.HasAPI(UsdPhysics.RigidBodyAPI)) and is_on(enabled)


def is_joint_in_use(prim: Any) -> bool:
    """Tell whether it is a joint that is enabled and in the tree; one that closes a loop is not."""
    from pxr import UsdPhysics

    if not prim.IsA(UsdPhysics.Joint):
        return False
    joint = UsdPhysics.Joint(prim)
    left_out = joint.GetExcludeFromArticulationAttr().Get() is True
    return is_on(joint.GetJointEnabledAttr()) and not left_out


def joint_kind(prim: Any) -> str:
    """Return ``revolute``, ``prismatic``, ``fixed``, or the file's word for any other joint."""
    from pxr import UsdPhysics

    for kind in ("revolute", "prismatic", "fixed"):
        if prim.IsA(getattr(UsdPhysics, f"{kind.capitalize()}Joint")):
            return kind
    return str(prim.GetTypeName())


def is_shown(prim: Any) -> bool:
    """Return whether a surface is visible, and made to be looked at."""
    from pxr import UsdGeom

    image = UsdGeom.Imageable(prim)
    looked_at = image.ComputePurpose() in (UsdGeom.Tokens.default_, UsdGeom.Tokens.render)
    return looked_at and image.ComputeVisibility() != UsdGeom.Tokens.invisible
