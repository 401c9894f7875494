"""Does the engine hold what the file says? Silent drops and invented numbers become findings."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..config import CheckConfig, LoadingConfig
from ..description import Description, JointLine, Link, LinkInertia
from ..report import Finding, Severity
from ..simulators.simulator import LoadedJoint, LoadedLink, Observation
from .agreement import check_agreement
from .result import CheckResult

MOVING = ("revolute", "continuous", "prismatic")
#: Names spelled out in a sentence that concerns many.
MOST_NAMES = 4
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
    for line in description.joints:
        if line.kind != "fixed":
            findings.extend(_joint_findings(line, joints.get(line.name), simulator, config.loading))
    findings.extend(_ignored(description, joints, simulator))
    findings.extend(_invented(description, links, simulator))
    agreement = check_agreement(description, simulator, observation, config.loading)
    findings.extend(agreement.findings)
    findings.extend(_said(observation, simulator))
    return CheckResult(tuple(findings), {**_numbers(observation), **agreement.measurements})


def _link_findings(link: Link, held: LoadedLink | None, simulator: str, config: LoadingConfig) -> Iterator[Finding]:
    def found(code: str, message: str, severity: Severity = Severity.HARD, **numbers: Any) -> Finding:
        return Finding(code, severity, f"{simulator}: {message}", simulator=simulator, parts=(link.name,), **numbers)

    if held is None:
        yield found("link_missing", f"link {link.name!r} of the file did not arrive")
        return
    written = len(link.collisions)
    if held.shapes < written:
        message = f"{written - held.shapes} of {written} collision shapes of link {link.name!r} were dropped"
        yield found("shape_dropped", message, value=float(held.shapes), unit="shapes", limit=float(written))
    elif held.shapes > written:
        message = f"link {link.name!r} holds {held.shapes} collision shapes, the file has {written}"
        yield found(
            "shape_added", message, Severity.SOFT, value=float(held.shapes), unit="shapes", limit=float(written)
        )
    # A mass of nothing is no word to hold anyone to; it counts as invented below.
    if link.inertia is None or link.inertia.mass <= 0.0 or held.static or held.moments is None:
        return
    mass = link.inertia.mass
    if abs(held.mass - mass) > config.mass * abs(mass):
        message = f"link {link.name!r} weighs {held.mass:.6g} kg, the file says {mass:.6g} kg"
        yield found("mass_mismatch", message, value=held.mass, unit="kg", limit=mass)
    yield from _inertia_findings(link.name, link.inertia, held, simulator, config)


def _inertia_findings(
    name: str, inertia: LinkInertia, held: LoadedLink, simulator: str, config: LoadingConfig
) -> Iterator[Finding]:
    # A tensor that is no tensor is the lint's business; here only whether the engine holds the same.
    written = np.linalg.eigvalsh(0.5 * (inertia.tensor + inertia.tensor.T))
    difference = np.abs(written - np.array(held.moments))
    worst = int(np.argmax(difference))
    if difference[worst] > config.inertia * float(np.abs(written).max()) + config.moment_floor:
        message = (
            f"{simulator}: link {name!r} has principal moments {_three(held.moments)} kg m2, "
            f"the file says {_three(written)} kg m2"
        )
        number = {"value": float(np.array(held.moments)[worst]), "unit": "kg m2", "limit": float(written[worst])}
        yield Finding("inertia_mismatch", Severity.HARD, message, simulator=simulator, parts=(name,), **number)  # type: ignore[arg-type]
    if held.center is None:
        return
    offset = float(np.linalg.norm(np.array(held.center) - inertia.center))
    if offset > config.position_m:
        message = f"{simulator}: the centre of mass of link {name!r} is {1000 * offset:.3g} mm from where the file says"
        yield Finding(
            "center_mismatch", Severity.HARD, message, simulator, None, (name,), offset, "m", config.position_m
        )


def _joint_findings(
    line: JointLine, held: LoadedJoint | None, simulator: str, config: LoadingConfig
) -> Iterator[Finding]:
    def found(code: str, message: str, **numbers: Any) -> Finding:
        where = (line.parent, line.child)
        sentence = f"{simulator}: {message}"
        return Finding(code, Severity.HARD, sentence, simulator=simulator, joint=line.name, parts=where, **numbers)

    if held is None:
        yield found("joint_missing", f"joint {line.name!r} of the file did not arrive")
        return
    lower = -math.inf if line.lower is None else line.lower
    upper = math.inf if line.upper is None else line.upper
    unlimited = {"revolute", "continuous"}
    same_kind = held.kind == line.kind or (math.isinf(lower) and {held.kind, line.kind} <= unlimited)
    if line.kind in MOVING and not same_kind:
        yield found("joint_kind", f"joint {line.name!r} is {held.kind}, the file says {line.kind}")
    unit = "m" if line.kind == "prismatic" else "rad"
    for side, said, has in (("lower", lower, held.lower), ("upper", upper, held.upper)):
        if _differ(said, has, config.limit):
            message = f"{side} limit of joint {line.name!r} is {has:.6g} {unit}, the file says {said:.6g} {unit}"
            numbers = {"value": _finite(has), "unit": unit, "limit": _finite(said)}
            yield found("limit_mismatch", message, **numbers)


def _ignored(description: Description, joints: dict[str, LoadedJoint], simulator: str) -> Iterator[Finding]:
    for quantity in ("friction", "damping"):
        names = []
        for line in description.joints:
            held = joints.get(line.name)
            said = getattr(line, quantity)
            if held is None or line.kind not in MOVING or said == 0.0:
                continue
            has = getattr(held, quantity)
            if has is None or not math.isclose(has, said, rel_tol=1e-4):
                names.append(line.name)
        if names:
            message = f"{simulator} drops the {quantity} that the file gives to {_listed(names)}"
            yield Finding(
                f"{quantity}_ignored",
                Severity.SOFT,
                message,
                simulator=simulator,
                value=float(len(names)),
                unit="joints",
            )


def _invented(description: Description, links: dict[str, LoadedLink], simulator: str) -> Iterator[Finding]:
    names, total = [], 0.0
    for link in description.links:
        held = links.get(link.name)
        written = link.inertia is not None and link.inertia.mass > 0.0
        if link.virtual or written or held is None or held.static or not link.collisions:
            continue
        names.append(link.name)
        total += held.mass
    if names:
        message = (
            f"{simulator} invented mass and inertia, {total:.4g} kg in all, for {_listed(names)}: the file gives none"
        )
        yield Finding("inertia_invented", Severity.SOFT, message, simulator, None, tuple(names), total, "kg")


def _said(observation: Observation, simulator: str) -> Iterator[Finding]:
    lines = observation.model.warnings
    if lines:
        message = f"{simulator} said while loading: {' | '.join(lines[:MOST_WARNINGS])}"
        yield Finding("loader_warning", Severity.SOFT, message, simulator, None, (), float(len(lines)), "lines")


def _numbers(observation: Observation) -> dict[str, Any]:
    links = observation.model.links
    return {
        "links": len(links),
        "joints": len(observation.model.joints),
        "shapes": sum(link.shapes for link in links),
        "mass_kg": float(sum(link.mass for link in links)),
        "loader_lines": list(observation.model.warnings),
    }


def _differ(said: float, has: float, tolerance: float) -> bool:
    if math.isinf(said) or math.isinf(has):
        return said != has
    return abs(said - has) > tolerance * max(1.0, abs(said))


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _three(values: Any) -> str:
    return "(" + ", ".join(f"{float(v):.4g}" for v in values) + ")"


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return ", ".join(repr(name) for name in names[:MOST_NAMES]) + more
