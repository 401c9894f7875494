"""Tensor files: read back what was written, refuse what is damaged, foreign or hostile."""

import struct
import sys
import types
import zipfile
from collections import OrderedDict

import pytest
import torch  # noqa: TID253
from hypothesis import given, settings
from hypothesis import strategies as st

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.weights import pickled
from asset_factory.factory.models.weights.checkpoint import load_tensors, open_checkpoint
from asset_factory.factory.models.weights.pickled import unpack
from asset_factory.factory.models.weights.safetensors import read_safetensors, write_safetensors
from asset_factory.sim_checks.processes.isolation import Failure, Outcome

pytestmark = pytest.mark.usefixtures("warm_reader")

TENSORS = {
    "one.weight": torch.arange(6.0).reshape(2, 3),
    "one.bias": torch.tensor([0.5, -1.0]).bfloat16(),
    "steps": torch.tensor(7),
    "nothing": torch.zeros(0, 4),
    "mask": torch.tensor([True, False, True]),
    "half": torch.tensor([1.5]).half(),
}


@pytest.fixture
def stored(tmp_path):
    file = tmp_path / "weights.safetensors"
    write_safetensors(file, TENSORS, {"network": "none"})
    return file


def loaded(file):
    return open_checkpoint(file).load()


def assert_same(found, wanted=TENSORS):
    assert set(found) == set(wanted)
    for name, tensor in wanted.items():
        assert found[name].dtype == tensor.dtype, name
        assert torch.equal(found[name], tensor), name


def test_what_was_written_is_read(stored):
    assert_same(loaded(stored))
    assert read_safetensors(stored).metadata == {"network": "none"}


def test_the_same_tensors_are_the_same_bytes_in_any_order(stored, tmp_path):
    other = tmp_path / "other.safetensors"
    write_safetensors(other, dict(reversed(TENSORS.items())), {"network": "none"})
    assert other.read_bytes() == stored.read_bytes()
    assert not list(tmp_path.glob(".writing-*"))


def test_files_of_the_formats_own_library_are_read(fixtures):
    checkpoint = open_checkpoint(fixtures / "pat_tiny" / "weights_seed0.safetensors")
    tensors = load_tensors(checkpoint)
    assert len(tensors) == 116
    assert tensors["pos_embed.mlp.0.weight"].shape == (48, 195)


@settings(max_examples=60)
@given(share=st.floats(0.0, 0.999))
def test_a_file_cut_anywhere_is_refused(tmp_path_factory, share):
    folder = tmp_path_factory.mktemp("cut")
    whole = folder / "whole.safetensors"
    cut = folder / "cut.safetensors"
    write_safetensors(whole, TENSORS, {})
    data = whole.read_bytes()
    cut.write_bytes(data[: int(share * len(data))])
    with pytest.raises(ConfigError, match=r"cut off|too few"):
        loaded(cut)


@pytest.mark.parametrize(
    "data", [b"", b"abc", b"solid cube facet normal 0 0 0", bytes(64), b"\xff" * 64]
)
def test_what_is_no_checkpoint_is_refused(tmp_path, data):
    file = tmp_path / "mesh.stl"
    file.write_bytes(data)
    with pytest.raises(ConfigError, match=r"mesh\.stl: "):
        open_checkpoint(file)


def test_doubled_names_are_refused(tmp_path):
    file = tmp_path / "twice.safetensors"
    entry = b'"a":{"dtype":"U8","shape":[1],"data_offsets":[0,1]}'
    text = b"{" + entry + b"," + entry + b"}"
    file.write_bytes(struct.pack("<Q", len(text)) + text + b"\0")
    with pytest.raises(ConfigError, match="a appears twice"):
        open_checkpoint(file)


BASE = torch.arange(12.0).reshape(3, 4)
VIEWS = {"turned": BASE.T, "tail": BASE[1:, 2], "own": torch.nn.Parameter(BASE)}


@pytest.mark.parametrize(
    ("saved", "wanted"),
    [
        (OrderedDict(TENSORS), TENSORS),
        ({"state_dict": TENSORS, "callbacks": {"best": 0.5}, ("epoch", 1): 3}, TENSORS),
        (VIEWS, {name: tensor.detach() for name, tensor in VIEWS.items()}),
    ],
    ids=["tensors", "a state", "views and parameters"],
)
def test_what_torch_saves_is_read(tmp_path, saved, wanted):
    torch.save(saved, tmp_path / "model.pt")
    assert_same(loaded(tmp_path / "model.pt"), wanted)


def test_settings_of_unknown_classes_are_passed_over(tmp_path, monkeypatch):
    file = tmp_path / "trained.ckpt"
    # As trainers store their configuration: in a class of a library that nobody here has.
    library = types.ModuleType("yacs.config")
    library.CfgNode = type("CfgNode", (dict,), {"__module__": "yacs.config"})
    monkeypatch.setitem(sys.modules, "yacs", types.ModuleType("yacs"))
    monkeypatch.setitem(sys.modules, "yacs.config", library)
    configuration = library.CfgNode(rate=0.1, nested=library.CfgNode(deep=[1, 2]))
    configuration.frozen = True
    more = {"hyper_parameters": configuration, "dtypes": torch.float64}
    torch.save({"state_dict": TENSORS, **more}, file)
    monkeypatch.undo()
    assert "yacs.config" not in sys.modules
    assert_same(loaded(file))


def test_a_reader_is_not_kept_where_nobody_asks_for_it(tmp_path, monkeypatch):
    monkeypatch.undo()
    file = tmp_path / "model.pt"
    torch.save(TENSORS, file)
    assert_same(loaded(file))


def test_without_torch_the_remedy_is_named(tmp_path, monkeypatch):
    file = tmp_path / "model.pt"
    torch.save(TENSORS, file)
    monkeypatch.setitem(sys.modules, "torch", None)
    with pytest.raises(ConfigError, match="pip install torch"):
        unpack(file, tmp_path / "to.safetensors", 5)


def test_a_file_that_takes_too_long_is_given_up(tmp_path, monkeypatch):
    torch.save(TENSORS, tmp_path / "model.pt")
    killed = Outcome(None, Failure.CRASHED, "killed", "", 1.0)
    monkeypatch.setattr(pickled, "run_isolated", lambda *_args, **_limits: killed)
    with pytest.raises(ConfigError, match="cannot be read within 1 s and 1 GiB: killed"):
        open_checkpoint(tmp_path / "model.pt")


def test_what_was_read_once_is_known_until_the_file_changes(tmp_path, monkeypatch):
    file = tmp_path / "model.pt"
    torch.save({"a": torch.ones(2)}, file)
    assert open_checkpoint(file).shapes == {"a": (2,)}
    with monkeypatch.context() as patch:
        patch.setattr(pickled, "run_isolated", None)
        assert open_checkpoint(file).shapes == {"a": (2,)}
    torch.save({"a": torch.ones(3)}, file)
    assert open_checkpoint(file).shapes == {"a": (3,)}


def repacked(source, target, part, change):
    """A copy of a zip archive whose entries of that name are changed; left out if by nothing."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for info in old.infolist():
            data = old.read(info)
            if part not in info.filename:
                new.writestr(info.filename, data)
            elif change is not None:
                new.writestr(info.filename, change(data))


@pytest.mark.parametrize(
    ("part", "change", "says"),
    [
        ("/data/", None, "failed locating file data/0"),
        ("/data/", lambda data: data[:1], "bytes are missing, compressed or cut off"),
        ("data.pkl", None, "not one of torch.save"),
        ("byteorder", lambda _: b"big", "big-endian"),
        ("data.pkl", lambda data: data[:9], "cannot be read|cut off"),
        ("data.pkl", lambda _: b"garbage", "cannot be read"),
    ],
)
def test_a_damaged_archive_is_refused(tmp_path, part, change, says):
    torch.save({"half": TENSORS["half"]}, tmp_path / "whole.pt")
    repacked(tmp_path / "whole.pt", tmp_path / "damaged.pt", part, change)
    with pytest.raises(ConfigError, match=says):
        loaded(tmp_path / "damaged.pt")


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.99])
def test_an_archive_that_is_cut_off_is_refused(tmp_path, share):
    torch.save(TENSORS, tmp_path / "whole.pt")
    data = (tmp_path / "whole.pt").read_bytes()
    (tmp_path / "cut.pt").write_bytes(data[: int(share * len(data))])
    with pytest.raises(ConfigError, match="cut off"):
        open_checkpoint(tmp_path / "cut.pt")


@pytest.mark.parametrize(
    ("saved", "says"),
    [
        # A million rows that share one number take no room in a file, and gigabytes once they are
        # loaded.
        (
            {"wide": torch.zeros(1).expand(1_000_000, 1000)},
            r"wide: shape .* does not fit the 1 numbers stored",
        ),
        ([1, 2], "no mapping"),
        ({"epoch": 3}, "holds no tensors"),
    ],
)
def test_what_holds_no_tensors_as_they_are_stored_is_refused(tmp_path, saved, says):
    torch.save(saved, tmp_path / "model.pt")
    with pytest.raises(ConfigError, match=says):
        open_checkpoint(tmp_path / "model.pt")


def test_the_old_format_says_what_to_do(tmp_path):
    torch.save(TENSORS, tmp_path / "old.pt", _use_new_zipfile_serialization=False)
    with pytest.raises(ConfigError, match="save it again"):
        open_checkpoint(tmp_path / "old.pt")


def test_floats_become_float32_and_the_unwanted_stay_in_the_file(stored):
    tensors = load_tensors(open_checkpoint(stored), leave=("one.", "nothing"))
    found = {name: tensor.dtype for name, tensor in tensors.items()}
    assert found == {"steps": torch.int64, "mask": torch.bool, "half": torch.float32}
