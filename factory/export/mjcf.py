"""Asset -> MJCF.

The root body has no joint, so it is welded to the world. MuJoCo collides a moving body with a
*static* parent (PhysX and Bullet do not), so pairs that overlap on purpose need an
``<exclude>``.

MuJoCo's joint friction is a soft constraint: what it should hold creeps in proportion to
``1 - solimpfriction``. :data:`FRICTION_IMPEDANCE` makes that as little as MuJoCo allows.
"""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from ..articulation import Joint, JointKind
from ..geometry.colors import srgb_of
from ..runtime.layout import MESHES
from .links import Layout, LinkLayout
from .resistance import Resistance
from .text import DECIMALS_UNIT, number, scientific, vector, xml_text
from .visuals import VisualPiece

#: Impedance of joint friction: ``dmin dmax width``, here the same at any violation, and the most
#: that MuJoCo takes. Measured in 2 s at steps of 1/240 s, on a vertical slide and on a hinge with
#: its centre of mass 0.3 m out, friction 1.2 times the load: MuJoCo's default of 0.9 lets them
#: creep by 20.6 mm and 51 mrad, 0.99 by 1.96 mm and 4.8 mrad, 0.999 by 0.20 mm and 0.48 mrad,
#: 0.9999 by 0.020 mm and 0.048 mrad, 0.99999 by no less. Neither mass, armature, step nor more
#: friction changes this. Joints that are pushed move alike with 0.9 and 0.9999, to 0.01 %.
FRICTION_IMPEDANCE = "0.9999 0.9999 0.001"

#: What tells two appearances apart: linear RGBA, and the texture's file name below ``meshes``.
Look = tuple[tuple[float, float, float, float], str | None]


def mjcf_text(layout: Layout) -> str:
    """Return the whole document; file names are relative to the bundle's folder."""
    root = Element("mujoco", model=layout.asset.name)
    compiler = SubElement(root, "compiler", angle="radian", autolimits="true")
    compiler.attrib |= {"meshdir": MESHES, "texturedir": MESHES}
    root.append(_defaults())
    looks = _looks(layout)
    root.append(_assets(layout, looks))
    world = SubElement(root, "worldbody")
    bodies: list[ElementTree.Element] = []
    for link in layout.links:
        bodies.append(_body(link, looks))
        (world if link.joint is None else bodies[link.joint.parent]).append(bodies[-1])
    if layout.excluded_pairs:
        contact = SubElement(root, "contact")
        for first, second in layout.excluded_pairs:
            SubElement(contact, "exclude", body1=first, body2=second)
    _couple(root, layout)
    return xml_text(root)


def _couple(root: ElementTree.Element, layout: Layout) -> None:
    mimics = {joint.name: joint.mimic for joint in layout.asset.articulation.joints if joint.mimic}
    equality = SubElement(root, "equality") if mimics else root
    for name, mimic in mimics.items():
        ratio = scientific([mimic.multiplier])
        words = {"joint1": name, "joint2": mimic.leader, "polycoef": f"0 {ratio} 0 0 0"}
        SubElement(equality, "joint", words)


def _defaults() -> ElementTree.Element:
    default = Element("default")
    SubElement(default, "joint", solimpfriction=FRICTION_IMPEDANCE)
    visual = SubElement(default, "default", {"class": "visual"})
    SubElement(visual, "geom", type="mesh", group="2", contype="0", conaffinity="0", mass="0")
    # A panel without thickness encloses no volume, and MuJoCo asks every mesh for one.
    SubElement(visual, "mesh", inertia="shell")
    collision = SubElement(default, "default", {"class": "collision"})
    SubElement(collision, "geom", type="mesh", group="3", mass="0")
    SubElement(collision, "mesh", inertia="shell")
    return default


def _looks(layout: Layout) -> dict[Look, str]:
    """Return the names for the distinct appearances, in order of first use."""
    looks: dict[Look, str] = {}
    for files in layout.links:
        for piece in files.visuals:
            looks.setdefault(_look(piece), f"material_{len(looks)}")
    return looks


def _look(piece: VisualPiece) -> Look:
    return piece.material.color, None if piece.texture is None else _inside(piece.texture)


def _inside(path: Path) -> str:
    return path.as_posix().removeprefix(f"{MESHES}/")


def _assets(layout: Layout, looks: dict[Look, str]) -> ElementTree.Element:
    assets = Element("asset")
    for image in dict.fromkeys(texture for _, texture in looks if texture is not None):
        SubElement(assets, "texture", name=image, type="2d", file=image)
    for (color, texture), name in looks.items():
        textured = {} if texture is None else {"texture": texture}
        # Its renderer shows colours as they are written, and does not convert them to sRGB.
        shown = vector([*srgb_of(color[:3]), color[3]], DECIMALS_UNIT)
        words = {"name": name, **textured, "rgba": shown, "specular": "0.1"}
        SubElement(assets, "material", words)
    for files in layout.links:
        for piece in files.visuals:
            _mesh_asset(assets, "visual", _inside(piece.file))
        for file in files.collisions:
            _mesh_asset(assets, "collision", _inside(file))
    return assets


def _mesh_asset(assets: ElementTree.Element, kind: str, file: str) -> None:
    SubElement(assets, "mesh", {"name": file.removesuffix(".obj"), "class": kind, "file": file})


def _body(link: LinkLayout, looks: dict[Look, str]) -> ElementTree.Element:
    body = Element("body", name=link.name, pos=vector(link.offset))
    inertial = link.inertial
    cells = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    SubElement(
        body,
        "inertial",
        pos=vector(inertial.center),
        mass=scientific([inertial.mass]),
        fullinertia=scientific([inertial.tensor[cell] for cell in cells]),
    )
    if link.joint is not None and link.joint.movable:
        body.append(_joint(link.joint, link.resistance))
    for piece in link.visuals:
        mesh = _inside(piece.file).removesuffix(".obj")
        words = {"name": piece.name, "class": "visual", "mesh": mesh}
        SubElement(body, "geom", {**words, "material": looks[_look(piece)]})
    for file in link.collisions:
        mesh = _inside(file).removesuffix(".obj")
        words = {"name": f"collision_{file.stem}", "class": "collision", "mesh": mesh}
        SubElement(body, "geom", words)
    return body


def _joint(joint: Joint, resistance: Resistance) -> ElementTree.Element:
    kind = "hinge" if joint.turns else "slide"
    element = Element("joint", name=joint.name, type=kind, axis=vector(joint.axis))
    if joint.kind is not JointKind.CONTINUOUS:
        element.set("range", f"{number(joint.lower)} {number(joint.upper)}")
    element.set("damping", scientific([resistance.damping]))
    element.set("frictionloss", scientific([resistance.friction]))
    element.set("armature", scientific([resistance.armature]))
    return element
