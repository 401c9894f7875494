"""What all formats agree on: links with their frames, inertias and joints."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..articulation import Joint
from ..asset import Asset, Inertial
from ..mesh import FloatArray
from ..runtime.numbers import DIGITS
from .meshes import hull_obj
from .resistance import NO_RESISTANCE, Resistance, joint_resistances, resistance_notes
from .text import write_text
from .visuals import VISUAL_FOLDER, TextureFolder, VisualPiece, write_visuals

COLLISION_FOLDER = Path("meshes/collision")
#: MuJoCo wants ``A + B >= C`` without tolerance; a flat plate sits exactly on that border.
TRIANGLE_SLACK = 1e-6


@dataclass(frozen=True)
class LinkLayout:
    """Everything that the elements of one link and of its joint say.

    Attributes:
        name: of the link, the same in URDF, MJCF and manifest.
        joint: that holds it; ``None`` for the root.
        resistance: of that joint.
        origin: of its frame at rest [m], object frame, shape [3]; the axes are parallel.
        offset: the same in its parent's frame.
        inertial: in its own frame, its tensor as :func:`safe_tensor` has it.
        visuals: see :class:`VisualPiece`.
        collisions: OBJ files, one per hull, relative to the bundle.
    """

    name: str
    joint: Joint | None
    resistance: Resistance
    origin: FloatArray
    offset: FloatArray
    inertial: Inertial
    visuals: tuple[VisualPiece, ...]
    collisions: tuple[Path, ...]


@dataclass(frozen=True)
class Layout:
    """An asset whose meshes lie in its bundle folder, ready to be described.

    Attributes:
        asset: to describe.
        links: one per part.
        excluded_pairs: names of links whose contacts MuJoCo is told to ignore.
        notes: losses and changes on the way, one sentence each.
    """

    asset: Asset
    links: tuple[LinkLayout, ...]
    excluded_pairs: tuple[tuple[str, str], ...]
    notes: tuple[str, ...]


def lay_out(asset: Asset, folder: Path, excluded_pairs: tuple[tuple[str, str], ...]) -> Layout:
    """Write all meshes of ``asset`` below ``folder``.

    Raises:
        ValueError: an excluded pair names a part that is not there.
    """
    for subfolder in (VISUAL_FOLDER, COLLISION_FOLDER):
        (folder / subfolder).mkdir(parents=True)
    textures = TextureFolder(folder / VISUAL_FOLDER)
    resistances = joint_resistances(asset)
    links = tuple(
        _lay_out_link(asset, part, resistance, folder, textures)
        for part, resistance in enumerate((NO_RESISTANCE, *resistances))
    )
    names = tuple(link.name for link in links)
    notes = (*textures.notes, *resistance_notes(asset, resistances))
    return Layout(asset, links, _sorted(excluded_pairs, names), notes)


def _lay_out_link(
    asset: Asset, part: int, resistance: Resistance, folder: Path, textures: TextureFolder
) -> LinkLayout:
    articulation = asset.articulation
    joint = articulation.parent_joint(part)
    origin = articulation.link_frame(part)
    inertial = asset.bodies[part].inertial
    return LinkLayout(
        name=articulation.parts[part].name,
        joint=joint,
        resistance=resistance,
        origin=origin,
        offset=origin if joint is None else origin - articulation.link_frame(joint.parent),
        inertial=Inertial(inertial.mass, inertial.center - origin, safe_tensor(inertial)),
        visuals=write_visuals(asset, part, folder, textures),
        collisions=_write_hulls(asset, part, folder),
    )


def safe_tensor(inertial: Inertial) -> FloatArray:
    """Return the inertia tensor [kg m2], moved off the triangle inequality's limit by a millionth.

    In as many digits of its trace as are written of any number: products of inertia that cancel to
    nothing leave other last digits on every processor.
    """
    moments = np.linalg.eigvalsh(inertial.tensor)
    slack = TRIANGLE_SLACK * moments[2]
    lift = max(0.0, slack - (moments[0] + moments[1] - moments[2]))
    decimals = DIGITS - 1 - math.floor(math.log10(moments.sum()))
    return np.asarray(np.round(inertial.tensor + lift * np.eye(3), decimals) + 0.0)


def _write_hulls(asset: Asset, part: int, folder: Path) -> tuple[Path, ...]:
    name = asset.articulation.parts[part].name
    origin = asset.articulation.link_frame(part)
    files = []
    for index, hull in enumerate(asset.bodies[part].hulls):
        file = COLLISION_FOLDER / f"{name}_{index:03d}.obj"
        write_text(folder / file, hull_obj(hull, origin))
        files.append(file)
    return tuple(files)


def _sorted(
    pairs: tuple[tuple[str, str], ...], names: tuple[str, ...]
) -> tuple[tuple[str, str], ...]:
    for pair in pairs:
        for name in pair:
            if name not in names:
                known = sorted(names)
                raise ValueError(f"excluded pair {pair}: no part {name!r}; there are {known}")
    return tuple(sorted({(min(pair), max(pair)) for pair in pairs}))
