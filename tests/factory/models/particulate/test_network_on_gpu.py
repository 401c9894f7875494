"""The network on a GPU: the answers of a processor, up to what its precision rounds off."""

import numpy as np
import pytest
from tiny_checkpoint import write_checkpoint

torch = pytest.importorskip("torch")

from ray_calls import answer  # noqa: E402 - after the skip

from asset_factory.factory.config import ParticulateConfig  # noqa: E402

if not torch.cuda.is_available():
    pytest.skip("no GPU here: torch sees no CUDA device", allow_module_level=True)


@pytest.mark.parametrize(("precision", "share"), [("float32", 1e-3), ("bfloat16", 0.02)])
def test_a_gpu_says_what_a_processor_says(tmp_path, precision, share):
    checkpoint = str(write_checkpoint(tmp_path / "tiny.safetensors", base=7))
    settings = {"checkpoint": checkpoint, "points": 300, "context_points": 300}
    here, there = (
        np.frombuffer(answer(ParticulateConfig(**settings, **more), None)[0], np.float32)
        for more in ({}, {"device": "cuda", "precision": precision})
    )
    assert np.abs(there - here).max() < share * max(np.abs(here).max(), 1.0)
