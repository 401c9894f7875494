"""Write the demo meshes: ``python -m asset_factory.factory.training.objects FOLDER``."""

from __future__ import annotations

import sys
from pathlib import Path

from .examples import write_example_meshes

if len(sys.argv) != 2:
    sys.exit("usage: python -m asset_factory.factory.training.objects FOLDER")
write_example_meshes(Path(sys.argv[1]))
