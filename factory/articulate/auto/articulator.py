"""The automatic articulator: network predictions, shape rules and geometric evidence combined."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ...articulation import Articulation, Weights
from ...config import AutoConfig, BuildConfig, ParticulateConfig
from ...errors import ConfigError
from ...geometry.components import connected_components
from ...geometry.triangles import face_areas
from ...intake.intake import Intake
from ...mesh import Mesh
from ...models.particulate.inference import Network
from ...models.weights.sources import SHIPPED
from ...part import Proposer
from ..annotated import annotated_articulator
from ..articulator import Articulator
from ..assembly import assembled
from ..geometric import GeometricArticulator
from ..origin import MeshOrigin
from ..particulate import load_articulator
from ..proposal import Proposal
from ..rigid import rigid_articulation
from ..seams.knobs import knobs_of
from ..stated import StatedArticulator
from .contacts import contacts_of, settled
from .partition import share_out
from .parts import agreed_parts
from .proposals import copies_of, propose
from .trust import Trust, load_trust
from .views import MOST_VIEWS, look_around

#: Where nobody but the network sees anything that moves, the surest part must be this sure. Of 81
#: static meshes six opened below it: a bookshelf, a table, a box, a picture, tablets; of 110
#: objects that do open, four fall below it, with one joint right of five.
ALONE = 0.45


@dataclass(frozen=True)
class AutoArticulator:
    """Parts and joints that a network and the rules of shape propose, where they can be trusted.

    Attributes:
        network: answers for one cloud of points.
        weights: of that network, for the manifest.
        trust: how proposals are weighed.
        particulate: how the mesh is shown to the network.
        config: how many views, and how sure is sure enough.
    """

    name = "auto"

    network: Network
    weights: tuple[Weights, ...]
    trust: Trust
    particulate: ParticulateConfig
    config: AutoConfig

    def articulate(self, mesh: Mesh) -> Articulation:
        """Return what of ``mesh`` [m], z up, moves with some certainty; the rest is one rigid part.

        Network and rules see rubbish in a one-piece mesh: only its knobs are told.

        Raises:
            InputRejected: ``empty``, ``zero_size``: no surface to see; ``prediction_not_finite``:
                broken weights.
        """
        if MeshOrigin.of(mesh).is_generated:
            return knobs_of(mesh, self.name)
        decided = self.decide(mesh, self.proposals(mesh))
        return replace(decided, weights=self.weights)

    def _least(self, rated: Sequence[Proposal]) -> float:
        """Return how sure a part must be; one must be surer where only the network sees any."""
        asked = self.config.least_confidence
        least = self.trust.least if asked is None else asked
        likely = [each for each in rated if each.rated >= least]
        if not likely or asked is not None:
            return least
        guessed = all(each.proposer is Proposer.NETWORK and each.rated < ALONE for each in likely)
        return ALONE if guessed else least

    def _rated(self, mesh: Mesh, proposals: Sequence[Proposal]) -> list[Proposal]:
        chances = [self.trust.confidence(each.signs) for each in proposals]
        chances = [max(chances[copy] for copy in own) for own in copies_of(mesh, proposals)]
        return [
            replace(each, existence=chance, probability=chance)
            for each, chance in zip(proposals, chances, strict=True)
        ]

    def decide(self, mesh: Mesh, proposals: Sequence[Proposal]) -> Articulation:
        """Return the articulation of the proposals that can be trusted and be there together.

        Args:
            mesh: metres, z up.
            proposals: about its faces.
        """
        rated = self._rated(mesh, proposals)
        rated.sort(key=lambda proposal: -proposal.rated)
        least = self._least(rated)
        sure = [proposal for proposal in rated if proposal.rated >= least]
        left = [proposal for proposal in rated if proposal.rated < least]
        notes: tuple[str, ...] = ()
        if left:
            best = left[0].rated
            what = "1 part that may move was"
            if len(left) > 1:
                what = f"{len(left)} parts that may move were"
            surest = f"the surest of them is right with probability {best:.2f}, want {least:.2f}"
            notes = (f"{what} left fixed: {surest}",)
        sharing = share_out([proposal.faces for proposal in sure], face_areas(mesh))
        if not sharing.chosen:
            return rigid_articulation(
                mesh, self.name, notes or ("nothing in this mesh looks as if it moved",)
            )
        # Handles and mouldings that touch only a mover go with it.
        made = assembled(
            mesh,
            settled(contacts_of(mesh, connected_components(mesh)), sharing.face_part),
            [sure[index] for index in sharing.chosen],
            self.name,
            sharing.hosts,
        )
        return replace(made, notes=(*made.notes, *notes))

    def proposals(self, mesh: Mesh) -> tuple[Proposal, ...]:
        """Return everything of ``mesh`` [m], z up, that may move, by whoever says so."""
        areas = face_areas(mesh)
        contacts = contacts_of(mesh, connected_components(mesh))
        views = tuple(
            replace(view, face_part=settled(contacts, view.face_part))
            for view in look_around(mesh, self.network, self.particulate, self.config.views)
        )
        ruled = GeometricArticulator().proposals(mesh)
        return propose(mesh, areas, ruled, agreed_parts(views, areas))


def articulator_for(intake: Intake, config: BuildConfig) -> Articulator:
    """Return who is asked for one input.

    What came with it is believed; else the network of a checkpoint of the user's own is asked
    alone; else the detector, the shipped network and rules of shape.

    Raises:
        ConfigError: no usable checkpoint, no torch, or a setting that cannot be.
    """
    if intake.stated is not None:
        return StatedArticulator(intake.stated, _guess(config))
    return annotated_articulator(intake) or _guess(config)


def _guess(config: BuildConfig) -> Articulator:
    """Return who is asked where nothing came with the input."""
    if config.particulate.checkpoint == SHIPPED:
        from ..detected import DetectedArticulator

        guess = load_auto(config.particulate, config.auto)
        return DetectedArticulator(guess, config.auto.least_confidence)
    return load_articulator(config.particulate)


def load_auto(
    particulate: ParticulateConfig, config: AutoConfig, trust: Trust | None = None
) -> AutoArticulator:
    """Return the articulator with the shipped network, and trust, unless another is given.

    Raises:
        ConfigError: its weights cannot be read, or a setting cannot be.
    """
    if not 1 <= config.views <= MOST_VIEWS:
        raise ConfigError(f"views must be 1 to {MOST_VIEWS}, not {config.views}")
    settings = replace(particulate, points=config.points, context_points=config.context_points)
    learned = load_articulator(settings)
    return AutoArticulator(
        learned.network, learned.weights, trust or load_trust(), settings, config
    )
