"""The target joint of each parallel environment as tensors: set per episode, read without loops."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
import torch  # noqa: TID253 - this module is only imported to make an environment

from .assets import RegisteredAsset

#: What is kept of every candidate: vectors in the object frame with every joint at 0, values [rad]
#: or [m].
VECTORS = ("point", "pull", "axis")
VALUES = ("lower", "upper")


class Targets:
    """Per environment: every joint that may be named, those that are drawn, and the target.

    Candidates are padded to the longest list, so that choosing is indexing.

    Attributes:
        count: how many of its candidates each environment may draw, shape [environment].
        slot: which one is the target, shape [environment].
    """

    def __init__(
        self,
        assets: Sequence[RegisteredAsset],
        articulations: Sequence[Any],
        allowed: Sequence[Sequence[str]],
        px: Any,
    ) -> None:
        device = articulations[0].device
        slots = max(len(asset.openable) for asset in assets)
        joints = [_padded(asset.openable, slots) for asset in assets]
        self._px = px
        self._on_gpu = device.type == "cuda"
        self.count = torch.tensor([len(names) for names in allowed], device=device)
        pairs = zip(assets, allowed, strict=True)
        named = ([named_slot(asset, name) for name in names] for asset, names in pairs)
        self._allowed = torch.tensor([_padded(each, slots) for each in named], device=device)
        self.slot = self._allowed[:, 0].clone()
        self._rows = torch.arange(len(assets), device=device)
        columns = {
            name: [[np.asarray(getattr(j, name)).tolist() for j in row] for row in joints]
            for name in (*VECTORS, *VALUES)
        }
        columns["slides"] = [[float(j.kind == "prismatic") for j in row] for row in joints]
        single = partial(torch.tensor, dtype=torch.float32, device=device)
        self._table = {name: single(rows) for name, rows in columns.items()}
        degrees = []
        self._handles = []
        self._movers = []
        for articulation, row in zip(articulations, joints, strict=True):
            order = {joint.name: i for i, joint in enumerate(articulation.active_joints)}
            degrees.append([order[j.name] for j in row])
            self._handles.append([articulation.links_map[j.handle_link] for j in row])
            self._movers.append([articulation.links_map[j.child] for j in row])
        self._table["dof"] = torch.tensor(degrees, device=device)
        self._now = {name: table[self._rows, self.slot] for name, table in self._table.items()}

    def find_bodies(self) -> None:
        """Learn the links' addresses on the GPU; known once the simulation is set up there."""
        if self._on_gpu:
            device = self.slot.device
            for name, links in (("handle", self._handles), ("mover", self._movers)):
                rows = [[link._bodies[0].gpu_pose_index for link in row] for row in links]
                self._table[name] = torch.tensor(rows, device=device)

    def choose(self, env_idx: torch.Tensor, slot: torch.Tensor) -> None:
        """Make candidate ``slot`` the target of each ``env_idx``; both have shape [chosen]."""
        self.slot[env_idx] = slot
        self._now = {name: table[self._rows, self.slot] for name, table in self._table.items()}

    def drawn(self, env_idx: torch.Tensor, draw: torch.Tensor) -> torch.Tensor:
        """Return the slots that uniform numbers in [0, 1) stand for, both shape [chosen]."""
        return self._allowed[env_idx, (draw * self.count[env_idx]).long()]

    def __getitem__(self, name: str) -> torch.Tensor:
        """Return one property of the targets, shape [environment, ...]."""
        return self._now[name]

    def handle_pose(self) -> torch.Tensor:
        """Return poses of the held links: position [m], quaternion wxyz; shape [environment, 7]."""
        if self._on_gpu:
            return self._px.cuda_rigid_body_data.torch()[self._now["handle"], :7]
        return self._handles[0][int(self.slot[0])].pose.raw_pose

    def motion(self) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        """Return the moved links' orientation wxyz, velocity [m/s] and angular velocity [rad/s]."""
        if self._on_gpu:
            data = self._px.cuda_rigid_body_data.torch()[self._now["mover"]]
            return data[:, 3:7], data[:, 7:10], data[:, 10:13]
        link = self._movers[0][int(self.slot[0])]
        return link.pose.q, link.linear_velocity, link.angular_velocity

    def share(self, qpos: torch.Tensor) -> torch.Tensor:
        """Return how far the targets are open, 0 to 1, shape [environment].

        ``qpos`` is padded, shape [environment, dof].
        """
        value = qpos.gather(1, self._now["dof"][:, None])[:, 0]
        return (value - self._now["lower"]) / (self._now["upper"] - self._now["lower"])

    def opened(
        self, qpos: torch.Tensor, env_idx: torch.Tensor, share: torch.Tensor
    ) -> torch.Tensor:
        """Return ``qpos`` [chosen, dof] of ``env_idx``, targets open by ``share`` [chosen]."""
        lower = self._now["lower"][env_idx]
        upper = self._now["upper"][env_idx]
        value = lower + share * (upper - lower)
        return qpos.scatter(1, self._now["dof"][env_idx][:, None], value[:, None])


def named_slot(asset: RegisteredAsset, joint: str) -> int:
    """Return which candidate a joint is. Raises RegistryError listing those there are."""
    return asset.openable.index(asset.joint(joint))


def _padded(items: Sequence[Any], length: int) -> list[Any]:
    return [*items, *[items[-1]] * (length - len(items))]
