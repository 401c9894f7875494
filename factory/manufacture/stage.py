"""The stage Articulation -> Asset: hulls, inertias, handles, targets, by a repair plan."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

from asset_factory.sim_checks import Finding, Severity

from ..articulation import Articulation
from ..asset import Asset, Inertial, PartBody, Target
from ..config import BuildConfig, HullsConfig
from ..errors import InputRejected
from ..geometry.posing import closed
from ..intake.categories import UNKNOWN, Category, usual_of
from ..intake.intake import Intake
from ..runtime.keys import Stage
from ..runtime.packing import contents
from ..runtime.stages import Stages
from .decompose.decompose import decompose
from .decompose.fewer import fewer
from .decompose.pieces import SolidPieces
from .decompose.room import rooms_of
from .inertia import carrier_inertial, part_inertial, weighing
from .plan import Plan, as_planned
from .separate import Separation, separate
from .solids.build import solid_parts
from .targets.find import find_targets
from .targets.handles import find_handle

FINISH = Stage(
    "finish",
    code=(__name__,),
    settings=("separate", "inertia", "decompose.max_vertices"),
    libraries=("numpy", "scipy", "trimesh", "manifold3d"),
)


def manufacture(
    articulation: Articulation, plan: Plan, intake: Intake, stages: Stages
) -> tuple[Asset, tuple[Finding, ...]]:
    """Make all that a simulator needs beside the joints; with the factory's own findings.

    Where its joints are best held no simulator asks: see :func:`with_targets`. The stages have the
    settings, are told how long each stage took, and asked whether it was done before.
    """
    whole = as_planned(articulation, Plan(given_up=plan.given_up, rehung=plan.rehung))
    usual = usual_of(intake.provenance.category or articulation.looks_like)
    built = solid_parts(whole, stages, plan.build_fronts, usual)
    planned = as_planned(
        built.articulation, replace(plan, given_up=frozenset(), rehung=frozenset())
    )
    with stages.clock.stage("decompose"):
        pieces, joined = _hulls(planned, built.pieces, plan, stages)
    stated = intake.provenance.density
    density = stated or stages.config.inertia.density
    bulk = None if stated else usual.bulk
    # By content: other settings of the decomposition that give the same hulls change nothing more.
    shapes = contents((planned.mesh.vertices, planned.mesh.faces, planned.parts, planned.joints))
    key = FINISH.key(
        stages.config, *shapes, *contents(pieces), sorted(plan.separate), density, bulk
    )
    finish = partial(_finished, planned, pieces, plan, density, bulk, stages)
    finished = stages.recall("finish", _Finished, key, finish)
    notes = (*planned.notes, *_assumptions(usual, intake, bulk))
    planned = replace(planned, notes=notes)
    asset = Asset(intake.name, planned, finished.bodies, (), built.surfaces)
    return asset, (*_own_findings(asset), *joined, *finished.findings)


def _assumptions(usual: Category, intake: Intake, bulk: float | None) -> Iterator[str]:
    """Yield a sentence for each assumption that rests on an object's category."""
    if usual is not UNKNOWN and not intake.provenance.category:
        yield f"its category was taken to be {usual.name}, by its looks"
    if bulk is not None:
        yield f"its mass is that of a usual {usual.name}: {bulk:g} kg per m3 of the box around it"


def _hulls(
    planned: Articulation, known: Sequence[SolidPieces | None], plan: Plan, stages: Stages
) -> tuple[tuple[SolidPieces, ...], list[Finding]]:
    """Decompose every part, joined where the asset has many hulls; and say which were joined."""
    room_of = rooms_of(planned)
    plain = decompose(planned, stages, room_of, known, plan.hollow)
    found, errors_m = fewer(plain, _wanted(plan, stages.config), stages, room_of)
    limit = stages.config.decompose.max_hulls
    for part, piece in zip(planned.parts, found, strict=True):
        if len(piece.hulls) > limit:
            raise InputRejected(
                "too_many_hulls",
                f"part {part.name!r}: needs {len(piece.hulls)} convex pieces; want at most "
                f"{limit}: split the part or simplify its mesh",
                value=float(len(piece.hulls)),
                unit="hulls",
                limit=float(limit),
            )
    return found, [
        _finding(
            "hulls_joined",
            f"part {planned.parts[part].name!r}: {len(plain[part].hulls)} hulls joined to "
            f"{len(found[part].hulls)} with an error of {1000 * error_m:g} mm",
            planned.parts[part].name,
        )
        for part, error_m in sorted(errors_m.items())
    ]


def _wanted(plan: Plan, config: BuildConfig) -> HullsConfig:
    """Return how many hulls there may be, as a plan says."""
    if plan.fewer is None and not plan.closely:
        return config.hulls
    most = config.decompose.max_hulls if plan.fewer is None else plan.fewer
    return replace(config.hulls, wanted=most, most=most)


def with_targets(asset: Asset, stages: Stages) -> Asset:
    """Return the same asset with the places where each joint is best opened."""
    shapes = contents((asset.articulation.mesh.vertices, asset.articulation.mesh.faces))
    moved = contents((asset.articulation.parts, asset.articulation.joints, asset.bodies))
    key = FINISH.key(stages.config, "targets", *shapes, *moved)

    def make() -> tuple[Target, ...]:
        with stages.clock.stage("targets"):
            return find_targets(asset.articulation, [body.hulls for body in asset.bodies])

    return replace(asset, targets=stages.recall("finish", tuple[Target, ...], key, make))


@dataclass(frozen=True)
class _Finished:
    """The separated and weighed hulls, and the findings on the way."""

    bodies: tuple[PartBody, ...]
    findings: tuple[Finding, ...]


def _finished(
    planned: Articulation,
    pieces: tuple[SolidPieces, ...],
    plan: Plan,
    density: float,
    bulk: float | None,
    stages: Stages,
) -> _Finished:
    config = stages.config
    clock = stages.clock
    with clock.stage("separate"):
        separation = separate(
            planned, pieces, plan.separate, config.separate, config.decompose.max_vertices
        )
        pieces = separation.pieces
    with clock.stage("inertia"):
        inertials = _inertials(planned, pieces, density, bulk, config)
        bodies = tuple(
            PartBody(
                piece.hulls, inertial, find_handle(planned, index), piece.method, piece.degraded
            )
            for index, (piece, inertial) in enumerate(zip(pieces, inertials, strict=True))
        )
    return _Finished(bodies, tuple(_separation_findings(separation)))


def _own_findings(asset: Asset) -> Iterator[Finding]:
    for part, body in zip(asset.articulation.parts, asset.bodies, strict=True):
        for sentence in body.degraded:
            yield _finding("degraded_decomposition", f"part {part.name!r}: {sentence}", part.name)
    for note in asset.articulation.notes:
        yield _finding("articulation_note", note)


def _separation_findings(separation: Separation) -> Iterator[Finding]:
    for pair, refusal in separation.refused.items():
        done = "cut apart at rest only" if refusal.at_rest else "left as they are"
        message = f"the hulls of {pair[0]!r} and {pair[1]!r} were {done}: {refusal.reason}"
        code = "meshes_overlap" if refusal.meshes else "not_separated"
        yield _finding(code, message, *pair)
    for pair, depth in separation.hidden.items():
        message = (
            f"{pair[0]!r} and {pair[1]!r} overlap by {depth * 1000:.2f} mm at rest; "
            "what is hidden there was cut out of the collision geometry"
        )
        yield _finding("hidden_overlap", message, *pair, depth_m=depth)
    for pair, trimmed in separation.trimmed.items():
        told = " and ".join(
            f"{each.deepest_m * 1000:.1f} mm of {each.part!r} ({each.share:.1%} of it, "
            f"{each.area:.1%} of its surface)"
            for each in trimmed
        )
        message = (
            f"so that {pair[0]!r} and {pair[1]!r} are clear of one another, their collision "
            f"geometry was cut back where that can be seen: {told}"
        )
        deepest_m = max(each.deepest_m for each in trimmed)
        yield _finding("planed", message, *pair, depth_m=deepest_m)


def _finding(code: str, message: str, *parts: str, depth_m: float | None = None) -> Finding:
    """Return a warning about some parts, with a depth where one was measured."""
    found = Finding(code, Severity.WARNING, message, parts=parts)
    return found if depth_m is None else replace(found, value=round(depth_m * 1000, 4), unit="mm")


def _inertials(
    articulation: Articulation,
    pieces: tuple[SolidPieces, ...],
    density: float,
    bulk: float | None,
    config: BuildConfig,
) -> list[Inertial]:
    """Weigh every part, and all together; see :class:`Category` for bulk [kg/m3].

    A carrier weighs a share of its load, so children come first.
    """
    inertials: dict[int, Inertial] = {}
    for part in reversed(range(len(articulation.parts))):
        if len(articulation.parts[part].faces):
            mesh = articulation.part_mesh(part)
            inertials[part] = part_inertial(mesh, pieces[part].hulls, density, config.inertia)
        else:
            carried = next(joint.child for joint in articulation.joints if joint.parent == part)
            inertials[part] = carrier_inertial(inertials[carried], articulation.link_frame(part))
    ordered = [inertials[part] for part in range(len(articulation.parts))]
    if bulk is None:
        return ordered
    box = float(closed(articulation).mesh.extents.prod())
    return weighing(ordered, bulk * box, density)
