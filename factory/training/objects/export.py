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

_FLOAT, _UINT32 = 5126, 5125
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


def write_glb(mesh: Mesh, frame: FileFrame, path: Path) -> None:
    """One node, one primitive per material, images embedded; colours linear as glTF wants them."""
    blob, views, accessors, primitives = bytearray(), [], [], []

    def view(data: bytes, target: int | None) -> int:
        blob.extend(b"\0" * (-len(blob) % 4))
        views.append(
            {"buffer": 0, "byteOffset": len(blob), "byteLength": len(data)}
            | ({"target": target} if target else {})
        )
        blob.extend(data)
        return len(views) - 1

    def accessor(array: npt.NDArray[Any], kind: str, component: int, target: int) -> int:
        bounds = (
            {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
            if kind == "VEC3"
            else {}
        )
        entry = {
            "bufferView": view(array.tobytes(), target),
            "componentType": component,
            "count": len(array),
            "type": kind,
        }
        accessors.append(entry | bounds)
        return len(accessors) - 1

    placed = mesh.transformed(frame.matrix)
    for index in range(len(mesh.materials)):
        positions, uv, triangles = _primitive(placed, np.flatnonzero(mesh.face_material == index))
        attributes = {"POSITION": accessor(positions, "VEC3", _FLOAT, 34962)}
        if uv is not None:
            attributes["TEXCOORD_0"] = accessor(uv, "VEC2", _FLOAT, 34962)
        indices = accessor(triangles.reshape(-1), "SCALAR", _UINT32, 34963)
        primitives.append({"attributes": attributes, "indices": indices, "material": index})
    images = [m.texture for m in mesh.materials if m.texture is not None]
    document: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "asset-factory"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": primitives}],
        "materials": _gltf_materials(mesh.materials),
        "accessors": accessors,
    }
    if images:
        document["images"] = [
            {"bufferView": view(t.data, None), "mimeType": "image/png"} for t in images
        ]
        document["samplers"] = [{"magFilter": 9728, "wrapS": 10497, "wrapT": 10497}]
        document["textures"] = [{"source": i, "sampler": 0} for i in range(len(images))]
    blob.extend(b"\0" * (-len(blob) % 4))
    document |= {"bufferViews": views, "buffers": [{"byteLength": len(blob)}]}
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    header = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(blob))
    path.write_bytes(
        header
        + struct.pack("<I4s", len(text), b"JSON")
        + text
        + struct.pack("<I4s", len(blob), b"BIN\0")
        + blob
    )


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
    entries, textures = [], 0
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
        raise ValueError(
            f"{path.name}: a material has a texture, which only the GLB writer carries"
        )
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
    turns, slides = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
    plucker, axis = np.zeros((count, 6)), np.zeros((count, 3))
    turn_range, slide_range = np.zeros((count, 2)), np.zeros((count, 2))
    rotation = frame.matrix[:3, :3] / frame.scale
    for joint in articulation.movable_joints:
        direction, child = rotation @ joint.axis, number[joint.child]
        if joint.kind is JointKind.PRISMATIC:
            slides[child], axis[child] = True, direction
            slide_range[child] = np.array([joint.lower, joint.upper]) * frame.scale
        else:
            point = frame.matrix[:3, :3] @ joint.origin + frame.matrix[:3, 3]
            turns[child], plucker[child] = (
                True,
                np.concatenate([direction, np.cross(direction, point)]),
            )
            turn_range[child] = joint.lower, joint.upper
    edges = [
        (number[j.parent], number[j.child]) for j in articulation.joints if j.child not in carried
    ]
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
    """Number of each part where a carrier is one with what it carries, and the parts that are carried."""
    carried: dict[int, int] = {}
    for joint in articulation.joints:
        if joint.parent and not len(articulation.parts[joint.parent].faces):
            above, name = (
                articulation.joints[joint.parent - 1],
                articulation.parts[joint.parent].name,
            )
            pair = {above.turns, joint.turns}
            if (
                joint.parent in carried.values()
                or not (above.movable and joint.movable)
                or len(pair) < 2
            ):
                raise ValueError(
                    f"part {name!r}: has no faces, want it to carry one part that turns and slides by it"
                )
            carried[joint.child] = joint.parent
    kept = [index for index in range(len(articulation.parts)) if index not in carried]
    number = [kept.index(carried.get(index, index)) for index in range(len(articulation.parts))]
    return number, set(carried)
