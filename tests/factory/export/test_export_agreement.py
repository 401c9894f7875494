"""URDF, MJCF and SDF say what the asset is, to whoever reads them and knows nothing of it."""

from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from export_samples import PROVENANCE, box, boxes_asset

from asset_factory.factory.articulation import Joint, JointKind, rotation_about
from asset_factory.factory.asset import Inertial
from asset_factory.factory.export import export_bundle
from asset_factory.factory.export.resistance import joint_resistances
from asset_factory.sim_checks.read.read import read_here


def lopsided_asset():
    """A body, a door that also turns inwards, a drawer in the door; no inertia along the axes."""
    centers = ([0.0, 0.0, 0.4], [0.1, -0.25, 0.4], [0.2, -0.35, 0.5])
    meshes = [box(center, [0.6, 0.1 + 0.1 * i, 0.3]) for i, center in enumerate(centers)]
    hinge = Joint("hinge", JointKind.REVOLUTE, 0, 1, [0, 0, -1], [-0.3, -0.2, 0.1], -0.4, 1.2)
    axis = np.array([0.6, -0.8, 0.0])
    slide = Joint("slide", JointKind.PRISMATIC, 1, 2, axis, [0.2, -0.3, 0.5], -0.05, 0.3)
    asset = boxes_asset(meshes, (hinge, slide))
    turned = rotation_about(np.array([1.0, 2.0, 2.0]) / 3.0, 0.7)
    moments = turned @ np.diag([0.02, 0.03, 0.04]) @ turned.T
    bodies = (
        replace(body, inertial=Inertial(1.5 + part, np.asarray(center) + 0.01, moments))
        for part, (body, center) in enumerate(zip(asset.bodies, centers, strict=True))
    )
    return replace(asset, bodies=tuple(bodies))


@pytest.fixture(scope="module", params=["urdf", "mjcf"])
def said(request, tmp_path_factory):
    """What a file of the exported asset says."""
    bundle = export_bundle(lopsided_asset(), PROVENANCE, tmp_path_factory.mktemp("bundle"))
    return read_here(getattr(bundle, request.param))


def test_every_link_has_its_mass_its_center_the_whole_tensor_and_its_hull(said):
    asset = lopsided_asset()
    links = {link.name: link for link in said.links}
    for part, body in enumerate(asset.bodies):
        frame = asset.articulation.link_frame(part)
        inertia = links[f"part_{part}"].inertia
        assert inertia.mass == pytest.approx(body.inertial.mass)
        assert inertia.center == pytest.approx(body.inertial.center - frame)
        assert inertia.tensor == pytest.approx(body.inertial.tensor, abs=1e-7)
        (shape,) = links[f"part_{part}"].collisions
        (hull,) = body.hulls
        there = shape.vertices + frame
        assert there.min(axis=0) == pytest.approx(hull.vertices.min(axis=0), abs=1e-6)
        assert there.max(axis=0) == pytest.approx(hull.vertices.max(axis=0), abs=1e-6)


def test_every_joint_has_its_axis_both_limits_and_what_resists_it(said):
    asset = lopsided_asset()
    lines = {line.name: line for line in said.joints}
    for joint, resistance in zip(asset.articulation.joints, joint_resistances(asset), strict=True):
        line = lines[joint.name]
        assert line.kind == joint.kind
        assert line.axis == pytest.approx(joint.axis)
        assert (line.lower, line.upper) == pytest.approx((joint.lower, joint.upper))
        assert resistance.friction > 0.0
        assert line.friction == pytest.approx(resistance.friction)
        assert line.damping == pytest.approx(resistance.damping)


def test_sdf_has_the_same_joints_and_tensors(tmp_path):
    asset = lopsided_asset()
    export_bundle(asset, PROVENANCE, tmp_path, formats=("sdf",))
    model = ElementTree.parse(tmp_path / "asset.sdf").getroot().find("model")
    resistances = joint_resistances(asset)
    for joint, resistance in zip(asset.articulation.joints, resistances, strict=True):
        axis = model.find(f"joint[@name='{joint.name}']/axis")
        said = {each.tag: each.text for each in axis.iter()}
        assert [float(number) for number in said["xyz"].split()] == pytest.approx(joint.axis)
        limits = (float(said["lower"]), float(said["upper"]))
        assert limits == pytest.approx((joint.lower, joint.upper))
        assert float(said["friction"]) == pytest.approx(resistance.friction)
        assert float(said["damping"]) == pytest.approx(resistance.damping)
    for part, body in enumerate(asset.bodies):
        tensor = body.inertial.tensor
        for row, column in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)):
            name = f"i{'xyz'[row]}{'xyz'[column]}"
            cell = model.find(f"link[@name='part_{part}']/inertial/inertia/{name}")
            assert float(cell.text) == pytest.approx(tensor[row, column], abs=1e-7)
