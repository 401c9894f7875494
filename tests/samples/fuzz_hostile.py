"""Attacks by hand on mesh readers, on what meshes refer to, on names of files and on sidecars."""

import json
import struct
from collections.abc import Iterator, Mapping
from typing import Any

from fuzz_cases import Case, annotated, packed, prediction, seeds
from mesh_cube import gltf_parts, pack_glb

ELSEWHERE = (
    *("../outside/secret.{0}", "../../../../../../../../etc/passwd", "/etc/passwd"),
    *("@OUTSIDE@/secret.{0}", "file://@OUTSIDE@/secret.{0}", "file:///etc/passwd"),
    *("http://127.0.0.1:9/secret.{0}", "https://localhost/x.{0}", "ftp://127.0.0.1/x.{0}"),
    *("\\\\127.0.0.1\\share\\secret.{0}", "C:\\secret.{0}", "..\\outside\\secret.{0}"),
    *("sub/../../outside/secret.{0}", "%2e%2e/outside/secret.{0}", "..%2Foutside%2Fsecret.{0}"),
    *("./.././outside/secret.{0}", "package://../outside/secret.{0}"),
    *("link.{0}", "folder_link/secret.{0}", "loop.{0}", "a%00b.{0}"),
    *("n" * 300 + ".{0}", "d/" * 3000 + "x.{0}"),
    *(" ", ".", "..", "/dev/zero", "/proc/self/environ", "~/x.{0}"),
)


def links(suffix: str) -> dict[str, str]:
    """Links out of the folder, and one to itself."""
    return {
        f"link.{suffix}": f"@OUTSIDE@/secret.{suffix}",
        "folder_link": "@OUTSIDE@",
        f"loop.{suffix}": f"loop.{suffix}",
    }


def folder_case(
    kind: str, name: str, entry: str, files: dict[str, bytes], *rest: Any, **options: Any
) -> Case:
    """An input of files in a folder, to be loaded."""
    return Case(f"{kind}-{name}", kind, "load", entry, files, *rest, **options)


def single(name: str, entry: str, data: bytes, **options: Any) -> Case:
    """An input of one file."""
    return Case(name, entry.rsplit(".", 1)[-1], "load", entry, {entry: data}, **options)


def _glb(name: str, changes: Mapping[str, dict[str, Any]], **parts: Any) -> Case:
    """The cube as GLB, fields of the first item of some of its document's lists changed."""
    document, binary = gltf_parts(**parts)
    for place, fields in changes.items():
        document[place][0].update(fields)
    return single(f"glb-{name}", "cube.glb", pack_glb(document, binary))


def _changed(kind: str, file: str, old: bytes, new: str) -> dict[str, bytes]:
    """The sound files of a kind, a piece of one of them another."""
    files = seeds()[kind].files
    return {**files, file: files[file].replace(old, new.encode(), 1)}


def _references() -> Iterator[Case]:
    for number, reference in enumerate(ELSEWHERE):
        picture, library, array, buffer = (
            reference.replace("{0}", suffix) for suffix in ("png", "mtl", "npz", "bin")
        )
        document, binary = gltf_parts()
        document["images"] = [{"uri": picture}]
        data = pack_glb(document, binary)
        yield single(f"glb-image-{number}", "cube.glb", data, links=links("png"))
        document, _ = gltf_parts()
        document["buffers"][0]["uri"] = buffer
        data = json.dumps(document).encode()
        yield single(f"gltf-buffer-{number}", "cube.gltf", data, links=links("bin"))
        files = _changed("obj", "cube.obj", b"cube.mtl", library)
        yield folder_case("obj", f"library-{number}", "cube.obj", files, links("mtl"))
        files = _changed("obj", "cube.mtl", b"wood.png", picture)
        yield folder_case("mtl", f"picture-{number}", "cube.obj", files, links("png"))
        ply = _changed("ply_ascii", "cube.ply", b"wood.png", picture)["cube.ply"]
        yield single(f"ply-picture-{number}", "cube.ply", ply, links=links("png"))
        sidecar = b"annotation = " + json.dumps(array).encode()
        files = {**annotated(packed(prediction())), "cube.toml": sidecar}
        yield folder_case("toml", f"annotation-{number}", "cube.glb", files, links("npz"))
        dae = _changed("dae", "cube.dae", b"wood.png", picture.replace("&", ""))["cube.dae"]
        yield single(f"dae-picture-{number}", "cube.dae", dae, links=links("png"))
    cube = {"cube.glb": pack_glb(*gltf_parts())}
    found = {"other.glb": "@OUTSIDE@/secret.png", "o.xml": "@OUTSIDE@/secret.xml"}
    # Nobody named the last one: it is found in the folder.
    for name, files, led in (
        ("link-sidecar", cube, {"cube.toml": "@OUTSIDE@/secret.toml"}),
        ("loop-sidecar", cube, {"cube.toml": "cube.toml"}),
        ("loop-input", {}, {"cube.glb": "cube.glb"}),
        ("link-found", cube, found),
    ):
        yield folder_case("names", name, "cube.glb", files, led)


def _gltf_counts() -> Iterator[Case]:
    counted = (
        *(("accessors", "count"), ("bufferViews", "byteLength"), ("buffers", "byteLength")),
        *(("bufferViews", key) for key in ("byteOffset", "byteStride", "buffer")),
    )
    for count in (2**31, 2**32, 2**40, 2**63, -1, 10**400, 1e308, 2.5, "9", None):
        for place, key in counted:
            yield _glb(f"{place}-{key}-{count!s:.9}", {place: {key: count}})
        indices = {"bufferView": 3, "componentType": 5123}
        sparse = {"count": count, "indices": indices, "values": {"bufferView": 0}}
        document, binary = gltf_parts()
        matrices = {"componentType": 5126, "count": 24, "type": "MAT4", "sparse": sparse}
        document["accessors"][0] = matrices
        yield single(f"glb-sparse-{count!s:.9}", "cube.glb", pack_glb(document, binary))
    for size in (0, 2**31 - 1, 2**32 - 1):
        data = bytearray(pack_glb(*gltf_parts()))
        for at in (8, 12):
            struct.pack_into("<I", data, at, size)
            yield single(f"glb-chunk-{at}-{size}", "cube.glb", bytes(data))
    for value in (float("nan"), float("inf"), 1e308, 0, 1e-320, "x"):
        placed = {"scale": [value] * 3, "rotation": [value] * 4}
        for name, place in (("matrix", {"matrix": [value] * 16}), ("placed", placed)):
            yield _glb(f"{name}-{value}", {}, nodes=[{"mesh": 0, **place}])


def _ply(name: str, form: str, elements: str, body: bytes) -> Case:
    head = f"ply\nformat {form} 1.0\n{elements}end_header\n"
    return single(f"ply-{name}", "a.ply", head.encode() + body)


def _tables() -> Iterator[Case]:
    binary = "binary_little_endian"
    for form in ("ascii", binary):
        for kind, length in (("float", ""), ("int", "list uint "), ("double", "list int ")):
            for count in (2**31, 3_000_000, -5, 10**30):
                elements = "element vertex 3\nproperty float x\n"
                elements += f"element face {count}\nproperty {length}{kind} q\n"
                yield _ply(f"{form}-{kind}-{count}", form, elements, b"\xff\xff\xff\x7f" * 100)
        none = "".join(f"element e{k} 3000000\n" for k in range(900))
        yield _ply(f"nothing-{form}", form, none, b"\n" * 3_000_000)
        empty = "".join(f"element e{k} 3000000\nproperty list uchar int q\n" for k in range(400))
        yield _ply(f"empty-lists-{form}", form, empty, b"\0\n" * 1_500_000)
    again = "element vertex 100000\n" + "property float x\n" * 900
    yield _ply("again", "ascii", again, b"1 \n" * 100_000)
    comments = b"ply\nformat ascii 1.0\n" + b"comment x\n" * 2_000_000
    yield single("ply-header", "a.ply", comments, least="unreadable")
    negative = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    negative += "element face 2\nproperty list char int vertex_indices\n"
    faces = b"\xfd" + b"\x03" + struct.pack("<iii", 0, 1, 2)
    yield _ply("negative", binary, negative, struct.pack("<9f", *range(9)) + faces)


_NAMES = (
    *("a\nb", "a\x1b[31mb", "..glb", "é😀", "\udcff\udcfe", "n" * 240, " ", "-rf", "$(id)"),
    *("a;b|c", "' OR 1=1 --", "<b>", "%s%n", "CON", "a" + "/b" * 500 + "/x", "\u202ebgl"),
)


def _names() -> Iterator[Case]:
    cube = pack_glb(*gltf_parts())
    for stem in _NAMES:
        name = f"{stem}.glb"
        yield folder_case("names", f"{name!a:.40}", name, {name: cube}, least="loaded")
    comment = b"<!--" + b"x" * 30_000_000 + b"--><mujoco/>"
    files = {"a.glb": cube, "a.xml": comment}
    yield folder_case("names", "comment", "a.glb", files, least="loaded")
    yield folder_case("names", "folder", "a.glb", {"a.glb/x": b""})
    yield folder_case("names", "missing", f"{'m' * 400}.glb", {"x": b""})


def _sidecars() -> Iterator[Case]:
    cube = pack_glb(*gltf_parts())
    texts = {
        "deep": b"a = " + b"[" * 60_000,
        "deep-table": b"[" + b"a." * 30_000 + b"a]",
        "digits": b"height = " + b"9" * 5000,
        "int": b"height = 1" + b"0" * 400,
        **{"inf": b"height = inf", "nan": b"scale = nan", "zero": b"scale = 0.0"},
        **{"huge": b"scale = 1e300", "tiny": b"scale = 1e-300"},
        **{"height": b"height = 1e308", "least": b"height = 5e-324"},
        "many": b"".join(b"k%d = 1\n" % k for k in range(6_000)),
        **{"long": b"#" * 900_000, "too-long": b"#" * 1_100_000},
        **{"list": b"category = []", "date": b"license = 1979-05-27"},
        **{"latin": b"license = '\xe9'", "nul": b"license = '\0'"},
        "category": b"category = '../../x\\n\\u0000'",
        "words": b"category = '" + b"a_" * 30_000 + b"'",
        **{"bom": b"\xef\xbb\xbfheight = 1", "inline": b"a = " + b"{a=" * 20_000},
        "density": b"density = 1e999",
        "license": b"license = '" + b"x" * 60_000 + b"'",
    }
    for name, text in texts.items():
        yield folder_case("toml", name, "cube.glb", {"cube.glb": cube, "cube.toml": text})
        urdf = seeds()["urdf"].files
        yield folder_case("toml", f"urdf-{name}", "box.urdf", {**urdf, "box.toml": text})
    yield folder_case("toml", "folder", "cube.glb", {"cube.glb": cube, "cube.toml/x": b""})


MESH_PAGES = {
    "references": _references,
    "gltf_counts": _gltf_counts,
    "tables": _tables,
    "names": _names,
    "sidecars": _sidecars,
}
