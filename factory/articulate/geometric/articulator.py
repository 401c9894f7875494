"""Articulation from geometry alone: no learning, few guesses, and each guess said."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ...articulation import Articulation
from ...config import BuildConfig
from ...geometry.components import connected_components
from ...intake.intake import Intake
from ...mesh import IntArray, Mesh
from ...part import PartKind
from ..assembly import assembled
from ..proposal import Proposal
from ..rigid import rigid_articulation
from .fronts import find_fronts
from .house_doors import find_house_doors
from .knobs import find_top_knobs
from .movers import Mover
from .rounds import FROM_ABOVE, find_cap, find_turntables, find_wheels
from .scene import FRONT, SIDEWAYS, UP, Scene, level_frame, quarter_turn

MOST_PIECES = 5000


class GeometricArticulator:
    """Finds what opens, turns and slides among the separate pieces of a closed, upright object.

    Doors and drawers; knobs, caps, levers, turntables and wheels.

    It prefers to leave something fixed over moving what does not move; notes say what it assumed.
    """

    name = "geometric"

    def articulate(self, mesh: Mesh) -> Articulation:
        """Return ``mesh`` (metres, z up) with what opens as joints; else one rigid part and why."""
        found, why = _found(mesh)
        if not found:
            return rigid_articulation(mesh, self.name, (why,))
        owner = np.zeros(len(mesh.faces), dtype=np.int64)
        for number, proposal in enumerate(found, start=1):
            owner[proposal.faces] = number
        return assembled(mesh, owner, found, self.name)

    def proposals(self, mesh: Mesh) -> tuple[Proposal, ...]:
        """Return what opens, turns and slides of ``mesh`` (metres, z up)."""
        return _found(mesh)[0]


def articulator_for(intake: Intake, config: BuildConfig) -> GeometricArticulator:
    """Return the same one for every input."""
    return GeometricArticulator()


def _found(mesh: Mesh) -> tuple[tuple[Proposal, ...], str]:
    """Return the moving parts; or none, and a sentence that says why."""
    labels = connected_components(mesh)
    pieces = int(labels.max()) + 1 if len(labels) else 0
    if pieces <= 1:
        return (), "the mesh is one connected surface: nothing can be told apart; kept rigid"
    if pieces > MOST_PIECES:
        return (), (
            f"the mesh falls into {pieces} separate pieces, more than {MOST_PIECES}: kept rigid"
        )
    triangles = mesh.vertices[mesh.faces]
    scene = Scene(triangles, labels, np.eye(3)).turned(level_frame(triangles))
    if float(scene.size.min()) <= 1e-6 * float(scene.size.max()):
        return (), "the mesh is flat: kept rigid"
    movers = _best_view(scene) or tuple(m.seen_from(scene.rotation) for m in find_cap(scene))
    movers += tuple(_small_ones(scene, movers))
    if not movers or len(_pieces_of(movers)) == pieces:
        return (), (f"none of the {pieces} separate pieces looks like a door or drawer: kept rigid")
    return _proposals(labels, movers), ""


def _best_view(scene: Scene) -> tuple[Mover, ...]:
    """Return the moving parts, seen from the side that has most of them; object frame."""
    best: tuple[Mover, ...] = ()
    best_weight = 0.0
    for turns in range(4):
        view = scene.turned(quarter_turn(turns)) if turns else scene
        movers = find_fronts(view) or find_house_doors(view)
        weight = sum(m.weight for m in movers)
        if weight > best_weight * (1.0 + 1e-9):
            best = tuple(m.seen_from(view.rotation) for m in movers)
            best_weight = weight
    return best


def _pieces_of(movers: tuple[Mover, ...]) -> IntArray:
    return np.array(sorted({p for mover in movers for p in mover.pieces.tolist()}), dtype=np.int64)


def _small_ones(scene: Scene, movers: tuple[Mover, ...]) -> Iterator[Mover]:
    """Yield knobs on top, turntables and wheels among pieces that stay so far; object frame."""
    taken = _pieces_of(movers)
    above = scene.turned(FROM_ABOVE)
    low = scene.size[UP] <= 0.5 * min(scene.size[SIDEWAYS], scene.size[FRONT])
    if low or any(m.kind is PartKind.DOOR for m in movers):
        yield from (m.seen_from(above.rotation) for m in find_top_knobs(above, taken))
    yield from (m.seen_from(scene.rotation) for m in find_turntables(scene, taken))
    yield from (m.seen_from(scene.rotation) for m in find_wheels(scene, taken))


def _proposals(labels: IntArray, movers: Sequence[Mover]) -> tuple[Proposal, ...]:
    """Return the movers as proposals; a piece that several want belongs to the last of them."""
    owner = np.full(int(labels.max()) + 1, -1)
    for index, mover in enumerate(movers):
        owner[mover.pieces] = index
    return tuple(
        Proposal(
            mover.kind,
            owner[labels] == index,
            mover.motion,
            notes=mover.guesses,
            panel=mover.panel,
        )
        for index, mover in enumerate(movers)
    )
