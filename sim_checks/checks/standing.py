"""Resting on the floor and fastened to nothing, does the object stay up while its parts are opened?

Exact for rigid bodies at rest: the object stands where its centre of mass lies above the convex
hull of the points that touch the floor, and an outside force tips it where it turns it about an
edge of that hull more than its weight holds. z is up; the floor is at the lowest point with every
joint closed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.spatial import ConvexHull, QhullError

from ..config import StandingConfig
from ..description import DescribedShape, Description, FloatArray, JointLine, Link
from ..geometry.hull import find_hull
from ..geometry.kinematics import Poser, Tree, find_tree
from ..geometry.path import joint_axis
from ..geometry.statics import GRAVITY
from ..report import Finding
from .result import CheckResult, Findings, measured, warning

#: Values of a joint's range that are tried before the worst is refined.
SAMPLES = 17
#: Points this much alike in distance are equally far [m].
SAME = 1e-9


class _RestingBody:
    """The object as points and masses, ready to be posed."""

    def __init__(self, description: Description, tree: Tree, config: StandingConfig) -> None:
        self.tree = tree
        self._config = config
        corners = {link.name: _corners(link.collisions) for link in description.links}
        self.points = {name: points for name, points in corners.items() if len(points)}
        inertias = ((link.name, link.inertia) for link in description.links)
        weighed = {name: inertia for name, inertia in inertias if inertia is not None}
        self._centers = {name: (item.mass, item.center) for name, item in weighed.items()}
        self.mass = sum(mass for mass, _ in self._centers.values())
        self._poser = Poser(tree)
        self._posed: dict[str, FloatArray] = {}
        ends = np.cumsum([0, *map(len, self.points.values())])
        self._rows = {name: slice(ends[i], ends[i + 1]) for i, name in enumerate(self.points)}
        self._cloud = np.zeros((ends[-1], 3))
        self._moments = {name: np.zeros(3) for name in self._centers}
        self._footing: tuple[FloatArray, FloatArray | None] | None = None
        points = self._placed(tree.closed)
        self.floor = float(points[:, 2].min())
        spread = float(np.linalg.norm(np.ptp(points[:, :2], axis=0)))
        self._near = self.floor + max(config.contact_m, config.contact_share * spread)

    def sunk(self, values: Mapping[str, float]) -> float:
        """Return how far the lowest point is below the floor [m]."""
        return max(0.0, self.floor - float(self._placed(values)[:, 2].min()))

    def margin(self, values: Mapping[str, float]) -> float | None:
        """Return how far within the support the centre of mass lies [m]; negative outside.

        ``None`` where fewer than three points, or none apart, touch the floor.
        """
        edges = self._support(values)
        if edges is None:
            return None
        return float((edges[:, 2] - edges[:, :2] @ self._center()[:2]).min())

    def stance(self, values: Mapping[str, float]) -> dict[str, Any]:
        """Return the margin, and how far the floor may lean until the object topples.

        Negative where it topples by itself; ``None`` both where it has nothing to stand on.
        """
        margin = self.margin(values)
        if margin is None:
            return {"margin_mm": None, "tilt_deg": None}
        height = max(float(self._center()[2]) - self.floor, 1e-6)
        tilt = round(math.degrees(math.atan2(margin, height)), 3)
        return {"margin_mm": round(1000 * margin, 3), "tilt_deg": tilt}

    def tipping_force(self, joint: JointLine, values: Mapping[str, float]) -> float | None:
        """Return the least opening force at the part's farthest point that tips the object [N].

        ``None`` where no such pull tips it, or it does not stand on its own.
        """
        edges = self._support(values)
        pull = self._pull(joint)
        if edges is None or pull is None:
            return None
        point, way = pull
        center = self._center()
        held = GRAVITY * self.mass * (edges[:, 2] - edges[:, :2] @ center[:2])
        lever = (point[2] - self.floor) * (edges[:, :2] @ way[:2])
        lever += way[2] * (edges[:, 2] - edges[:, :2] @ point[:2])
        tips = lever > 1e-9
        return max(0.0, float((held[tips] / lever[tips]).min())) if tips.any() else None

    def _placed(self, values: Mapping[str, float]) -> FloatArray:
        """Pose all; return the corners in the root's frame [m], shape [point_count, 3].

        Only what moved since the last pose is moved.
        """
        before = self._posed
        self._posed = self._poser.link_poses(values)
        for name, pose in self._posed.items():
            if pose is before.get(name):
                continue
            if name in self.points:
                corners = self.points[name] @ pose[:3, :3].T + pose[:3, 3]
                self._cloud[self._rows[name]] = corners
            if name in self._centers:
                mass, at = self._centers[name]
                self._moments[name] = mass * (pose[:3, :3] @ at + pose[:3, 3])
        return self._cloud

    def _center(self) -> FloatArray:
        """Return the centre of mass as posed, in the root's frame [m], shape [3]."""
        total: FloatArray = np.sum(list(self._moments.values()), axis=0) / self.mass
        return total

    def _support(self, values: Mapping[str, float]) -> FloatArray | None:
        """Return the support's edges: lines (nx, ny, d), ``n @ x <= d`` inside, [edge_count, 3]."""
        points = self._placed(values)
        feet = points[points[:, 2] <= self._near, :2]
        # Most joints move nothing that touches the floor.
        if self._footing is None or not np.array_equal(feet, self._footing[0]):
            self._footing = feet, _edges(feet, self._config.footing_m)
        return self._footing[1]

    def _pull(self, joint: JointLine) -> tuple[FloatArray, FloatArray] | None:
        """Return where a hand pulls [m], and the unit direction in which that point opens."""
        below = self.tree.below(joint)
        clouds = [self._cloud[rows] for name, rows in self._rows.items() if name in below]
        if not clouds:
            return None
        points = np.vstack(clouds)
        line = joint_axis(joint, self._posed[joint.child])
        if not line.turning:
            return _farthest(points, points @ line.axis), line.axis
        point = _farthest(points, np.linalg.norm(line.arms(points), axis=1))
        arm = np.cross(line.axis, point - line.origin)
        length = float(np.linalg.norm(arm))
        return (point, arm / length) if length > SAME else None


def check_standing(description: Description, config: StandingConfig) -> CheckResult:
    """Check the object closed, with each joint anywhere in its range, and with all joints at upper.

    Joints closed means at lower. A moving part that touches the floor carries its share; one that
    goes below it is taken to rest on it. There is no verdict while a link with collision shapes has
    no mass.

    Returns:
        ``no_stable_footing``, or ``topples``, or else ``topples_when_pulled``, all warnings: a
        thing that is fastened to a wall or lies in a hand may well not stand. The measurements give
        margin [mm], the lean that topples it [deg] and the pull that tips it where the joint sticks
        or ends [N], joint by joint; ``None`` where there is nothing to say.
    """
    tree = find_tree(description)
    if tree is None:
        return CheckResult()
    solid = [link for link in description.links if link.collisions]
    unweighed = [link.name for link in description.links if not _weighed(link)]
    if unweighed or not solid:
        return CheckResult((), {"unweighed": unweighed})
    body = _RestingBody(description, tree, config)
    closed = body.stance(tree.closed)
    measurements: dict[str, Any] = {"mass_kg": round(body.mass, 6), "closed": closed}
    if closed["margin_mm"] is None:
        touch = "fewer than three points apart touch the floor with every joint closed"
        found = (warning("no_stable_footing", f"{touch}: it does not stand by itself"),)
        return CheckResult(found, {**measurements, "joints": []})
    rows = [_joint_row(body, joint) for joint in tree.free if joint.name in tree.ranges]
    together = body.stance(tree.opened)
    measurements |= {"joints": rows, "all_upper": together}
    told = tuple(_topples(closed, rows, together, config.margin_m))
    return CheckResult(told or tuple(_pulled(rows, config)), measurements)


def _weighed(link: Link) -> bool:
    """Return whether a link's mass is known; one with nothing to touch may weigh nothing."""
    inertia = link.inertia
    if inertia is None:
        return not link.collisions
    return 0.0 < inertia.mass < math.inf and bool(np.isfinite(inertia.center).all())


def _joint_row(body: _RestingBody, joint: JointLine) -> dict[str, Any]:
    at = _worst(body, joint)
    closed = body.tree.closed
    ends = [{**closed, joint.name: end} for end in body.tree.ranges[joint.name]]
    forces = [force for values in ends if (force := body.tipping_force(joint, values)) is not None]
    return {
        "joint": joint.name,
        "worst_at": round(at, 6),
        **body.stance({**closed, joint.name: at}),
        "tipping_force_n": round(min(forces), 3) if forces else None,
        "below_floor_mm": round(1000 * body.sunk(ends[1]), 3),
    }


def _worst(body: _RestingBody, joint: JointLine) -> float:
    """Return where in its range, others closed, a joint leaves the least margin.

    No footing at all is the worst.
    """
    lower, upper = body.tree.ranges[joint.name]
    closed = body.tree.closed

    def margin(value: float) -> float:
        found = body.margin({**closed, joint.name: float(value)})
        return -math.inf if found is None else found

    values = np.linspace(lower, upper, SAMPLES)
    margins = [margin(value) for value in values]
    least = int(np.argmin(margins))
    at = float(values[least])
    if 0 < least < SAMPLES - 1 and math.isfinite(margins[least]):
        around = (float(values[least - 1]), float(values[least + 1]))
        near = 1e-6 * (upper - lower)
        found = minimize_scalar(margin, bounds=around, method="bounded", options={"xatol": near})
        at = float(found.x) if found.fun < margins[least] else at
    return at


def _topples(
    closed: dict[str, Any], rows: list[dict[str, Any]], together: dict[str, Any], margin_m: float
) -> Findings:
    least = 1000 * margin_m

    def found(subject: str, numbers: Mapping[str, Any], joint: str | None = None) -> Finding:
        margin = numbers["margin_mm"]
        told = "too little touches the floor to stand on"
        if margin is not None:
            lies = f"{-margin:.1f} mm outside" if margin < 0.0 else f"only {margin:.1f} mm inside"
            leans = f": a floor that leans by {numbers['tilt_deg']:.2f} deg topples it"
            want = f"want {least:g} mm{' inside' if margin < 0.0 else leans}"
            told = f"its centre of mass lies {lies} what it stands on, {want}"
        short = measured(margin, "mm", least)
        return warning("topples", f"{subject}: {told}", joint=joint, **short)

    def margin_of(numbers: Mapping[str, Any]) -> float:
        return -math.inf if numbers["margin_mm"] is None else numbers["margin_mm"]

    loose = [row for row in rows if margin_of(row) < least]
    if margin_of(closed) < least:
        yield found("closed, and not fastened, it topples", closed)
    elif loose:
        worst = min(loose, key=margin_of)
        others = f" (so do {len(loose) - 1} more joints)" if len(loose) > 1 else ""
        at = f"joint {worst['joint']!r} at {worst['worst_at']:g}"
        yield found(f"{at} topples it{others} unless it is fastened", worst, worst["joint"])
    elif margin_of(together) < least:
        yield found("with all joints open, and not fastened, it topples", together)


def _pulled(rows: list[dict[str, Any]], config: StandingConfig) -> Findings:
    most = config.hand_force_n
    tipping = [(row["tipping_force_n"], row["joint"]) for row in rows]
    weak = [each for each in tipping if each[0] is not None and each[0] < most]
    if weak:
        force, joint = min(weak, key=lambda each: each[0])
        others = f"; the same of {len(weak) - 1} more" if len(weak) > 1 else ""
        tips = f"pulling joint {joint!r} open tips the whole object at {force:.1f} N"
        message = f"{tips}, want it to withstand {most:g} N or be fastened{others}"
        yield warning("topples_when_pulled", message, joint=joint, **measured(force, "N", most))


def _corners(shapes: tuple[DescribedShape, ...]) -> FloatArray:
    """Return corners of the shapes' convex hull [m]: no other point of them can be lowest."""
    if not shapes:
        return np.zeros((0, 3))
    points: FloatArray = np.vstack([shape.corners for shape in shapes])
    hull = find_hull(points)
    return points if hull is None else hull.vertices


def _edges(points: FloatArray, thinnest: float) -> FloatArray | None:
    """Return the lines around points in the plane, shape [edge_count, 3].

    ``None`` where the points span less than ``thinnest`` [m].
    """
    if len(points) < 3:
        return None
    centered = points - points.mean(axis=0)
    _, _, ways = np.linalg.svd(centered, full_matrices=False)
    if np.ptp(centered @ ways[-1]) < thinnest:
        return None
    try:
        equations = ConvexHull(points).equations
    except QhullError:
        return None
    return np.column_stack([equations[:, :2], -equations[:, 2]])


def _farthest(points: FloatArray, distances: FloatArray) -> FloatArray:
    """Return the point with the greatest distance; of several, the highest."""
    far = points[distances >= distances.max() - SAME]
    point: FloatArray = far[int(np.argmax(far[:, 2]))]
    return point
