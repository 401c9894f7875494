"""Asset -> SDFormat 1.9, or 1.11 for joints that follow others, which 1.9 has no word for.

Poses are written relative to the parent link, so that the text reads like the URDF's. Drake takes a
collision mesh for convex only where it is told so.
"""

from __future__ import annotations

from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from ..articulation import Joint, JointKind
from ..geometry.colors import srgb_of
from ..runtime.numbers import magnitude
from .links import EFFORT, INERTIA_CELLS, VELOCITY, Layout, LinkLayout
from .text import DECIMALS_UNIT, number, vector, xml_text
from .visuals import VisualPiece

#: Declared because Drake's own elements are used.
DRAKE = "http://drake.mit.edu"


def sdf_text(layout: Layout) -> str:
    """Return the whole document; file names are relative to the bundle's folder."""
    coupled = any(joint.mimic is not None for joint in layout.asset.articulation.joints)
    root = Element("sdf", {"version": "1.11" if coupled else "1.9", "xmlns:drake": DRAKE})
    name = layout.asset.name
    model = SubElement(root, "model", name=name, canonical_link=layout.links[0].name)
    # It holds the asset in place, as a URDF's root link is held by who loads it.
    world = SubElement(model, "joint", name="world_joint", type="fixed")
    SubElement(world, "parent").text = "world"
    SubElement(world, "child").text = layout.links[0].name
    model.extend(_link(layout, link) for link in layout.links)
    joints = (_joint(layout, link, link.joint) for link in layout.links if link.joint is not None)
    model.extend(joints)
    for first, second in layout.excluded_pairs:
        group = SubElement(model, "drake:collision_filter_group", name=f"{first} {second}")
        for member in (first, second):
            SubElement(group, "drake:member").text = member
        SubElement(group, "drake:ignored_collision_filter_group").text = f"{first} {second}"
    return xml_text(root)


def _link(layout: Layout, link: LinkLayout) -> ElementTree.Element:
    element = Element("link", name=link.name)
    if link.joint is not None:
        pose = SubElement(element, "pose", relative_to=layout.links[link.joint.parent].name)
        pose.text = f"{vector(link.offset)} 0 0 0"
    inertial = SubElement(element, "inertial")
    SubElement(inertial, "pose").text = f"{vector(link.inertial.center)} 0 0 0"
    SubElement(inertial, "mass").text = repr(magnitude(link.inertial.mass))
    inertia = SubElement(inertial, "inertia")
    for name, cell in INERTIA_CELLS.items():
        SubElement(inertia, name).text = repr(magnitude(link.inertial.tensor[cell]))
    for piece in link.visuals:
        visual = SubElement(element, "visual", name=piece.name)
        _mesh(visual, piece.file.as_posix())
        visual.append(_material(piece))
    for file in link.collisions:
        mesh = _mesh(SubElement(element, "collision", name=file.stem), file.as_posix())
        SubElement(mesh, "drake:declare_convex")
    return element


def _mesh(parent: ElementTree.Element, file: str) -> ElementTree.Element:
    mesh = SubElement(SubElement(parent, "geometry"), "mesh")
    SubElement(mesh, "uri").text = file
    return mesh


def _material(piece: VisualPiece) -> ElementTree.Element:
    """Write a colour, and a texture for renderers that take one; others read it beside the OBJ."""
    material = Element("material")
    red, green, blue = srgb_of(piece.material.color[:3])
    shown = vector([red, green, blue, piece.material.color[3]], DECIMALS_UNIT)
    for kind in ("ambient", "diffuse"):
        SubElement(material, kind).text = shown
    if piece.texture is not None:
        metal = SubElement(SubElement(material, "pbr"), "metal")
        SubElement(metal, "albedo_map").text = piece.texture.as_posix()
        SubElement(metal, "roughness").text = "0.7"
        SubElement(metal, "metalness").text = "0"
    return material


def _joint(layout: Layout, link: LinkLayout, joint: Joint) -> ElementTree.Element:
    element = Element("joint", name=joint.name, type=str(joint.kind))
    SubElement(element, "parent").text = layout.links[joint.parent].name
    SubElement(element, "child").text = link.name
    if not joint.movable:
        return element
    axis = SubElement(element, "axis")
    SubElement(axis, "xyz").text = vector(joint.axis)
    limit = SubElement(axis, "limit")
    if joint.kind is not JointKind.CONTINUOUS:
        SubElement(limit, "lower").text = number(joint.lower)
        SubElement(limit, "upper").text = number(joint.upper)
    SubElement(limit, "effort").text = number(EFFORT[joint.turns])
    SubElement(limit, "velocity").text = number(VELOCITY[joint.turns])
    dynamics = SubElement(axis, "dynamics")
    SubElement(dynamics, "damping").text = repr(magnitude(link.resistance.damping))
    SubElement(dynamics, "friction").text = repr(magnitude(link.resistance.friction))
    if joint.mimic is not None:
        ratio = repr(magnitude(joint.mimic.multiplier))
        mimic = SubElement(axis, "mimic", joint=joint.mimic.leader)
        for word, value in (("multiplier", ratio), ("offset", "0"), ("reference", "0")):
            SubElement(mimic, word).text = value
        # Drake has a word of its own.
        told = {"joint": joint.mimic.leader, "multiplier": ratio, "offset": "0"}
        SubElement(element, "drake:mimic", told)
    return element
