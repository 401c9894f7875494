"""Fronts that stick in something are built anew, once, and only where they were guessed."""

from dataclasses import replace

import numpy as np
from modelled_furniture import drawer_chest
from test_repair import hard, planned, verdict

from asset_factory.factory.articulate.locate import located
from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part
from asset_factory.factory.geometry.components import connected_components
from asset_factory.factory.manufacture.plan import (
    MANY_FACES,
    Plan,
    Spare,
    dispensable_joints,
    first_plan,
)
from asset_factory.factory.mesh import Mesh
from asset_factory.factory.part import PartSource, Proposer

FRONTS = Spare(fronts=frozenset({"drawer"}))


def drawer(proposer):
    """The upper drawer of a chest, by whoever says so."""
    mesh = drawer_chest()
    own = np.isin(connected_components(mesh), (2, 4))
    source = PartSource("upper", proposer)
    front = Part("drawer", np.flatnonzero(own), source=source)
    parts = (Part("base", np.flatnonzero(~own)), front)
    out = np.array([0.0, -1.0, 0.0])
    joint = Joint("slide", JointKind.PRISMATIC, 0, 1, out, np.zeros(3), upper=0.3)
    return located(Articulation(mesh, parts, (joint,), "auto"))


def test_a_front_that_sticks_is_built_anew_once():
    stuck = verdict(hard("rest_penetration", ("base", "drawer")))
    plan = planned(stuck, spare=FRONTS)
    assert plan.build_fronts
    assert [each.sentence for each in plan.repairs] == ["built fronts and body anew: drawer"]
    assert planned(stuck, plan, FRONTS) is None
    # Nothing is built for other faults, or without fronts.
    assert planned(verdict(hard("no_mass", ("base", "drawer"))), spare=FRONTS) is None
    assert planned(stuck) is None


def test_only_guessed_fronts_are_built():
    assert dispensable_joints(drawer(Proposer.RULES), 0.1).fronts == {"drawer"}
    assert not dispensable_joints(drawer(Proposer.ANNOTATION), 0.1).fronts


def test_fronts_of_many_faces_are_built_at_once():
    chest = drawer(Proposer.RULES)
    assert first_plan(chest, FRONTS) == Plan()
    faces = np.tile(chest.mesh.faces, (MANY_FACES // len(chest.mesh.faces) + 1, 1))
    own = chest.parts[1]
    base = Part("base", np.setdiff1d(np.arange(len(faces)), own.faces))
    mesh = Mesh.from_triangles(chest.mesh.vertices, faces)
    carved = replace(chest, mesh=mesh, parts=(base, own))
    assert first_plan(carved, FRONTS).build_fronts
    assert first_plan(carved, Spare()) == Plan()
