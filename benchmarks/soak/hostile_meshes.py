"""Attacks by hand on mesh readers that take long: much work from little files, texts, pictures."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator

from fuzz_cases import Case, seeds
from fuzz_hostile import folder_case, single
from mesh_cube import gltf_parts, pack_glb, png


def _gltf_work() -> Iterator[Case]:
    """Little files that ask for much work."""
    cycle = [{"mesh": 0, "children": [1]}, {"children": [2]}, {"children": [0]}]
    yield single(
        "glb-cycle",
        "cube.glb",
        pack_glb(*gltf_parts(nodes=cycle, scenes=[{"nodes": [0]}])),
        least="unreadable",
    )
    yield single(
        "glb-selfish",
        "cube.glb",
        pack_glb(*gltf_parts(nodes=[{"children": [0]}], scenes=[{"nodes": [0]}])),
    )
    chain = [{"children": [k + 1]} for k in range(50_000)] + [{"mesh": 0}]
    yield single("glb-chain", "cube.glb", pack_glb(*gltf_parts(nodes=chain)), least="loaded")
    document, binary = gltf_parts(nodes=[{"mesh": 0}] * 200_000)
    document["scenes"] = [{"nodes": list(range(200_000))}]
    yield single("glb-instances", "cube.glb", pack_glb(document, binary), least="too_large")
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
        yield single(
            f"glb-work-{count}-{primitives}-{nodes}", "cube.glb", pack_glb(document, binary)
        )
    for opening in ("[", '{"a":'):
        yield single(f"gltf-deep-{opening[0]}", "cube.gltf", (opening * 5_000_000).encode())
        yield single(
            f"gltf-deep-{opening[0]}-short",
            "cube.gltf",
            (opening * 2000).encode(),
            least="unreadable",
        )
    document, binary = gltf_parts()
    document["materials"] = document["materials"] * 20_000
    document["images"] = [{"bufferView": 4}] * 20_000
    document["textures"] = [{"source": k} for k in range(20_000)]
    yield single("glb-textures", "cube.glb", pack_glb(document, binary))
    for extension in (
        "KHR_draco_mesh_compression",
        "EXT_meshopt_compression",
        "EXT_mesh_gpu_instancing",
    ):
        yield single(
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
    yield single("glb-meshopt-view", "cube.glb", pack_glb(document, binary), least="unsupported")


def _texts() -> Iterator[Case]:
    triangle = b"v 0 0 0\nv 1 0 0\nv 0 1 1\n"
    yield single("obj-continued", "a.obj", triangle + b"f 1 2 3\n" + b"\\\n" * 3_000_000)
    yield single(
        "obj-polygon", "a.obj", triangle + b"f" + b" 1" * 3_000_000 + b"\n", least="too_large"
    )
    yield single("obj-index", "a.obj", triangle + b"f 1 2 99999999999999999999999\nf 1 2 3\n")
    yield single(
        "obj-digits", "a.obj", triangle + b"f 1 2 " + b"9" * 1_000_000 + b"\n", least="unreadable"
    )
    yield single(
        "obj-materials",
        "a.obj",
        triangle + b"".join(b"usemtl m\nf 1 2 3\n" for k in range(100_000)),
    )
    yield single(
        "obj-many-materials",
        "a.obj",
        triangle + b"".join(b"usemtl %d\nf 1 2 3\n" % k for k in range(100_000)),
    )
    yield single(
        "obj-same-name",
        "a.obj",
        triangle + b"".join(b"usemtl %s\nf 1 2 3\n" % (b"." * k) for k in range(5000)),
    )
    mtl = b"".join(b"newmtl m%d\nKd 1 0 0\n" % k for k in range(50_000))
    for times in (1, 20_000):
        files = {"a.obj": b"mtllib a.mtl\n" * times + triangle + b"f 1 2 3\n", "a.mtl": mtl}
        yield folder_case("obj", f"libraries-{times}", "a.obj", files, least="loaded")
    files = {"a.obj": b"mtllib a.mtl\n" + triangle + b"f 1 2 3\n", "p.png": png((64, 64))}
    yield folder_case(
        "mtl",
        "maps",
        "a.obj",
        {**files, "a.mtl": b"newmtl m\n" + b"map_Kd p.png\n" * 200_000},
        least="loaded",
    )
    yield folder_case(
        "mtl",
        "itself",
        "a.obj",
        {**files, "a.mtl": b"newmtl m\nmap_Kd a.mtl\nmap_Kd a.obj\n"},
        least="loaded",
    )
    yield single("off-counts", "a.off", b"OFF\n4294967296 4294967296 0\n", least="unreadable")
    yield single(
        "off-polygon",
        "a.off",
        b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2147483648 0 1 2\n",
        least="too_large",
    )
    yield single(
        "off-negative", "a.off", b"OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n-2147483648 0 1 2\n3 0 1 2\n"
    )
    yield single("off-word", "a.off", b"OFF\n3 1 0\n" + b"1" * 10_000_000)
    yield single("stl-vertices", "a.stl", b"solid x\n" + b"vertex" * 3_000_000)
    yield single("stl-blanks", "a.stl", b"solid x\n" + b"vertex" + b" " * 5_000_000 + b"x")
    yield single(
        "stl-vertex-blanks",
        "a.stl",
        b"solid x\n" + b"vertex 1" + b" " * 2_000_000 + b"\n" + (b"vertex" + b" " * 1000) * 2000,
    )
    yield single(
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
            yield single(f"{entry}-{name}", entry, data)


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
        yield single(f"glb-picture-{name}", "cube.glb", pack_glb(*gltf_parts(image=data or b"\0")))
        yield folder_case(
            "png", f"obj-picture-{name}", "cube.obj", {**seeds()["obj"].files, "wood.png": data}
        )
        urdf = seeds()["urdf"].files
        plain = urdf["cube.mtl"].replace(b"map_Kd", b"#")
        yield folder_case(
            "urdf", f"picture-{name}", "box.urdf", {**urdf, "wood.png": data, "cube.mtl": plain}
        )
        yield folder_case(
            "mjcf", f"picture-{name}", "box.xml", {**seeds()["mjcf"].files, "wood.png": data}
        )


LONG_PAGES = {"gltf_work": _gltf_work, "texts": _texts, "pictures": _pictures}
