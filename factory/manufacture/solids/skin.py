"""Which parts get a body by construction: patches of one surface, and bare front plates."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation, JointKind
from ...geometry.components import connected_components
from ...geometry.edges import shared_edges
from ...geometry.posing import face_parts
from ...mesh import BoolArray, IntArray, Mesh
from ...part import Proposer
from ...views.crossings import Crossings, crossings
from ...views.raster import Raster, Side, side_facing
from .panel import opens

#: A part is a patch of a skin where it shares so much of its border with other parts, of the
#: diagonal of its own box. Bodies of their own share none: every edge of theirs has two own faces.
SHARED_BORDER = 0.25
#: A drawer deeper than this share of the object has a box of its own.
PLATE = 0.3
#: A door is in front of something solid where so many rays meet a surface within this share of the
#: object's depth behind it.
SOLID = 0.6
NEAR = 0.06
#: Along the longest extent of an object [pixels].
PIXELS = 96
#: Of a part's rectangle this is left out on every side: frames, rims, hinges.
INSET = 0.15


def skin_parts(articulation: Articulation) -> tuple[int, ...]:
    """Return the moved parts that are open patches of the surface they share with others.

    The figure: length of the edges that a part shares with another one and with no second face of
    its own, over the diagonal of the part's box. Half a door's outline is more than a diagonal;
    parts that are closed, however closely they touch, and sheets that merely lie on others, have 0.
    """
    vertices = articulation.mesh.vertices
    edges, both = border(articulation.mesh, face_parts(articulation))
    length = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    shared = np.bincount(both.T.ravel(), np.tile(length, 2), len(articulation.parts))
    return tuple(
        joint.child
        for joint in articulation.joints
        if len(articulation.parts[joint.child].faces)
        and shared[joint.child] > SHARED_BORDER * articulation.part_mesh(joint.child).diagonal
    )


def parts_to_build(articulation: Articulation, fronts: bool = False) -> tuple[int, ...]:
    """Return the moved parts to be rebuilt: patches of a one-piece mesh, and bare fronts.

    With ``fronts`` every thin front, bare or not.
    """
    found = plates(articulation) if fronts else bare_fronts(articulation)
    patches = (part for part in skin_parts(articulation) if not _has_box(articulation, part))
    return tuple(sorted({*patches, *found}))


def _has_box(articulation: Articulation, part: int) -> bool:
    """Tell whether a part is a drawer of pieces of its own, with all that slides behind its front.

    Edges of single sheets may lie on its frame's, and are the same then.
    """
    panel = articulation.parts[part].panel
    if panel is None or articulation.joints[part - 1].kind is not JointKind.PRISMATIC:
        return False
    if not panel.has_box(float((articulation.part_mesh(part).vertices @ panel.frame[2]).max())):
        return False
    pieces = connected_components(articulation.mesh)
    own = face_parts(articulation) == part
    return not np.isin(pieces[own], pieces[~own]).any()


def border(mesh: Mesh, part: IntArray) -> tuple[IntArray, IntArray]:
    """Return the edges between exactly two faces of different parts.

    Returns:
        Vertices, shape [n, 2], and the two parts, shape [n, 2].
    """
    shared = shared_edges(mesh.faces)
    both = part[shared.faces]
    apart: BoolArray = both[:, 0] != both[:, 1]
    return shared.vertices[apart], both[apart]


def plates(articulation: Articulation) -> dict[int, Side]:
    """Return the thin panels of upright sides, hung on the body, and the side of each.

    Stated parts are none: they were modelled so on purpose.
    """
    found = {}
    for joint in articulation.joints:
        part = articulation.parts[joint.child]
        if part.is_by(Proposer.ANNOTATION) or joint.parent or part.panel is None:
            continue
        if not part.kind.closes_side or not opens(joint, part.panel):
            continue
        away = part.panel.frame[2]
        depth = float(np.ptp(articulation.part_mesh(joint.child).vertices @ away))
        if depth <= PLATE * float(np.ptp(articulation.mesh.vertices @ away)):
            found[joint.child] = side_facing(part.panel.outward)
    return found


def bare_fronts(articulation: Articulation) -> tuple[int, ...]:
    """Return drawers that are front plates alone, and doors whose back is solid."""
    found = plates(articulation)
    slides = {part for part in found if articulation.joints[part - 1].kind is JointKind.PRISMATIC}
    mesh = articulation.mesh
    crossed = {
        side: crossings(mesh, Raster.around(mesh, side, PIXELS))
        for side in {found[part] for part in found if part not in slides}
    }
    return tuple(
        part
        for part, side in found.items()
        if part in slides or _solid_behind(articulation, part, crossed[side]) >= SOLID
    )


def _solid_behind(articulation: Articulation, part: int, crossed: Crossings) -> float:
    """Return the share of a plate soon behind which there is a surface of something else."""
    mesh = articulation.mesh
    side = crossed.raster.side
    own = np.zeros(len(mesh.faces), dtype=np.bool_)
    own[articulation.parts[part].faces] = True
    local = articulation.part_mesh(part).vertices @ side.frame.T
    low = local[:, :2].min(axis=0)
    high = local[:, :2].max(axis=0)
    inset = INSET * (high - low)
    window = np.zeros((crossed.raster.rows, crossed.raster.columns), dtype=np.bool_)
    window[crossed.raster.window(low + inset, high - inset)] = True
    far = float(local[:, 2].max()) - crossed.raster.near
    reach = far + NEAR * float(np.ptp(mesh.vertices @ side.frame[2]))
    mine = own[crossed.face]
    front = np.full(crossed.raster.rows * crossed.raster.columns, np.inf)
    np.minimum.at(front, crossed.pixel[mine], crossed.depth[mine])
    behind = ~mine & (crossed.depth > front[crossed.pixel]) & (crossed.depth <= reach)
    met = np.zeros(len(front), dtype=np.bool_)
    met[crossed.pixel[behind]] = True
    looked = window.ravel() & np.isfinite(front)
    return float(met[looked].mean()) if looked.any() else 0.0
