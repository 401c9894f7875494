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


def imported(path: Path, digest: str, kept: Path | None) -> Articulation:
    """Return the articulation described by a URDF, an MJCF or an annotated mesh, without its looks.

    It is kept in the folder ``kept`` under the file's ``digest``; without one of them the files
    are read every time.

    Raises:
        InputRejected: it cannot be read, is no tree, or comes without joints.
    """
    key = stage_key("evaluation-case", code_digest(__name__), path.parent.name, digest)
    store = Store(kept) if kept and digest else None
    if store and (found := store.load(key)):
        return unpack(Articulation, found)
    intake = load(path, IntakeConfig())
    whole = choose(intake, BuildConfig(articulator="annotated")).articulate(intake.mesh)
    plain = replace(whole, mesh=Mesh.from_triangles(whole.mesh.vertices, whole.mesh.faces))
    if store:
        store.save(key, pack(plain))
    return plain
