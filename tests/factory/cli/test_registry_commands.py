"""What the commands print and how they exit."""

import json
from dataclasses import replace

import pytest
import tyro
from registry_samples import BAD_REPORT, REJECTED, named, publish

from asset_factory.factory.cli import registry as commands
from asset_factory.factory.cli.build import Build, idle_retries
from asset_factory.factory.cli.listing import List
from asset_factory.factory.cli.listing import run as run_list
from asset_factory.factory.cli.show import Show
from asset_factory.factory.cli.show import run as run_show
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.registry import Registry

ROOMS = {
    List: run_list,
    Show: run_show,
    commands.RegistryCommand: commands.run,
}


@pytest.fixture
def root(tmp_path):
    registry = Registry(tmp_path / "out", create=True)
    publish(registry)
    publish(registry, entry=named("fridge-1", category="fridge"))
    registry.reject(replace(REJECTED, id="chest-1"), BAD_REPORT)
    return registry.root


@pytest.fixture
def run(capsys):
    def ask(command, *arguments):
        parsed = tyro.cli(
            command, args=[str(item) for item in arguments], config=(tyro.conf.FlagCreatePairsOff,)
        )
        code = ROOMS[command](parsed)
        return code, capsys.readouterr().out

    return ask


def test_listing(root, run):
    code, out = run(List, "--output", root, "--json")
    assert (code, [row["id"] for row in json.loads(out)]) == (
        0,
        ["cabinet-1", "chest-1", "fridge-1"],
    )
    _, out = run(List, "--output", root, "--status", "passed", "--category", "fridge", "--json")
    assert [row["id"] for row in json.loads(out)] == ["fridge-1"]
    _, out = run(List, "--output", root, "--limit", 1)
    assert "the first 1; --after cabinet-1 goes on" in out
    _, out = run(List, "--output", root, "--limit", 2, "--after", "cabinet-1")
    assert "--after" not in out
    with pytest.raises(
        ConfigError, match=r"--status: is 'good', want one of passed, rejected, unjudged"
    ):
        run(List, "--output", root, "--status", "good")


def test_showing(root, run):
    _, out = run(Show, "cabinet-1", "--output", root, "--json")
    assert json.loads(out)["manifest"]["license"] == "CC0-1.0"
    assert json.loads(out)["changes"] == []


def test_verify_exits_with_1_for_damage(root, run):
    assert run(commands.RegistryCommand, "verify", "--output", root) == (
        0,
        "3 entries: 0 are not as they were published\n",
    )
    (root / "assets" / "cabinet-1" / "asset.urdf").unlink()
    code, out = run(commands.RegistryCommand, "verify", "--output", root, "--json")
    assert (code, json.loads(out)[0]["kind"]) == (1, "missing")
    assert run(commands.RegistryCommand, "verify", "fridge-1", "--output", root)[0] == 0


def test_rebuild_and_gc(root, run):
    (root / "registry.db").unlink()
    assert (
        run(commands.RegistryCommand, "rebuild", "--output", root)[1]
        == "3 entries; 0 folders could not be read\n"
    )
    assert (
        "freed 0 B"
        in run(
            commands.RegistryCommand, "gc", "--output", root, "--older-than", 30, "--keep-gb", 1
        )[1]
    )


def test_out_and_in_and_the_difference(root, run, tmp_path):
    target = tmp_path / "x.tar.gz"
    other = tmp_path / "other"
    _, out = run(commands.RegistryCommand, "export", target, "--output", root)
    assert out.startswith(f"{target}: ")
    assert run(commands.RegistryCommand, "import", target, "--output", other)[1].startswith(
        "2 assets imported"
    )
    code, out = run(commands.RegistryCommand, "diff", root, other, "--strict")
    assert code == 1
    assert "gone: chest-1: rejected, rest_penetration: 5 mm deep" in out
    Registry(other).reject(replace(REJECTED, id="fridge-1"), BAD_REPORT)
    _, out = run(commands.RegistryCommand, "diff", root, other)
    assert "newly failed: fridge-1: rest_penetration: 5 mm deep" in out


def test_tags_and_splits(root, run):
    assert (
        run(commands.RegistryCommand, "tag", "cabinet-1", "b", "a", "--output", root)[1]
        == "cabinet-1: a, b\n"
    )
    assert (
        run(commands.RegistryCommand, "untag", "cabinet-1", "b", "--output", root)[1]
        == "cabinet-1: a\n"
    )
    assert (
        run(commands.RegistryCommand, "untag", "cabinet-1", "--output", root)[1]
        == "cabinet-1: no tags\n"
    )
    _, out = run(commands.RegistryCommand, "split", "--output", root)
    assert sorted(line.split("\t")[1] for line in out.splitlines()) == ["cabinet-1", "fridge-1"]


def test_reasons_to_be_retried_that_nothing_has_are_named_with_those_there_are(root):
    reason = Registry(root).entry("chest-1").reason
    said = list(idle_retries(Build((), root, retry_rejected=("nonsense", "any"))))
    assert said == [f"--retry-rejected: nothing was rejected for 'nonsense'; there are {reason}"]
    assert list(idle_retries(Build((), root, retry_rejected=(reason,)))) == []
