"""A carcass with a drawer above a door, of boxes, as URDF and MJCF; a good one and broken ones."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import trimesh

from asset_factory.sim_checks.checks.result import CheckResult
from asset_factory.sim_checks.report import Severity

Boxes = tuple[tuple[tuple[float, float, float], tuple[float, float, float]], ...]

#: Centre and size [m] of every box, in the base's frame with all joints at 0; front is -x, gaps are
#: 5 mm.
PARTS: Mapping[str, Boxes] = {
    "carcass": (
        ((0.191, 0.0, 0.4), (0.018, 0.6, 0.8)),
        ((0.0, -0.291, 0.4), (0.4, 0.018, 0.8)),
        ((0.0, 0.291, 0.4), (0.4, 0.018, 0.8)),
        ((0.0, 0.0, 0.791), (0.4, 0.6, 0.018)),
        ((0.0, 0.0, 0.4), (0.4, 0.6, 0.018)),
        ((0.0, 0.0, 0.009), (0.4, 0.6, 0.018)),
    ),
    "drawer": (((-0.015, 0.0, 0.5955), (0.37, 0.554, 0.363)),),
    "door": (((-0.214, 0.0, 0.2), (0.018, 0.59, 0.38)),),
}
MASSES = {"carcass": 20.0, "drawer": 3.0, "door": 2.0, "stopper": 1.0}
ORIGINS = {"drawer": (-0.2, 0.0, 0.6), "door": (-0.223, -0.295, 0.2), "stopper": (-0.3, 0.0, 0.6)}
SLIDE = 'axis xyz="-1 0 0"/><limit lower="0" upper="0.3" effort="50" velocity="2"/'
SWING = 'axis xyz="0 0 1"/><limit lower="0" upper="1.57" effort="50" velocity="2"/'
JOINTS = {"drawer": ("slide", "prismatic", SLIDE), "door": ("hinge", "revolute", SWING)}


def write_urdf(
    folder: Path,
    parts: Mapping[str, Boxes] = PARTS,
    replace: Mapping[str, str] | None = None,
    *,
    joints: bool = True,
) -> Path:
    """A URDF with one OBJ per box; ``replace`` edits its text, and must find what it replaces."""
    text = [_link(folder, name, boxes) for name, boxes in parts.items()]
    for child in parts:
        if child != "carcass" and joints:
            name, kind, rest = JOINTS.get(child, (f"{child}_joint", "fixed", 'axis xyz="1 0 0"/'))
            origin = _words(ORIGINS[child])
            text.append(
                f'<joint name="{name}" type="{kind}"><parent link="carcass"/>'
                f'<child link="{child}"/>'
                f'<origin xyz="{origin}"/><{rest}></joint>'
            )
    whole = "\n".join(['<robot name="cabinet">', *text, "</robot>"])
    for old, new in (replace or {}).items():
        if old not in whole:
            raise ValueError(f"nothing to replace: {old}")
        whole = whole.replace(old, new)
    path = folder / "cabinet.urdf"
    path.write_text(whole)
    return path


def write_mjcf(folder: Path, drawer_size: float = 0.554, friction: float = 0.0) -> Path:
    """The cabinet as MJCF box geoms, with the drawer's width [m] and friction [N] to choose."""
    drawer = (((-0.015, 0.0, 0.5955), (0.37, drawer_size, 0.363)),)
    carcass = _geoms("carcass", PARTS["carcass"])
    text = f"""<mujoco><worldbody><body name="carcass">{carcass}
        <body name="drawer" pos="{_words(ORIGINS["drawer"])}">{_geoms("drawer", drawer)}
          <joint name="slide" type="slide" axis="-1 0 0" range="0 0.3" limited="true"
            frictionloss="{friction}"/></body>
        <body name="door" pos="{_words(ORIGINS["door"])}">{_geoms("door", PARTS["door"])}
          <joint name="hinge" axis="0 0 1" range="0 90" limited="true"/></body></body></worldbody>
        </mujoco>"""
    path = folder / "cabinet.xml"
    path.write_text(text)
    return path


def write_lid(folder: Path) -> Path:
    """A 20 kg lid with damping and friction, without collision shapes, opening upwards."""
    path = folder / "lid.urdf"
    path.write_text(
        """<robot name="chest"><link name="chest"/><link name="lid"><inertial>
        <origin xyz="0.3 0 0"/><mass value="20"/>
        <inertia ixx="0.4" iyy="0.7" izz="1.0" ixy="0.01" ixz="0.02" iyz="0.03"/></inertial></link>
        <joint name="hinge" type="revolute"><parent link="chest"/><child link="lid"/>
        <origin xyz="0 0 0.5"/><axis xyz="0 -1 0"/>
        <limit lower="0" upper="1.57" effort="1" velocity="1"/>
        <dynamics damping="1.5" friction="2.0"/></joint></robot>"""
    )
    return path


def codes(result: CheckResult, severity: Severity = Severity.ERROR) -> list[str]:
    return [finding.code for finding in result.findings if finding.severity is severity]


def motion_of(result: CheckResult, joint: str) -> dict[str, float]:
    return next(m for m in result.measurements["motion"]["joints"] if m["joint"] == joint)


def _link(folder: Path, name: str, boxes: Boxes) -> str:
    shapes = []
    for i, (center, size) in enumerate(boxes):
        mesh = trimesh.creation.box(extents=size)
        mesh.vertices += np.array(center) - ORIGINS.get(name, (0.0, 0.0, 0.0))
        mesh.export(folder / f"{name}_{i}.obj")
        shapes.append(
            f'<collision><geometry><mesh filename="{name}_{i}.obj"/></geometry></collision>'
        )
    center, (x, y, z) = _bounds(name, boxes)
    mass = MASSES[name]
    inertia = np.array([y * y + z * z, x * x + z * z, x * x + y * y]) * mass / 12.0
    moments = " ".join(
        f'{key}="{value!r}"'
        for key, value in zip(("ixx", "iyy", "izz"), inertia.tolist(), strict=True)
    )
    return (
        f'<link name="{name}"><inertial><origin xyz="{_words(center)}"/><mass value="{mass}"/>'
        f'<inertia {moments} ixy="0" ixz="0" iyz="0"/></inertial>{"".join(shapes)}</link>'
    )


def _geoms(name: str, boxes: Boxes) -> str:
    origin = np.array(ORIGINS.get(name, (0.0, 0.0, 0.0)))
    return "".join(
        f'<geom type="box" mass="{MASSES[name] / len(boxes)}" '
        f'pos="{_words(np.array(center) - origin)}" '
        f'size="{_words(np.array(size) / 2)}"/>'
        for center, size in boxes
    )


def _bounds(name: str, boxes: Boxes) -> tuple[np.ndarray, np.ndarray]:
    centers, sizes = (np.array([box[k] for box in boxes]) for k in (0, 1))
    lower = (centers - sizes / 2).min(0)
    upper = (centers + sizes / 2).max(0)
    return (lower + upper) / 2 - ORIGINS.get(name, (0.0, 0.0, 0.0)), upper - lower


def _words(values: object) -> str:
    return " ".join(repr(float(v)) for v in np.asarray(values))
