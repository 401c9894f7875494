"""The articulator of stated parts: what a sidecar says opens, found on the mesh."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, islice, product

import numpy as np

from ...articulation import Articulation
from ...config import BuildConfig
from ...errors import InputRejected
from ...geometry.posing import posed
from ...geometry.triangles import face_areas
from ...intake.intake import Intake
from ...intake.stated import Stated, StatedPart
from ...mesh import BoolArray, IntArray, Mesh
from ...part import PartKind, Proposer
from ..articulator import Articulator, HypothesisMaker, make_hypotheses
from ..assembly import assembled
from ..proposal import Motion, Proposal
from ..rigid import rigid_articulation
from ..seams.cutting import CutMesh, Region, cut_along, inside
from .boxed import NOT_FOUND, USUAL, StatedBox, StatedWay, label_of
from .expecting import count_expected, keep_expected, proposals_on, require_some
from .placing import place_parts, stated_unit
from .seen import SeenMesh

NAME = "stated"
#: Whole hypotheses that are worth trying.
MOST_HYPOTHESES = 4
#: Sides of the mesh that was stated may differ so much from this one's, of the longest.
SAME_SHAPE = 0.05


@dataclass(frozen=True)
class StatedArticulator(HypothesisMaker):
    """Finds on a mesh the parts that somebody stated.

    Attributes:
        stated: what a sidecar says.
        guess: who is asked for parts that are stated without a place.
        proposer: who stated them.
        chances: probability of each, in their order; none where a person's word counts.
        seen: the mesh that is going to be asked about, with its sides.
    """

    name = NAME

    stated: Stated
    guess: Articulator | None = None
    proposer: Proposer = Proposer.SIDECAR
    chances: tuple[float, ...] = ()
    seen: SeenMesh | None = None

    def hypotheses(self, mesh: Mesh) -> tuple[Articulation, ...]:
        """Return the articulations that fit the statement, the likeliest first.

        All share one mesh: the given one, cut along the outlines of all their parts.

        Raises:
            InputRejected: ``stated_part_not_found``.
        """
        _refuse_other_size(mesh, self.stated)
        if not self.stated.opens:
            note = "its sidecar says that nothing opens"
            return (rigid_articulation(mesh, self.name, (note,)),)
        wanted = count_expected(self.stated.parts)
        if wanted:
            return self._filled(mesh, wanted)
        placed = self._placed_on(mesh)
        chosen = list(islice(_with_cut(_choices(placed)), MOST_HYPOTHESES))
        cut = cut_along(mesh, chain.from_iterable(_to_cut(ways) for ways in chosen))
        return tuple(self._articulation(cut, placed, ways) for ways in chosen)

    def beside(self, guess: Articulation) -> tuple[Articulation, ...]:
        """Return the stated parts beside all that moves in a guess, the likeliest first.

        Raises:
            InputRejected: ``stated_part_not_found``.
        """
        if not guess.movable_joints:
            return self.hypotheses(guess.mesh)
        return self._beside(guess, self._placed_on(guess.mesh))

    def _placed_on(self, mesh: Mesh) -> list[StatedBox]:
        """Return the stated parts that have a place, found on a mesh."""
        seen = self.seen or SeenMesh.of(mesh, self.stated.front)
        return place_parts(seen, self.stated.parts)

    def _beside(self, guess: Articulation, placed: Sequence[StatedBox]) -> tuple[Articulation, ...]:
        """Return the placed parts beside those of a guess, cut from the guess's mesh."""
        made = []
        hosts = [joint.parent for joint in guess.joints]
        for ways in islice(_with_cut(_choices(placed)), MOST_HYPOTHESES):
            cut = cut_along(guess.mesh, _to_cut(ways))
            filled = self._articulation(cut, placed, ways, proposals_on(cut, guess), hosts)
            made.append(replace(filled, weights=guess.weights))
        return tuple(made)

    def _filled(self, mesh: Mesh, wanted: Counter[PartKind]) -> tuple[Articulation, ...]:
        """Return the placed parts, and those that the guess has of expected ones."""
        if self.guess is None:
            bare = [part.view is None for part in self.stated.parts].index(True)
            raise InputRejected(
                NOT_FOUND,
                f"{label_of(self.stated.parts[bare], bare)}: has no side and box; want them for "
                "every part, or an articulator that looks for it, as auto does",
            )
        guesses = make_hypotheses(self.guess, mesh)
        placed = [self._placed_on(each.mesh) for each in guesses]
        kept = [keep_expected(*each, wanted) for each in zip(guesses, placed, strict=True)]
        made: list[Articulation] = []
        for place in require_some(kept, wanted):
            whole = not placed[place] and len(kept[place].parts) == len(guesses[place].parts)
            made += (guesses[place],) if whole else self._beside(kept[place], placed[place])
        return tuple(made[:MOST_HYPOTHESES])

    def _articulation(
        self,
        cut: CutMesh,
        placed: Sequence[StatedBox],
        ways: Sequence[StatedWay],
        guessed: Sequence[Proposal] = (),
        guessed_hosts: Sequence[int] = (),
    ) -> Articulation:
        """Return the placed parts beside the guessed ones, on a mesh cut for both."""
        hosts = _hosts(placed, ways)
        owner = _owners(cut, placed, ways, hosts)
        movers = [way.mover for way in ways]
        chances = self.chances or (None,) * len(placed)
        proposals = [
            Proposal(
                mover.kind,
                owner == number,
                _from_closed(each.stated, mover.motion),
                proposer=self.proposer,
                panel=mover.panel if each.stated.drawn is None else None,
                existence=chance,
                probability=chance,
                name=each.stated.name,
            )
            for number, (each, mover, chance) in enumerate(
                zip(placed, movers, chances, strict=True), start=1
            )
        ]
        drawn = {
            proposal.source.id
            for proposal, each in zip(proposals, placed, strict=True)
            if each.stated.drawn is not None
        }
        for proposal in guessed:
            left = proposal.faces & (owner == 0)
            if not left.any():
                sentence = f"a {proposal.kind} that is expected lies where stated parts are"
                raise InputRejected(NOT_FOUND, sentence)
            proposals.append(replace(proposal, faces=left))
            owner[left] = len(proposals)
        hosts += [len(placed) + host if host else 0 for host in guessed_hosts]
        return _closed(assembled(cut.mesh, owner, proposals, NAME, hosts), drawn)


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


def _with_cut(chosen: Iterable[tuple[StatedWay, ...]]) -> Iterator[tuple[StatedWay, ...]]:
    """Yield each choice, and after one with parts that are whole pieces the same cut out.

    A piece may be only a front that was set before what it opens, or hold more than what opens.
    """
    for ways in chosen:
        yield ways
        if any(len(way.faces) for way in ways):
            yield tuple(StatedWay(way.cut or way.mover) for way in ways)


def _to_cut(ways: Sequence[StatedWay]) -> Iterator[Region]:
    """Yield what those parts fill that are cut out of the mesh."""
    return (way.mover.region for way in ways if not len(way.faces))


def _choices(placed: Sequence[StatedBox]) -> Iterator[tuple[StatedWay, ...]]:
    """Yield one way for each part, those with the fewest unlikely ways first."""
    ways = [range(len(each.ways)) for each in placed]
    # Two ways for each of many parts are too many to sort; the unlikely ones are not tried anyway.
    choices = islice(product(*ways), 4096)
    for choice in sorted(choices, key=sum):
        yield tuple(each.ways[way] for each, way in zip(placed, choice, strict=True))


def _from_closed(part: StatedPart, motion: Motion) -> Motion:
    """Return a motion whose lower limit is the closed pose of a part that is drawn open."""
    if part.drawn is None or part.range is not None:
        return motion
    by = motion.upper if part.drawn == "open" else float(part.drawn) / stated_unit(motion)
    return replace(motion, lower=-by, upper=max(motion.upper - by, 0.0))


def _closed(made: Articulation, drawn: Collection[str]) -> Articulation:
    """Return an articulation whose parts of some proposals are closed: its new rest."""
    values = {
        joint.name: joint.lower
        for joint in made.joints
        if (source := made.parts[joint.child].source) is not None and source.id in drawn
    }
    return posed(made, values) if values else made


def _hosts(placed: Sequence[StatedBox], ways: Sequence[StatedWay]) -> list[int]:
    """Return the part that carries each, 0 for the body: as stated, else the panel under it."""
    numbers = {each.stated.name: number for number, each in enumerate(placed, start=1)}
    hosts = []
    for each, way in zip(placed, ways, strict=True):
        if each.stated.parent is not None:
            if each.stated.parent not in numbers:
                raise InputRejected(
                    NOT_FOUND,
                    f"{each.label}: its parent {each.stated.parent} has no side and box; want them",
                )
            hosts.append(numbers[each.stated.parent])
            continue
        under = [
            number
            for number, (other, below) in enumerate(zip(placed, ways, strict=True), start=1)
            if way.mover.kind not in USUAL
            and below.mover.kind in USUAL
            and below.mover.region.holds(way.mover.motion.origin)
        ]
        hosts.append(under[0] if under else 0)
    return hosts


def _owners(
    cut: CutMesh, placed: Sequence[StatedBox], ways: Sequence[StatedWay], hosts: Sequence[int]
) -> IntArray:
    """Return the part of each face, 0 for the body; carried parts claim their faces first.

    Raises:
        InputRejected: ``stated_part_not_found``: a part gets nothing, or less than half of the
            surface in its region.
    """
    mesh = cut.mesh
    owner = np.zeros(len(mesh.faces), dtype=np.int64)
    areas = face_areas(mesh)
    within_each = [_faces_of(cut, way) for way in ways]
    for index in sorted(range(len(ways)), key=lambda index: (hosts[index] == 0, index)):
        within = within_each[index]
        own = within & (owner == 0)
        carried = [number for number, host in enumerate(hosts, start=1) if host == index + 1]
        claimed = float(areas[within].sum())
        kept = float(areas[within & ((owner == 0) | np.isin(owner, carried))].sum())
        if not own.any() or kept < claimed / 2.0:
            taken = 100.0 * (1.0 - kept / claimed) if claimed else 100.0
            why = f"other stated parts take {taken:.0f} % of its surface"
            found = why if within.any() else "no surface of the mesh is in its box"
            raise InputRejected(NOT_FOUND, f"{placed[index].label}: {found}")
        owner[own] = index + 1
    if not (owner == 0).any():
        raise InputRejected(NOT_FOUND, "stated parts take all of the mesh: want a body beside them")
    return owner


def _faces_of(cut: CutMesh, way: StatedWay) -> BoolArray:
    """Return which faces are in a part's region, or of its pieces, shape [face_count]."""
    if len(way.faces):
        return np.isin(cut.source, way.faces)
    return inside(cut.mesh, way.mover.region)
