"""Textures as PNG files named by their content, so that two different images never share a name."""

import hashlib
import io
from pathlib import Path

from PIL import Image

from ..mesh import Material, Texture

#: Pixel layouts that every simulator's PNG reader takes as they are.
PLAIN_MODES = frozenset({"L", "RGB", "RGBA"})


class TextureFolder:
    """Writes each image once and remembers where.

    MuJoCo reads no JPEG, so everything becomes PNG: one file serves all simulators.

    Attributes:
        notes: a sentence per image that could not be decoded; its material stays a plain colour.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._names: dict[Texture, str | None] = {}
        self.notes: list[str] = []

    def file_name(self, material: Material) -> str | None:
        """Return the PNG of ``material``, written on first use; ``None`` for a plain colour."""
        texture = material.texture
        if texture is None:
            return None
        if texture not in self._names:
            self._names[texture] = self._write(texture, material.name)
        return self._names[texture]

    def _write(self, texture: Texture, material: str) -> str | None:
        try:
            data = png_bytes(texture)
        except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
            self.notes.append(
                f"texture of material {material!r} cannot be decoded ({error}); "
                "its plain colour is used"
            )
            return None
        name = f"texture_{hashlib.sha256(data).hexdigest()[:16]}.png"
        (self._folder / name).write_bytes(data)
        return name


def png_bytes(texture: Texture) -> bytes:
    """Return the image as an 8-bit PNG; a PNG that already is one keeps its bytes.

    Raises:
        OSError, ValueError, SyntaxError: Pillow cannot decode it.
    """
    with Image.open(io.BytesIO(texture.data)) as image:
        image.load()
        if image.format == "PNG" and image.mode in PLAIN_MODES:
            return texture.data
        transparent = image.mode in ("RGBA", "LA", "PA") or "transparency" in image.info
        buffer = io.BytesIO()
        image.convert("RGBA" if transparent else "RGB").save(buffer, format="PNG", compress_level=6)
    return buffer.getvalue()
