"""A sideboard whose doors no seam, handle or crease shows: the mesh that needs its sidecar.

python examples/stated/sideboard.py    writes sideboard.glb beside itself; Apache-2.0, as all here
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh

#: Low and high corners [m] of body, top and plinth; z up, front towards -y.
BOXES = (
    ((-0.60, -0.22, 0.08), (0.60, 0.22, 0.72)),
    ((-0.62, -0.24, 0.72), (0.62, 0.24, 0.75)),
    ((-0.57, -0.18, 0.00), (0.57, 0.20, 0.08)),
)
#: From z up to y up, as glTF has it.
UPRIGHT = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1.0]])


def main() -> None:
    """Write the mesh."""
    boxes = [trimesh.creation.box(bounds=bounds) for bounds in BOXES]
    mesh = trimesh.boolean.union(boxes, engine="manifold")
    mesh.apply_transform(UPRIGHT).export(Path(__file__).with_suffix(".glb"))


if __name__ == "__main__":
    main()
