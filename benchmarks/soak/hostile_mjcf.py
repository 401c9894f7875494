"""Attacks by hand on what MuJoCo reads: models in models, pictures and meshes that swell."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator, Mapping
from typing import Any

from fuzz_cases import Case, zipped

GEOM = '<geom size="0.1"/>'
_BODY = f'<body name="b">{GEOM}</body>'


def _both(name: str, world: str, before: str = "", **options: Any) -> Iterator[Case]:
    """Read once as an input and once as something to judge."""
    more: Mapping[str, bytes] = options.pop("more", {})
    text = f"<mujoco>{before}<worldbody>{world}</worldbody></mujoco>".encode()
    for verb in ("load", "check"):
        files = {"scene.xml": text, **more}
        yield Case(f"mjcf-{verb}-{name}", "mjcf", verb, "scene.xml", files, **options)


def attached(depth: int, times: int) -> dict[str, bytes]:
    """Models ``m0.xml``... that each attach the one before so many times."""
    files = {"m0.xml": f"<mujoco><worldbody>{_BODY}</worldbody></mujoco>".encode()}
    for level in range(1, depth + 1):
        every = "".join(
            f'<frame><attach model="m" body="b" prefix="{k}_"/></frame>' for k in range(times)
        )
        asset = f'<asset><model name="m" file="m{level - 1}.xml"/></asset>'
        world = f'<worldbody><body name="b">{every}</body></worldbody>'
        files[f"m{level}.xml"] = f"<mujoco>{asset}{world}</mujoco>".encode()
    return files


def picture(width: int, height: int) -> bytes:
    """A black PNG, thousands of times smaller than its pixels."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    rows = zlib.compressobj(9)
    line = b"\0" * (1 + 3 * width)
    data = b"".join(rows.compress(line) for _ in range(height)) + rows.flush()
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    magic = b"\x89PNG\r\n\x1a\n"
    return magic + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


def _mjcf_more() -> Iterator[Case]:
    yield from _models()
    yield from _files()
    yield from _texts()


def _models() -> Iterator[Case]:
    attach = '<attach model="m" prefix="x"/>'
    for depth, times in ((2, 3), (6, 10), (12, 20), (20, 1), (300, 1)):
        asset = f'<asset><model name="m" file="m{depth}.xml"/></asset>'
        yield from _both(f"attached-{depth}-{times}", attach, asset, more=attached(depth, times))
    itself = '<asset><model name="m" file="scene.xml"/></asset>'
    yield from _both("attached-itself", attach, itself)
    asset = '<asset><model name="m" file="../outside/secret.xml"/></asset>'
    yield from _both("attached-outside", attach, asset)
    for count in ("-1", "0", "1e9", "0x7fffffff", "9" * 400, " 3 ", "3 3", "nan"):
        grid = f'<flexcomp name="f" type="grid" count="{count} 2 2" spacing="1 1 1" dim="3"/>'
        yield from _both(f"replicate-{count[:9]}", f'<replicate count="{count}">{GEOM}</replicate>')
        yield from _both(f"grid-{count[:9]}", grid)
    for shape in ("grid", "box", "cylinder", "ellipsoid", "square", "disc", "circle"):
        size = '<flexcomp name="f" type="{}" count="2000 2000 {}" spacing="1 1 1" dim="2"/>'
        for deep in (1, 20):
            yield from _both(f"flex-{shape}-{deep}", size.format(shape, deep), least="too_large")
    chain = {
        f"c{k}.xml": f'<mujocoinclude><include file="c{k + 1}.xml"/></mujocoinclude>'.encode()
        for k in range(3000)
    }
    chain["c3000.xml"] = b"<mujocoinclude/>"
    yield from _both("chain", '<include file="c0.xml"/>', more=chain)
    yield from _both("many", '<include file="scene.xml"/>' * 3000)


def _files() -> Iterator[Case]:
    bomb = {"t.png": picture(30_000, 30_000)}
    texture = '<asset><texture name="t" type="2d" file="t.png"/></asset>'
    yield from _both("picture", _BODY, texture, more=bomb)
    field = '<asset><hfield name="h" file="t.png" size="1 1 1 1"/></asset>'
    yield from _both("field", _BODY + '<geom type="hfield" hfield="h"/>', field, more=bomb)
    mesh = '<asset><mesh name="m" file="m.{}"/></asset>'
    use = '<geom type="mesh" mesh="m"/>'
    stl = b"\0" * 80 + struct.pack("<I", 2**32 - 1) + b"\0" * 500
    legacy = struct.pack("<4i", 2**31 - 1, 2**31 - 1, 2**31 - 1, 2**31 - 1) + b"\0" * 100
    obj = b"mtllib ../outside/secret.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    faces = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf" + b" 1 2 3" * 500_000 + b"\n"
    for name, (suffix, data) in {
        "stl": ("stl", stl),
        "legacy": ("msh", legacy),
        "library": ("obj", obj),
        "polygon": ("obj", faces),
        "index": ("obj", b"v 0 0 0\nf 1 99999999999 -5\n"),
        "numbers": ("obj", b"v " + b"9" * 400_000 + b" 0 0\nf 1 1 1\n"),
        "gmsh": ("msh", b"$MeshFormat\n4.1 1 8\n" + b"\xff" * 400),
    }.items():
        yield from _both(f"mesh-{name}", use, mesh.format(suffix), more={f"m.{suffix}": data})
    archive = {"m.mjz": zipped({"scene.xml": b"<mujoco/>", "../../outside/secret.xml": b"x"}, 8)}
    yield from _both("archive", '<include file="m.mjz"/>', more=archive)


def _texts() -> Iterator[Case]:
    long = "n" * 100_000
    yield from _both("name", f'<body name="{long}">{GEOM}</body>')
    yield from _both("names", "".join(f'<body name="{long}{k}">{GEOM}</body>' for k in range(20)))
    for value in ("nan", "inf", "1e400", "-1e308"):
        yield from _both(f"size-{value}", f'<body><geom size="{value}"/></body>')
        yield from _both(f"place-{value}", f'<body pos="{value} 0 0">{GEOM}</body>')
        yield from _both(f"range-{value}", f'<body><joint range="0 {value}"/>{GEOM}</body>')
    for plugin in ("/lib/x.so", "../outside/x.so", "mujoco.elasticity.cable", "x" * 100_000):
        asked = f'<extension><plugin plugin="{plugin}"/></extension>'
        yield from _both(
            f"plugin-{len(plugin)}", f'<body>{GEOM}<plugin plugin="{plugin}"/></body>', asked
        )
    yield from _both("deep", "<body>" * 20_000 + GEOM + "</body>" * 20_000)
    yield from _both("defaults", _BODY, '<default class="a">' * 400 + "</default>" * 400)
    yield from _both("key", _BODY, "<keyframe>" + f'<key qpos="{"0 " * 300_000}"/>' + "</keyframe>")


MJCF_PAGES = {"mjcf_more": _mjcf_more}
