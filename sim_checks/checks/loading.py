"""Does the engine hold what the file says? Silent drops and invented numbers become findings."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..config import CheckConfig, LoadingConfig
from ..description import Description, Link, LinkInertia, sensible
from ..report import Finding
from ..simulators.simulator import Observation
from ..simulators.world import LoadedLink
from .agreement import check_agreement
from .loading_joints import SINGLE, added, joint_findings, joint_numbers
from .result import (
    CheckResult,
    Findings,
    error,
    finite,
    graded,
    listed,
    measured,
    rounded,
    significant,
    three,
    warning,
)

MOST_WARNINGS = 3


def check_loading(
    description: Description, observation: Observation, config: CheckConfig
) -> CheckResult:
    """Compare links, shapes, masses, inertias, joints, limits and link poses with the file."""
    held = observation.model.links
    links = {link.name: link for link in held}
    joints = {joint.name: joint for joint in observation.model.joints}
    findings: list[Finding] = []
    for link in description.links:
        if not link.virtual:
            findings += _link_findings(link, links.get(link.name), config.loading)
    written = {link.name for link in description.links}
    # The ground that some engines count as a body is empty.
    bodies = (h for h in held if not (h.static and h.shapes == 0 and h.mass == 0.0))
    if more := tuple(body.name for body in bodies if body.name not in written):
        findings.append(added("links", more, parts=more))
    findings += joint_findings(description, joints, config.loading)
    findings += _invented(description, links)
    agreement = check_agreement(description, observation, config.loading)
    findings += agreement.findings
    if lines := observation.loader_lines:
        message = f"said while loading: {' | '.join(lines[:MOST_WARNINGS])}"
        findings.append(warning("loader_warning", message, **measured(float(len(lines)), "lines")))
    return CheckResult(tuple(findings), {**_numbers(observation), **agreement.measurements})


def _link_findings(link: Link, held: LoadedLink | None, config: LoadingConfig) -> Findings:
    parts = (link.name,)
    if held is None:
        message = f"link {link.name!r} of the file is not in the loaded model"
        yield error("link_missing", message, parts=parts)
        return
    written = len(link.collisions)
    count = rounded(held.shapes, "shapes", written)
    if held.shapes < written:
        words = f"{written - held.shapes} of {written} collision shapes of link {link.name!r}"
        yield error("shape_dropped", f"{words} were dropped", parts=parts, **count)
    elif held.shapes > written:
        words = f"holds {held.shapes} collision shapes, the file has {written}"
        yield warning("shape_added", f"link {link.name!r} {words}", parts=parts, **count)
    # A mass of nothing is no word to hold anyone to; it counts as invented below.
    inertia = link.inertia
    if inertia is None or inertia.mass <= 0.0 or held.moments is None:
        return
    # What is not sensible the lint says; there is no number to hold anyone to.
    if sensible(inertia.mass) and sensible(inertia.center) and sensible(inertia.tensor):
        yield from _inertia_findings(inertia, held, config)


def _inertia_findings(inertia: LinkInertia, held: LoadedLink, config: LoadingConfig) -> Findings:
    # What never moves is compared where the engine holds it, but its mass changes nothing.
    grave = not held.static
    parts = (held.name,)
    link = f"link {held.name!r}"
    mass = inertia.mass
    if not abs(held.mass - mass) <= config.mass * abs(mass):
        message = f"{link} weighs {held.mass:.6g} kg, the file says {mass:.6g} kg"
        told = measured(held.mass, "kg", mass)
        yield graded(grave, "mass_mismatch", message, parts=parts, **told)
    # A tensor that is no tensor is the lint's business; here only whether the engine holds the
    # same.
    written = np.linalg.eigvalsh(0.5 * (inertia.tensor + inertia.tensor.T))
    moments = np.array(held.moments)
    difference = np.abs(written - moments)
    worst = int(np.argmax(difference))
    if not difference[worst] <= config.inertia * float(np.abs(written).max()) + config.moment_floor:
        has = f"{link} has principal moments {three(moments)} kg m2"
        message = f"{has}, the file says {three(written)} kg m2"
        told = measured(float(moments[worst]), "kg m2", float(written[worst]))
        yield graded(grave, "inertia_mismatch", message, parts=parts, **told)
    if held.center is None:
        return
    offset = float(np.linalg.norm(np.array(held.center) - inertia.center))
    if not offset <= config.position_m:
        message = f"the centre of mass of {link} is {1000 * offset:.3g} mm from where the file says"
        told = measured(offset, "m", config.position_m)
        yield graded(grave, "center_mismatch", message, parts=parts, **told)


def _invented(description: Description, links: dict[str, LoadedLink]) -> Findings:
    names = []
    total = 0.0
    for link in description.links:
        held = links.get(link.name)
        written = link.inertia is not None and not link.inertia.mass <= 0.0
        if link.virtual or written or held is None or held.static or not link.collisions:
            continue
        names.append(link.name)
        total += held.mass
    if names:
        invented = f"invented mass and inertia, {total:.4g} kg in all"
        message = f"{invented}, for {listed(names)}: the file gives none"
        yield warning("inertia_invented", message, parts=tuple(names), **measured(total, "kg"))


def _numbers(observation: Observation) -> dict[str, Any]:
    links = observation.model.links
    return {
        "links": len(links),
        "joints": len(observation.model.joints),
        "shapes": sum(link.shapes for link in links),
        "mass_kg": finite(float(sum(link.mass for link in links))),
        "loader_lines": list(observation.loader_lines),
        "held_links": [
            {
                "link": link.name,
                "mass_kg": significant(link.mass, SINGLE),
                "shapes": link.shapes,
                "contact_friction": significant(link.friction, SINGLE),
            }
            for link in links
        ],
        "held_joints": [joint_numbers(joint) for joint in observation.model.joints],
    }
