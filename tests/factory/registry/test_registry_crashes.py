"""A process that dies publishes all of an asset or nothing, whichever line it dies before."""

import os
import shutil
import sys
from pathlib import Path

import pytest
from registry_samples import BAD_REPORT, PASSED, REJECTED, publish

import asset_factory.factory.registry as room
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.cleaning import collect_garbage
from asset_factory.factory.registry.rebuild import rebuild
from asset_factory.factory.registry.verify import verify

ROOM = str(Path(room.__file__).parent)
DIED = 9
DONE = 0


def run_until(line, work):
    """Do ``work`` in a child that dies before its n-th line in the registry's files; exit code."""
    child = os.fork()
    if child:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    left = line

    def watch(frame, event, argument):
        nonlocal left
        if not frame.f_code.co_filename.startswith(ROOM):
            return None
        if event == "line":
            left -= 1
            if left == 0:
                os._exit(DIED)
        return watch

    try:
        # Losing power is another matter; here only the order counts.
        os.fsync = lambda descriptor: None
        sys.settrace(watch)
        work()
    finally:
        os._exit(DONE)


def state(registry):
    """What a reader sees: verdict, content, tags."""
    seen = []
    for entry in registry.entries():
        mesh = registry.folder(entry) / "meshes" / "a.obj"
        assert registry.told(entry).report.passed == (entry.status == "passed")
        content = mesh.read_text() if mesh.exists() else ""
        seen.append((entry.id, entry.status, content, entry.tags, entry.solved))
    return seen


def outcome(root, *steps):
    registry = Registry(root, create=True)
    for step in steps:
        WORK[step](registry)
    return registry, state(registry)


WORK = {
    "one": lambda registry: publish(registry, "one"),
    "two": lambda registry: publish(registry, "two"),
    "reject": lambda registry: registry.add(REJECTED, BAD_REPORT),
    "forget": lambda registry: registry.forget(PASSED.id),
    "note": lambda registry: registry.note(PASSED.id, tags=("a",), solved="yes"),
}
CASES = {
    "first": ("one",),
    "changed": ("one", "two"),
    "passed_after_all": ("reject", "one"),
    "rejected_after_all": ("one", "reject"),
    "forgotten": ("one", "forget"),
    "noted": ("one", "note"),
}


@pytest.mark.parametrize("stride", [19, pytest.param(1, marks=pytest.mark.full)])
@pytest.mark.parametrize("case", CASES)
def test_nothing_is_ever_half_there(tmp_path, case, stride):
    *before, work = CASES[case]
    registry, old = outcome(tmp_path / "old", *before)
    _, new = outcome(tmp_path / "new", *before, work)
    line = 1
    met = set()
    while True:
        root = tmp_path / f"died_{line}"
        shutil.copytree(registry.root, root)
        code = run_until(line, lambda root=root: WORK[work](Registry(root)))
        assert code in (DIED, DONE)
        seen = state(Registry(root))
        assert seen in (old, new), f"line {line}"
        rebuild(root)
        assert state(Registry(root)) in (old, new), f"line {line}, rebuilt"
        assert verify(Registry(root)) == (), f"line {line}"
        collect_garbage(root)
        assert list((root / ".staging").iterdir()) == []
        met.add(str(seen))
        shutil.rmtree(root)
        if code == DONE:
            break
        line += stride
    assert met == {str(old), str(new)}
    assert line > 50 // stride


def test_what_is_published_is_on_the_disk_before_its_name_and_then_its_name(tmp_path, monkeypatch):
    registry = Registry(tmp_path / "out", create=True)
    done = []
    sync = os.fsync
    rename = os.rename

    def noted_sync(descriptor):
        sync(descriptor)
        done.append(("synced", Path(os.readlink(f"/proc/self/fd/{descriptor}"))))

    def noted_rename(source, target):
        rename(source, target)
        done.append(("renamed", Path(target)))

    monkeypatch.setattr("os.fsync", noted_sync)
    monkeypatch.setattr("os.rename", noted_rename)
    folder = publish(registry)
    monkeypatch.undo()
    named = done.index(("renamed", folder))
    before = [path for what, path in done[:named] if what == "synced"]
    assert ("synced", registry.assets) in done[named:]
    for path in (folder, *folder.rglob("*")):
        end = ("bundle", *path.relative_to(folder).parts)
        assert any(each.parts[-len(end) :] == end for each in before), path
