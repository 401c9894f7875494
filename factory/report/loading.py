"""How other programs load an asset: a few lines of Python for each."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePath

from ..export.manifest import Manifest
from ..runtime.layout import ASSETS


@dataclass(frozen=True)
class Snippet:
    """Python that loads an asset into the program of that name."""

    program: str
    code: str


def loading_snippets(registry: PurePath, asset_id: str, manifest: Manifest) -> tuple[Snippet, ...]:
    """Return how a registered asset is loaded.

    Args:
        registry: path of its folder, as somebody would type it.
        asset_id: of the asset.
        manifest: of the asset.
    """
    mjcf = str(registry / ASSETS / asset_id / manifest.mjcf)
    named = f"registry={str(registry)!r}, asset={asset_id!r}"
    return (
        Snippet("MuJoCo", f"import mujoco\nmodel = mujoco.MjModel.from_xml_path({mjcf!r})"),
        Snippet(
            "ManiSkill",
            "import gymnasium as gym\n"
            f'env = gym.make("asset_factory.envs:OpenJoint-v1", {named})\nenv.reset(seed=0)',
        ),
    )
