"""Small assets made of boxes, for the export tests."""

import io
from collections.abc import Sequence

import numpy as np
import trimesh
from PIL import Image
from plain_solids import parted

from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.asset import Asset, Handle, Hull, Inertial, PartBody
from asset_factory.factory.intake.intake import Provenance
from asset_factory.factory.mesh import Material, Mesh, Texture, concatenate

KINDS = (JointKind.REVOLUTE, JointKind.CONTINUOUS, JointKind.PRISMATIC, JointKind.FIXED)
PROVENANCE = Provenance(input="cabinet.glb", digest="0" * 64, category="cabinet", license="CC0-1.0")


def image(color: tuple[int, int, int], file_format: str = "PNG") -> Texture:
    buffer = io.BytesIO()
    Image.new("RGB", (4, 4), color).save(buffer, format=file_format)
    return Texture(buffer.getvalue(), ".png" if file_format == "PNG" else ".jpg")


def box(center: Sequence[float], size: Sequence[float], material: Material | None = None) -> Mesh:
    shape = trimesh.creation.box(extents=size)
    mesh = Mesh.from_triangles(shape.vertices + np.asarray(center), shape.faces, material)
    corners = mesh.vertices[mesh.faces]
    uv = (corners[..., :2] - corners[..., :2].min()) if material and material.texture else None
    return Mesh(mesh.vertices, mesh.faces, uv, None, mesh.face_material, mesh.materials)


def hull_of(mesh: Mesh) -> Hull:
    return Hull(mesh.vertices, mesh.faces)


def inertial_of(mesh: Mesh, mass: float = 2.0) -> Inertial:
    size = mesh.extents
    tensor = np.diag(mass / 12.0 * ((size**2).sum() - size**2))
    return Inertial(mass, mesh.bounds.mean(axis=0), tensor)


def boxes_asset(
    meshes: list[Mesh],
    joints: tuple[Joint, ...],
    handles: dict[int, Handle] | None = None,
    name: str = "boxes",
) -> Asset:
    """One part ``part_<i>`` per mesh; a mesh without faces makes a carrier."""
    articulation = parted({f"part_{i}": [mesh] for i, mesh in enumerate(meshes)}, *joints)
    bodies = tuple(
        PartBody((hull_of(m),), inertial_of(m), (handles or {}).get(i), "exact")
        if len(m.faces)
        else PartBody((), Inertial(0.01, np.zeros(3), np.eye(3) * 1e-5))
        for i, m in enumerate(meshes)
    )
    return Asset(name, articulation, bodies)


def cabinet(looks: Sequence[Material] = (Material("red", (0.8, 0.1, 0.1, 1.0)),) * 3) -> Asset:
    """A block with a hinged door in front of it and a drawer above the door, 2 mm apart."""
    body = box([0.0, 0.0, 0.4], [0.6, 0.4, 0.8], looks[0])
    door = box([0.0, -0.212, 0.25], [0.56, 0.02, 0.46], looks[1])
    knob = box([0.22, -0.237, 0.25], [0.02, 0.03, 0.10], looks[1])
    drawer = box([0.0, -0.212, 0.65], [0.56, 0.02, 0.26], looks[2])
    turn = Joint("hinge", JointKind.REVOLUTE, 0, 1, [0, 0, -1], [-0.28, -0.212, 0.25], 0.0, 1.6)
    slide = Joint("slide", JointKind.PRISMATIC, 0, 2, [0, -1, 0], [0.0, -0.212, 0.65], 0.0, 0.3)
    front = np.array([0.0, -1.0, 0.0])
    handles = {
        1: Handle([0.22, -0.252, 0.25], front, front, np.arange(24, 36), "protrusion"),
        2: Handle([0.0, -0.222, 0.65], front, front),
    }
    asset = boxes_asset([body, concatenate([door, knob]), drawer], (turn, slide), handles)
    bodies = list(asset.bodies)
    bodies[1] = PartBody((hull_of(door), hull_of(knob)), inertial_of(door), handles[1], "exact")
    return Asset("cabinet", asset.articulation, tuple(bodies))


def tree_of_boxes(seed: int) -> Asset:
    """A random tree of one to six boxes behind joints of any kind and any axis."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 7))
    meshes = [box(rng.uniform(-1, 1, 3), rng.uniform(0.05, 0.5, 3)) for _ in range(count + 1)]
    joints = []
    for child in range(1, count + 1):
        parent = int(rng.integers(0, child))
        kind = KINDS[int(rng.integers(0, len(KINDS)))]
        axis = rng.normal(size=3)
        limits = (-rng.uniform(0, 1), rng.uniform(0.1, 2))
        if kind is JointKind.FIXED:
            limits = (0.0, 0.0)
        elif kind is JointKind.CONTINUOUS:
            limits = (-np.pi, np.pi)
        origin = rng.uniform(-1, 1, 3)
        line = axis / np.linalg.norm(axis)
        joints.append(Joint(f"j{child}", kind, parent, child, line, origin, *limits))
    return boxes_asset(meshes, tuple(joints))


def frames(articulation: Articulation, values: dict[str, float]) -> dict[str, np.ndarray]:
    """Poses of the links in the world, as the articulation says."""
    poses = articulation.poses(values)
    found = {}
    for index, part in enumerate(articulation.parts):
        rest = np.eye(4)
        rest[:3, 3] = articulation.link_frame(index)
        found[part.name] = poses[index] @ rest
    return found
