"""Descriptions of many joints: a chain, each link on the one before, and keys on one base."""

from box_world import body, described, joint

from asset_factory.sim_checks.description import Description


def chain(links: int) -> Description:
    """Boxes in a row, each on a hinge at the end of the one before, 2 mm apart."""
    pitch = 0.102
    bodies = [
        body(f"l{i}", [((pitch * i + 0.05, 0.0, 0.0), (0.1, 0.05, 0.05))], (pitch * i, 0.0, 0.0))
        for i in range(links)
    ]
    turn = ((pitch, 0, 0), (0.0, 0.0, 1.0), (0.0, 0.02))
    hinges = [joint(f"j{i}", "revolute", f"l{i - 1}", f"l{i}", *turn) for i in range(1, links)]
    return described(bodies, hinges)


def keyboard(keys: int) -> Description:
    """Keys in a row, 2 mm apart, that go down into nothing."""
    bodies = [body("base", [((0.0, 0.0, -1.0), (1.0, 1.0, 0.1))])]
    slides = []
    for i in range(keys):
        at = (0.02 * i, 0.0, 0.0)
        bodies.append(body(f"k{i}", [(at, (0.018, 0.018, 0.01))], at))
        way = (at, (0.0, 0.0, -1.0), (0.0, 0.004))
        slides.append(joint(f"j{i}", "prismatic", "base", f"k{i}", *way))
    return described(bodies, slides)
