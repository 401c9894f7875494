"""Inputs of every kind of which one file names another, each small and quickly built."""

from pathlib import Path

import numpy as np
import trimesh
from PIL import Image

_BOXES = 3
_CART = """<robot name="cart">
  <link name="body"><visual><geometry><mesh filename="package://carts/parts/body.obj"/></geometry>
  </visual></link>
  <link name="lid"><visual><geometry><mesh filename="parts/lid.stl"/></geometry></visual></link>
  <joint name="hinge" type="revolute">
    <parent link="body"/><child link="lid"/><origin xyz="0 0.2 0.25"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="1.2" effort="10" velocity="1"/>
  </joint>
</robot>
"""


def write_inputs(folder: Path) -> Path:
    """The folder, with boxes, and what is made of several files, in subfolders of a new folder.

    ``cart``: a description with meshes, one of them with a texture; ``painted``: materials and a
    texture whose name has a space; ``strange``: materials in a file that is not called like one;
    ``leads_out``: a link to outside; ``nothing``: no faces.
    """
    folder.mkdir()
    for number in range(_BOXES):
        box = trimesh.creation.box((0.3 + 0.05 * number, 0.4, 0.5))
        box.export(folder / f"box_{number}.stl")
    (folder / "nothing.stl").write_bytes(b"solid nothing\nendsolid nothing\n")
    write_painted(folder / "painted" / "painted.obj", "painted.mtl", "red paint.png")
    write_painted(folder / "strange" / "strange.obj", "materials", "paint.png")
    write_painted(folder / "leads_out" / "leads_out.obj", "real.mtl", "paint.png")
    outside = folder.parent / "outside.mtl"
    (folder / "leads_out" / "real.mtl").rename(outside)
    (folder / "leads_out" / "real.mtl").symlink_to(outside)
    parts = folder / "cart" / "parts"
    write_painted(parts / "body.obj", "body.mtl", "body.png")
    lid = trimesh.creation.box((0.4, 0.38, 0.02))
    lid.apply_translation((0.0, -0.2, 0.015))
    lid.export(parts / "lid.stl")
    (parts.parent / "cart.urdf").write_text(_CART)
    return folder


def write_painted(path: Path, materials: str, texture: str) -> None:
    """A box with materials and a texture, each in a file of its own beside it."""
    path.parent.mkdir(parents=True)
    box = trimesh.creation.box((0.4, 0.4, 0.5))
    lines = [f"mtllib {materials}", "usemtl paint"]
    lines += ["v " + " ".join(f"{value:g}" for value in vertex) for vertex in box.vertices]
    lines += ["vt 0 0", "vt 1 0", "vt 1 1"]
    lines += [
        "f " + " ".join(f"{corner + 1}/{k + 1}" for k, corner in enumerate(face))
        for face in box.faces
    ]
    path.write_text("\n".join(lines) + "\n")
    (path.parent / materials).write_text(f"newmtl paint\nKd 1 1 1\nmap_Kd {texture}\n")
    colours = np.tile(np.array([[200, 30, 30], [30, 200, 30]], np.uint8), (8, 4, 1))
    Image.fromarray(colours).save(path.parent / texture)
