"""Asset -> URDF.

Written for the pickiest reader of each element: no ``<material>`` and no primitive visuals (SAPIEN
needs a renderer for those even when none is wanted; colour comes through the MTL instead), one file
per convex piece (SAPIEN and MuJoCo make one hull of whatever a file holds), explicit inertials
(each simulator guesses differently), limits on every joint that has them. Frames are parallel to
the object frame, so that every ``rpy`` is zero and is left out.

An asset without any joint becomes a valid URDF of one link, which MuJoCo and PyBullet load; SAPIEN
takes it for a plain actor, not an articulation.
"""

from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from ..articulation import Joint, JointKind
from ..runtime.numbers import magnitude
from .links import EFFORT, INERTIA_CELLS, VELOCITY, Layout, child_offset, safe_tensor
from .resistance import Resistance
from .text import number, vector, xml_text


def urdf_text(layout: Layout) -> str:
    """Return the whole document; file names are relative to the bundle's folder."""
    root = Element("robot", name=layout.asset.name)
    for part in range(len(layout.links)):
        root.append(_link(layout, part))
    for joint, resistance in zip(layout.asset.articulation.joints, layout.resistances, strict=True):
        root.append(_joint(layout, joint, resistance))
    return xml_text(root)


def _link(layout: Layout, part: int) -> ElementTree.Element:
    files = layout.links[part]
    link = Element("link", name=files.name)
    link.append(_inertial(layout, part))
    for piece in files.visuals:
        _mesh(SubElement(link, "visual", name=piece.name), piece.file.as_posix())
    for file in files.collisions:
        _mesh(SubElement(link, "collision", name=file.stem), file.as_posix())
    return link


def _mesh(parent: ElementTree.Element, file: str) -> None:
    SubElement(SubElement(parent, "geometry"), "mesh", filename=file)


def _inertial(layout: Layout, part: int) -> ElementTree.Element:
    inertial = layout.asset.bodies[part].inertial
    tensor = safe_tensor(inertial)
    element = Element("inertial")
    center = inertial.center - layout.asset.articulation.link_frame(part)
    SubElement(element, "origin", xyz=vector(center))
    SubElement(element, "mass", value=repr(magnitude(inertial.mass)))
    cells = {name: repr(magnitude(tensor[cell])) for name, cell in INERTIA_CELLS.items()}
    SubElement(element, "inertia", cells)
    return element


def _joint(layout: Layout, joint: Joint, resistance: Resistance) -> ElementTree.Element:
    element = Element("joint", name=joint.name, type=str(joint.kind))
    SubElement(element, "parent", link=layout.links[joint.parent].name)
    SubElement(element, "child", link=layout.links[joint.child].name)
    SubElement(element, "origin", xyz=vector(child_offset(layout.asset.articulation, joint.child)))
    if not joint.movable:
        return element
    SubElement(element, "axis", xyz=vector(joint.axis))
    limit = {"effort": number(EFFORT[joint.turns]), "velocity": number(VELOCITY[joint.turns])}
    if joint.kind is not JointKind.CONTINUOUS:
        limit = {"lower": number(joint.lower), "upper": number(joint.upper), **limit}
    SubElement(element, "limit", limit)
    damping = repr(magnitude(resistance.damping))
    friction = repr(magnitude(resistance.friction))
    SubElement(element, "dynamics", damping=damping, friction=friction)
    return element
