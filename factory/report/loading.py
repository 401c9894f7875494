"""How other programs load an asset: a few lines for each."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePath
from shlex import quote

from ..export.manifest import Manifest
from ..runtime.layout import ASSETS


@dataclass(frozen=True)
class Snippet:
    """What loads an asset into the program of that name."""

    program: str
    code: str


def loading_snippets(registry: PurePath, asset_id: str, manifest: Manifest) -> tuple[Snippet, ...]:
    """Return how an asset is loaded; ``registry`` is the folder's path, as somebody types it."""
    folder = registry / ASSETS / asset_id
    mjcf = str(folder / manifest.mjcf)
    usd = str(folder / "asset.usd")
    packed = f"tar czf {asset_id}.tar.gz -C {quote(str(folder.parent))} {asset_id}"
    named = f"registry={str(registry)!r}, asset={asset_id!r}"
    return (
        Snippet("MuJoCo", f"import mujoco\nmodel = mujoco.MjModel.from_xml_path({mjcf!r})"),
        Snippet(
            "ManiSkill",
            "import gymnasium as gym\n"
            f'env = gym.make("asset_factory.envs:OpenJoint-v1", {named})\nenv.reset(seed=0)',
        ),
        Snippet(
            "Isaac Sim, if built with --formats usd",
            "import omni.usd\nstage = omni.usd.get_context().get_stage()\n"
            f'stage.DefinePrim("/World/asset").GetReferences().AddReference({usd!r})',
        ),
        Snippet("a shell, as an archive to hand on", packed),
    )
