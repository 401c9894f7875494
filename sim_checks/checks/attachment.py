"""Does what a joint moves come near what carries it, anywhere on its way?"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from operator import attrgetter

import numpy as np

from ..config import LintConfig
from ..description import Description, FloatArray, IntArray, JointLine
from ..geometry.collision import Skin
from ..geometry.kinematics import Tree, find_tree, sweep_range
from ..geometry.path import joint_axis
from ..geometry.placing import box_gap, joined, placed
from .result import CheckResult, about, error, in_mm

#: Poses along a joint that are asked, both ends among them.
POSES = 9


def check_attachment(description: Description, config: LintConfig) -> CheckResult:
    """Find moving parts that no pose brings near what carries them, and hinges that let go.

    Near is a finger's width, and a tenth of the part's size: racks ride on rails that no mesh has.
    """
    tree = find_tree(description)
    if tree is None:
        # There is no pose to look at, which the lint says.
        return CheckResult()
    surfaces = _Surfaces(description, tree)
    findings = []
    for joint in tree.moving:
        gaps, size = surfaces.gaps(joint, config.finger_m)
        away = config.finger_m + config.near_share * size
        never = bool(gaps.min() > away)
        if not never and (joint.kind == "prismatic" or gaps.max() <= away):
            continue
        gap = float(gaps.min() if never else gaps.max())
        where = "in every pose" if never else "in some pose, though a hinge holds in every pose"
        message = (
            f"the part that joint {joint.name!r} moves is {1000 * gap:.1f} mm away from its "
            f"parent {joint.parent!r} {where}; want at most {1000 * away:.3g} mm"
        )
        findings.append(error("part_detached", message, **about(joint), **in_mm(gap, away)))
    return CheckResult(tuple(findings))


class _Surfaces:
    """The triangles of links, with every joint at lower, in the root's frame."""

    def __init__(self, description: Description, tree: Tree) -> None:
        self.tree = tree
        self._poses = self.tree.link_poses(self.tree.closed)
        self._links = {link.name: link for link in description.links}
        self._part_of = self.tree.part_of()
        moving = self.tree.moving
        self._above = {self._part_of[j.child]: self._part_of[j.parent] for j in moving}
        self._ready = cache(self._made_ready)

    def gaps(self, joint: JointLine, enough: float) -> tuple[FloatArray, float]:
        """Return gaps at poses along a joint's way [m], shape [pose_count], and its part's size.

        0 where there is nothing to measure. What can be touched is asked first: visible meshes may
        be large. Gaps up to ``enough`` [m] are not measured again; of a slide's poses, the first
        that is so near will do.
        """
        every = joint.kind != "prismatic"
        part = self._carrier(joint)
        limits = sweep_range(joint)
        gaps = np.full(POSES, np.inf)
        size = 0.0
        if part is None or limits is None:
            return np.zeros(POSES), size
        length = limits[1] - limits[0]
        path = joint_axis(joint, self._poses[joint.child]).path(length)
        poses = path.poses(np.linspace(0.0, length, POSES))
        for visible in (False, True):
            moved = self._triangles(sorted(self.tree.below(joint)), visible=visible)
            still = self._ready(part, visible=visible)
            if moved is None or still is None:
                continue
            size = max(size, float(np.linalg.norm(np.ptp(moved[0], axis=0))))
            for index, pose in enumerate(poses):
                if gaps[index] <= enough:
                    continue
                vertices = placed(moved[0], pose)
                gap = box_gap(vertices, still[0])
                if gap <= enough or every:
                    gap = Skin(vertices, moved[1]).distance(still[1])
                gaps[index] = min(gaps[index], gap)
                if gaps[index] <= enough and not every:
                    return gaps, size
        return (gaps if np.isfinite(gaps).all() else np.zeros(POSES)), size

    def _carrier(self, joint: JointLine) -> int | None:
        """Return the part that a joint hangs on: its parent's, or the next above with shapes."""
        part: int | None = self._part_of[joint.parent]
        while part is not None:
            links = [self._links[name] for name in self.tree.parts[part]]
            if any(link.collisions or link.visuals for link in links):
                break
            part = self._above.get(part)
        return part

    def _made_ready(self, part: int, *, visible: bool) -> tuple[FloatArray, Skin] | None:
        """Return a part's corners and its triangles held ready; ``None`` where it has none."""
        found = self._triangles(self.tree.parts[part], visible=visible)
        return None if found is None else (found[0], Skin(*found))

    def _triangles(
        self, names: Sequence[str], *, visible: bool
    ) -> tuple[FloatArray, IntArray] | None:
        """Return corners [m] and faces of links' visible or collision shapes; ``None`` if none."""
        shapes = attrgetter("visuals" if visible else "collisions")
        links = ((self._links[name], self._poses[name]) for name in names)
        return joined((shape, pose) for link, pose in links for shape in shapes(link))
