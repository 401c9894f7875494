"""Small assets for the tests of the registry."""

import json
from dataclasses import replace
from pathlib import Path

from asset_factory.factory.registry import Entry, Registry
from asset_factory.factory.registry.report_file import BuildReport
from asset_factory.factory.runtime.store import folder_digests
from asset_factory.sim_checks import Finding, Report, Severity

PASSED = Entry(
    "cabinet-1", "cabinet", "cabinet", "passed", "", 3, 2, 9, key="ab" * 32, license="CC0-1.0"
)
REJECTED = replace(
    PASSED, status="rejected", reason="rest_penetration", message="5 mm deep", license=""
)
REPORT = BuildReport(Report("asset.urdf"))
_DEEP = Finding("rest_penetration", Severity.ERROR, "5 mm deep", value=5.0, unit="mm", limit=2.0)
BAD_REPORT = BuildReport(Report("asset.urdf", findings=(_DEEP,)))
MANIFEST = {
    "name": "cabinet",
    "category": "cabinet",
    "license": "CC0-1.0",
    "urdf": "asset.urdf",
    "mjcf": "asset.xml",
    "mass": 12.5,
    "closed_bounds": [[0.0, 0.0, 0.0], [0.5, 0.4, 0.8]],
    "hulls": 9,
    "links": [{"name": "base"}, {"name": "door"}, {"name": "drawer"}],
    "joints": [{"name": "hinge", "kind": "revolute"}, {"name": "slide", "kind": "prismatic"}],
}


def named(asset_id: str, **changes: object) -> Entry:
    """The same asset under another id."""
    return replace(PASSED, id=asset_id, **changes)


def publish(
    registry: Registry, content: str = "one", entry: Entry = PASSED, report: BuildReport = REPORT
) -> Path:
    """Publish an asset with a mesh of that content."""
    with registry.staging_folder() as staging:
        bundle = staging / "bundle"
        (bundle / "meshes").mkdir(parents=True)
        (bundle / "meshes" / "a.obj").write_text(content)
        (bundle / "asset.urdf").write_text(f"<robot name='{entry.name}'/>")
        (bundle / "asset.json").write_text(
            json.dumps({**MANIFEST, "license": entry.license or None})
        )
        return registry.add(entry, report, bundle)


def three_entries(root: Path) -> Registry:
    """Two assets that passed, one of them noted and without a license, and one that did not."""
    made = Registry(root, create=True)
    publish(made)
    publish(made, "two", named("fridge-1", category="fridge", license=""))
    made.add(replace(REJECTED, id="chest-1"), BAD_REPORT)
    made.note("fridge-1", tags=("blue",), solved="yes")
    return made


def alter(folder: Path) -> None:
    """Damage an asset that was published so; the same for the two below."""
    (folder / "meshes" / "a.obj").write_text("1")


def remove(folder: Path) -> None:
    (folder / "meshes" / "a.obj").unlink()


def link(folder: Path) -> None:
    (folder / "meshes" / "a.obj").rename(folder.parent / "a.obj")
    (folder / "meshes" / "a.obj").symlink_to(folder.parent / "a.obj")


def require_same(output: Path, wanted: Path) -> None:
    """Fail unless one output is whole, and byte for byte the other."""
    from asset_factory.factory.registry.verify import verify

    for folder in ("assets", "rejected"):
        assert folder_digests(output / folder) == folder_digests(wanted / folder)
    assert Registry(output).entries() == Registry(wanted).entries()
    assert verify(Registry(output)) == ()
    for folder in (".staging", ".claims"):
        assert not list((output / folder).iterdir())


def dump(registry: Registry) -> list[tuple[object, ...]]:
    """Every byte of every row."""
    from asset_factory.factory.registry.database import connected

    with connected(registry.root) as connection:
        tables = ("assets ORDER BY id", "tags ORDER BY tag, id")
        return [row for table in tables for row in connection.execute(f"SELECT * FROM {table}")]  # noqa: S608
