"""A checkpoint of a small untrained network: it answers, and its answers mean nothing."""

from weight_rule import weights

from asset_factory.factory.models.network.shape import NetworkShape, expected_tensors
from asset_factory.factory.models.weights.safetensors import write_safetensors

SHAPE = NetworkShape(hidden=32, blocks=2, heads=4, features=0)
GAINS = {"point_mask_decoder": 8.0, "part_hierarchy_decoder": 2.0, "part_motion_classifier": 8.0}


def write_checkpoint(file, base=0, metadata=None):
    """Weights by the seed rule; another ``base`` is another network. Returns ``file``."""
    write_safetensors(file, weights(expected_tensors(SHAPE), base, GAINS), metadata or {})
    return file
