"""Attacks by hand on descriptions, annotations and checkpoints."""

import io
import pickle
import struct
import zipfile
from collections.abc import Iterator
from typing import Any

import numpy as np
from fuzz_cases import Bomb, Case, annotated, locked, packed, prediction, seeds, zipped

_BILLION = (
    "<!DOCTYPE r [<!ENTITY a0 'ha'>"
    + "".join(f"<!ENTITY a{k} '{f'&a{k - 1};' * 20}'>" for k in range(1, 12))
    + "]>"
)
_EXTERNAL = "<!DOCTYPE r [<!ENTITY a11 SYSTEM '{}'>]>"


def description(name: str, kind: str, text: str | bytes, **options: Any) -> Iterator[Case]:
    """Read once as an input and once as something to judge."""
    seed = seeds()[kind]
    data = text if isinstance(text, bytes) else text.encode()
    for verb in ("load", "check"):
        given = {key: value for key, value in options.items() if key != "least" or verb == "load"}
        files = {**seed.files, seed.entry: data}
        yield Case(f"{kind}-{verb}-{name}", kind, verb, seed.entry, files, **given)


def _entities() -> Iterator[Case]:
    declarations = {
        "billion": _BILLION,
        "dtype": "<!DOCTYPE r>",
        "public": "<!DOCTYPE r PUBLIC 'x' 'http://127.0.0.1:9/x.dtd'>",
        "parameter": "<!DOCTYPE r [<!ENTITY % p SYSTEM 'file://@OUTSIDE@/secret.xml'>%p;]>",
        "subset": "<!DOCTYPE r SYSTEM 'file://@OUTSIDE@/secret.xml'>",
    }
    outside = "@OUTSIDE@/secret.xml"
    places = (f"file://{outside}", outside, "http://127.0.0.1:9/x", "/etc/passwd")
    for number, place in enumerate(places):
        declarations[f"external{number}"] = _EXTERNAL.format(place)
    seed = seeds()["urdf"].files
    urdf = {**seed, "box.urdf": seed["box.urdf"].replace(b"cube.obj", b"a.dae")}
    body = seeds()["dae"].files["cube.dae"].decode().split("?>", 1)[1]
    body = body.replace('4.1">', '4.1">&a11;', 1).replace("<p>", "<p>&a11;")
    for name, declaration in declarations.items():
        for encoding in ("utf-8", "utf-16", "utf-16-le"):
            case = f"{name}-{encoding}"
            for kind, tag in (("urdf", "robot"), ("mjcf", "mujoco")):
                text = f"{declaration}<{tag} name='&a11;'>&a11;</{tag}>".encode(encoding)
                yield from description(case, kind, text, least="unreadable")
            text = f"<?xml version='1.0' encoding='{encoding[:6]}'?>{declaration}{body}"
            dae = {"a.dae": text.encode(encoding)}
            yield Case(f"dae-{case}", "dae", "load", "a.dae", dae, least="unreadable")
            yield Case(f"urdf-dae-{case}", "dae", "check", "box.urdf", {**urdf, **dae})


def _predictions() -> Iterator[Case]:
    def case(name: str, data: bytes, **options: Any) -> Case:
        return Case(f"npz-{name}", "npz", "load", "cube.glb", annotated(data), **options)

    def refused(name: str, data: bytes) -> Case:
        return case(name, data, least="bad_annotation")

    for value in (1e300, 1e308, -1e308, 1e39, 1e-320, np.nan, np.inf):
        for field in ("revolute_plucker", "revolute_range", "prismatic_axis", "prismatic_range"):
            for slides in (False, True):
                shape = prediction()[field].shape
                changes = {field: np.full(shape, value), "is_part_prismatic": [False, slides]}
                told = case if value == 1e-320 else refused
                yield told(f"{field}-{value}-{slides}", packed(prediction(**changes)))
                one = np.array(prediction()[field])
                one[1, -1] = value
                changes[field] = one
                yield told(f"{field}-{value}-{slides}-one", packed(prediction(**changes)))
    yield case("cycle", packed(prediction(motion_hierarchy=[[0, 1], [1, 0]])))
    yield case("itself", packed(prediction(motion_hierarchy=[[1, 1]])))
    yield refused("edges", packed(prediction(motion_hierarchy=np.tile([[0, 1]], (1_000_000, 1)))))
    far = np.array([[0, 2**63 - 1]])
    yield refused("huge-edge", packed(prediction(motion_hierarchy=far)))
    line = [[0.0] * 6, [0.0, 0.0, 1e-7, 1e8, 0.0, 0.0]]
    yield case("far", packed(prediction(revolute_plucker=line)), least="bad_axis")
    unsigned = np.full(12, 2**64 - 1, dtype=np.uint64)
    yield refused("unsigned", packed(prediction(face_part_ids=unsigned)))
    yield case("parts", packed(_chained(4096)))
    bombs = np.array([Bomb()] * 12, dtype=object)
    yield refused("objects", packed(prediction(face_part_ids=bombs)))
    members = {f"{name}.npy": _npy(value) for name, value in prediction().items()}
    bomb = pickle.dumps(Bomb())
    yield refused("pickle", zipped({**members, "face_part_ids.npy": bomb}))
    for name, data in {"cut": b"\x93NUMPY\x01\x00\x10\x00{'descr': (((((  ", "none": b"x"}.items():
        yield refused(f"array-{name}", zipped(dict.fromkeys(members, data)))
    begin = b"{'descr': '<i8', 'fortran_order': False, 'shape': "
    for name, head in {
        "shape": begin + b"(1099511627776,), }",
        "negative": begin + b"(-1,), }",
        "deep": begin + b"(" * 5000 + b")" * 5000 + b"}",
        "call": b"{'descr': '<i8', 'shape': __import__('os').system('touch @OUTSIDE@/executed')}",
        "descr": (
            b"{'descr': [('a', '<i8', (1099511627776,))], 'fortran_order': False, 'shape': (1,), }"
        ),
        "text": b"{'descr': '<U999999999', 'fortran_order': False, 'shape': (12,), }",
        "object": b"{'descr': '|O', 'fortran_order': False, 'shape': (12,), }",
        "open": b"{'descr': '<i8', 'fortran_order'",
    }.items():
        data = b"\x93NUMPY\x02\x00" + struct.pack("<I", len(head)) + head + bomb
        yield refused(f"header-{name}", zipped({**members, "face_part_ids.npy": data}))
    zeros = np.zeros(1 << 28, dtype=np.uint8)
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, data in members.items():
            archive.writestr(zipfile.ZipInfo(name), data)
        archive.writestr("big.npy", zeros.tobytes(), zipfile.ZIP_DEFLATED)
    yield refused("bomb", stream.getvalue())
    lied = bytearray(stream.getvalue())
    at = lied.rfind(b"PK\x01\x02")
    struct.pack_into("<I", lied, at + 24, 10)
    yield case("bomb-lied", bytes(lied))
    outside = {"../../outside/secret.npy": b"x", "/etc/x.npy": b"x"}
    yield case("traversal", zipped({**members, **outside}), least="loaded")
    yield case("empty", b"")
    yield refused("no-zip", bomb)
    yield refused("locked", locked(zipped(members)))


def _chained(count: int) -> dict[str, np.ndarray]:
    row = np.tile
    return {
        "face_part_ids": np.arange(12),
        "motion_hierarchy": np.stack([np.arange(count - 1), np.arange(1, count)], axis=1),
        "is_part_revolute": np.ones(count, bool),
        "is_part_prismatic": np.ones(count, bool),
        "revolute_plucker": row([[0, 0, 1.0, 0, 0, 0]], (count, 1)),
        "revolute_range": row([[0.5, 1.0]], (count, 1)),
        "prismatic_axis": row([[1.0, 0, 0]], (count, 1)),
        "prismatic_range": row([[0.5, 1.0]], (count, 1)),
    }


def _npy(value: np.ndarray) -> bytes:
    stream = io.BytesIO()
    np.save(stream, value)
    return stream.getvalue()


TEXT_PAGES = {"entities": _entities, "predictions": _predictions}
