"""No more workers than memory has room for, by the machine and by every cgroup above."""

import pytest
from laid import laid

from asset_factory.factory.jobs import memory
from asset_factory.factory.jobs.memory import free_memory, workers_for

GIB = 2**30


def machine(root, cgroup):
    free = f"MemFree: 1 kB\nMemAvailable: {64 * GIB // 1024} kB\n"
    laid(root / "proc" / "meminfo", f"MemTotal: 99999999 kB\n{free}")
    laid(root / "proc" / "self" / "cgroup", cgroup)
    return root / "proc"


def group(folder, limit, used, unused):
    """A group with that limit [GiB], of which so much is used, and of that so much is no loss."""
    most = limit if limit == "max" else limit * GIB
    laid(folder / "memory.max", f"{most}\n")
    (folder / "memory.current").write_text(f"{used * GIB}\n")
    (folder / "memory.stat").write_text(f"anon 5\ninactive_file {unused * GIB}\n")


@pytest.mark.parametrize(
    ("cgroup", "groups", "free"),
    [
        # Without groups the machine decides, else the tightest of all above.
        ("", {}, 64),
        ("0::/slurm/job/step\n", {"slurm/job": (8, 5, 1), "slurm/job/step": ("max", 0, 0)}, 4),
        # A container sees its own group at the root.
        ("0::/../outside\n", {".": (2, 1, 0)}, 1),
    ],
)
def test_the_tightest_limit_decides(tmp_path, cgroup, groups, free):
    for name, (limit, used, unused) in groups.items():
        group(tmp_path / "groups" / name, limit, used, unused)
    assert free_memory(machine(tmp_path, cgroup), tmp_path / "groups") == free * GIB


def test_groups_of_the_first_kind_are_read_too(tmp_path):
    proc = machine(tmp_path, "5:cpu,cpuacct:/x\n4:memory:/x\n")
    for name, gib in (("limit", 6), ("usage", 2)):
        laid(tmp_path / f"groups/memory/x/memory.{name}_in_bytes", str(gib * GIB))
    assert free_memory(proc, tmp_path / "groups") == 4 * GIB


def test_where_nothing_says_nothing_limits(tmp_path):
    assert free_memory(tmp_path, tmp_path) is None


@pytest.mark.parametrize(
    ("asked", "free", "started"),
    [(None, 64, 4), (None, 5, 2), (None, 0, 1), (3, 64, 3), (16, 9, 4), (16, None, 16)],
)
def test_workers_fit_into_what_is_free(asked, free, started, monkeypatch, capsys):
    monkeypatch.setattr(memory, "processors", lambda: 4)
    monkeypatch.setattr(memory, "free_memory", lambda: None if free is None else free * GIB)
    assert workers_for(asked, 2 * GIB) == started
    sentence = capsys.readouterr().err
    wanted = asked or 4
    assert (sentence == "") == (started == wanted)
    if sentence:
        assert f"{started} of {wanted} workers" in sentence
        assert "2.0 GiB" in sentence
