"""The continuous sweep against the obvious loop: 64 fixed poses a joint, every pair of hulls, objects built anew.

One JSON line: how many times less work for the same cabinet, and the worst excess each finds [mm].
"""

from __future__ import annotations

import itertools
import json
import tempfile
import time
from pathlib import Path

import numpy as np

from asset_factory.factory.asset import Asset, PartBody
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.decompose.decompose import decompose
from asset_factory.factory.export.bundle import export_bundle
from asset_factory.factory.inertia import part_inertial
from asset_factory.factory.mesh import Provenance
from asset_factory.factory.training.objects import make_object
from asset_factory.sim_checks.checks.penetration import check_penetration
from asset_factory.sim_checks.config import PenetrationConfig
from asset_factory.sim_checks.depth import overlap
from asset_factory.sim_checks.description import Description
from asset_factory.sim_checks.hull import convex_hull
from asset_factory.sim_checks.kinematics import build_tree, sweep_range
from asset_factory.sim_checks.reading.read import read_here

POSES = 64


def cabinet(folder: Path) -> Description:
    """A cabinet with doors and drawers, decomposed and exported as any asset is."""
    articulation, config = make_object("cabinet", 1), BuildConfig()
    bodies = []
    for index, piece in enumerate(decompose(articulation, config.decompose)):
        mesh = articulation.part_mesh(index)
        inertial = part_inertial(mesh, piece.hulls, config.inertia.density, config.inertia)
        bodies.append(PartBody(piece.hulls, inertial, None, piece.method))
    asset = Asset("cabinet", articulation, tuple(bodies))
    return read_here(export_bundle(asset, Provenance("cabinet", "0" * 64), folder).urdf)


def obvious_loop(description: Description) -> float:
    """Worst depth over rest [m], as it would be written down first."""
    tree = build_tree(description)
    links = {link.name: link for link in description.links}
    part_of = tree.part_of()
    lower = {joint.name: sweep_range(joint)[0] for joint in tree.moving}  # type: ignore[index]

    def depths(values: dict[str, float]) -> dict[tuple[str, int, str, int], float]:
        poses, found = tree.link_poses(values), {}
        built = {
            (name, number): convex_hull(shape.vertices).moved(poses[name])
            for name in sorted(links)
            for number, shape in enumerate(links[name].collisions)
        }
        for (a, i), (b, j) in itertools.combinations(built, 2):
            if part_of[a] != part_of[b]:
                found[a, i, b, j] = max(0.0, overlap(built[a, i], built[b, j]).depth)
        return found

    rest, worst = depths(lower), 0.0
    for joint in tree.moving:
        span = sweep_range(joint)
        for value in np.linspace(*span, POSES):  # type: ignore[misc]
            now = depths({**lower, joint.name: float(value)})
            worst = max(worst, *(now[key] - rest[key] for key in now))
    return worst


def main() -> None:
    """Time both on one cabinet."""
    with tempfile.TemporaryDirectory() as folder:
        description = cabinet(Path(folder))
        started = time.process_time()
        result = check_penetration(description, PenetrationConfig())
        ours = time.process_time() - started
        started = time.process_time()
        naive = obvious_loop(description)
        theirs = time.process_time() - started
    excess = max(joint["excess_mm"] for joint in result.measurements["joints"])
    line = {
        "benchmark": "penetration_sweep",
        "hulls": result.measurements["hulls"],
        "joints": len(result.measurements["joints"]),
        "times_less_work": round(theirs / ours, 1),
        "worst_excess_mm": {"continuous": excess, "obvious_loop": round(naive * 1000.0, 4)},
    }
    print(json.dumps(line))


if __name__ == "__main__":
    main()
