"""What a node says of a call whose input or answer does not come through."""

import errno
import hashlib
import os
import pickle
from dataclasses import replace
from pathlib import Path
from unittest.mock import Mock

import pytest

from asset_factory.factory.jobs.ray.exchange import ExchangeError
from asset_factory.factory.jobs.ray.inputs import pack_input
from asset_factory.factory.jobs.ray.worker import Order, carry_out
from asset_factory.sim_checks.processes.isolation import Limits, Outcome

pytest.importorskip("ray")


@pytest.fixture
def sent(tmp_path):
    source = tmp_path / "meshes" / "thing.stl"
    source.parent.mkdir()
    source.write_text("solid thing")
    return pack_input(source, frozenset())


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
