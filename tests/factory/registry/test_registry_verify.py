"""Every file that is not as it was published is named."""

import shutil

import pytest
from registry_samples import alter, link, remove

from asset_factory.factory.registry.database import writing
from asset_factory.factory.registry.rows import delete
from asset_factory.factory.registry.verify import verify


def add(folder):
    (folder / "meshes" / "b.obj").write_text("")


def alter_report(folder):
    report = folder / "report.json"
    report.write_text(report.read_text().replace('"passed": true', '"passed":  true'))


def spoil_report(folder):
    (folder / "report.json").write_text("{")


def lose(folder):
    shutil.rmtree(folder)


@pytest.mark.parametrize(
    ("damage", "kind", "path"),
    [
        (alter, "altered", "assets/cabinet-1/meshes/a.obj"),
        (remove, "missing", "assets/cabinet-1/meshes/a.obj"),
        (add, "extra", "assets/cabinet-1/meshes/b.obj"),
        (link, "altered", "assets/cabinet-1/meshes/a.obj"),
        (alter_report, "altered", "assets/cabinet-1/report.json"),
        (spoil_report, "unreadable", "assets/cabinet-1/report.json"),
        (lose, "lost", "assets/cabinet-1"),
    ],
)
def test_damage_is_named(registry, damage, kind, path):
    assert verify(registry) == ()
    damage(registry.assets / "cabinet-1")
    problem = verify(registry)[0]
    assert (problem.id, problem.kind, problem.path) == ("cabinet-1", kind, path)
    assert verify(registry, ["fridge-1", "chest-1"]) == ()


def test_rows_and_folders_that_do_not_match_are_named(registry):
    with writing(registry.root) as connection:
        delete(connection, "cabinet-1")
        connection.execute("UPDATE assets SET joints = 7 WHERE id = 'fridge-1'")
    shutil.copytree(registry.rejected / "chest-1", registry.assets / "chest-1")
    kinds = {problem.id: problem.kind for problem in reversed(verify(registry))}
    assert kinds == {"cabinet-1": "unlisted", "chest-1": "twice", "fridge-1": "stale"}
