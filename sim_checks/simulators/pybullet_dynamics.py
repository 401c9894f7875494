"""Bullet's inverse dynamics, and a substitute where it refuses a sound body.

Bullet holds inertia tensors of its inverse dynamics symmetric to the last bit; rounding makes
heavy, turned ones (a fridge's door) differ there, and it answers nothing at all.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from functools import partial
from inspect import isbuiltin
from typing import Any

import numpy as np

from ..description import FloatArray


class BulletClient:
    """PyBullet's names, its functions asked of a physics client that was just connected."""

    def __init__(self, pybullet: Any) -> None:
        self._bullet = pybullet
        self._client = pybullet.connect(pybullet.DIRECT)

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._bullet, name)
        if isbuiltin(found):
            found = partial(found, physicsClientId=self._client)
        setattr(self, name, found)
        return found


class Dynamics:
    """Inertias and balancing forces of one multibody.

    All vectors are in the order of its joints, each given with the links beyond it, which it moves.
    """

    def __init__(self, bullet: BulletClient, body: int, beyond: Mapping[int, list[int]]) -> None:
        self._bullet = bullet
        self._body = body
        self._joints = list(beyond)
        lines = [bullet.getJointInfo(body, joint) for joint in beyond]
        self._slides = [line[2] == bullet.JOINT_PRISMATIC for line in lines]
        # In the principal frame of the link that each joint moves.
        self._axes = [np.array(line[13]) for line in lines]
        self._beyond = list(beyond.values())
        self._refuses = False
        links = sorted({link for group in self._beyond for link in group})
        infos = {link: bullet.getDynamicsInfo(body, link) for link in links}
        self._mass = {link: float(info[0]) for link, info in infos.items()}
        self._moments = {link: np.array(info[2], np.float64) for link, info in infos.items()}

    def mass_matrix(self, position: FloatArray) -> FloatArray:
        """Return the mass matrix [kg m2], [kg m] or [kg], shape [joint_count, joint_count]."""
        if not self._refuses:
            with suppress(SystemError, self._bullet.error):
                matrix = np.array(self._bullet.calculateMassMatrix(self._body, position.tolist()))
                if matrix.shape == (len(self._joints),) * 2:
                    return matrix
            self._refuses = True
        return self._composed()

    def balance(self, position: FloatArray, velocity: FloatArray, gravity: float) -> FloatArray:
        """Return forces against gravity along z [m/s2] and velocity effects, [joint_count].

        The stand-in knows no velocity effects: at furniture's speeds the drive's own pull makes up
        for them.
        """
        if not self._refuses:
            motion = (position.tolist(), velocity.tolist(), [0.0] * len(self._joints))
            with suppress(SystemError, self._bullet.error):
                forces = self._bullet.calculateInverseDynamics(self._body, *motion)
                return np.array(forces, np.float64)
            self._refuses = True
        axes, points, centers, _ = self._geometry()
        forces = np.zeros(len(self._joints))
        for i, group in enumerate(self._beyond):
            for link in group:
                lift = axes[i] if self._slides[i] else np.cross(axes[i], centers[link] - points[i])
                forces[i] -= gravity * self._mass[link] * lift[2]
        return forces

    def _composed(self) -> FloatArray:
        """Return the mass matrix, link by link from what each joint does to it."""
        axes, points, centers, turns = self._geometry()
        matrix = np.zeros((len(self._joints),) * 2)
        for link, mass in self._mass.items():
            speed = np.zeros((len(self._joints), 3))
            spin = np.zeros((len(self._joints), 3))
            for i, group in enumerate(self._beyond):
                if link in group:
                    arm = centers[link] - points[i]
                    speed[i] = axes[i] if self._slides[i] else np.cross(axes[i], arm)
                    spin[i] = 0.0 if self._slides[i] else axes[i] @ turns[link]
            matrix += mass * speed @ speed.T + spin * self._moments[link] @ spin.T
        return matrix

    def _geometry(
        self,
    ) -> tuple[list[FloatArray], list[FloatArray], dict[int, FloatArray], dict[int, FloatArray]]:
        """Return joints' world axes and points; links' world centres of mass and principal axes."""
        links = list(self._mass)
        states = self._bullet.getLinkStates(self._body, links, computeForwardKinematics=1)
        at = dict(zip(links, states, strict=True))
        turns = {link: self._turn(state) for link, state in at.items()}
        axes = [turns[joint] @ axis for joint, axis in zip(self._joints, self._axes, strict=True)]
        points = [np.array(at[joint][4]) for joint in self._joints]
        return axes, points, {link: np.array(state[0]) for link, state in at.items()}, turns

    def _turn(self, state: Any) -> FloatArray:
        return np.reshape(self._bullet.getMatrixFromQuaternion(state[1]), (3, 3)).astype(np.float64)
