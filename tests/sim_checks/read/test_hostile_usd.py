"""A damaged USD file gets a verdict in a sentence, whatever its library makes of it."""

import os
import signal

import pytest

pytest.importorskip("pxr")
from fuzz_cases import usd_files
from fuzz_hostile_usd import laughs
from refusing import refusal

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.intake.load import load
from asset_factory.sim_checks import Status
from asset_factory.sim_checks.description import DescriptionError
from asset_factory.sim_checks.processes.isolation import Limits, WarmChild
from asset_factory.sim_checks.read.native import ask_of, memory_bounded
from asset_factory.sim_checks.read.usd.refusing import refusing

SHORT = Limits(wall_s=60.0)


@pytest.mark.parametrize("kind", ["usda", "usdc", "usdz"])
def test_a_damaged_file_is_rejected_with_a_code_and_its_librarys_words(tmp_path, judge, kind):
    whole = usd_files()[kind]
    path = tmp_path / f"thing.{kind}"
    path.write_bytes(whole[: len(whole) // 2] + b"\0" * 64)
    report = judge.check(path, ())
    assert (report.status, report.findings[0].code) == (Status.REJECTED, "unreadable")
    assert report.description == path.name
    assert "in file" not in report.findings[0].message
    rejected = refusal(load, path, IntakeConfig())
    assert rejected.code == "unreadable"
    assert str(tmp_path) not in rejected.message


def test_prims_that_multiply_are_counted_before_they_are_composed(tmp_path):
    path = tmp_path / "thing.usda"
    path.write_text("#usda 1.0\n" + laughs(9, 10))
    rejected = refusal(load, path, IntakeConfig())
    assert rejected.code == "too_large"
    assert "prims once composed" in rejected.message
    path.write_text("#usda 1.0\n" + laughs(3, 3))
    load(path, IntakeConfig())


class Unpicklable(Exception):
    def __reduce__(self):
        raise TypeError("no pickle")


def die(times):
    with times.open("a") as file:
        file.write("x")
    os.kill(os.getpid(), signal.SIGSEGV)


def raise_oddly(folder):
    with refusing("thing.usd", folder):
        raise Unpicklable(f"something of {folder}/thing.usd")


def take_memory(folder):
    with refusing("thing.usd", folder), memory_bounded(2**28):
        bytearray(2**30)


def be_killed(folder):
    os.kill(os.getpid(), signal.SIGKILL)


def test_whatever_a_reader_raises_or_dies_of_is_a_sentence(tmp_path):
    with WarmChild() as child:
        for function, given, said in (
            (raise_oddly, tmp_path, r"unreadable: thing\.usd: .*something of /thing"),
            (take_memory, tmp_path, r"too_large: thing\.usd"),
            (die, tmp_path / "times", r"unreadable: thing\.usd: .*SIGSEGV"),
        ):
            with pytest.raises(DescriptionError, match=said):
                ask_of(child, "thing.usd", function, given, limits=SHORT)
        assert (tmp_path / "times").read_text().count("x") >= 2
        with pytest.raises(ChildProcessError):
            ask_of(child, "thing.usd", be_killed, tmp_path, limits=SHORT)
