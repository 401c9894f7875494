"""The network runs on a GPU that is there and computes, else on the CPU; the user may say."""

from contextlib import nullcontext
from types import SimpleNamespace

import pytest

from asset_factory.factory.cli.flags import InputFlags, input_config
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.particulate import device


@pytest.fixture(autouse=True)
def _forgotten():
    device.works.cache_clear()
    yield
    device.works.cache_clear()


@pytest.mark.parametrize(
    ("works", "taken"), [(("cuda", "mps"), "cuda"), (("mps",), "mps"), ((), "cpu")]
)
def test_auto_takes_the_first_device_that_works(works, taken, monkeypatch, tmp_path):
    monkeypatch.setattr(device, "GPU_FILES", (str(tmp_path),))

    def tried(function, name, limits):
        return SimpleNamespace(value=True if name.split(":")[0] in works else None)

    monkeypatch.setattr(device, "run_isolated", tried)
    assert input_config(InputFlags()).particulate.device == taken
    named = InputFlags(device="cuda:1")
    assert input_config(named, here=False).particulate.device == "cuda:1"
    with nullcontext() if taken == "cuda" else pytest.raises(ConfigError, match="no cuda:1 here"):
        assert input_config(named).particulate.device == "cuda:1"
    with pytest.raises(ConfigError, match="must be auto, cpu, cuda"):
        input_config(InputFlags(device="gpu"))


def test_without_a_gpu_torch_is_not_asked(monkeypatch):
    monkeypatch.setattr(device, "GPU_FILES", ())
    monkeypatch.setattr(device, "run_isolated", None)
    assert device.device_for("auto") == "cpu"


def test_the_trial_itself_finds_no_gpu_where_torch_has_none():
    import torch

    assert device.runs_on("cuda") is torch.cuda.is_available()
