"""Textures: kept as they were encoded, re-encoded only where simulators could not read them."""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable

from PIL import Image

from ..errors import InputRejected
from ..mesh import Texture
from .files import InputFiles

_FORMATS = ("PNG", "JPEG", "WEBP", "BMP", "TGA", "TIFF", "GIF", "DDS", "PPM")
_PNG_MAGIC = b"\x89PNG\r\n\x1a\n"
_JPEG_MAGIC = b"\xff\xd8\xff"


def load_texture(data: bytes, name: str, files: InputFiles) -> Texture | None:
    """Return an encoded image as a texture; PNG and JPEG keep their bytes, others become PNG.

    The header's size is checked before a pixel is decoded; the image is then decoded once, so that
    no simulator meets a broken one.

    Returns:
        ``None`` if the image cannot be decoded.

    Raises:
        InputRejected: ``too_large``: more pixels than the limits of ``files`` allow.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.simplefilter("error", Image.DecompressionBombWarning)
        try:
            with Image.open(io.BytesIO(data), formats=_FORMATS) as image:
                files.spend_pixels(name, image.width * image.height)
                image.load()
                if data.startswith(_PNG_MAGIC):
                    return Texture(data, ".png")
                if data.startswith(_JPEG_MAGIC):
                    return Texture(data, ".jpg")
                return Texture(encode_png(image), ".png")
        except (Image.DecompressionBombWarning, Image.DecompressionBombError) as error:
            raise InputRejected("too_large", f"texture {name}: {error}") from error
        except InputRejected:
            raise
        except MemoryError as error:
            raise InputRejected("too_large", f"texture {name}: does not fit into memory") from error
        except Exception:  # noqa: BLE001 - a picture from anybody: its decoders raise whatever they trip over
            return None


def read_texture(
    name: str, read: Callable[[], bytes], files: InputFiles, notes: list[str]
) -> Texture | None:
    """Return :func:`load_texture` of the image that ``read`` gives, or is missing; notes if none.

    Raises:
        InputRejected: as ``read`` and :func:`load_texture` do.
    """
    try:
        data = read()
    except FileNotFoundError:
        notes.append(f"The texture {name} is missing; a plain colour was used.")
        return None
    texture = load_texture(data, name, files)
    if texture is None:
        broken = f"The texture {name} ({len(data)} bytes) cannot be decoded"
        notes.append(f"{broken}; a plain colour was used.")
    return texture


def encode_png(image: Image.Image) -> bytes:
    """Return an image as PNG, the same bytes for the same pixels."""
    has_alpha = image.mode in ("RGBA", "LA", "PA") or "transparency" in image.info
    buffer = io.BytesIO()
    image.convert("RGBA" if has_alpha else "RGB").save(buffer, format="PNG", compress_level=6)
    return buffer.getvalue()
