"""Reading, describing and converting checkpoints of the networks this package knows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...errors import ConfigError
from ..network.shape import parameter_count, read_shape
from ..partfield.shape import read_partfield_shape
from .pickled import read_pickled
from .safetensors import Checkpoint, Shape, Tensor, read_safetensors, write_safetensors
from .sources import PARTFIELD, PARTICULATE, WeightsProvenance

UNSTATED = "Not stated in the file. The published weights of this network:"


@dataclass(frozen=True)
class WeightsInfo:
    """What a checkpoint holds.

    Attributes:
        file: where.
        network: which network it is for.
        details: its sizes and variant, in words and numbers.
        tensors: how many.
        parameters: how many numbers.
        dtypes: in which types, sorted.
        terms: under which they stand, by their own statement; else those of the network's
            published weights.
        outputs: the license that these put on whatever they help to make; empty if none.
    """

    file: Path
    network: str
    details: Mapping[str, str]
    tensors: int
    parameters: int
    dtypes: tuple[str, ...]
    terms: str
    outputs: str


def open_checkpoint(file: Path) -> Checkpoint:
    """Return what a file of weights holds: safetensors, or a zip archive of torch.save.

    Raises:
        ConfigError: neither format, or damaged.
    """
    try:
        with file.open("rb") as stream:
            start = stream.read(2)
        if start == b"PK":
            return read_pickled(file)
        if start == b"\x80\x02":
            old = "saved in torch's format from before 2020"
            raise ConfigError(f"{file}: {old}; load and save it again with torch")
        return read_safetensors(file)
    except OSError as error:
        raise ConfigError(f"{file}: cannot be read: {error.strerror or error}") from error
    except (MemoryError, RecursionError) as error:
        why = "its description is too large or too deep to be a checkpoint's"
        raise ConfigError(f"{file}: {why}") from error


def load_tensors(checkpoint: Checkpoint, leave: tuple[str, ...] = ()) -> dict[str, Tensor]:
    """Return copies of tensors, floats as float32, but those of names that begin with ``leave``."""
    import torch

    return {
        name: each.to(torch.float32 if each.is_floating_point() else each.dtype, copy=True)
        for name, each in checkpoint.load(leave).items()
    }


def filled(kind: Any, shape: Any, tensors: dict[str, Tensor], device: str) -> Any:
    """Return a network with its weights, ready to answer."""
    import torch

    with torch.device("meta"):
        network = kind(shape)
    network.load_state_dict(tensors, strict=True, assign=True)
    return network.to(device).eval().requires_grad_(False)


def describe(file: Path) -> WeightsInfo:
    """Return which network a checkpoint is for, and its sizes.

    Raises:
        ConfigError: not a checkpoint of a network this package knows.
    """
    checkpoint = open_checkpoint(file)
    provenance, details = checkpoint.read(_identify)
    own = checkpoint.metadata.get("terms")
    return WeightsInfo(
        file=file,
        network=provenance.network,
        details=details,
        tensors=len(checkpoint.shapes),
        parameters=parameter_count(checkpoint.shapes),
        dtypes=tuple(sorted(set(checkpoint.dtypes.values()))),
        terms=own or f"{UNSTATED} {provenance.terms}",
        outputs=checkpoint.metadata.get("outputs", "" if own else provenance.outputs),
    )


def convert(source: Path, target: Path) -> WeightsInfo:
    """Write a checkpoint as safetensors, its terms in the header; tensors keep names and types.

    Raises:
        ConfigError: not a checkpoint of a network this package knows, or ``target`` is no such
            name.
    """
    if target.suffix != ".safetensors":
        raise ConfigError(f"{target}: want a name that ends in .safetensors")
    if not target.parent.is_dir():
        raise ConfigError(f"{target.parent}: no such folder")
    info = describe(source)
    checkpoint = open_checkpoint(source)
    # A network's own metadata say how it is to be read.
    told = {"published_terms": info.terms, **checkpoint.metadata, "network": info.network}
    write_safetensors(target, checkpoint.load(), told)
    return describe(target)


def _identify(shapes: Mapping[str, Shape]) -> tuple[WeightsProvenance, dict[str, str]]:
    if any(name.startswith("triplane_transformer.") for name in shapes):
        field = read_partfield_shape(shapes)
        planes = f"3 x {field.resolution} x {field.resolution}"
        return PARTFIELD, {"features": str(field.features), "planes": planes}
    network = read_shape(shapes)
    inputs = ["points", *["normals"] * network.normals]
    inputs += [f"{network.features} features"] * bool(network.features)
    return PARTICULATE, {
        "blocks": str(network.blocks),
        "width": str(network.hidden),
        "heads": str(network.heads),
        "inputs": " + ".join(inputs),
        "axes": network.axis_form.value,
        "mask hypotheses": str(network.hypotheses),
    }
