"""Whole appliances from the factory's own generator, manufactured and exported as any asset is."""

from collections.abc import Callable
from pathlib import Path

from asset_factory.factory.asset import Asset, PartBody
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.export.bundle import export_bundle
from asset_factory.factory.intake.intake import Provenance
from asset_factory.factory.manufacture.decompose.decompose import decompose
from asset_factory.factory.manufacture.decompose.room import rooms_of
from asset_factory.factory.manufacture.inertia import part_inertial
from asset_factory.factory.runtime.stages import Stages
from asset_factory.learn.objects import make_object


def made(category: str, seed: int, suffix: str) -> Callable[[Path], Path]:
    """Writes an object of the generator; ``suffix`` is ``urdf`` or ``mjcf``."""

    def write(folder: Path) -> Path:
        articulation = make_object(category, seed)
        config = BuildConfig()
        bodies = []
        pieces = decompose(articulation, Stages(config), rooms_of(articulation))
        for index, piece in enumerate(pieces):
            mesh = articulation.part_mesh(index)
            inertial = part_inertial(mesh, piece.hulls, config.inertia.density, config.inertia)
            bodies.append(PartBody(piece.hulls, inertial, None, piece.method))
        asset = Asset(category, articulation, tuple(bodies))
        bundle = export_bundle(asset, Provenance(category, "0" * 64), folder / category)
        return bundle.urdf if suffix == "urdf" else bundle.mjcf

    return write
