"""Every code that the factory may say, and what it means; ``docs/reasons.md`` is made from this.

What the validator may say is in :mod:`asset_factory.sim_checks.reasons`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from asset_factory.sim_checks import Severity
from asset_factory.sim_checks import reasons as judge

#: The input could not become an asset.
INPUT: Mapping[str, str] = {
    "unsupported": "a format, or a feature of one, that is not read",
    "empty": "no triangles",
    "absurd_size": "it would measure under a micrometre, or reach over 1000 km [m]",
    "license_disallowed": "it stands under none of the licenses in `intake.allowed_licenses`",
    "input_changed": "somebody was writing its files each time they were read [readings]",
    "zero_size": "flat in two directions",
    "external_reference": "it refers to a file outside its folder, or to a network address",
    "bad_sidecar": "the sidecar beside it cannot be used",
    "bad_annotation": "the `pred.npz` beside it, or its joints, cannot be used",
    "stated_part_not_found": "a part that its sidecar states is not where it says [of its area]",
    "bad_answer": "the model that was asked what opens did not answer in the form, twice",
    "no_annotation": "`annotated` was asked for, and no joints came with it",
    "no_limits": "a slide without limits",
    "bad_axis": "a joint's axis has no direction",
    "unsupported_joint": "a joint of a kind that is not made",
    "no_movable_joint": "nothing moves, so there is nothing to open [joints]",
    "prediction_not_finite": "the network answered with NaN: its weights are broken [numbers]",
    "too_many_hulls": "a part needs more convex pieces than the limit [hulls]",
    "decomposition_failed": "no body to collide with can be made of a part",
}

#: An object of a dataset cannot be trained on, or evaluated; it is passed over and counted.
DATASET: Mapping[str, str] = {
    "too_many_parts": "more moving parts than the network can tell apart [parts]",
    "bad_sample": "a sample's file is damaged, or says what cannot be",
    "not_made": "the procedural generator failed at one object",
    "nothing_seen": "nothing that moves is seen from outside: no one-piece mesh can be made",
}

#: Said of an asset on the way; no reason to reject.
WARNINGS: Mapping[str, str] = {
    "hidden_overlap": "what two parts overlapped at a joint was cut out of collision geometry [mm]",
    "planed": "what was taken off collision geometry that can be seen, so that parts clear [mm]",
    "meshes_overlap": "hulls were left overlapping, because the meshes themselves do",
    "not_separated": "hulls were left overlapping, because no cut keeps both parts",
    "hulls_joined": "hulls of a part were joined, because the asset has many",
    "degraded_decomposition": "what was given up in the decomposition of a part",
    "other_reading": "other hypotheses of the input, and what became of them",
    "articulation_note": "what was assumed or guessed of parts and joints",
}

#: Nobody could say; another run asks again.
UNJUDGED: Mapping[str, str] = {
    "model_unavailable": "the model that was to be asked what opens gave no answer",
}


@dataclass(frozen=True)
class CodeTable:
    """Codes that stand together on the page.

    Attributes:
        heading: of the page's section.
        severity: of findings with these codes.
        meanings: of each code.
    """

    heading: str
    severity: Severity
    meanings: Mapping[str, str]


#: Tables of the page, in order. A code means one thing for each severity that it is said with.
TABLES: tuple[CodeTable, ...] = (
    CodeTable("The input could not become an asset", Severity.ERROR, INPUT),
    CodeTable("The input, or a description, could not be read", Severity.ERROR, judge.UNREADABLE),
    CodeTable("The object cannot be trained on, or evaluated", Severity.ERROR, DATASET),
    CodeTable("The asset was made and did not pass", Severity.ERROR, judge.ERRORS),
    CodeTable(
        "Nobody could say (status `unjudged`, exit code 3)",
        Severity.ERROR,
        {**judge.UNJUDGED, **UNJUDGED},
    ),
    CodeTable(
        "Worth knowing, no reason to reject", Severity.WARNING, {**judge.WARNINGS, **WARNINGS}
    ),
    CodeTable("How it was validated, nothing to mend", Severity.NOTE, judge.NOTES),
)

#: What each code means where a finding of some severity says it.
MEANINGS: Mapping[tuple[Severity, str], str] = {
    (table.severity, code): meaning for table in TABLES for code, meaning in table.meanings.items()
}

#: Every code there is.
CODES: frozenset[str] = frozenset(code for _, code in MEANINGS)


def meaning_of(severity: Severity, code: str) -> str:
    """Return what a code means where a finding of some severity says it; empty for an unknown one.

    One that means the same at every severity is declared for the gravest only.
    """
    return next((MEANINGS[s, code] for s in (severity, *Severity) if (s, code) in MEANINGS), "")
