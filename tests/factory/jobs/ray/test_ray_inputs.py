"""An input on a node is the one that was sent, whole, and nothing of it lies anywhere else.

What a node says of a call whose input or answer does not come through.
"""

import errno
import hashlib
import io
import os
import pickle
import tarfile
from dataclasses import replace
from pathlib import Path
from unittest.mock import Mock

import numpy as np
import pytest
from input_files import write_inputs
from laid import laid
from tiny_checkpoint import write_checkpoint

from asset_factory.factory.build import make_asset
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.intake.source import Source
from asset_factory.factory.jobs.ray.exchange import ExchangeError
from asset_factory.factory.jobs.ray.inputs import pack_input
from asset_factory.factory.jobs.ray.weights import arrived, sent_weights
from asset_factory.factory.jobs.ray.worker import Order, carry_out
from asset_factory.factory.models.weights.sources import fetch, weights_at
from asset_factory.sim_checks.config import CheckConfig
from asset_factory.sim_checks.judge import Judge
from asset_factory.sim_checks.processes.isolation import Limits, Outcome

CONFIG = BuildConfig(articulator="rigid", simulators=())


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    return write_inputs(tmp_path_factory.mktemp("here") / "meshes")


def packed(source, more=frozenset()):
    return pack_input(source, more)


def keys_of(source):
    """What an input is called, and what it was made of."""
    return source.id, source.unloaded_ids, source.loaded_key, source.reads


def loaded(source):
    """What is known of an input once it is loaded, or why it cannot be."""
    try:
        return source.load().provenance
    except Exception as error:  # noqa: BLE001 - whatever it is, it is the same here and there
        return str(error)


def read_there(source):
    """What a node says of an input, its keys there, and the rounds that it took."""
    more = frozenset()
    for rounds in range(1, 9):
        sent = packed(source, more)
        with sent.unpacked(sent.data) as path:
            there = Source(path, CONFIG, source)
            said = loaded(there)
            keys = keys_of(there)
        lacking = sent.lacking(there.reads)
        if not lacking:
            return said, keys, rounds
        more |= lacking
    raise AssertionError(f"{more}: sent again and again")


@pytest.mark.parametrize(
    ("name", "rounds"),
    [
        ("box_0.stl", 1),
        ("nothing.stl", 1),
        ("painted/painted.obj", 1),
        ("cart/cart.urdf", 1),
        ("leads_out/leads_out.obj", 1),
        ("strange/strange.obj", 2),
    ],
)
def test_a_node_reads_what_is_here(inputs, name, rounds):
    here = Source(inputs / name, CONFIG)
    said = loaded(here)
    assert read_there(inputs / name) == (said, keys_of(here), rounds)


def test_an_input_that_is_gone_is_the_same_everywhere(inputs):
    gone = inputs / "gone.stl"
    here = Source(gone, CONFIG)
    with pytest.raises(Exception, match="gone"):
        here.load()
    assert read_there(gone)[1] == keys_of(here)


def test_a_product_tells_where_its_input_lies_here(inputs, tmp_path):
    source = inputs / "box_0.stl"
    sent = packed(source)
    with sent.unpacked(sent.data) as path, Judge(CheckConfig()) as judge:
        product = make_asset(path, tmp_path / "staging", CONFIG, None, judge, source)
    assert product.result.input == str(source)


@pytest.mark.parametrize("folder", ["..", "", "fridges"])
def test_the_folder_keeps_its_name(inputs, folder):
    sent = packed(inputs / "box_0.stl")
    with replace(sent, source=Path(folder) / "box_0.stl").unpacked(sent.data) as path:
        assert path.read_bytes() == (inputs / "box_0.stl").read_bytes()
        assert path.parent.name == folder or not folder
        around = next(each for each in path.resolve().parents if each.name.startswith("input-"))
    assert not around.exists()


def test_no_input_leaves_its_folder(inputs):
    data = io.BytesIO()
    with tarfile.open(fileobj=data, mode="w:") as archive:
        archive.addfile(tarfile.TarInfo("../out"))
    digest = hashlib.sha256(data.getvalue()).hexdigest()
    forged = replace(packed(inputs / "box_0.stl"), digest=digest).unpacked(data.getvalue())
    with pytest.raises(ExchangeError, match="no file or folder below"), forged:
        pass


@pytest.fixture
def ray():
    """Keeps what is put, as Ray's object store does."""
    return Mock(put=lambda value: value, get=Mock(wraps=lambda value, timeout: value))


@pytest.fixture
def node(tmp_path, monkeypatch):
    """Temporary files of a node."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    return tmp_path


def test_a_checkpoint_is_fetched_once(ray, node, tmp_path_factory):
    named = write_checkpoint(tmp_path_factory.mktemp("weights") / "tiny.safetensors")
    content = named.read_bytes()
    sent = sent_weights(ray, (str(named), "", "shipped", "absent.pt"))
    assert [each[:2] for each in sent] == [(str(named), named.name)]
    named.unlink()
    for _ in range(2):
        places = arrived(ray, sent)
        with weights_at(places):
            assert fetch(str(named)).read_bytes() == content
            assert fetch(str(named)).name == named.name
    assert ray.get.call_count == 1
    (kept,) = places.values()
    assert kept.is_relative_to(node)
    kept.write_bytes(b"damaged")
    assert arrived(ray, sent)[str(named)].read_bytes() == content
    assert ray.get.call_count == 2


def test_another_checkpoint_than_was_sent_is_refused(ray, node):
    sent = [("w", "w.pt", "0" * 64, [np.zeros(3, np.uint8)])]
    with pytest.raises(ExchangeError, match="digest"):
        arrived(ray, sent)
    assert not list(node.rglob("w.pt"))


def test_an_input_too_large_to_send_is_refused_unread(tmp_path):
    vast = tmp_path / "vast.obj"
    with vast.open("wb") as file:
        file.truncate(2**40)
    with pytest.raises(ValueError, match=r"vast\.obj: its files have more than"):
        packed(vast)


@pytest.fixture
def sent(tmp_path):
    return packed(laid(tmp_path / "meshes" / "thing.stl", "solid thing"))


@pytest.fixture
def made(monkeypatch):
    """Calls in this process, whose outcome a test sets; each notes what it saw of its input."""
    seen = []

    def work(child, function, limits, *, retries, until):
        path = function.keywords["here"]["source"]
        seen.append((path, path.read_text()))
        return work.outcome

    work.seen = seen
    work.outcome = Outcome("value", None, "", "", 0.0)
    monkeypatch.setattr("asset_factory.factory.jobs.ray.worker._child", lambda modules: None)
    monkeypatch.setattr("asset_factory.factory.jobs.ray.worker.tried", work)
    return work


def ordered(sent, data=None, **changed):
    order = Order(len, {}, Limits(wall_s=9.0), 0, input=replace(sent, **changed))
    return carry_out(pickle.dumps(order), sent.data if data is None else data, [])


def test_an_input_is_there_for_its_call_alone(sent, made):
    assert ordered(sent) == ("done", made.outcome)
    ((path, text),) = made.seen
    assert text == "solid thing"
    assert not path.exists()


def test_an_input_that_arrives_damaged_is_lost(sent, made):
    word, why = ordered(sent, sent.data[:-1] + b"x")
    assert word == "lost"
    assert "digest" in why
    nothing = b"no archive"
    assert ordered(sent, nothing, digest=hashlib.sha256(nothing).hexdigest())[0] == "lost"
    assert made.seen == []


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT])
def test_a_node_without_room_for_an_input_is_full(sent, made, monkeypatch, number):
    monkeypatch.setattr(Path, "open", Mock(side_effect=OSError(number, os.strerror(number))))
    assert ordered(sent) == ("full", None)


@pytest.mark.parametrize(
    ("error", "answer"),
    [
        (OSError(errno.ENOSPC, "No space left on device"), ("full", None)),
        (ExchangeError("s3://bucket: no answer"), ("lost", "s3://bucket: no answer")),
    ],
)
def test_an_asset_without_room_or_that_cannot_be_sent_is_no_failure_of_its_input(
    sent, made, error, answer
):
    made.outcome = Outcome(None, "raised", str(error), "", 0.0, error)
    assert ordered(sent) == answer
