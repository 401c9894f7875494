"""The demo meshes: eight objects, five as an artist models them, three as an image-to-3D tool gives them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .catalog import make_object
from .export import Y_UP, FileFrame, write_annotation, write_glb, write_obj, write_sidecar
from .generated import generated_like

LICENSE = "Apache-2.0"


@dataclass(frozen=True)
class _Example:
    """``style``: ``glb`` and ``obj`` are artist-like, ``fused`` is generated-like with ``bumps`` as its seed."""

    category: str
    seed: int
    style: str
    bumps: int = 0


EXAMPLES = (
    _Example("cabinet", 1, "glb"),
    _Example("fridge", 0, "obj"),
    _Example("oven", 0, "glb"),
    _Example("microwave", 1, "glb"),
    _Example("dishwasher", 0, "fused"),
    _Example("laptop", 1, "glb"),
    _Example("chest", 0, "fused"),
    _Example("trash_can", 3, "fused", bumps=1),
)


def write_example_meshes(folder: Path) -> None:
    """Write the demo meshes with their sidecars; existing files of the same names are replaced.

    Artist-like GLBs are in metres, the OBJ is in centimetres and z up; generated-like GLBs fill a
    unit cube, as such tools give them, and come with their ground truth as ``<name>.pred.npz``.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for example in EXAMPLES:
        _write(example, folder / example.category)


def _write(example: _Example, stem: Path) -> None:
    articulation = make_object(example.category, example.seed)
    sidecar: dict[str, str | float] = {"category": example.category}
    if example.style == "obj":
        write_obj(
            articulation.mesh,
            FileFrame(np.diag([100.0, 100.0, 100.0, 1.0])),
            stem.with_suffix(".obj"),
        )
        sidecar |= {"up": "z", "scale": 0.01}
    elif example.style == "glb":
        write_glb(articulation.mesh, FileFrame(Y_UP), stem.with_suffix(".glb"))
        sidecar |= {"scale": 1.0}
    else:
        articulation = generated_like(articulation, example.bumps)
        scale = 1.0 / float(articulation.mesh.extents.max())
        frame = FileFrame(np.diag([scale, scale, scale, 1.0]) @ Y_UP)
        write_glb(articulation.mesh, frame, stem.with_suffix(".glb"))
        annotation = f"{stem.name}.pred.npz"
        write_annotation(articulation, frame, stem.with_name(annotation))
        sidecar |= {
            "height": round(float(articulation.mesh.extents[2]), 4),
            "annotation": annotation,
        }
    write_sidecar(stem.with_suffix(".toml"), sidecar | {"license": LICENSE})
