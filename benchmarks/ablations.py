"""What three choices are worth to the network of parts: skins in its data, votes, features.

    python benchmarks/ablations.py OUTPUT --described train_infinigen --real DATA [--only NAME ...]

Small networks that differ from the first in one thing, trained alike on the same objects, as
modelled and made one-piece skins. Then each is asked alone about real one-piece
surfaces and real modelled meshes. What is done already is kept: call it again to go on, with
``--only`` to share the work between processes. Prints a line for each network and set.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from asset_factory.factory.errors import InputRejected
from asset_factory.learn.objects import MixtureSettings
from asset_factory.learn.objects.mixture import sample_object
from asset_factory.learn.samples.sampled_object import sampled_from, write_sampled

#: Points kept of an object, of which each example takes some.
POINTS = 4096
RECIPE = """\
batch = 16
recipe = "ablation"
[network]
hidden = 96
blocks = 3
heads = 4
mlp_ratio = 2
quiet_start = true
features = "{features}"
axes = "{axes}"
[draw]
points = 256
closed_share = 0.6
turned_share = 0.1
facing_share = 0.4
mirrored_share = 0.5
stretch = 0.6
[loss]
dice = 0.3
auxiliary = 0.3
root_first = true
sign_free = true
upright_axes = true
unseen_parts = false
[schedule]
steps = {steps}
rate = 1e-3
warm_up = 100
[optimiser]
ema = 0.998
[validation]
objects = 64
[run]
workers = 0
threads = 1
device = "cpu"
log_every = 100
checkpoint_every = 200
validate_every = 1000
cache = "{cache}"
"""
#: Means over all joints; of places those that turn.
FIGURES = ("recall", "precision", "axis_of_all", "place_of_all", "joint_right")
#: What is learned from: made objects are seen twice as often as those of the folder.
SOURCES = """\
[[data]]
kind = "sampled"
path = "{objects}/{character}"
weight = {made}
[[data]]
kind = "description"
path = "{described}"
split = "configs/train/infinigen.train.txt"
weight = {found}
options = {{front = "x", points = 4096, skin = {skin}}}
"""
HELD_OUT = """\
[[held_out]]
kind = "description"
path = "{described}"
split = "configs/train/infinigen.held_out.txt"
options = {{front = "x", points = 4096, skin = true}}
"""


@dataclass(frozen=True)
class Variant:
    """One network.

    Attributes:
        skins: share of its examples that are one-piece surfaces.
        axes, features: see ``NetworkSettings``.
    """

    skins: float = 2 / 3
    axes: str = "per_point_closest"
    features: str = "components"


FIRST = Variant()
VARIANTS = {
    "first": FIRST,
    "no-skins": replace(FIRST, skins=0.0),
    "only-skins": replace(FIRST, skins=1.0),
    "no-votes": replace(FIRST, axes="per_part_plucker"),
    "no-features": replace(FIRST, features="none"),
}


def recipe_of(variant: Variant, steps: int, objects: Path, described: Path, cache: Path) -> str:
    """The recipe of one network."""
    text = RECIPE.format(features=variant.features, axes=variant.axes, steps=steps, cache=cache)
    for skin, share in (("false", 1.0 - variant.skins), ("true", variant.skins)):
        if share > 0.0:
            text += SOURCES.format(
                objects=objects,
                character="skin" if skin == "true" else "artist",
                described=described,
                made=share * 2 / 3,
                found=share / 3,
                skin=skin,
            )
    return text + HELD_OUT.format(described=described)


def make_objects(folder: Path, character: str, count: int) -> None:
    """The same objects in each character; what has a part that nobody sees stays as modelled."""
    folder.mkdir(parents=True, exist_ok=True)
    skins = float(character == "skin")
    settings = MixtureSettings(artist=1.0 - skins, generated=0.0, skin=skins)
    for number in range(count):
        path = folder / f"{number:05}.npz"
        if path.is_file():
            continue
        rng = np.random.default_rng(number)
        name, whole = sample_object(rng, settings)
        try:
            sampled = sampled_from(whole, name, POINTS, rng)
        except InputRejected as error:
            print(f"{name} left out: {error}")
            continue
        write_sampled(path, sampled)


def factory(*arguments: str) -> None:
    """Run a command of the package."""
    subprocess.run([sys.executable, "-m", "asset_factory.factory.cli", *arguments], check=True)


def train(name: str, options: argparse.Namespace) -> Path:
    """Train one network, or go on with it; its weights."""
    run: Path = options.output / name
    recipe = options.output / f"{name}.toml"
    text = recipe_of(
        VARIANTS[name],
        options.steps,
        options.output / "objects",
        options.described,
        options.output / "described",
    )
    recipe.write_text(text, encoding="utf-8")
    if not (run / "card.json").is_file():
        resume = ("--resume",) if (run / "last.pt").is_file() else ()
        factory("train", str(recipe), "--output", str(run), *resume)
    return run / "model.safetensors"


def judge(name: str, weights: Path, options: argparse.Namespace) -> Iterator[tuple[str, Any]]:
    """Figures of one network alone on real objects, by set."""
    sets = {
        "skins": ("--data", str(options.real / "skins")),
        "real": ("--data", str(options.real), "--half", "develop", "--limit", str(options.limit)),
    }
    for kind, data in sets.items():
        output = options.output / f"{name}-{kind}"
        if not (output / "evaluation.json").is_file():
            asked = ("--set", kind, *data, "--method", "particulate", "--checkpoint", str(weights))
            factory("evaluate", *asked, "--output", str(output))
        yield kind, json.loads((output / "evaluation.json").read_text(encoding="utf-8"))


def told(found: Any) -> str:
    """The figures of one set, in a line."""
    overall = next(each for each in found["summary"] if each["by"] == "overall")
    nothing = {"mean": 0.0}
    figures = {name: overall["parts"].get(name, nothing)["mean"] for name in FIGURES}
    figures["part mIoU"] = overall["values"]["part_miou"]
    return ", ".join(f"{name} {value:.3f}" for name, value in figures.items())


def main() -> None:
    """Parse, make, train, judge."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("output", type=Path, help="where objects, networks and figures are kept")
    add("--described", type=Path, required=True, help="folder with objects to learn from as well")
    add("--real", type=Path, required=True, help="folder that holds skins/ and the list's paths")
    add("--only", nargs="+", choices=tuple(VARIANTS), default=tuple(VARIANTS))
    add("--objects", type=int, default=800, help="made, of each character")
    add("--steps", type=int, default=3000, help="of training")
    add("--limit", type=int, default=60, help="modelled objects to be asked about")
    options = parser.parse_args()
    for character in ("artist", "skin"):
        make_objects(options.output / "objects" / character, character, options.objects)
    for name in options.only:
        weights = train(name, options)
        for kind, found in judge(name, weights, options):
            print(f"{name:12} {kind:6} {told(found)}", flush=True)


if __name__ == "__main__":
    main()
