"""The assets and joints of a registry that a task is about; errors that name the alternatives."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

from asset_factory.factory.errors import ConfigError, RegistryError
from asset_factory.factory.registry.entry import SPLITS, Split, split_of

from .assets import OpenableJoint, RegisteredAsset, listed

#: What can be asked of an asset's report.
VERDICTS = ("passed", "clean")
JOINT_TYPES = ("revolute", "prismatic", "continuous")

Assets = dict[str, RegisteredAsset]


@dataclass(frozen=True)
class Wanted:
    """Filters; ``None`` or an empty one lets everything pass.

    Attributes:
        asset: id of the only asset.
        joint: name of the only joint.
        categories: of objects.
        joint_types: of :data:`JOINT_TYPES`.
        split: ``train`` or ``test``.
        verdict: ``passed``: everything in the registry; ``clean``: without a single finding.
        min_lever: what turns must be held at least this far from its axis [m].
    """

    asset: str | None = None
    joint: str | None = None
    categories: tuple[str, ...] = ()
    joint_types: tuple[str, ...] = ()
    split: Split | None = None
    verdict: str = "passed"
    min_lever: float = 0.0

    def __post_init__(self) -> None:
        for name, value, known in (
            *(("joint_type", kind, JOINT_TYPES) for kind in self.joint_types),
            *((("split", self.split, SPLITS),) if self.split is not None else ()),
            ("verdict", self.verdict, VERDICTS),
        ):
            if value not in known:
                words = ", ".join(map(repr, known))
                raise ConfigError(f"{name} must be one of {words}, not {value!r}")

    def admits(self, joint: OpenableJoint) -> bool:
        """Return whether the joint passes, its name aside."""
        if self.joint_types and joint.kind not in self.joint_types:
            return False
        return joint.kind == "prismatic" or joint.lever >= self.min_lever


def verdicts_of(asset: RegisteredAsset) -> tuple[str, ...]:
    """Return an asset's verdicts: ``passed``, as all in a registry, ``clean`` without findings."""
    report = asset.report
    return ("passed", "clean") if report is not None and report.clean else ("passed",)


def select(assets: Assets, wanted: Wanted) -> Assets:
    """Return the assets that pass every filter, each with the joints that do.

    Raises:
        RegistryError: there are none; says which filter left nothing and what there was before it.
    """
    if wanted.asset is not None and wanted.asset not in assets:
        there = listed(list(assets))
        raise RegistryError(f"no asset {wanted.asset!r} in the registry; there are {there}")
    left = {wanted.asset: assets[wanted.asset]} if wanted.asset is not None else assets
    left = _filter(
        left, "category", wanted.categories, lambda asset: (asset.manifest.category or "",)
    )
    splits = (wanted.split,) if wanted.split else ()
    left = _filter(left, "split", splits, lambda asset: (split_of(asset.id),))
    if wanted.verdict != "passed":
        left = _filter(left, "verdict", (wanted.verdict,), verdicts_of)
    return _with_joints(left, wanted, assets)


def _filter(
    assets: Assets,
    name: str,
    values: tuple[str, ...],
    words: Callable[[RegisteredAsset], Iterable[str]],
) -> Assets:
    if not values:
        return assets
    said = {key: set(words(asset)) for key, asset in assets.items()}
    kept = {key: asset for key, asset in assets.items() if said[key] & set(values)}
    if not kept:
        there = listed(sorted({word for each in said.values() for word in each}))
        none = f"{_where(assets)}: none with {name} {listed(list(values))}"
        raise RegistryError(f"{none}; there are {there}")
    return kept


def _with_joints(left: Assets, wanted: Wanted, assets: Assets) -> Assets:
    admitted = _admitted(left, wanted)
    if not admitted:
        raise RegistryError(_nothing_to_move(left, wanted, assets))
    if wanted.joint is None:
        return admitted
    named = _admitted(admitted, wanted, wanted.joint)
    if not named:
        names = sorted({joint.name for asset in admitted.values() for joint in asset.openable})
        reasons = [asset.unusable.get(wanted.joint) for asset in left.values()]
        reason = next(filter(None, reasons), "")
        none = f"{_where(left)}: no joint {wanted.joint!r} to move"
        why = f" ({reason})" if reason else ""
        raise RegistryError(f"{none}{why}; there are {listed(names)}")
    return named


def _admitted(assets: Assets, wanted: Wanted, name: str | None = None) -> Assets:
    """Return the assets that keep a joint, each with those that it keeps."""
    kept = {}
    for key, asset in assets.items():
        named = (joint for joint in asset.openable if name in (None, joint.name))
        admitted = tuple(joint for joint in named if wanted.admits(joint))
        if admitted:
            kept[key] = replace(asset, openable=admitted)
    return kept


def _nothing_to_move(left: Assets, wanted: Wanted, assets: Assets) -> str:
    need = f"{' or '.join(wanted.joint_types)} joint to move".strip()
    if wanted.min_lever:
        need += f", held at least {wanted.min_lever} m from its axis"
    kinds = sorted({joint.kind for asset in left.values() for joint in asset.openable})
    there = f"; there are {listed(kinds)} joints" if kinds else ""
    unusable = (item for asset in left.values() for item in asset.unusable.items())
    reasons = sorted({f"{name!r}: {why}" for name, why in unusable})
    why = f" ({'; '.join(reasons[:3])})" if reasons else ""
    others = ""
    if wanted.asset is not None:
        # Asked for one asset, people want to know which others would do.
        others = f"; assets with one: {listed(list(_admitted(assets, wanted)))}"
    return f"{_where(left)}: no {need}{there}{why}{others}"


def _where(assets: Assets) -> str:
    return f"asset {next(iter(assets))!r}" if len(assets) == 1 else f"{len(assets)} assets"
