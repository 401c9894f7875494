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
that uses it.
"""

__version__ = "0.1.0"
