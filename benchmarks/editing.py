"""How long it takes to put one asset right on the page of ``factory edit``, at a person's pace.

    python benchmarks/editing.py fridge.glb fridge.parts.json film.webp last.png

The parts of the statement are drawn on the page of the mesh with the mouse, their kind and hinge
are chosen by key, and it is built; what stands on the page before is deleted. One JSON line:
seconds to the first picture of the page, to the page with its model, for drawing, until the
verdict, and in all. The film shows the page after each act, for as long as the next one took.
Needs Chromium.
"""

from __future__ import annotations

import io
import json
import os
import sys
import tempfile
import time
from pathlib import Path
from shutil import copy
from threading import Thread
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "samples"))
from browser import CHROMIUM, SOFTWARE, until

from asset_factory.factory.config import BuildConfig
from asset_factory.factory.edit.builds import Builds
from asset_factory.factory.edit.editor import editing
from asset_factory.factory.edit.subject import Subject

#: Before each act of a person who knows the page, and while a box is drawn [s].
THOUGHT_S = 0.8
DRAG_S = 0.7
SIZE = {"width": 1280, "height": 800}
#: Of a frame of the film [pixels].
FILM = (960, 600)
READY = """JSON.stringify([
    performance.getEntriesByType('resource').find(({ name }) => name.endsWith('.png')).responseEnd,
    performance.getEntriesByName('ready')[0].startTime,
])"""


class Film:
    """The page after each act, and when that was."""

    def __init__(self, page: Any) -> None:
        self._page = page
        self.shots: list[bytes] = []
        self.times: list[float] = []

    def shoot(self) -> None:
        """Take a picture."""
        self.shots.append(self._page.screenshot())
        self.times.append(time.monotonic())

    def save(self, path: Path) -> None:
        """Write the film."""
        from PIL import Image

        frames = [Image.open(io.BytesIO(shot)).convert("RGB").resize(FILM) for shot in self.shots]
        ends = [*self.times[1:], self.times[-1] + 3.0]
        spans = [int(1000 * (end - start)) for start, end in zip(self.times, ends, strict=True)]
        first, *rest = frames
        first.save(path, save_all=True, append_images=rest, duration=spans, quality=60, method=6)


def main() -> int:
    """Edit and build one mesh; returns the exit code."""
    mesh, stated, film, last = (Path(name).absolute() for name in sys.argv[1:])
    parts = json.loads(stated.read_text())["parts"]
    with tempfile.TemporaryDirectory() as name:
        os.chdir(name)
        subject = Subject(Path(copy(mesh, mesh.name)), Path("out"))
        place = ("--input", str(subject.mesh), "--output", str(subject.output))
        builds = Builds(("build", *place, "--json", "--no-report"))
        with editing(subject, BuildConfig(), builds) as server:
            thread = Thread(target=server.run, daemon=True)
            thread.start()
            print(json.dumps(edited(server.url, parts, film, last)))
            server.stop()
            thread.join()
    return 0


def edited(url: str, parts: list[dict[str, Any]], film: Path, last: Path) -> dict[str, Any]:
    """Return how long all took."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=SOFTWARE)
        page = browser.new_page(viewport=SIZE)
        page.goto(url)
        page.wait_for_selector("body.ready")
        picture_ms, ready_ms = json.loads(page.evaluate(READY))
        until(page, "Boolean(window.factory) && !factory.page.guessing", 120.0)
        until(page, "!factory.page.previewing", 60.0)
        shots = Film(page)
        begun = time.monotonic()
        shots.shoot()
        wrong = page.evaluate("factory.page.statement.parts.length")
        for _ in range(wrong):
            act(page, "]", "Delete")
        for part in parts:
            draw(page, part, shots)
        drawn = time.monotonic()
        until(page, "!factory.page.previewing", 60.0)
        act(page, "o")
        page.wait_for_timeout(600)
        shots.shoot()
        act(page, "Control+Enter")
        shots.shoot()
        page.wait_for_selector("#verdict p.verdict", timeout=300_000)
        ended = time.monotonic()
        page.wait_for_timeout(1500)
        shots.shoot()
        last.write_bytes(page.screenshot())
        told = page.inner_text("#verdict")
        browser.close()
    shots.save(film)
    return {
        "first_picture_s": round(picture_ms / 1000, 2),
        "first_load_s": round(ready_ms / 1000, 2),
        "deleted": wrong,
        "drawn": len(parts),
        "drawing_s": round(drawn - begun, 1),
        "verdict_s": round(ended - drawn, 1),
        "in_all_s": round(ended - begun, 1),
        "verdict": told.split("\n")[0],
    }


def act(page: Any, *keys: str) -> None:
    """Press keys, each after a thought."""
    for key in keys:
        page.wait_for_timeout(1000 * THOUGHT_S)
        page.keyboard.press(key)


def draw(page: Any, part: dict[str, Any], shots: Film) -> None:
    """Draw one part on its side, and say what it is."""
    side = ("front", "left", "right", "back", "top").index(part["side"]) + 1
    if page.evaluate("factory.page.sides.side") != part["side"]:
        act(page, str(side))
    frame = page.locator("#boxes").bounding_box()
    left, lower, right, upper = part["box"]
    page.wait_for_timeout(1000 * THOUGHT_S)
    # Shift draws over a box that is chosen.
    page.keyboard.down("Shift")
    start, end = (
        (frame["x"] + x * frame["width"], frame["y"] + (1.0 - y) * frame["height"])
        for x, y in ((left, upper), (right, lower))
    )
    page.mouse.move(*start)
    page.mouse.down()
    page.wait_for_timeout(1000 * DRAG_S)
    page.mouse.move(*end, steps=6)
    page.mouse.up()
    page.keyboard.up("Shift")
    keys = page.evaluate("import('./statement.js').then(({ KEYS }) => KEYS)")
    act(page, keys[part["kind"]])
    hinges = page.evaluate(
        "[...document.querySelectorAll('.hinges button')].map((b) => b.innerText)"
    )
    act(page, *("g" for _ in range(hinges.index(part.get("hinge", "any")) if hinges else 0)))
    shots.shoot()


if __name__ == "__main__":
    sys.exit(main())
