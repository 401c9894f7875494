"""Targets of many environments at once, as on a GPU: padded, chosen and read by index."""

from types import SimpleNamespace

import numpy as np
import pytest
from openable_samples import cabinet, oven, write_registry

from asset_factory.envs.assets import read_registry

torch = pytest.importorskip("torch", reason="torch is not installed")
pytest.importorskip("mani_skill", reason="mani_skill is not installed")

ROWS = 8


class Articulation:
    """Knows its joints' order and where each of its links' data lie."""

    def __init__(self, joints, links, first_row):
        self.device = torch.device("cpu")
        self.active_joints = [SimpleNamespace(name=name) for name in joints]
        bodies = [SimpleNamespace(gpu_pose_index=first_row + row) for row in range(len(links))]
        links_of = [SimpleNamespace(_bodies=[body]) for body in bodies]
        self.links_map = dict(zip(links, links_of, strict=True))


@pytest.fixture
def targets(tmp_path):
    from asset_factory.envs.targets import Targets

    assets = read_registry(write_registry(tmp_path, cabinet(), oven()))
    data = torch.arange(ROWS * 13, dtype=torch.float32).reshape(ROWS, 13)
    px = SimpleNamespace(cuda_rigid_body_data=SimpleNamespace(torch=lambda: data))
    articulations = [
        Articulation(["slide", "hinge"], ["part_0", "part_1", "part_2"], 0),
        Articulation(["door"], ["part_0", "part_1"], 3),
        Articulation(["hinge", "slide"], ["part_0", "part_1", "part_2"], 5),
    ]
    each = [assets["cabinet"], assets["oven"], assets["cabinet"]]
    made = Targets(each, articulations, [["hinge", "slide"], ["door"], ["slide"]], px)
    made._on_gpu = True
    made.find_bodies()
    made.choose(torch.arange(3), torch.tensor([0, 0, 1]))
    return made


def test_each_environment_has_its_own_candidates(targets):
    assert targets.count.tolist() == [2, 1, 1]
    assert targets.drawn(torch.arange(3), torch.tensor([0.6, 0.9, 0.3])).tolist() == [1, 0, 1]
    assert targets.drawn(torch.tensor([2, 0]), torch.tensor([0.9, 0.4])).tolist() == [1, 0]
    assert np.allclose(targets["upper"], [1.6, 1.5, 0.3])
    assert targets["dof"].tolist() == [1, 0, 1]
    assert targets["slides"].tolist() == [0.0, 0.0, 1.0]


def test_link_data_come_from_the_rows_of_the_chosen_links(targets):
    assert targets.handle_pose()[:, 0].tolist() == [13.0, 4 * 13.0, 7 * 13.0]
    orientation, velocity, turning = targets.motion()
    assert orientation[:, 0].tolist() == [16.0, 55.0, 94.0]
    assert velocity[0].tolist() == [20.0, 21.0, 22.0]
    assert turning[0].tolist() == [23.0, 24.0, 25.0]


def test_choosing_in_some_environments_leaves_the_others(targets):
    targets.choose(torch.tensor([0]), torch.tensor([1]))
    assert targets["dof"].tolist() == [0, 0, 1]
    assert targets.handle_pose()[:, 0].tolist() == [26.0, 52.0, 91.0]


def test_shares_and_joint_values_are_inverse(targets):
    share = torch.tensor([0.5, 1.0])
    values = targets.opened(torch.zeros(2, 2), torch.tensor([0, 2]), share)
    assert torch.allclose(values, torch.tensor([[0.0, 0.8], [0.0, 0.3]]))
    padded = torch.stack([values[0], torch.zeros(2), values[1]])
    assert torch.allclose(targets.share(padded), torch.tensor([0.5, 0.0, 1.0]))
