"""Small objects that a robot can open, and some that it cannot."""

from dataclasses import replace

from openable_samples import FRONT, assemble, box

from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.asset import Asset
from asset_factory.factory.manufacture.targets.find import find_targets
from asset_factory.factory.part import Handle


def fin(name: str, height: float = 0.6, friction: float = 20.0) -> Asset:
    """A block out of whose front a narrow fin is pulled; ``friction`` [N]."""
    meshes = [
        box([0.0, 0.0, 0.5 * height], [0.4, 0.4, height]),
        box([0.0, -0.26, height - 0.1], [0.02, 0.1, 0.12]),
    ]
    slide = Joint(
        "slide",
        JointKind.PRISMATIC,
        0,
        1,
        FRONT,
        [0.0, -0.26, height - 0.1],
        0.0,
        0.15,
        friction=friction,
    )
    asset = assemble(name, meshes, (slide,), {1: Handle([0.0, -0.31, height - 0.1], FRONT, FRONT)})
    return replace(
        asset, targets=find_targets(asset.articulation, [body.hulls for body in asset.bodies])
    )
