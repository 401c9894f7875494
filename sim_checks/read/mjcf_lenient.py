"""MuJoCo's compiler as an import wants it: nothing thrown away, and what authors meant."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mujoco import MjModel, MjSpec


def compile_leniently(path: str) -> tuple[MjModel, tuple[str, ...]]:
    """Return a model, and the joints that were given the range that the file switches off."""
    import mujoco

    spec, meant = _undiscarding(path)
    try:
        return spec.compile(), meant
    except ValueError:
        # A body too thin for MuJoCo's own masses is no reason to refuse its shape.
        spec, meant = _undiscarding(path)
        spec.compiler.boundmass = 1e-3
        spec.compiler.boundinertia = 1e-6
        spec.compiler.balanceinertia = True
        for mesh in spec.meshes:
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        return spec.compile(), meant


def _undiscarding(path: str) -> tuple[MjSpec, tuple[str, ...]]:
    import mujoco

    spec = mujoco.MjSpec.from_file(path)
    spec.compiler.discardvisual = False
    spec.compiler.fusestatic = False
    scalar = (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE)
    off = int(mujoco.mjtLimited.mjLIMITED_FALSE)
    switched = (j for j in spec.joints if j.type in scalar and int(j.limited) == off)
    meant = [joint for joint in switched if joint.range[0] < joint.range[1]]
    for joint in meant:
        joint.limited = mujoco.mjtLimited.mjLIMITED_TRUE
    return spec, tuple(joint.name for joint in meant)
