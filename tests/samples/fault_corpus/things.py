"""Articulated things of convex pieces, in the world's frame with every joint at 0.

Written as URDF and MJCF.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from asset_factory.sim_checks.description import FloatArray, IntArray, Mimic
from asset_factory.sim_checks.geometry.placing import placed, rigid
from asset_factory.sim_checks.read import primitives


@dataclass(frozen=True)
class Body:
    """A rigid part.

    Attributes:
        name: of the link.
        pieces: corners of its convex collision pieces [m], world frame.
        frame: of the link in the world, shape [4, 4]; its joint sits in the origin.
        mass: [kg].
        looks: corners of its visible pieces; ``None`` for the same as ``pieces``.
    """

    name: str
    pieces: tuple[FloatArray, ...]
    frame: FloatArray
    mass: float
    looks: tuple[FloatArray, ...] | None = None


@dataclass(frozen=True)
class Move:
    """A joint: ``axis`` in the world's frame, limits [rad] or [m], and what it follows."""

    name: str
    kind: str
    parent: str
    child: str
    axis: tuple[float, float, float]
    lower: float
    upper: float
    mimic: Mimic | None = None


@dataclass(frozen=True)
class Thing:
    """Bodies, the first of which is the root, and one joint for each of the others."""

    name: str
    bodies: tuple[Body, ...]
    moves: tuple[Move, ...]


def box(center: Sequence[float], size: Sequence[float]) -> FloatArray:
    """Corners of a box [m], shape [8, 3]."""
    corners, _ = primitives.box(np.asarray(size, dtype=float))
    return corners + np.asarray(center, dtype=float)


def at(*origin: float) -> FloatArray:
    """A frame with the world's axes, shape [4, 4]."""
    return rigid(np.eye(3), np.array(origin, dtype=float))


def renewed(items: Iterable[Any], name: str, /, **changes: object) -> tuple[Any, ...]:
    """The items, of which the one of that name is changed."""
    return tuple(replace(item, **changes) if item.name == name else item for item in items)


def with_body(thing: Thing, name: str, **changes: object) -> Thing:
    """The thing with one body changed."""
    return replace(thing, bodies=renewed(thing.bodies, name, **changes))


def with_move(thing: Thing, name: str, **changes: object) -> Thing:
    """The thing with one joint changed."""
    return replace(thing, moves=renewed(thing.moves, name, **changes))


def moved(thing: Thing, pose: FloatArray, scale: float = 1.0) -> Thing:
    """The thing scaled about the world's origin, then moved rigidly, link frames turned along."""

    def points(corners: FloatArray) -> FloatArray:
        return scale * corners @ pose[:3, :3].T + pose[:3, 3]

    def frame(old: FloatArray) -> FloatArray:
        new = pose @ old
        new[:3, 3] = points(old[:3, 3])
        return new

    bodies = tuple(
        replace(
            body,
            pieces=tuple(points(piece) for piece in body.pieces),
            looks=None if body.looks is None else tuple(points(piece) for piece in body.looks),
            frame=frame(body.frame),
        )
        for body in thing.bodies
    )
    moves = []
    for move in thing.moves:
        x, y, z = pose[:3, :3] @ np.array(move.axis)
        size = scale if move.kind == "prismatic" else 1.0
        moves.append(
            replace(move, axis=(x, y, z), lower=size * move.lower, upper=size * move.upper)
        )
    return replace(thing, bodies=bodies, moves=tuple(moves))


def write_urdf(thing: Thing, folder: Path) -> Path:
    """A URDF with one OBJ for each convex piece, collision before visual."""
    links = "".join(_urdf_link(thing, body, folder) for body in thing.bodies)
    joints = "".join(_urdf_joint(thing, move) for move in thing.moves)
    path = folder / f"{thing.name}.urdf"
    path.write_text(f'<robot name="{thing.name}">{links}{joints}</robot>\n')
    return path


def write_mjcf(thing: Thing, folder: Path) -> Path:
    """The thing as MJCF: root fixed to the world, pieces as mesh geoms, visuals without contact."""
    meshes: list[str] = []
    tree = _mjcf_body(thing, thing.bodies[0], folder, meshes)
    path = folder / f"{thing.name}.xml"
    path.write_text(
        f'<mujoco model="{thing.name}"><compiler angle="radian"/>'
        f"<asset>{''.join(meshes)}</asset><worldbody>{tree}</worldbody>"
        f"{''.join(map(_mjcf_equality, thing.moves))}</mujoco>\n"
    )
    return path


def _urdf_link(thing: Thing, body: Body, folder: Path) -> str:
    center, tensor = _inertia(body)
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = tensor.tolist()
    shapes = [
        f'<{tag}><geometry><mesh filename="{file}"/></geometry></{tag}>'
        for tag, files in (
            ("collision", _write(body, folder)),
            ("visual", _write(body, folder, looks=True)),
        )
        for file in files
    ]
    return (
        f'<link name="{body.name}"><inertial><origin xyz="{words(center)}"/>'
        f'<mass value="{body.mass!r}"/>'
        f'<inertia ixx="{xx!r}" ixy="{xy!r}" ixz="{xz!r}" iyy="{yy!r}" iyz="{yz!r}" izz="{zz!r}"/>'
        "</inertial>"
        f"{''.join(shapes)}</link>\n"
    )


def _urdf_joint(thing: Thing, move: Move) -> str:
    parent = _body(thing, move.parent).frame
    child = _body(thing, move.child).frame
    origin = np.linalg.inv(parent) @ child
    turn = Rotation.from_matrix(origin[:3, :3])
    axis = child[:3, :3].T @ np.array(move.axis)
    return (
        f'<joint name="{move.name}" type="{move.kind}"><parent link="{move.parent}"/>'
        f'<child link="{move.child}"/>'
        f'<origin xyz="{words(origin[:3, 3])}" rpy="{words(turn.as_euler("xyz"))}"/>'
        f'<axis xyz="{words(axis)}"/>'
        f'<limit lower="{move.lower!r}" upper="{move.upper!r}" effort="50" velocity="2"/>'
        f"{_urdf_mimic(move.mimic)}</joint>\n"
    )


def _urdf_mimic(mimic: Mimic | None) -> str:
    if mimic is None:
        return ""
    rate = f'multiplier="{mimic.multiplier!r}" offset="{mimic.offset!r}"'
    return f'<mimic joint="{mimic.leader}" {rate}/>'


def _mjcf_equality(move: Move) -> str:
    if move.mimic is None:
        return ""
    rate = f"{move.mimic.offset!r} {move.mimic.multiplier!r} 0 0 0"
    pair = f'joint1="{move.name}" joint2="{move.mimic.leader}"'
    return f'<equality><joint {pair} polycoef="{rate}"/></equality>'


def _mjcf_body(thing: Thing, body: Body, folder: Path, meshes: list[str]) -> str:
    move = next((item for item in thing.moves if item.child == body.name), None)
    above = np.eye(4) if move is None else _body(thing, move.parent).frame
    origin = np.linalg.inv(above) @ body.frame
    x, y, z, w = Rotation.from_matrix(origin[:3, :3]).as_quat(canonical=True)
    center, tensor = _inertia(body)
    full = (tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[0, 2], tensor[1, 2])
    text = [
        f'<body name="{body.name}" pos="{words(origin[:3, 3])}" '
        f'quat="{words((w, x, y, z))}">'
        f'<inertial pos="{words(center)}" mass="{body.mass!r}" fullinertia="{words(full)}"/>'
    ]
    if move is not None:
        axis = body.frame[:3, :3].T @ np.array(move.axis)
        kind = "slide" if move.kind == "prismatic" else "hinge"
        text.append(
            f'<joint name="{move.name}" type="{kind}" axis="{words(axis)}" limited="true" '
            f'range="{move.lower!r} {move.upper!r}"/>'
        )
    for looks, extra in ((False, ""), (True, ' contype="0" conaffinity="0" group="2"')):
        for file in _write(body, folder, looks=looks):
            mesh = file.removesuffix(".obj")
            meshes.append(f'<mesh name="{mesh}" file="{file}"/>')
            text.append(f'<geom type="mesh" mesh="{mesh}"{extra}/>')
    held = (_body(thing, item.child) for item in thing.moves if item.parent == body.name)
    below = (_mjcf_body(thing, each, folder, meshes) for each in held)
    return "".join([*text, *below, "</body>"])


def _write(body: Body, folder: Path, *, looks: bool = False) -> list[str]:
    pieces = body.pieces if body.looks is None or not looks else body.looks
    files = []
    for index, corners in enumerate(pieces):
        hull = _hull(body, corners)
        file = f"{body.name}_{'seen' if looks else 'hull'}_{index}.obj"
        (folder / file).write_text(obj(hull.vertices, hull.faces))
        files.append(file)
    return files


def _inertia(body: Body) -> tuple[FloatArray, FloatArray]:
    """Centre [m] and tensor about it [kg m2] of the pieces at one density, in the link's frame."""
    pieces = body.pieces or (box((0, 0, 0), [0.1] * 3),)
    solid = trimesh.util.concatenate([_hull(body, corners) for corners in pieces])
    solid.density = body.mass / solid.volume
    return solid.center_mass, solid.moment_inertia


def _hull(body: Body, corners: FloatArray) -> trimesh.Trimesh:
    """A piece in its link's frame; most are written three times, and by many exhibits."""
    return _hull_of(placed(corners, np.linalg.inv(body.frame)).tobytes())


@cache
def _hull_of(points: bytes) -> trimesh.Trimesh:
    return trimesh.convex.convex_hull(np.frombuffer(points).reshape(-1, 3))


def _body(thing: Thing, name: str) -> Body:
    return next(body for body in thing.bodies if body.name == name)


def obj(vertices: FloatArray, faces: IntArray) -> str:
    """A mesh as the text of an OBJ file."""
    corners = "".join(f"v {words(vertex)}\n" for vertex in vertices)
    return corners + "".join("f {} {} {}\n".format(*(face + 1)) for face in faces)


def words(values: object) -> str:
    """Numbers as XML has them, exact to the last bit."""
    return " ".join(repr(float(value)) for value in np.asarray(values, dtype=float))
