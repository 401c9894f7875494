"""A person puts right what was rejected: draws boxes, looks, builds, and it is registered.

Slow, and it needs Chromium: ``make site-test``.
"""

import json
from contextlib import contextmanager
from types import SimpleNamespace

import pytest
from browser import CONTRAST, LAPTOP, PHONE, until
from one_piece import write_oven
from shown_registry import make_registry
from waiting import running

from asset_factory.factory.cli.commands import run
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.edit.builds import Builds
from asset_factory.factory.edit.editor import editing
from asset_factory.factory.edit.subject import Subject, subject_of
from asset_factory.factory.registry import Registry

pytestmark = pytest.mark.browser
PARTS = "factory.page.statement.parts"
BUILD = ("--sim", "mujoco", "--no-report")
#: No answer is awaited, and what is stated can be opened.
OPENS = "!factory.page.previewing && factory.page.stage.model.free.length === {}"


@pytest.fixture
def rejected(tmp_path, capsys):
    """The folder of an oven on which nothing was seen to open."""
    mesh = write_oven(tmp_path)
    run(["build", "--input", str(mesh), "--output", str(tmp_path / "out"), *BUILD])
    said = capsys.readouterr().out
    (entry,) = Registry(tmp_path / "out").entries()
    assert (entry.status, entry.reason) == ("rejected", "no_movable_joint")
    folder = tmp_path / "out" / "rejected" / entry.id
    assert f"factory edit {folder}" in said
    return folder


@contextmanager
def opened(browser, subject, builds):
    """A page; afterwards nothing may have been complained of on the console."""
    said = []
    with editing(subject, BuildConfig(), builds) as server, running(server):
        context = browser.new_context(viewport=LAPTOP)
        page = context.new_page()
        page.on("console", lambda each: said.append(each.text) if each.type != "log" else None)
        page.on("pageerror", lambda error: said.append(str(error)))
        page.goto(server.url)
        page.wait_for_selector("body.ready", timeout=60_000)
        until(page, "Boolean(window.factory) && !factory.page.guessing", 60.0)
        page.subject = subject
        yield page
        context.close()
    # What the reader refuses, the browser calls an error of its own.
    assert [each for each in said if "422" not in each] == []


@pytest.fixture
def page(browser, rejected):
    subject = subject_of(rejected, None, rejected)
    place = ("--input", str(subject.mesh), "--output", str(subject.output))
    with opened(browser, subject, Builds(("build", *place, *BUILD, "--json"))) as page:
        yield page


def draw(page, left, lower, right, upper):
    """Draw a box with the mouse, in shares of the side."""
    frame = page.locator("#boxes").bounding_box()
    corners = [
        (frame["x"] + x * frame["width"], frame["y"] + (1.0 - y) * frame["height"])
        for x, y in ((left, lower), (right, upper))
    ]
    page.mouse.move(*corners[0])
    page.mouse.down()
    page.mouse.move(*corners[1], steps=4)
    page.mouse.up()


def test_what_was_rejected_is_drawn_built_and_registered(page):
    assert page.evaluate(PARTS) == []
    assert page.locator("#build").is_disabled()
    draw(page, 0.0, 0.0, 0.999, 0.815)
    page.keyboard.press("f")
    for _ in range(4):
        page.keyboard.press("g")
    until(page, OPENS.format(1), 60.0)
    (flap,) = page.evaluate(PARTS)
    assert (flap["kind"], flap["side"], flap["hinge"]) == ("flap", "front", "bottom")
    assert flap["box"] == pytest.approx([0.0, 0.0, 1.0, 0.815], abs=0.01)
    drag_it_open(page)
    page.keyboard.press("Control+Enter")
    page.wait_for_selector("#verdict p.verdict.passed", timeout=120_000)
    assert json.loads(page.subject.sidecar.read_text())["parts"] == [flap]
    (entry,) = Registry(page.subject.output).entries(status="passed")
    assert (entry.id, entry.joints) == (page.locator("#verdict code").first.inner_text(), 1)
    until(page, "factory.page.shown === 'built' && factory.page.stage.share === 1")
    assert page.evaluate("factory.page.stage.model.hulls.length") == entry.hulls
    refuse_and_undo(page, flap)


def drag_it_open(page):
    """Take the flap by its middle, and pull it down."""
    seen = """(() => {
        const { viewer, grab } = factory.page.stage;
        const box = viewer.canvas.getBoundingClientRect();
        for (let down = 0.2; down < 0.9; down += 0.02) {
            const [clientX, clientY] = [box.x + 0.4 * box.width, box.y + down * box.height];
            const found = grab.hit({ clientX, clientY });
            if (found) return [clientX, clientY];
        }
        return null;
    })()"""
    x, y = page.evaluate(seen)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x, y + 150.0, steps=12)
    page.mouse.up()
    assert page.evaluate("[...factory.page.stage.model.values.values()][0]") > 0.3
    assert page.evaluate("factory.page.chosen") == 0


def refuse_and_undo(page, flap):
    """State what cannot be, by keyboard alone, read why, and take it back."""
    page.keyboard.press("Escape")
    page.keyboard.press("n")
    page.keyboard.press("l")
    for _ in range(3):
        page.keyboard.press("ArrowUp")
    until(page, "factory.page.sentence !== '' && !factory.page.previewing", 60.0)
    wrong = page.locator("#parts li.chosen .wrong").inner_text()
    assert "parts[0] (flap) and parts[1] (lid): share" in wrong
    lid = page.evaluate(PARTS)[1]
    assert lid["box"] == [0.3, 0.315, 0.7, 0.715]
    page.keyboard.press("Delete")
    assert page.evaluate(PARTS) == [flap]
    page.keyboard.press("u")
    assert page.evaluate(PARTS) == [flap, lid]
    for _ in range(3):
        page.keyboard.press("Control+z")
    assert page.evaluate(PARTS) == [flap]
    page.keyboard.press("Control+Shift+z")
    assert len(page.evaluate(PARTS)) == 2
    page.keyboard.press("]")
    page.keyboard.press("3")
    assert page.locator("#thumbs [aria-pressed=true]").inner_text() == "right"
    page.click("#as-text summary")
    page.fill("#text", json.dumps({"front": "x", "parts": []}))
    until(page, "factory.page.sides.image.src.endsWith('sides/x/right.png')")


def test_what_fails_shows_where_it_hits(browser, tmp_path):
    class Done(Builds):
        def start(self):
            self.last = SimpleNamespace(asset="hitting-2", stop=lambda: None)

    registry = make_registry(tmp_path / "out")
    subject = Subject(write_oven(tmp_path), registry.root)
    with opened(browser, subject, Done(())) as page:
        page.keyboard.press("n")
        page.keyboard.press("Control+Enter")
        page.wait_for_selector("#verdict p.verdict.rejected")
        until(page, "factory.page.shown === 'built'")
        page.keyboard.press("o")
        page.get_by_role("button", name="Show").first.click()
        stage = "factory.page.stage"
        until(page, f"Math.abs({stage}.model.values.get('hinge') - 0.8) < 1e-6")
        until(page, f"{stage}.viewer.marks.children.length >= 1")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_phone_needs_no_sideways_scrolling_and_text_is_legible(page, scheme):
    page.emulate_media(color_scheme=scheme)
    page.keyboard.press("n")
    page.set_viewport_size(PHONE)
    page.wait_for_timeout(300)
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
    assert page.evaluate(CONTRAST) == []
