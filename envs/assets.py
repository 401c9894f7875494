"""What a registry offers to open: assets that passed, their joints and where to hold them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from asset_factory.factory.articulation import JointKind
from asset_factory.factory.errors import RegistryError
from asset_factory.factory.export.manifest import (
    Manifest,
    ManifestHandle,
    ManifestJoint,
    ManifestTarget,
)
from asset_factory.factory.registry.report_file import StoredReport, file_digests, read_report
from asset_factory.factory.runtime.layout import MANIFEST
from asset_factory.factory.runtime.store import digest_bytes

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
        origin: a point of the axis, same frame [m], shape [3].
        handle_link: the link that is held; ``child``, or a link it carries.
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
    origin: FloatArray
    handle_link: str
    point: FloatArray
    rest_point: FloatArray
    normal: FloatArray
    pull: FloatArray

    @property
    def lever(self) -> float:
        """Return how far from the axis it is held [m]; 0 for what slides."""
        if self.kind == "prismatic":
            return 0.0
        return float(np.linalg.norm(np.cross(self.axis, self.rest_point - self.origin)))


@dataclass(frozen=True)
class RegisteredAsset:
    """An asset as a task sees it.

    Attributes:
        folder: where its files lie, called like it.
        manifest: what its bundle says of it.
        digest: SHA-256 of the manifest when it was read.
        openable: joints that can be a target.
        unusable: why other movable joints cannot be; name -> sentence.
    """

    folder: Path
    manifest: Manifest
    digest: str
    openable: tuple[OpenableJoint, ...]
    unusable: dict[str, str]

    @property
    def id(self) -> str:
        """Return its name in the registry."""
        return self.folder.name

    @property
    def urdf(self) -> Path:
        """Return the file to load."""
        return self.folder / self.manifest.urdf

    @property
    def report(self) -> StoredReport | None:
        """Return what the validator said of it; ``None`` where that cannot be read."""
        try:
            return read_report(self.folder)
        except RegistryError:
            return None

    @property
    def bounds(self) -> FloatArray:
        """Return the box around the closed object, object frame [m], shape [2, 3]."""
        return np.array(self.manifest.closed_bounds)

    @property
    def standing_bounds(self) -> FloatArray:
        """Return the box around the closed object as it stands on the ground [m], shape [2, 3]."""
        return np.asarray(self.bounds + np.array([0.0, 0.0, self.manifest.ground_offset]))

    def closed_value(self, joint: str) -> float:
        """Return the joint's value when closed [rad] or [m]; its input pose if it has no limit."""
        found = self.manifest.movable[joint]
        ends = _limits(found)
        return 0.0 if ends is None or found.kind is JointKind.CONTINUOUS else ends[0]

    def joint(self, name: str) -> OpenableJoint:
        """Return the openable joint of that name. Raises RegistryError listing those there are."""
        for joint in self.openable:
            if joint.name == name:
                return joint
        names = listed([joint.name for joint in self.openable])
        why = f" ({self.unusable[name]})" if name in self.unusable else ""
        raise RegistryError(f"asset {self.id!r}: no joint {name!r} to open{why}; there are {names}")


def read_registry(registry: str | Path) -> dict[str, RegisteredAsset]:
    """Return every asset in ``registry/assets``, by id, sorted.

    Raises:
        RegistryError: no registry there, nothing in it, or a manifest that cannot be read.
    """
    folder = Path(registry) / "assets"
    if not folder.is_dir():
        remedy = "`factory build --output` makes one"
        raise RegistryError(f"{registry}: no registry here (no folder 'assets'); {remedy}")
    manifests = sorted(folder.glob(f"*/{MANIFEST}"))
    if not manifests:
        remedy = f"`factory build --output {registry}` adds some"
        raise RegistryError(f"{registry}: a registry without assets; {remedy}")
    return {path.parent.name: _read_asset(path) for path in manifests}


def named(
    assets: dict[str, RegisteredAsset], ids: Sequence[str], registry: Path
) -> dict[str, RegisteredAsset]:
    """Return those of a registry's assets that have these ids, sorted; all if there are no ids.

    An id may be cut short where only one begins so.

    Raises:
        RegistryError: no such asset, or several; names those there are.
    """
    whole = set()
    for id in ids:
        begun = [id] if id in assets else [each for each in sorted(assets) if each.startswith(id)]
        if len(begun) != 1:
            found = f"{len(begun)} assets" if begun else "no asset"
            there = listed(begun or sorted(assets))
            raise RegistryError(f"{found} {id!r} in {registry}; there are {there}")
        whole |= {begun[0]}
    return {id: assets[id] for id in sorted(whole or assets)}


def check_unaltered(asset: RegisteredAsset) -> None:
    """Raise RegistryError if the asset was deleted or altered since it was registered.

    The report's ``files``, where it has them, are the digests at registration; else the manifest
    must be what it was when the registry was read.
    """
    name = f"asset {asset.id!r}"
    try:
        manifest = digest_bytes((asset.folder / MANIFEST).read_bytes())
        asset.urdf.stat()
    except OSError as error:
        there = sorted(path.parent.name for path in asset.folder.parent.glob(f"*/{MANIFEST}"))
        gone = f"{error.filename} is gone since the registry was read"
        raise RegistryError(f"{name}: {gone}; there are {listed(there)}") from error
    if manifest != asset.digest:
        changed = f"{MANIFEST} changed since the registry was read"
        raise RegistryError(f"{name}: {changed}; make the task again")
    try:
        registered = read_report(asset.folder).files
    except (RegistryError, ValueError):
        return
    found = file_digests(asset.folder)
    files = registered.keys() | found.keys()
    wrong = sorted(file for file in files if registered.get(file) != found.get(file))
    if wrong:
        words = f"{listed(wrong)} not as registered (SHA-256)"
        raise RegistryError(f"{name}: {words}; build it again")


def listed(names: list[str]) -> str:
    """Return the names as an error lists them."""
    more = f" and {len(names) - LISTED} more" if len(names) > LISTED else ""
    return (", ".join(repr(name) for name in names[:LISTED]) + more) or "none"


def _read_asset(path: Path) -> RegisteredAsset:
    try:
        text = path.read_bytes()
        manifest = Manifest.from_json(text)
    except (OSError, ValueError) as error:
        raise RegistryError(f"{path}: not a manifest of this version ({error})") from error

    openable: list[OpenableJoint] = []
    unusable = {}
    for joint in manifest.movable.values():
        found = _openable(joint, manifest)
        if isinstance(found, str):
            unusable[joint.name] = found
        else:
            openable.append(found)

    return RegisteredAsset(path.parent, manifest, digest_bytes(text), tuple(openable), unusable)


def _limits(joint: ManifestJoint) -> tuple[float, float] | None:
    """Return a joint's ends [rad] or [m]; ``None`` if they are missing, infinite or swapped."""
    if joint.kind is JointKind.CONTINUOUS:
        return 0.0, CONTINUOUS_RANGE
    ends = (joint.lower, joint.upper)
    if None in ends or not all(math.isfinite(end) for end in ends) or not ends[0] < ends[1]:
        return None
    return ends


def _openable(joint: ManifestJoint, manifest: Manifest) -> OpenableJoint | str:
    """Return the joint as a target, or why it cannot be one."""
    limits = _limits(joint)
    if limits is None:
        return f"its limits are [{joint.lower}, {joint.upper}], want finite ones, lower below upper"
    targets = (target for target in manifest.targets if target.joint == joint.name)
    held = max(targets, key=lambda target: target.score, default=None) or _handle(joint, manifest)
    if held is None:
        return "nothing that it moves can be held"

    origins = {other.child: other.origin for other in manifest.joints}
    link = held.part if isinstance(held, ManifestTarget) else held.frame
    return OpenableJoint(
        name=joint.name,
        kind=str(joint.kind),
        child=joint.child,
        lower=limits[0],
        upper=limits[1],
        axis=np.array(joint.axis),
        origin=np.array(joint.origin),
        handle_link=link,
        point=np.array(held.point),
        rest_point=np.array(held.point) + np.array(origins[link]),
        normal=np.array(held.normal),
        pull=np.array(held.pull),
    )


def _handle(joint: ManifestJoint, manifest: Manifest) -> ManifestHandle | None:
    """Return the handle of the first link with one that a joint moves."""
    carried = {joint.child}
    for other in manifest.joints:
        if other.parent in carried:
            carried.add(other.child)
        if other.child in carried and other.handle is not None:
            return other.handle
    return None
