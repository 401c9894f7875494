"""Attacks by hand on mesh readers, on what meshes refer to, on names of files and on sidecars."""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Iterator
from typing import Any

from fuzz_cases import Case, annotated, packed, prediction, seeds
from mesh_cube import gltf_parts, pack_glb, png

#: References that must not be followed, as meshes, descriptions and sidecars write them.
ELSEWHERE = (
    "../outside/secret.{0}",
    "../../../../../../../../etc/passwd",
    "/etc/passwd",
    "@OUTSIDE@/secret.{0}",
    "file://@OUTSIDE@/secret.{0}",
    "file:///etc/passwd",
    "http://127.0.0.1:9/secret.{0}",
    "https://localhost/x.{0}",
    "ftp://127.0.0.1/x.{0}",
    "\\\\127.0.0.1\\share\\secret.{0}",
    "C:\\secret.{0}",
    "..\\outside\\secret.{0}",
    "sub/../../outside/secret.{0}",
    "%2e%2e/outside/secret.{0}",
    "..%2Foutside%2Fsecret.{0}",
    "./.././outside/secret.{0}",
    "package://../outside/secret.{0}",
    "link.{0}",
    "folder_link/secret.{0}",
    "loop.{0}",
    "a%00b.{0}",
    "n" * 300 + ".{0}",
    "d/" * 3000 + "x.{0}",
    " ",
    ".",
    "..",
    "/dev/zero",
    "/proc/self/environ",
    "~/x.{0}",
)


def links(suffix: str) -> dict[str, str]:
    """Links out of the folder, and one to itself."""
    return {
        f"link.{suffix}": f"@OUTSIDE@/secret.{suffix}",
        "folder_link": "@OUTSIDE@",
        f"loop.{suffix}": f"loop.{suffix}",
    }


def _case(
    kind: str, name: str, entry: str, files: dict[str, bytes], *rest: Any, **options: Any
) -> Case:
    """An input of files in a folder, to be loaded."""
    return Case(f"{kind}-{name}", kind, "load", entry, files, *rest, **options)


def _single(name: str, entry: str, data: bytes, **options: Any) -> Case:
    return Case(name, entry.rsplit(".", 1)[-1], "load", entry, {entry: data}, **options)


def _references() -> Iterator[Case]:
    for number, reference in enumerate(ELSEWHERE):
        picture = reference.replace("{0}", "png")
        library = reference.replace("{0}", "mtl")
        document, binary = gltf_parts()
        document["images"] = [{"uri": picture}]
        yield _single(
            f"glb-image-{number}", "cube.glb", pack_glb(document, binary), links=links("png")
        )
        document, _ = gltf_parts()
        document["buffers"][0]["uri"] = reference.replace("{0}", "bin")
        yield _single(
            f"gltf-buffer-{number}", "cube.gltf", json.dumps(document).encode(), links=links("bin")
        )
        obj = seeds()["obj"].files
        text = obj["cube.obj"].replace(b"cube.mtl", library.encode())
        yield _case("obj", f"library-{number}", "cube.obj", {**obj, "cube.obj": text}, links("mtl"))
        text = obj["cube.mtl"].replace(b"wood.png", picture.encode())
        yield _case("mtl", f"picture-{number}", "cube.obj", {**obj, "cube.mtl": text}, links("png"))
        ply = seeds()["ply_ascii"].files["cube.ply"].replace(b"wood.png", picture.encode())
        yield _single(f"ply-picture-{number}", "cube.ply", ply, links=links("png"))
        toml = b"annotation = " + json.dumps(reference.replace("{0}", "npz")).encode()
        files = {**annotated(packed(prediction())), "cube.toml": toml}
        yield _case("toml", f"annotation-{number}", "cube.glb", files, links("npz"))
        dae = (
            seeds()["dae"]
            .files["cube.dae"]
            .replace(
                b"<library_geo",
                b"<library_images><image id='i'><init_from>"
                + picture.replace("&", "").encode()
                + b"</init_from></image></library_images><library_geo",
                1,
            )
        )
        yield _single(f"dae-picture-{number}", "cube.dae", dae, links=links("png"))
    cube = {"cube.glb": pack_glb(*gltf_parts())}
    yield _case("names", "link-sidecar", "cube.glb", cube, {"cube.toml": "@OUTSIDE@/secret.toml"})
    yield _case("names", "loop-sidecar", "cube.glb", cube, {"cube.toml": "cube.toml"})
    yield _case("names", "loop-input", "cube.glb", {}, {"cube.glb": "cube.glb"})
    # Nobody named this one: it is found in the folder.
    yield _case(
        "names",
        "link-found",
        "cube.glb",
        cube,
        {"other.glb": "@OUTSIDE@/secret.png", "o.xml": "@OUTSIDE@/secret.xml"},
    )


def _gltf_counts() -> Iterator[Case]:
    for count in (2**31, 2**32, 2**40, 2**63, -1, 10**400, 1e308, 2.5, "9", None):
        for place, key in (
            ("accessors", "count"),
            ("bufferViews", "byteLength"),
            ("buffers", "byteLength"),
        ):
            document, binary = gltf_parts()
            document[place][0][key] = count
            yield _single(f"glb-{place}-{count!s:.9}", "cube.glb", pack_glb(document, binary))
        for key in ("byteOffset", "byteStride", "buffer"):
            document, binary = gltf_parts()
            document["bufferViews"][0][key] = count
            yield _single(f"glb-view-{key}-{count!s:.9}", "cube.glb", pack_glb(document, binary))
        document, binary = gltf_parts()
        document["accessors"][0] = {
            "componentType": 5126,
            "count": 24,
            "type": "MAT4",
            "sparse": {
                "count": count,
                "indices": {"bufferView": 3, "componentType": 5123},
                "values": {"bufferView": 0},
            },
        }
        yield _single(f"glb-sparse-{count!s:.9}", "cube.glb", pack_glb(document, binary))
    for size in (0, 2**31 - 1, 2**32 - 1):
        data = bytearray(pack_glb(*gltf_parts()))
        for at in (8, 12):
            struct.pack_into("<I", data, at, size)
            yield _single(f"glb-chunk-{at}-{size}", "cube.glb", bytes(data))
    for values in (
        [float("nan")] * 16,
        [float("inf")] * 16,
        [1e308] * 16,
        [0] * 16,
        [1e-320] * 16,
        ["x"] * 16,
    ):
        document, binary = gltf_parts(nodes=[{"mesh": 0, "matrix": values}])
        yield _single(f"glb-matrix-{values[0]}", "cube.glb", pack_glb(document, binary))
        document, binary = gltf_parts(
            nodes=[{"mesh": 0, "scale": values[:3], "rotation": values[:4]}]
        )
        yield _single(f"glb-placed-{values[0]}", "cube.glb", pack_glb(document, binary))


def _gltf_work() -> Iterator[Case]:
    """Little files that ask for much work."""
    cycle = [{"mesh": 0, "children": [1]}, {"children": [2]}, {"children": [0]}]
    yield _single(
        "glb-cycle",
        "cube.glb",
        pack_glb(*gltf_parts(nodes=cycle, scenes=[{"nodes": [0]}])),
        least="unreadable",
    )
    yield _single(
        "glb-selfish",
        "cube.glb",
        pack_glb(*gltf_parts(nodes=[{"children": [0]}], scenes=[{"nodes": [0]}])),
    )
    chain = [{"children": [k + 1]} for k in range(50_000)] + [{"mesh": 0}]
    yield _single("glb-chain", "cube.glb", pack_glb(*gltf_parts(nodes=chain)), least="loaded")
    document, binary = gltf_parts(nodes=[{"mesh": 0}] * 200_000)
    document["scenes"] = [{"nodes": list(range(200_000))}]
    yield _single("glb-instances", "cube.glb", pack_glb(document, binary), least="too_large")
    for count, primitives, nodes in (
        (2_999_999, 3000, 1),
        (2_999_999, 1, 3000),
        (3, 20_000, 20_000),
    ):
        document, binary = gltf_parts(nodes=[{"mesh": 0}] * nodes)
        document["scenes"] = [{"nodes": list(range(nodes))}]
        document["accessors"] += [{"componentType": 5126, "count": count, "type": "MAT4"}]
        document["accessors"] += [{"componentType": 5126, "count": count, "type": "VEC3"}]
        document["accessors"] += [{"componentType": 5125, "count": 0, "type": "SCALAR"}]
        empty = {
            "attributes": {"POSITION": 5, "COLOR_0": 4, "NORMAL": 4, "TEXCOORD_0": 4},
            "indices": 6,
        }
        document["meshes"] = [{"primitives": [empty] * primitives}]
        yield _single(
            f"glb-work-{count}-{primitives}-{nodes}", "cube.glb", pack_glb(document, binary)
        )
    for opening in ("[", '{"a":'):
        yield _single(f"gltf-deep-{opening[0]}", "cube.gltf", (opening * 5_000_000).encode())
        yield _single(
            f"gltf-deep-{opening[0]}-short",
            "cube.gltf",
            (opening * 2000).encode(),
            least="unreadable",
        )
    document, binary = gltf_parts()
    document["materials"] = document["materials"] * 20_000
    document["images"] = [{"bufferView": 4}] * 20_000
    document["textures"] = [{"source": k} for k in range(20_000)]
    yield _single("glb-textures", "cube.glb", pack_glb(document, binary))
    for extension in (
        "KHR_draco_mesh_compression",
        "EXT_meshopt_compression",
        "EXT_mesh_gpu_instancing",
    ):
        yield _single(
            f"glb-{extension}",
            "cube.glb",
            pack_glb(*gltf_parts(extensionsRequired=[extension])),
            least="unsupported",
        )
    document, binary = gltf_parts()
    for view in document["bufferViews"]:
        view["extensions"] = {
            "EXT_meshopt_compression": {
                "buffer": 0,
                "byteLength": 10,
                "count": 2**31,
                "byteStride": 64,
            }
        }
    yield _single("glb-meshopt-view", "cube.glb", pack_glb(document, binary), least="unsupported")


def _texts() -> Iterator[Case]:
    triangle = b"v 0 0 0\nv 1 0 0\nv 0 1 1\n"
    yield _single("obj-continued", "a.obj", triangle + b"f 1 2 3\n" + b"\\\n" * 3_000_000)
    yield _single(
        "obj-polygon", "a.obj", triangle + b"f" + b" 1" * 3_000_000 + b"\n", least="too_large"
    )
    yield _single("obj-index", "a.obj", triangle + b"f 1 2 99999999999999999999999\nf 1 2 3\n")
    yield _single(
        "obj-digits", "a.obj", triangle + b"f 1 2 " + b"9" * 1_000_000 + b"\n", least="unreadable"
    )
    yield _single(
        "obj-materials",
        "a.obj",
        triangle + b"".join(b"usemtl m\nf 1 2 3\n" for k in range(100_000)),
    )
    yield _single(
        "obj-many-materials",
        "a.obj",
        triangle + b"".join(b"usemtl %d\nf 1 2 3\n" % k for k in range(100_000)),
    )
    yield _single(
        "obj-same-name",
        "a.obj",
        triangle + b"".join(b"usemtl %s\nf 1 2 3\n" % (b"." * k) for k in range(5000)),
    )
    mtl = b"".join(b"newmtl m%d\nKd 1 0 0\n" % k for k in range(50_000))
    for times in (1, 20_000):
        files = {"a.obj": b"mtllib a.mtl\n" * times + triangle + b"f 1 2 3\n", "a.mtl": mtl}
        yield _case("obj", f"libraries-{times}", "a.obj", files, least="loaded")
    files = {"a.obj": b"mtllib a.mtl\n" + triangle + b"f 1 2 3\n", "p.png": png((64, 64))}
    yield _case(
        "mtl",
        "maps",
        "a.obj",
        {**files, "a.mtl": b"newmtl m\n" + b"map_Kd p.png\n" * 200_000},
        least="loaded",
    )
    yield _case(
        "mtl",
        "itself",
        "a.obj",
        {**files, "a.mtl": b"newmtl m\nmap_Kd a.mtl\nmap_Kd a.obj\n"},
        least="loaded",
    )
    yield _single("off-counts", "a.off", b"OFF\n4294967296 4294967296 0\n", least="unreadable")
    yield _single(
        "off-polygon",
        "a.off",
        b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2147483648 0 1 2\n",
        least="too_large",
    )
    yield _single(
        "off-negative", "a.off", b"OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n-2147483648 0 1 2\n3 0 1 2\n"
    )
    yield _single("off-word", "a.off", b"OFF\n3 1 0\n" + b"1" * 10_000_000)
    yield _single("stl-vertices", "a.stl", b"solid x\n" + b"vertex" * 3_000_000)
    yield _single("stl-blanks", "a.stl", b"solid x\n" + b"vertex" + b" " * 5_000_000 + b"x")
    yield _single(
        "stl-vertex-blanks",
        "a.stl",
        b"solid x\n" + b"vertex 1" + b" " * 2_000_000 + b"\n" + (b"vertex" + b" " * 1000) * 2000,
    )
    yield _single(
        "stl-nan",
        "a.stl",
        b"\1" * 80 + struct.pack("<I", 4) + b"\xff\xff\xff\x7f" * 50,
        least="not_finite",
    )
    for entry in (
        "a.glb",
        "a.gltf",
        "a.obj",
        "a.ply",
        "a.stl",
        "a.off",
        "a.dae",
        "a.urdf",
        "a.xml",
    ):
        for name, data in (
            ("empty", b""),
            ("zeros", b"\0" * 4096),
            ("latin", b"\xe9\xff\xfe" * 400),
            ("line", b"v" * 2_000_000),
        ):
            yield _single(f"{entry}-{name}", entry, data)


def _tables() -> Iterator[Case]:
    for form in ("ascii", "binary_little_endian"):
        for kind, length in (("float", ""), ("int", "list uint "), ("double", "list int ")):
            for count in (2**31, 3_000_000, -5, 10**30):
                head = (
                    f"ply\nformat {form} 1.0\nelement vertex 3\nproperty float x\n"
                    f"element face {count}\n"
                )
                head += f"property {length}{kind} q\nend_header\n"
                yield _single(
                    f"ply-{form}-{kind}-{count}", "a.ply", head.encode() + b"\xff\xff\xff\x7f" * 100
                )
        none = "".join(f"element e{k} 3000000\n" for k in range(900))
        yield _single(
            f"ply-nothing-{form}",
            "a.ply",
            f"ply\nformat {form} 1.0\n{none}end_header\n".encode() + b"\n" * 3_000_000,
        )
        empty = "".join(f"element e{k} 3000000\nproperty list uchar int q\n" for k in range(400))
        yield _single(
            f"ply-empty-lists-{form}",
            "a.ply",
            f"ply\nformat {form} 1.0\n{empty}end_header\n".encode() + b"\0\n" * 1_500_000,
        )
    again = "".join("property float x\n" for _ in range(900))
    yield _single(
        "ply-again",
        "a.ply",
        f"ply\nformat ascii 1.0\nelement vertex 100000\n{again}end_header\n".encode()
        + b"1 \n" * 100_000,
    )
    yield _single(
        "ply-header",
        "a.ply",
        b"ply\nformat ascii 1.0\n" + b"comment x\n" * 2_000_000,
        least="unreadable",
    )
    negative = (
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
        "property float y\nproperty float z\n"
    )
    negative += "element face 2\nproperty list char int vertex_indices\nend_header\n"
    faces = b"\xfd" + b"\x03" + struct.pack("<iii", 0, 1, 2)
    yield _single(
        "ply-negative", "a.ply", negative.encode() + struct.pack("<9f", *range(9)) + faces
    )


def _pictures() -> Iterator[Case]:
    def chunk(kind: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    def picture(width: int, height: int, *extra: bytes, data: bytes = b"") -> bytes:
        head = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
        return (
            b"\x89PNG\r\n\x1a\n"
            + head
            + b"".join(extra)
            + chunk(b"IDAT", data)
            + chunk(b"IEND", b"")
        )

    bomb = zlib.compress(b"\0" * 200_000_000)
    found = {
        "huge": picture(2**31 - 1, 2**31 - 1),
        "pixels": picture(60_000, 60_000),
        "bomb": picture(8, 8, data=bomb),
        "text": picture(2, 2, chunk(b"zTXt", b"x\0\0" + bomb), data=zlib.compress(b"\0" * 14)),
        "profile": picture(2, 2, chunk(b"iCCP", b"x\0\0" + bomb), data=zlib.compress(b"\0" * 14)),
        "empty": b"",
        "gif": b"GIF89a" + struct.pack("<HH", 65535, 65535) + b"\0" * 100,
        "tiff": b"II*\0\x08\0\0\0\x01\0" + struct.pack("<HHII", 256, 4, 1, 2**31 - 1) + b"\0" * 4,
        "bmp": b"BM"
        + struct.pack("<IIIIiiHHIIiiII", 2**31, 0, 54, 40, 2**30, 2**30, 1, 24, 0, 0, 0, 0, 0, 0),
        "tga": b"\0\0\x0a" + b"\0" * 9 + struct.pack("<HH", 65535, 65535) + b"\x18\0",
        "ppm": b"P6 99999999 99999999 255\n",
        "dds": b"DDS " + struct.pack("<IIII", 124, 0x1007, 2**30, 2**30) + b"\0" * 200,
        "eps": b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n(x) (w) file\n",
        "svg": b"<svg xmlns='http://www.w3.org/2000/svg'><image href='file:///etc/passwd'/></svg>",
        "jpeg": b"\xff\xd8\xff\xe0\0\x10JFIF\0\1\1\0\0\1\0\1\0\0\xff\xc0\0\x11\x08\xff\xff\xff\xff"
        b"\x03\1\x22\0\2\x11\1\3\x11\1\xff\xd9",
    }
    for name, data in found.items():
        yield _single(f"glb-picture-{name}", "cube.glb", pack_glb(*gltf_parts(image=data or b"\0")))
        yield _case(
            "png", f"obj-picture-{name}", "cube.obj", {**seeds()["obj"].files, "wood.png": data}
        )
        urdf = seeds()["urdf"].files
        plain = urdf["cube.mtl"].replace(b"map_Kd", b"#")
        yield _case(
            "urdf", f"picture-{name}", "box.urdf", {**urdf, "wood.png": data, "cube.mtl": plain}
        )
        yield _case(
            "mjcf", f"picture-{name}", "box.xml", {**seeds()["mjcf"].files, "wood.png": data}
        )


def _names() -> Iterator[Case]:
    cube = pack_glb(*gltf_parts())
    long = "n" * 240
    for name in (
        "a\nb.glb",
        "a\x1b[31mb.glb",
        "..glb.glb",
        "é😀.glb",
        "\udcff\udcfe.glb",
        f"{long}.glb",
        " .glb",
        "-rf.glb",
        "$(id).glb",
        "a;b|c.glb",
        "' OR 1=1 --.glb",
        "<b>.glb",
        "%s%n.glb",
        "CON.glb",
        "a" + "/b" * 500 + "/x.glb",
        "\u202ebgl.glb",
    ):
        yield _case("names", f"{name!a:.40}", name, {name: cube}, least="loaded")
    comment = b"<!--" + b"x" * 30_000_000 + b"--><mujoco/>"
    yield _case("names", "comment", "a.glb", {"a.glb": cube, "a.xml": comment}, least="loaded")
    yield _case("names", "folder", "a.glb", {"a.glb/x": b""})
    yield _case("names", "missing", f"{'m' * 400}.glb", {"x": b""})


def _sidecars() -> Iterator[Case]:
    cube = pack_glb(*gltf_parts())
    texts = {
        "deep": b"a = " + b"[" * 60_000,
        "deep-table": b"[" + b"a." * 30_000 + b"a]",
        "digits": b"height = " + b"9" * 5000,
        "int": b"height = 1" + b"0" * 400,
        "inf": b"height = inf",
        "nan": b"scale = nan",
        "zero": b"scale = 0.0",
        "huge": b"scale = 1e300",
        "tiny": b"scale = 1e-300",
        "height": b"height = 1e308",
        "least": b"height = 5e-324",
        "many": b"".join(b"k%d = 1\n" % k for k in range(6_000)),
        "long": b"#" * 900_000,
        "too-long": b"#" * 1_100_000,
        "list": b"category = []",
        "date": b"license = 1979-05-27",
        "latin": b"license = '\xe9'",
        "nul": b"license = '\0'",
        "category": b"category = '../../x\\n\\u0000'",
        "words": b"category = '" + b"a_" * 30_000 + b"'",
        "bom": b"\xef\xbb\xbfheight = 1",
        "inline": b"a = " + b"{a=" * 20_000,
        "density": b"density = 1e999",
        "license": b"license = '" + b"x" * 60_000 + b"'",
    }
    for name, text in texts.items():
        yield _case("toml", f"{name}", "cube.glb", {"cube.glb": cube, "cube.toml": text})
        urdf = seeds()["urdf"].files
        yield _case("toml", f"urdf-{name}", "box.urdf", {**urdf, "box.toml": text})
    yield _case("toml", "folder", "cube.glb", {"cube.glb": cube, "cube.toml/x": b""})


MESH_PAGES = {
    "references": _references,
    "gltf_counts": _gltf_counts,
    "gltf_work": _gltf_work,
    "texts": _texts,
    "tables": _tables,
    "pictures": _pictures,
    "names": _names,
    "sidecars": _sidecars,
}
