"""The articulator of stated parts: what a sidecar says opens, found on the mesh."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice, product

import numpy as np

from ...articulation import Articulation, rotation_about
from ...config import BuildConfig
from ...errors import InputRejected
from ...geometry.posing import posed
from ...geometry.triangles import face_areas
from ...intake.intake import Intake
from ...intake.stated import Stated, StatedPart
from ...mesh import FloatArray, IntArray, Mesh
from ...part import PartKind, Proposer
from ..articulator import Articulator, make_hypotheses
from ..assembly import JOINT_SUFFIX, assembled
from ..proposal import Hypothesis, Motion, Proposal
from ..rigid import rigid_articulation
from ..seams.articulator import cut_along
from ..seams.cutting import inside
from ..seams.placing import OpeningPart
from .placing import NOT_FOUND, USUAL, Placed, SeenMesh, place_parts, stated_unit

NAME = "stated"
#: Whole hypotheses that are worth trying.
MOST_HYPOTHESES = 4
#: A part must keep so much of the surface in its region that others claim too.
LEAST_OWN = 0.5
#: Sides of the mesh that was stated may differ so much from this one's, of the longest.
SAME_SHAPE = 0.05
#: Quarter turns about z that bring a stated front to -Y.
_TURNS: Mapping[str, int] = {"-y": 0, "-x": 1, "y": 2, "x": 3}


class StatedArticulator:
    """Finds on a mesh the parts that somebody stated.

    Args:
        stated: what a sidecar says.
        guess: who is asked for parts that are stated without a place.
        seen: the mesh that is going to be asked about, as :func:`seen_from` gives it.
    """

    name = NAME

    def __init__(
        self, stated: Stated, guess: Articulator | None = None, seen: SeenMesh | None = None
    ) -> None:
        self.stated = stated
        self.guess = guess
        self.seen = seen

    def articulate(self, mesh: Mesh) -> Articulation:
        """Return the likeliest hypothesis of ``mesh`` [m], z up."""
        return self.hypotheses(mesh)[0].articulation

    def hypotheses(self, mesh: Mesh) -> tuple[Hypothesis, ...]:
        """Return the articulations that fit what is stated, the likeliest first.

        All share one mesh: the given one, cut along the outlines of all their parts.

        Raises:
            InputRejected: ``stated_part_not_found``.
        """
        _refuse_other_size(mesh, self.stated)
        if not self.stated.opens:
            note = "its sidecar says that nothing opens"
            return (Hypothesis.of(rigid_articulation(mesh, self.name, (note,))),)
        places = [part.view is not None for part in self.stated.parts]
        if self.guess is not None and not any(places):
            return _as_expected(self.guess, mesh, self.stated)
        if not all(places):
            bare = places.index(False)
            raise InputRejected(
                NOT_FOUND,
                f"parts[{bare}] ({self.stated.parts[bare].kind}): has no side and box; want them "
                "for every part, or for none where the finding is left to the factory",
            )
        placed = _placed(self.seen or seen_from(mesh, self.stated.front), self.stated)
        chosen = list(islice(_choices(placed), MOST_HYPOTHESES))
        cut = cut_along(mesh, chosen)
        return tuple(Hypothesis.of(_articulation(cut.mesh, placed, ways)) for ways in chosen)


def articulator_for(intake: Intake, config: BuildConfig) -> StatedArticulator:
    """Return one for the parts that are stated beside an input.

    Raises:
        InputRejected: ``no_annotation``: none are.
    """
    if intake.stated is None:
        wanted = f"want {intake.name}.parts.json"
        raise InputRejected(
            "no_annotation", f"{intake.provenance.input}: no parts are stated beside it; {wanted}"
        )
    return StatedArticulator(intake.stated)


def _refuse_other_size(mesh: Mesh, stated: Stated) -> None:
    if stated.size is None:
        return
    shares = mesh.extents / mesh.extents.max()
    wanted = np.array(stated.size) / max(stated.size)
    off = float(np.abs(shares - wanted).max())
    if off > SAME_SHAPE:
        said = " : ".join(f"{each:.2f}" for each in wanted)
        here = " : ".join(f"{each:.2f}" for each in shares)
        raise InputRejected(
            NOT_FOUND,
            f"the sidecar is of a mesh whose sides are {said}, this one's are {here}; "
            "it states another mesh, or this one's up axis is wrong",
            value=off,
            unit="of the longest side",
            limit=SAME_SHAPE,
        )


def _as_expected(guess: Articulator, mesh: Mesh, stated: Stated) -> tuple[Hypothesis, ...]:
    """Return those hypotheses that have as many parts of each kind as are expected.

    Raises:
        InputRejected: ``stated_part_not_found``: none has.
    """
    found = make_hypotheses(guess, mesh)
    wanted: Counter[PartKind] = Counter()
    for part in stated.parts:
        wanted[part.kind] += part.count
    counted = [_kinds(each.articulation) for each in found]
    fit = [each for each, kinds in zip(found, counted, strict=True) if kinds == wanted]
    if fit:
        return tuple(fit)
    nearest = max(counted, key=lambda kinds: (kinds & wanted).total() - (kinds - wanted).total())
    sentences = [f"found {nearest[kind]} of {wanted[kind]} {kind}s" for kind in wanted | nearest]
    raise InputRejected(
        NOT_FOUND,
        f"{', '.join(sentences)}; state a side and a box for each",
        value=float((nearest & wanted).total()),
        unit="parts",
        limit=float(wanted.total()),
    )


def _kinds(articulation: Articulation) -> Counter[PartKind]:
    return Counter(articulation.parts[joint.child].kind for joint in articulation.movable_joints)


def seen_from(mesh: Mesh, front: str) -> SeenMesh:
    """Return a mesh turned so that a stated front is -Y."""
    return SeenMesh(mesh.turned(_turn(front)))


def _turn(front: str) -> FloatArray:
    return rotation_about([0.0, 0.0, 1.0], _TURNS[front] * np.pi / 2.0)


def _placed(seen: SeenMesh, stated: Stated) -> list[Placed]:
    """Return the stated parts, found on the turned mesh, turned back."""
    back = _turn(stated.front).T
    return [
        replace(each, ways=tuple(way.turned(back) for way in each.ways))
        for each in place_parts(seen, stated.parts)
    ]


def _choices(placed: Sequence[Placed]) -> Iterator[tuple[OpeningPart, ...]]:
    """Yield one way for each part, those with the fewest unlikely ways first."""
    ways = [range(len(each.ways)) for each in placed]
    # Two ways for each of many parts are too many to sort; the unlikely ones are not tried anyway.
    choices = islice(product(*ways), 4096)
    for choice in sorted(choices, key=sum):
        yield tuple(each.ways[way] for each, way in zip(placed, choice, strict=True))


def _articulation(
    mesh: Mesh, placed: Sequence[Placed], ways: Sequence[OpeningPart]
) -> Articulation:
    hosts = _hosts(placed, ways)
    owner = _owners(mesh, placed, ways, hosts)
    proposals = [
        Proposal(
            way.kind,
            owner == number,
            _from_closed(each.stated, way.motion),
            proposer=Proposer.SIDECAR,
            panel=way.panel if each.stated.drawn is None else None,
            handle=way.handle if each.stated.drawn is None else None,
        )
        for number, (each, way) in enumerate(zip(placed, ways, strict=True), start=1)
    ]
    stated = {
        proposal.source.id: each.stated for proposal, each in zip(proposals, placed, strict=True)
    }
    made = _named(assembled(mesh, owner, proposals, NAME, hosts), stated)
    return _closed(made, stated)


def _from_closed(part: StatedPart, motion: Motion) -> Motion:
    """Return a motion whose lower limit is the closed pose of a part that is drawn open."""
    if part.drawn is None:
        return motion
    by = motion.upper if part.drawn == "open" else float(part.drawn) / stated_unit(motion)
    return replace(motion, lower=-by, upper=max(motion.upper - by, 0.0))


def _closed(made: Articulation, stated: Mapping[str, StatedPart]) -> Articulation:
    """Return an articulation whose parts that are drawn open are closed, its new rest."""
    drawn = {
        joint.name: joint.lower
        for joint in made.joints
        if (source := made.parts[joint.child].source) is not None
        and stated[source.id].drawn is not None
    }
    return posed(made, drawn) if drawn else made


def _hosts(placed: Sequence[Placed], ways: Sequence[OpeningPart]) -> list[int]:
    """Return the part that carries each, 0 for the body: as stated, else the panel under it."""
    numbers = {each.stated.name: number for number, each in enumerate(placed, start=1)}
    hosts = []
    for each, way in zip(placed, ways, strict=True):
        if each.stated.parent is not None:
            hosts.append(numbers.get(each.stated.parent, 0))
            continue
        under = [
            number
            for number, (other, below) in enumerate(zip(placed, ways, strict=True), start=1)
            if each.stated.kind not in USUAL
            and other.stated.kind in USUAL
            and below.region.holds(way.motion.origin)
        ]
        hosts.append(under[0] if under else 0)
    return hosts


def _owners(
    mesh: Mesh, placed: Sequence[Placed], ways: Sequence[OpeningPart], hosts: Sequence[int]
) -> IntArray:
    """Return the part of each face, 0 for the body; what is carried claims its faces first.

    Raises:
        InputRejected: ``stated_part_not_found``: a part gets nothing, or hardly any of its own.
    """
    owner = np.zeros(len(mesh.faces), dtype=np.int64)
    areas = face_areas(mesh)
    for index in sorted(range(len(ways)), key=lambda index: (hosts[index] == 0, index)):
        within = inside(mesh, ways[index].region)
        own = within & (owner == 0)
        carried = [number for number, host in enumerate(hosts, start=1) if host == index + 1]
        claimed = float(areas[within].sum())
        kept = float(areas[within & ((owner == 0) | np.isin(owner, carried))].sum())
        if not own.any() or kept < LEAST_OWN * claimed:
            taken = 100.0 * (1.0 - kept / claimed) if claimed else 100.0
            why = f"other stated parts take {taken:.0f} % of its surface"
            found = why if within.any() else "no surface of the mesh is in its box"
            named = placed[index].stated.name or placed[index].stated.kind
            raise InputRejected(NOT_FOUND, f"parts[{index}] ({named}): {found}")
        owner[own] = index + 1
    return owner


def _named(made: Articulation, stated: Mapping[str, StatedPart]) -> Articulation:
    """Return an articulation whose parts are called as stated, by the id of their proposal."""
    parts = []
    joints = []
    for part in made.parts:
        name = stated[part.source.id].name if part.source is not None else None
        parts.append(replace(part, name=name or part.name))
    for joint in made.joints:
        suffix = JOINT_SUFFIX[joint.kind]
        joints.append(replace(joint, name=f"{parts[joint.child].name}_{suffix}"))
    return replace(made, parts=tuple(parts), joints=tuple(joints))
