"""From triangles to closed manifolds: the gate in front of everything native."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import manifold3d
import numpy as np
from manifold3d import Manifold
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order

from ...asset import Hull
from ...geometry.edges import SharedEdges, label_linked, shared_edges
from ...geometry.rows import distinct_rows
from ...geometry.triangles import doubled_normals
from ...mesh import BoolArray, FloatArray, IntArray
from .convex import begun_lowest

#: Less volume than this is nothing to collide with [m3]: a cube of a tenth of a millimetre.
LEAST_VOLUME_M3 = 1e-12
#: Points that are held against a solid at once.
TOGETHER = 64


@dataclass(frozen=True)
class OpenSurface:
    """An open piece of surface, consistently wound; which side is outside is not known.

    Attributes:
        vertices: [m], shape [vertex_count, 3].
        faces: shape [face_count, 3].
    """

    vertices: FloatArray
    faces: IntArray


@dataclass(frozen=True)
class Gated:
    """A triangle soup, sorted.

    Attributes:
        solids: closed connected manifolds of positive volume; they may overlap one another.
        cavities: closed manifolds turned outward, to be cut out of the solids.
        sheets: everything that encloses nothing.
    """

    solids: tuple[Manifold, ...]
    cavities: tuple[Manifold, ...]
    sheets: tuple[OpenSurface, ...]

    @property
    def body(self) -> Manifold:
        """Return all solids as one, without cavities but with the bodies loose in these."""
        found = union(list(self.solids))
        for cavity in sorted(self.cavities, key=lambda cavity: -cavity.volume()):
            found -= cavity
            found += union([solid for solid in self.solids if contains(cavity, solid)])
        return found


def manifold_of(vertices: FloatArray, faces: IntArray) -> Manifold | None:
    """Return a manifold of these triangles [m]; ``None`` unless they close and enclose something.

    The volume may be negative: an inverted body.
    """
    if not closes(faces):
        return None
    # Only the vertices in use, or a mesh of a thousand bodies is copied a thousand times; and a
    # copy, because the binding refuses read-only arrays.
    used, compact = np.unique(faces, return_inverse=True)
    triangles = np.array(compact.reshape(-1, 3), dtype=np.uint64, order="C")
    manifold = Manifold(
        manifold3d.Mesh64(np.array(vertices[used], dtype=np.float64, order="C"), triangles)
    )
    if manifold.status() != manifold3d.Error.NoError or not manifold.num_tri():
        return None
    return manifold if abs(manifold.volume()) > LEAST_VOLUME_M3 else None


def closes(faces: IntArray) -> bool:
    """Return whether every edge is walked as often one way as the other.

    Asked before anything native: manifold3d 3.5 dies of a segmentation fault on some open meshes.
    """
    # A tetrahedron has the fewest.
    if len(faces) < 4:
        return False
    starts = faces.ravel()
    ends = np.roll(faces, -1, axis=1).ravel()
    edges = np.column_stack([np.minimum(starts, ends), np.maximum(starts, ends)])
    _, edge = distinct_rows(edges)
    return not np.bincount(edge, weights=np.sign(ends - starts)).any()


def manifold_of_hull(hull: Hull) -> Manifold:
    """Return a hull as a manifold."""
    return Manifold.hull_points(np.array(hull.vertices))


def triangles_of(manifold: Manifold) -> tuple[FloatArray, IntArray]:
    """Return the vertices [m], shape [n, 3], and outward faces, shape [m, 3]."""
    mesh = manifold.to_mesh64()
    return (
        np.array(mesh.vert_properties[:, :3], dtype=np.float64, order="C"),
        np.array(mesh.tri_verts, dtype=np.int64, order="C"),
    )


def flipped(manifold: Manifold) -> Manifold:
    """Return the same surface wound the other way."""
    vertices, faces = triangles_of(manifold)
    turned = manifold_of(vertices, faces[:, ::-1])
    return manifold if turned is None else turned


def union(solids: list[Manifold]) -> Manifold:
    """Return the boolean union; empty for none."""
    return Manifold.batch_boolean(solids, manifold3d.OpType.Add) if solids else Manifold()


def thickness_m(solid: Manifold | None) -> float:
    """Return the mean thickness of a solid of sheets [m]; 0 of what encloses nothing."""
    return 0.0 if solid is None else 2.0 * float(solid.volume()) / float(solid.surface_area())


def volume_within(hulls: Iterable[Hull], others: Iterable[Hull]) -> float:
    """Return the volume of hulls that lies in any of others [m3]."""
    room = union([manifold_of_hull(other) for other in others])
    return sum(float((manifold_of_hull(hull) ^ room).volume()) for hull in hulls)


def gate(vertices: FloatArray, faces: IntArray) -> Gated:
    """Sort triangles, of welded positions [m], into solids, cavities and sheets.

    Duplicated faces count once, double-sided ones too; where the rest closes without these they are
    sheets. Inverted bodies are turned; a body that faces the other way than the outermost around it
    is a cavity.
    """
    faces = _without_repeats(vertices, faces)
    closed: list[Manifold] = []
    sheets: list[OpenSurface] = []
    for group in _grouped(component_labels(faces)):
        manifold = manifold_of(vertices, faces[group])
        if manifold is not None:
            closed += manifold.decompose()
            # A pane that hangs at its frame's corners is no part of the volume.
            panes = faces[group][_both_ways(faces[group])]
            sheets += [_compact(vertices, patch) for patch in two_sided_patches(panes)]
            continue
        for patch in two_sided_patches(faces[group]):
            manifold = manifold_of(vertices, patch)
            if manifold is not None:
                closed.append(manifold)
            else:
                sheets.append(_compact(vertices, patch))
    solids, cavities = _inside_out(closed)
    return Gated(tuple(solids), tuple(cavities), tuple(sheets))


def _without_repeats(vertices: FloatArray, faces: IntArray) -> IntArray:
    """Return the faces that have an area, each once, whichever corner it begins with."""
    faces = faces[np.linalg.norm(doubled_normals(vertices[faces]), axis=1) > 0.0]
    kept, _ = distinct_rows(begun_lowest(faces))
    return faces[np.sort(kept)]


def _both_ways(faces: IntArray) -> BoolArray:
    """Return the faces that are there twice, once each way, shape [m]."""
    _, label = distinct_rows(np.sort(faces, axis=1))
    return np.asarray(np.bincount(label)[label] > 1)


def component_labels(faces: IntArray) -> IntArray:
    """Return each face's component, connected by shared vertices, shape [face_count]."""
    used, compact = np.unique(faces, return_inverse=True)
    corners = compact.reshape(-1, 3)
    links = np.concatenate([corners[:, :2], corners[:, 1:]])
    return label_linked(len(used), links)[corners[:, 0]]


def _grouped(label: IntArray) -> list[IntArray]:
    """Return the indices that have each label, in the order of their first ones."""
    order = np.argsort(label, kind="stable")
    splits = np.flatnonzero(np.diff(label[order])) + 1
    groups = (group for group in np.split(order, splits) if len(group))
    return sorted(groups, key=lambda group: int(group[0]))


def two_sided_patches(faces: IntArray) -> list[IntArray]:
    """Split faces where over two meet at an edge; drop back sides, wind each patch one way.

    Faces have shape [m, 3], those of each patch [k, 3].
    """
    kept, _ = distinct_rows(np.sort(faces, axis=1))
    faces = faces[np.sort(kept)]
    shared = shared_edges(faces)
    patches = _grouped(label_linked(len(faces), shared.faces))
    flip = _flips(shared, len(faces), patches)
    wound = np.where(flip[:, None], faces[:, ::-1], faces)
    return [wound[patch] for patch in patches]


def _flips(shared: SharedEdges, count: int, patches: list[IntArray]) -> BoolArray:
    """Tell which of some faces to turn to wind each patch like its first face, shape [count]."""
    # Weight 1: wound alike, 2: not; an explicit zero would be no edge.
    weights = np.where(shared.forward[:, 0] != shared.forward[:, 1], 1, 2)
    graph = coo_matrix((weights, shared.faces.T), shape=(count, count)).tocsr()
    graph = graph.maximum(graph.T)
    flip = np.zeros(count, dtype=bool)
    for patch in (each for each in patches if len(each) > 1):
        order, parent = breadth_first_order(graph, patch[0], directed=False)
        before = parent[order[1:]]
        turned = np.asarray(graph[order[1:], before]).reshape(-1) == 2
        for face, known, turns in zip(order[1:], before, turned, strict=True):
            flip[face] = flip[known] ^ turns
    return flip


def _compact(vertices: FloatArray, faces: IntArray) -> OpenSurface:
    used, compact = np.unique(faces, return_inverse=True)
    return OpenSurface(vertices[used], compact.reshape(-1, 3).astype(np.int64))


def _inside_out(closed: list[Manifold]) -> tuple[list[Manifold], list[Manifold]]:
    """Return the bodies and the cavities among closed manifolds of either sign.

    A cavity faces the other way than the outermost body around it, inverted or not.
    """
    positive = [m for m in closed if m.volume() > LEAST_VOLUME_M3]
    negative = [flipped(m) for m in closed if m.volume() < -LEAST_VOLUME_M3]
    if not negative:
        return positive, []
    bodies = [*positive, *sorted(negative, key=lambda m: -m.volume())]
    order = sorted(range(len(bodies)), key=lambda number: -bodies[number].volume())
    hollow = set()
    for place, number in enumerate(order):
        larger = order[:place]
        upright = number < len(positive)
        turned = [other for other in larger if (other < len(positive)) != upright]
        if any(contains(bodies[other], bodies[number]) for other in turned):
            around = (other for other in larger if contains(bodies[other], bodies[number]))
            if next(around) in turned:
                hollow.add(number)
    solids = [body for number, body in enumerate(bodies) if number not in hollow]
    return solids, [bodies[number] for number in sorted(hollow)]


def contains(outer: Manifold, inner: Manifold) -> bool:
    """Return whether ``inner`` lies within ``outer``, up to a thousandth of its volume."""
    a = np.array(outer.bounding_box())
    b = np.array(inner.bounding_box())
    slack = 1e-9 + 1e-6 * float(np.abs(a).max())
    if (
        (b[:3] < a[:3] - slack).any()
        or (b[3:] > a[3:] + slack).any()
        or outer.volume() < inner.volume()
    ):
        return False
    return float((inner - outer).volume()) <= 1e-3 * float(inner.volume())


def inside(solid: Manifold, points: FloatArray) -> BoolArray:
    """Return which points [m], shape [n, 3], lie in a solid, by its winding number, shape [n].

    The solid angles are those of van Oosterom and Strackee 1983.
    """
    vertices, faces = triangles_of(solid)
    found = np.zeros(len(points), dtype=bool)
    for start in range(0, len(points), TOGETHER):
        arms = vertices[faces][None] - points[start : start + TOGETHER, None, None]
        lengths = np.linalg.norm(arms, axis=3)
        a, b, c = np.moveaxis(arms, 2, 0)
        la, lb, lc = np.moveaxis(lengths, 2, 0)
        over = np.einsum("ijk,ijk->ij", a, np.cross(b, c))
        under = (
            la * lb * lc
            + np.einsum("ijk,ijk->ij", a, b) * lc
            + np.einsum("ijk,ijk->ij", b, c) * la
            + np.einsum("ijk,ijk->ij", c, a) * lb
        )
        angles = 2.0 * np.arctan2(over, under).sum(axis=1)
        found[start : start + TOGETHER] = np.abs(angles) > 2.0 * np.pi
    return found
