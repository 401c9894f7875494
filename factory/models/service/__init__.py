"""One process that holds the network, and everybody else's questions to it over a local socket."""

from .answering import identity_of
from .asking import Address, asking, network_for
from .process import ModelService

__all__ = ["Address", "ModelService", "asking", "identity_of", "network_for"]
