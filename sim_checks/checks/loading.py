"""Does the engine hold what the file says? Silent drops and invented numbers become findings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..config import CheckConfig, LoadingConfig
from ..description import Description, Link, LinkInertia, sensible
from ..report import Finding, Severity
from ..simulators.simulator import LoadedLink, Observation
from .agreement import check_agreement
from .loading_joints import finite, joint_findings, joint_numbers, listed, rounded
from .result import CheckResult, warning

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
    findings.extend(_said(observation, simulator))
    return CheckResult(tuple(findings), {**_numbers(observation), **agreement.measurements})


def _link_findings(
    link: Link, held: LoadedLink | None, simulator: str, config: LoadingConfig
) -> Iterator[Finding]:
    def found(
        code: str, message: str, severity: Severity = Severity.ERROR, **numbers: Any
    ) -> Finding:
        return Finding(
            code,
            severity,
            f"{simulator}: {message}",
            simulator=simulator,
            parts=(link.name,),
            **numbers,
        )

    if held is None:
        yield found("link_missing", f"link {link.name!r} of the file is not in the loaded model")
        return
    written = len(link.collisions)
    if held.shapes < written:
        message = (
            f"{written - held.shapes} of {written} collision shapes of link "
            f"{link.name!r} were dropped"
        )
        yield found(
            "shape_dropped", message, value=float(held.shapes), unit="shapes", limit=float(written)
        )
    elif held.shapes > written:
        message = f"link {link.name!r} holds {held.shapes} collision shapes, the file has {written}"
        yield found(
            "shape_added",
            message,
            Severity.WARNING,
            value=float(held.shapes),
            unit="shapes",
            limit=float(written),
        )
    # A mass of nothing is no word to hold anyone to; it counts as invented below.
    if link.inertia is None or link.inertia.mass <= 0.0 or held.moments is None:
        return
    # What never moves is compared where the engine holds it, but its mass changes nothing.
    weight = Severity.WARNING if held.static else Severity.ERROR
    mass = link.inertia.mass
    if not (sensible(mass) and sensible(link.inertia.center) and sensible(link.inertia.tensor)):
        # The lint says so; there is no number to hold anyone to.
        return
    if not abs(held.mass - mass) <= config.mass * abs(mass):
        message = f"link {link.name!r} weighs {held.mass:.6g} kg, the file says {mass:.6g} kg"
        yield found(
            "mass_mismatch", message, weight, value=finite(held.mass), unit="kg", limit=mass
        )
    yield from _inertia_findings(link.name, link.inertia, held, simulator, config)


def _inertia_findings(
    name: str, inertia: LinkInertia, held: LoadedLink, simulator: str, config: LoadingConfig
) -> Iterator[Finding]:
    severity = Severity.WARNING if held.static else Severity.ERROR
    # A tensor that is no tensor is the lint's business; here only whether the engine holds the
    # same.
    written = np.linalg.eigvalsh(0.5 * (inertia.tensor + inertia.tensor.T))
    moments = np.array(held.moments)
    difference = np.abs(written - moments)
    worst = int(np.argmax(difference))
    if not difference[worst] <= config.inertia * float(np.abs(written).max()) + config.moment_floor:
        message = (
            f"{simulator}: link {name!r} has principal moments {_three(held.moments)} kg m2, "
            f"the file says {_three(written)} kg m2"
        )
        yield Finding(
            "inertia_mismatch",
            severity,
            message,
            simulator=simulator,
            parts=(name,),
            value=finite(float(moments[worst])),
            unit="kg m2",
            limit=float(written[worst]),
        )
    if held.center is None:
        return
    offset = float(np.linalg.norm(np.array(held.center) - inertia.center))
    if not offset <= config.position_m:
        message = (
            f"{simulator}: the centre of mass of link {name!r} is {1000 * offset:.3g} mm "
            "from where the file says"
        )
        yield Finding(
            "center_mismatch",
            severity,
            message,
            simulator,
            None,
            (name,),
            finite(offset),
            "m",
            config.position_m,
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
        count = float(len(names))
        yield warning(
            "link_added",
            message,
            simulator=simulator,
            parts=tuple(names),
            value=count,
            unit="links",
            limit=0.0,
        )


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
        yield warning(
            "inertia_invented",
            message,
            simulator=simulator,
            parts=tuple(names),
            value=finite(total),
            unit="kg",
        )


def _said(observation: Observation, simulator: str) -> Iterator[Finding]:
    lines = observation.model.warnings
    if lines:
        message = f"{simulator} said while loading: {' | '.join(lines[:MOST_WARNINGS])}"
        yield warning(
            "loader_warning", message, simulator=simulator, value=float(len(lines)), unit="lines"
        )


def _numbers(observation: Observation) -> dict[str, Any]:
    links = observation.model.links
    return {
        "links": len(links),
        "joints": len(observation.model.joints),
        "shapes": sum(link.shapes for link in links),
        "mass_kg": finite(float(sum(link.mass for link in links))),
        "loader_lines": list(observation.model.warnings),
        "held_links": [_link_numbers(link) for link in links],
        "held_joints": [joint_numbers(joint) for joint in observation.model.joints],
    }


def _link_numbers(link: LoadedLink) -> dict[str, Any]:
    friction = None if link.friction is None else rounded(link.friction)
    return {
        "link": link.name,
        "mass_kg": rounded(link.mass),
        "shapes": link.shapes,
        "contact_friction": friction,
    }


def _three(values: Any) -> str:
    return "(" + ", ".join(f"{float(v):.4g}" for v in values) + ")"
