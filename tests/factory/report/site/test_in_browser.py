"""The pages in a real browser: sliders move the mesh, filters filter, nothing hostile runs.

Slow, and it needs Chromium: ``make site-test``.
"""

import json
import math
import shutil
from dataclasses import replace

import pytest
from browser import CONTRAST, LAPTOP, PHONE, until
from registry_samples import PASSED
from shown_registry import draw, make_registry

from asset_factory.factory.report.site.render import STATIC, STATIC_FILES, grid_html
from asset_factory.factory.report.site.told import AssetPage

pytestmark = pytest.mark.browser
#: Assets of the large grid, and what its tab may hold [bytes].
MANY = 10_000
MOST_MEMORY = 500_000_000


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return draw(make_registry(tmp_path_factory.mktemp("browser"))).parent


def link_positions(page):
    told = "factory.model.links.map(link => Array.from(link.matrix.elements).slice(12, 15))"
    return page.evaluate(told)


def test_a_slider_moves_its_part_and_no_other(opened, site):
    page = opened(site / "a/cabinet-1/index.html")
    before = link_positions(page)
    slider = page.get_by_role("slider", name="slide")
    slider.focus()
    page.keyboard.press("End")
    after = link_positions(page)
    assert after[2][1] == pytest.approx(before[2][1] - 0.3, abs=1e-6)
    assert after[:2] == before[:2]
    assert page.get_by_role("textbox", name="slide, value").input_value() == "300 mm"
    page.get_by_role("textbox", name="hinge, value").fill("45")
    page.keyboard.press("Enter")
    assert page.evaluate("factory.model.values.get('hinge')") == pytest.approx(math.radians(45.0))


def test_a_pose_is_in_the_address_and_comes_back_from_it(opened, site):
    page = opened(site / "a/cabinet-1/index.html")
    page.get_by_role("button", name="Play slide").click()
    until(page, "factory.model.values.get('slide') > 0.1")
    assert page.evaluate("factory.model.values.get('hinge')") == 0.0
    page.get_by_role("button", name="Play slide").click()
    until(page, "location.hash.startsWith('#slide=0.')")
    moved = page.evaluate("factory.model.values.get('slide')")
    again = opened(page.url)
    assert again.evaluate("factory.model.values.get('slide')") == pytest.approx(moved, abs=1e-3)


def on_screen(page, link):
    """Where the middle of a link's surface is in the window [pixels]."""
    told = f"""(() => {{
        const {{ model, viewer }} = factory;
        const mesh = model.visuals.find((each) => each.userData.link === {link});
        const at = mesh.geometry.boundingBox.min.clone().add(mesh.geometry.boundingBox.max);
        at.multiplyScalar(0.5).applyMatrix4(mesh.matrixWorld).project(viewer.camera);
        const box = viewer.canvas.getBoundingClientRect();
        return [box.left + (at.x + 1) / 2 * box.width, box.top + (1 - at.y) / 2 * box.height];
    }})()"""
    return page.evaluate(told)


def test_a_part_lights_up_with_its_row_and_is_dragged_open(opened, site):
    page = opened(site / "a/cabinet-1/index.html")
    page.wait_for_timeout(300)
    x, y = on_screen(page, 2)
    page.mouse.move(x, y)
    assert page.locator("#joints .over label").inner_text() == "slide"
    lit = "factory.model.visuals.filter((each) => each.material.emissiveIntensity < 1).length"
    assert page.evaluate(lit) > 0
    page.mouse.down()
    page.mouse.move(x - 40, y + 30, steps=6)
    page.mouse.up()
    assert page.evaluate("factory.model.values.get('slide')") > 0.02
    page.mouse.move(2, 2)
    assert page.locator("#joints .over").count() == 0
    assert page.evaluate(lit) == 0


def test_parts_are_hidden_and_shown_alone(opened, site):
    page = opened(site / "a/cabinet-1/index.html")
    shown = """[...new Set(factory.model.visuals.filter((each) => each.visible)
        .map((each) => each.userData.link))]"""
    page.get_by_role("button", name="Hide hinge").click()
    assert page.evaluate(shown) == [0, 2]
    page.get_by_role("button", name="Alone hinge").click()
    assert page.evaluate(shown) == [1]
    page.get_by_role("button", name="Alone hinge").click()
    assert page.evaluate(shown) == [0, 1, 2]


@pytest.mark.parametrize("size", [LAPTOP, PHONE])
def test_the_closed_object_is_in_the_middle_and_all_limits_are_in_the_picture(opened, site, size):
    page = opened(site / "a/cabinet-1/index.html")
    page.set_viewport_size(size)
    page.wait_for_timeout(300)
    page.get_by_role("button", name="Reset view").click()
    seen = """(() => {
        const { viewer } = factory;
        viewer.camera.updateMatrixWorld();
        const spots = (each) => each.map((corner) => corner.clone().project(viewer.camera));
        const ranges = viewer.overlays.limits.flatMap(({ group }) => group.children.flatMap(
            ({ geometry, matrixWorld }) => {
                const { array } = geometry.getAttribute("position");
                const point = (at) => viewer.closed[0].clone().fromArray(array, 3 * at);
                return Array.from({ length: array.length / 3 },
                    (_, at) => point(at).applyMatrix4(matrixWorld));
            }));
        const told = (axis) => spots(viewer.closed).map((spot) => spot[axis]);
        return {
            middle: ["x", "y"].map((axis) => Math.max(...told(axis)) + Math.min(...told(axis))),
            reach: Math.max(...spots(ranges).flatMap(({ x, y }) => [Math.abs(x), Math.abs(y)])),
        };
    })()"""
    found = page.evaluate(seen)
    assert found["middle"] == pytest.approx([0.0, 0.0], abs=0.02)
    assert 0.1 < found["reach"] <= 1.0


def test_a_person_stands_beside_the_object_in_the_picture(opened, site):
    page = opened(site / "a/cabinet-1/index.html")
    far = "factory.viewer.camera.position.distanceTo(factory.viewer.controls.target)"
    before = page.evaluate(far)
    page.get_by_role("button", name="Person").click()
    assert page.evaluate("factory.viewer.person.visible")
    assert page.evaluate(far) > 1.2 * before
    size = """(() => {
        const { geometry } = factory.viewer.person;
        geometry.computeBoundingBox();
        return geometry.boundingBox.max.z - geometry.boundingBox.min.z;
    })()"""
    assert page.evaluate(size) == pytest.approx(1.75, abs=1e-3)
    page.keyboard.press("m")
    assert page.evaluate(far) == pytest.approx(before)


def test_the_wheel_scrolls_the_page_until_the_model_is_clicked(opened, site):
    page = opened(site / "a/cabinet-1/index.html")
    far = "factory.viewer.camera.position.distanceTo(factory.viewer.controls.target)"
    before = page.evaluate(far)
    box = page.locator("#stage canvas").bounding_box()
    page.mouse.move(box["x"] + 20, box["y"] + 20)
    page.mouse.wheel(0, 200)
    until(page, "scrollY > 100")
    assert page.evaluate(far) == before
    page.evaluate("scrollTo(0, 0)")
    page.mouse.click(box["x"] + 20, box["y"] + 20)
    page.mouse.wheel(0, 200)
    until(page, f"{far} > {1.05 * before}")
    assert page.evaluate("scrollY") == 0


def test_the_picture_changes_when_the_door_opens(opened, site):
    page = opened(site / "a/cabinet-1/index.html")
    stage = page.locator("#stage canvas")
    page.wait_for_timeout(500)
    closed = stage.screenshot()
    page.evaluate("factory.page.set(factory.model.opened(1))")
    page.wait_for_timeout(500)
    assert stage.screenshot() != closed


def test_what_was_refused_shows_its_contact_in_red(opened, site):
    page = opened(site / "a/hitting-2/index.html")
    assert page.evaluate("factory.model.values.get('hinge')") == pytest.approx(0.8)
    assert page.evaluate("factory.viewer.marks.children.length") >= 1
    page.get_by_role("button", name="Close", exact=True).click()
    until(page, "Math.abs(factory.model.values.get('hinge')) < 1e-6")
    page.get_by_role("button", name="Show").first.click()
    until(page, "Math.abs(factory.model.values.get('hinge') - 0.8) < 1e-6")


def test_clearance_is_what_the_geometry_says(opened, site):
    page = opened(site / "a/cabinet-1/index.html")
    page.wait_for_selector("#plots figure:nth-child(2)")
    told = """(() => {
        const { model, bodies } = factory;
        const joint = model.byName.get("slide");
        return bodies.sweep(joint, model.opened(0)).map(({ links, gaps }) => [links, gaps[0]]);
    })()"""
    gaps = {tuple(sorted(links)): gap for links, gap in page.evaluate(told)}
    # The drawer hangs 2 mm before the block, and 40 mm above the door.
    assert gaps[0, 2] == pytest.approx(0.002, abs=1e-6)
    assert gaps[1, 2] == pytest.approx(0.04, abs=1e-6)


def test_filters_filter_and_search_searches(opened, site):
    page = opened(site / "index.html")
    cards = page.locator("#grid .card")
    assert cards.count() == 3
    page.get_by_role("button", name="rejected").click()
    assert cards.count() == 2
    page.locator("#by-reason").select_option("no_movable_joint")
    assert cards.count() == 1
    page.get_by_role("button", name="Clear filters").click()
    page.keyboard.press("/")
    page.keyboard.type("hitting")
    until(page, "document.querySelectorAll('#grid .card').length === 1")
    page.get_by_role("link", name="hitting").click()
    page.wait_for_selector("body.ready")
    assert "hitting-2" in page.url


def test_tiles_of_the_same_name_have_their_ids(opened, tmp_path):
    entries = [PASSED, replace(PASSED, id="cabinet-2"), replace(PASSED, id="oven-1", name="oven")]
    page = opened(grid_of(tmp_path, [AssetPage(entry).row() for entry in entries]))
    told = page.locator("#grid .card strong").all_inner_texts()
    assert told == ["cabinet-1", "cabinet-2", "oven"]


def grid_of(tmp_path, rows):
    """A grid's page with those rows."""
    fields = sorted(rows[0])
    table = {"fields": fields, "rows": [[row[name] for name in fields] for row in rows]}
    for name in STATIC_FILES:
        shutil.copy(STATIC / name, tmp_path / name)
    (tmp_path / "assets.js").write_text(f"factoryAssets={json.dumps(table)};")
    (tmp_path / "index.html").write_text(grid_html(rows, 10, "many"))
    return tmp_path / "index.html"


def test_no_name_of_an_input_runs(opened, site):
    for address in ("index.html", "a/cabinet-1/index.html", "a/hitting-2/index.html"):
        page = opened(site / address)
        page.wait_for_timeout(300)
        assert page.evaluate("window.hacked") is None
    page = opened(site / "list-1.html", ready="table")
    assert page.evaluate("window.hacked") is None


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize(
    "address", ["index.html", "a/cabinet-1/index.html", "a/hitting-2/index.html"]
)
def test_a_phone_needs_no_sideways_scrolling_and_text_is_legible(opened, site, address, scheme):
    page = opened(site / address, color_scheme=scheme)
    page.set_viewport_size(PHONE)
    until(page, f"document.documentElement.scrollWidth <= {PHONE['width']}")
    assert page.evaluate(CONTRAST) == []
    if page.query_selector("#person"):
        contact, person = (page.locator(each).bounding_box() for each in ("#contact", "#person"))
        assert contact["x"] + contact["width"] <= person["x"]


def test_everything_can_be_reached_by_keyboard(opened, site):
    page = opened(site / "a/hitting-2/index.html")
    reached = set()
    for _ in range(40):
        page.keyboard.press("Tab")
        reached.add(page.evaluate("document.activeElement.id || document.activeElement.tagName"))
    assert {"joint-0", "joint-1", "show-hulls", "open", "save", "CANVAS"} <= reached
    page.keyboard.press("h")
    assert page.evaluate("factory.viewer.shown.hulls") is True


def test_without_scripts_there_is_a_plain_list(browser, site):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto((site / "index.html").as_uri())
    page.get_by_role("link", name="a plain list of all assets").click()
    page.get_by_role("link", name="hitting-2").click()
    assert "deeper than at rest" in page.inner_text("body")
    context.close()


def test_ten_thousand_assets_open_fast_and_stay_light(opened, tmp_path, record_property):
    names = [{"id": f"cabinet-{n:05d}", "name": f"cabinet {n:05d}"} for n in range(MANY)]
    rows = [AssetPage(replace(PASSED, **name)).row() for name in names]
    page = opened(grid_of(tmp_path, rows))
    milliseconds = page.evaluate("performance.now()")
    assert page.locator("#grid .card").count() < 100
    scrolled = page.evaluate(SCROLL)
    found = page.evaluate(SEARCH)
    memory = page.evaluate("performance.memory.usedJSHeapSize")
    record_property("figures", (milliseconds, scrolled, found, memory))
    print(
        f"open {milliseconds:.0f} ms, scroll {scrolled:.1f} ms, search {found:.1f} ms, {memory} B"
    )
    assert milliseconds < 10_000
    assert scrolled < 200
    assert found < 500
    assert memory < MOST_MEMORY


#: Milliseconds for a screen of the grid, over twenty places.
SCROLL = """(() => {
    const start = performance.now();
    for (let part = 0; part < 20; part += 1) {
        scrollTo(0, document.body.scrollHeight * part / 20);
        factory.grid.draw();
        factory.grid.box.offsetHeight;
    }
    return (performance.now() - start) / 20;
})()"""
#: Milliseconds to search all assets.
SEARCH = """(() => {
    const { grid } = factory;
    grid.state.set("q", "cabinet 09");
    const start = performance.now();
    grid.filter();
    const took = performance.now() - start;
    if (grid.shown.length < 1000) throw new Error(`found ${grid.shown.length}`);
    return took;
})()"""
