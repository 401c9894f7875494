"""What a result was made from, as one name: inputs, settings, versions of stages and of libraries.

A result is made anew when any of these is another, and only then. Limits on time and memory do not
    count: they
decide by failing, and what failed is not kept.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from functools import lru_cache
from importlib import resources
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from asset_factory import __version__
from asset_factory.sim_checks import Finding
from asset_factory.sim_checks import judge as judge_module
from asset_factory.sim_checks.judge import VERSION as JUDGE_VERSION
from asset_factory.sim_checks.simulators.catalog import installed_version

from .articulate.choose import VERSION as ARTICULATE_VERSION
from .articulation import Articulation
from .config import BuildConfig
from .errors import ConfigError
from .export.bundle import VERSION as EXPORT_VERSION
from .intake.importers.load import VERSION as LIFT_VERSION
from .intake.loading import VERSION as LOAD_VERSION
from .intake.naming import safe_name
from .intake.reads import Reads
from .intake.sizes import guess_category
from .manufacture.decompose.child import engine_versions
from .manufacture.decompose.decompose import VERSION as DECOMPOSE_VERSION
from .manufacture.decompose.decompose import PartHulls
from .manufacture.inertia import VERSION as INERTIA_VERSION
from .manufacture.separate.separate import VERSION as SEPARATE_VERSION
from .manufacture.targets.find import VERSION as TARGETS_VERSION
from .particulate.weights.sources import fetch
from .runtime.packing import pack
from .runtime.store import digest_bytes, digest_file, stage_key

#: Raised when the pipeline itself would make something else of the same stages.
VERSION = 1

#: Articulators that may ask a network.
LEARNED = frozenset({"auto", "particulate"})
GEOMETRY = ("numpy", "scipy", "trimesh", "manifold3d", "pillow")
COLLISION = ("numpy", "scipy", "trimesh", "python-fcl")


def input_key(source: Path, reads: Reads, config: BuildConfig) -> str:
    """Of what loading one input gives: its files, what its name says, and how it is read.

    Args:
        source: the input.
        reads: every file it was made of.
        config: of intake.
    """
    # The same files are another input under another name, for that becomes the asset's; their
    # folder only matters as far as it tells the category.
    names = [safe_name(source), source.suffix.lower(), _category(source.stem, source.parent.name)]
    versions = [
        LOAD_VERSION,
        LIFT_VERSION,
        _data("categories.toml"),
        _installed((*GEOMETRY, "mujoco")),
    ]
    # What may be loaded is not what loading gives; the settings as a whole say it.
    intake = {
        name: value for name, value in asdict(config.intake).items() if name != "allowed_licences"
    }
    return stage_key("load", VERSION, names, sorted(reads.items()), intake, versions)


def build_key(loaded: str, config: BuildConfig) -> str:
    """Of everything that an asset and its verdict follow from.

    Args:
        loaded: :func:`input_key`.
        config: of every stage.
    """
    return digest_bytes(f"{loaded} {_settings_key(config)}".encode())


@lru_cache(maxsize=4)
def _settings_key(config: BuildConfig) -> str:
    settings = asdict(config)
    for limit in ("asset_wall_s", "asset_memory_bytes", "retries"):
        del settings[limit]
    settings["decompose"] = _unlimited(settings["decompose"])
    settings["checks"] = check_settings(config)
    made = [
        VERSION,
        DECOMPOSE_VERSION,
        SEPARATE_VERSION,
        INERTIA_VERSION,
        TARGETS_VERSION,
        EXPORT_VERSION,
    ]
    judged = [
        _judge_version(),
        _installed(COLLISION),
        [installed_version(name) for name in config.simulators],
    ]
    said = articulate_key("", config)
    return stage_key(
        "settings", VERSION, __version__, settings, made, judged, said, engine_versions()
    )


def failure_key(built: str, config: BuildConfig) -> str:
    """Of an input that could not be judged: with other limits on time and memory it may be.

    Args:
        built: :func:`build_key`.
        config: of every stage.
    """
    limits = [
        config.asset_wall_s,
        config.asset_memory_bytes,
        config.retries,
        asdict(config.checks.child),
    ]
    return stage_key("failure", VERSION, built, limits).removeprefix("failure-")


def articulate_key(loaded: str, config: BuildConfig) -> str:
    """Of what moves in a loaded input."""
    asked = config.articulator in LEARNED
    network = [asdict(config.particulate), asdict(config.auto), _weights(config)] if asked else []
    libraries = _installed((*GEOMETRY, "torch") if asked else GEOMETRY)
    tables = [_data("auto.toml"), _data("evidence.toml")]
    return stage_key(
        "articulate", ARTICULATE_VERSION, loaded, config.articulator, network, libraries, tables
    )


def finish_key(
    planned: Articulation,
    pieces: tuple[PartHulls, ...],
    pairs: Iterable[tuple[str, str]],
    density: float,
    config: BuildConfig,
) -> str:
    """Of what an articulation's hulls become: separated, weighed, with places to take hold.

    By content: other settings of the decomposition that give the same hulls change nothing from
        here on.

    Args:
        planned: the articulation, as a repair plan wants it.
        pieces: hulls, one per part.
        pairs: of parts whose hulls are cut apart.
        density: of the material [kg/m3].
        config: of every stage.
    """
    shapes = {
        **pack((planned.parts, planned.joints)),
        **{f"{k}_of_pieces": v for k, v in pack(pieces).items()},
    }
    arrays = [
        item
        for name in sorted(shapes)
        for item in (name, str(shapes[name]) if "text" in name else shapes[name])
    ]
    mesh = planned.mesh
    settings = [
        asdict(config.separate),
        asdict(config.inertia),
        config.decompose.max_vertices,
        density,
    ]
    versions = [SEPARATE_VERSION, INERTIA_VERSION, TARGETS_VERSION, _installed(GEOMETRY)]
    return stage_key(
        "finish", VERSION, mesh.vertices, mesh.faces, *arrays, sorted(pairs), settings, versions
    )


def inspect_key(files: Mapping[str, str], config: BuildConfig) -> str:
    """Of what is said of a bundle without simulators.

    Args:
        files: the bundle's, with their digests.
        config: of the checks.
    """
    return stage_key(
        "inspect",
        JUDGE_VERSION,
        _judge_version(),
        dict(files),
        check_settings(config),
        _installed(COLLISION),
    )


def validate_key(inspected: str, own_findings: tuple[Finding, ...], config: BuildConfig) -> str:
    """Of the verdict on a bundle that was inspected: by which simulators, and with what the factory itself found."""
    engines = [[name, installed_version(name)] for name in config.simulators]
    return stage_key(
        "validate",
        JUDGE_VERSION,
        _judge_version(),
        inspected,
        [asdict(finding) for finding in own_findings],
        engines,
    )


def check_settings(config: BuildConfig) -> dict[str, Any]:
    """The judge's settings, without those of its processes."""
    return {name: value for name, value in asdict(config.checks).items() if name != "child"}


def _unlimited(decompose: dict[str, Any]) -> dict[str, Any]:
    return {
        name: value
        for name, value in decompose.items()
        if name not in ("cpu_s", "wall_s", "memory_bytes")
    }


@lru_cache(maxsize=4)
def _weights(config: BuildConfig) -> list[str]:
    """Of every checkpoint that may be asked; empty where no network can run."""
    if find_spec("torch") is None:
        return []
    named = [name for name in (config.particulate.checkpoint, config.particulate.features) if name]
    try:
        return [digest_file(fetch(name)) for name in named]
    except (ConfigError, OSError) as error:
        # Whoever asks that network says so; inputs with joints of their own never ask.
        return [str(error)]


# An input's key is asked for a few times in a row, and looking through all categories takes a
# millisecond.
_category = lru_cache(maxsize=1024)(guess_category)


@lru_cache(maxsize=1)
def _judge_version() -> str:
    """The judge's code itself: what a mended judge would reject must not pass by being remembered."""
    folder = Path(judge_module.__file__).parent
    files = sorted(folder.rglob("*.py"))
    return digest_bytes(
        "\n".join(f"{file.relative_to(folder)} {digest_file(file)}" for file in files).encode()
    )


@lru_cache(maxsize=16)
def _data(name: str) -> str:
    return digest_bytes((resources.files("asset_factory") / "configs" / name).read_bytes())


@lru_cache(maxsize=16)
def _installed(packages: tuple[str, ...]) -> list[str]:
    return [f"{package} {_version(package)}" for package in packages]


@lru_cache(maxsize=32)
def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "absent"
