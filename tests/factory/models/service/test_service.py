"""One network for many callers: the same bits as locally, and local if the service fails."""

import json
import os
import signal
import socket
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields
from unittest.mock import Mock

import numpy as np
import pytest
from random_network import cloud_of, random_network
from tiny_checkpoint import write_checkpoint

from asset_factory.factory.articulate.particulate import load_articulator
from asset_factory.factory.config import ParticulateConfig
from asset_factory.factory.models.particulate.loading import load_network
from asset_factory.factory.models.particulate.prediction import Prediction
from asset_factory.factory.models.service import Address, ModelService, asking, network_for, wire
from asset_factory.factory.models.service.answering import Answering, LoadedNetwork
from asset_factory.factory.models.service.process import answer_all, listening_socket
from asset_factory.factory.models.service.wire import Message, WireError, pack, unpack


def equal(one, other):
    pairs = [(getattr(one, each.name), getattr(other, each.name)) for each in fields(Prediction)]
    return all(a is b is None or np.array_equal(a, b) for a, b in pairs)


def not_at_home():
    raise AssertionError("the network at home was asked")


@pytest.fixture
def config(tmp_path):
    checkpoint = write_checkpoint(tmp_path / "tiny.safetensors")
    return ParticulateConfig(checkpoint=str(checkpoint), points=64)


def test_a_loaded_network_multiplies_with_one_thread(config):
    import torch

    before = torch.get_num_threads()
    torch.set_num_threads(2)
    try:
        load_network(config)
        assert torch.get_num_threads() == 1
    finally:
        torch.set_num_threads(before)


@pytest.fixture
def serving(tmp_path):
    """A network served by threads of this process: ``serving(network)`` gives the address."""
    opened = []

    def serve(network, identity="it", answering=None, **settings):
        listening = listening_socket(str(tmp_path / "socket"))
        opened.append(listening)
        loaded = LoadedNetwork(network, identity, threading.BoundedSemaphore(2))
        answering = answering or Answering(lambda: loaded)
        call = {"args": (listening, answering), "kwargs": settings}
        threading.Thread(target=answer_all, **call, daemon=True).start()
        return Address(str(tmp_path / "socket"), start_s=0.2, answer_s=20.0)

    yield serve
    for listening in opened:
        listening.shutdown(socket.SHUT_RDWR)
        listening.close()


def test_a_served_network_gives_the_same_bits(serving):
    cloud = cloud_of(500)
    context = cloud_of(200, 1)
    with asking(serving(random_network)):
        served = network_for("it", not_at_home)
    assert equal(served(cloud, context), random_network(cloud, context))


def test_many_askers_at_once_each_get_their_own_answer(serving):
    clouds = [(cloud_of(100 + number, number), cloud_of(50, number)) for number in range(16)]
    with asking(serving(random_network)):
        served = [network_for("it", not_at_home) for _ in clouds]
    with ThreadPoolExecutor(len(clouds)) as pool:
        answers = pool.map(lambda ask, both: ask(*both), served, clouds)
    assert all(
        equal(answer, random_network(*both)) for answer, both in zip(answers, clouds, strict=True)
    )


def test_without_a_service_the_network_is_ones_own():
    assert network_for("it", lambda: "own") == "own"


@pytest.mark.parametrize(
    "wrong", ["nobody listens", "another network", "it breaks", "it says nonsense", "full"]
)
def test_where_the_service_is_no_help_the_network_at_home_answers(serving, tmp_path, wrong):
    cloud = cloud_of(50)
    address = Address(str(tmp_path / "gone" / "socket"), start_s=30.0)
    if wrong == "another network":
        address = serving(random_network, identity="other")
    elif wrong == "it breaks":
        address = serving(Mock(side_effect=MemoryError("no room")))
    elif wrong == "full":
        address = serving(random_network, most_askers=0)
    elif wrong == "it says nonsense":
        address = serving(random_network, answering=lambda _: b"\xff" * 100)
    home = Mock(return_value=random_network)
    with asking(address):
        served = network_for("it", home)
    began = time.monotonic()
    assert equal(served(cloud, cloud), random_network(cloud, cloud))
    served(cloud, cloud)
    assert home.call_count == 1, "loaded once, asked twice"
    assert time.monotonic() - began < 10.0, "a service that is gone for good is not waited for"


def test_a_service_is_told_which_parts_are_to_be_dissolved(serving):
    hearing = Mock(wraps=random_network)
    with asking(serving(hearing)):
        served = network_for("it", not_at_home)
    served(cloud_of(20), cloud_of(20), 0.1)
    (heard,) = hearing.call_args_list
    assert heard.args[2] == 0.1


def test_messages_come_back_as_they_were():
    arrays = {"a": np.ones((2, 3), np.float32), "b": np.zeros((0, 4), np.int64), "c": np.array(3)}
    message = unpack(pack(Message({"x": "y"}, arrays)))
    assert message.texts == {"x": "y"}
    assert all(np.array_equal(message.arrays[name], array) for name, array in arrays.items())
    # So does what is written here as those below are.
    assert unpack(array("F32", [1], b"1234")).arrays["a"].shape == (1,)


def header(text, body=b""):
    return len(text).to_bytes(8, "little") + text + body


def array(dtype, shape, body):
    described = {"dtype": dtype, "shape": shape, "data_offsets": [0, len(body)]}
    return header(json.dumps({"__metadata__": {}, "a": described}).encode(), body)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\x01\x00\x00",
        b"\xff" * 8,
        # The library writes texts in any order: an id of bytes would differ between workers.
        pytest.param(pack(Message({"x": "y"}))[:-1], id="cut off"),
        pack(Message({}, {"a": np.zeros(9)}))[:-1],
        header(b"{}"),
        header(b"not json"),
        header(b"[" * 50000),
        header(b'{"__metadata__": {"x": 1}}'),
        header(b'{"__metadata__": {"x": {"a": "b"}}}'),
        array("|O", [1], b"12345678"),
        array("BF16", [4], b"12345678"),
        array("F32", [-1], b"1234"),
        array("F32", [9999999999, 9999999999], b"1234"),
        array("F32", [1], b"12345678"),
    ],
)
def test_what_is_no_message_is_refused(data):
    with pytest.raises(WireError):
        unpack(data)


def test_a_header_that_is_too_long_is_not_even_parsed():
    told = json.dumps({"__metadata__": {"more": "y" * wire.MOST_HEADER_BYTES}})
    with pytest.raises(WireError, match="at most"):
        unpack(header(told.encode()))


@pytest.mark.parametrize(
    ("said", "leaves", "error"),
    [
        (bytes(1001), False, WireError),
        (b"", True, ConnectionResetError),
        (b"1", False, TimeoutError),
    ],
    ids=["says too much", "leaves without a word", "dawdles"],
)
def test_who_does_not_ask_is_not_answered(monkeypatch, said, leaves, error):
    monkeypatch.setattr(wire, "MOST_BYTES", 1000)
    here, there = socket.socketpair()
    with here, there:
        there.sendall(said)
        if leaves:
            there.close()
        with pytest.raises(error, match="at most" if error is WireError else None):
            wire.receive(here, time.monotonic() + 0.1)


def test_a_killed_service_starts_again_and_a_stopped_one_leaves_nothing(config):
    own = load_network(config)
    cloud = cloud_of(600)
    with ModelService(config) as service:
        for _ in range(2):
            with asking(service.address):
                served = load_articulator(config).network
            assert equal(served(cloud, cloud), own(cloud, cloud))
            assert served._own is None, "the service answered"
            pid = service.pid
            os.kill(pid, signal.SIGKILL)
            while service.pid in (pid, None):
                time.sleep(0.01)
        folder = os.path.dirname(service.address.path)
    assert not os.path.exists(folder)
    assert service.pid is None


def test_a_service_that_nobody_asks_loads_nothing(config):
    with ModelService(config) as service:
        while not os.path.exists(service.address.path):
            time.sleep(0.01)
        with open(f"/proc/{service.pid}/maps") as loaded:
            assert "libtorch" not in loaded.read()


def test_a_service_whose_weights_cannot_be_read_is_given_up(tmp_path):
    nowhere = ParticulateConfig(checkpoint=str(tmp_path / "none.safetensors"))
    with ModelService(nowhere) as service, asking(service.address):
        served = network_for("it", lambda: random_network)
        assert served(cloud_of(20), cloud_of(20)).part_count > 0
