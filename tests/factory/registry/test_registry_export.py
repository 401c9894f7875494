"""What is handed on: whole, reproducible, and with its terms; and how two lists differ."""

import json
import tarfile
from dataclasses import asdict, replace

import fsspec  # noqa: TID253
import pytest
from command_line import ran
from pyarrow import parquet  # noqa: TID253
from registry_samples import PASSED, REJECTED, named, publish

from asset_factory.factory.errors import ConfigError, RegistryError
from asset_factory.factory.registry.diff import Diff, diff
from asset_factory.factory.registry.export import contents, write_export
from asset_factory.factory.registry.sources import entries_of
from asset_factory.factory.runtime.store import folder_digests


def export(registry, target, layout="plain", **filters):
    return write_export(contents(registry, registry.entries(**filters), layout), str(target))


@pytest.mark.parametrize("name", ["a.tar", "a.tar.gz", "a.tgz"])
@pytest.mark.parametrize("layout", ["plain", "huggingface"])
def test_the_same_assets_give_the_same_bytes(registry, tmp_path, name, layout):
    targets = (tmp_path / "first" / name, tmp_path / "second" / name)
    for target in targets:
        export(registry, target, layout)
        for path in registry.assets.rglob("*.obj"):
            path.touch()
    assert targets[0].read_bytes() == targets[1].read_bytes()
    with tarfile.open(targets[0]) as archive:
        for member in archive:
            wanted = (0, 0, 0, "", 0o644)
            assert (member.mtime, member.uid, member.gid, member.uname, member.mode) == wanted


def test_sha256sum_agrees(registry, tmp_path):
    export(registry, tmp_path / "x")
    ran("sha256sum", "--check", "--quiet", "--strict", "SHA256SUMS", cwd=tmp_path / "x")
    listed = {line[66:] for line in (tmp_path / "x" / "SHA256SUMS").read_text().splitlines()}
    assert {*folder_digests(tmp_path / "x")} == listed | {"SHA256SUMS"}


def test_licenses_are_told_and_what_people_write_into_one_stays_text(registry, tmp_path):
    publish(registry, "three", named("oven-1", license="a | b\n# <script>"))
    export(registry, tmp_path / "x", status="passed")
    text = (tmp_path / "x" / "LICENSES.md").read_text()
    assert "| CC0-1.0 | 1 |" in text
    assert "| unknown | 1 |" in text
    assert "ask before handing them on" in text
    assert "## unknown\n\n- fridge-1\n" in text
    assert "| a \\| b \\# &lt;script> | 1 |" in text


def test_the_hub_finds_a_card_and_tables(registry, tmp_path):
    export(registry, tmp_path / "x", "huggingface", status="passed")
    matter = (tmp_path / "x" / "README.md").read_text().split("---")[1]
    for line in ("license: other", "license_link: LICENSES.md", "  - n<1K", "      - split: train"):
        assert f"\n{line}\n" in matter
    tables = [parquet.read_table(path) for path in (tmp_path / "x" / "metadata").iterdir()]
    row = next(row for table in tables for row in table.to_pylist() if row["id"] == "cabinet-1")
    assert row["urdf"] == "assets/cabinet-1/asset.urdf"
    assert (tmp_path / "x" / row["urdf"]).is_file()
    wanted = ([0.5, 0.4, 0.8], 12.5, ["revolute", "prismatic"])
    assert (row["size_m"], row["mass_kg"], row["joint_types"]) == wanted


def test_one_license_that_the_hub_knows_is_named(registry, tmp_path):
    export(registry, tmp_path / "x", "huggingface", license="CC0-1.0")
    assert "\nlicense: cc0-1.0\n" in (tmp_path / "x" / "README.md").read_text()


def test_tables_are_json_lines_without_pyarrow(registry, tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pyarrow.parquet", None)
    export(registry, tmp_path / "x", "huggingface", status="passed")
    assert all(path.suffix == ".jsonl" for path in (tmp_path / "x" / "metadata").iterdir())


def test_an_altered_asset_is_not_handed_on(registry, tmp_path):
    (registry.assets / "cabinet-1" / "asset.urdf").write_text("<robot/>")
    told = r"cabinet-1 cannot be exported: .*asset.urdf: is not what was"
    for target in ("x", "x.tar"):
        with pytest.raises(RegistryError, match=told):
            export(registry, tmp_path / target)
        assert sorted(path.name for path in tmp_path.iterdir()) == ["out"]


def test_a_report_that_names_files_elsewhere_leads_nowhere(registry, tmp_path):
    report = registry.assets / "cabinet-1" / "report.json"
    report.write_text(report.read_text().replace('"asset.urdf":', '"../../registry.db":'))
    with pytest.raises(RegistryError, match="is no file of this asset"):
        export(registry, tmp_path / "x")


def test_urls(registry, tmp_path):
    export(registry, "memory://bucket/x.tar.gz")
    export(registry, tmp_path / "x.tar.gz")
    with fsspec.open("memory://bucket/x.tar.gz", "rb") as stream:
        assert stream.read() == (tmp_path / "x.tar.gz").read_bytes()
    export(registry, "memory://bucket/folder")
    export(registry, tmp_path / "folder")
    system = fsspec.filesystem("memory")
    for name in folder_digests(tmp_path / "folder"):
        assert system.cat(f"/bucket/folder/{name}") == (tmp_path / "folder" / name).read_bytes()
    with pytest.raises(RegistryError, match="is there already"):
        export(registry, "memory://bucket/folder")
    with pytest.raises(ConfigError, match="nosuch"):
        export(registry, "nosuch://bucket/x.tar")


FAILED = replace(REJECTED, id="b")


def test_each_change_has_its_group():
    before = (*(named(each) for each in ("a", "c", "d", "e", "gone")), FAILED)
    altered = (replace(FAILED, id="c"), named("d", joints=5), named("e", key="new"))
    after = (named("a"), named("b"), *altered, named("new"))
    found = diff(before, reversed(after))
    assert [entry.id for entry in found.new] == ["new"]
    assert [entry.id for entry in found.gone] == ["gone"]
    assert [change.id for change in found.newly_passed] == ["b"]
    failed = [(change.id, change.after.reason) for change in found.newly_failed]
    assert failed == [("c", "rest_penetration")]
    assert [(change.id, change.columns) for change in found.changed] == [("d", ("joints",))]
    assert found.same == 2
    told = json.loads(json.dumps(asdict(found)))["newly_failed"][0]
    assert (told["id"], told["after"]["message"]) == ("c", "5 mm deep")
    assert diff((PASSED,), (PASSED,)) == Diff(same=1)


def test_entries_are_found_wherever_they_are(registry, tmp_path):
    for target in ("folder", "file.tar", "file.tar.gz"):
        export(registry, tmp_path / target)
        assert entries_of(tmp_path / target) == entries_of(registry.root) == registry.entries()
    assert entries_of(tmp_path / "folder" / "entries.jsonl") == registry.entries()


@pytest.mark.parametrize(
    ("name", "content", "told"),
    [
        ("file.tar", b"", r"file\.tar"),
        ("file.tar", b"no archive", r"file\.tar"),
        ("file.tar", b"\x1f\x8b\x08", r"file\.tar"),
        ("entries.jsonl", b'{"id": "a"}\n', "entry 1 cannot be read"),
    ],
)
def test_what_is_no_list_of_entries_is_refused(tmp_path, name, content, told):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(RegistryError, match=told):
        entries_of(tmp_path / name)
