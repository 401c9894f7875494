"""The page of one file in a real browser: alone, and served, where files are dropped on it."""

import re

import pytest
from browser import until
from shown_registry import bundle_in
from waiting import running

from asset_factory.factory.report.site.alone import MOST_BYTES, DroppedFiles, page_of_file
from asset_factory.factory.report.site.server import serve

pytestmark = pytest.mark.browser


def described(tmp_path, links, joints):
    """A page of links with a visual cube, and with a collision cube where ``True``."""
    cube = "<geometry><box size='1 1 1'/></geometry>"
    solid = f"<visual>{cube}</visual><collision>{cube}</collision>"
    bodies = [
        f"<link name='{name}'>{solid if hard else f'<visual>{cube}</visual>'}</link>"
        for name, hard in links.items()
    ]
    file = tmp_path / "x.urdf"
    file.write_text(f"<robot name='x'>{''.join(bodies)}{joints}</robot>")
    page = tmp_path / "x.html"
    page.write_text(page_of_file(file))
    return page


ENDLESS = (
    "<joint name='turn' type='continuous'><parent link='a'/><child link='b'/>"
    "<origin xyz='0.626 0 0'/><axis xyz='0 0 1'/></joint>"
)


def test_contact_is_told_only_where_something_can_touch(opened, tmp_path):
    page = opened(described(tmp_path, {"a": False, "b": False}, ENDLESS))
    until(page, "document.querySelector('#contact').textContent")
    assert page.locator("#contact").inner_text() == "No collision geometry in this file"
    assert page.locator("#size").inner_text() == "1.6 x 1 x 1 m"
    assert "turns without end" in page.locator("#joints").inner_text()
    page = opened(described(tmp_path, {"a": True, "b": True}, ENDLESS))
    until(page, "document.querySelector('#contact').textContent")
    told = "a and b overlap by 374.0 mm when closed; no further contact in this pose"
    assert page.locator("#contact").inner_text() == told
    assert page.evaluate("factory.model.visuals.every((each) => each.material.polygonOffset)")
    assert re.fullmatch(r"[125]0* (cm|mm|m)", page.locator("#scale").inner_text())


def test_a_hundred_joints_are_in_a_list_that_scrolls_and_filters(opened, tmp_path):
    names = {f"key_{number}": False for number in range(115)}
    joints = [
        f"<joint name='press_{name}' type='prismatic'><parent link='body'/><child link='{name}'/>"
        "<axis xyz='0 0 -1'/><limit lower='0' upper='0.01' effort='1' velocity='1'/></joint>"
        for name in names
    ]
    page = opened(described(tmp_path, {"body": False, **names}, "".join(joints)))
    rows = page.locator("#joints li")
    assert rows.count() == 115
    assert page.evaluate("document.querySelector('#joints').clientHeight < innerHeight")
    page.get_by_role("searchbox", name="Search joints").fill("key_11")
    assert [row.is_visible() for row in rows.all()].count(True) == 6


#: Drop files, given by name, on a page.
DROP = """(files) => {
    const dataTransfer = new DataTransfer();
    Object.entries(files).forEach(([name, text]) => dataTransfer.items.add(new File([text], name)));
    document.dispatchEvent(new DragEvent("drop", { dataTransfer, cancelable: true }));
}"""


def test_the_viewer_is_served_to_this_machine_and_shows_what_is_dropped_on_it(browser, tmp_path):
    file = bundle_in(tmp_path / "bundle") / "asset.xml"
    answer = DroppedFiles(page_of_file(file, live=True), lambda path: page_of_file(path, live=True))
    link = "<link name='{}'><visual><geometry><box size='1 1 1'/></geometry></visual></link>"
    robot = f"<robot name='x'>{link.format('a')}{link.format('b')}{ENDLESS}</robot>"
    with serve(answer, most_bytes=MOST_BYTES) as server, running(server):
        page = browser.new_page()
        page.goto(server.url)
        page.wait_for_selector("body.ready", timeout=60_000)
        page.evaluate(DROP, {"notes.txt": "nothing"})
        until(page, "document.querySelector('#drop.bad') !== null")
        assert "no URDF, MJCF or mesh" in page.locator("#drop").inner_text()
        page.evaluate(DROP, {"robot.urdf": robot, "notes.txt": "nothing"})
        until(page, "document.title === 'robot.urdf' && document.body.matches('.ready')", 60.0)
        assert page.evaluate("factory.model.free.map((joint) => joint.name)") == ["turn"]
        page.close()
