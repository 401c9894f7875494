"""The kinds of dataset that are known, and who reads each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.errors import ConfigError

from ..samples.sampled_object import SampledObject
from .description import (
    find_descriptions,
    find_partnet,
    find_registered,
    find_usd,
    read_description,
)
from .item import SourceItem
from .labelled import find_labelled, read_labelled
from .predictions import find_predictions, read_prediction_item
from .published import find_published, read_published
from .settings import SourceSettings


@dataclass(frozen=True)
class SourceKind:
    """A kind of dataset.

    Attributes:
        find: the objects in a folder, cheaply: nothing is read yet.
        read: one of them; raises InputRejected with a reason code.
        wants: what an object of this kind is, for people.
        front: where its objects look, see :class:`SourceSettings`.
        modules: libraries without which some objects are refused, until the libraries come.
    """

    find: Callable[[Path], tuple[SourceItem, ...]]
    read: Callable[[SourceItem, SourceSettings], Articulation | SampledObject]
    wants: str
    front: str = "-y"
    modules: tuple[str, ...] = ()


SOURCES: Mapping[str, SourceKind] = {
    "description": SourceKind(
        find_descriptions, read_description, "a folder with a URDF or an MJCF each",
        modules=("mujoco",),
    ),
    "labelled": SourceKind(
        find_labelled, read_labelled, "a folder with an inventory of meshes that were labelled"
    ),
    "partnet": SourceKind(
        find_partnet, read_description, "PartNet-Mobility folders (mobility.urdf, meta.json)", "-x"
    ),
    "predictions": SourceKind(
        find_predictions, read_prediction_item, "meshes with a pred.npz beside them"
    ),
    "particulate": SourceKind(
        find_published, read_published,
        "the release's preprocessed folders (original.obj, meta.npz...) or point caches",
    ),
    "registry": SourceKind(find_registered, read_description, "an output folder of factory build"),
    "usd": SourceKind(
        find_usd, read_description,
        "a folder with a USD asset of rigid bodies and physics joints each",
    ),
}  # fmt: skip


def source(kind: str) -> SourceKind:
    """Return the kind of dataset of that name. Raises ConfigError naming the ones there are."""
    if kind not in SOURCES:
        raise ConfigError(f"no kind of dataset {kind!r}; there are {', '.join(SOURCES)}")
    return SOURCES[kind]
