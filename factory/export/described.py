"""Asset -> Manifest."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np

from ..articulation import Joint, Part, Weights
from ..asset import Handle, Hull, InnerSurface, PartBody, StandingPlace, Target
from ..intake.intake import Provenance
from ..manufacture.targets.standing import standing_place
from ..mesh import FloatArray
from ..runtime.keys import installed_version
from ..runtime.layout import MJCF, URDF
from ..runtime.numbers import DECIMALS, magnitude, rounded
from .links import Layout, LinkLayout
from .manifest import (
    SCHEMA,
    Manifest,
    ManifestHandle,
    ManifestJoint,
    ManifestLink,
    ManifestProposal,
    ManifestProvenance,
    ManifestTarget,
    Row,
)

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
            _joint(layout, link, link.joint) for link in layout.links if link.joint is not None
        ),
        links=tuple(map(_link, layout.links, articulation.parts, asset.bodies)),
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


def _surface(surface: InnerSurface) -> InnerSurface:
    """Return a surface as it is written."""
    thickness = _rounded(surface.thickness_m)
    return replace(surface, thickness_m=thickness, depth_m=_rounded(surface.depth_m))


def _rounded(value: float | None, decimals: int = DECIMALS) -> float | None:
    return None if value is None else rounded(value, decimals)


def _joint(layout: Layout, link: LinkLayout, joint: Joint) -> ManifestJoint:
    return ManifestJoint(
        name=joint.name,
        kind=joint.kind,
        parent=layout.links[joint.parent].name,
        child=link.name,
        axis=_row(joint.axis),
        origin=_row(joint.origin),
        lower=rounded(joint.lower),
        upper=rounded(joint.upper),
        unit=joint.unit,
        confidence=_rounded(joint.confidence, 4),
        inertia=magnitude(link.resistance.inertia),
        damping=magnitude(link.resistance.damping),
        friction=magnitude(link.resistance.friction),
        default_damping=joint.movable and joint.damping is None,
        default_friction=joint.movable and joint.friction is None,
        handle=_handle(link, layout.asset.bodies[joint.child].handle),
        placement=_placement(layout, joint),
        mimic=joint.mimic,
    )


def _handle(link: LinkLayout, handle: Handle | None) -> ManifestHandle | None:
    if handle is None:
        return None
    return ManifestHandle(
        frame=link.name,
        point=_row(handle.point - link.origin),
        normal=_row(handle.normal),
        pull=_row(handle.pull),
        source=handle.source,
    )


def _target(layout: Layout, target: Target) -> ManifestTarget:
    link = layout.links[target.part]
    return ManifestTarget(
        joint=target.joint,
        part=link.name,
        kind=target.kind,
        point=_row(target.point - link.origin),
        normal=_row(target.normal),
        pull=_row(target.pull),
        fingers=_row(target.fingers),
        opening_m=rounded(target.opening),
        score=rounded(target.score, 4),
    )


def _placement(layout: Layout, joint: Joint) -> StandingPlace | None:
    """Return where a robot's base may stand to open the joint at its best target."""
    target = next((each for each in layout.asset.targets if each.joint == joint.name), None)
    place = None if target is None else standing_place(layout.asset, joint, target)
    if place is None:
        return None
    x, y = place.position
    return StandingPlace((rounded(x), rounded(y)), rounded(place.yaw))


def _link(link: LinkLayout, part: Part, body: PartBody) -> ManifestLink:
    return ManifestLink(
        name=link.name,
        confidence=_rounded(part.confidence, 4),
        mass=magnitude(body.inertial.mass),
        hulls=len(body.hulls),
        max_hull_vertices=max((len(hull.vertices) for hull in body.hulls), default=0),
        max_hull_aspect=rounded(max((hull_aspect(hull) for hull in body.hulls), default=0.0), 3),
        visuals=len(link.visuals),
        decomposition=body.decomposition,
        degraded=body.degraded,
        proposal=_proposal(part),
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
        probability=_rounded(source.probability, 4),
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
