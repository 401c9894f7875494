"""Asset -> Manifest."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from ..articulation import Joint, Part, Weights
from ..asset import Hull, InnerSurface, Target
from ..intake.intake import Provenance
from ..manufacture.targets.standing import standing_place
from ..mesh import FloatArray
from ..runtime.keys import installed_version
from ..runtime.layout import MJCF, URDF
from ..runtime.numbers import magnitude, rounded
from .links import Layout
from .manifest import (
    SCHEMA,
    Manifest,
    ManifestHandle,
    ManifestJoint,
    ManifestLink,
    ManifestPlacement,
    ManifestProposal,
    ManifestProvenance,
    ManifestSurface,
    ManifestTarget,
    Row,
)
from .resistance import Resistance

#: Everything whose version can change an exported number.
TOOLS = ("asset-factory", "coacd", "manifold3d", "numpy", "pillow", "scipy", "trimesh")


def manifest_of(layout: Layout, provenance: Provenance) -> Manifest:
    """Return what ``asset.json`` says of an asset that was laid out in a folder."""
    asset = layout.asset
    articulation = asset.articulation
    rest = _bounds(layout, {})
    closed = _bounds(layout, {joint.name: joint.lower for joint in articulation.joints})
    return Manifest(
        schema=SCHEMA,
        name=asset.name,
        category=provenance.category,
        license=provenance.license,
        urdf=URDF,
        mjcf=MJCF,
        articulator=articulation.articulator,
        scale=1.0,
        fixed_base=True,
        mass=magnitude(sum(body.inertial.mass for body in asset.bodies)),
        bounds=tuple(_row(corner) for corner in rest),
        closed_bounds=tuple(_row(corner) for corner in closed),
        ground_offset=rounded(-min(rest[0, 2], closed[0, 2])),
        hulls=asset.hull_count,
        joints=tuple(
            _joint(layout, joint, resistance)
            for joint, resistance in zip(articulation.joints, layout.resistances, strict=True)
        ),
        links=tuple(_link(layout, part) for part in range(len(layout.links))),
        targets=tuple(_target(layout, target) for target in asset.targets),
        excluded_pairs=layout.excluded_pairs,
        provenance=_provenance(provenance, articulation.weights),
        tools=tool_versions(),
        notes=(*provenance.notes, *articulation.notes, *layout.notes),
        invented=tuple(_surface(surface) for surface in asset.invented),
        proposers=tuple(sorted({p.source.proposer for p in articulation.parts if p.source})),
    )


def _provenance(provenance: Provenance, weights: tuple[Weights, ...]) -> ManifestProvenance:
    """Return where an asset came from, without what the manifest says itself."""
    told = {**vars(provenance), "scale": magnitude(provenance.scale), "weights": weights}
    names = (each.name for each in fields(ManifestProvenance))
    return ManifestProvenance(**{name: told[name] for name in names})


def tool_versions() -> dict[str, str | None]:
    """Return the versions of the libraries that make assets; ``None``: not installed."""
    found = ((tool, installed_version(tool)) for tool in TOOLS)
    return {tool: None if version == "absent" else version for tool, version in found}


def hull_aspect(hull: Hull) -> float:
    """Return longest over shortest side of a hull's principal box, which GPU PhysX limits."""
    centered = hull.vertices - hull.vertices.mean(axis=0)
    _, _, axes = np.linalg.svd(centered, full_matrices=False)
    sides = np.ptp(centered @ axes.T, axis=0)
    return float(sides.max() / max(float(sides.min()), 1e-12))


def _surface(surface: InnerSurface) -> ManifestSurface:
    lengths = (surface.thickness_m, surface.depth_m)
    told = (None if length is None else rounded(length) for length in lengths)
    return ManifestSurface(surface.part, surface.kind, surface.rule, *told)


def _joint(layout: Layout, joint: Joint, resistance: Resistance) -> ManifestJoint:
    return ManifestJoint(
        name=joint.name,
        kind=joint.kind,
        parent=layout.links[joint.parent].name,
        child=layout.links[joint.child].name,
        axis=_row(joint.axis),
        origin=_row(joint.origin),
        lower=rounded(joint.lower),
        upper=rounded(joint.upper),
        unit=joint.unit,
        confidence=None if joint.confidence is None else rounded(joint.confidence, 4),
        inertia=magnitude(resistance.inertia),
        damping=magnitude(resistance.damping),
        friction=magnitude(resistance.friction),
        default_damping=joint.movable and joint.damping is None,
        default_friction=joint.movable and joint.friction is None,
        handle=_handle(layout, joint),
        placement=_placement(layout, joint),
        mimic=joint.mimic,
    )


def _handle(layout: Layout, joint: Joint) -> ManifestHandle | None:
    handle = layout.asset.bodies[joint.child].handle
    if handle is None:
        return None
    origin = layout.asset.articulation.link_frame(joint.child)
    return ManifestHandle(
        frame=layout.links[joint.child].name,
        point=_row(handle.point - origin),
        normal=_row(handle.normal),
        pull=_row(handle.pull),
        source=handle.source,
    )


def _target(layout: Layout, target: Target) -> ManifestTarget:
    origin = layout.asset.articulation.link_frame(target.part)
    return ManifestTarget(
        joint=target.joint,
        part=layout.links[target.part].name,
        kind=target.kind,
        point=_row(target.point - origin),
        normal=_row(target.normal),
        pull=_row(target.pull),
        fingers=_row(target.fingers),
        opening_m=rounded(target.opening),
        score=rounded(target.score, 4),
    )


def _placement(layout: Layout, joint: Joint) -> ManifestPlacement | None:
    """Return where a robot's base may stand to open the joint at its best target."""
    target = next((each for each in layout.asset.targets if each.joint == joint.name), None)
    place = None if target is None else standing_place(layout.asset, joint, target)
    if place is None:
        return None
    return ManifestPlacement(tuple(rounded(value) for value in place.position), rounded(place.yaw))


def _link(layout: Layout, part: int) -> ManifestLink:
    body = layout.asset.bodies[part]
    files = layout.links[part]
    made = layout.asset.articulation.parts[part]
    confidence = made.confidence
    return ManifestLink(
        name=files.name,
        confidence=None if confidence is None else rounded(confidence, 4),
        mass=magnitude(body.inertial.mass),
        hulls=len(body.hulls),
        max_hull_vertices=max((len(hull.vertices) for hull in body.hulls), default=0),
        max_hull_aspect=rounded(max((hull_aspect(hull) for hull in body.hulls), default=0.0), 3),
        visuals=len(files.visuals),
        decomposition=body.decomposition,
        degraded=body.degraded,
        proposal=_proposal(made),
    )


def _proposal(part: Part) -> ManifestProposal | None:
    """Return why a part moves; ``None`` if nobody proposed it."""
    source = part.source
    if source is None:
        return None
    return ManifestProposal(
        id=source.id,
        proposer=source.proposer,
        kind=part.kind,
        probability=None if source.probability is None else rounded(source.probability, 4),
        signs={name: rounded(value, 4) for name, value in sorted(source.signs.items())},
    )


def _bounds(layout: Layout, values: dict[str, float]) -> FloatArray:
    """Lower and upper corner of everything visible for given joint values, shape [2, 3]."""
    articulation = layout.asset.articulation
    poses = articulation.poses(values)
    corners = []
    for part, pose in zip(articulation.parts, poses, strict=True):
        vertices = articulation.mesh.vertices[np.unique(articulation.mesh.faces[part.faces])]
        corners.append(vertices @ pose[:3, :3].T + pose[:3, 3])
    cloud = np.concatenate(corners)
    cloud = cloud if len(cloud) else np.zeros((1, 3))
    return np.stack([cloud.min(axis=0), cloud.max(axis=0)])


def _row(values: FloatArray) -> Row:
    return tuple(rounded(value) for value in values.tolist())
