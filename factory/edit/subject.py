"""The subject of editing: a mesh, the place of its sidecar, and the asset made of it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..errors import ConfigError, RegistryError
from ..intake.formats.catalog import FORMATS, is_mesh
from ..intake.stated import stated_paths
from ..registry import Registry
from ..registry.logged import logged_build
from ..runtime.layout import ASSETS, REJECTED, REPORT


@dataclass(frozen=True)
class Subject:
    """A mesh whose parts are going to be stated.

    Attributes:
        mesh: its file.
        output: folder of the registry that builds go into.
        asset: folder of the asset made of it before; ``None`` if that is not asked about.
    """

    mesh: Path
    output: Path
    asset: Path | None = None

    @property
    def existing(self) -> Path | None:
        """Return the file of stated parts that is there, if one is."""
        return next((path for path in stated_paths(self.mesh) if path.is_file()), None)

    @property
    def sidecar(self) -> Path:
        """Return where the statement is written: it wins over sidecars that are there."""
        usual = self.mesh.with_name(f"{self.mesh.stem}.parts.json")
        return (self.existing or usual).with_suffix(".json")


def subject_of(given: Path, output: Path | None, usual: Path) -> Subject:
    """Find the mesh that somebody wants to edit.

    Args:
        given: a mesh file, the folder of an asset or of a rejected one, or its id.
        output: the registry's folder, if it was said.
        usual: the registry of a mesh otherwise.

    Raises:
        ConfigError: no such thing, or its input is gone.
        RegistryError: no such registry.
    """
    if given.is_file():
        return Subject(_required(given), output or usual)
    if (given / REPORT).is_file() and given.resolve().parent.name in (ASSETS, REJECTED):
        folder = given.resolve()
    elif output is not None and given.name == str(given):
        registry = Registry(output)
        folder = registry.folder(registry.named(given.name))
    else:
        raise ConfigError(
            f"{given}: no such file or asset; want a mesh, the folder of an asset such as "
            "out/rejected/chest-0123456789, or its id with --output"
        )
    root = folder.parent.parent
    return Subject(_required(_input(root, folder.name)), output or root, folder)


def _input(root: Path, asset_id: str) -> Path:
    """Return the file that an asset was made of."""
    logged = logged_build(root, asset_id)
    if logged is None:
        raise RegistryError(
            f"{root}: its log does not say what {asset_id} was made of; want its mesh instead"
        )
    said = logged.input
    # Of a job that was given a relative path, from wherever it was run.
    for folder in (Path(), root.parent, root):
        if (folder / said).is_file():
            return folder / said
    raise ConfigError(f"{said}: {asset_id} was made of it, and it is not there; want where it is")


def _required(path: Path) -> Path:
    if not is_mesh(path):
        known = ", ".join(form.suffix for form in FORMATS if form.stands_alone)
        raise ConfigError(f"{path}: parts are stated of a mesh, want one of {known}")
    return path
