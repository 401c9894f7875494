"""MuJoCo's own compiler.

MJCF has defaults, classes, includes, frames and half a dozen ways to write a rotation; the only
faithful reader is the compiler itself. It is native code on somebody else's file: call it where it
can die.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from ..description import DescriptionError
from .mjcf_model import CompiledModel, read_model
from .multiplied import MOST
from .native import COMPILER_BYTES, memory_bounded

if TYPE_CHECKING:
    from mujoco import MjModel, MjSpec


def compile_model(path: Path, *, lenient: bool = False) -> CompiledModel:
    """Compile the MJCF file at ``path``; call it in a killable child.

    Args:
        path: a file whose references were checked by :func:`.references.follow_models`.
        lenient: keep names and looks that the file drops, and accept bodies that are too light.

    Raises:
        DescriptionError: ``too_large``, or ``unreadable`` with MuJoCo's own words.
    """
    import mujoco  # the engine's own compiler is the only true reader of its format

    main = str(path.parent.resolve() / path.name)
    begin_compiling()
    try:
        with memory_bounded(COMPILER_BYTES):
            meant: tuple[str, ...] = ()
            if lenient:
                model, meant = _compile_leniently(main)
            else:
                model = mujoco.MjModel.from_xml_path(main)
    except MemoryError as error:
        raise DescriptionError("too_large", f"{path.name}: {error}") from error
    except (ValueError, RuntimeError, mujoco.FatalError) as error:
        words = " ".join(str(error).replace(str(path.parent.resolve()), "").split())
        message = f"{path.name}: MuJoCo cannot compile it: {words}"
        raise DescriptionError("unreadable", message) from error
    for what, count in (("bodies", model.nbody), ("geoms", model.ngeom)):
        if count > MOST[what]:
            message = f"{path.name}: {count} {what} once compiled, at most {MOST[what]} are read"
            raise DescriptionError("too_large", message)
    return read_model(model, meant)


def begin_compiling() -> None:
    """Have MuJoCo say its warnings on standard error, and forget earlier files' meshes."""
    import mujoco

    # Its own way is a log file in whatever folder the program was started from.
    mujoco.set_mju_user_warning(lambda words: os.write(2, f"MuJoCo: {words}\n".encode()))
    # It remembers meshes by their file's name and the second they were written in.
    mujoco.mj_clearCache(mujoco.mj_getCache())


def _compile_leniently(path: str) -> tuple[MjModel, tuple[str, ...]]:
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
