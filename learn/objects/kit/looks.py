"""Colours and a wood texture, the same bytes everywhere."""

from __future__ import annotations

import struct
import zlib

import numpy as np
import numpy.typing as npt

from asset_factory.factory.geometry.triangles import doubled_normals
from asset_factory.factory.mesh import FloatArray, Material, Mesh, Texture

WHITE = Material("white", (0.85, 0.85, 0.83, 1.0))
BLACK = Material("black", (0.03, 0.03, 0.035, 1.0))
STEEL = Material("steel", (0.55, 0.56, 0.58, 1.0))
GLASS = Material("glass", (0.08, 0.1, 0.12, 1.0))
OAK = Material("oak", (0.55, 0.36, 0.19, 1.0))
WALNUT = Material("walnut", (0.24, 0.13, 0.07, 1.0))
GREEN = Material("green", (0.2, 0.33, 0.24, 1.0))
BLUE = Material("blue", (0.13, 0.2, 0.36, 1.0))
RED = Material("red", (0.5, 0.08, 0.06, 1.0))
BRASS = Material("brass", (0.62, 0.45, 0.17, 1.0))

#: A texture repeats after this length [m].
TEXTURE_PERIOD_M = 0.5


def wood(seed: int, size: int = 64) -> Material:
    """Return a wood-grained material; its square image tiles, and its grain runs along u."""
    rng = np.random.default_rng(seed)
    u, v = np.meshgrid(np.arange(size) / size, np.arange(size) / size)
    phase = rng.uniform(0.0, 2.0 * np.pi, 3)
    bend = 0.04 * np.sin(2.0 * np.pi * u + phase[0]) + 0.02 * np.sin(4.0 * np.pi * u + phase[1])
    rings = 0.5 + 0.5 * np.sin(2.0 * np.pi * 7.0 * (v + bend) + phase[2])
    tone = 0.75 + 0.18 * rings + 0.05 * rng.uniform(-1.0, 1.0, (size, 1))
    colors = np.clip(tone[..., None] * np.array([190.0, 140.0, 88.0]), 0.0, 255.0)
    image = png(np.round(colors).astype(np.uint8))
    return Material("wood", (1.0, 1.0, 1.0, 1.0), Texture(image, ".png"))


def laid_over(mesh: Mesh) -> FloatArray | None:
    """Return texture coordinates, [face_count, 3, 2], NaN on plain faces; ``None`` if all are."""
    textured = np.array([material.texture is not None for material in mesh.materials])
    if not textured.any():
        return None
    corners = mesh.vertices[mesh.faces]
    normal = doubled_normals(corners)
    # The grain runs along u: along z on upright faces, along x on lying ones.
    across = np.array([[2, 1], [2, 0], [0, 1]])[np.abs(normal).argmax(axis=1)]
    uv = np.take_along_axis(corners, across[:, None], axis=2) / TEXTURE_PERIOD_M
    return np.asarray(np.where(textured[mesh.face_material][:, None, None], uv, np.nan))


def png(pixels: npt.NDArray[np.uint8]) -> bytes:
    """Return an RGB image, top row first, shape [height, width, 3], as a PNG file.

    The stream is stored: compressors differ between machines, and the bytes must not.
    """
    height, width = pixels.shape[:2]
    raw = b"".join(b"\0" + row.tobytes() for row in pixels)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", zlib.compress(raw, 0)), (b"IEND", b""))
    file = b"\x89PNG\r\n\x1a\n"
    for kind, data in chunks:
        check = struct.pack(">I", zlib.crc32(kind + data))
        file += struct.pack(">I", len(data)) + kind + data + check
    return file
