"""Elements of a URDF as written: http://wiki.ros.org/urdf/XML."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass, field, replace

import numpy as np

from ..description import ABSURD, DescriptionError, FloatArray, JointLine, Mimic, sensible
from ..geometry.placing import rigid

#: What a shape is sized by, and how many numbers that is.
SIZES = {
    "box": (("size", 3),),
    "cylinder": (("radius", 1), ("length", 1)),
    "capsule": (("radius", 1), ("length", 1)),
    "sphere": (("radius", 1),),
}
#: The entries of an inertia tensor on and above its diagonal, row by row.
TENSOR = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


@dataclass(frozen=True)
class UrdfGeometry:
    """The shape of a visual or collision, in its own frame.

    Attributes:
        kind: ``mesh``, or one of :data:`SIZES`.
        size: edges of a box, radius of a sphere, radius and length of others [m]; empty for a mesh.
        file: how a mesh is referred to.
        scale: of a mesh, shape [3].
    """

    kind: str
    size: tuple[float, ...] = ()
    file: str = ""
    scale: FloatArray = field(default_factory=lambda: np.ones(3))


@dataclass(frozen=True)
class UrdfElements:
    """Reads elements, each by itself.

    Attributes:
        lenient: read commas between numbers as spaces, and no number at all as nothing said; let
            names be absent, and leave out of joints what only engines need.
    """

    lenient: bool = False

    def joint(self, element: ET.Element) -> JointLine:
        """Return a ``<joint>``.

        Where the reader is lenient, a ``<limit>`` that states no end is no limit.

        Raises:
            DescriptionError: with a stable code.
        """
        name = self.name(element)
        where = f"joint {name!r}"
        kind = element.get("type", "")
        limits = self._limits(element.find("limit"), kind, where)
        ends = (self._end(element, "parent", where), self._end(element, "child", where))
        origin = self.origin(element, where)
        item = element.find("axis")
        axis = np.array([1.0, 0.0, 0.0])
        if item is not None:
            axis = self.vector(item, "xyz", where, "1 0 0" if self.lenient else None)
        line = JointLine(name, kind, *ends, origin, axis, *limits)
        return line if self.lenient else _driven(line, element, where)

    def name(self, element: ET.Element) -> str:
        """Return an element's name."""
        name = element.get("name", "")
        if not name and not self.lenient:
            raise DescriptionError("missing_name", f"a <{element.tag}> has no name")
        return name

    def _end(self, element: ET.Element, tag: str, where: str) -> str:
        item = element.find(tag)
        link = "" if item is None else item.get("link", "")
        if not link and not self.lenient:
            raise DescriptionError("missing_element", f"{where}: no <{tag} link=...>")
        return link

    def _limits(
        self, limit: ET.Element | None, kind: str, where: str
    ) -> tuple[float | None, float | None]:
        if limit is None or kind in ("continuous", "fixed", "floating"):
            return None, None
        if self.lenient and limit.get("lower") is None and limit.get("upper") is None:
            return None, None
        return number(limit, "lower", where, 0.0), number(limit, "upper", where, 0.0)

    def origin(self, element: ET.Element, where: str) -> FloatArray:
        """Return the pose in an element's ``<origin>``, shape [4, 4].

        It turns about the fixed axes x, y and z.
        """
        from scipy.spatial.transform import Rotation

        item = element.find("origin")
        if item is None:
            return np.eye(4)
        turn = Rotation.from_euler("xyz", self.vector(item, "rpy", where, "0 0 0"))
        return rigid(turn.as_matrix(), self.vector(item, "xyz", where, "0 0 0"))

    def geometry(self, shape: ET.Element, where: str) -> UrdfGeometry | None:
        """Return the geometry of a ``<visual>`` or ``<collision>``; ``None`` where it has none.

        Raises:
            DescriptionError: ``unknown_geometry``, ``invalid_size`` or one of its numbers'.
        """
        geometry = shape.find("geometry")
        item = None if geometry is None else next(iter(geometry), None)
        if item is None:
            return None
        if item.tag == "mesh":
            scale = self.vector(item, "scale", where, "1 1 1")
            return UrdfGeometry("mesh", file=item.get("filename", ""), scale=scale)
        if item.tag not in SIZES:
            message = f"{where}: <{item.tag}>, want mesh or one of {sorted(SIZES)}"
            raise DescriptionError("unknown_geometry", message)
        size: list[float] = []
        for key, count in SIZES[item.tag]:
            values = self.vector(item, key, where, count=count)
            if values.min() <= 0.0:
                message = f"{where}: {key}={item.get(key)!r}, want positive numbers"
                raise DescriptionError("invalid_size", message)
            size += values.tolist()
        return UrdfGeometry(item.tag, tuple(size))

    def vector(
        self, element: ET.Element, key: str, where: str, default: str | None = None, count: int = 3
    ) -> FloatArray:
        """Return the numbers of an attribute, or of ``default`` where it is absent; shape [count].

        Raises:
            DescriptionError: ``missing_number``, ``invalid_number``, ``not_finite``.
        """
        text = element.get(key, default)
        if self.lenient and text is not None:
            text = text.replace(",", " ") if text.strip() else default
        if text is None:
            raise DescriptionError("missing_number", f"{where}: <{element.tag}> has no {key}")
        said = f"{where}: {key}={text[:80]!r}"
        try:
            values = [float(word) for word in text.split()]
        except ValueError as error:
            raise DescriptionError("invalid_number", f"{said}, want numbers") from error
        if len(values) != count:
            raise DescriptionError("invalid_number", f"{said}, want {count} numbers")
        if not sensible(values):
            raise DescriptionError("not_finite", f"{said}, want finite numbers up to {ABSURD:g}")
        return np.array(values)


#: What is refused, and what an import forgives.
STRICT = UrdfElements()
LENIENT = UrdfElements(lenient=True)


def _driven(line: JointLine, element: ET.Element, where: str) -> JointLine:
    """Return a joint with what engines drive it by."""
    limit = element.find("limit")
    dynamics = element.find("dynamics")
    return replace(
        line,
        damping=0.0 if dynamics is None else number(dynamics, "damping", where, 0.0),
        friction=0.0 if dynamics is None else number(dynamics, "friction", where, 0.0),
        mimic=read_mimic(element.find("mimic"), where),
        effort=_optional(limit, "effort", where),
        velocity=_optional(limit, "velocity", where),
    )


def read_mimic(element: ET.Element | None, where: str) -> Mimic | None:
    """Return what a ``<mimic>`` says; ``None`` where there is none.

    Raises:
        DescriptionError: it names no joint, or no number.
    """
    if element is None:
        return None
    leader = element.get("joint")
    if not leader:
        raise DescriptionError("missing_element", f"{where}: its <mimic> names no joint")
    multiplier = number(element, "multiplier", where, 1.0)
    return Mimic(leader, multiplier, number(element, "offset", where, 0.0))


def _optional(element: ET.Element | None, key: str, where: str) -> float | None:
    return None if element is None or element.get(key) is None else number(element, key, where)


def number(element: ET.Element, key: str, where: str, default: float | None = None) -> float:
    """Return the number of an attribute, whatever its size.

    Raises:
        DescriptionError: ``missing_number``, ``invalid_number``.
    """
    text = element.get(key)
    if text is None:
        if default is None:
            raise DescriptionError("missing_number", f"{where}: <{element.tag}> has no {key}")
        return default
    try:
        return float(text)
    except ValueError as error:
        raise DescriptionError("invalid_number", f"{where}: {key}={text!r} is no number") from error
