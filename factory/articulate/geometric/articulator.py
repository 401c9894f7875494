"""Articulation from geometry alone: no learning, few guesses, and each guess said."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...articulation import Articulation, Joint, Part
from ...config import BuildConfig
from ...geometry.components import connected_components
from ...intake.intake import Intake
from ...mesh import FloatArray, IntArray, Mesh
from ..naming import JOINT_SUFFIX, numbered
from ..rigid import rigid_articulation
from .fronts import find_fronts
from .house_doors import find_house_doors
from .knobs import find_top_knobs
from .lids import find_lid
from .movers import Mover
from .racks import find_racks
from .rounds import FROM_ABOVE, find_cap, find_turntables, find_wheels
from .scene import FRONT, SIDEWAYS, UP, Scene, level_yaw, quarter_turn

MOST_PIECES = 5000


class GeometricArticulator:
    """Finds what opens, turns and slides among the separate pieces of a closed, upright object.

    Doors with the baskets behind them, drawers, lids and screens; knobs, caps, levers, turntables
    and wheels.

    It prefers to leave something fixed over moving what does not move; notes say what it assumed.
    """

    name = "geometric"

    def articulate(self, mesh: Mesh) -> Articulation:
        """The mesh (metres, z up) with what opens as joints; else one rigid part and a note."""
        labels = connected_components(mesh)
        pieces = int(labels.max()) + 1 if len(labels) else 0
        if pieces <= 1:
            return rigid_articulation(
                mesh,
                self.name,
                ("the mesh is one connected surface: nothing can be told apart; kept rigid",),
            )
        if pieces > MOST_PIECES:
            note = (
                f"the mesh falls into {pieces} separate pieces, more than {MOST_PIECES}: kept rigid"
            )
            return rigid_articulation(mesh, self.name, (note,))
        scene = _level_scene(mesh, labels)
        if float(scene.size.min()) <= 1e-6 * float(scene.size.max()):
            return rigid_articulation(mesh, self.name, ("the mesh is flat: kept rigid",))
        movers = _best_view(scene) or tuple(
            _in_object_frame(m, scene.rotation) for m in _top(scene)
        )
        movers += tuple(_small_ones(scene, movers))
        moving = {int(piece) for mover in movers for piece in mover.pieces}
        if not movers or len(moving) == pieces:
            note = (
                f"none of the {pieces} separate pieces looks like a door, drawer or lid: kept rigid"
            )
            return rigid_articulation(mesh, self.name, (note,))
        return _assemble(mesh, labels, movers, self.name)


def articulator_for(intake: Intake, config: BuildConfig) -> GeometricArticulator:
    """Return the same one for every input."""
    return GeometricArticulator()


def _level_scene(mesh: Mesh, labels: IntArray) -> Scene:
    triangles = mesh.vertices[mesh.faces]
    yaw = level_yaw(triangles)
    scene = Scene(triangles, labels, np.eye(3))
    if yaw == 0.0:
        return scene
    c = np.cos(-yaw)
    s = np.sin(-yaw)
    return scene.turned(np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]))


def _best_view(scene: Scene) -> tuple[Mover, ...]:
    """What moves, seen from the side where most of it is; axes and origins in the object frame."""
    best: tuple[Mover, ...] = ()
    best_weight = 0.0
    for turns in range(4):
        view = scene.turned(quarter_turn(turns)) if turns else scene
        movers = find_fronts(view) or find_house_doors(view)
        doors = tuple(m for m in movers if m.label == "door")
        movers += find_racks(view, doors, _pieces_of(movers))
        weight = sum(m.weight for m in movers)
        if weight > best_weight * (1.0 + 1e-9):
            best = tuple(_in_object_frame(m, view.rotation) for m in movers)
            best_weight = weight
    return best


def _pieces_of(movers: tuple[Mover, ...]) -> IntArray:
    return np.array(
        sorted(int(piece) for mover in movers for piece in mover.pieces), dtype=np.int64
    )


def _top(scene: Scene) -> tuple[Mover, ...]:
    """Return what opens upwards, in the scene's frame."""
    return find_cap(scene) or find_lid(scene)


def _small_ones(scene: Scene, movers: tuple[Mover, ...]) -> Iterator[Mover]:
    """Knobs on top, turntables and wheels among the pieces that do not move yet; object frame."""
    taken = _pieces_of(movers)
    above = scene.turned(FROM_ABOVE)
    low = scene.size[UP] <= 0.5 * min(scene.size[SIDEWAYS], scene.size[FRONT])
    if low or any(m.label == "door" for m in movers):
        yield from (_in_object_frame(m, above.rotation) for m in find_top_knobs(above, taken))
    yield from (_in_object_frame(m, scene.rotation) for m in find_turntables(scene, taken))
    yield from (_in_object_frame(m, scene.rotation) for m in find_wheels(scene, taken))


def _in_object_frame(mover: Mover, rotation: FloatArray) -> Mover:
    axis = mover.axis @ rotation
    return replace(mover, axis=axis / np.linalg.norm(axis), origin=mover.origin @ rotation)


def _assemble(
    mesh: Mesh, labels: IntArray, movers: tuple[Mover, ...], articulator: str
) -> Articulation:
    owner = np.zeros(int(labels.max()) + 1, dtype=np.int64)
    parts: list[Part] = []
    joints: list[Joint] = []
    notes: list[str] = []
    names = numbered(mover.label for mover in movers)
    for index, (name, mover) in enumerate(zip(names, movers, strict=True), start=1):
        owner[mover.pieces] = index
        parts.append(Part(name, np.zeros(0, dtype=np.int64), guesses=mover.guesses))
        joints.append(
            Joint(
                name=f"{name}_{JOINT_SUFFIX[mover.kind]}",
                kind=mover.kind,
                parent=0,
                child=index,
                axis=mover.axis,
                origin=mover.origin,
                lower=mover.lower,
                upper=mover.upper,
            )
        )
        notes.extend(f"{name} {guess}" for guess in mover.guesses)
    face_owner = owner[labels]
    filled = [
        replace(part, faces=np.flatnonzero(face_owner == i))
        for i, part in enumerate(parts, start=1)
    ]
    base = Part("base", np.flatnonzero(face_owner == 0))
    return Articulation(mesh, (base, *filled), tuple(joints), articulator, tuple(notes))
