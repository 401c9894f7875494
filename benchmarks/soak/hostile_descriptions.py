"""Attacks by hand on URDF and MJCF: references, numbers and sizes, a thousand and more."""

from collections.abc import Iterator

from fuzz_cases import Case, seeds
from fuzz_hostile import ELSEWHERE, links
from fuzz_hostile_texts import description


def _urdf() -> Iterator[Case]:
    text = seeds()["urdf"].files["box.urdf"].decode()
    for number, reference in enumerate(ELSEWHERE):
        plain = reference.replace("&", "")
        for what, old, suffix in (
            ("mesh", "cube.obj", "obj"),
            ("stl", "package://box/cube.stl", "stl"),
            ("picture", "wood.png", "png"),
        ):
            yield from description(
                f"{what}-{number}",
                "urdf",
                text.replace(old, plain.replace("{0}", suffix)),
                links=links(suffix),
            )
    for value in ("1e300", "1e308", "1e39", "-1e308", "1e-320", "0", "nan", "9" * 400):
        for old in (
            'xyz="0 0 0.1"',
            'rpy="0 0 1"',
            'scale="1 1 1"',
            'xyz="0 0 1"',
            'radius="0.1"',
            'upper="1.5"',
            'lower="-0.5"',
            'damping="1"',
            'multiplier="1"',
            'mass value="1"',
            'ixx="1"',
            'xyz="1 0 0"',
        ):
            key, _, said = old.partition("=")
            new = f'{key}="{" ".join([value] * len(said.split()))}"'
            yield from description(
                f"{key}-{said.strip(chr(34))[:3]}-{value[:6]}", "urdf", text.replace(old, new)
            )
        limits = f'lower="{value}" upper="{value}"'
        yield from description(
            f"limits-{value[:6]}", "urdf", text.replace('lower="0" upper="1.5"', limits)
        )
        yield from description(
            f"slide-{value[:6]}", "urdf", text.replace('lower="-0.5" upper="0.5"', limits)
        )
    yield from _urdf_sizes(text)


def _urdf_sizes(text: str) -> Iterator[Case]:
    """Much of everything."""
    parents = ["body", *(f"l{k}" for k in range(4000))]
    many = "".join(
        f'<link name="l{k}"/><joint name="j{k}" type="fixed"><parent link="{parents[k]}"/>'
        f'<child link="l{k}"/></joint>'
        for k in range(4000)
    )
    yield from description("chain", "urdf", text.replace("</robot>", many + "</robot>"))
    star = "".join(
        f'<link name="l{k}"/><joint name="j{k}" type="continuous"><parent link="body"/>'
        f'<child link="l{k}"/></joint>'
        for k in range(20_000)
    )
    yield from description("star", "urdf", text.replace("</robot>", star + "</robot>"))
    same = "".join('<link name="same"/>' for _ in range(100_000))
    yield from description("same", "urdf", text.replace("</robot>", same + "</robot>"))
    boxes = '<visual><geometry><box size="1 1 1"/></geometry></visual>' * 30_000
    yield from description("boxes", "urdf", text.replace("<inertial>", boxes + "<inertial>"))
    spheres = '<collision><geometry><sphere radius="1"/></geometry></collision>' * 30_000
    yield from description("spheres", "urdf", text.replace("<inertial>", spheres + "<inertial>"))
    yield from description(
        "deep", "urdf", "<robot>" + "<a>" * 300_000 + "</a>" * 300_000 + "</robot>"
    )
    yield from description("wide", "urdf", "<robot>" + "<a/>" * 5_000_000 + "</robot>")
    yield from description("attribute", "urdf", f"<robot name='{'x' * 10_000_000}'/>")
    yield from description(
        "attributes", "urdf", "<robot " + " ".join(f"a{k}=''" for k in range(300_000)) + "/>"
    )
    yield from description("comment", "urdf", f"<!--{'x' * 20_000_000}--><robot/>")
    yield from description(
        "nul", "urdf", text.replace("hinge", "hi\0nge").encode(), least="unreadable"
    )
    yield from description(
        "latin",
        "urdf",
        b"<?xml version='1.0' encoding='latin-1'?>"
        + text.replace("hinge", "\xe9").encode("latin-1"),
    )
    yield from description(
        "encoding", "urdf", b"<?xml version='1.0' encoding='utf-7'?>" + text.encode()
    )
    yield from description(
        "codec", "urdf", b"<?xml version='1.0' encoding='zip_codec'?>" + text.encode()
    )


def _mjcf() -> Iterator[Case]:
    text = seeds()["mjcf"].files["box.xml"].decode()
    assets = seeds()["mjcf"].files["assets.xml"].decode()
    for number, reference in enumerate(ELSEWHERE[:22:2]):
        where = reference.replace("&", "")
        yield from description(
            f"include-{number}",
            "mjcf",
            text.replace("assets.xml", where.replace("{0}", "xml")),
            links=links("xml"),
        )
        mesh = text.replace(
            '<include file="assets.xml"/>',
            assets[15:-16].replace("cube.stl", where.replace("{0}", "stl")),
        )
        yield from description(f"mesh-{number}", "mjcf", mesh, links=links("stl"))
        picture = text.replace(
            '<include file="assets.xml"/>',
            assets[15:-16].replace("wood.png", where.replace("{0}", "png")),
        )
        yield from description(f"picture-{number}", "mjcf", picture, links=links("png"))
    for name, folder in (
        ("meshdir", "../outside"),
        ("assetdir", "@OUTSIDE@"),
        ("texturedir", "sub/../../outside"),
        ("meshdir", "/"),
    ):
        out = text.replace('angle="radian"', f'angle="radian" {name}="{folder}"').replace(
            "cube.stl", "secret.stl"
        )
        yield from description(f"{name}-{len(folder)}", "mjcf", out)
    for name, element in {
        "replicate": '<replicate count="1000000000"><geom size="1"/></replicate>',
        "replicate-deep": '<replicate count="1000">' * 4 + '<geom size="1"/>' + "</replicate>" * 4,
        "composite": (
            '<composite type="grid" count="10000 10000 1" spacing="1"><geom size="1"/></composite>'
        ),
        "flexcomp": '<flexcomp name="f" type="grid" count="5000 5000 1" spacing="1 1 1" dim="2"/>',
        "geom": '<geom size="1e308" pos="1e308 1e308 nan"/>',
    }.items():
        yield from description(name, "mjcf", text.replace("<worldbody>", f"<worldbody>{element}"))
    for name, element in {
        "texture": (
            '<asset><texture name="t" type="2d" builtin="flat" '
            'width="2000000000" height="2000000000"/></asset>'
        ),
        "hfield": '<asset><hfield name="h" nrow="100000" ncol="100000" size="1 1 1 1"/></asset>',
        "memory": '<size memory="900G"/>',
        "stack": '<size njmax="2000000000" nconmax="2000000000" nstack="2000000000"/>',
        "user": '<size nuser_body="2000000000"/>',
        "plugin": '<extension><plugin plugin="/tmp/evil.so"/></extension>',
        "itself": '<include file="box.xml"/>',
        "keyframe": '<custom><numeric name="n" size="2000000000"/></custom>',
    }.items():
        yield from description(name, "mjcf", text.replace("<worldbody>", f"{element}<worldbody>"))
    both = {k: f"<include file='i{k + 1}.xml'/>" * 20 for k in range(15)}
    files = {
        f"i{k}.xml": f"<mujocoinclude>{inner}</mujocoinclude>".encode() for k, inner in both.items()
    }
    cube = {name: data for name, data in seeds()["urdf"].files.items() if name != "box.urdf"}
    files |= {"i15.xml": b"<mujocoinclude/>", **cube, "assets.xml": assets.encode()}
    twice = text.replace("assets.xml", "i0.xml").encode()
    for verb in ("load", "check"):
        yield Case(f"mjcf-{verb}-includes", "mjcf", verb, "box.xml", {**files, "box.xml": twice})


DESCRIPTION_PAGES = {"urdf": _urdf, "mjcf": _mjcf}
