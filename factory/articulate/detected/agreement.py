"""How likely a part is there by what the detector sees of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from ...models.perceptron import Perceptron
from ...models.shipped import Arrays, load_shipped

FILE = "agreement.safetensors"
#: Networks of the file, and what they are given.
PROPOSED = "proposed"
PANEL = "panel"
LID = "lid"
PROPOSED_SIGNS = ("support", "root of support", "by rules of shape", "anything opens")
PANEL_SIGNS = ("support", "root of support", "seams in relief", "handle")
SIGNS = {PROPOSED: PROPOSED_SIGNS, PANEL: PANEL_SIGNS, LID: ("support",)}


@dataclass(frozen=True)
class Agreement:
    """Logistic models, fitted to meshes that the detector did not learn from.

    Each is given the numbers that :data:`SIGNS` names.

    Attributes:
        proposed: of a part that somebody else proposes.
        panel: of a door, drawer or flap that only the detector sees.
        lid: of such a lid.
        least: probability below which a part stays fixed.
    """

    proposed: Perceptron
    panel: Perceptron
    lid: Perceptron
    least: float


@cache
def load_agreement() -> Agreement:
    """Return the models that come with the package.

    Raises:
        ConfigError: the file is for other signs.
    """
    return agreement_of(load_shipped(FILE))


def agreement_of(stored: Arrays) -> Agreement:
    """Return what a file holds; errors as for :func:`load_agreement`."""
    proposed, panel, lid = (Perceptron.read(stored, name, signs) for name, signs in SIGNS.items())
    return Agreement(proposed, panel, lid, float(stored.arrays["least"][0]))
