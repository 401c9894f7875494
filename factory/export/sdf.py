"""Asset -> SDFormat 1.9, or 1.11 for joints that follow others, which 1.9 has no word for.

Poses are written relative to the parent link, so that the text reads like the URDF's. Drake takes a
collision mesh for convex only where it is told so.
"""

from __future__ import annotations

from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from ..articulation import Joint
from ..geometry.colors import srgb_of
from ..runtime.numbers import magnitude
from .links import Layout, LinkLayout
from .text import DECIMALS_UNIT, vector, xml_text
from .urdf import inertia_words, joint_words
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
    _write(world, parent="world", child=layout.links[0].name)
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
    mass = repr(magnitude(link.inertial.mass))
    _write(inertial, pose=f"{vector(link.inertial.center)} 0 0 0", mass=mass)
    _write(SubElement(inertial, "inertia"), **inertia_words(link.inertial.tensor))
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
    _write(mesh, uri=file)
    return mesh


def _material(piece: VisualPiece) -> ElementTree.Element:
    """Write a colour, and a texture for renderers that take one; others read it beside the OBJ."""
    material = Element("material")
    red, green, blue = srgb_of(piece.material.color[:3])
    shown = vector([red, green, blue, piece.material.color[3]], DECIMALS_UNIT)
    _write(material, ambient=shown, diffuse=shown)
    if piece.texture is not None:
        metal = SubElement(SubElement(material, "pbr"), "metal")
        _write(metal, albedo_map=piece.texture.as_posix(), roughness="0.7", metalness="0")
    return material


def _joint(layout: Layout, link: LinkLayout, joint: Joint) -> ElementTree.Element:
    element = Element("joint", name=joint.name, type=str(joint.kind))
    _write(element, parent=layout.links[joint.parent].name, child=link.name)
    if not joint.movable:
        return element
    axis = SubElement(element, "axis")
    _write(axis, xyz=vector(joint.axis))
    words = joint_words(joint, link.resistance)
    for name in ("limit", "dynamics"):
        _write(SubElement(axis, name), **words[name])
    if joint.mimic is not None:
        # Drake has a word of its own.
        SubElement(element, "drake:mimic", words["mimic"])
        mimic = SubElement(axis, "mimic", joint=words["mimic"].pop("joint"))
        _write(mimic, **words["mimic"], reference="0")
    return element


def _write(element: ElementTree.Element, /, **texts: str) -> None:
    """Write elements of these names into another, each with a text."""
    for name, text in texts.items():
        SubElement(element, name).text = text
