"""Acting: a plan becomes actions of the environment, whose effects are watched."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..assets import FloatArray
from ..robots import CLOSED, OPEN
from .grips import PRESS_ON
from .planning import ArmPlan
from .world import RobotWorld

#: The hand's way per control step while it holds something [m], and a joint's [rad].
STEP_M = 0.012
STEP_RAD = 0.10
#: Steps for the gripper to close, and for the arm to come to rest.
CLOSING = 8
SETTLING = 12
#: A joint is left behind if it lags by more than this much of the hand's way [m], for so many
#: steps.
BEHIND_M = 0.06
BEHIND_STEPS = 12
#: Forces are means over so many control steps, a quarter of a second: a stiff arm's bumps are
#: shorter.
WINDOW = 5
#: More than an arm of this size carries [N]: a real one stops, and what opens by it was levered
#: open by a jammed hand.
OVERLOAD = 200.0
#: How far closed fingers press beyond the surface they follow [m].
PRESS = 0.02


class Stopped(Exception):
    """The episode is over: solved, out of steps, or more than the arm can bear."""


@dataclass
class Driver:
    """One episode being acted: the only thing here that changes.

    Attributes:
        env: the environment to step.
        world: the episode.
        limit: most control steps.
        actions: those sent so far.
        forces: that the wrist carries after each, 0 while nothing is touched [N].
        loads: the same, or what one of its links presses on the object with where that is more [N].
        solved: whether the task said so after the last one.
        opened: how far open the joint is, as the task says.
        gripper: what it is told, -1 to 1.
    """

    env: Any
    world: RobotWorld
    limit: int
    actions: list[FloatArray] = field(default_factory=list)
    forces: list[float] = field(default_factory=list)
    loads: list[float] = field(default_factory=list)
    solved: bool = False
    opened: float = 0.0
    gripper: float = OPEN

    def __post_init__(self) -> None:
        task = self.env.unwrapped
        self._arm = task.agent.robot._objs[0]
        self._part = task._parts[0]._objs[0]
        self._ours = {link.name for link in self._arm.links}
        self._theirs = {link.name for link in self._part.links}
        #: Joint values that were asked for last, shape [degree].
        self.command = self.values()
        self._home = self.command[:3].copy()

    def measured(self) -> dict[str, Any]:
        """Return the figures so far, by their names in an :class:`~.attempt.Attempt`."""
        touched = [force for force in self.forces if force > 0.0]
        actions = np.array(self.actions, dtype=np.float32)
        return {
            "solved": self.solved,
            "open_fraction": self.opened,
            "peak_force": sustained(self.forces),
            "mean_force": float(np.mean(touched)) if touched else 0.0,
            "actions": actions.reshape(-1, *self.env.action_space.shape),
        }

    def values(self) -> FloatArray:
        """Return the robot's joint values now, shape [degree]."""
        return np.array(self._arm.qpos, dtype=float)

    def object_values(self) -> FloatArray:
        """Return the object's joint values now, shape [degree]."""
        return np.array(self._part.qpos, dtype=float)

    def share(self) -> float:
        """Return how far the joint is open now."""
        return self.world.share(self.object_values())

    def send(self, goal: FloatArray) -> None:
        """Act one control step towards joint values, shape [degree].

        Raises:
            Stopped: the task is solved, the steps are used up, or the arm is overloaded.
        """
        free = list(self.world.free)
        now = self.values()
        self.command = goal.copy()
        action = self.world.robot.action(goal[free], now[free], self.gripper, self._drive(now))
        _, _, terminated, truncated, info = self._stepped(action)
        self.actions.append(action)
        self.opened = float(info["open_fraction"])
        self.solved = bool(info["success"]) and not self.overloaded
        over = self.overloaded or bool(info["success"]) or bool(terminated) or bool(truncated)
        if over or len(self.actions) >= self.limit:
            raise Stopped

    @property
    def overloaded(self) -> bool:
        """Return whether the arm has borne too much for a quarter of a second."""
        return sustained(self.loads[-WINDOW:]) > OVERLOAD

    def go(self, path: FloatArray, step: float = STEP_RAD) -> None:
        """Move along joint values, shape [station, degree], then wait until the arm has arrived."""
        for station in path:
            start = self.command.copy()
            goal = _planned(station, start, self.world.free)
            for part in range(count := max(1, int(np.ceil(np.abs(goal - start).max() / step)))):
                self.send(start + (goal - start) * (part + 1) / count)
        self.wait(SETTLING)

    def wait(self, steps: int) -> None:
        """Hold still, at most so long; no longer than the arm moves."""
        free = list(self.world.free)
        for _ in range(steps):
            self.send(self.command)
            if np.abs(self.values()[free] - self.command[free]).max() < 0.005:
                break

    def grasp(self, gripper: float) -> None:
        """Open or close the gripper."""
        self.gripper = gripper
        for _ in range(CLOSING):
            self.send(self.command)

    def back_off(self, distance: float = 0.1) -> None:
        """Open the gripper a little, and move the hand back."""
        if self.gripper == CLOSED:
            self.grasp(OPEN)
        hand = self.world.hand(self.world.chain.forward(self.values()[None], self.world.root))[0]
        current = self.values()
        steps = []
        for back in np.linspace(0.0, distance, 6)[1:]:
            goal = hand.copy()
            goal[:3, 3] -= back * hand[:3, 2]
            found, off = self.world.reach(goal[None], current[None], 8)
            if off[0, 0] > 0.02:
                break
            current = found[0]
            steps.append(current)
        if steps:
            self.go(np.array(steps), 0.06)

    def follow(self, plan: ArmPlan) -> None:
        """Move along the joint's way, until it is open or left behind."""
        world = self.world
        last = plan.grip.hand
        behind = 0
        previous = self.share()
        current = self.command.copy()
        for hand, share, way in zip(plan.hands, plan.shares, plan.way, strict=True):
            ahead = hand[:3, 3] - last[:3, 3]
            length = float(np.linalg.norm(ahead))
            press = _press(plan.grip.kind, ahead, hand)
            turn = float(np.abs(way[list(world.free)] - current[list(world.free)]).max())
            count = max(1, int(np.ceil(max(length / STEP_M, turn / STEP_RAD))))
            scale = length / max(abs(float(share) - previous), 1e-9)
            for portion in np.arange(1, count + 1) / count:
                self.send(self._on_the_way(current + (way - current) * portion, press))
                wanted = previous + (float(share) - previous) * portion
                behind = behind + 1 if (wanted - self.share()) * scale > BEHIND_M else 0
                if behind > BEHIND_STEPS:
                    return
            current = way
            last = hand
            previous = float(share)
        self.wait(SETTLING)

    def _on_the_way(self, values: FloatArray, press: FloatArray) -> FloatArray:
        """Return joint values for the hand pose of ``values`` shifted by ``press`` [m].

        Solved from where the base really is.
        """
        goal = _planned(values, self.command, self.world.free)
        if not self.world.robot.mobile and not press.any():
            return goal
        hand = self.world.hand(self.world.chain.forward(goal[None], self.world.root))[0]
        hand[:3, 3] += press
        if self.world.robot.mobile:
            goal[:3] = self.values()[:3]
        found, _ = self.world.reach(hand[None], goal[None], 4)
        return np.asarray(found[0])

    def _drive(self, now: FloatArray) -> FloatArray:
        """Return speeds that bring a base that was pushed away back [m/s], [rad/s]."""
        if not self.world.robot.mobile:
            return np.zeros(2)
        offset = self._home - now[:3]
        ahead = offset[0] * np.cos(now[2]) + offset[1] * np.sin(now[2])
        return np.array([4.0 * ahead, 4.0 * offset[2]])

    def _stepped(self, action: FloatArray) -> Any:
        """Return one control step, with forces sampled at every simulator step.

        The arm moves and stops within one control step.
        """
        task = self.env.unwrapped
        felt: list[tuple[FloatArray, float]] = []
        task._after_simulation_step = lambda: felt.append(self._felt())
        try:
            answer = self.env.step(action)
        finally:
            del task._after_simulation_step
        carried = float(np.linalg.norm(np.mean([force for force, _ in felt], axis=0)))
        self.forces.append(carried)
        self.loads.append(max(carried, float(np.mean([pressed for _, pressed in felt]))))
        return answer

    def _felt(self) -> tuple[FloatArray, float]:
        """Return the force that the wrist carries, shape [3], and one link's on the object [N].

        Both are 0 while the object is not touched.

        Contacts know no friction, so that the one cannot be had from the other.
        """
        physics = self.env.unwrapped.scene.px
        pressed: dict[str, FloatArray] = {}
        for contact in physics.get_contacts():
            names = {body.name for body in contact.bodies}
            if names & self._ours and names & self._theirs:
                impulse = np.sum([point.impulse for point in contact.points], axis=0)
                link = min(names & self._ours)
                pressed[link] = pressed.get(link, np.zeros(3)) + impulse / physics.timestep
        most = max((float(np.linalg.norm(force)) for force in pressed.values()), default=0.0)
        if most == 0.0:
            return np.zeros(3), 0.0
        carried = self._arm.get_link_incoming_joint_forces()[self.world.palm][:3]
        return np.array(carried, dtype=float), most


def sustained(forces: Sequence[float]) -> float:
    """Return the greatest mean over ``WINDOW`` control steps, of forces of one each [N]."""
    if len(forces) < WINDOW:
        return 0.0
    return float(np.convolve(forces, np.full(WINDOW, 1.0 / WINDOW), "valid").max())


def _press(kind: str, motion: FloatArray, hand: FloatArray) -> FloatArray:
    """Return how far beyond where it seems to be the hand is sent [m], shape [3]."""
    if kind == "push":
        return np.asarray(PRESS * motion / max(float(np.linalg.norm(motion)), 1e-9))
    return np.asarray(PRESS_ON * hand[:3, 2]) if kind == "drag" else np.zeros(3)


def _planned(goal: FloatArray, start: FloatArray, free: tuple[int, ...]) -> FloatArray:
    """Return ``goal`` in the planned joints, ``start`` in all others."""
    result = start.copy()
    result[list(free)] = goal[list(free)]
    return result
