"""The articulation of an input, cached: the network is not run twice on the same input."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import lru_cache
from importlib.util import find_spec

from ..articulation import Articulation, Joint, Part, Weights
from ..config import BuildConfig
from ..errors import ConfigError, InputRejected
from ..intake.intake import Intake
from ..mesh import FloatArray, IntArray, Mesh
from ..models.weights.sources import fetch
from ..runtime.keys import Stage
from ..runtime.stages import Stages
from ..runtime.store import digest_file
from .articulator import make_hypotheses
from .catalog import choose, entry_of
from .locate import located
from .proposal import Hypothesis


@lru_cache(maxsize=4)
def _weight_digests(config: BuildConfig) -> list[str]:
    """Return the digests of checkpoints that may be asked; none where no network can run."""
    if not entry_of(config.articulator).asks_network or find_spec("torch") is None:
        return []
    named = [name for name in (config.particulate.checkpoint, config.particulate.features) if name]
    try:
        return [digest_file(fetch(name)) for name in named]
    except (ConfigError, OSError) as error:
        # Whoever asks that network says so; inputs with joints of their own never ask.
        return [str(error)]


ARTICULATE = Stage(
    "articulate",
    # Articulators are imported by their names.
    code=("asset_factory.factory.articulate", "asset_factory.factory.models"),
    settings=("articulator", "particulate", "auto", "vlm"),
    libraries=("numpy", "scipy", "trimesh", "torch"),
    data=tuple(
        f"weights/{name}.safetensors"
        for name in ("agreement", "detector", "trust", "evidence", "rectangles", "seams")
    ),
    also=_weight_digests,
)


def articulate(intake: Intake, config: BuildConfig) -> Articulation:
    """Return the likeliest kinematic tree of a loaded input, asked anew.

    Arguments and errors as for :func:`hypotheses_of`.
    """
    return hypotheses_of(intake, config)[0].articulation


def hypotheses_of(intake: Intake, config: BuildConfig) -> tuple[Hypothesis, ...]:
    """Return the kinematic trees that a loaded input may have, the likeliest first; asked anew.

    Arguments and errors as for :func:`~.catalog.choose`; besides:

    Raises:
        InputRejected: ``no_movable_joint``, unless a rigid asset was asked for: there is nothing to
            open, so nothing to decompose, simulate or register.
    """
    found = make_hypotheses(choose(intake, config), intake.mesh)
    likeliest = found[0].articulation
    if not likeliest.movable_joints and likeliest.articulator != "rigid":
        why = f": {likeliest.notes[0]}" if likeliest.notes else ""
        message = (
            f"{intake.provenance.input}: nothing moves, says {likeliest.articulator}{why}; "
            "want a joint to open"
        )
        raise InputRejected("no_movable_joint", message, value=0.0, unit="joints", limit=1.0)
    return tuple(replace(each, articulation=located(each.articulation)) for each in found)


@dataclass(frozen=True)
class _Surface:
    """A mesh of the articulator's own, moved or cut along its parts; materials are the input's."""

    vertices: FloatArray
    faces: IntArray
    corner_uv: FloatArray | None
    corner_normals: FloatArray | None
    face_material: IntArray

    @classmethod
    def of(cls, mesh: Mesh) -> _Surface:
        return cls(
            mesh.vertices, mesh.faces, mesh.corner_uv, mesh.corner_normals, mesh.face_material
        )

    def on(self, mesh: Mesh) -> Mesh:
        return replace(mesh, **{name: getattr(self, name) for name in SURFACE})


SURFACE = tuple(field.name for field in fields(_Surface))


@dataclass(frozen=True)
class _Tree:
    """An articulation without the mesh that it was given.

    Attributes:
        own: the mesh's surface, where a joint's range leaves out the input's pose, so that the
            articulator moved it, or where the articulator cut triangles along its parts.
        probability: of the hypothesis.
    """

    parts: tuple[Part, ...]
    joints: tuple[Joint, ...]
    articulator: str
    notes: tuple[str, ...]
    weights: tuple[Weights, ...]
    own: _Surface | None
    probability: float


@dataclass(frozen=True)
class _Trees:
    """All hypotheses of one input."""

    trees: tuple[_Tree, ...]


def hypotheses(intake: Intake, loaded: str, stages: Stages) -> tuple[Hypothesis, ...]:
    """Return what :func:`hypotheses_of` does, with the settings of ``stages``, and remember it.

    Args:
        intake: the loaded input.
        loaded: key of all that it was loaded from.
        stages: with the settings and the cache.

    Raises:
        InputRejected: as the articulator does, or did.
    """
    config = stages.config

    def trees() -> _Trees:
        return _Trees(tuple(_tree(made, intake) for made in hypotheses_of(intake, config)))

    kept = stages.recall("articulate", _Trees, ARTICULATE.key(config, loaded), trees)
    return tuple(_grown(tree, intake) for tree in kept.trees)


def _tree(made: Hypothesis, intake: Intake) -> _Tree:
    tree = made.articulation
    own = None if tree.mesh is intake.mesh else _Surface.of(tree.mesh)
    return _Tree(
        tree.parts, tree.joints, tree.articulator, tree.notes, tree.weights, own, made.probability
    )


def _grown(tree: _Tree, intake: Intake) -> Hypothesis:
    mesh = intake.mesh if tree.own is None else tree.own.on(intake.mesh)
    return Hypothesis(
        Articulation(mesh, tree.parts, tree.joints, tree.articulator, tree.notes, tree.weights),
        tree.probability,
    )
