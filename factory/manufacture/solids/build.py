"""The step: from parts that are patches of one mesh to solid parts, convex by construction."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ...articulation import Articulation
from ...asset import Hull, InnerSurface
from ...config import SolidsConfig
from ...geometry.posing import face_parts, rotated
from ...intake.categories import UNKNOWN, Category
from ...mesh import FloatArray, Mesh
from ...runtime.keys import Stage
from ...runtime.packing import contents
from ...runtime.stages import Stages
from ...runtime.store import digest_bytes
from ...views.raster import Side
from ...views.view import elevation
from ..decompose.pieces import SolidPieces
from .body import hang_panels, make_body, make_rest, share_out
from .carve import carve_panel, hollow_behind, make_slab, planes_of_panels
from .clear import cleared
from .frame import turned_hull, working_frame
from .knobs import make_bumps, planes_of_bumps
from .lattice import Lattice, enclosed
from .recognize import cut_bases, recognize, recognize_bumps
from .skin import parts_to_build, skin_parts
from .visible import bump_surfaces, meshed, panel_surfaces
from .work import Workpiece

SOLIDS = Stage(
    "solids",
    code=(__name__,),
    settings=("solids",),
    libraries=("numpy", "scipy", "manifold3d", "pillow"),
)


@dataclass(frozen=True)
class SolidParts:
    """A one-piece mesh made solid.

    Attributes:
        articulation: over the mesh with inner faces; hinges may have been moved.
        pieces: one per part; ``None`` for parts that are to be decomposed as they are.
        surfaces: those invented.
    """

    articulation: Articulation
    pieces: tuple[SolidPieces | None, ...]
    surfaces: tuple[InnerSurface, ...]


def solid_parts(
    articulation: Articulation, stages: Stages, fronts: bool = False, usual: Category = UNKNOWN
) -> SolidParts:
    """Return an articulation whose one-piece parts are made solid; any other comes back as it is.

    Arguments as of :func:`solids`, with the settings and the cache. Solids are kept between builds
    without textures, which the input brings again.
    """
    config = stages.config.solids
    if not config.construct or not parts_to_build(articulation, fronts):
        return SolidParts(articulation, (None,) * len(articulation.parts), ())
    mesh = articulation.mesh
    textures = [digest_bytes(each.texture.data) for each in mesh.materials if each.texture]
    plain = replace(articulation, mesh=_bare(mesh))
    key = SOLIDS.key(stages.config, *contents(plain), *textures, fronts, usual.shelves, usual.liner)

    def make() -> SolidParts:
        made = solids(articulation, config, fronts, usual)
        return _with_mesh(made, _bare(made.articulation.mesh))

    made = stages.recall("solids", SolidParts, key, make)
    return _with_mesh(made, _dressed(made.articulation.mesh, mesh))


def _with_mesh(made: SolidParts, mesh: Mesh) -> SolidParts:
    return replace(made, articulation=replace(made.articulation, mesh=mesh))


def _bare(mesh: Mesh) -> Mesh:
    materials = tuple(replace(material, texture=None) for material in mesh.materials)
    return replace(mesh, materials=materials)


def _dressed(mesh: Mesh, source: Mesh) -> Mesh:
    """Give a mesh the source's own materials, which come first, as the source has them."""
    own = source.materials
    return replace(mesh, materials=(*own, *mesh.materials[len(own) :]))


def solids(
    articulation: Articulation,
    config: SolidsConfig,
    fronts: bool = False,
    usual: Category = UNKNOWN,
) -> SolidParts:
    """Make patches of a one-piece mesh and bare fronts solid, and what holds them hollow.

    At least one moved part is to be built, see ``parts_to_build``: with ``fronts`` every thin
    front, bare or not. The insides are as usual in a category.
    """
    parts = parts_to_build(articulation, fronts)
    turn = working_frame(articulation, parts)
    work = _prepared(_rotated(articulation, turn), parts, config, usual)
    if not work.whole.any():
        note = "the one-piece mesh encloses no volume: its parts are decomposed as they are"
        plain = replace(articulation, notes=(*articulation.notes, note))
        return SolidParts(plain, (None,) * len(articulation.parts), ())
    _made(work)
    work.hulls = cleared(work)
    for part in set(work.rest) - set(skin_parts(work.source)):
        # A body of its own, a rack of wire: what it is made of is known better than cells tell.
        work.hulls[part] = ()
    for part in work.panels:
        panel_surfaces(work, part)
    for part in work.bumps:
        bump_surfaces(work, part)
    made = _rotated(meshed(work), turn.T)
    pieces = tuple(
        _piece(tuple(turned_hull(hull, turn.T) for hull in work.hulls[index]), len(part.faces))
        for index, part in enumerate(made.parts)
    )
    notes = (*articulation.notes, *work.notes, *_notes(work, pieces))
    return SolidParts(replace(made, notes=notes), pieces, tuple(work.records))


def _notes(work: Workpiece, pieces: tuple[SolidPieces | None, ...]) -> Iterator[str]:
    """Yield a sentence for each invention, and for each part not made as panels are."""
    kinds = Counter(record.kind for record in work.records)
    said = ", ".join(f"{count} x {kind}" for kind, count in sorted(kinds.items()))
    if said:
        yield f"one-piece mesh rebuilt as solids; geometry that the input lacks: {said}"
    rest = [work.name(part) for part in work.rest if pieces[part] is not None]
    if rest:
        names = ", ".join(repr(name) for name in rest)
        yield f"no panel, lid or knob: {names}; hulls were cut from the solid behind the surface"
    left = [work.name(part) for part, piece in enumerate(pieces) if piece is None]
    if left:
        names = ", ".join(repr(name) for name in left)
        yield f"decomposed as they are: {names}"


def _prepared(
    articulation: Articulation, parts: tuple[int, ...], config: SolidsConfig, usual: Category
) -> Workpiece:
    owners = face_parts(articulation)
    sides: list[Side] = [side for side in Side if side is not Side.BOTTOM]
    views = {side: elevation(articulation.mesh, side, owner=owners) for side in sides}
    panels, skin = recognize(articulation, parts, views, config.behind_m)
    others = [part for part in range(1, len(articulation.parts)) if part not in panels]
    others = [part for part in others if len(articulation.parts[part].faces)]
    bumps, rest = recognize_bumps(articulation, others)
    skin = cut_bases(skin, bumps, articulation)
    joints = list(articulation.joints)
    planes: list[list[float]] = [[], [], []]
    for axis, at in (*planes_of_panels(panels, joints, config), *planes_of_bumps(bumps, joints)):
        planes[axis].append(at)
    lattice = Lattice.over(articulation.mesh.bounds, config.cells, planes)
    whole = enclosed(articulation.mesh, lattice)
    owner = np.where(whole, 0, -1).astype(np.int64)
    return Workpiece(
        articulation,
        config,
        usual,
        views,
        joints,
        panels,
        bumps,
        rest,
        skin,
        lattice,
        whole,
        owner,
    )


def _made(work: Workpiece) -> None:
    """Make every part's pieces; panels first, what holds them last."""
    order = sorted(work.panels, key=lambda part: work.panels[part].is_lid)
    share_out(work)
    for part in order:
        carve_panel(work, part)
    make_bumps(work)
    for part in order:
        make_slab(work, part)
    if work.config.interior:
        for part in order:
            hollow_behind(work, part)
    hang_panels(work)
    make_rest(work, work.config.most_pieces // 2)
    make_body(work, work.config.most_pieces)
    for part, shelves in work.shelves.items():
        work.add_boards(0, shelves, work.panels[part])


def _rotated(articulation: Articulation, turn: FloatArray) -> Articulation:
    return articulation if np.array_equal(turn, np.eye(3)) else rotated(articulation, turn)


def _piece(hulls: tuple[Hull, ...], faces: int) -> SolidPieces | None:
    if not faces:
        return SolidPieces((), "none")
    return SolidPieces(hulls, "built") if hulls else None
