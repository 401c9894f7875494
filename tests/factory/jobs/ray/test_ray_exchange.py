"""What comes back from a node is what was sent, lies where it should, and can do no harm."""

import io
import tarfile
from dataclasses import replace
from types import SimpleNamespace
from unittest.mock import Mock

import pytest
import ray_calls

from asset_factory.factory.jobs.ray.exchange import (
    ExchangeError,
    begin_transfer,
    make_and_send,
    unpacked,
    with_own_folder,
)
from asset_factory.sim_checks.processes.isolation import Failure, Outcome


@pytest.fixture
def between(tmp_path):
    folder = tmp_path / "between"
    folder.mkdir()
    return folder


def filling(folder, size=10):
    return {"source": "it", "staging": folder, "size": size}


def made(url, arguments):
    """The outcome of a call made on a node, and what opens it."""
    sent, transfer = begin_transfer(url, ray_calls.fill, with_own_folder(arguments))
    return Outcome(make_and_send(**sent), None, "", "", 0.0), transfer


def test_a_shared_folder_holds_each_try_apart(tmp_path):
    tries = [with_own_folder(filling(tmp_path / "staging")) for _ in range(2)]
    folders = {ray_calls.fill(**each).bundle for each in tries}
    assert len(folders) == 2
    assert all(each.is_relative_to(tmp_path / "staging") and each.is_dir() for each in folders)


def test_a_folder_that_is_sent_arrives_whole_and_leaves_nothing(tmp_path, between):
    outcome, transfer = made(between.as_uri(), filling(tmp_path / "staging", 5000))
    assert not (tmp_path / "staging").exists(), "nothing is written there but by the caller"
    filled = transfer.opened(outcome).unwrap()
    assert filled.bundle.is_relative_to(tmp_path / "staging")
    found = sorted(path.relative_to(filled.bundle).as_posix() for path in filled.bundle.rglob("*"))
    assert found == ["meshes", "meshes/a.bin", "robot.urdf"]
    assert (filled.bundle / "meshes" / "a.bin").read_bytes() == bytes(range(256)) * 5000
    assert not list(between.iterdir())


def test_nodes_are_not_told_of_places_that_only_the_caller_sees(tmp_path, between):
    shared = with_own_folder({**filling(tmp_path / "staging"), "cache": tmp_path / "cache"})
    assert shared["cache"] == tmp_path / "cache"
    sent, _ = begin_transfer(between.as_uri(), ray_calls.fill, shared)
    assert sent["arguments"]["cache"] is None


def test_a_failed_call_keeps_its_failure(tmp_path, between):
    _, transfer = begin_transfer(between.as_uri(), ray_calls.fill, filling(tmp_path))
    failed = Outcome(None, Failure.TIMEOUT, "no answer", "", 1.0)
    assert transfer.opened(failed) == failed


@pytest.mark.parametrize("damage", ["altered", "cut", "longer", "gone"])
def test_another_file_than_was_sent_is_no_answer(tmp_path, between, damage):
    outcome, transfer = made(between.as_uri(), filling(tmp_path / "staging"))
    (file,) = between.iterdir()
    data = file.read_bytes()
    changed = {"altered": data[:-1] + b"x", "cut": data[:-1], "longer": data + b"x"}
    file.unlink() if damage == "gone" else file.write_bytes(changed[damage])
    with pytest.raises(OSError, match="another" if damage != "gone" else "No such file"):
        transfer.opened(outcome)
    assert not list(between.iterdir())


def test_what_cannot_be_sent_is_told_from_a_call_that_fails(tmp_path):
    nowhere = (tmp_path / "gone").as_uri()
    with pytest.raises(ExchangeError, match="gone"):
        made(nowhere, filling(tmp_path / "staging"))


def test_a_store_that_does_not_answer_loses_a_try(tmp_path, between, monkeypatch):
    outcome, transfer = made(between.as_uri(), filling(tmp_path / "staging"))
    fails = Mock(side_effect=LookupError("of its own kind"))
    silent = SimpleNamespace(open=fails, rm_file=fails)
    located = "asset_factory.factory.jobs.ray.exchange.located"
    monkeypatch.setattr(located, lambda url: (silent, url))
    with pytest.raises(OSError, match="of its own kind"):
        transfer.opened(outcome)


def test_more_than_can_be_is_not_fetched(tmp_path, between):
    outcome, transfer = made(between.as_uri(), filling(tmp_path / "staging"))
    with pytest.raises(OSError, match="at most"):
        transfer.opened(replace(outcome, value=replace(outcome.value, size=2**50)))


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("../out", tarfile.REGTYPE),
        ("/out", tarfile.REGTYPE),
        ("a/../../out", tarfile.REGTYPE),
        ("link", tarfile.SYMTYPE),
        ("hard", tarfile.LNKTYPE),
        ("pipe", tarfile.FIFOTYPE),
        ("device", tarfile.CHRTYPE),
    ],
)
def test_an_archive_writes_nowhere_else(tmp_path, name, kind):
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w:") as archive:
        member = tarfile.TarInfo(name)
        member.type = kind
        member.linkname = "/etc/passwd"
        archive.addfile(member)
    packed.seek(0)
    (tmp_path / "in").mkdir()
    refused = pytest.raises(ExchangeError, match="no file or folder below")
    with tarfile.open(fileobj=packed) as archive, refused:
        unpacked(archive, tmp_path / "in")
    assert [path.name for path in tmp_path.rglob("*")] == ["in"]
