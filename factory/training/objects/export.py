"""Objects as files: GLB, OBJ with MTL, sidecar and annotation. Same object, same bytes."""

from __future__ import annotations

import json
import struct
import zipfile
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ...articulation import Articulation, JointKind
from ...mesh import FloatArray, IntArray, Material, Mesh

#: Turns z up, front -Y into glTF's y up, front +Z.
Y_UP = np.array(
    [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
)
#: Coordinates are written in steps of this many units, so that a last bit of rounding never shows.
DECIMALS = 6

# Of glTF: component types and targets of buffer views.
_FLOAT = 5126
_UINT32 = 5125
_VERTICES = 34962
_INDICES = 34963
_ZIP_EPOCH = (1980, 1, 1, 0, 0, 0)


@dataclass(frozen=True)
class FileFrame:
    """From the object frame [m] to the frame and units of a file: ``file = matrix @ object``.

    Attributes:
        matrix: rotation and uniform scale, shape [4, 4].
    """

    matrix: FloatArray

    @property
    def scale(self) -> float:
        """File units per metre."""
        return float(np.cbrt(np.linalg.det(self.matrix[:3, :3])))


def written_order(mesh: Mesh) -> IntArray:
    """Faces in the order files hold them, material by material, shape [face_count]."""
    return np.argsort(mesh.face_material, kind="stable")


class _Buffer:
    """The binary chunk of a GLB as it fills, and what the document says of it."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, int]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, data: bytes, target: int | None = None) -> int:
        """Append bytes; the number of their view."""
        self.pad()
        place = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        self.views.append(place if target is None else {**place, "target": target})
        self.data.extend(data)
        return len(self.views) - 1

    def accessor(self, array: npt.NDArray[Any], kind: str, component: int, target: int) -> int:
        """Append an array; the number of its accessor."""
        entry = {
            "bufferView": self.view(array.tobytes(), target),
            "componentType": component,
            "count": len(array),
            "type": kind,
        }
        if kind == "VEC3":
            entry |= {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
        self.accessors.append(entry)
        return len(self.accessors) - 1

    def pad(self) -> None:
        """Up to the next multiple of 4, as glTF wants it."""
        self.data.extend(b"\0" * (-len(self.data) % 4))


def write_glb(mesh: Mesh, frame: FileFrame, path: Path) -> None:
    """One node, one primitive per material, images embedded; colours linear as glTF wants them."""
    buffer = _Buffer()
    placed = mesh.transformed(frame.matrix)
    primitives = []
    for index in range(len(mesh.materials)):
        positions, uv, triangles = _primitive(placed, np.flatnonzero(mesh.face_material == index))
        attributes = {"POSITION": buffer.accessor(positions, "VEC3", _FLOAT, _VERTICES)}
        if uv is not None:
            attributes["TEXCOORD_0"] = buffer.accessor(uv, "VEC2", _FLOAT, _VERTICES)
        indices = buffer.accessor(triangles.reshape(-1), "SCALAR", _UINT32, _INDICES)
        primitives.append({"attributes": attributes, "indices": indices, "material": index})
    document: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "asset-factory"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": primitives}],
        "materials": _gltf_materials(mesh.materials),
        "accessors": buffer.accessors,
    }
    images = [material.texture for material in mesh.materials if material.texture is not None]
    if images:
        document["images"] = [
            {"bufferView": buffer.view(image.data), "mimeType": "image/png"} for image in images
        ]
        document["samplers"] = [{"magFilter": 9728, "wrapS": 10497, "wrapT": 10497}]
        document["textures"] = [{"source": i, "sampler": 0} for i in range(len(images))]
    buffer.pad()
    document |= {"bufferViews": buffer.views, "buffers": [{"byteLength": len(buffer.data)}]}
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(buffer.data), b"BIN\0") + buffer.data
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def _primitive(
    mesh: Mesh, faces: IntArray
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32] | None, npt.NDArray[np.uint32]]:
    corners = mesh.faces[faces].reshape(-1)
    if mesh.corner_uv is None or np.isnan(mesh.corner_uv[faces]).any():
        used, compact = np.unique(corners, return_inverse=True)
        uv = None
    else:
        flat = np.round(mesh.corner_uv[faces].reshape(-1, 2), DECIMALS)
        rows = np.column_stack([corners.astype(np.float64), flat])
        unique, compact = np.unique(rows, axis=0, return_inverse=True)
        used = unique[:, 0].astype(np.int64)
        # glTF measures v from the top of the image.
        uv = np.column_stack([unique[:, 1], 1.0 - unique[:, 2]]).astype(np.float32)
    positions = np.round(mesh.vertices[used], DECIMALS) + 0.0
    return positions.astype(np.float32), uv, compact.reshape(-1, 3).astype(np.uint32)


def _gltf_materials(materials: tuple[Material, ...]) -> list[dict[str, Any]]:
    entries = []
    textures = 0
    for material in materials:
        surface: dict[str, Any] = {
            "baseColorFactor": list(material.color),
            "metallicFactor": 0.0,
            "roughnessFactor": 0.7,
        }
        if material.texture is not None:
            surface["baseColorTexture"] = {"index": textures}
            textures += 1
        entries.append({"name": material.name, "pbrMetallicRoughness": surface})
    return entries


def write_obj(mesh: Mesh, frame: FileFrame, path: Path) -> None:
    """An OBJ and, beside it, an MTL of the same stem; plain colours only.

    Raises:
        ValueError: a material has a texture.
    """
    if any(m.texture is not None for m in mesh.materials):
        raise ValueError(f"{path.name}: a material has a texture, which only a GLB carries")
    lines = [f"mtllib {path.stem}.mtl"]
    placed = np.round(mesh.transformed(frame.matrix).vertices, DECIMALS) + 0.0
    lines += [f"v {x:.6g} {y:.6g} {z:.6g}" for x, y, z in placed]
    for index, material in enumerate(mesh.materials):
        lines.append(f"usemtl {material.name}")
        lines += [f"f {a} {b} {c}" for a, b, c in mesh.faces[mesh.face_material == index] + 1]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")
    palette = []
    for material in mesh.materials:
        r, g, b, _ = material.color
        palette += [f"newmtl {material.name}", f"Kd {r:g} {g:g} {b:g}", "Ks 0 0 0", "d 1", ""]
    path.with_suffix(".mtl").write_text("\n".join(palette), encoding="utf-8", newline="\n")


def write_sidecar(path: Path, values: dict[str, str | float]) -> None:
    """A TOML file of strings and numbers, in the order given."""
    lines = [f"{key} = {json.dumps(value)}" for key, value in values.items()]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")


def write_annotation(articulation: Articulation, frame: FileFrame, path: Path) -> None:
    """Ground truth as ``pred.npz``, in the frame, units and face order of the mesh file beside it.

    A part on a carrier, a part without faces, is one part that turns and slides.

    Fields: ``face_part_ids`` [face_count], ``motion_hierarchy`` [joint_count, 2] (parent, child),
    ``is_part_revolute`` and ``is_part_prismatic`` [part_count], ``revolute_plucker`` [part_count,
    6] (direction l, moment l x p of a point p on the axis), ``prismatic_axis`` [part_count, 3], and
    the two ranges [part_count, 2] relative to the pose of the file [rad, file units].

    Raises:
        ValueError: a carrier does not carry exactly one part, or not by the other kind of joint.
    """
    number, carried = _numbers(articulation)
    count = len(set(number))
    label = np.zeros(len(articulation.mesh.faces), dtype=np.int32)
    for index, part in enumerate(articulation.parts):
        label[part.faces] = number[index]
    edges = [
        (number[j.parent], number[j.child]) for j in articulation.joints if j.child not in carried
    ]
    turns = np.zeros(count, dtype=bool)
    slides = np.zeros(count, dtype=bool)
    plucker = np.zeros((count, 6))
    axis = np.zeros((count, 3))
    turn_range = np.zeros((count, 2))
    slide_range = np.zeros((count, 2))
    for joint in articulation.movable_joints:
        child = number[joint.child]
        direction = frame.matrix[:3, :3] @ joint.axis / frame.scale
        if joint.kind is JointKind.PRISMATIC:
            slides[child] = True
            axis[child] = direction
            slide_range[child] = np.array([joint.lower, joint.upper]) * frame.scale
        else:
            point = frame.matrix[:3, :3] @ joint.origin + frame.matrix[:3, 3]
            turns[child] = True
            plucker[child] = np.concatenate([direction, np.cross(direction, point)])
            turn_range[child] = joint.lower, joint.upper
    arrays: dict[str, npt.NDArray[Any]] = {
        "face_part_ids": label[written_order(articulation.mesh)],
        "motion_hierarchy": np.array(edges, dtype=np.int64).reshape(-1, 2),
        "is_part_revolute": turns,
        "is_part_prismatic": slides,
        "revolute_plucker": np.round(plucker, 9) + 0.0,
        "revolute_range": np.round(turn_range, 9).astype(np.float32),
        "prismatic_axis": (np.round(axis, 9) + 0.0).astype(np.float32),
        "prismatic_range": np.round(slide_range, 9).astype(np.float32),
    }
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
        for name, array in arrays.items():
            buffer = BytesIO()
            np.save(buffer, array)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy", _ZIP_EPOCH), buffer.getvalue())


def _numbers(articulation: Articulation) -> tuple[list[int], set[int]]:
    """Number of each part, a carrier's that of what it carries; and the parts that are carried."""
    carried: dict[int, int] = {}
    for joint in articulation.joints:
        carrier = articulation.parts[joint.parent]
        if not joint.parent or len(carrier.faces):
            continue
        above = articulation.joints[joint.parent - 1]
        both = above.movable and joint.movable and above.turns != joint.turns
        if not both or joint.parent in carried.values():
            wanted = "want it to carry one part that turns and slides by it"
            raise ValueError(f"part {carrier.name!r}: has no faces, {wanted}")
        carried[joint.child] = joint.parent
    kept = [index for index in range(len(articulation.parts)) if index not in carried]
    number = [kept.index(carried.get(index, index)) for index in range(len(articulation.parts))]
    return number, set(carried)
