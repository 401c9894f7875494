"""Tensor files: read back what was written, refuse what is damaged, foreign or hostile.

What fuzzing found is among it, each once.
"""

import io
import struct
import sys
import time
import types
import zipfile
from collections import OrderedDict

import pytest
import torch  # noqa: TID253
from fuzz_cases import SHARED, locked, pickled_tensor, pickled_text, safetensors, zipped
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
#: Far more than the work takes, far less than what it took.
QUICK_S = 3.0


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


def require_refused(file, content, said):
    """At once, in a sentence that is not as long as the file."""
    file.write_bytes(content)
    started = time.process_time()
    with pytest.raises(ConfigError, match=said) as caught:
        open_checkpoint(file)
    assert time.process_time() - started < QUICK_S
    assert len(str(caught.value)) < 600


def test_what_was_written_is_read(stored):
    assert_same(loaded(stored))
    assert read_safetensors(stored).metadata == {"network": "none"}


def test_the_same_tensors_are_the_same_bytes_in_any_order(stored, tmp_path):
    other = tmp_path / "other.safetensors"
    write_safetensors(other, dict(reversed(TENSORS.items())), {"network": "none"})
    assert other.read_bytes() == stored.read_bytes()
    assert not list(tmp_path.glob(".writing-*"))


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
    require_refused(tmp_path / "mesh.stl", data, r"mesh\.stl: ")


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


def as_saved(thing, **settings):
    """What torch saves."""
    stream = io.BytesIO()
    torch.save(thing, stream, **settings)
    return stream.getvalue()


def repacked(part, change):
    """What torch saves, with the entries of that name changed; left out if by nothing."""
    with zipfile.ZipFile(io.BytesIO(as_saved({"half": TENSORS["half"]}))) as whole:
        members = {name: whole.read(name) for name in whole.namelist()}
    named = {name: change and change(data) for name, data in members.items() if part in name}
    return zipped({name: data for name, data in (members | named).items() if data is not None})


def described(description, **members):
    """An archive of one number with that description of it, and with more members."""
    archive = {"data.pkl": description, "version": b"3\n", **members, "data/0": bytes(4)}
    return zipped({f"archive/{name}": data for name, data in archive.items()})


def one_tensor(size=1, more=b""):
    return b"\x80\x02}(" + more + pickled_text("a") + pickled_tensor(0, (size,)) + b"u."


def calling(call):
    """An archive that would call something to make another of its values."""
    return described(one_tensor(more=pickled_text("b") + call))


def lying():
    """An archive whose last member is said to be far larger than it is."""
    data = bytearray(described(one_tensor(size=1_000_000)))
    for at in (data.rfind(b"PK\x01\x02") + 20, data.rfind(b"PK\x01\x02") + 24):
        struct.pack_into("<I", data, at, 4_000_000)
    return bytes(data)


WHOLE = as_saved(TENSORS)
#: A pair of the pair before, twice, sixty times: a few bytes with 2^60 leaves. By DUP, which torch
#: does not know, and in the way in which torch writes it.
LAUGH = b"(t" + b"2\x86" * 60
REMEMBERED = b"(t" + SHARED * 60
PAIRS = (b"}" + LAUGH + b"Ns", b"}" + REMEMBERED + b"Ns", REMEMBERED + b")R")
CALLS = (b"cos\nsystem\n(NtR", b"(Nios\nsystem\n", b"(cos\nsystem\nNo", b"(Nishutil\nrmtree\n")
#: The fault of a file said to be of torch -> the file, and the answer.
REFUSED = {
    "no tensor": (repacked("/data/", None), "failed locating file data/0"),
    "half a tensor": (
        repacked("/data/", lambda data: data[:1]),
        "bytes are missing, compressed or cut off",
    ),
    "no description": (repacked("data.pkl", None), "not one of torch.save"),
    "half a description": (repacked("data.pkl", lambda data: data[:9]), "cannot be read|cut off"),
    "garbage": (repacked("data.pkl", lambda _: b"garbage"), "cannot be read"),
    "another machine's": (repacked("byteorder", lambda _: b"big"), "big-endian"),
    # What is no short note is not even unpacked.
    "a long note": (repacked("byteorder", lambda _: b"little" + b" " * 5000), "big-endian"),
    **{f"cut at {at}": (WHOLE[: int(at * len(WHOLE))], "cut off") for at in (0.1, 0.5, 0.9, 0.99)},
    # A million rows that share one number take no room in a file, and gigabytes once they are
    # loaded.
    "shared rows": (
        as_saved({"wide": torch.zeros(1).expand(1_000_000, 1000)}),
        r"wide: shape .* does not fit the 1 numbers stored",
    ),
    "a list": (as_saved([1, 2]), "no mapping"),
    "a number": (as_saved({"epoch": 3}), "holds no tensors"),
    "the old format": (as_saved(TENSORS, _use_new_zipfile_serialization=False), "save it again"),
    "locked": (locked(described(one_tensor())), "unsupported encryption"),
    "lies": (lying(), r"does not fit|archive is corrupted"),
    # They are neither hashed nor printed.
    **{f"pairs {body[:3]}": (described(b"\x80\x02" + body + b"."), None) for body in PAIRS},
    **{
        f"call {call}": (calling(call), r"(os|posix)\.system|Unsupported operand") for call in CALLS
    },
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_torch_would_not_have_saved_is_refused(tmp_path, what):
    require_refused(tmp_path / "model.pt", *REFUSED[what])


def test_a_file_cannot_change_what_the_next_one_is_read_with(tmp_path):
    state = b"}" + pickled_text("dtype") + pickled_text("U8") + b"s"
    poison = b"\x80\x02}" + pickled_text("x") + b"ctorch\nFloatStorage\n" + state + b"bs."
    require_refused(tmp_path / "w.pt", described(poison), "Can only build Tensor")
    (tmp_path / "w.pt").write_bytes(described(one_tensor()))
    assert open_checkpoint(tmp_path / "w.pt").dtypes == {"a": "F32"}


def test_what_torch_would_call_is_a_stand_in(tmp_path):
    (tmp_path / "dear").mkdir()
    call = b"cshutil\nrmtree\n(" + pickled_text(str(tmp_path / "dear")) + b"tR"
    (tmp_path / "w.pt").write_bytes(calling(call))
    assert list(open_checkpoint(tmp_path / "w.pt").shapes) == ["a"]
    assert (tmp_path / "dear").is_dir()


def entry(shape, offsets=(0, 4)):
    return {"a": {"dtype": "F32", "shape": shape, "data_offsets": list(offsets)}}


@pytest.mark.parametrize(
    ("header", "said"),
    [
        *(
            (header, "not safetensors, damaged or cut off: ")
            for header in (
                entry([1], ("a", "b")),
                entry(["x"], (0, -1)),
                entry([-1], (0, -4)),
                entry([1.0], (0.0, 4.0)),
                entry([1] * 1000),
                entry([10**4000] * 1000),
            )
        ),
        # Nothing but brackets: refused before it is parsed.
        ([*[{}] * 1_000_001, 1], "invalid type: sequence"),
        ({"__metadata__": {"terms": {"a": 1}}}, "invalid type: map, expected a string"),
    ],
    ids=range(8),
)
def test_a_header_that_is_none_is_refused_at_once(tmp_path, header, said):
    require_refused(tmp_path / "w.safetensors", safetensors(header, bytes(16)), said)


def test_doubled_names_are_refused(tmp_path):
    twice = b'"a":{"dtype":"U8","shape":[1],"data_offsets":[0,1]}'
    text = b"{" + twice + b"," + twice + b"}"
    content = struct.pack("<Q", len(text)) + text + b"\0"
    require_refused(tmp_path / "twice.safetensors", content, "a appears twice")


def test_floats_become_float32_and_the_unwanted_stay_in_the_file(stored):
    tensors = load_tensors(open_checkpoint(stored), leave=("one.", "nothing"))
    found = {name: tensor.dtype for name, tensor in tensors.items()}
    assert found == {"steps": torch.int64, "mask": torch.bool, "half": torch.float32}
