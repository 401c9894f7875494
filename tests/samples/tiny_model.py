"""Networks with weights from their tensors' names, most of them small, as models in memory."""

from functools import cache

import numpy as np
import torch  # noqa: TID253
from weight_rule import weights

from asset_factory.factory.models.network.shape import NetworkShape, expected_tensors
from asset_factory.factory.models.network.transformer import PartArticulationTransformer
from asset_factory.factory.models.partfield.encoder import PartFieldEncoder
from asset_factory.factory.models.partfield.shape import PartFieldShape
from asset_factory.factory.models.partfield.shape import expected_tensors as expected_field_tensors
from asset_factory.factory.models.particulate.field import FeatureField
from asset_factory.factory.models.particulate.model import Model, PointCloud

TINY = NetworkShape(hidden=32, blocks=3, heads=4, features=6)
TINY_FIELD = PartFieldShape(
    channels=8, unet=(8, 16), resolution=8, width=16, layers=1, plane_channels=72
)
GAINS = {"point_mask_decoder": 3.0, "part_hierarchy_decoder": 2.0}


def model_of(shape, gains, dtype=torch.float32):
    """A model of that shape."""
    with torch.device("meta"):
        network = PartArticulationTransformer(shape)
    network.load_state_dict(weights(expected_tensors(shape), 0, gains), assign=True)
    return Model(shape, dtype, network.eval().requires_grad_(False))


@cache
def tiny_model(shape=TINY, dtype=torch.float32):
    """The same, made once."""
    return model_of(shape, GAINS, dtype)


def field_of(shape, dtype=torch.float32):
    """A field of that shape."""
    with torch.device("meta"):
        encoder = PartFieldEncoder(shape)
    encoder.load_state_dict(weights(expected_field_tensors(shape), 0), assign=True)
    return FeatureField(shape, dtype, "cpu", encoder.eval().requires_grad_(False))


def random_cloud(count, shape=TINY, seed=0):
    """Points, normals and features without meaning."""
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(count, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    features = rng.normal(size=(count, shape.features)) if shape.features else None
    return PointCloud(rng.uniform(-0.5, 0.5, (count, 3)), normals, features)


def plainly(model, cloud, owners=None):
    """Mask logits, closest points (best part or nothing) and part outputs, in training form.

    ``owners``: the part of each point, if it is not the best.
    """
    network = model._network
    batch = [
        None if each is None else torch.tensor(each)[None]
        for each in (cloud.points, cloud.normals, cloud.features)
    ]
    with torch.no_grad():
        hidden, queries = network(*batch)
        masks = network.mask_logits(hidden, queries)
        ids = masks.argmax(-1) if owners is None else torch.tensor(owners)[None]
        closest = None
        if hasattr(network, "point_motion_decoder"):
            closest = network.closest_points(hidden, queries, ids)[0].numpy()
        return masks[0].numpy(), closest, network.part_outputs(queries)
