"""Asset -> USD with UsdPhysics: bodies, joints, colliders, masses, limits, dampers, looks.

Links lie side by side below the default prim, as Isaac Sim and Newton expect them, each with its
frame of the URDF; ``visuals`` are for eyes, ``collisions`` of purpose ``guide`` for contact. A
fixed joint holds the first link to the world. UsdPhysics measures angles in degrees. It has no word
for friction and armature of joints: Newton's attributes say them, other readers pass over them. A
joint that follows another says so to Newton and MuJoCo, and to PhysX, which couples hinges only.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from pxr import Gf, Kind, Sdf, Tf, Usd, UsdGeom, UsdPhysics, UsdShade, Vt  # noqa: TID253
from scipy.spatial.transform import Rotation

from ..articulation import Joint, JointKind
from ..asset import Hull, Inertial
from ..mesh import FloatArray, IntArray
from .links import Layout, LinkLayout
from .meshes import filled_normals
from .visuals import VisualPiece

X_AXIS = np.array([1.0, 0.0, 0.0])
ROUGHNESS = 0.7


def write_usd(layout: Layout, file: Path) -> None:
    """Write the whole asset as one binary layer; textures stay beside it in the bundle.

    This module is only imported to write USD.
    """
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdPhysics.SetStageKilogramsPerUnit(stage, 1.0)
    name = Tf.MakeValidIdentifier(layout.asset.name)
    root = UsdGeom.Xform.Define(stage, f"/{name}").GetPrim()
    stage.SetDefaultPrim(root)
    Usd.ModelAPI(root).SetKind(Kind.Tokens.component)
    UsdPhysics.ArticulationRootAPI.Apply(root)
    looks = _Looks(stage, f"/{name}/looks")
    paths = (f"/{name}/{Tf.MakeValidIdentifier(files.name)}" for files in layout.links)
    links = [
        _link(stage, path, link, body.hulls, looks)
        for path, link, body in zip(paths, layout.links, layout.asset.bodies, strict=True)
    ]
    _filter(layout, links)
    UsdGeom.Scope.Define(stage, f"/{name}/joints")
    held = UsdPhysics.FixedJoint.Define(stage, f"/{name}/joints/world_joint")
    held.CreateBody1Rel().SetTargets([links[0].GetPath()])
    for link in layout.links:
        if link.joint is not None:
            path = f"/{name}/joints/{Tf.MakeValidIdentifier(link.joint.name)}"
            _joint(stage, path, layout, link, link.joint, links)
    stage.GetRootLayer().Export(str(file))


def _link(
    stage: Usd.Stage, path: str, link: LinkLayout, hulls: tuple[Hull, ...], looks: _Looks
) -> Usd.Prim:
    origin = link.origin
    form = UsdGeom.Xform.Define(stage, path)
    form.AddTranslateOp().Set(Gf.Vec3d(*origin.tolist()))
    prim = form.GetPrim()
    UsdPhysics.RigidBodyAPI.Apply(prim)
    _mass(prim, link.inertial)
    UsdGeom.Scope.Define(stage, f"{path}/visuals")
    for piece in link.visuals:
        _visual(stage, f"{path}/visuals/{piece.name}", piece, origin, looks)
    UsdGeom.Scope.Define(stage, f"{path}/collisions")
    for file, hull in zip(link.collisions, hulls, strict=True):
        mesh = _mesh(stage, f"{path}/collisions/{file.stem}", hull.vertices - origin, hull.faces)
        mesh.CreatePurposeAttr(UsdGeom.Tokens.guide)
        UsdPhysics.CollisionAPI.Apply(mesh.GetPrim())
        api = UsdPhysics.MeshCollisionAPI.Apply(mesh.GetPrim())
        api.CreateApproximationAttr(UsdPhysics.Tokens.convexHull)
    return prim


def _mass(prim: Usd.Prim, inertial: Inertial) -> None:
    moments, axes = np.linalg.eigh(inertial.tensor)
    # Eigenvectors come with any sign; as written they turn right-handed, and least.
    axes = axes * np.where(axes[np.abs(axes).argmax(axis=0), range(3)] < 0.0, -1.0, 1.0)
    if np.linalg.det(axes) < 0.0:
        axes[:, 2] *= -1.0
    api = UsdPhysics.MassAPI.Apply(prim)
    api.CreateMassAttr(inertial.mass)
    api.CreateCenterOfMassAttr(Gf.Vec3f(*inertial.center.tolist()))
    api.CreateDiagonalInertiaAttr(Gf.Vec3f(*moments.tolist()))
    api.CreatePrincipalAxesAttr(_quaternion(Rotation.from_matrix(axes)))


def _visual(
    stage: Usd.Stage, path: str, piece: VisualPiece, origin: FloatArray, looks: _Looks
) -> None:
    shape = replace(piece.mesh, vertices=piece.mesh.vertices - origin)
    mesh = _mesh(stage, path, shape.vertices, shape.faces)
    # Panels without thickness are seen from behind, too.
    mesh.CreateDoubleSidedAttr(True)
    primvars = UsdGeom.PrimvarsAPI(mesh)
    normals = filled_normals(shape).reshape(-1, 3).astype(np.float32)
    mesh.CreateNormalsAttr(Vt.Vec3fArray.FromNumpy(normals))
    mesh.SetNormalsInterpolation(UsdGeom.Tokens.faceVarying)
    if shape.corner_uv is not None:
        uv = np.nan_to_num(shape.corner_uv.reshape(-1, 2)).astype(np.float32)
        kind = Sdf.ValueTypeNames.TexCoord2fArray
        coordinates = primvars.CreatePrimvar("st", kind, UsdGeom.Tokens.faceVarying)
        coordinates.Set(Vt.Vec2fArray.FromNumpy(uv))
    api = UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim())
    api.Bind(looks.material(piece))


def _mesh(stage: Usd.Stage, path: str, vertices: FloatArray, faces: IntArray) -> Any:
    points = vertices.astype(np.float32)
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points))
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(faces), 3, dtype=np.int32)))
    indices = np.ascontiguousarray(faces.reshape(-1), dtype=np.int32)
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(indices))
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    extent = np.stack([points.min(axis=0), points.max(axis=0)])
    mesh.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(extent))
    return mesh


def _filter(layout: Layout, links: list[Usd.Prim]) -> None:
    """Tell engines which links overlap on purpose."""
    of_name = {files.name: prim for files, prim in zip(layout.links, links, strict=True)}
    for first, second in layout.excluded_pairs:
        api = UsdPhysics.FilteredPairsAPI.Apply(of_name[first])
        api.CreateFilteredPairsRel().AddTarget(of_name[second].GetPath())


def _joint(
    stage: Usd.Stage,
    path: str,
    layout: Layout,
    link: LinkLayout,
    joint: Joint,
    links: list[Usd.Prim],
) -> None:
    """Write a joint along or about the x axis of its own frame; value 0 is the rest pose."""
    if not joint.movable:
        made = UsdPhysics.FixedJoint.Define(stage, path)
    elif joint.turns:
        made = UsdPhysics.RevoluteJoint.Define(stage, path)
    else:
        made = UsdPhysics.PrismaticJoint.Define(stage, path)
    made.CreateBody0Rel().SetTargets([links[joint.parent].GetPath()])
    made.CreateBody1Rel().SetTargets([links[joint.child].GetPath()])
    made.CreateLocalPos0Attr(Gf.Vec3f(*link.offset.tolist()))
    made.CreateLocalPos1Attr(Gf.Vec3f(0.0))
    if not joint.movable:
        return
    turned = _quaternion(_x_to(joint.axis))
    made.CreateLocalRot0Attr(turned)
    made.CreateLocalRot1Attr(turned)
    made.CreateAxisAttr("X")
    per_unit = _per_unit(joint)
    if joint.kind is not JointKind.CONTINUOUS:
        made.CreateLowerLimitAttr(joint.lower * per_unit)
        made.CreateUpperLimitAttr(joint.upper * per_unit)
    drive = UsdPhysics.DriveAPI.Apply(made.GetPrim(), "angular" if joint.turns else "linear")
    drive.CreateTypeAttr("force")
    drive.CreateStiffnessAttr(0.0)
    drive.CreateDampingAttr(link.resistance.damping / per_unit)
    for name in ("friction", "armature"):
        attribute = made.GetPrim().CreateAttribute(f"newton:{name}", Sdf.ValueTypeNames.Float)
        attribute.Set(getattr(link.resistance, name))
    if joint.mimic is not None:
        leader = layout.asset.articulation.joint(joint.mimic.leader)
        ratio = joint.mimic.multiplier * per_unit / _per_unit(leader)
        _couple(made.GetPrim(), leader.name, ratio)


def _per_unit(joint: Joint) -> float:
    """Return the file's units, degrees or metres, in one of the joint's."""
    return 180.0 / np.pi if joint.turns else 1.0


def _couple(prim: Usd.Prim, leader: str, ratio: float) -> None:
    """Have a joint follow another of the same scope, in the file's units.

    Newton: ``joint = coef0 + coef1 leader``; PhysX: ``joint + gearing leader + offset = 0``.
    """
    target = prim.GetPath().GetParentPath().AppendChild(Tf.MakeValidIdentifier(leader))
    words = (
        ("NewtonMimicAPI", "newton", "mimicJoint", "mimicCoef1", ratio),
        ("PhysxMimicJointAPI:rotX", "physxMimicJoint:rotX", "referenceJoint", "gearing", -ratio),
    )
    for schema, space, relation, attribute, value in words:
        prim.AddAppliedSchema(schema)
        prim.CreateRelationship(f"{space}:{relation}", custom=False).SetTargets([target])
        kind = Sdf.ValueTypeNames.Float
        prim.CreateAttribute(f"{space}:{attribute}", kind, custom=False).Set(value)


def _x_to(axis: FloatArray) -> Rotation:
    """Return the shortest rotation that turns the x axis to ``axis``."""
    across = np.cross(X_AXIS, axis)
    sine = float(np.linalg.norm(across))
    if sine < 1e-9:
        return Rotation.from_rotvec([0.0, 0.0, 0.0 if axis[0] > 0.0 else np.pi])
    return Rotation.from_rotvec(across / sine * np.arctan2(sine, float(axis[0])))


def _quaternion(rotation: Rotation) -> Any:
    x, y, z, w = (float(value) for value in rotation.as_quat())
    return Gf.Quatf(w, x, y, z)


class _Looks:
    """Materials of a stage, each written once."""

    def __init__(self, stage: Usd.Stage, path: str) -> None:
        self._stage = stage
        self._path = path
        self._made: dict[tuple[object, str | None], UsdShade.Material] = {}

    def material(self, piece: VisualPiece) -> UsdShade.Material:
        """Return how a piece looks."""
        texture = None if piece.texture is None else piece.texture.as_posix()
        key = (piece.material.color, texture)
        if key not in self._made:
            self._made[key] = self._write(piece.material.color, texture)
        return self._made[key]

    def _write(
        self, color: tuple[float, float, float, float], texture: str | None
    ) -> UsdShade.Material:
        UsdGeom.Scope.Define(self._stage, self._path)
        path = f"{self._path}/material_{len(self._made)}"
        material = UsdShade.Material.Define(self._stage, path)
        shader = UsdShade.Shader.Define(self._stage, f"{path}/surface")
        shader.CreateIdAttr("UsdPreviewSurface")
        shader.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(ROUGHNESS)
        shader.CreateInput("opacity", Sdf.ValueTypeNames.Float).Set(color[3])
        diffuse = shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f)
        if texture is None:
            diffuse.Set(Gf.Vec3f(*color[:3]))
        else:
            diffuse.ConnectToSource(self._texture(path, texture, color))
        surface = shader.CreateOutput("surface", Sdf.ValueTypeNames.Token)
        material.CreateSurfaceOutput().ConnectToSource(surface)
        return material

    def _texture(
        self, path: str, texture: str, color: tuple[float, float, float, float]
    ) -> UsdShade.Output:
        place = UsdShade.Shader.Define(self._stage, f"{path}/place")
        place.CreateIdAttr("UsdPrimvarReader_float2")
        place.CreateInput("varname", Sdf.ValueTypeNames.String).Set("st")
        image = UsdShade.Shader.Define(self._stage, f"{path}/image")
        image.CreateIdAttr("UsdUVTexture")
        image.CreateInput("file", Sdf.ValueTypeNames.Asset).Set(Sdf.AssetPath(f"./{texture}"))
        image.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set("sRGB")
        image.CreateInput("scale", Sdf.ValueTypeNames.Float4).Set(Gf.Vec4f(*color))
        for wrap in ("wrapS", "wrapT"):
            image.CreateInput(wrap, Sdf.ValueTypeNames.Token).Set("repeat")
        uv = place.CreateOutput("result", Sdf.ValueTypeNames.Float2)
        image.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(uv)
        return image.CreateOutput("rgb", Sdf.ValueTypeNames.Float3)
