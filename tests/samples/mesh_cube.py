"""A textured unit cube in every format, with corners of its own for every face."""

import io
import json
import struct
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from PIL import Image

AXES = np.eye(3)


def cube() -> dict[str, Any]:
    """24 positions, uvs (origin bottom left) and normals, 12 outward faces; x, y, z in [0, 1]."""
    positions = []
    uv = []
    normals = []
    faces = []
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
    for axis in range(3):
        for side in (0.0, 1.0):
            normal = AXES[axis] * (2 * side - 1)
            a = AXES[(axis + 1) % 3]
            b = AXES[(axis + 2) % 3]
            if side == 0.0:
                a, b = b, a
            start = len(positions)
            for s, t in square:
                positions.append(AXES[axis] * side + a * s + b * t)
                uv.append([s, t])
                normals.append(normal)
            faces += [[start, start + 1, start + 2], [start, start + 2, start + 3]]
    return {
        "positions": np.array(positions),
        "uv": np.array(uv),
        "normals": np.array(normals),
        "faces": np.array(faces),
    }


def png(size: tuple[int, int] = (2, 2), color: tuple[int, int, int] = (200, 30, 30)) -> bytes:
    """A plain image."""
    buffer = io.BytesIO()
    Image.new("RGB", size, color).save(buffer, "PNG")
    return buffer.getvalue()


def gltf_parts(
    nodes: list[dict[str, Any]] | None = None, image: bytes | None = None, **extra: object
) -> tuple[dict[str, Any], bytes]:
    """JSON and binary of the cube as glTF, shown once unless ``nodes`` say otherwise."""
    shape = cube()
    uv = np.stack([shape["uv"][:, 0], 1.0 - shape["uv"][:, 1]], axis=1)
    blobs = [
        shape["positions"].astype("<f4").tobytes(),
        shape["normals"].astype("<f4").tobytes(),
        uv.astype("<f4").tobytes(),
        shape["faces"].astype("<u2").tobytes(),
        image or png(),
    ]
    offsets = np.cumsum([0] + [len(b) for b in blobs])
    views = [
        {"buffer": 0, "byteOffset": int(o), "byteLength": len(b)}
        for o, b in zip(offsets, blobs, strict=False)
    ]
    nodes = nodes or [{"mesh": 0}]
    children = {c for node in nodes for c in node.get("children", [])}
    attributes = {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}
    look = {"baseColorFactor": [1, 0.5, 0.25, 1], "baseColorTexture": {"index": 0}}
    document: dict[str, Any] = {
        "asset": {"version": "2.0", "copyright": "CC0-1.0"},
        "scene": 0,
        "scenes": [{"nodes": [i for i in range(len(nodes)) if i not in children]}],
        "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": attributes, "indices": 3, "material": 0}]}],
        "materials": [{"name": "red wood", "pbrMetallicRoughness": look}],
        "textures": [{"source": 0}],
        "images": [{"bufferView": 4, "mimeType": "image/png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 24, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5126, "count": 24, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5126, "count": 24, "type": "VEC2"},
            {"bufferView": 3, "componentType": 5123, "count": 36, "type": "SCALAR"},
        ],
        "bufferViews": views,
        "buffers": [{"byteLength": int(offsets[-1])}],
    }
    document.update(extra)
    return document, b"".join(blobs)


def pack_glb(document: dict[str, Any], binary: bytes) -> bytes:
    """A GLB container."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def write_glb(folder: Path, name: str = "cube.glb", **options: Any) -> Path:
    path = folder / name
    path.write_bytes(pack_glb(*gltf_parts(**options)))
    return path


def write_gltf(folder: Path, name: str = "cube.gltf") -> Path:
    document, binary = gltf_parts()
    document["buffers"][0]["uri"] = "cube%20data.bin"
    document["images"] = [{"uri": "wood.png"}]
    (folder / "cube data.bin").write_bytes(binary)
    (folder / "wood.png").write_bytes(png())
    (folder / name).write_text(json.dumps(document))
    return folder / name


def write_obj(folder: Path, name: str = "cube.obj") -> Path:
    """Quads, two materials: the first four faces textured, the last two plain."""
    shape = cube()
    lines = ["# a cube", "mtllib cube.mtl", "o cube"]
    lines += ["v " + " ".join(map(str, p)) for p in shape["positions"]]
    lines += ["vt " + " ".join(map(str, t)) for t in shape["uv"]]
    lines += ["vn " + " ".join(map(str, n)) for n in shape["normals"]]
    for quad in range(6):
        if quad in (0, 4):
            lines.append(f"usemtl {'red wood' if quad == 0 else 'steel'}")
        lines.append("f " + " ".join(f"{k}/{k}/{k}" for k in range(4 * quad + 1, 4 * quad + 5)))
    (folder / name).write_text("\n".join(lines) + "\n")
    (folder / "cube.mtl").write_text(
        "newmtl red wood\nKd 0.2 0.2 0.2\nmap_Kd -s 1 1 1 wood.png\nnewmtl steel\nKd 0.5 0.6 0.7\n"
        "d 0.5\n"
    )
    (folder / "wood.png").write_bytes(png())
    return folder / name


def write_ply(folder: Path, name: str = "cube.ply", *, form: str = "binary_little_endian") -> Path:
    shape = cube()
    header = (
        f"ply\nformat {form} 1.0\ncomment TextureFile wood.png\nelement vertex 24\n"
        + "".join(f"property float {n}\n" for n in ("x", "y", "z", "nx", "ny", "nz", "s", "t"))
        + "element face 12\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = np.concatenate([shape["positions"], shape["normals"], shape["uv"]], axis=1)
    if form == "ascii":
        body = "".join(" ".join(f"{v:g}" for v in row) + "\n" for row in rows)
        body += "".join("3 " + " ".join(map(str, face)) + "\n" for face in shape["faces"])
        data = (header + body).encode()
    else:
        order = "<" if "little" in form else ">"
        faces = b"".join(struct.pack(f"{order}Biii", 3, *face) for face in shape["faces"].tolist())
        data = header.encode() + rows.astype(f"{order}f4").tobytes() + faces
    (folder / name).write_bytes(data)
    (folder / "wood.png").write_bytes(png())
    return folder / name


def write_stl(folder: Path, name: str = "cube.stl") -> Path:
    shape = cube()
    records = np.zeros(12, dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    records["v"] = shape["positions"][shape["faces"]]
    # A header may well begin with "solid", which is how text files begin.
    header = b"solid cube".ljust(80, b"\0") + struct.pack("<I", 12)
    (folder / name).write_bytes(header + records.tobytes())
    return folder / name


def write_stl_ascii(folder: Path, name: str = "cube.stl") -> Path:
    shape = cube()
    mesh = trimesh.Trimesh(shape["positions"], shape["faces"], process=False)
    mesh.export(folder / name, file_type="stl_ascii")
    return folder / name


def write_off(folder: Path, name: str = "cube.off") -> Path:
    shape = cube()
    lines = ["OFF # a cube", "24 6 0"] + [" ".join(map(str, p)) for p in shape["positions"]]
    lines += ["4 " + " ".join(str(4 * q + k) for k in range(4)) + " 255 0 0" for q in range(6)]
    (folder / name).write_text("\n".join(lines) + "\n")
    return folder / name


WRITERS: dict[str, Callable[[Path], Path]] = {
    "glb": write_glb,
    "gltf": write_gltf,
    "obj": write_obj,
    "ply": write_ply,
    "ply_ascii": partial(write_ply, form="ascii"),
    "ply_big": partial(write_ply, form="binary_big_endian"),
    "stl": write_stl,
    "stl_ascii": write_stl_ascii,
    "off": write_off,
}
TEXTURED = ("glb", "gltf", "obj", "ply", "ply_ascii", "ply_big")
