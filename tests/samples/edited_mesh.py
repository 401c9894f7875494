"""A mesh that is rejected as it is: nothing on it looks as if it opened."""

from pathlib import Path

from one_piece import plain_box
from trimesh import Trimesh

#: z up to glTF's y up.
Y_UP = [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]


def write_oven(folder: Path) -> Path:
    """Write a plain box, a dishwasher without a seam, as GLB; returns the file."""
    mesh = plain_box()
    path = folder / "oven.glb"
    Trimesh(mesh.vertices @ Y_UP, mesh.faces, process=False).export(path)
    return path
