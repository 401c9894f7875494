"""The articulation of an input, cached: the network is not run twice on the same input."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ..articulation import Articulation
from ..config import BuildConfig
from ..errors import ConfigError, InputRejected
from ..intake.intake import Intake
from ..mesh import Material, Mesh
from ..models.weights.sources import fetch
from ..runtime.keys import Stage
from ..runtime.stages import Stages
from ..runtime.store import digest_file
from .annotated import annotation_of
from .articulator import make_hypotheses
from .catalog import choose, entry_of
from .locate import located


@lru_cache(maxsize=4)
def _weight_digests(config: BuildConfig) -> list[str]:
    """Return the digests of checkpoints that may be asked."""
    if not entry_of(config.articulator).asks_network:
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
        f"weights/{name}.safetensors" for name in ("agreement", "detector", "trust", "evidence")
    ),
    also=_weight_digests,
)

#: What helps where nothing is seen to move.
WAY_FORWARD = (
    "say what opens in a sidecar (docs/say-what-opens.md) or with `factory edit`, take what is "
    "less sure with --config lenient, or ask the published network with --checkpoint paper"
)


def hypotheses_of(intake: Intake, config: BuildConfig) -> tuple[Articulation, ...]:
    """Return the kinematic trees that a loaded input may have, the likeliest first; asked anew.

    Arguments and errors as for :func:`~.catalog.choose`; besides:

    Raises:
        InputRejected: ``no_movable_joint``, unless a rigid asset was asked for: there is nothing to
            open, so nothing to decompose, simulate or register.
    """
    name = intake.provenance.input
    guessed = intake.stated is None and annotation_of(intake) is None
    if guessed and config.articulator != "rigid":
        _refuse_flat(name, intake.mesh)
    found = make_hypotheses(choose(intake, config), intake.mesh)
    likeliest = found[0]
    if not likeliest.movable_joints and likeliest.articulator != "rigid":
        size = " x ".join(f"{side:.3g}" for side in intake.mesh.extents)
        seen = "; ".join(likeliest.notes) or "nothing in this mesh looks as if it moved"
        says = f", says {likeliest.articulator} (it is {size} m): {seen}"
        raise _nothing_moves(name, f"{says}; {WAY_FORWARD}")
    return tuple(located(each) for each in found)


def _refuse_flat(name: str, mesh: Mesh) -> None:
    """Raise InputRejected where all triangles are in one plane."""
    used = mesh.vertices[np.unique(mesh.faces)]
    spread = np.linalg.svd(used - used.mean(axis=0), compute_uv=False)
    if spread[-1] <= spread[0] * 1e-6:
        count = len(mesh.faces)
        faces = "its one triangle is" if count == 1 else f"all its {count} triangles are"
        wanted = "want a solid object, with parts that open"
        raise _nothing_moves(name, f": {faces} in one plane; {wanted}")


def _nothing_moves(name: str, why: str) -> InputRejected:
    message = f"{name}: nothing moves{why}"
    return InputRejected("no_movable_joint", message, value=0.0, unit="joints", limit=1.0)


def hypotheses(intake: Intake, loaded: str, stages: Stages) -> tuple[Articulation, ...]:
    """Return what :func:`hypotheses_of` does, with the settings of ``stages``, and remember it.

    Args:
        intake: the loaded input.
        loaded: key of all that it was loaded from.
        stages: with the settings and the cache.

    Raises:
        InputRejected: as the articulator does, or did.
    """
    config = stages.config

    # Textures are kept once, with the input.
    nameless = (Material("input"),) * len(intake.mesh.materials)

    def made() -> tuple[Articulation, ...]:
        return tuple(_painted(each, nameless) for each in hypotheses_of(intake, config))

    key = ARTICULATE.key(config, loaded)
    kept = stages.recall("articulate", tuple[Articulation, ...], key, made)
    return tuple(_painted(each, intake.mesh.materials) for each in kept)


def _painted(articulation: Articulation, materials: tuple[Material, ...]) -> Articulation:
    """Return an articulation whose mesh has other materials."""
    return replace(articulation, mesh=replace(articulation.mesh, materials=materials))
