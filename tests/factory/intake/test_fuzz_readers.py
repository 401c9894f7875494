"""A small sample of ``benchmarks/soak/fuzz_readers.py``: every reading ends in a verdict.

The files are damaged or hostile.
"""

import socket
import subprocess
import sys
from itertools import chain, islice
from pathlib import Path

import fuzz_trial
import pytest
from fuzz_cases import seeds
from fuzz_hostile import MESH_PAGES
from fuzz_hostile_texts import TEXT_PAGES
from fuzz_hostile_usd import USD_PAGES
from fuzz_mutations import mutated
from fuzz_trial import try_case

from asset_factory.sim_checks.processes.isolation import Limits

LIMITS = Limits(wall_s=120.0, memory_bytes=4 * 2**30)
#: MuJoCo's compiler and USD need a child for each file: the benchmark has time for that.
QUICK = tuple(kind for kind in seeds() if not kind.startswith(("mjcf", "usd")))
USD = tuple(kind for kind in seeds() if kind.startswith("usd"))
#: Kind -> how many of it, where more than of others.
MOST = {"glb": 101}
#: Page of attacks -> every how many of its cases.
ATTACKS = {"references": 7, "gltf_counts": 6, "tables": 4, "names": 2, "sidecars": 5}
ATTACKS |= {"entities": 11, "predictions": 1, "usd_by_hand": 23}


def sample(number):
    """A hundred of GLB, whose JSON can be of any shape, ten of each other, some attacks by hand."""
    pages = {**MESH_PAGES, **TEXT_PAGES, **USD_PAGES}
    damaged = [mutated(seeds()[kind], k) for kind in QUICK for k in range(MOST.get(kind, 11))]
    damaged += [mutated(seeds()[kind], k) for kind in USD for k in range(3)]
    attacks = chain(*(islice(pages[page](), 0, None, every) for page, every in ATTACKS.items()))
    cases = (*damaged, *attacks)
    return [case for case in cases if not case.name.startswith(("mjcf", "npz-bomb"))][number::2]


def try_sample(number):
    return [try_case(case) for case in sample(number)]


@pytest.mark.parametrize("number", [0, 1])
def test_every_hostile_file_ends_in_a_verdict_and_touches_nothing_else(reading_child, number):
    trials = reading_child.call(try_sample, number, limits=LIMITS).unwrap()
    assert len(trials) > 140
    assert [(t.name, t.verdict, t.broke, t.detail) for t in trials if t.failed] == []
    verdicts = {trial.verdict for trial in trials}
    assert {"loaded", "unreadable", "external_reference", "bad_sidecar"} <= verdicts


#: What the watch says -> what a reader must not do in the folder of its input.
TRAITORS = {
    "looked into the folder outside": lambda folder: (
        folder.parent / "outside" / "secret.png"
    ).read_bytes(),
    "read /etc/hostname": lambda folder: Path("/etc/hostname").read_bytes(),
    "changed the input's folder": lambda folder: (folder / "new.txt").write_text("x"),
    "socket.connect": lambda folder: socket.socket().connect_ex(("127.0.0.1", 9)),
    "subprocess.Popen": lambda folder: subprocess.run([sys.executable, "--version"], check=True),
    "failed": lambda folder: {}["x"],
}


def try_traitor(name):
    """All that is said of one."""

    def read(path, folder):
        return fuzz_trial._judged(lambda: str(TRAITORS[name](folder)), ValueError)

    fuzz_trial._READERS["load"] = read
    trial = try_case(seeds()["off"])
    assert trial.failed
    return trial.verdict, *trial.broke


@pytest.mark.parametrize("name", TRAITORS)
def test_the_watch_sees_what_a_reader_must_not_do(reading_child, name):
    told = reading_child.call(try_traitor, name, limits=LIMITS).unwrap()
    assert any(name in said for said in told)
