"""A short MJCF that becomes a million bodies is refused by counting or by memory, never by time."""

import time
from dataclasses import replace

import pytest
from refusing import judges_refusal, refusal

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.intake.load import load
from asset_factory.sim_checks.description import DescriptionError
from asset_factory.sim_checks.processes.isolation import Failure, Outcome, run_isolated
from asset_factory.sim_checks.read import multiplied, native
from asset_factory.sim_checks.read.document import parse_document
from asset_factory.sim_checks.read.multiplied import refuse_multiplied
from asset_factory.sim_checks.read.native import COMPILE_LIMITS, COMPILER_BYTES, memory_bounded
from asset_factory.sim_checks.read.read import read_description, read_here
from asset_factory.sim_checks.read.references import follow_models

GEOM = '<geom size="0.1"/>'
BODY = f"<body>{GEOM}</body>"
GRID = '<flexcomp name="f" type="grid" count="{}" spacing="1 1 1" dim="2"/>'


def replicated(count, inside):
    return f'<replicate count="{count}">{inside}</replicate>'


def count(path):
    refuse_multiplied(path.name, follow_models(path, parse_document(path)))


def written(folder, world, before="", **documents):
    for name, text in documents.items():
        (folder / f"{name}.xml").write_text(text)
    path = folder / "scene.xml"
    path.write_text(f"<mujoco>{before}<worldbody>{world}</worldbody></mujoco>")
    return path


def attaching(folder, depth, times):
    """Models that each attach the one before so many times."""
    inner = f"<worldbody><body name='b'>{GEOM}</body></worldbody>"
    (folder / "m0.xml").write_text(f"<mujoco>{inner}</mujoco>")
    for level in range(1, depth + 1):
        attached = (f"<attach model='m' body='b' prefix='{k}_'/>" for k in range(times))
        attach = "".join(f"<frame>{each}</frame>" for each in attached)
        text = f"<asset><model name='m' file='m{level - 1}.xml'/></asset>"
        text += f"<worldbody><body name='b'>{attach}</body></worldbody>"
        (folder / f"m{level}.xml").write_text(f"<mujoco>{text}</mujoco>")
    return folder / f"m{depth}.xml"


HOSTILE = {
    "replicate": lambda folder: written(folder, replicated(10**9, GEOM)),
    "nested": lambda folder: written(folder, replicated(1000, replicated(1000, BODY))),
    "empty": lambda folder: written(folder, replicated(10**9, "")),
    "sites": lambda folder: written(folder, replicated(300_000, '<site size="1"/>')),
    "digits": lambda folder: written(folder, replicated(int("9" * 4000), GEOM)),
    "flexcomp": lambda folder: written(folder, GRID.format("2000 2000 20")),
    "included": lambda folder: written(
        folder,
        replicated(1000, '<include file="inner.xml"/>'),
        inner=f"<mujocoinclude>{BODY * 30}</mujocoinclude>",
    ),
    "attached": lambda folder: attaching(folder, 8, 8),
    "attached elsewhere": lambda folder: written(
        folder,
        replicated(30_000, '<attach model="inner" prefix="x"/>'),
        '<include file="assets.xml"/>',
        assets="<mujocoinclude><asset><model file='inner.xml'/></asset></mujocoinclude>",
        inner=f"<mujoco><worldbody>{BODY}</worldbody></mujoco>",
    ),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_what_multiplies_without_bounds_is_refused_by_counting(tmp_path, name, monkeypatch):
    path = HOSTILE[name](tmp_path)
    started = time.process_time()
    assert judges_refusal(count, path).code == "too_large"
    assert time.process_time() - started < 2.0
    # Intake says so before anything is compiled.
    monkeypatch.setattr("asset_factory.factory.intake.importers.mjcf.read_apart", None)
    assert refusal(load, path, IntakeConfig()).code == "too_large"


@pytest.mark.parametrize(
    ("world", "bodies"),
    [
        (BODY * 3, 4),
        (replicated(3, BODY + replicated(4, BODY)), 16),
        (f"<frame>{replicated(5, f'<frame>{BODY}</frame>')}</frame>", 6),
        ('<include file="inner.xml"/>' + BODY, 4),
        (GRID.format("4 5 1"), 21),
    ],
)
def test_as_many_are_counted_as_mujoco_makes(tmp_path, world, bodies, monkeypatch):
    mujoco = pytest.importorskip("mujoco")
    # It logs its warnings into whatever folder it is called from.
    monkeypatch.chdir(tmp_path)
    path = written(tmp_path, world, inner=f"<mujocoinclude>{BODY * 2}</mujocoinclude>")
    assert mujoco.MjModel.from_xml_path(str(path)).nbody == bodies
    # The world is not written in the file.
    monkeypatch.setitem(multiplied.MOST, "bodies", bodies - 1)
    count(path)
    monkeypatch.setitem(multiplied.MOST, "bodies", bodies - 2)
    with pytest.raises(DescriptionError, match=f"{bodies - 1} bodies"):
        count(path)


def test_models_attached_a_few_times_are_read(tmp_path):
    path = attaching(tmp_path, 2, 3)
    count(path)
    assert len(read_here(path).links) == 14


#: What no counting sees: the compiler asks for gigabytes.
GREEDY = '<asset><texture name="t" type="2d" builtin="flat" width="40000" height="40000"/></asset>'


def test_what_takes_gigabytes_to_compile_is_too_large(tmp_path):
    path = written(tmp_path, BODY, GREEDY)
    refused = judges_refusal(read_description, path)
    assert refused.code == refusal(load, path, IntakeConfig()).code == "too_large"
    assert "2 GiB" in refused.message


def take_memory():
    with pytest.raises(MemoryError, match=r"0\.25 GiB"), memory_bounded(2**28):
        bytearray(2**29)
    assert len(bytearray(2**29)) == 2**29


def test_memory_is_bounded_and_unbounded_again():
    # A process that has given much back may take it again without more address space.
    run_isolated(take_memory, limits=COMPILE_LIMITS).unwrap()
    with pytest.raises(ValueError, match="no name"), memory_bounded(COMPILER_BYTES):
        raise ValueError("no name")


HUNG = Outcome(None, Failure.TIMEOUT, "no answer within 120 s", "", 120.0)
CRASHED = replace(HUNG, failure=Failure.CRASHED)


@pytest.mark.parametrize(
    ("outcome", "raised", "code"),
    [
        (HUNG, TimeoutError, ""),
        (replace(CRASHED, killed=True), ChildProcessError, ""),
        (replace(CRASHED, exited=True, deaths=("",)), ChildProcessError, ""),
        (replace(CRASHED, deaths=("",)), None, "unreadable"),
    ],
)
def test_a_compiler_that_hangs_or_is_killed_gives_no_verdict(
    tmp_path, monkeypatch, outcome, raised, code
):
    path = written(tmp_path, BODY)
    monkeypatch.setattr(native.WarmChild, "call", lambda *_, **__: outcome)
    with pytest.raises(raised or DescriptionError) as refused:
        read_description(path)
    with pytest.raises(raised or InputRejected) as rejected:
        load(path, IntakeConfig())
    assert all(getattr(each.value, "code", "") == code for each in (refused, rejected))
