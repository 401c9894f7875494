"""A solved episode as a video, drawn by rays: neither a GPU nor Vulkan is asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.ndimage import uniform_filter
from scipy.spatial import ConvexHull

from asset_factory.factory.display.camera import Camera, Viewpoint
from asset_factory.factory.display.casting import Caster, Hits, Shot
from asset_factory.factory.display.described import scene_of_file
from asset_factory.factory.display.made import plain_surface
from asset_factory.factory.display.pictures import Pixels, paint_still
from asset_factory.factory.display.scene import SceneGraph, SceneSurface, put_together
from asset_factory.factory.display.shading import light_direction, still

from ..assets import FloatArray
from ..robots import ROBOTS
from .attempt import Attempt
from .solve import make_episodes, replay
from .world import matrix_of

#: Control steps per second, and of how many one is drawn.
RATE = 20
EVERY = 2
#: Longest that a film may take [s]: far more than any took.
LONGEST_S = 1800.0
#: Of the pictures [pixels].
WIDTH = 640
HEIGHT = 480
#: Places around the scene from which the camera is chosen, moments that it is chosen by, and the
#: width of the pictures that it is chosen by [pixels].
PLACES = 16
MOMENTS = 5
ROUGH = 80
#: The floor's colour, sRGB; how much of it shadows leave, and how wide they blur, a share of the
#: picture's width.
FLOOR = np.array([226.0, 228.0, 230.0])
SHADOW = 0.75
BLUR = 0.012
#: A link moves whose pose changes by more in the film [m], or in a direction's parts.
STILL = 1e-4
#: Half the width of the post below a robot that is mounted above the floor [m].
POST_M = 0.09
POST_COLOR = (0.2, 0.21, 0.22, 1.0)

Values = Mapping[str, float]


@dataclass(frozen=True)
class FilmScene:
    """An episode, ready to be drawn.

    Attributes:
        scene: robot and asset, without the floor.
        values: joint values after the reset and after every action [rad] or [m].
        watched: the links that the film is about: the hand, and what it opens.
    """

    scene: SceneGraph
    values: tuple[Values, ...]
    watched: frozenset[int]


def film(registry: str, attempt: Attempt, path: Path) -> None:
    """Take an attempt's actions again, draw them, and write an MP4.

    Raises:
        InputRejected: the robot or the asset cannot be drawn, with a reason code.
    """
    import imageio.v2 as imageio

    made = read_film(registry, attempt)
    path.parent.mkdir(parents=True, exist_ok=True)
    writer: Any = imageio.get_writer(path, fps=RATE // EVERY, macro_block_size=8)
    with writer:
        for picture in draw_film(made, WIDTH, HEIGHT, EVERY):
            writer.append_data(picture)


def read_film(registry: str, attempt: Attempt) -> FilmScene:
    """Take the actions of an attempt again; return all that its film shows."""
    environment = make_episodes(registry, attempt.robot)
    task = environment.unwrapped
    seen: list[Values] = []
    try:
        replay(environment, attempt, lambda: seen.append(_values(task)))
        robot = scene_of_file(Path(task.agent.urdf_path))
        asset = scene_of_file(task.asset_record.urdf)
        where = {"robot": task.agent.robot, "asset": task._parts[0]}
        poses = {whose: matrix_of(actor.pose.sp) for whose, actor in where.items()}
    finally:
        environment.close()
    parts = {"robot": (robot, poses["robot"]), "asset": (asset, poses["asset"])}
    scene = put_together(attempt.asset, parts)
    hand = ROBOTS[attempt.robot]
    moved = next(joint.child for joint in scene.joints if joint.name == f"asset/{attempt.joint}")
    watched = {scene.links.index(f"robot/{name}") for name in (hand.palm, *hand.fingers)}
    scene = replace(scene, visuals=(*scene.visuals, *_post(poses["robot"][:3, 3])))
    return FilmScene(scene, tuple(seen), frozenset(watched | {moved}))


def draw_film(made: FilmScene, width: int, height: int, every: int = 1) -> Iterator[Pixels]:
    """Yield pictures of an episode, sRGB, shape [height, width, 3], one of every so many steps."""
    camera = _camera(made, width, height)
    caster = Caster(made.scene, made.scene.visuals)
    points = _floor_points(camera)
    poses = np.array([made.scene.poses(values) for values in made.values])
    moving = frozenset(np.flatnonzero((np.ptp(poses, axis=0) > STILL).any(axis=(1, 2))).tolist())
    under = paint_still(Shot(caster, camera, made.values[0]), moving)
    for values in made.values[::every]:
        shot = Shot(caster, camera, values)
        seen = still(shot, under)
        covered = seen[..., 3:] / 255.0
        floor = FLOOR * _floor_light(shot, points)[..., None]
        yield np.round(seen[..., :3] * covered + floor * (1.0 - covered)).astype(np.uint8)


def _values(task: Any) -> Values:
    """Return the values of all joints of robot and asset in a task's running episode."""
    found = {}
    for whose, actor in (("robot", task.agent.robot), ("asset", task._parts[0])):
        values = actor.get_qpos()[0].cpu().numpy()
        for joint, value in zip(actor.active_joints, values, strict=True):
            found[f"{whose}/{joint.name}"] = float(value)
    return found


def _post(foot: FloatArray) -> tuple[SceneSurface, ...]:
    """Return what a robot above the floor stands on; nothing below one on the floor."""
    if foot[2] < POST_M:
        return ()
    ends = [(at - POST_M, at + POST_M) for at in foot[:2]]
    corners = np.array(np.meshgrid(*ends, (0.0, foot[2]))).reshape(3, -1).T
    return (plain_surface(0, corners, ConvexHull(corners).simplices.astype(np.int64), POST_COLOR),)


def _camera(made: FilmScene, width: int, height: int) -> Camera:
    """Return the camera that sees the most of the hand and of what it opens."""
    last = len(made.values) - 1
    poses = [made.values[round(last * share)] for share in np.linspace(0.0, 1.0, MOMENTS)]
    view = Viewpoint(made.scene)
    caster = Caster(made.scene, made.scene.visuals)

    def shown(turn: float) -> int:
        rough = view.camera(ROUGH, ROUGH * height // width, *poses, turn=turn)
        seen = [Shot(caster, rough, values).see().link for values in poses]
        return sum(int(np.isin(each, list(made.watched)).sum()) for each in seen)

    turns = [2.0 * np.pi * place / PLACES for place in range(PLACES)]
    return view.camera(width, height, *poses, turn=max(turns, key=shown))


def _floor_points(camera: Camera) -> FloatArray:
    """Return where the floor is, behind every pixel, root frame [m], shape [pixels, 3].

    It is at height 0 and fills the picture: cameras look down on all of it.
    """
    columns, rows = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
    rays = camera.rays(np.stack([columns, rows], axis=-1).reshape(-1, 2))
    return np.asarray(camera.eye - rays * (camera.eye[2] / rays[:, 2:]))


def _floor_light(shot: Shot, points: FloatArray) -> FloatArray:
    """Return how much light falls on points of the floor, shape [height, width]."""
    light = light_direction(shot.camera)
    met = Hits.none(len(points))
    for index, link in shot.caster.links.items():
        corners = link.corners @ shot.poses[index][:3, :3].T + shot.poses[index][:3, 3]
        falls = (corners - light * (corners[:, 2:] / light[2]))[:, :2]
        near = (points[:, :2] >= falls.min(axis=0)) & (points[:, :2] <= falls.max(axis=0))
        own = np.flatnonzero(near.all(axis=1))
        directions = np.broadcast_to(light, (len(own), 3))
        link.meet(points[own], directions, shot.poses[index], own, met)
    share = np.where(np.isfinite(met.depth), SHADOW, 1.0).reshape(shot.camera.height, -1)
    return np.asarray(uniform_filter(share, int(BLUR * share.shape[1]) | 1))
