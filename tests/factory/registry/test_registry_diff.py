"""What became better, worse, or other between two lists."""

from dataclasses import replace

import pytest
from registry_samples import PASSED, REJECTED, named, publish

from asset_factory.factory.errors import RegistryError
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.diff import Diff, diff
from asset_factory.factory.registry.export import contents, write_export
from asset_factory.factory.registry.sources import entries_of

FAILED = replace(REJECTED, id="b")


def test_each_change_has_its_group():
    before = (*(named(each) for each in ("a", "c", "d", "e", "gone")), FAILED)
    altered = (replace(FAILED, id="c"), named("d", joints=5), named("e", key="new"))
    after = (named("a"), named("b"), *altered, named("new"))
    found = diff(before, reversed(after))
    assert [entry.id for entry in found.new] == ["new"]
    assert [entry.id for entry in found.gone] == ["gone"]
    assert [change.after.id for change in found.newly_passed] == ["b"]
    failed = [(change.after.id, change.after.reason) for change in found.newly_failed]
    assert failed == [("c", "rest_penetration")]
    assert [(change.after.id, change.columns) for change in found.changed] == [("d", ("joints",))]
    assert found.same == 2
    assert found.to_dict()["newly_failed"][0]["after"]["message"] == "5 mm deep"
    assert diff((PASSED,), (PASSED,)) == Diff(same=1)


def test_entries_are_found_wherever_they_are(tmp_path):
    registry = Registry(tmp_path / "out", create=True)
    publish(registry)
    registry.note(PASSED.id, tags=("a",))
    for target in ("folder", "file.tar", "file.tar.gz"):
        write_export(contents(registry, registry.entries()), str(tmp_path / target))
        assert entries_of(tmp_path / target) == entries_of(registry.root) == registry.entries()
    assert entries_of(tmp_path / "folder" / "entries.jsonl") == registry.entries()


@pytest.mark.parametrize("content", [b"", b"no archive", b"\x1f\x8b\x08"])
def test_what_is_no_list_of_entries_is_refused(tmp_path, content):
    (tmp_path / "file.tar").write_bytes(content)
    with pytest.raises(RegistryError, match=r"file\.tar"):
        entries_of(tmp_path / "file.tar")
    (tmp_path / "entries.jsonl").write_bytes(b'{"id": "a"}\n')
    with pytest.raises(RegistryError, match="entry 1 cannot be read"):
        entries_of(tmp_path)
