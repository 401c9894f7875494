"""Openings that people labelled on artists' meshes, stated by sidecars: how many come out right.

    python benchmarks/stated.py OUT --python PYTHON

Writes a sidecar for each labelled mesh of ``train_static``, builds all with ``factory build --sim
all``, has the data's own ``score.py`` compare what was registered with the labels, and writes
``results/stated_static.toml``. PYTHON has ``yourdfpy``, which that script reads URDF with. Left out
are meshes that are drawn open.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

from real_yield import DATA
from results_file import renew

COLUMNS = ("", "figure")
SIDES = {(0, -1): "front", (0, 1): "back", (1, 0): "right", (-1, 0): "left"}
#: A side's picture runs against the object's axis there.
MIRRORED = ("back", "left")
#: Labels that do not say what opens: two of the same doors, and a roller shutter.
UNCLEAR = ("polyhaven__gallinera_table", "sketchfab__garage_door_01")


def main() -> int:
    """Build and score; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=Path, help="folder of sidecars and of the build")
    parser.add_argument("--data", type=Path, default=DATA, help="folder of train_static, generated")
    parser.add_argument("--python", default=sys.executable, help="one that has yourdfpy")
    parser.add_argument("--workers", default="2")
    asked = parser.parse_args()
    inputs = asked.output / "inputs"
    labels = write_sidecars(asked.data / "train_static", inputs)
    program = Path(sys.executable).with_name("factory")
    build = [program, "build", "--input", inputs, "--output", asked.output / "built"]
    build += ["--sim", "all", "--workers", asked.workers]
    # An input that is rejected is data; its exit code is no failure.
    subprocess.run(build, check=False)
    expected = asked.output / "expected.json"
    expected.write_text(json.dumps(labels))
    score = [asked.python, asked.data / "generated" / "score.py", expected, asked.output / "built"]
    said = subprocess.run(score, check=True, capture_output=True, text=True).stdout
    print(said)
    total = json.loads(said.splitlines()[-1])
    rows = [
        ("registered", f"{total['registered']} of {total['meshes']}"),
        ("joints right, found, expected", "{right}, {found}, {expected}".format(**total)),
        ("spurious", str(total["spurious"])),
        ("meshes with every joint right and none spurious", str(total["all_right"])),
    ]
    renew("stated_static", COLUMNS, rows)
    return 0


def write_sidecars(source: Path, inputs: Path) -> dict[str, Any]:
    """Copy the labelled meshes with a sidecar each; return their labels."""
    labels = json.loads((source / "openings.json").read_text())
    fronts = json.loads((source / "fronts.json").read_text())
    drawn_open = {name.split()[0] for name in fronts["open_as_given"]}
    inputs.mkdir(parents=True, exist_ok=True)
    taken = {}
    for name, joints in labels.items():
        mesh = name.split(":")[0]
        if mesh in drawn_open or mesh in UNCLEAR or not labels.get(mesh):
            continue
        taken[name] = joints
        if name == mesh:
            parts = [stated(joint, fronts["front"].get(name, "-y")) for joint in joints]
            (inputs / f"{name}.parts.json").write_text(json.dumps({"parts": parts}))
            shutil.copy(source / f"{name}.glb", inputs)
    return taken


def stated(joint: dict[str, Any], front: str) -> dict[str, Any]:
    """Return what a sidecar says of a labelled joint.

    Args:
        joint: of ``openings.json``: type, axis, plane, box and places of the hinge, in shares.
        front: where the object's front looks.
    """
    side = side_of(joint, front)
    low, bottom, high, top = joint["box"]
    mirrored = side in MIRRORED
    box = [1.0 - high, bottom, 1.0 - low, top] if mirrored else joint["box"]
    part = {"side": side, "box": [min(1.0, max(0.0, round(end, 3))) for end in box]}
    if joint["type"] != "revolute":
        return {**part, "kind": "drawer" if joint["type"] == "prismatic" else "knob"}
    place = joint.get("hinge", [{}])[0]
    across = "x" if joint["plane"] == "xz" else "y"
    if abs(joint["axis"][2]) > 0.5:
        if across not in place:
            return {**part, "kind": "door"}
        left = (place[across] < (low + high) / 2.0) != mirrored
        return {**part, "kind": "door", "hinge": "left" if left else "right"}
    behind = "x" if joint["plane"] == "yz" else "y"
    if behind in place and (side == "top" or top > 0.95):
        edges = ("left", "right") if behind == "x" else ("front", "back")
        return {**part, "kind": "lid", "hinge": edges[place[behind] >= 0.5]}
    below = place.get("z", bottom) < (bottom + top) / 2.0
    return {**part, "kind": "flap", "hinge": "bottom" if below else "top"}


def side_of(joint: dict[str, Any], front: str) -> str:
    """Return the side that shows a labelled joint's part."""
    if joint["plane"] == "xy":
        return "top"
    if joint["type"] == "prismatic" and not joint["axis"][2]:
        return SIDES[tuple(joint["axis"][:2])]
    if joint["plane"] == "xz":
        return "back" if front == "+y" else "front"
    return "left" if front == "-x" else "right"


if __name__ == "__main__":
    sys.exit(main())
