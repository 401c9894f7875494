"""Articulation -> Asset: hulls, inertias and handles, as a repair plan wants them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from asset_factory.sim_checks import Finding, Severity

from .articulation import Articulation, Joint
from .asset import Asset, Inertial, PartBody
from .clock import Stopwatch
from .config import BuildConfig
from .decompose.decompose import PartHulls, decompose
from .handles import find_handle
from .inertia import carrier_inertial, part_inertial
from .mesh.intake import Intake
from .repair import Plan
from .separate import Separation, separate
from .store import Store


def manufacture(
    articulation: Articulation, plan: Plan, intake: Intake, config: BuildConfig, store: Store, clock: Stopwatch
) -> tuple[Asset, tuple[Finding, ...]]:
    """Everything a simulator needs beside the joints, and what the factory itself finds wrong with it.

    Args:
        articulation: parts and joints.
        plan: what a repair wants done differently.
        intake: the input's name and density.
        config: of every stage.
        store: cache of decompositions.
        clock: told how long each stage took.
    """
    limited = with_upper_limits(articulation, plan.upper)
    with clock.stage("decompose"):
        pieces = decompose(limited, config.decompose, store, plan.error_m)
    with clock.stage("separate"):
        separation = separate(limited, pieces, plan.separate, config.separate)
        pieces = separation.pieces
    with clock.stage("inertia"):
        density = intake.provenance.density or config.inertia.density
        inertials = _inertials(limited, pieces, density, config)
        bodies = tuple(
            PartBody(piece.hulls, inertial, find_handle(limited, index), piece.method, piece.degraded)
            for index, (piece, inertial) in enumerate(zip(pieces, inertials, strict=True))
        )
    asset = Asset(intake.name, limited, bodies)
    return asset, (*_own_findings(asset, config), *_refusals(separation))


def _own_findings(asset: Asset, config: BuildConfig) -> Iterator[Finding]:
    if not asset.articulation.movable_joints and config.articulator != "rigid":
        message = (
            f"{asset.name}: nothing moves, says the {asset.articulation.articulator} articulator; want a joint to open"
        )
        yield Finding("no_movable_joint", Severity.HARD, message, value=0.0, unit="joints", limit=1.0)
    for part, body in zip(asset.articulation.parts, asset.bodies, strict=True):
        for sentence in body.degraded:
            yield Finding(
                "degraded_decomposition", Severity.SOFT, f"part {part.name!r}: {sentence}", parts=(part.name,)
            )
    for note in asset.articulation.notes:
        yield Finding("articulation_note", Severity.SOFT, note)


def _refusals(separation: Separation) -> Iterator[Finding]:
    for pair, reason in separation.refused.items():
        message = f"the hulls of {pair[0]!r} and {pair[1]!r} were left as they are: {reason}"
        yield Finding("not_separated", Severity.SOFT, message, parts=pair)


def with_upper_limits(articulation: Articulation, upper: Mapping[str, float]) -> Articulation:
    """The same tree with some joints ending earlier; ``upper`` maps joint names to limits [rad] or [m]."""

    def limited(joint: Joint) -> Joint:
        return replace(joint, upper=upper[joint.name]) if joint.name in upper else joint

    return replace(articulation, joints=tuple(limited(joint) for joint in articulation.joints))


def _inertials(
    articulation: Articulation, pieces: tuple[PartHulls, ...], density: float, config: BuildConfig
) -> list[Inertial]:
    """One inertial per part; a carrier weighs a share of what it carries, so children come first."""
    inertials: dict[int, Inertial] = {}
    for part in reversed(range(len(articulation.parts))):
        if len(articulation.parts[part].faces):
            mesh = articulation.part_mesh(part)
            inertials[part] = part_inertial(mesh, pieces[part].hulls, density, config.inertia)
        else:
            carried = next(joint.child for joint in articulation.joints if joint.parent == part)
            inertials[part] = carrier_inertial(inertials[carried], articulation.link_frame(part))
    return [inertials[part] for part in range(len(articulation.parts))]
