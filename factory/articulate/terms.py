"""License terms that trained weights put on what they help to make."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..articulation import Articulation
from ..intake.intake import Intake
from ..intake.licenses import combined, require_allowed


def with_terms(
    intake: Intake, hypotheses: Sequence[Articulation], allowed: Sequence[str]
) -> Intake:
    """Return an input under its own license and those of the weights that proposed its parts.

    Args:
        intake: as loaded.
        hypotheses: of its articulation.
        allowed: licenses, as for :func:`~..intake.licenses.require_allowed`.

    Raises:
        InputRejected: ``license_disallowed``: the configuration does not allow these weights'.
    """
    named = (weights.outputs for each in hypotheses for weights in each.weights)
    outputs = {license for license in named if license}
    if not outputs:
        return intake
    provenance = intake.provenance
    license = combined(provenance.license, outputs)
    what = f"{provenance.input}, with the weights that are asked what moves"
    require_allowed(what, license, allowed, provenance.digest)
    return replace(intake, provenance=replace(provenance, license=license))
