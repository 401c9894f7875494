"""What a registry offers to open: assets that passed, their joints and where to hold them."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from asset_factory.factory.errors import RegistryError

FloatArray = npt.NDArray[np.float64]

#: How far a joint without limits has to be turned to count as fully open [rad].
CONTINUOUS_RANGE = math.pi / 2
#: Most names that an error lists.
LISTED = 12


@dataclass(frozen=True)
class OpenableJoint:
    """A joint with a place to hold it.

    Attributes:
        name, kind, child: as in the URDF.
        lower, upper: closed and fully open [rad] or [m]; finite for every kind.
        axis: unit direction in the object frame with every joint at 0, shape [3].
        handle_link: the link that carries the handle; ``child``, or a link it carries.
        point: where to hold, in ``handle_link``'s frame [m], shape [3].
        rest_point: the same place in the object frame with every joint at 0 [m], shape [3].
        normal: outward there, object frame with every joint at 0, shape [3].
        pull: in which direction a pull there opens, same frame, shape [3].
    """

    name: str
    kind: str
    child: str
    lower: float
    upper: float
    axis: FloatArray
    handle_link: str
    point: FloatArray
    rest_point: FloatArray
    normal: FloatArray
    pull: FloatArray


@dataclass(frozen=True)
class RegisteredAsset:
    """An asset as a task sees it.

    Attributes:
        id: folder name in the registry.
        urdf: the file to load.
        category: of the object; empty if unknown.
        bounds: box around the closed object, object frame [m], shape [2, 3].
        ground_offset: height of the object frame at which the object stands on the ground [m].
        movable: every joint with a degree of freedom, whether or not it can be held; name -> manifest data.
        openable: those that can be a target.
        ignored_contacts: pairs of links that overlap on purpose.
    """

    id: str
    urdf: Path
    category: str
    bounds: FloatArray
    ground_offset: float
    movable: dict[str, dict[str, Any]]
    openable: tuple[OpenableJoint, ...]
    ignored_contacts: tuple[tuple[str, str], ...]

    @property
    def standing_bounds(self) -> FloatArray:
        """Box around the closed object as it stands on the ground [m], shape [2, 3]."""
        return np.asarray(self.bounds + np.array([0.0, 0.0, self.ground_offset]))

    def joint(self, name: str) -> OpenableJoint:
        """The openable joint of that name. Raises RegistryError listing those there are."""
        select_assets({self.id: self}, self.id, name)
        return next(joint for joint in self.openable if joint.name == name)


def read_registry(registry: str | Path) -> dict[str, RegisteredAsset]:
    """Every asset in ``registry/assets`` that has a joint to open, by id, sorted.

    Raises:
        RegistryError: no registry there, nothing in it that opens, or a manifest that cannot be read.
    """
    folder = Path(registry) / "assets"
    if not folder.is_dir():
        raise RegistryError(f"{registry}: no registry here (no folder 'assets'); `factory build --output` makes one")
    manifests = sorted(folder.glob("*/asset.json"))
    assets = {path.parent.name: _read_asset(path) for path in manifests}
    openable = {name: asset for name, asset in assets.items() if asset.openable}
    if not openable:
        raise RegistryError(f"{registry}: {len(assets)} assets, none with a joint to open; build one that has")
    return openable


def select_assets(
    assets: dict[str, RegisteredAsset], asset_id: str | None, joint: str | None
) -> dict[str, RegisteredAsset]:
    """Those of ``assets`` that have the given id and an openable joint of the given name.

    Raises:
        RegistryError: there are none; lists the assets or joints there are.
    """
    if asset_id is not None:
        if asset_id not in assets:
            raise RegistryError(f"no asset {asset_id!r} to open; there are {_listed(list(assets))}")
        assets = {asset_id: assets[asset_id]}
    if joint is None:
        return assets
    chosen = {name: asset for name, asset in assets.items() if joint in [j.name for j in asset.openable]}
    if not chosen:
        names = sorted({j.name for asset in assets.values() for j in asset.openable})
        where = f"asset {asset_id!r}" if asset_id is not None else f"{len(assets)} assets"
        raise RegistryError(f"{where}: no joint {joint!r} to open; there are {_listed(names)}")
    return chosen


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - LISTED} more" if len(names) > LISTED else ""
    return ", ".join(repr(name) for name in names[:LISTED]) + more


def _read_asset(path: Path) -> RegisteredAsset:
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        movable = {joint["name"]: joint for joint in data["joints"] if joint["kind"] != "fixed"}
        handles = {joint["child"]: joint["handle"] for joint in data["joints"] if joint["handle"] is not None}
        openable = (_openable(joint, data["joints"], handles) for joint in movable.values())
        return RegisteredAsset(
            id=path.parent.name,
            urdf=path.parent / data["urdf"],
            category=data["category"] or "",
            bounds=np.array(data["closed_bounds"]),
            ground_offset=float(data["ground_offset"]),
            movable=movable,
            openable=tuple(joint for joint in openable if joint is not None),
            ignored_contacts=tuple((first, second) for first, second in data["excluded_pairs"]),
        )
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise RegistryError(f"{path}: not a manifest of this version ({type(error).__name__}: {error})") from error


def _openable(
    joint: dict[str, Any], joints: list[dict[str, Any]], handles: dict[str, dict[str, Any]]
) -> OpenableJoint | None:
    """The joint as a target; ``None`` if nothing that it moves can be held."""
    carried = [joint["child"]]
    for other in joints:
        if other["parent"] in carried:
            carried.append(other["child"])
    link = next((link for link in carried if link in handles), None)
    if link is None:
        return None
    lower, upper = joint["lower"], joint["upper"]
    if joint["kind"] == "continuous":
        lower, upper = 0.0, CONTINUOUS_RANGE
    handle = handles[link]
    origins = {other["child"]: other["origin"] for other in joints}
    return OpenableJoint(
        name=joint["name"],
        kind=joint["kind"],
        child=joint["child"],
        lower=float(lower),
        upper=float(upper),
        axis=np.array(joint["axis"]),
        handle_link=link,
        point=np.array(handle["point"]),
        rest_point=np.array(handle["point"]) + np.array(origins[link]),
        normal=np.array(handle["normal"]),
        pull=np.array(handle["pull"]),
    )
