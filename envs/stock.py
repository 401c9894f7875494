"""ManiSkill's own cabinet tasks on a registry's assets.

These are ``OpenCabinetDrawer-v1`` and ``OpenCabinetDoor-v1``. Their code runs as it is, so that
scripts written to train on PartNet-Mobility train on these::

    @register_env("OpenMyDrawers-v1", max_episode_steps=100)
    class OpenMyDrawers(RegistryCabinets, OpenCabinetDrawerEnv):
        registry = "out/"

A script that cannot be changed runs as ``python -m asset_factory.envs.stock out/ train.py --its-own
arguments``.
"""

from __future__ import annotations

import json
import math
import runpy
import shutil
import sys
import tempfile
import weakref
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar
from xml.etree import ElementTree

import numpy as np
import trimesh
from defusedxml.ElementTree import parse

from asset_factory.factory.errors import RegistryError
from asset_factory.factory.registry.entry import Split
from asset_factory.sim_checks.simulators.sapien_backend import couple_as_written

from .assets import FloatArray, RegisteredAsset, check_unaltered, read_registry
from .loading import invisible_robots, replaced, resist
from .placement import facing_of
from .selection import Wanted, select
from .tasks.arguments import words

#: The ids whose classes ask for drawers and for doors, and how ManiSkill limits their episodes.
STOCK_TASKS = {
    "OpenCabinetDrawer-v1": "OpenCabinetDrawerEnv",
    "OpenCabinetDoor-v1": "OpenCabinetDoorEnv",
}
STOCK_STEPS = 100
#: What the stock code looks for in the name of a visual, and what it calls a door.
HANDLE = "handle"
#: The link that turns an object's front to where the stock code puts its robot, which is at -x.
STAND = "stand"
#: The least side of the box around a handle [m].
THINNEST = 1e-3


def described(asset: RegisteredAsset) -> ElementTree.Element:
    """Return the asset's URDF as the stock code wants it, meshes by their full path.

    It opens every joint of a kind that has a visual called handle, closes all joints at their lower
    limit, and expects the front at -x.
    """
    robot: ElementTree.Element = parse(asset.urdf).getroot()
    for mesh in robot.iter("mesh"):
        mesh.set("filename", str((asset.folder / mesh.get("filename", "")).resolve()))
    held = {link.get("name") for link in robot.iter("link") if _handles(link)}
    children = set()
    for joint in robot.iter("joint"):
        child = joint.find("child").get("link")  # type: ignore[union-attr]
        children.add(child)
        if joint.get("type") == "continuous" or child not in held:
            joint.set("type", "fixed")
            for mimic in joint.findall("mimic"):
                joint.remove(mimic)
    names = (link.get("name", "") for link in robot.iter("link"))
    root = next(name for name in names if name not in children)
    front = facing_of(asset, asset.openable[0])
    yaw = math.pi - math.atan2(front[1], front[0])
    robot.insert(0, ElementTree.Element("link", name=STAND))
    turn = ElementTree.SubElement(robot, "joint", name=f"{STAND}_turn", type="fixed")
    ElementTree.SubElement(turn, "parent", link=STAND)
    ElementTree.SubElement(turn, "child", link=root)
    ElementTree.SubElement(turn, "origin", xyz="0 0 0", rpy=f"0 0 {yaw:.9g}")
    return robot


class RegistryCabinets:
    """Put before a stock cabinet task, makes its cabinets those of a registry.

    Each asset is described to ManiSkill's loader of PartNet-Mobility as one of that data set:
    turned to face -x, joints without an end or without a handle fixed. Friction and damping are
    those of the manifest; the parts of one asset do not collide with one another, which the stock
    code decides.

    Attributes:
        registry: folder that ``factory build --output`` wrote; a class says it, or ``gym.make(...,
            registry=DIR)``.

    Args:
        asset, category, split, verdict: as for the tasks of this package.

    Raises:
        RegistryError: no registry, nothing in it with such a joint, or an asset altered since.
    """

    registry: ClassVar[str | Path]
    handle_types: ClassVar[list[str]]
    scene: Any

    def __init__(
        self,
        *args: Any,
        registry: str | Path | None = None,
        asset: str | None = None,
        category: str | tuple[str, ...] | None = None,
        split: Split | None = None,
        verdict: str = "passed",
        **options: Any,
    ) -> None:
        root = Path(self.registry if registry is None else registry)
        kinds = tuple(kind for kind in ("prismatic", "revolute") if kind in self.handle_types)
        wanted = Wanted(asset, None, words(category), kinds, split, verdict)
        folder = Path(tempfile.mkdtemp(prefix="stock-cabinets-"))
        weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
        self._sources = {}
        for record in select(read_registry(root), wanted).values():
            tree = described(record)
            if any(joint.get("type") in kinds for joint in tree.iter("joint")):
                path = folder / f"{record.id}.urdf"
                ElementTree.ElementTree(tree).write(path, encoding="utf-8", xml_declaration=True)
                self._sources[record.id] = (record, path)
        if not self._sources:
            none = f"{root}: no {' or '.join(kinds)} joint"
            raise RegistryError(f"{none} whose part carries a visual named {HANDLE!r}")
        # The stock code reads its ids from a file.
        listing = folder / "ids.json"
        listing.write_text(json.dumps(dict.fromkeys(self._sources)), encoding="utf-8")
        self.TRAIN_JSON = listing
        super().__init__(*args, **options)

    def _load_agent(self, options: dict[str, Any]) -> None:
        with invisible_robots(self.scene):
            super()._load_agent(options)  # type: ignore[misc]

    def _load_cabinets(self, joint_types: list[str]) -> None:
        _add_to_partnet({name: path for name, (_, path) in self._sources.items()})
        with (
            _handles_from_files(self._sources),
            _coupled_as_written(),
            nullcontext() if self.scene.can_render() else unpainted(),
        ):
            super()._load_cabinets(joint_types)  # type: ignore[misc]
        for cabinet in self._cabinets:  # type: ignore[attr-defined]
            asset, _ = self._sources[_asset_of(cabinet.name)]
            check_unaltered(asset)
            resist(cabinet, asset, 1.0, 1.0)


def replace_stock(registry: str | Path) -> None:
    """Make the stock ids name the registry's assets, in this process and those it forks."""
    from mani_skill.envs.tasks.mobile_manipulation import open_cabinet_drawer
    from mani_skill.utils.registration import register_env

    for task, name in STOCK_TASKS.items():
        stock = getattr(open_cabinet_drawer, name)
        made = type(name, (RegistryCabinets, stock), {"registry": registry, "__module__": __name__})
        register_env(task, max_episode_steps=STOCK_STEPS, override=True)(made)


def main(arguments: list[str]) -> None:
    """Run somebody's script, its own arguments after it, with :func:`replace_stock` done."""
    registry, script, *rest = arguments
    replace_stock(registry)
    sys.argv = [script, *rest]
    runpy.run_path(script, run_name="__main__")


def _add_to_partnet(files: dict[str, Path]) -> None:
    """Enter files into ManiSkill's table of PartNet-Mobility."""
    from mani_skill.utils.building.articulations import partnet_mobility

    if partnet_mobility.PARTNET_MOBILITY is None:
        # It raises where PartNet-Mobility was not downloaded, after it made the table.
        with suppress(RuntimeError):
            partnet_mobility._load_partnet_mobility_dataset()
    for name, path in files.items():
        partnet_mobility.PARTNET_MOBILITY["model_data"][name] = {"scale": 1.0}
        partnet_mobility.PARTNET_MOBILITY["model_urdf_paths"][name] = path


def _coupled_as_written() -> AbstractContextManager[None]:
    """Let joints follow others at the ratios of their files, which SAPIEN's loader turns round."""
    from mani_skill.utils.building.articulations import partnet_mobility

    make = partnet_mobility.get_partnet_mobility_builder

    def coupled(*args: Any, **options: Any) -> Any:
        builder = make(*args, **options)
        couple_as_written(builder)
        return builder

    return replaced(partnet_mobility, make.__name__, coupled)


def _handles_from_files(
    sources: dict[str, tuple[RegisteredAsset, Path]],
) -> AbstractContextManager[None]:
    """Let the stock code find handles without a renderer, and the middle of flat ones.

    It takes their shapes from what the renderer loaded, and only asks for the middle of the box
    around them, which of a flat box is not a number.
    """
    from mani_skill.utils.structs import Link

    def from_files(link: Any, filter: object, mesh_name: str) -> list[trimesh.Trimesh]:
        _, path = sources[_asset_of(link.articulation.name)]
        found = next(each for each in parse(path).iter("link") if each.get("name") == link.name)
        points = np.concatenate(list(_corners(_handles(found))))
        box = trimesh.creation.box(np.maximum(np.ptp(points, axis=0), THINNEST))
        return [box.apply_translation((points.min(axis=0) + points.max(axis=0)) / 2)]

    return replaced(Link, "generate_mesh", from_files)


@contextmanager
def unpainted() -> Iterator[None]:
    """Let ManiSkill's code describe coloured shapes where nothing can render; none is built.

    The colour alone asks for a device.
    """
    import sapien
    from sapien import pysapien

    with (
        replaced(sapien.render, "RenderMaterial", SimpleNamespace),
        replaced(pysapien.render, "RenderMaterial", SimpleNamespace),
    ):
        yield


def _handles(link: ElementTree.Element) -> list[ElementTree.Element]:
    return [visual for visual in link.findall("visual") if HANDLE in visual.get("name", "")]


def _corners(visuals: Iterable[ElementTree.Element]) -> Iterator[FloatArray]:
    """Yield the vertices of visuals [m], link frame, shape [vertex, 3] each."""
    for mesh in (mesh for visual in visuals for mesh in visual.iter("mesh")):
        found = trimesh.load(mesh.get("filename"), force="mesh", process=False)
        yield np.asarray(found.vertices)


def _asset_of(cabinet: str) -> str:
    """Return the stock code names a cabinet by its id and the number of the environment."""
    return cabinet.rsplit("-", 1)[0]


if __name__ == "__main__":
    main(sys.argv[1:])
