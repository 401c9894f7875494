"""USD assets as text: a cabinet with its door hinged at the left edge, and variations of it."""

from pathlib import Path

CUBE = (
    "int[] faceVertexCounts = [4, 4, 4, 4, 4, 4]\n"
    "int[] faceVertexIndices = [0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1, 2, 3, "
    "7, 6, 0, 2, 6, 4, 1, 5, 7, 3]\n"
)
CORNERS = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]


def mesh(name: str, size: tuple[float, float, float], inside: str = "") -> str:
    points = ", ".join(
        str(tuple(c * s for c, s in zip(corner, size, strict=True))) for corner in CORNERS
    )
    return f'def Mesh "{name}" ()\n{{\n{CUBE}point3f[] points = [{points}]\n{inside}\n}}\n'


def body(name: str, at: tuple[float, float, float], inside: str, scale: float = 1.0) -> str:
    return (
        f'def Xform "{name}" (prepend apiSchemas = ["PhysicsRigidBodyAPI"])\n{{\n'
        f"double3 xformOp:translate = {at}\nfloat3 xformOp:scale = ({scale}, {scale}, {scale})\n"
        'uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]\n'
        f"{inside}\n}}\n"
    )


def joint(name: str, kind: str, first: str, second: str, inside: str = "") -> str:
    held = f"rel physics:body0 = <{first}>\n" if first else ""
    return (
        f'def Physics{kind}Joint "{name}"\n{{\n{held}rel physics:body1 = <{second}>\n{inside}\n}}\n'
    )


def stage(inside: str, header: str = 'metersPerUnit = 1\nupAxis = "Z"') -> str:
    return f'#usda 1.0\n(\n{header}\n)\ndef Xform "obj"\n{{\n{inside}\n}}\n'


HINGE = (
    'uniform token physics:axis = "Z"\npoint3f physics:localPos0 = (-0.5, -0.31, 0)\n'
    "float physics:lowerLimit = -90\nfloat physics:upperLimit = 0\n"
)
BASE = body("base", (0, 0, 0), mesh("box", (1.0, 0.6, 0.8)))
DOOR = body("door", (0, -0.31, 0), mesh("panel", (1.0, 0.02, 0.8)))
CABINET = BASE + DOOR + joint("hinge", "Revolute", "/obj/base", "/obj/door", HINGE)


def write(folder: Path, text: str, name: str = "asset.usda") -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path
