"""The articulator of stated parts: what a sidecar says opens, found on the mesh."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice, product

import numpy as np

from ...articulation import Articulation, Joint, Part, rotation_about
from ...config import BuildConfig
from ...errors import InputRejected
from ...geometry.triangles import face_areas
from ...intake.intake import Intake
from ...intake.stated import Stated
from ...mesh import IntArray, Mesh
from ..naming import JOINT_SUFFIX, numbered
from ..rigid import rigid_articulation
from ..seams.cutting import CutMesh, cut_around, inside, uncut
from ..seams.placing import OpeningPart
from .placing import NOT_FOUND, Placed, place_parts

NAME = "stated"
#: Whole hypotheses that are worth trying.
MOST_HYPOTHESES = 4
#: A stated part must keep so much of the faces in its region that another one claims too.
LEAST_OWN = 0.5
#: Quarter turns about z that bring a stated front to -Y.
_TURNS = {"-y": 0, "-x": 1, "y": 2, "x": 3}


class StatedArticulator:
    """Finds on a mesh the parts that somebody stated."""

    name = NAME

    def __init__(self, stated: Stated) -> None:
        self.stated = stated

    def articulate(self, mesh: Mesh) -> Articulation:
        """Return the likeliest hypothesis of ``mesh`` (metres, z up)."""
        return self.readings(mesh)[0]

    def readings(self, mesh: Mesh) -> tuple[Articulation, ...]:
        """Return the articulations that fit what is stated, the likeliest first.

        All share one mesh: the given one, cut along the outlines of all their parts.

        Raises:
            InputRejected: ``stated_part_not_found``.
        """
        if not self.stated.opens:
            return (rigid_articulation(mesh, self.name, ("its sidecar says that nothing opens",)),)
        turn = rotation_about([0.0, 0.0, 1.0], _TURNS[self.stated.front] * np.pi / 2.0)
        pose = np.eye(4)
        pose[:3, :3] = turn
        placed = place_parts(mesh.transformed(pose), self.stated.parts)
        turned = [
            Placed(each.stated, tuple(way.turned(turn.T) for way in each.ways)) for each in placed
        ]
        chosen = list(islice(_hypotheses(turned), MOST_HYPOTHESES))
        cut = _cut(mesh, [way for ways in chosen for way in ways])
        return tuple(_articulation(cut, turned, ways) for ways in chosen)


def articulator_for(intake: Intake, config: BuildConfig) -> StatedArticulator:
    """Return one for what is stated beside an input.

    Raises:
        InputRejected: ``no_annotation``: nothing is.
    """
    if intake.stated is None:
        raise InputRejected(
            "no_annotation",
            f"{intake.provenance.input}: no parts are stated beside it; want "
            f"{intake.name}.parts.json",
        )
    return StatedArticulator(intake.stated)


def _hypotheses(placed: Sequence[Placed]) -> Iterator[tuple[OpeningPart, ...]]:
    """Yield one way for each part, those with the fewest unlikely ways first."""
    ways = [range(len(each.ways)) for each in placed]
    for choice in sorted(product(*ways), key=sum):
        yield tuple(each.ways[way] for each, way in zip(placed, choice, strict=True))


def _cut(mesh: Mesh, movers: Sequence[OpeningPart]) -> CutMesh:
    cut = uncut(mesh)
    done: list[OpeningPart] = []
    for mover in movers:
        if not any(mover.region.same(other.region) for other in done):
            cut = cut_around(cut, mover.region)
            done.append(mover)
    return cut


def _articulation(
    cut: CutMesh, placed: Sequence[Placed], ways: Sequence[OpeningPart]
) -> Articulation:
    parents = _parents(placed, ways)
    owner = _owners(cut.mesh, placed, ways, parents)
    labels = [each.stated.name or way.name for each, way in zip(placed, ways, strict=True)]
    named = [each.stated.name for each in placed]
    counted = iter(numbered(label for label, name in zip(labels, named, strict=True) if not name))
    names = [name or next(counted) for name in named]
    parts = [Part("base", np.flatnonzero(owner == 0))]
    joints = []
    for number, (name, way, parent) in enumerate(zip(names, ways, parents, strict=True), start=1):
        parts.append(
            Part(name, np.flatnonzero(owner == number), kind=placed[number - 1].stated.kind)
        )
        joints.append(
            Joint(
                name=f"{name}_{JOINT_SUFFIX[way.kind]}",
                kind=way.kind,
                parent=parent,
                child=number,
                axis=way.axis,
                origin=way.origin,
                lower=way.lower,
                upper=way.upper,
            )
        )
    return Articulation(cut.mesh, tuple(parts), tuple(joints), NAME, ())


def _parents(placed: Sequence[Placed], ways: Sequence[OpeningPart]) -> list[int]:
    """Return the part that carries each: as stated, else the one whose region holds its joint."""
    names = {each.stated.name: number for number, each in enumerate(placed, start=1)}
    parents = []
    for each, way in zip(placed, ways, strict=True):
        if each.stated.parent is not None:
            parents.append(names.get(each.stated.parent, 0))
            continue
        holders = [
            number
            for number, (other, region) in enumerate(
                zip(placed, (w.region for w in ways), strict=True), start=1
            )
            if other is not each
            and _is_control(each)
            and not _is_control(other)
            and region.holds(way.origin)
        ]
        parents.append(holders[0] if holders else 0)
    return parents


def _is_control(placed: Placed) -> bool:
    return not placed.stated.kind.closes_side and placed.stated.kind != "lid"


def _owners(
    mesh: Mesh, placed: Sequence[Placed], ways: Sequence[OpeningPart], parents: Sequence[int]
) -> IntArray:
    """Return the part of each face, 0 for the base; what is carried claims its faces first.

    Raises:
        InputRejected: ``stated_part_not_found``: a part gets nothing, or hardly any of its own.
    """
    owner = np.zeros(len(mesh.faces), dtype=np.int64)
    areas = face_areas(mesh)
    order = sorted(range(len(ways)), key=lambda index: (parents[index] == 0, index))
    for index in order:
        within = inside(mesh, ways[index].region)
        own = within & (owner == 0)
        carried = within & np.isin(owner, [k + 1 for k in order if parents[k] == index + 1])
        claimed = float(areas[within].sum())
        kept = float(areas[own | carried].sum())
        if not own.any() or kept < LEAST_OWN * claimed:
            taken = 100 * (1 - kept / claimed) if claimed else 0.0
            why = f"other stated parts take {taken:.0f} % of its surface"
            found = why if within.any() else "no surface of the mesh is in its box"
            named = placed[index].stated.name or placed[index].stated.kind
            raise InputRejected(NOT_FOUND, f"{named}: {found}")
        owner[own] = index + 1
    return owner
