"""Methods to evaluate: any articulator, the naive answer, or predictions read from files."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from asset_factory.factory.articulate.annotated import AnnotatedArticulator
from asset_factory.factory.articulate.articulator import Articulator
from asset_factory.factory.articulate.catalog import ARTICULATORS, choose
from asset_factory.factory.articulate.rigid import RigidArticulator
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.config import BuildConfig, ParticulateConfig
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.intake.importers.prediction import read_prediction
from asset_factory.factory.intake.intake import Intake, Provenance
from asset_factory.factory.mesh import Mesh

NAIVE = "naive"
PREDICTIONS = "predictions"
#: Those that see a mesh and nothing else.
_SEEING = [name for name in ARTICULATORS if name not in ("annotated", "rigid")]
METHODS = (NAIVE, *_SEEING, PREDICTIONS)


@dataclass(frozen=True)
class Method:
    """One way to find moving parts, of ``METHODS``; ``folder`` holds ``predictions``' files."""

    name: str
    config: ParticulateConfig
    folder: Path | None = None

    def __post_init__(self) -> None:
        if self.name not in METHODS:
            raise ConfigError(f"--method: no method {self.name!r}; there are {', '.join(METHODS)}")
        if self.name == PREDICTIONS and (self.folder is None or not self.folder.is_dir()):
            given = self.folder or "not given"
            raise ConfigError(f"--predictions: {given}; want the folder of <case>.npz files")

    @property
    def is_random(self) -> bool:
        """Return whether another seed may give another answer."""
        return self.name in ("auto", "particulate")

    def seeded(self, repeat: int) -> Method:
        """Return the same method with the seed of a repetition."""
        return replace(self, config=replace(self.config, seed=self.config.seed + repeat))

    def answer(self, mesh: Mesh, case: str) -> Articulation:
        """Return the moving parts of a mesh.

        Raises:
            InputRejected: it has no answer.
            ConfigError: its checkpoint cannot be used.
        """
        if self.name == NAIVE:
            return RigidArticulator().articulate(mesh)
        if self.name == PREDICTIONS and self.folder is not None:
            faces = len(mesh.faces)
            annotation = read_prediction(self.folder / f"{case}.npz", faces)
            return AnnotatedArticulator(annotation, np.eye(4), np.arange(faces)).articulate(mesh)
        return _articulator(self.name, self.config).articulate(mesh)


@lru_cache(maxsize=2)
def _articulator(name: str, config: ParticulateConfig) -> Articulator:
    """Load one per process; the choice ignores the mesh, as none has an annotation."""
    corner = Mesh.from_triangles(np.eye(3), [[0, 1, 2]])
    nothing = Intake("case", corner, np.zeros(1, np.int64), np.eye(4), Provenance("case", ""))
    return choose(nothing, BuildConfig(articulator=name, particulate=config))
