"""A small sample of ``benchmarks/soak/fuzz_readers.py``: every reading ends in a verdict.

The files are damaged or hostile.
"""

from itertools import chain, islice

import pytest
from fuzz_cases import seeds
from fuzz_hostile import MESH_PAGES
from fuzz_hostile_texts import TEXT_PAGES
from fuzz_hostile_usd import USD_PAGES
from fuzz_mutations import mutated
from fuzz_trial import try_case

from asset_factory.sim_checks.processes.isolation import Limits, WarmChild

LIMITS = Limits(wall_s=120.0, memory_bytes=4 * 2**30)
#: MuJoCo's compiler and USD need a child for each file: the benchmark has time for that.
QUICK = tuple(kind for kind in seeds() if not kind.startswith(("mjcf", "usd")))
USD = tuple(kind for kind in seeds() if kind.startswith("usd"))
#: Page of attacks -> every how many of its cases.
ATTACKS = {"references": 7, "gltf_counts": 6, "tables": 4, "names": 2, "sidecars": 5}
ATTACKS |= {"entities": 11, "predictions": 11, "usd_by_hand": 23}


def sample(number):
    """Ten of each kind, and some attacks by hand."""
    pages = {**MESH_PAGES, **TEXT_PAGES, **USD_PAGES}
    damaged = [mutated(seeds()[kind], k) for kind in QUICK for k in range(11)]
    damaged += [mutated(seeds()[kind], k) for kind in USD for k in range(3)]
    attacks = chain(*(islice(pages[page](), 0, None, every) for page, every in ATTACKS.items()))
    cases = (*damaged, *attacks)
    return [case for case in cases if not case.name.startswith(("mjcf", "npz-bomb"))][number::2]


def try_sample(number):
    return [try_case(case) for case in sample(number)]


@pytest.fixture(scope="module")
def child():
    with WarmChild() as child:
        yield child


@pytest.mark.parametrize("number", [0, 1])
def test_every_hostile_file_ends_in_a_verdict_and_touches_nothing_else(child, number):
    trials = child.call(try_sample, number, limits=LIMITS).unwrap()
    assert len(trials) > 140
    assert [(t.name, t.verdict, t.broke, t.detail) for t in trials if t.failed] == []
    verdicts = {trial.verdict for trial in trials}
    assert {"loaded", "unreadable", "external_reference", "bad_sidecar"} <= verdicts


def try_traitors():
    """What the watch says of readers that do what they must not."""
    import socket
    import subprocess
    import sys

    import fuzz_trial

    def read_outside(path, folder):
        (folder.parent / "outside" / "secret.png").read_bytes()
        return "loaded", ""

    def read_elsewhere(path, folder):
        open("/etc/hostname", "rb").close()
        return "loaded", ""

    def write_beside(path, folder):
        (folder / "new.txt").write_text("x")
        return "loaded", ""

    def ask(path, folder):
        with socket.socket() as stranger:
            stranger.settimeout(0.1)
            stranger.connect_ex(("127.0.0.1", 9))
        return "loaded", ""

    def run(path, folder):
        subprocess.run([sys.executable, "--version"], check=True)
        return "loaded", ""

    def raise_oddly(path, folder):
        return fuzz_trial._judged(lambda: {}["x"], ValueError)

    broke = []
    for traitor in (read_outside, read_elsewhere, write_beside, ask, run, raise_oddly):
        fuzz_trial._READERS["load"] = traitor
        trial = fuzz_trial.try_case(seeds()["off"])
        assert trial.failed, traitor
        broke.append((trial.verdict, *trial.broke))
    return broke


def test_the_watch_sees_what_a_reader_must_not_do(child):
    outside, elsewhere, beside, asked, ran, odd = child.call(try_traitors, limits=LIMITS).unwrap()
    child.close()
    assert "looked into the folder outside" in outside
    assert "read /etc/hostname" in elsewhere
    assert "changed the input's folder" in beside
    assert any("socket.connect" in said for said in asked)
    assert any("subprocess.Popen" in said for said in ran)
    assert odd[0] == "failed"
