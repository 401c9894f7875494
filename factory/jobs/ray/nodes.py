"""Which of a cluster's nodes are given work."""

from __future__ import annotations

import os
import socket
import time
from contextlib import suppress
from typing import Any

from ...runtime.terminal import complain
from .cluster import ClusterLost

#: A node whose disk was full, or where processes died, is asked again after so long [s].
FULL_S = 600.0
#: So many calls that were sent to a node by name died there, and it is set aside.
MOST_DEATHS = 2


class NoNodeLeft(ClusterLost):
    """No node of the cluster can be given work; says why of each."""


class Nodes:
    """The nodes of one run; standard error is told, once of each node, why it is set aside."""

    def __init__(self, ray: Any) -> None:
        self._ray = ray
        self._aside: dict[str, tuple[str, float]] = {}
        self._deaths: dict[str, set[str]] = {}
        self._turn = 0
        self._buried: set[str] = set()

    def set_aside(self, node: str, why: str, seconds: float = float("inf")) -> None:
        """Give a node no work, for good or for a while [s].

        Raises:
            NoNodeLeft: it was the last one.
        """
        told = node in self._aside
        address = self._alive().get(node, {}).get("NodeManagerAddress", node)
        self._aside[node] = (f"node {address}: {why}", time.monotonic() + seconds)
        if not told:
            complain(f"factory: a node is given no work; {self._aside[node][0]}")
        self.require_fit()

    def require_fit(self) -> None:
        """Raise NoNodeLeft if there are nodes, and each of them is set aside."""
        working = self._working()
        if working and not self._fit():
            reasons = "; ".join(self._aside[name][0] for name in working)
            raise NoNodeLeft(f"no node of the cluster can be given work: {reasons}")

    def next(self) -> str:
        """Return the node whose turn it is, for a call lost nobody knows where; empty: none."""
        fit = self._fit()
        self._turn += 1
        return fit[self._turn % len(fit)] if fit else ""

    def died(self, node: str, call: str) -> None:
        """Note that Ray's process died with a call that was sent to that node by name.

        A node whose disk is full takes every call, and loses it: no process of Ray's can begin.
        The last node is kept: it may be the calls.
        """
        calls = self._deaths.setdefault(node, set())
        calls.add(call)
        others = [name for name in self._fit() if name != node]
        if others and node in self._alive() and len(calls) >= MOST_DEATHS:
            calls.clear()
            self.set_aside(node, f"{MOST_DEATHS} calls died there with Ray's processes", FULL_S)

    def hang_up(self) -> None:
        """End this process's connections to hosts whose nodes are dead.

        A host that is cut off closes none, and Ray then waits for its answers: for minutes, or, if
        the host has given up before it is back, for good.
        """
        nodes = self._ray.nodes()
        dead = [each for each in nodes if not each["Alive"] and each["NodeID"] not in self._buried]
        self._buried |= {each["NodeID"] for each in dead}
        alive = {each["NodeManagerAddress"] for each in nodes if each["Alive"]}
        hosts = {each["NodeManagerAddress"] for each in dead} - alive
        if hosts:
            end_connections(hosts)

    def options(self, node: str = "") -> dict[str, Any]:
        """Return where a task may run, as Ray is told; on that node, as long as it is there."""
        if node:
            affinity = self._ray.util.scheduling_strategies.NodeAffinitySchedulingStrategy
            return {"scheduling_strategy": affinity(node, soft=True)}
        aside = ",".join(sorted(self._aside_now()))
        return {"label_selector": {"ray.io/node-id": f"!in({aside})"}} if aside else {}

    def _working(self) -> list[str]:
        alive = sorted(self._alive().items())
        return [name for name, each in alive if each["Resources"].get("CPU", 0.0) > 0.0]

    def _fit(self) -> list[str]:
        aside = self._aside_now()
        return [name for name in self._working() if name not in aside]

    def _aside_now(self) -> frozenset[str]:
        now = time.monotonic()
        return frozenset(node for node, (_, until) in self._aside.items() if until > now)

    def _alive(self) -> dict[str, Any]:
        return {each["NodeID"]: each for each in self._ray.nodes() if each["Alive"]}


def end_connections(hosts: set[str]) -> None:
    """End this process's TCP connections to some addresses, whoever in it holds them."""
    for name in os.listdir("/dev/fd"):
        with suppress(OSError), socket.socket(fileno=os.dup(int(name))) as held:
            if held.family not in (socket.AF_INET, socket.AF_INET6):
                continue
            # An old address looks like a new one to a socket that takes both.
            if held.getpeername()[0].removeprefix("::ffff:") in hosts:
                held.shutdown(socket.SHUT_RDWR)
