"""What fuzzing found in the readers of checkpoints, each once."""

import struct
import time
import zipfile

import pytest
from fuzz_cases import SHARED, locked, pickled_tensor, pickled_text, safetensors

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.weights.checkpoint import open_checkpoint

pytestmark = pytest.mark.usefixtures("warm_reader")

#: Far more than the work takes, far less than what it took.
QUICK_S = 3.0


def torch_file(folder, description, **members):
    file = folder / "w.pt"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("archive/data.pkl", description)
        archive.writestr("archive/version", b"3\n")
        for name, data in members.items():
            archive.writestr(f"archive/{name}", data)
        archive.writestr(zipfile.ZipInfo("archive/data/0"), b"\0" * 4)
    return file


def one_tensor(size=1):
    return b"\x80\x02}" + pickled_text("a") + pickled_tensor(0, (size,)) + b"s."


#: A pair of the pair before, twice, sixty times: a few bytes with 2^60 leaves. By DUP, which torch
#: does not know, and in the way in which torch writes it.
LAUGH = b"(t" + b"2\x86" * 60
REMEMBERED = b"(t" + SHARED * 60


def test_a_file_cannot_change_what_the_next_one_is_read_with(tmp_path):
    state = b"}" + pickled_text("dtype") + pickled_text("U8") + b"s"
    poison = b"\x80\x02}" + pickled_text("x") + b"ctorch\nFloatStorage\n" + state + b"bs."
    with pytest.raises(ConfigError, match="Can only build Tensor"):
        open_checkpoint(torch_file(tmp_path, poison))
    sound = open_checkpoint(torch_file(tmp_path, one_tensor()))
    assert sound.dtypes == {"a": "F32"}


@pytest.mark.parametrize(
    "body", [b"}" + LAUGH + b"Ns", b"}" + REMEMBERED + b"Ns", REMEMBERED + b")R"]
)
def test_shared_pairs_are_neither_hashed_nor_printed(body, tmp_path):
    started = time.process_time()
    with pytest.raises(ConfigError) as caught:
        open_checkpoint(torch_file(tmp_path, b"\x80\x02" + body + b"."))
    assert time.process_time() - started < QUICK_S
    assert len(str(caught.value)) < 500


@pytest.mark.parametrize(
    "code", [b"cos\nsystem\n(NtR", b"(Nios\nsystem\n", b"(cos\nsystem\nNo", b"(Nishutil\nrmtree\n"]
)
def test_what_a_file_would_call_is_refused(code, tmp_path):
    body = pickled_text("b") + code + pickled_text("a") + pickled_tensor(0, (1,))
    with pytest.raises(ConfigError, match=r"os\.system|posix\.system|Unsupported operand"):
        open_checkpoint(torch_file(tmp_path, b"\x80\x02}(" + body + b"u."))


def test_what_torch_would_call_is_a_stand_in(tmp_path):
    (tmp_path / "dear").mkdir()
    call = b"cshutil\nrmtree\n(" + pickled_text(str(tmp_path / "dear")) + b"tR"
    body = pickled_text("b") + call + pickled_text("a") + pickled_tensor(0, (1,))
    found = open_checkpoint(torch_file(tmp_path, b"\x80\x02}(" + body + b"u."))
    assert list(found.shapes) == ["a"]
    assert (tmp_path / "dear").is_dir()


def test_a_bomb_beside_the_description_is_not_unpacked(tmp_path):
    with pytest.raises(ConfigError, match="big-endian"):
        open_checkpoint(torch_file(tmp_path, one_tensor(), byteorder=b"\0" * 50_000_000))


def test_a_locked_or_lying_archive_is_refused(tmp_path):
    data = torch_file(tmp_path, one_tensor()).read_bytes()
    (tmp_path / "locked.pt").write_bytes(locked(data))
    with pytest.raises(ConfigError, match="unsupported encryption"):
        open_checkpoint(tmp_path / "locked.pt")
    data = bytearray(torch_file(tmp_path, one_tensor(size=1_000_000)).read_bytes())
    for at in (data.rfind(b"PK\x01\x02") + 20, data.rfind(b"PK\x01\x02") + 24):
        struct.pack_into("<I", data, at, 4_000_000)
    (tmp_path / "lies.pt").write_bytes(data)
    with pytest.raises(ConfigError, match=r"does not fit|archive is corrupted"):
        open_checkpoint(tmp_path / "lies.pt")


def opened(folder, header):
    """A safetensors file of that header, looked into."""
    (folder / "w.safetensors").write_bytes(safetensors(header, bytes(16)))
    return open_checkpoint(folder / "w.safetensors")


@pytest.mark.parametrize(
    "entry",
    [
        {"dtype": "F32", "shape": [1], "data_offsets": ["a", "b"]},
        {"dtype": "F32", "shape": ["x"], "data_offsets": [0, -1]},
        {"dtype": "F32", "shape": [-1], "data_offsets": [0, -4]},
        {"dtype": "F32", "shape": [1.0], "data_offsets": [0.0, 4.0]},
        {"dtype": "F32", "shape": [1] * 1000, "data_offsets": [0, 4]},
        {"dtype": "F32", "shape": [10**4000] * 1000, "data_offsets": [0, 4]},
    ],
)
def test_sizes_that_are_no_sizes_are_refused_at_once(entry, tmp_path):
    started = time.process_time()
    with pytest.raises(ConfigError, match="not safetensors, damaged or cut off: ") as caught:
        opened(tmp_path, {"a": entry})
    assert time.process_time() - started < QUICK_S
    assert len(str(caught.value)) < 600


def test_a_header_of_nothing_but_brackets_is_refused_before_it_is_parsed(tmp_path):
    with pytest.raises(ConfigError, match="invalid type: sequence"):
        opened(tmp_path, [*[{}] * 1_000_001, 1])
    with pytest.raises(ConfigError, match="invalid type: map, expected a string"):
        opened(tmp_path, {"__metadata__": {"terms": {"a": 1}}})
