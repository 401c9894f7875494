"""Ways to damage a file: bytes, words, JSON, XML, archive members; repeatable by seed."""

import io
import json
import re
import struct
import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Callable
from dataclasses import replace
from random import Random
from typing import Any

from fuzz_cases import Case, zipped
from mesh_cube import pack_glb

_NUMBERS = (
    *(0, 1, -1, 2, 127, 255, 65535, 2**31 - 1, 2**31, 2**32 - 1, 2**32),
    *(2**40, 2**53, 2**63, -(2**31), 10**30),
)
_FLOATS = (
    *("nan", "inf", "-inf", "1e400", "1e308", "-1e308"),
    *("1e-320", "1e39", "0.0", "-0.0", "1e30", "1e10"),
)
_WORDS = (
    "", "x", "-", "true", "\ufeff", "é", "\x7f",
    "../outside/secret.png", "../../../../etc/passwd", "/etc/passwd",
    "file:///etc/passwd", "http://127.0.0.1:9/x.png", "\\\\host\\share", "C:\\x", "a" * 300,
    "a/" * 3000, "%00", "%2e%2e/%2e%2e/x",
    "data:,x", ".", "..", "~", "$HOME", "`id`", "*", "CON", "a\nb",
)  # fmt: skip
_TOKEN = re.compile(rb"[-+.\w]+")
_BINARY = tuple(
    struct.pack(form, value)
    for form, values in {
        "<I": (0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x0FFFFFFF),
        "<H": (0, 0xFFFF, 0x8000),
        "<f": (float("nan"), float("inf"), -float("inf"), 3e38, 1e-45),
        "<Q": (2**63, 2**64 - 1, 2**40),
        ">I": (0x7FFFFFFF, 0x80000000),
    }.items()
    for value in values
)


def mutated(seed: Case, number: int, salt: int = 0) -> Case:
    """A seed with its target damaged, one to three times; number 0 is the seed itself."""
    random = Random(f"{salt}/{seed.name}/{number}")  # noqa: S311 - reproducible, not secret
    data = seed.files[seed.target]
    for _ in range(0 if number == 0 else random.choice((1, 1, 1, 2, 3))):
        data = _mutate(data, seed, random)
    return replace(seed, name=f"{seed.name}-{number}", files={**seed.files, seed.target: data})


def _mutate(data: bytes, seed: Case, random: Random) -> bytes:
    structured = _STRUCTURED.get(seed.kind.removesuffix("_check"), mutate_words)
    if random.random() < 0.65:
        try:
            return structured(data, random)
        except Exception:  # noqa: BLE001, S110 - damaged too much already to be taken apart again
            pass
    return mutate_bytes(data, random)


def mutate_bytes(data: bytes, random: Random) -> bytes:
    """Flipped bits, cut, doubled, removed or overwritten pieces."""
    at = random.randrange(len(data) + 1)
    size = random.choice((1, 4, 16, 64, 1024))
    piece = data[at : at + size]
    other = random.randrange(len(data) + 1)
    blob = random.choice(_BINARY)
    changed = (
        data[:at],
        data[:at] + data[at + size :],
        data[:at] + piece * random.choice((2, 3, 100)) + data[at + size :],
        data[:at] + data[other : other + size] + data[at:],
        data[:at] + blob + data[at + len(blob) :],
        data[:at] + random.randbytes(size) + data[at + size :],
        data[:at] + b"\0" * size + data[at + size :],
        _flipped(data, random),
    )
    return random.choice(changed)


def _flipped(data: bytes, random: Random) -> bytes:
    damaged = bytearray(data)
    for _ in range(random.choice((1, 2, 8, 64)) if data else 0):
        damaged[random.randrange(len(data))] ^= 1 << random.randrange(8)
    return bytes(damaged)


def mutate_words(data: bytes, random: Random) -> bytes:
    """Words replaced, lines doubled, removed or exchanged."""
    if random.random() < 0.3:
        lines = data.split(b"\n")
        at = random.randrange(len(lines))
        match random.randrange(4):
            case 0:
                lines[at:at] = [lines[at]] * random.choice((1, 2, 50))
            case 1:
                del lines[at : at + random.choice((1, 3, 10))]
            case 2:
                other = random.randrange(len(lines))
                lines[at], lines[other] = lines[other], lines[at]
            case _:
                lines[at] += random.choice((b"\\", b"\r", b"\0", b"\xff\xfe", b" " * 1000))
        return b"\n".join(lines)
    words = list(_TOKEN.finditer(data))
    if not words:
        return mutate_bytes(data, random)
    word = random.choice(words)
    return data[: word.start()] + _word(random) + data[word.end() :]


def _word(random: Random) -> bytes:
    match random.randrange(4):
        case 0:
            return str(random.choice(_NUMBERS)).encode()
        case 1:
            return random.choice(_FLOATS).encode()
        case 2:
            return random.choice(_WORDS).encode()
    return b"9" * random.choice((20, 400, 5000))


def _value(random: Random) -> Any:
    match random.randrange(6):
        case 0:
            return random.choice(_NUMBERS)
        case 1:
            return float(random.choice(_FLOATS))
        case 2:
            return random.choice(_WORDS)
        case 3:
            return random.choice((None, True, [], {}, [[]], {"a": {}}, [0] * 100))
        case 4:
            return [random.choice(_NUMBERS) for _ in range(random.choice((1, 2, 3, 4, 16)))]
    deep: Any = []
    for _ in range(random.choice((3, 50, 400))):
        deep = [deep]
    return deep


def mutate_json(document: Any, random: Random) -> Any:
    """One value somewhere in a JSON document replaced, removed or moved."""
    places: list[tuple[Any, Any]] = []
    stack = [document]
    while stack:
        node = stack.pop()
        for key, value in node.items() if isinstance(node, dict) else enumerate(node):
            places.append((node, key))
            if isinstance(value, dict | list):
                stack.append(value)
    if not places:
        return document
    node, key = random.choice(places)
    match random.randrange(4):
        case 0:
            del node[key]
        case 1:
            other, place = random.choice(places)
            node[key] = json.loads(json.dumps(other[place])) if _has(other, place) else 0
        case _:
            node[key] = _value(random)
    return document


def _has(node: Any, key: Any) -> bool:
    return key in node if isinstance(node, dict) else key < len(node)


def _glb(data: bytes, random: Random) -> bytes:
    size = struct.unpack_from("<I", data, 12)[0]
    document = mutate_json(json.loads(data[20 : 20 + size]), random)
    return pack_glb(document, data[28 + size :])


def _gltf(data: bytes, random: Random) -> bytes:
    return json.dumps(mutate_json(json.loads(data), random)).encode()


def _safetensors(data: bytes, random: Random) -> bytes:
    size = struct.unpack_from("<Q", data)[0]
    text = json.dumps(mutate_json(json.loads(data[8 : 8 + size]), random)).encode()
    return struct.pack("<Q", len(text)) + text + data[8 + size :]


def _xml(data: bytes, random: Random) -> bytes:
    root = ET.fromstring(data)
    elements = list(root.iter())
    element = random.choice(elements)
    other = random.choice(elements)
    match random.randrange(7):
        case 0 | 1 | 2 if element.attrib:
            key = random.choice(sorted(element.attrib))
            words = (_clean(_word(random)) for _ in range(random.choice((1, 1, 3, 4))))
            element.set(key, " ".join(words))
        case 3 if element.attrib:
            del element.attrib[random.choice(sorted(element.attrib))]
        case 4 if len(element):
            del element[random.randrange(len(element))]
        case 5:
            element.append(ET.fromstring(ET.tostring(other)))
        case _:
            element.tag = random.choice(elements).tag
    return ET.tostring(root)


def _clean(word: bytes) -> str:
    return re.sub(r"[^\x20-\ud7ff]", "?", word.decode("utf-8"))


def _archive(change: Callable[[bytes, Random], bytes]) -> Callable[[bytes, Random], bytes]:
    def mutate(data: bytes, random: Random) -> bytes:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
        name = random.choice([*members, *(name for name in members if name.endswith(".pkl"))])
        match random.randrange(6):
            case 0:
                del members[name]
            case 1:
                members[random.choice(sorted(members))] = members[name]
            case 2:
                members[random.choice(_WORDS).replace("\0", "") or "x"] = members.pop(name)
            case _:
                members[name] = change(members[name], random)
        return zipped(members, random.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)))

    return mutate


def _npy(data: bytes, random: Random) -> bytes:
    """The header of an array, or its numbers."""
    if random.random() < 0.5:
        return mutate_bytes(data, random)
    head = data[:128]
    body = data[128:]
    changed = mutate_words(head[10:], random)
    return head[:8] + struct.pack("<H", len(changed)) + changed + body


_STRUCTURED: dict[str, Callable[[bytes, Random], bytes]] = {
    "glb": _glb,
    "gltf": _gltf,
    "safetensors": _safetensors,
    **dict.fromkeys(("urdf", "mjcf", "dae"), _xml),
    "npz": _archive(_npy),
    **dict.fromkeys(("pt", "usdz"), _archive(mutate_bytes)),
    **dict.fromkeys(("png", "stl", "usdc"), mutate_bytes),
}
