"""Solids as they are kept between builds: without textures, which the input brings again."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ...articulation import Articulation
from ...intake.categories import UNKNOWN, Category
from ...mesh import Mesh
from ...runtime.packing import contents
from ...runtime.stages import Stages
from ...runtime.store import digest_bytes
from .build import SOLIDS, SolidParts, solids
from .skin import parts_to_build


def solid_parts(
    articulation: Articulation, stages: Stages, fronts: bool = False, usual: Category = UNKNOWN
) -> SolidParts:
    """Return an articulation whose one-piece parts are made solid; any other comes back as it is.

    Args:
        articulation: parts and joints.
        stages: with the settings and the cache.
        fronts: build every thin front, bare or not.
        usual: inside of objects of its category.
    """
    config = stages.config.solids
    if not config.construct or not parts_to_build(articulation, fronts):
        return SolidParts(articulation, (None,) * len(articulation.parts), ())
    mesh = articulation.mesh
    textures = [digest_bytes(each.texture.data) for each in mesh.materials if each.texture]
    plain = replace(articulation, mesh=_bare(mesh))
    key = SOLIDS.key(stages.config, *contents(plain), *textures, fronts, usual.shelves, usual.liner)
    make = _maker(articulation, stages, fronts, usual)
    made = stages.recall("solids", SolidParts, key, make)
    return _with_mesh(made, _dressed(made.articulation.mesh, mesh))


def _maker(
    articulation: Articulation, stages: Stages, fronts: bool, usual: Category
) -> Callable[[], SolidParts]:
    def make() -> SolidParts:
        made = solids(articulation, stages.config.solids, fronts, usual)
        return _with_mesh(made, _bare(made.articulation.mesh))

    return make


def _with_mesh(made: SolidParts, mesh: Mesh) -> SolidParts:
    return replace(made, articulation=replace(made.articulation, mesh=mesh))


def _bare(mesh: Mesh) -> Mesh:
    materials = tuple(replace(material, texture=None) for material in mesh.materials)
    return replace(mesh, materials=materials)


def _dressed(mesh: Mesh, source: Mesh) -> Mesh:
    """Give a mesh the source's own materials, which come first, as the source has them."""
    own = source.materials
    return replace(mesh, materials=(*own, *mesh.materials[len(own) :]))
