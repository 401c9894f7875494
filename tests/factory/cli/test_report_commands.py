"""``factory report`` and ``factory view``."""

import pytest
from shown_registry import bundle_in, make_registry

from asset_factory.factory.cli.commands import run
from asset_factory.factory.cli.report import report_after
from asset_factory.factory.report import pages


def test_report_draws_every_page_once(tmp_path, capsys):
    registry = make_registry(tmp_path / "out")
    assert run(["report", "--output", str(registry.root), "--workers", "1"]) == 0
    index = registry.root / "report" / "index.html"
    assert capsys.readouterr().out.strip() == str(index)
    page = registry.root / "report/a/hitting-2/index.html"
    written = page.stat().st_mtime_ns
    assert run(["report", "--output", str(registry.root), "--workers", "1"]) == 0
    assert page.stat().st_mtime_ns == written


def test_a_build_is_done_whatever_becomes_of_its_report(tmp_path, capsys, monkeypatch):
    registry = make_registry(tmp_path / "out")
    monkeypatch.setattr(pages, "find_spec", lambda name: None)
    report_after(registry.root, 1)
    assert "pip install" in capsys.readouterr().err
    monkeypatch.undo()
    (registry.root / "report").write_text("in the way")
    report_after(registry.root, 1)
    assert "cannot be written" in capsys.readouterr().err


def test_view_takes_the_beginning_of_an_id(tmp_path):
    root = make_registry(tmp_path / "out").root
    saved = tmp_path / "page.html"
    assert run(["view", "cab", "--output", str(root), "--save", str(saved)]) == 0
    assert "cabinet" in saved.read_text()


@pytest.mark.parametrize("name", ["asset.urdf", "asset.xml"])
def test_view_reads_a_file_in_a_process_of_its_own_and_saves_one_page(
    tmp_path, monkeypatch, capsys, name
):
    saved = tmp_path / "page.html"
    monkeypatch.setattr("asset_factory.factory.display.described.read_description", None)
    assert run(["view", str(bundle_in(tmp_path / "bundle") / name), "--save", str(saved)]) == 0
    assert capsys.readouterr().out.strip() == str(saved)
    assert saved.read_text().startswith("<!DOCTYPE html>")
