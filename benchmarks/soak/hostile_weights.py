"""Attacks by hand on checkpoints."""

from __future__ import annotations

import io
import json
import pickle
import struct
import zipfile
from collections.abc import Iterator
from typing import Any

from fuzz_cases import (
    SHARED,
    Bomb,
    Case,
    locked,
    network_shapes,
    pickled_tensor,
    pickled_text,
    safetensors,
    torch_file,
    zipped,
)


def _laughs(laugh: bytes) -> dict[str, bytes]:
    text = pickled_text
    return {
        "key": b"}" + laugh + b"Ns",
        "pid": laugh + b"Q",
        "set": b"\x8f(" + laugh + b"\x90",
        "frozen": b"(" + laugh + b"\x91",
        "ordered": b"ccollections\nOrderedDict\n](" + laugh + b"N\x86e\x85R",
        "tensor": b"ctorch._utils\n_rebuild_tensor_v2\n" + laugh + b"R",
        "storage": b"((" + text("storage") + laugh + text("0") + text("cpu") + b"K\1tQ",
        "place": b"("
        + text("storage")
        + b"ctorch\nFloatStorage\n"
        + laugh
        + text("cpu")
        + b"K\1tQ",
        "value": b"}" + text("a") + laugh + b"s",
        "global": laugh + b"\x93",
        "build": b"ccollections\nOrderedDict\n)R" + laugh + b"b",
        "call": laugh + b")R",
    }


def _checkpoints() -> Iterator[Case]:
    def case(name: str, data: bytes, **options: Any) -> Case:
        return Case(f"pt-{name}", "pt", "weights", "w.pt", {"w.pt": data}, **options)

    yield case("bomb", torch_file(pickle.dumps({"a": Bomb()})), least="refused")
    yield case("legacy", b"\x80\x02" + pickle.dumps(Bomb()), least="refused")
    yield case("pickle", pickle.dumps(Bomb()), least="refused")
    for depth in (40, 200):
        # Each pair twice the one before: by DUP, which torch does not know, and as torch writes it.
        for how, laugh in {"": b"(t" + b"2\x86" * depth, "memo-": b"(t" + SHARED * depth}.items():
            for name, body in _laughs(laugh).items():
                yield case(
                    f"laugh-{how}{name}-{depth}",
                    torch_file(b"\x80\x02" + body + b"."),
                    least="refused",
                )
    for kind in ("\nFloatStorage\n", "\nno\n"):
        state = b"}" + pickled_text("dtype") + pickled_text("U8") + b"sb"
        poison = b"}" + pickled_text("x") + b"ctorch" + kind.encode() + state
        yield case(f"poison-{kind.strip()}", torch_file(b"\x80\x02" + poison + b"s."))
    yield case(
        "poison-slots",
        torch_file(
            b"\x80\x02ctorch._utils\n_rebuild_tensor_v2\nN}"
            + pickled_text("__defaults__")
            + b")s\x86b."
        ),
    )
    yield case("many", torch_file(b"\x80\x02" + b"]" * 30_000_000 + b"."))
    yield case("marks", torch_file(b"\x80\x02" + b"(" * 30_000_000 + b"."))
    yield case("long", torch_file(b"\x80\x02\x8b" + struct.pack("<I", 2**31 - 1) + b"."))
    yield case("frame", torch_file(b"\x80\x04\x95" + struct.pack("<Q", 2**62) + b"."))
    yield case("string", torch_file(b"\x80\x04\x8d" + struct.pack("<Q", 2**62) + b"."))
    yield case("memo", torch_file(b"\x80\x02Nr\xff\xff\xff\x7f."))
    yield case("digits", torch_file(b"\x80\x02L" + b"9" * 5_000_000 + b"L\n."))
    for shape in ((2**40,), (2**62, 2**62), (1,) * 5000, (0, 2**62)):
        yield case(
            f"shape-{len(shape)}-{shape[0]}",
            torch_file(b"\x80\x02}" + pickled_text("a") + pickled_tensor(0, shape) + b"s."),
        )
    yield case("byteorder", torch_file(None, byteorder=b"\0" * 50_000_000))
    packed_order = io.BytesIO()
    with zipfile.ZipFile(packed_order, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("archive/data.pkl", b"\x80\x02}.")
        archive.writestr("archive/version", b"3\n")
        with archive.open("archive/byteorder", "w", force_zip64=True) as stream:
            for _ in range(300):
                stream.write(b"\0" * 1_000_000)
    yield case("byteorder-bomb", packed_order.getvalue(), least="refused")
    yield case("locked", locked(torch_file()), least="refused")
    yield case(
        "twice", zipped({"a/data.pkl": b"\x80\x02}.", "b/data.pkl": b"\x80\x02}."}), least="refused"
    )
    lied = torch_file()
    yield case("cut", lied[: len(lied) // 2], least="refused")
    for name in ("../../outside/x", "a\0b", "n" * 60_000):
        yield case(
            f"member-{name[:3]!a}", zipped({f"{name}/data.pkl": b"\x80\x02}."}), least="refused"
        )


def _headers() -> Iterator[Case]:
    def case(name: str, data: bytes, **options: Any) -> Case:
        return Case(
            f"safetensors-{name}",
            "safetensors",
            "weights",
            "w.safetensors",
            {"w.safetensors": data},
            **options,
        )

    for length in (0, 1, 2**31, 2**63, 2**64 - 1):
        yield case(f"length-{length}", struct.pack("<Q", length) + b"{}", least="refused")
    for name, entry in {
        "words": {"dtype": "F32", "shape": [1], "data_offsets": ["a", "b"]},
        "minus": {"dtype": "F32", "shape": ["x"], "data_offsets": [0, -1]},
        "bools": {"dtype": "F32", "shape": [True], "data_offsets": [False, True]},
        "none": {"dtype": None, "shape": None, "data_offsets": None},
        "nested": {"dtype": ["F32"], "shape": [[1]], "data_offsets": [[0], [4]]},
        "rank": {"dtype": "F32", "shape": [1] * 200_000, "data_offsets": [0, 4]},
        "product": {"dtype": "F32", "shape": [10**4000] * 2000, "data_offsets": [0, 4]},
        "zero": {"dtype": "F32", "shape": [0] + [10**4000] * 100, "data_offsets": [0, 0]},
        "float": {"dtype": "F32", "shape": [1.0], "data_offsets": [0.0, 4.0]},
        "text": "x" * 1_000_000,
    }.items():
        yield case(name, safetensors({"a": entry}, b"\0" * 4), least="refused")
    for text in (
        b"[" * 1_000_000,
        b'{"a":' * 100_000,
        b"[]",
        b"1",
        b"\xff\xfe",
        b'{"a":1,"a":2}',
        b"[" + b"{}," * 10_000_000 + b"1]",
    ):
        yield case(
            f"json-{text[:5]!a}-{len(text)}", struct.pack("<Q", len(text)) + text, least="refused"
        )
    metadata: Any = {"terms": "\x1b[2Jx"}
    for _ in range(900):
        metadata = {"a": metadata}
    whole = {
        name: {"dtype": "F32", "shape": list(shape), "data_offsets": [0, 0]}
        for name, shape in network_shapes().items()
    }
    yield case("metadata", safetensors({"__metadata__": metadata, **whole}, b""))
    yield case("metadata-list", safetensors({"__metadata__": [1]}, b""), least="refused")
    yield case("json", json.dumps({"a": 1}).encode())


WEIGHT_PAGES = {"checkpoints": _checkpoints, "headers": _headers}
