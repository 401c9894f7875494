"""What an engine that holds exactly what the file says would report, and how to make it lie."""

from dataclasses import replace

import numpy as np
from fault_corpus.things import renewed

from asset_factory.sim_checks.checks.loading import check_loading
from asset_factory.sim_checks.config import CheckConfig
from asset_factory.sim_checks.description import Description
from asset_factory.sim_checks.geometry.kinematics import build_tree, unit_axis
from asset_factory.sim_checks.simulators.simulator import (
    LoadedJoint,
    LoadedLink,
    LoadedModel,
    Observation,
    PoseSample,
)


def faithful(description: Description) -> Observation:
    links = []
    for link in description.links:
        assert link.inertia is not None
        a, b, c = np.linalg.eigvalsh(link.inertia.tensor).tolist()
        x, y, z = link.inertia.center.tolist()
        links.append(
            LoadedLink(link.name, link.inertia.mass, len(link.collisions), (a, b, c), (x, y, z))
        )
    joints = []
    for line in description.joints:
        x, y, z = unit_axis(line).tolist()
        numbers = (line.lower or 0.0, line.upper or 0.0, line.damping, line.friction)
        joints.append(LoadedJoint(line.name, line.kind, *numbers, (x, y, z), line.mimic))
    tree = build_tree(description)
    values = tree.completed(
        {"slide": 0.1} if description.joints[-1].mimic else {"slide": 0.1, "hinge": 0.7}
    )
    return Observation(
        LoadedModel(tuple(links), tuple(joints), ()), (PoseSample(values, tree.link_poses(values)),)
    )


def found(description: Description, observation: Observation) -> list[str]:
    judged = check_loading(description, "engine", observation, CheckConfig())
    return [finding.code for finding in judged.findings]


def with_link(observation: Observation, link: str, /, **changes: object) -> Observation:
    links = renewed(observation.model.links, link, **changes)
    return replace(observation, model=replace(observation.model, links=links))


def with_joint(observation: Observation, joint: str, /, **changes: object) -> Observation:
    joints = renewed(observation.model.joints, joint, **changes)
    return replace(observation, model=replace(observation.model, joints=joints))
