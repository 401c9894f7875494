"""A registered asset in a ManiSkill scene, with the resistances its manifest states."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from xml.etree import ElementTree

from .assets import RegisteredAsset

#: Skin, wood and plastic against a rubber fingertip.
SURFACE_FRICTION = 1.0
#: Speed at which a joint's friction is fully there [rad/s] or [m/s]; below it a joint creeps.
SLIP_SPEED = 1e-3
#: Fastest decay of motion that the simulation's step can follow [1/s].
MAX_DECAY = 50.0

# PhysX lets two shapes meet if one's first group word shares a bit with the other's second, unless their
# third words share one.
GROUND_GROUPS = (0b01, 0b00)
ASSET_GROUPS = (0b11, 0b10)
#: Bits 29 and 30 of the third word belong to ManiSkill's cabinets and to Fetch's wheels.
FREE_BITS = 29


def load_asset(scene: Any, asset: RegisteredAsset) -> Any:
    """Build the asset's articulation, root fixed, standing on the ground, joints still as PhysX has them."""
    import sapien

    loader = scene.create_urdf_loader()
    loader.name = asset.id
    loader.fix_root_link = True
    loader.set_material(SURFACE_FRICTION, SURFACE_FRICTION, 0.0)
    builder = loader.parse(str(asset.urdf))["articulation_builders"][0]
    builder.initial_pose = sapien.Pose(p=[0.0, 0.0, asset.ground_offset])
    articulation = builder.build(name=asset.id)
    for link in articulation.links:
        for word, value in enumerate(ASSET_GROUPS):
            link.set_collision_group(word, value)
    for bit, pair in enumerate(asset.ignored_contacts[:FREE_BITS]):
        for name in pair:
            articulation.links_map[name].set_collision_group_bit(2, bit, 1)
    _resist(articulation, asset)
    return articulation


def build_ground(scene: Any) -> Any:
    """A floor that carries robots; assets are fixed and may swing below it."""
    from mani_skill.utils.building.ground import build_ground as build_plane

    ground = build_plane(scene)
    for word, value in enumerate(GROUND_GROUPS):
        ground.set_collision_group(word, value)
    return ground


@contextmanager
def invisible_robots(scene: Any) -> Iterator[None]:
    """Let robots load whose URDF names materials, as Fetch's does, where nothing can render.

    SAPIEN's loader makes a render material of each, which needs a device, although ManiSkill drops every
    visual afterwards. Here the visuals are taken out of the text before it is parsed.
    """
    if scene.can_render():
        yield
        return
    from sapien.wrapper.urdf_loader import URDFLoader

    parse = URDFLoader._parse_urdf

    def parse_without_visuals(loader: Any, text: str) -> Any:
        robot = ElementTree.fromstring(text)
        for link in robot.iter("link"):
            for visual in link.findall("visual"):
                link.remove(visual)
        return parse(loader, ElementTree.tostring(robot, encoding="unicode"))

    URDFLoader._parse_urdf = parse_without_visuals
    try:
        yield
    finally:
        URDFLoader._parse_urdf = parse


def _resist(articulation: Any, asset: RegisteredAsset) -> None:
    """Give every joint its friction and damping.

    PhysX's joint friction is a coefficient on the joint's load, not a force, so it is set to zero. A
    velocity drive toward zero whose force is limited to the friction is Coulomb's law with a slip speed.
    That uses up the drive; damping becomes the link's own decay of motion, ``damping / inertia``, which for
    a link on a resting parent is the same law.
    """
    for joint in articulation.active_joints:
        data = asset.movable[joint.name]
        friction = float(data["friction"])
        joint.set_friction(0.0)
        joint.set_drive_properties(0.0, friction / SLIP_SPEED, force_limit=friction, mode="force")
        joint.set_drive_velocity_target(0.0)
        decay = min(float(data["damping"]) / float(data["inertia"]), MAX_DECAY)
        for body in articulation.links_map[data["child"]]._bodies:
            body.set_linear_damping(decay)
            body.set_angular_damping(decay)
