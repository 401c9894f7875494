"""Hand poses to open a joint: closed around a target, or with the fingers behind a surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from asset_factory.sim_checks.geometry.placing import rigid

from ..assets import FloatArray
from .solids import Balls
from .world import RobotWorld

#: How far the hand leans out of the target's normal [rad], and how far behind the point its frame
#: gets [m].
LEANS = np.radians([0.0, 30.0, -30.0, 60.0, -60.0, 85.0, -85.0])
DEPTHS = (0.004, 0.016)
#: How much wider than the target a gripper has to open [m].
SLACK = 0.006
#: A surface is pushed on if it faces the motion by this cosine; so many points of all such surfaces
#: are tried.
FACING = -0.6
POINTS = 32
#: And dragged along if it moves along itself, but for this sine.
ALONG = 0.3
#: So far along the motion is it pressed, lest the fingertips press on what stays as well [m].
ALOFT = (0.0, 0.006, 0.012)
#: How far fingertips press onto a surface that they drag along [m], and how far in front of it they
#: stop.
PRESS_ON = 0.015
SHORT_OF = 0.004
#: How deep they would be in it by then, at the least [m].
INTO = 0.001
#: Distances of the fingers' middle from that surface [m]: lying against it, or coming to it tip
#: first.
BESIDE = (0.014, 0.022, 0.03)
#: Before it takes hold the hand is this far back [m], and must have been free all the way.
STANDOFF = 0.1
STATIONS = (0.0, 0.04, 0.1)


@dataclass(frozen=True)
class Grip:
    """One way to take hold.

    Attributes:
        kind: ``grasp`` closes the hand; ``push`` moves closed fingers against a surface; ``drag``
            presses them on one and takes it along.
        target: number of the asset's target; -1 for a place found on its surface.
        hand: pose of the hand frame in the world, shape [4, 4].
        score: 0 to 1, how much one would like it.
        label: of the try, to tell two apart.
        opening: between the fingers when they hold it [m]; 0 for closed ones.
    """

    kind: str
    target: int
    hand: FloatArray
    score: float
    label: tuple[object, ...]
    opening: float = 0.0


def grasps(world: RobotWorld, poses: FloatArray, seed: int = 0) -> list[Grip]:
    """Return every way to close the hand around a target narrow enough for it.

    ``poses`` are of the object's links.
    """
    found = []
    for target in world.targets:
        stated = target.stated
        if stated.kind != "grasp" or stated.opening_m + SLACK > 2.0 * world.robot.opening:
            continue
        pose = poses[target.link]
        point = pose[:3, :3] @ stated.point + pose[:3, 3]
        fingers = pose[:3, :3] @ stated.fingers
        ahead = -pose[:3, :3] @ stated.normal
        for (row, lean), flip, depth in product(enumerate(LEANS), (1.0, -1.0), DEPTHS):
            direction = Rotation.from_rotvec(lean * fingers).apply(ahead)
            hand = _hand(point + depth * direction, direction, flip * fingers)
            score = stated.score * (1.0 - 0.25 * abs(lean) / np.pi)
            label = (target.number, row, flip, depth)
            found.append(Grip("grasp", target.number, hand, score, label, stated.opening_m))
    return found


def pushes(world: RobotWorld, poses: FloatArray, seed: int = 0) -> list[Grip]:
    """Return ways to lay closed fingers against surfaces that face against the joint's motion."""
    points, normals, worth = _outer(world, poses, seed, along=False)
    directions = _directions()
    found = []
    for row, (point, normal) in enumerate(zip(points, normals, strict=True)):
        for column, ahead in enumerate(directions):
            facing = float(ahead @ normal)
            if facing > 0.5:
                continue
            tip_first = facing < -0.7
            ends = (ahead, _most_across(ahead)) if tip_first else (normal, ahead)
            side = np.cross(*ends)
            side /= np.linalg.norm(side)
            # Fingers lie against the surface with their narrow side, one beside the other.
            for roll, distance in product((0, 1), BESIDE):
                across = side if roll == 0 else np.cross(ahead, side)
                away = distance + (world.robot.length if tip_first else 0.0)
                hand = _hand(point + away * normal, ahead, across)
                score = worth[row] * (0.55 - 3.0 * distance - 0.05 * roll)
                found.append(Grip("push", -1, hand, score, (row, column, roll, distance)))
    return found


def drags(world: RobotWorld, poses: FloatArray, seed: int = 0) -> list[Grip]:
    """Return every way to press closed fingertips on a surface that slides along itself.

    Friction takes the surface along.
    """
    points, normals, worth = _outer(world, poses, seed, along=True)
    motion = _motion(world, poses, points)
    found = []
    for row, (point, normal) in enumerate(zip(points, normals, strict=True)):
        across = _most_across(normal)
        across = np.cross(normal, np.cross(across, normal))
        across /= np.linalg.norm(across)
        along = motion[row] / np.linalg.norm(motion[row])
        for (column, lean), turn, aloft in product(enumerate(LEANS[:3]), range(4), ALOFT):
            fingers = Rotation.from_rotvec(0.5 * np.pi * turn * normal).apply(across)
            ahead = Rotation.from_rotvec(lean * fingers).apply(-normal)
            place = point + aloft * along - (world.robot.length + SHORT_OF) * ahead
            hand = _hand(place, ahead, fingers)
            score = (0.2 - 3.0 * aloft) * worth[row]
            found.append(Grip("drag", -1, hand, score, (row, column, turn, aloft)))
    return _only_what_moves(world, found, poses)


def unobstructed(world: RobotWorld, grips: list[Grip], poses: FloatArray) -> list[Grip]:
    """Return those at which the hand itself hits nothing, there and on its way there.

    Of those that differ only in their distance from the surface the closest stays.
    """
    # A few points of the fingers rule most of them out.
    grips = _clear(world, grips, poses, world.balls.of(world.fingers, 6), (0.0,))
    grips = _clear(world, grips, poses, world.balls.of(world.fingers), (0.0,))
    kept = []
    seen = set()
    for grip in _clear(world, grips, poses, world.balls.of((*world.fingers, world.palm)), STATIONS):
        key = (grip.kind, grip.label[:-1] if grip.kind == "push" else grip.label)
        if key not in seen:
            seen.add(key)
            kept.append(grip)
    return kept


def _only_what_moves(world: RobotWorld, grips: list[Grip], poses: FloatArray) -> list[Grip]:
    """Return those whose fingers, pressed on, are in moving links and in no others."""
    if not grips:
        return []
    hands = np.array([grip.hand for grip in grips])
    hands[:, :3, 3] += PRESS_ON * hands[:, :3, 2]
    fingers = world.balls.of(world.fingers)
    points = _hand_points(world, fingers, hands, 0.0)
    stays = [link for link in range(len(poses)) if link not in world.carried]
    clear = (world.pieces.distance(points, poses[None], world.carried) - fingers.radius).min(axis=1)
    pressed = world.pieces.distance(points, poses[None], stays).min(axis=1)
    fine = (clear > 0.0) & (pressed < -INTO)
    return [grip for grip, ok in zip(grips, fine, strict=True) if ok]


def _clear(
    world: RobotWorld, grips: list[Grip], poses: FloatArray, balls: Balls, backs: Sequence[float]
) -> list[Grip]:
    """Return the grips where points of the hand are free, moved back by each of ``backs`` [m]."""
    fine = np.ones(len(grips), dtype=bool)
    for back, kind in product(backs, ("grasp", "push", "drag")):
        rows = np.flatnonzero(fine & np.array([grip.kind == kind for grip in grips], dtype=bool))
        if not len(rows):
            continue
        hands = np.array([grips[row].hand for row in rows])
        hands[:, :3, 3] -= back * hands[:, :3, 2]
        points = _hand_points(world, balls, hands, world.robot.opening if kind == "grasp" else 0.0)
        clear = world.pieces.distance(points, poses[None]) - balls.radius
        fine[rows] = (clear.min(axis=1) > 0.0) & (points[..., 2].min(axis=1) > 0.0)
    return [grip for grip, ok in zip(grips, fine, strict=True) if ok]


def _hand_points(world: RobotWorld, balls: Balls, hands: FloatArray, opening: float) -> FloatArray:
    """Return the points of the hand at some poses, shape [count, point, 3]."""
    values = np.zeros((1, len(world.chain.limits)))
    values[:, list(world.grippers)] = opening
    poses = world.chain.forward(values, np.eye(4))
    local = balls.placed(poses)[0]
    home = world.hand(poses)[0]
    local = (local - home[:3, 3]) @ home[:3, :3]
    return np.asarray(np.einsum("gij,pj->gpi", hands[:, :3, :3], local) + hands[:, None, :3, 3])


def _outer(
    world: RobotWorld, poses: FloatArray, seed: int, along: bool
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the points of outer surfaces [m], their normals, and what they are worth, 0 to 1.

    Surfaces that face against the motion, or, ``along``, those that move along themselves.
    """
    rng = np.random.default_rng(seed)
    points = []
    normals = []
    levers = []
    for piece in world.pieces.pieces:
        if piece.link not in world.carried:
            continue
        pose = poses[piece.link]
        spots, faces = trimesh.sample.sample_surface(piece.mesh, 400, seed=int(rng.integers(2**31)))
        spots = np.asarray(spots) @ pose[:3, :3].T + pose[:3, 3]
        outward = piece.normals[faces] @ pose[:3, :3].T
        speed = _motion(world, poses, spots)
        lever = np.linalg.norm(speed, axis=1)
        facing = np.einsum("pi,pi->p", outward, speed)
        chosen = np.abs(facing) < ALONG * lever if along else facing < FACING * lever
        points.append(spots[chosen])
        normals.append(outward[chosen])
        levers.append(lever[chosen])
    spots = np.concatenate(points)
    outward = np.concatenate(normals)
    lever = np.concatenate(levers)
    if not len(spots):
        return spots, outward, lever
    worth = lever / max(lever.max(), 1e-9)
    clear = world.pieces.distance((spots + 0.006 * outward)[None], poses[None])[0] > 0.003
    outer = clear & (worth > 0.3)
    return _spread(spots[outer], outward[outer], worth[outer])


def _motion(world: RobotWorld, poses: FloatArray, points: FloatArray) -> FloatArray:
    """Return where points of moving links go, shape [point, 3], per [rad] or [m] of the joint."""
    origin, axis = world.axis(poses)
    if world.object_chain.slides[world.mover]:
        return np.broadcast_to(axis, points.shape)
    return np.cross(axis, points - origin)


def _spread(
    points: FloatArray, normals: FloatArray, worth: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Select at most ``POINTS`` of them, far from one another and worth most."""
    chosen: list[int] = []
    gap = np.full(len(points), 0.3)
    for _ in range(min(POINTS, len(points))):
        best = int(np.argmax(gap * worth**2))
        if gap[best] < 0.01:
            break
        chosen.append(best)
        gap = np.minimum(gap, np.linalg.norm(points - points[best], axis=1))
    return points[chosen], normals[chosen], worth[chosen]


def _directions() -> FloatArray:
    """Return the 26 directions to the neighbours of a cube among cubes, shape [26, 3]."""
    steps = np.array([step for step in product((-1, 0, 1), repeat=3) if any(step)], dtype=float)
    return np.asarray(steps / np.linalg.norm(steps, axis=1)[:, None])


def _most_across(direction: FloatArray) -> FloatArray:
    return np.asarray(np.eye(3)[int(np.argmin(np.abs(direction)))])


def _hand(position: FloatArray, ahead: FloatArray, fingers: FloatArray) -> FloatArray:
    """Hand frame, shape [4, 4]."""
    return rigid(np.stack([np.cross(fingers, ahead), fingers, ahead], axis=1), position)
