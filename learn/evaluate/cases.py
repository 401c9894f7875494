"""Objects with the truth about them, posed and turned as an input might be."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

import numpy as np

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.errors import ConfigError, InputRejected
from asset_factory.factory.geometry.posing import closed, posed, turned
from asset_factory.factory.intake.categories import guess_category
from asset_factory.factory.intake.discover import find_inputs, is_description
from asset_factory.factory.intake.files import InputFiles
from asset_factory.factory.intake.sidecar import read_sidecar
from asset_factory.factory.runtime.store import digest_file

from .stored import imported
from .transfer import merged

FULL_TURN = 2.0 * np.pi
#: Of skins along their longest side, about as fine as image-to-3D tools give them.
CELLS = 200


@dataclass(frozen=True)
class Request:
    """What to make a case of: small, so that another process can make it.

    Attributes:
        object: its name, unique among objects.
        source: where it is from.
        category: what it is.
        pose: every joint at its closed end (``closed``), or anywhere in its range (``open``).
        yaw: the front towards -Y if there is one (``front``), or turned about z (``random``).
        file: of its description, or its mesh with an annotation; ``None`` for a procedural object.
        digest: of that file; empty if any will do, which is then not kept.
        front_yaw: turn that brings its front to -Y [deg]; ``None`` where that is unknown.
        seed: of a procedural object.
        fused: made one closed skin with seams engraved, as image-to-3D tools give it; parts that
            nothing is seen of are gone.
    """

    object: str
    source: str
    category: str
    pose: str = "closed"
    yaw: str = "front"
    file: Path | None = None
    digest: str = ""
    front_yaw: float | None = 0.0
    seed: int = 0
    fused: bool = False

    @property
    def name(self) -> str:
        """Return the case's name, unique among cases; a file's name without suffix."""
        return f"{self.object}--{self.pose}-{self.yaw}" + ("-fused" if self.fused else "")


def in_settings(
    objects: Sequence[Request], poses: Sequence[str], yaws: Sequence[str]
) -> tuple[Request, ...]:
    """Return every object in every pose and yaw asked for."""
    return tuple(
        replace(each, pose=pose, yaw=yaw) for each, pose, yaw in product(objects, poses, yaws)
    )


def procedural_requests(categories: Sequence[str], seeds: Sequence[int]) -> tuple[Request, ...]:
    """Return the procedural objects, one per category and seed."""
    made = product(categories, seeds)
    return tuple(Request(f"{kind}_{seed}", "procedural", kind, seed=seed) for kind, seed in made)


def folder_requests(folder: Path, *, skins: bool = False) -> tuple[Request, ...]:
    """Return every URDF, MJCF and annotated mesh of a folder; fronts look along -Y.

    Of ``skins``, meshes of one piece, there are only annotated ones.

    Raises:
        ConfigError: there is none.
    """
    config = IntakeConfig()
    found = [
        path
        for path in find_inputs((folder,))
        if (not skins and is_description(path))
        or read_sidecar(path, InputFiles(path.parent, config)).annotation is not None
    ]
    if not found:
        described = "" if skins else "no URDF, no MJCF and "
        said = f"holds {described}no mesh with an annotation"
        raise ConfigError(f"{folder}: {said}; want at least one")
    return tuple(
        Request(
            object=path.relative_to(folder).with_suffix("").as_posix().replace("/", "__"),
            source="skins" if skins else folder.resolve().name,
            category=guess_category(path.stem, path.parent.name) or "unknown",
            file=path,
        )
        for path in found
    )


def make_case(request: Request, kept: Path | None = None) -> Articulation:
    """Return the truth about an object, posed, turned and melted into one mesh.

    ``kept`` is a folder that keeps objects; ``None`` reads them every time.

    Raises:
        InputRejected: it cannot be read, or nothing that moves is seen of the fused object.
        ConfigError: it is not the file that the list speaks of.
    """
    whole = closed(_original(request, kept))
    if request.pose == "open":
        rng = _rng(request, "pose")
        values = {j.name: j.lower + j.range * float(rng.uniform()) for j in whole.movable_joints}
        whole = posed(whole, values)
    if request.yaw == "random":
        whole = turned(whole, float(_rng(request, "yaw").uniform(0.0, FULL_TURN)))
    elif request.front_yaw:
        whole = turned(whole, float(np.radians(request.front_yaw)))
    if request.fused:
        whole = _fused(whole, int(_rng(request, "skin").integers(2**31)))
    return merged(whole, _rng(request, "order"))


def _original(request: Request, kept: Path | None) -> Articulation:
    if request.file is None:
        from ..objects import make_object

        return make_object(request.category, request.seed)
    if request.digest and (digest := digest_file(request.file)) != request.digest:
        said = f"has the SHA-256 {digest[:12]}..., the list says {request.digest[:12]}..."
        raise ConfigError(f"{request.file}: {said}; want the file that was listed")
    return imported(request.file, request.digest, kept)


def _fused(whole: Articulation, seed: int) -> Articulation:
    from ..surfaces import skin_like

    try:
        return skin_like(whole, seed, cells=CELLS, engraved=1.0)
    except ValueError as error:
        raise InputRejected("nothing_seen", f"cannot be made one skin: {error}") from error


def _rng(request: Request, purpose: str) -> np.random.Generator:
    """Return random numbers for one purpose, the same for the same object, pose and yaw."""
    parts = {"yaw": (request.pose,), "order": (request.pose, request.yaw)}.get(purpose, ())
    text = "/".join((request.object, purpose, *parts))
    digest = hashlib.sha256(text.encode()).digest()
    return np.random.default_rng(int.from_bytes(digest[:8], "little"))
