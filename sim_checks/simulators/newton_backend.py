"""Newton, its importers and its MuJoCo solver: the only module that imports it."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..config import MotionConfig
from ..read.mjcf_model import CompiledModel, read_model
from ..read.read import format_of
from .chatter import captured_lines
from .mujoco_backend import MujocoWorld
from .simulator import Simulator
from .twin import twin_of
from .world import PairRules

#: Newton speaks of a body as ``model/link``; its solver calls the same ``model_link``.
SEPARATOR = "/"


class NewtonSimulator(Simulator):
    """Newton's model of the file, stepped by its MuJoCo solver on the processor.

    Newton converts its model for MuJoCo once, and steps the same conversion by MuJoCo-Warp or by
    MuJoCo itself. The latter takes 0.1 ms a step here, the former 20 ms, for it is written for
    thousands of worlds on a GPU.
    """

    name = "newton"
    distribution = "newton"
    formats = ("urdf", "mjcf")
    soft_friction = ("urdf", "mjcf")
    blind_spots = (
        "Newton never lets a link touch the one that it is jointed to, as its importers are set",
        "joint friction is soft, whatever the file says of it: what it holds creeps",
        "contacts and limits are soft, and its conversion makes limits softer than MuJoCo's own",
        "it is stepped by MuJoCo in double precision, not by MuJoCo-Warp in single",
    )

    def open(self, path: Path, config: MotionConfig) -> NewtonWorld:
        """Load with the base fixed. Raises ValueError with the loader's own words."""
        with warnings.catch_warnings():
            # It warns of versions of MuJoCo other than those that it names.
            warnings.simplefilter("ignore")
            import mujoco
            import newton
            import warp

            # What Warp says of the machine as it starts is nothing about the file.
            warp.config.log_level = warp.LOG_ERROR
            with captured_lines([]):
                warp.init()
            builder = newton.ModelBuilder()
            try:
                if format_of(path) == "urdf":
                    with twin_of(path) as twin:
                        builder.add_urdf(twin, floating=False)
                else:
                    builder.add_mjcf(str(path), floating=False)
                loaded = builder.finalize(device="cpu")
                solver = newton.solvers.SolverMuJoCo(loaded, use_mujoco_cpu=True)
            except Exception as error:
                raise ValueError(f"{type(error).__name__}: {error}") from error
        model = solver.mj_model
        model.opt.timestep = config.time_step_s
        return NewtonWorld(mujoco, model, loaded, int(newton.ShapeFlags.COLLIDE_SHAPES), config)


class NewtonWorld(MujocoWorld):
    """What Newton's solver made of its model; links and joints by the file's names."""

    def __init__(
        self, mujoco: Any, model: Any, loaded: Any, solid: int, config: MotionConfig
    ) -> None:
        held = _renamed(read_model(model), loaded)
        super().__init__(mujoco, model, held, config)
        frictions = _frictions(loaded, solid, held.names[0])
        moved = frozenset[str]().union(*self.carried)
        links = tuple(
            replace(
                link,
                shapes=len(frictions.get(link.name, ())),
                friction=max(frictions.get(link.name, ()), default=None),
                # What is fixed to the world is a body of its own here, that moves when told to.
                static=link.name not in moved,
            )
            for link in self.model.links
        )
        apart = self.model.pairs.excluded if self.model.pairs is not None else ()
        excluded = tuple(pair for pair in apart if not _jointed(pair, held))
        rules = PairRules(moving_parent=False, static_parent=False, excluded=excluded)
        self.model = replace(self.model, links=links, pairs=rules)


def _renamed(held: CompiledModel, loaded: Any) -> CompiledModel:
    """Return the same by the file's names, which Newton's solver calls by their model's, too."""
    labels = (*loaded.body_label, *loaded.joint_label)
    names = {each.replace(SEPARATOR, "_"): each.rpartition(SEPARATOR)[2] for each in labels}
    bodies = (replace(body, name=names.get(body.name, body.name)) for body in held.bodies)
    joints = (replace(joint, name=names.get(joint.name, joint.name)) for joint in held.joints)
    return replace(held, bodies=tuple(bodies), joints=tuple(joints))


def _frictions(loaded: Any, solid: int, world: str) -> dict[str, list[float]]:
    """Return the friction of each collision shape that Newton gave a link, or the ``world``.

    Its solver lets a shape that nothing can touch touch nothing, so that it is not counted there.
    """
    # The last one is what -1 means.
    names = [*(label.rpartition(SEPARATOR)[2] for label in loaded.body_label), world]
    found: dict[str, list[float]] = {}
    columns = (loaded.shape_body, loaded.shape_flags, loaded.shape_material_mu)
    for body, flags, friction in zip(*(column.numpy() for column in columns), strict=True):
        if int(flags) & solid:
            found.setdefault(names[int(body)], []).append(float(friction))
    return found


def _jointed(pair: tuple[str, str], held: CompiledModel) -> bool:
    first, second = (held.names.index(name) for name in pair)
    one, other = (held.bodies[number].parent for number in (first, second))
    return first in (second, other) or second == one
