"""Attacks by hand on USD: files elsewhere, prims that multiply, packages that are none."""

from collections.abc import Iterator
from typing import Any

from fuzz_cases import Case, usd_files, zipped
from fuzz_hostile import ELSEWHERE, links

_HEAD = "#usda 1.0\n"
_TRIANGLE = "int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]"
_MESH = f'def Mesh "m"\n{{\n{_TRIANGLE}\n%s\n}}\n'
_POINTS = "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]"


def _both(name: str, text: str | bytes, suffix: str = "usda", **options: Any) -> Iterator[Case]:
    """Read once as an input and once as something to judge."""
    entry = f"thing.{suffix}"
    data = text if isinstance(text, bytes) else (_HEAD + text).encode()
    more = options.pop("more", {})
    for verb in ("load", "check"):
        yield Case(f"usd-{verb}-{name}", "usd", verb, entry, {entry: data, **more}, **options)


def laughs(levels: int, width: int, how: str = "") -> str:
    """Prims that each refer to the one before so many times."""
    text = f'def Xform "L0"\n{{\n{_MESH % _POINTS}}}\n'
    for level in range(1, levels + 1):
        arcs = f"({how}\nprepend references = </L{level - 1}>\n)"
        inner = "".join(f'def Xform "c{k}" {arcs} {{ }}\n' for k in range(width))
        text += f'def Xform "L{level}" {{\n{inner}}}\n'
    return text


def _usd() -> Iterator[Case]:
    for number, reference in enumerate(ELSEWHERE):
        place = reference.replace("{0}", "usda").replace("\\", "\\\\")
        for what in ("references", "payload"):
            text = f'def Xform "a" (prepend {what} = @{place}@) {{}}\n{_MESH % _POINTS}'
            yield from _both(f"{what}-{number}", text, links=links("usda"))
        yield from _both(f"layers-{number}", f"(subLayers = [@{place}@])\n", links=links("usda"))
    yield from _both("laughs", laughs(12, 10), least="too_large")
    yield from _both("laughs-shared", laughs(12, 10, "instanceable = true"), least="too_large")
    inherits = laughs(12, 10).replace("references", "inherits")
    yield from _both("laughs-inherited", inherits, least="too_large")
    layers = {
        f"l{k}.usda": f'{_HEAD}(defaultPrim = "a")\ndef "a" {{\n{_twice(k, 10)}}}\n'.encode()
        for k in range(1, 12)
    }
    layers["l0.usda"] = f'{_HEAD}(defaultPrim = "a")\ndef "a"\n{{\n{_MESH % _POINTS}}}\n'.encode()
    yield from _both("laughs-layers", _twice(12, 10), more=layers, least="too_large")
    yield from _both("itself", 'def "a" (prepend references = @thing.usda@</a>) {}\n')
    yield from _both("circle", "(subLayers = [@thing.usda@])\n")
    many = "".join(f'def "p{k}" {{}}\n' for k in range(150_000))
    yield from _both("many", many, least="too_large")
    for depth in (500, 100_000):
        yield from _both(f"deep-{depth}", 'def "a" {\n' * depth + "}\n" * depth)
    for value in ("nan", "inf", "1e308", "1e400", "-1e39"):
        points = _POINTS.replace("1, 0, 0", f"{value}, 0, 0")
        yield from _both(f"point-{value}", _MESH % points)
        yield from _both(f"metres-{value}", f"(metersPerUnit = {value})\n{_MESH % _POINTS}")
    mesh = _MESH % _POINTS
    for index in ("-1", "3", "2147483647", "4294967296"):
        yield from _both(f"index-{index}", mesh.replace("[0, 1, 2]", f"[0, 1, {index}]"))
        yield from _both(f"count-{index}", mesh.replace("[3]", f"[{index}]"))
    yield from _both("name", f'def "{"n" * 100_000}" \n{{\n{_MESH % _POINTS}}}\n')
    yield from _both("clips", 'def "a" (clips = {dictionary default = {}}) {}\n')
    yield from _both("computed", 'def "a" (prepend references = @`"x"`@) {}\n')
    yield from _both("plugin", "#usda 1.0\n(subLayers = [@a.usda:SDF_FORMAT_ARGS:target=x@])\n")
    yield from _packages()


def _twice(number: int, width: int) -> str:
    arc = f"(prepend references = @l{number - 1}.usda@)"
    return "".join(f'def "c{k}" {arc} {{}}\n' for k in range(width))


def _packages() -> Iterator[Case]:
    files = usd_files()
    if not files:
        return
    inner = files["usda"]
    out = b"#usda 1.0\n(subLayers = [@../../outside/secret.usda@, @/etc/passwd@])\n"
    nesting = b"#usda 1.0\n(subLayers = [@b.usdz[c.usda]@])\n"
    for name, members in {
        "empty": {},
        "traversal": {"../../outside/secret.usda": inner, "a.usda": inner},
        "absolute": {"/etc/x.usda": inner},
        "out": {"a.usda": out},
        "nested": {"a.usda": nesting, "b.usdz": files["usdz"]},
        "text": {"a.txt": b"x"},
        "bomb": {"a.usda": b"#usda 1.0\n" + b" " * 2**26},
    }.items():
        for compression in (0, 8):
            yield from _both(f"package-{name}-{compression}", zipped(members, compression), "usdz")
    stubs = (("usdc", b""), ("usdc", b"PXR-USDC"), ("usdz", b"PK"), ("usd", b"\0" * 4096))
    for suffix, data in stubs:
        yield from _both(f"stub-{len(data)}", data, suffix)
    for at in range(8, 88, 8):
        # The file's head: its version, and where its table of contents lies.
        data = files["usdc"][:at] + b"\xff" * 8 + files["usdc"][at + 8 :]
        yield from _both(f"head-{at}", data, "usdc")


USD_PAGES = {"usd_by_hand": _usd}
