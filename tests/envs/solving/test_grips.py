"""Where fingertips may press, and what is too deep in the hand."""

import numpy as np
import pytest
from export_samples import box, boxes_asset
from openable_samples import FRONT, write_registry

from asset_factory.envs.solving import make_episodes
from asset_factory.envs.solving.grips import PRESS_ON, _hand_points, drags
from asset_factory.envs.solving.world import read_world
from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.asset import Handle

pytest.importorskip("mani_skill", reason="mani_skill is not installed")
#: Height of the base and of the lid's lower edge, and the lid's thickness [m].
BASE = 0.3
EDGE = 0.304
THICK = 0.012


def clamshell():
    """A lid that lies flush on its base, hinged at its rear edge."""
    middle = EDGE + 0.5 * THICK
    meshes = [box([0.0, 0.0, 0.15], [0.3, 0.24, 0.3]), box([0.0, 0.0, middle], [0.3, 0.24, THICK])]
    hinge = Joint("lid", JointKind.REVOLUTE, 0, 1, [-1, 0, 0], [0.0, 0.12, EDGE], 0.0, 1.5)
    handle = Handle([0.0, -0.12, middle], FRONT, FRONT)
    return boxes_asset(meshes, (hinge,), {1: handle}, "clamshell")


@pytest.fixture(scope="module")
def world(tmp_path_factory):
    registry = write_registry(tmp_path_factory.mktemp("registry"), clamshell())
    environment = make_episodes(registry, "panda")
    environment.reset(seed=0)
    world = read_world(environment.unwrapped)
    environment.close()
    return world


def test_fingertips_are_pressed_on_the_lid_and_not_on_the_base_below(world):
    found = drags(world, world.object_poses(np.zeros(1)))
    front = [grip for grip in found if grip.hand[1, 2] > 0.8]
    assert front
    hands = np.array([grip.hand for grip in front])
    hands[:, :3, 3] += PRESS_ON * hands[:, :3, 2]
    points = _hand_points(world, world.balls.of(world.fingers), hands, 0.0)
    # The base is a box, closed as the object is; the lid may be pressed.
    local = points - world.object_root[:3, 3]
    x, y, z = np.moveaxis(local, -1, 0)
    inside = (np.abs(x) < 0.15) & (np.abs(y) < 0.12) & (z < BASE)
    assert not inside.any()
    lid = (np.abs(local[..., 0]) < 0.15) & (np.abs(local[..., 1]) < 0.12) & (local[..., 2] > EDGE)
    assert (lid & (local[..., 2] < EDGE + THICK)).any(axis=1).all()
    # At the lid's middle there is no room for a fingertip, so that those left are above it.
    assert (hands[:, 2, 3] - world.object_root[2, 3] > EDGE).all()


def test_a_finger_through_what_it_holds_is_a_collision(world):
    poses = world.object_poses(np.zeros(1))[None]
    arm = np.zeros((1, len(world.chain.limits)))
    fingers = world.balls.of(world.fingers)
    inside = world.chain.forward(arm, world.root)
    # Bring the object to the fingers instead of the arm to the object.
    tip = fingers.placed(inside)[0].mean(axis=0)
    poses = poses.copy()
    poses[..., :3, 3] += tip - np.array([0.0, 0.0, EDGE - 0.1])
    assert world.hits(arm, poses, touching=True)[0]
