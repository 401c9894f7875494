"""Is a file small enough to be validated at all? Counted in work, not in seconds.

A file beyond is not validated rather than in part: such a file never passes.
"""

from __future__ import annotations

from ..config import WorkConfig
from ..description import Description
from ..geometry.kinematics import MOVING_KINDS, find_tree
from ..report import Finding
from .result import error


def oversized(description: Description, config: WorkConfig) -> Finding | None:
    """Return why none of the static checks looks at a file, if it is too large for them."""
    hulls = sum(len(link.collisions) for link in description.links)
    if hulls > config.hulls:
        words = f"{hulls} collision shapes: every one is compared with all others"
        return beyond(words, hulls, config.hulls)
    tree = find_tree(description)
    if tree is None:
        return None
    # Depths below each joint: a chain moves half the square of its links.
    above = {tree.root: 0}
    for joint in tree.order:
        above[joint.child] = above[joint.parent] + (joint.kind in MOVING_KINDS)
    moved = sum(above.values())
    if moved > config.moved_links:
        words = f"its joints move {moved} links, counted once for each joint that moves them"
        return beyond(words, moved, config.moved_links)
    return None


def undriven(description: Description, name: str, config: WorkConfig) -> Finding | None:
    """Return why a simulator is not asked, if driving every joint takes too much of it."""
    tree = find_tree(description)
    driven = 0 if tree is None else len(tree.ranges)
    work = driven * len(description.links)
    if work <= config.driven_links:
        return None
    model = f"a model of {len(description.links)} links"
    words = f"{driven} joints to drive, one by one, in {model}: {name} was not asked"
    return beyond(words, work, config.driven_links, simulator=name)


def beyond(words: str, count: int, most: int, simulator: str | None = None) -> Finding:
    """Return the finding that something was too much to look at."""
    message = f"too large to validate: {words} ({count}, at most {most})"
    return error("too_large_to_judge", message, simulator=simulator, value=count, limit=most)
