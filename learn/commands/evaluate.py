"""``factory evaluate``: flags, and the call."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import tyro

from asset_factory.factory.errors import ConfigError, Exit
from asset_factory.factory.runtime.store import digest_bytes, digest_file

if TYPE_CHECKING:
    from ..evaluate.cases import Request
    from ..evaluate.methods import Method

ObjectSet = Literal["real", "procedural", "folder", "skins"]


@dataclass(frozen=True)
class Evaluate:
    """Score articulators on objects whose joints are known.

    A method that gives no answer for a case is counted and scored as if it had said that nothing
    moves; what hangs is counted and not scored. Exit codes: 0 all cases are scored; 3 some case
    could not be made or hung; 2 wrong usage.

    Example: factory evaluate --set procedural --method auto geometric --output evaluation/
    """

    output: Path
    """Folder for evaluation.json and cases.csv; made if it is not there."""
    kind: Annotated[ObjectSet, tyro.conf.arg(name="set")] = "real"
    """real (a frozen list), procedural, folder (any with joints), or skins (one-piece meshes)."""
    data: Path | None = None
    """real: root of the list's paths; folder, skins: folder of the objects."""
    listed: Annotated[Path | None, tyro.conf.arg(name="list")] = None
    """real: another list than the package's own."""
    half: Literal["develop", "report", "both"] = "develop"
    """real: develop, to choose and tune on; report, held out for one last measurement; both."""
    category: tuple[str, ...] = ()
    """Only these; for procedural objects all by default."""
    seeds: int = 4
    """procedural: objects per category."""
    first_seed: int = 0
    """procedural: seed of the first one; leave it away from the seeds that training draws."""
    pose: tuple[Literal["closed", "open"], ...] = ("closed",)
    """closed: every joint at its closed end; open: anywhere in its range, at random."""
    yaw: tuple[Literal["front", "random"], ...] = ("front",)
    """front: its front towards -Y; random: turned about the vertical by any angle."""
    method: tuple[str, ...] = ("naive", "geometric")
    """naive, geometric, particulate, auto, predictions."""
    predictions: Path | None = None
    """Folder of <case>.npz files in the published model's format, over meshes of --meshes."""
    fused: bool = False
    """Fuse each object to one closed mesh with engraved seams, as image-to-3D tools make them."""
    meshes: Path | None = None
    """Write the cases' meshes there as <case>.obj and evaluate nothing."""
    convention: Literal["physical", "paper", "release"] = "physical"
    """physical (faces' areas and motion), or published metrics: paper (worded), release (coded)."""
    points: int = 100_000
    """paper, release: points per object."""
    checkpoint: str = "shipped"
    """Weights for particulate and auto: a file, or hf:owner/repository/file@commit."""
    features: str = ""
    """Weights of its feature extractor, where those want features."""
    network_points: int | None = None
    """Points that the network labels."""
    device: str = "auto"
    """Where the network runs: auto (a GPU where there is one), cpu, cuda, cuda:N or mps."""
    repeats: int = 1
    """How often a method that samples is asked, each time with another seed."""
    limit: int | None = None
    """Only the first so many cases."""
    workers: int = 1
    """Cases at once."""
    timeout: float = 300.0
    """Longest that one answer may take [s]; then it is stopped and not scored."""
    cache: Path | None = None
    """Folder that keeps objects that were read, for the next evaluation."""


def run(command: Evaluate) -> int:
    """Evaluate, write, print; returns the exit code.

    Raises:
        ConfigError: wrong usage, and what would be right.
    """
    from asset_factory.factory.cli.flags import require_writable
    from asset_factory.factory.config import BuildConfig
    from asset_factory.sim_checks.processes.isolation import Limits

    from ..evaluate.files import write_results
    from ..evaluate.trial import Trial, run_trials
    from .evaluation_printing import followed, print_summary

    _require_sound(command)
    requests = _requests(command)
    if command.meshes is not None:
        _write_meshes(command.meshes, requests, command.cache)
        return Exit.OK
    methods = _methods(command)
    require_writable(command.output, "--output")
    settings = _settings(command, len(requests))
    trials = [
        Trial(request, method, repeat, command.convention, command.points, command.cache)
        for method, request in product(methods, requests)
        for repeat in range(command.repeats if method.is_random else 1)
    ]
    limits = Limits(wall_s=command.timeout, memory_bytes=BuildConfig().asset_memory_bytes)
    rows = followed(run_trials(trials, command.workers, limits), len(trials))
    data = write_results(command.output, rows, settings)
    print_summary(data, command.output)
    return Exit.OK if all(row.score is not None for row in rows) else Exit.UNJUDGED


def _require_sound(command: Evaluate) -> None:
    from asset_factory.factory.cli.flags import check_effort

    check_effort(command, ("points", "seeds", "repeats", "workers", "limit"), seed="first_seed")
    if command.kind != "procedural" and command.data is None:
        raise ConfigError(f"--data: not given; --set {command.kind} wants the folder of objects")
    for flag in ("method", "pose", "yaw"):
        names = getattr(command, flag)
        if not names or len(set(names)) < len(names):
            said = " ".join(names) or "nothing"
            raise ConfigError(f"--{flag}: {said}; want at least one, each once")


def _requests(command: Evaluate) -> tuple[Request, ...]:
    from ..evaluate.cases import in_settings

    objects = [replace(each, fused=command.fused) for each in _objects(command)]
    requests = in_settings(objects, command.pose, command.yaw)
    if command.category:
        known = sorted({request.category for request in requests})
        unknown = [name for name in command.category if name not in known]
        if unknown:
            said = f"none of these objects is a {unknown[0]!r}"
            raise ConfigError(f"--category: {said}; there are {', '.join(known)}")
        requests = tuple(request for request in requests if request.category in command.category)
    if not requests:
        raise ConfigError("no object is left to evaluate; want another list or half")
    return requests[: command.limit]


def _objects(command: Evaluate) -> tuple[Request, ...]:
    from ..evaluate.cases import folder_requests, procedural_requests
    from ..evaluate.listing import real_requests

    if command.kind == "procedural" or command.data is None:
        from ..objects import CATEGORIES

        seeds = range(command.first_seed, command.first_seed + command.seeds)
        return procedural_requests(CATEGORIES, seeds)
    if command.kind in ("folder", "skins"):
        return folder_requests(command.data, skins=command.kind == "skins")
    half = None if command.half == "both" else command.half
    return real_requests(command.data, half, command.listed)


def _methods(command: Evaluate) -> tuple[Method, ...]:
    from asset_factory.factory.articulate.settings import require_usable
    from asset_factory.factory.cli.flags import given, on_device
    from asset_factory.factory.config import ParticulateConfig

    from ..evaluate.methods import Method

    config = on_device(ParticulateConfig(**given(command, "checkpoint", "features", "device")))
    if command.network_points is not None:
        config = replace(config, points=command.network_points)
    require_usable(config, needed="particulate" in command.method)
    return tuple(Method(name, config, command.predictions) for name in command.method)


def _settings(command: Evaluate, cases: int) -> dict[str, Any]:
    """Return what the numbers depend on; nothing of this machine."""
    from ..evaluate.listing import list_text

    told: dict[str, Any] = {"set": command.kind, "cases": cases, "convention": command.convention}
    told |= {name: list(getattr(command, name)) for name in ("pose", "yaw", "method", "category")}
    told |= {"repeats": command.repeats, "timeout_s": command.timeout}
    if command.kind == "real":
        told |= {"half": command.half, "list": digest_bytes(list_text(command.listed).encode())}
    if command.fused:
        told |= {"fused": True}
    if command.kind == "procedural":
        told |= {"seeds": command.seeds, "first_seed": command.first_seed}
    if command.convention != "physical":
        told |= {"points": command.points}
    if command.network_points is not None:
        told |= {"network_points": command.network_points}
    for name in ("checkpoint", "features"):
        if getattr(command, name) and {"auto", "particulate"} & set(command.method):
            told |= {name: _weights(getattr(command, name))}
    return told


def _weights(checkpoint: str) -> dict[str, str]:
    from asset_factory.factory.models.weights.sources import fetch

    file = fetch(checkpoint)
    return {"file": file.name, "digest": digest_file(file)}


def _write_meshes(folder: Path, requests: Sequence[Request], cache: Path | None) -> None:
    from ..evaluate.cases import make_case
    from ..evaluate.files import write_obj

    folder.mkdir(parents=True, exist_ok=True)
    for request in requests:
        write_obj(folder / f"{request.name}.obj", make_case(request, cache).mesh)
