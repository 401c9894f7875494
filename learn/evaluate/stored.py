"""Objects read from files with their joints; cached, because the slowest take seconds."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from asset_factory.factory.articulate.catalog import choose
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.config import BuildConfig, IntakeConfig
from asset_factory.factory.intake.load import load
from asset_factory.factory.mesh import Mesh
from asset_factory.factory.runtime.code import code_digest
from asset_factory.factory.runtime.packing import pack, unpack
from asset_factory.factory.runtime.store import Store, stage_key


def imported(path: Path, digest: str, store: Store | None) -> Articulation:
    """Return the articulation described by a URDF, an MJCF or an annotated mesh, without its looks.

    It is kept in ``store`` under the file's ``digest``; ``None`` reads the files every time.

    Raises:
        InputRejected: it cannot be read, is no tree, or comes without joints.
    """
    key = stage_key("evaluation-case", code_digest(__name__), path.parent.name, digest)
    kept = None if store is None else store.load(key)
    if kept is not None:
        return unpack(Articulation, kept)
    intake = load(path, IntakeConfig())
    found = choose(intake, BuildConfig(articulator="annotated")).articulate(intake.mesh)
    plain = replace(found, mesh=Mesh.from_triangles(found.mesh.vertices, found.mesh.faces))
    if store is not None:
        store.save(key, pack(plain))
    return plain
