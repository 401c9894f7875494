"""Turn 3D meshes into objects that robots can open.

Four packages, and one direction between them (``learn -> envs -> factory -> sim_checks``):

``asset_factory.factory``
    makes: a mesh file becomes a :class:`Mesh`, an :class:`Articulation`, an :class:`Asset`, a
    bundle of URDF and MJCF, and, once judged, a registry entry.
``asset_factory.sim_checks``
    judges any URDF or MJCF, ours or a stranger's: it knows files, never the factory's types.
``asset_factory.envs``
    uses: registry entries as ManiSkill tasks. Importing it registers them.
``asset_factory.learn``
    teaches: procedural objects, datasets, training and evaluation. What it makes reaches the maker
    as files of weights, never as an import.
``asset_factory.configs``
    data only: presets and tables, read with ``importlib.resources``.

Importing this package loads nothing heavy; each native library is imported inside the one package
that uses it. :func:`check` validates one file.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .sim_checks import Report

__version__ = "0.1.0"


def check(
    path: Path | str, simulators: Sequence[str] = ("sapien",), config: str = "default"
) -> Report:
    """Validate a URDF, MJCF or USD file as ``factory check`` does.

    Simulators run in child processes, which import the calling script: keep the call below
    ``if __name__ == "__main__"``.

    Args:
        path: the file; its meshes lie in the same folder or below.
        simulators: which engines to ask, by name; none for the static checks alone.
        config: a preset (default, fast, lenient, strict) or a TOML file of differences.

    Raises:
        ValueError: for a simulator or a preset that does not exist, with those that do.
    """
    from .factory.presets import load_config
    from .sim_checks import run_checks

    return run_checks(Path(path), simulators, load_config(config).checks)
