"""Which articulator answers for which input."""

from __future__ import annotations

from importlib.util import find_spec

from ..articulation import Articulation
from ..config import AutoConfig, ParticulateConfig
from ..errors import ConfigError, InputRejected
from ..intake.intake import Intake
from ..particulate.weights.sources import SHIPPED
from .articulator import Articulator

#: Raised when some articulator would say something else of the same mesh.
VERSION = 1
ARTICULATORS = ("auto", "annotated", "geometric", "particulate", "rigid")


def choose(
    intake: Intake,
    name: str,
    particulate: ParticulateConfig | None = None,
    auto: AutoConfig | None = None,
) -> Articulator:
    """The articulator of that name for one input.

    Args:
        intake: the loaded input.
        name: one of ``ARTICULATORS``; ``auto`` takes what came with the input, else ``particulate``
            if a checkpoint is named, else the shipped network and ``geometric`` together, or the
            latter alone where torch is missing.
        particulate: which checkpoint, and how to use it.
        auto: how many views, and how sure is sure enough.

    Raises:
        ConfigError: no articulator of that name, or no usable checkpoint for ``particulate``.
        InputRejected: ``annotated`` was asked for and the input has no annotation.
    """
    from ..intake.importers.prediction import read_prediction
    from .annotated import AnnotatedArticulator
    from .geometric import GeometricArticulator
    from .rigid import RigidArticulator

    if name not in ARTICULATORS:
        raise ConfigError(f"no articulator {name!r}; there are {', '.join(ARTICULATORS)}")
    annotation = intake.annotation
    if annotation is None and intake.annotation_path is not None and name in ("auto", "annotated"):
        faces = int(intake.source_faces.max()) + 1
        annotation = read_prediction(intake.annotation_path, faces, intake.annotation_data)
    if name == "rigid":
        return RigidArticulator()
    if annotation is not None and name in ("auto", "annotated"):
        return AnnotatedArticulator(annotation, intake.transform, intake.source_faces)
    if name == "annotated":
        raise InputRejected(
            "no_annotation",
            f"{intake.provenance.input}: has no parts and joints of its own; want a URDF, an MJCF, or a sidecar "
            "naming a pred.npz, or another articulator",
        )
    settings = particulate or ParticulateConfig()
    if name == "geometric" or (name == "auto" and find_spec("torch") is None):
        return GeometricArticulator()
    if name == "auto" and settings.checkpoint == SHIPPED:
        from .auto import load_auto

        return load_auto(settings, auto or AutoConfig())
    from .particulate import load_articulator

    return load_articulator(settings)


def articulate(
    intake: Intake,
    name: str,
    particulate: ParticulateConfig | None = None,
    auto: AutoConfig | None = None,
) -> Articulation:
    """The kinematic tree of a loaded input.

    Arguments and errors as for :func:`choose`; besides:

    Raises:
        InputRejected: ``no_movable_joint``, unless a rigid asset was asked for: there is nothing to
            open, so nothing to decompose, simulate or register.
    """
    articulation = choose(intake, name, particulate, auto).articulate(intake.mesh)
    if not articulation.movable_joints and articulation.articulator != "rigid":
        why = f": {articulation.notes[0]}" if articulation.notes else ""
        message = f"{intake.provenance.input}: nothing moves, says {articulation.articulator}{why}; want a joint to open"
        raise InputRejected("no_movable_joint", message, value=0.0, unit="joints", limit=1.0)
    return articulation
