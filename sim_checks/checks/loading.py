"""Does the engine hold what the file says? Silent drops and invented numbers become findings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..config import CheckConfig, LoadingConfig
from ..description import Description, Link, LinkInertia, sensible
from ..report import Finding
from ..simulators.simulator import LoadedLink, Observation
from .agreement import check_agreement
from .loading_joints import SINGLE, joint_findings, joint_numbers
from .result import (
    CheckResult,
    Concerned,
    Details,
    error,
    finite,
    graded,
    listed,
    significant,
    three,
    warning,
)

MOST_WARNINGS = 3


def check_loading(
    description: Description, simulator: str, observation: Observation, config: CheckConfig
) -> CheckResult:
    """Compare links, shapes, masses, inertias, joints, limits and link poses with the file.

    Args:
        description: what the file says.
        simulator: whose word ``observation`` is.
        observation: from :func:`~asset_factory.sim_checks.simulators.observe.observe`.
        config: tolerances in ``config.loading``.
    """
    links = {link.name: link for link in observation.model.links}
    joints = {joint.name: joint for joint in observation.model.joints}
    findings: list[Finding] = []
    for link in description.links:
        if not link.virtual:
            findings.extend(_link_findings(link, links.get(link.name), simulator, config.loading))
    findings.extend(_added(description, observation.model.links, simulator))
    findings.extend(joint_findings(description, joints, simulator, config.loading))
    findings.extend(_invented(description, links, simulator))
    agreement = check_agreement(description, simulator, observation, config.loading)
    findings.extend(agreement.findings)
    if lines := observation.model.warnings:
        message = f"{simulator} said while loading: {' | '.join(lines[:MOST_WARNINGS])}"
        count = float(len(lines))
        findings.append(
            warning("loader_warning", message, simulator=simulator, value=count, unit="lines")
        )
    return CheckResult(tuple(findings), {**_numbers(observation), **agreement.measurements})


def _link_findings(
    link: Link, held: LoadedLink | None, simulator: str, config: LoadingConfig
) -> Iterator[Finding]:
    subject: Concerned = {"simulator": simulator, "parts": (link.name,)}
    if held is None:
        message = f"{simulator}: link {link.name!r} of the file is not in the loaded model"
        yield error("link_missing", message, **subject)
        return
    written = len(link.collisions)
    details: Details = {"simulator": simulator, "parts": (link.name,), "unit": "shapes"}
    details["value"] = float(held.shapes)
    details["limit"] = float(written)
    if held.shapes < written:
        words = f"{written - held.shapes} of {written} collision shapes of link {link.name!r}"
        yield error("shape_dropped", f"{simulator}: {words} were dropped", **details)
    elif held.shapes > written:
        words = f"holds {held.shapes} collision shapes, the file has {written}"
        yield warning("shape_added", f"{simulator}: link {link.name!r} {words}", **details)
    # A mass of nothing is no word to hold anyone to; it counts as invented below.
    inertia = link.inertia
    if inertia is None or inertia.mass <= 0.0 or held.moments is None:
        return
    if not (sensible(inertia.mass) and sensible(inertia.center) and sensible(inertia.tensor)):
        # The lint says so; there is no number to hold anyone to.
        return
    yield from _inertia_findings(inertia, held, subject, config)


def _inertia_findings(
    inertia: LinkInertia, held: LoadedLink, subject: Concerned, config: LoadingConfig
) -> Iterator[Finding]:
    # What never moves is compared where the engine holds it, but its mass changes nothing.
    grave = not held.static
    name = held.name
    simulator = subject["simulator"]
    mass = inertia.mass
    if not abs(held.mass - mass) <= config.mass * abs(mass):
        message = (
            f"{simulator}: link {name!r} weighs {held.mass:.6g} kg, the file says {mass:.6g} kg"
        )
        weight = finite(held.mass)
        yield graded(
            grave, "mass_mismatch", message, **subject, value=weight, unit="kg", limit=mass
        )
    # A tensor that is no tensor is the lint's business; here only whether the engine holds the
    # same.
    written = np.linalg.eigvalsh(0.5 * (inertia.tensor + inertia.tensor.T))
    moments = np.array(held.moments)
    difference = np.abs(written - moments)
    worst = int(np.argmax(difference))
    if not difference[worst] <= config.inertia * float(np.abs(written).max()) + config.moment_floor:
        message = (
            f"{simulator}: link {name!r} has principal moments {three(moments)} kg m2, "
            f"the file says {three(written)} kg m2"
        )
        value = finite(float(moments[worst]))
        limit = float(written[worst])
        yield graded(
            grave, "inertia_mismatch", message, **subject, value=value, unit="kg m2", limit=limit
        )
    if held.center is None:
        return
    offset = float(np.linalg.norm(np.array(held.center) - inertia.center))
    if not offset <= config.position_m:
        message = (
            f"{simulator}: the centre of mass of link {name!r} is {1000 * offset:.3g} mm "
            "from where the file says"
        )
        limit = config.position_m
        yield graded(
            grave,
            "center_mismatch",
            message,
            **subject,
            value=finite(offset),
            unit="m",
            limit=limit,
        )


def _added(
    description: Description, links: tuple[LoadedLink, ...], simulator: str
) -> Iterator[Finding]:
    written = {link.name for link in description.links}
    # The ground that some engines count as a body is empty.
    names = [
        held.name
        for held in links
        if held.name not in written and not (held.static and held.shapes == 0 and held.mass == 0.0)
    ]
    if names:
        message = (
            f"{simulator} holds {len(names)} links that the file does not have, "
            f"want none: {listed(names)}"
        )
        subject: Concerned = {"simulator": simulator, "parts": tuple(names)}
        count = float(len(names))
        yield warning("link_added", message, **subject, value=count, unit="links", limit=0.0)


def _invented(
    description: Description, links: dict[str, LoadedLink], simulator: str
) -> Iterator[Finding]:
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
        message = (
            f"{simulator} invented mass and inertia, {total:.4g} kg in all, "
            f"for {listed(names)}: the file gives none"
        )
        subject: Concerned = {"simulator": simulator, "parts": tuple(names)}
        yield warning("inertia_invented", message, **subject, value=finite(total), unit="kg")


def _numbers(observation: Observation) -> dict[str, Any]:
    links = observation.model.links
    return {
        "links": len(links),
        "joints": len(observation.model.joints),
        "shapes": sum(link.shapes for link in links),
        "mass_kg": finite(float(sum(link.mass for link in links))),
        "loader_lines": list(observation.model.warnings),
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
