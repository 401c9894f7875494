"""What a fuzzer feeds to the readers: small sound inputs of every kind, as folders in memory."""

import importlib.util
import io
import json
import os
import struct
import tempfile
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import usda
from mesh_cube import WRITERS, gltf_parts, pack_glb, png, write_obj, write_stl

#: Stands in a file for the folder outside, which nobody may look into.
OUTSIDE = b"@OUTSIDE@"

URDF = """<robot name="box">
  <material name="wood"><color rgba="0.5 0.3 0.1 1"/><texture filename="wood.png"/></material>
  <link name="body"><visual><origin xyz="0 0 0.1" rpy="0 0 0"/>
    <geometry><mesh filename="cube.obj" scale="1 1 1"/></geometry><material name="wood"/></visual>
    <collision><geometry><box size="1 1 1"/></geometry></collision><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="door"><visual><geometry><mesh filename="package://box/cube.stl"/></geometry></visual></link>
  <link name="knob"><visual>
    <geometry><cylinder radius="0.1" length="0.2"/></geometry></visual></link>
  <joint name="hinge" type="revolute"><parent link="body"/><child link="door"/>
    <origin xyz="1 0 0" rpy="0 0 1"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="1.5" effort="1" velocity="1"/><dynamics damping="1" friction="1"/>
    </joint>
  <joint name="turn" type="prismatic"><parent link="door"/><child link="knob"/><axis xyz="1 0 0"/>
    <limit lower="-0.5" upper="0.5" effort="1" velocity="1"/>
    <mimic joint="hinge" multiplier="1" offset="0"/></joint>
</robot>
"""
MJCF = """<mujoco model="box"><compiler angle="radian"/><include file="assets.xml"/>
  <worldbody><body name="body"><geom type="mesh" mesh="cube" material="wood"/>
    <body name="door" pos="1 0 0">
      <joint name="hinge" type="hinge" axis="0 0 1" range="0 1.5" damping="1"/>
      <geom type="box" size="0.1 0.5 0.5" rgba="1 0 0 1"/>
      <body name="knob"><joint name="turn" type="slide" axis="1 0 0" range="0 0.5"/>
      <geom size="0.1"/></body>
    </body></body></worldbody></mujoco>
"""
ASSETS = """<mujocoinclude><asset><mesh name="cube" file="cube.stl" scale="1 1 1"/>
  <texture name="wood" type="2d" file="wood.png"/>
  <material name="wood" texture="wood" texrepeat="1 1"/>
</asset></mujocoinclude>"""
#: A triangle that shows a picture of that name.
DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/></asset>
<library_images><image id="i"><init_from>{}</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON>
<newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam>
<technique sid="c"><lambert><diffuse><texture texture="t" texcoord="UV"/></diffuse></lambert>
</technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>
</source><source id="u"><float_array id="b" count="6">0 0 1 0 0 1</float_array>
<technique_common><accessor source="#b" count="3" stride="2"><param name="S" type="float"/>
<param name="T" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="x"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="TEXCOORD" source="#u" offset="0" set="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node><instance_geometry url="#g"><bind_material>
<technique_common><instance_material symbol="x" target="#m"><bind_vertex_input semantic="UV"
input_semantic="TEXCOORD" input_set="0"/></instance_material></technique_common>
</bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>"""
SIDECAR = b'category = "fridge"\nup = "y"\nheight = 1.7\ndensity = 600.0\nlicense = "CC-BY-4.0"\n'


class Bomb:
    """What must not be unpickled: it would leave a file in the folder outside."""

    def __reduce__(self) -> tuple[Any, ...]:
        return os.system, ("touch @OUTSIDE@/executed || touch ../outside/executed",)


def locked(data: bytes) -> bytes:
    """Every member marked as encrypted."""
    locked = bytearray(data)
    for mark, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        at = locked.find(mark)
        while at >= 0:
            locked[at + offset] |= 1
            at = locked.find(mark, at + 4)
    return bytes(locked)


#: Opcodes that make a pair of what lies on top, twice: remember it, recall it, pair.
SHARED = b"q\0h\0\x86"


@dataclass(frozen=True)
class Case:
    """One folder to read from.

    Attributes:
        name: unique among all cases.
        kind: of the file that is wrong, e.g. ``glb``.
        verb: who reads it: ``load``, ``check`` or ``weights``.
        entry: the file that is named to the reader.
        files: path in the folder -> content; ``@OUTSIDE@`` stands for the folder outside.
        links: path in the folder -> where a symbolic link there leads.
        target: the file that mutations are for.
        least: the reading must end with this verdict, if it is given.
    """

    name: str
    kind: str
    verb: str
    entry: str
    files: Mapping[str, bytes]
    links: Mapping[str, str] = field(default_factory=dict)
    target: str = ""
    least: str | None = None


def _written(write: Callable[[Path], Path]) -> tuple[str, dict[str, bytes]]:
    with tempfile.TemporaryDirectory() as folder:
        entry = write(Path(folder)).name
        return entry, {path.name: path.read_bytes() for path in sorted(Path(folder).iterdir())}


def cube_files() -> dict[str, bytes]:
    """The meshes and pictures that the descriptions below refer to."""
    return {**_written(write_obj)[1], **_written(write_stl)[1]}


def prediction(**changes: object) -> dict[str, np.ndarray]:
    """A ``pred.npz`` of the cube: two parts, one of which turns."""
    fields = {
        "face_part_ids": np.repeat([0, 1], 6),
        "motion_hierarchy": np.array([[0, 1]]),
        "is_part_revolute": np.array([False, True]),
        "is_part_prismatic": np.array([False, False]),
        "revolute_plucker": np.array([[0, 0, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0]], dtype=float),
        "revolute_range": np.array([[0, 0], [0, 1.5]]),
        "prismatic_axis": np.array([[0, 0, 0], [1.0, 0, 0]]),
        "prismatic_range": np.array([[0, 0], [0, 0.5]]),
    }
    return fields | {name: np.asarray(value) for name, value in changes.items()}


def packed(fields: Mapping[str, np.ndarray]) -> bytes:
    """Arrays as an ``.npz``."""
    stream = io.BytesIO()
    np.savez_compressed(stream, **fields)
    return stream.getvalue()


def zipped(members: Mapping[str, bytes], compression: int = zipfile.ZIP_STORED) -> bytes:
    """Members as a zip archive, the same bytes every time."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", compression) as archive:
        for name, data in members.items():
            archive.writestr(zipfile.ZipInfo(name), data, compression)
    return stream.getvalue()


def annotated(npz: bytes) -> dict[str, bytes]:
    """The cube with an annotation beside it."""
    sidecar = SIDECAR + b'annotation = "pred.npz"\n'
    return {"cube.glb": pack_glb(*gltf_parts()), "cube.toml": sidecar, "pred.npz": npz}


def network_shapes() -> dict[str, tuple[int, ...]]:
    """The tensors of a network as small as can be."""
    from asset_factory.factory.models.network.shape import NetworkShape, expected_tensors

    return expected_tensors(NetworkShape(hidden=8, blocks=1, heads=2, features=0))


def safetensors(header: Mapping[str, object] | None = None, data: bytes | None = None) -> bytes:
    """A safetensors file; by default of a whole little network."""
    entries = {"__metadata__": {"terms": "CC0-1.0"}}
    end = 0
    for name, shape in network_shapes().items():
        size = 4 * int(np.prod(shape))
        entries[name] = {"dtype": "F32", "shape": list(shape), "data_offsets": [end, end + size]}
        end += size
    text = json.dumps(entries if header is None else header).encode()
    return struct.pack("<Q", len(text)) + text + (b"\0" * end if data is None else data)


def pickled_number(number: int) -> bytes:
    """A whole number as torch pickles it."""
    data = number.to_bytes(number.bit_length() // 8 + 1, "little", signed=True)
    return b"\x8a" + bytes([len(data)]) + data


def pickled_text(text: str) -> bytes:
    """A text as torch pickles it."""
    return b"X" + struct.pack("<I", len(text.encode())) + text.encode()


def pickled_tensor(key: int, shape: tuple[int, ...]) -> bytes:
    """The opcodes with which torch describes a tensor of floats."""

    def numbers(values: list[int]) -> bytes:
        return b"(" + b"".join(map(pickled_number, values)) + b"t"

    count = int(np.prod(shape))
    strides = [int(np.prod(shape[k + 1 :])) for k in range(len(shape))]
    where = pickled_text(str(key)) + pickled_text("cpu") + pickled_number(count)
    storage = b"(" + pickled_text("storage") + b"ctorch\nFloatStorage\n" + where + b"tQ"
    sizes = numbers(list(shape)) + numbers(strides)
    hooks = b"ccollections\nOrderedDict\n)R"
    return (
        b"ctorch._utils\n_rebuild_tensor_v2\n(" + storage + b"K\0" + sizes + b"\x89" + hooks + b"tR"
    )


def torch_file(description: bytes | None = None, **members: bytes) -> bytes:
    """A file as of ``torch.save``; by default of a whole little network."""
    body = b""
    data = {}
    for key, (name, shape) in enumerate(network_shapes().items()):
        body += pickled_text(name) + pickled_tensor(key, shape) + b"s"
        data[f"archive/data/{key}"] = b"\0" * (4 * int(np.prod(shape)))
    described = b"\x80\x02}" + body + b"." if description is None else description
    extra = {f"archive/{name}": value for name, value in members.items()}
    notes = {"archive/byteorder": b"little", "archive/version": b"3\n"}
    return zipped({"archive/data.pkl": described, **notes, **data, **extra})


@cache
def usd_files() -> dict[str, bytes]:
    """A cabinet with a door in each form of USD, by suffix; none where USD is not installed."""
    if importlib.util.find_spec("pxr") is None:
        return {}
    from pxr import Sdf, UsdUtils

    with tempfile.TemporaryDirectory() as folder:
        text = usda.write(Path(folder), usda.stage(usda.CABINET), "cabinet.usda")
        binary = Path(folder) / "cabinet.usdc"
        package = Path(folder) / "cabinet.usdz"
        Sdf.Layer.FindOrOpen(str(text)).Export(str(binary))
        UsdUtils.CreateNewUsdzPackage(str(binary), str(package))
        return {path.suffix[1:]: path.read_bytes() for path in (text, binary, package)}


@cache
def seeds() -> dict[str, Case]:
    """Sound inputs by kind; reading each ends well."""
    found = {}

    def add(kind: str, verb: str, entry: str, files: Mapping[str, bytes], target: str = "") -> None:
        found[kind] = Case(kind, kind, verb, entry, files, target=target or entry)

    for form, write in WRITERS.items():
        add(form, "load", *_written(write))
    obj = found["obj"]
    add("mtl", "load", obj.entry, obj.files, "cube.mtl")
    add("png", "load", obj.entry, obj.files, "wood.png")
    add("dae", "load", "cube.dae", {"cube.dae": DAE.format("wood.png").encode(), "wood.png": png()})
    add("npz", "load", "cube.glb", annotated(packed(prediction())), "pred.npz")
    add("toml", "load", "cube.glb", annotated(packed(prediction())), "cube.toml")
    meshes = cube_files()
    described = {
        "urdf": ("box.urdf", {"box.urdf": URDF.encode(), **meshes}),
        "mjcf": ("box.xml", {"box.xml": MJCF.encode(), "assets.xml": ASSETS.encode(), **meshes}),
    }
    for kind, data in usd_files().items():
        described[kind] = (f"cabinet.{kind}", {f"cabinet.{kind}": data})
    for kind, described_by in described.items():
        add(kind, "load", *described_by)
        add(f"{kind}_check", "check", *described_by)
    add("safetensors", "weights", "w.safetensors", {"w.safetensors": safetensors()})
    add("pt", "weights", "w.pt", {"w.pt": torch_file()})
    return found
