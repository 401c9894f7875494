"""A registered asset in a ManiSkill scene, with the resistances its manifest states."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any
from xml.etree import ElementTree

from defusedxml.ElementTree import fromstring

from asset_factory.sim_checks.simulators.sapien_backend import couple_as_written

from .assets import RegisteredAsset, check_unaltered
from .geometry import drop_visuals

#: Skin, wood and plastic against a rubber fingertip.
SURFACE_FRICTION = 1.0
#: Speed at which a joint's friction is fully there [rad/s] or [m/s]; below it a joint creeps.
SLIP_SPEED = 1e-3
#: Fastest decay of motion that the simulation's step can follow [1/s].
MAX_DECAY = 50.0

# PhysX lets two shapes meet if one's first group word shares a bit with the other's second, unless
# their third words share one.
GROUND_GROUPS = (0b01, 0b00)
ASSET_GROUPS = (0b11, 0b10)
#: Bits 29 and 30 of the third word belong to ManiSkill's cabinets and to Fetch's wheels.
FREE_BITS = 29


def load_asset(scene: Any, asset: RegisteredAsset, name: str, index: int) -> Any:
    """Build the asset's articulation in one of the parallel scenes.

    Its root is fixed, it stands on the ground, and its joints move as freely as PhysX leaves them:
    see :func:`resist`. Its name is unique among all scenes.

    Raises:
        RegistryError: the asset was deleted or altered since it was registered.
    """
    import sapien

    check_unaltered(asset)
    loader = scene.create_urdf_loader()
    loader.name = name
    loader.fix_root_link = True
    loader.set_material(SURFACE_FRICTION, SURFACE_FRICTION, 0.0)
    builder = loader.parse(str(asset.urdf))["articulation_builders"][0]
    couple_as_written(builder)
    builder.initial_pose = sapien.Pose(p=[0.0, 0.0, asset.manifest.ground_offset])
    builder.set_scene_idxs([index])
    articulation = builder.build(name=name)
    for link in articulation.links:
        for word, value in enumerate(ASSET_GROUPS):
            link.set_collision_group(word, value)
    for bit, pair in enumerate(asset.manifest.excluded_pairs[:FREE_BITS]):
        for link_name in pair:
            articulation.links_map[link_name].set_collision_group_bit(2, bit, 1)
    return articulation


def build_ground(scene: Any) -> Any:
    """Return a floor that carries robots; assets are fixed and may swing below it."""
    from mani_skill.utils.building.ground import build_ground as build_plane

    ground = build_plane(scene)
    for word, value in enumerate(GROUND_GROUPS):
        ground.set_collision_group(word, value)
    return ground


@contextmanager
def replaced(owner: Any, name: str, value: Any) -> Iterator[None]:
    """Have an attribute of somebody else's module or class be another within this."""
    before = getattr(owner, name)
    setattr(owner, name, value)
    try:
        yield
    finally:
        setattr(owner, name, before)


@contextmanager
def invisible_robots(scene: Any) -> Iterator[None]:
    """Let robots load whose URDF names materials, as Fetch's does, where nothing can render.

    SAPIEN's loader makes a render material of each, which needs a device, although ManiSkill drops
    every visual afterwards. Here the visuals are taken out of the text before it is parsed.
    """
    if scene.can_render():
        yield
        return
    from sapien.wrapper.urdf_loader import URDFLoader

    parse = URDFLoader._parse_urdf

    def parse_without_visuals(loader: Any, text: str) -> Any:
        robot = fromstring(text)
        drop_visuals(robot)
        return parse(loader, ElementTree.tostring(robot, encoding="unicode"))

    with replaced(URDFLoader, "_parse_urdf", parse_without_visuals):
        yield


def resist(
    articulation: Any, asset: RegisteredAsset, friction_factor: float, damping_factor: float
) -> None:
    """Give every joint its friction and damping, multiplied by the factors.

    PhysX's joint friction is a coefficient on the joint's load, not a force, so it is set to zero.
    A velocity drive toward zero whose force is limited to the friction is Coulomb's law with a slip
    speed. That uses up the drive; damping becomes the link's own decay of motion, ``damping /
    inertia``, which for a link on a resting parent is the same law. On a GPU all this has to be set
    before the first step.
    """
    movable = asset.manifest.movable
    for joint in articulation.active_joints:
        data = movable[joint.name]
        friction = friction_factor * data.friction
        joint.set_friction(0.0)
        joint.set_drive_properties(0.0, friction / SLIP_SPEED, force_limit=friction, mode="force")
        decay = min(damping_factor * data.damping / data.inertia, MAX_DECAY)
        for body in articulation.links_map[data.child]._bodies:
            body.set_linear_damping(decay)
            body.set_angular_damping(decay)


def warn_of_hulls(assets: Iterable[RegisteredAsset]) -> None:
    """Say of which assets the validator found that PhysX simulates their hulls badly on a GPU."""
    reports = {asset.id: asset.report for asset in assets}
    unfit = [id for id, told in reports.items() if told is not None and told.gpu_ready == "no"]
    if unfit:
        hulls = "hulls that PhysX refuses on a GPU, or simulates badly there"
        which = f"{len(unfit)} of {len(reports)} assets have {hulls}; the first is {unfit[0]!r}"
        warnings.warn(f"{which}; `factory show` says why", stacklevel=3)
