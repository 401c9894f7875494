"""The one interface behind which every articulation method stands."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from ..articulation import Articulation
from ..mesh import Mesh


class Articulator(Protocol):
    """Says which faces move together, and how."""

    @property
    def name(self) -> str:
        """Return how it is chosen on the command line."""

    def articulate(self, mesh: Mesh) -> Articulation:
        """Return the mesh's kinematic tree.

        Args:
            mesh: the whole object, metres, z up.

        Returns:
            An articulation over the same mesh; what had to be guessed is in its ``notes``.

        Raises:
            InputRejected: this method cannot make sense of this mesh; code and sentence say why.
        """


@runtime_checkable
class HypothesisMaker(Protocol):
    """An articulator that knows several ways in which a mesh may be articulated."""

    def hypotheses(self, mesh: Mesh) -> tuple[Articulation, ...]:
        """Return them, the likeliest first.

        Args:
            mesh: the whole object, metres, z up.
        """

    def articulate(self, mesh: Mesh) -> Articulation:
        """Return the likeliest hypothesis of ``mesh`` [m], z up."""
        return self.hypotheses(mesh)[0]


def make_hypotheses(articulator: Articulator, mesh: Mesh) -> tuple[Articulation, ...]:
    """Return the hypotheses of any articulator, the likeliest first; one, if it knows one way.

    Args:
        articulator: that is asked; errors are its own.
        mesh: the whole object, metres, z up.
    """
    if isinstance(articulator, HypothesisMaker):
        return articulator.hypotheses(mesh)
    return (articulator.articulate(mesh),)
