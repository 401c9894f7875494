"""The site: links lead somewhere, nothing is fetched from a network, nothing of an input is run."""

import json
import re
from dataclasses import replace
from urllib.parse import unquote, urlsplit

import pytest
from export_samples import PROVENANCE, cabinet
from html_page import Page
from laid import laid
from refusing import refusal
from registry_samples import PASSED
from repository import EXAMPLES
from shown_registry import HIT, HOSTILE, POINT, bundle_in, draw, make_registry

from asset_factory.factory.display.made import scene_of
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.export.bundle import export_bundle
from asset_factory.factory.report.site import site as drawing
from asset_factory.factory.report.site.alone import page_of_file
from asset_factory.factory.report.site.places import Places
from asset_factory.factory.report.site.render import grid_html, list_html
from asset_factory.factory.report.site.site import LISTED, index_of, stale, write_asset, write_index
from asset_factory.factory.report.site.told import AssetPage, asset_page
from asset_factory.sim_checks import Finding, Severity
from asset_factory.sim_checks.measurements import penetrations


@pytest.fixture(scope="module")
def registry(tmp_path_factory):
    made = make_registry(tmp_path_factory.mktemp("shown"))
    draw(made)
    return made


def pages(registry):
    return sorted((registry.root / "report").rglob("*.html"))


def test_every_link_and_everything_loaded_is_there_and_nothing_names_a_network(registry):
    assert len(pages(registry)) == 5
    for page in pages(registry):
        text = page.read_text()
        policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)
        assert policy[1].startswith("default-src 'none'")
        assert "http" not in policy[1]
        parsed = Page(text)
        for address in (*parsed.links, *parsed.loaded):
            parts = urlsplit(address)
            assert (parts.scheme, parts.netloc) == ("", ""), address
            if parts.path:
                assert (page.parent / unquote(parts.path)).exists(), f"{page}: {address}"
    for file in (registry.root / "report").rglob("*"):
        if file.suffix in (".html", ".css") or file.name in ("assets.js", "model.js"):
            assert not re.search(r"https?:|//[a-z]", file.read_text()), file


def test_names_of_inputs_are_text(registry):
    for page in pages(registry):
        text = page.read_text()
        parsed = Page(text)
        assert parsed.handlers == []
        assert parsed.tags.count("script") == len(re.findall(r"<script", text)) <= 3
        assert "onerror='window" not in text.replace("&#39;", "\\'")
    told = (registry.root / "report/a/hitting-2/index.html").read_text()
    assert "&lt;img src=x onerror=" in told
    assert '<script id="told" type="application/json">{' in told


def test_a_verdict_leads_back_to_the_proposals_of_its_parts(registry):
    page = asset_page(registry.root, registry.entry("cabinet-1"))
    ((part, proposal),) = page.manifest.proposed.items()
    assert (part, proposal.kind, proposal.proposer) == ("part_1", "door", "sides")
    assert "by sides, probability 0.70 (" in proposal.told
    assert "<h2>Proposals</h2>" in (registry.root / "report/a/cabinet-1/index.html").read_text()


def test_the_data_of_a_page_cannot_end_its_script(registry):
    text = (registry.root / "report/a/hitting-2/index.html").read_text()
    tag = r'<script id="told" type="application/json">(.*?)</script>'
    (data,) = re.findall(tag, text, re.DOTALL)
    told = json.loads(data)
    assert told["places"] == [{"values": {"hinge": 0.8}, "point": list(POINT)}]
    assert told["start"] == told["places"][0]
    assert told["sweeps"]["hinge"]["marks"][0]["mm"] == -4.2


def test_what_was_rejected_has_its_place_its_picture_and_its_findings_once_the_gravest_first(
    registry,
):
    folder = registry.root / "report/a/hitting-2"
    assert (folder / "fault.webp").is_file()
    assert (folder / "model.js").stat().st_size > 500
    page = asset_page(registry.root, registry.entry("hitting-2"))
    assert page.fault.point == POINT
    assert (registry.rejected / "hitting-2" / "view.glb").is_file()
    groups = [(group.severity, group.code, len(group.findings)) for group in page.groups]
    assert groups == [("error", "sweep_penetration", 1), ("warning", "articulation_note", 1)]
    text = (folder / "index.html").read_text()
    assert re.findall(r"<h3>(\w+)</h3>", text) == ["Errors", "Warnings"]
    # Without a model a page still says why.
    text = (registry.root / "report/a/still-3/index.html").read_text()
    assert "no_movable_joint" in text
    assert "model.js" not in text


def test_a_page_tells_size_units_and_how_to_load_an_asset(registry):
    text = (registry.root / "report/a/cabinet-1/index.html").read_text()
    assert "<span>0.6 x 0.45 x 0.8 m</span>" in text
    assert re.search(r"[\d.]+ N m s/rad</td>\s*<td class=\"number\">[\d.]+ N m</td>", text)
    assert re.search(r"[\d.]+ N s/m</td>\s*<td class=\"number\">[\d.]+ N</td>", text)
    assert re.findall(r"<code>import (\w+)", text) == ["mujoco", "gymnasium", "omni"]
    assert "import mujoco" not in (registry.root / "report/a/hitting-2/index.html").read_text()


def test_the_grid_knows_what_filters_ask_for(registry):
    text = (registry.root / "report/assets.js").read_text()
    table = json.loads(text.removeprefix("factoryAssets=").rstrip(";\n"))
    told = [dict(zip(table["fields"], row, strict=True)) for row in table["rows"]]
    rows = {row["id"]: row for row in told}
    assert rows["cabinet-1"]["kinds"] == ["prismatic", "revolute"]
    assert rows["cabinet-1"]["repairs"] == ["hulls cut apart"]
    assert rows["hitting-2"]["picture"] == "fault"
    assert rows["hitting-2"]["clearance"] == -4.2
    assert rows["still-3"]["picture"] == ""


def test_only_what_changed_is_drawn_again(registry):
    assert list(stale(registry)) == []
    registry.note("cabinet-1", tags=("seen",))
    assert [entry.id for entry in stale(registry)] == ["cabinet-1"]
    registry.note("cabinet-1", tags=())
    assert list(stale(registry)) == []
    files = [each for each in index_of(registry.root).parent.rglob("*") if each.is_file()]
    before = {each: each.read_bytes() for each in files}
    for entry in registry.entries():
        write_asset(registry.root, entry)
    write_index(registry)
    assert before == {file: file.read_bytes() for file in before}


def test_pages_of_what_is_gone_go(tmp_path):
    registry = make_registry(tmp_path)
    draw(registry)
    registry.forget("still-3")
    assert list(stale(registry)) == []
    assert not (tmp_path / "report/a/still-3").exists()
    write_index(registry)
    assert "still-3" not in (tmp_path / "report/assets.js").read_text()


def test_a_damaged_or_half_written_entry_has_a_page_or_none_and_stops_nobody(tmp_path):
    registry = make_registry(tmp_path)
    (registry.assets / "cabinet-1/view.glb").write_bytes(b"glTF broken")
    (registry.assets / "cabinet-1/asset.json").write_text("{")
    (registry.rejected / "hitting-2/report.json").write_text("no json")
    (registry.assets / "foreign").mkdir()
    draw(registry)
    assert index_of(registry.root).is_file()
    # The URDF still shows what it was.
    assert asset_page(tmp_path, registry.entry("cabinet-1")).scene is not None
    assert "hitting-2" in (tmp_path / "report/list-1.html").read_text()


def test_thousands_of_assets_leave_the_first_page_small():
    rows = [AssetPage(replace(PASSED, id=f"cabinet-{n}")).row() for n in range(5000)]
    assert len(grid_html(rows, 5, "many")) < 5_000
    listed = list_html(rows[:LISTED], 1, 5, "many")
    assert len(listed) < 500_000
    assert listed.count("<tr>") == LISTED + 1
    assert len(json.dumps([list(row.values()) for row in rows])) < 1_500_000


def test_findings_lead_to_the_pose_in_which_they_show(registry):
    scene = scene_of(cabinet())
    measured = asset_page(registry.root, registry.entry("hitting-2")).report.measurements
    assert len(penetrations(measured)) == 1
    places = Places(scene, measured)
    fault = places.of(HIT)
    assert (fault.values, fault.point) == ({"hinge": 0.8}, POINT)
    jammed = Finding("jammed", Severity.ERROR, "x", joint="slide", value=0.1, unit="m")
    assert places.of(jammed).values == {"slide": 0.1}
    assert places.of(Finding("no_mass", Severity.ERROR, "x")) is None
    assert places.clearance() == -4.2
    assert Places(scene, {"asset.urdf": {"penetration": {"from": "elsewhere"}}}).sweeps() == {}


def test_a_file_becomes_one_page_that_needs_nothing_else(tmp_path):
    folder = bundle_in(tmp_path / "bundle")
    export_bundle(cabinet(), PROVENANCE, tmp_path / "more", formats=("glb",))
    own = [folder / name for name in ("asset.urdf", "asset.xml", "view.glb", ".")]
    # Our own program wrote these, but they have no joints of ours.
    meshes = [path for path in EXAMPLES.glob("*/*") if path.suffix in (".glb", ".obj")]
    assert len(meshes) == 12
    for file in (*own, tmp_path / "more/asset.glb", *meshes):
        text = page_of_file(file)
        parsed = Page(text)
        assert parsed.loaded == []
        assert parsed.links == []
        assert 'factoryModel="H4sI' in text
        assert "three.js authors" in text
    assert page_of_file(folder / "asset.urdf") == page_of_file(folder / "asset.urdf")


def robot(folder, begun):
    """A description of one link, whose geometry is begun so."""
    text = f'<robot name="x">{begun}</geometry></visual></link></robot>'
    return laid(folder / "x.urdf", text)


def test_what_cannot_be_shown_says_why(tmp_path):
    with pytest.raises(InputRejected, match="no such file"):
        page_of_file(tmp_path / "nothing.urdf")
    hostile = '<link name="a"><visual><geometry><mesh filename="../../etc/x.obj"/>'
    assert refusal(page_of_file, robot(tmp_path, hostile)).code in (
        "outside_folder",
        "missing_file",
    )


def test_hostile_names_in_a_description_are_text(tmp_path):
    name = HOSTILE.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
    named = f'<link name="{name}"><visual><geometry><box size="1 1 1"/>'
    parsed = Page(page_of_file(robot(tmp_path, named)))
    assert parsed.handlers == []
    assert parsed.tags.count("img") == 0


def test_a_page_follows_all_code_that_draws_it(monkeypatch):
    seen = []
    monkeypatch.setattr(drawing, "digest_file", lambda file: seen.append(file.name) or "")
    drawing._code.__wrapped__()
    assert {"loading.py", "pages.py", "told.py", "asset.html.j2"} <= set(seen)
