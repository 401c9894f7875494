"""Asset -> URDF.

Written for the pickiest reader of each element: no ``<material>`` and no primitive visuals (SAPIEN
needs a renderer for those even when none is wanted; colour comes through the MTL instead), one file
per convex piece (SAPIEN and MuJoCo make one hull of whatever a file holds), explicit inertials
(each simulator guesses differently), limits on every joint that has them. Frames are parallel to
the object frame, so that every ``rpy`` is zero and is left out.

An asset without any joint becomes a valid URDF of one link, which MuJoCo and PyBullet load; SAPIEN
takes it for a plain actor, not an articulation.
"""

from __future__ import annotations

from itertools import combinations_with_replacement
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from ..articulation import Joint, JointKind
from ..mesh import FloatArray
from ..runtime.numbers import magnitude
from .links import Layout, LinkLayout
from .resistance import Resistance
from .text import number, vector, xml_text

#: Drives stronger than these serve no furniture [N m], [N].
EFFORT = {True: 200.0, False: 500.0}
#: [rad/s], [m/s].
VELOCITY = {True: 10.0, False: 5.0}


def urdf_text(layout: Layout) -> str:
    """Return the whole document; file names are relative to the bundle's folder."""
    root = Element("robot", name=layout.asset.name)
    root.extend(map(_link, layout.links))
    root.extend(_joint(layout, link, link.joint) for link in layout.links if link.joint is not None)
    return xml_text(root)


def _link(link: LinkLayout) -> ElementTree.Element:
    element = Element("link", name=link.name)
    inertial = SubElement(element, "inertial")
    SubElement(inertial, "origin", xyz=vector(link.inertial.center))
    SubElement(inertial, "mass", value=repr(magnitude(link.inertial.mass)))
    SubElement(inertial, "inertia", inertia_words(link.inertial.tensor))
    for piece in link.visuals:
        _mesh(SubElement(element, "visual", name=piece.name), piece.file.as_posix())
    for file in link.collisions:
        _mesh(SubElement(element, "collision", name=file.stem), file.as_posix())
    return element


def _mesh(parent: ElementTree.Element, file: str) -> None:
    SubElement(SubElement(parent, "geometry"), "mesh", filename=file)


def _joint(layout: Layout, link: LinkLayout, joint: Joint) -> ElementTree.Element:
    element = Element("joint", name=joint.name, type=str(joint.kind))
    SubElement(element, "parent", link=layout.links[joint.parent].name)
    SubElement(element, "child", link=link.name)
    SubElement(element, "origin", xyz=vector(link.offset))
    if not joint.movable:
        return element
    SubElement(element, "axis", xyz=vector(joint.axis))
    for name, words in joint_words(joint, link.resistance).items():
        SubElement(element, name, words)
    return element


def inertia_words(tensor: FloatArray) -> dict[str, str]:
    """Return the entries of an inertia tensor [kg m2] by names that SDFormat has too."""
    cells = combinations_with_replacement((0, 1, 2), 2)
    return {f"i{'xyz'[i]}{'xyz'[j]}": repr(magnitude(tensor[i, j])) for i, j in cells}


def joint_words(joint: Joint, resistance: Resistance) -> dict[str, dict[str, str]]:
    """Return what elements say of a joint that moves, in words that SDFormat has too."""
    limit = {"effort": number(EFFORT[joint.turns]), "velocity": number(VELOCITY[joint.turns])}
    if joint.kind is not JointKind.CONTINUOUS:
        limit = {"lower": number(joint.lower), "upper": number(joint.upper), **limit}
    damping = repr(magnitude(resistance.damping))
    friction = repr(magnitude(resistance.friction))
    words = {"limit": limit, "dynamics": {"damping": damping, "friction": friction}}
    if joint.mimic is not None:
        ratio = repr(magnitude(joint.mimic.multiplier))
        words["mimic"] = {"joint": joint.mimic.leader, "multiplier": ratio, "offset": "0"}
    return words
