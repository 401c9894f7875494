"""Which two links stand in a joint's way."""

from .simulator import World


def pressing(world: World, index: int) -> tuple[str, str] | None:
    """Return the hardest pressed pair of links across a joint.

    Args:
        world: after a step in which what presses pressed.
        index: the joint; one link of the pair is moved by it, the other is not.

    Returns:
        Names in the order of the model's links; ``None`` if nothing presses.
    """
    moved = world.carried[index]
    across = [
        (touch.force, touch.depth, pair)
        for pair, touch in world.contacts().items()
        if touch.presses and (pair[0] in moved) != (pair[1] in moved)
    ]
    return max(across)[2] if across else None
