"""Where the files of this repository are."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SAMPLES = ROOT / "tests" / "samples"
EXAMPLES = ROOT / "examples"
MESHES = EXAMPLES / "meshes"
FRIDGE = MESHES / "fridge.obj"
