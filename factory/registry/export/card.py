"""What people read first in an export: a card of the dataset and its assets' license terms."""

from __future__ import annotations

from bisect import bisect_right
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from ..entry import SPLITS, Entry

UNKNOWN = "unknown"
#: Licenses that the hub knows by this name.
_HUB_LICENSES = (
    *("apache-2.0", "bsd-2-clause", "bsd-3-clause", "mit"),
    *("cc0-1.0", "cc-by-4.0", "cc-by-nc-4.0", "cc-by-sa-4.0"),
)
#: What the hub calls so many assets: fewer than the first number, than the second, and so on.
_SIZES = ("n<1K", "1K<n<10K", "10K<n<100K", "100K<n<1M", "1M<n<10M", "n>10M")
_SIZES_END = (1_000, 10_000, 100_000, 1_000_000, 10_000_000)
_TEXT = """\
# Articulated assets

Objects with moving parts, each in a folder of its own under `assets/`: `asset.urdf`, \
`asset.xml` (MJCF), collision and
visual meshes, `asset.json` (masses, joints, where a robot can take hold) and \
`report.json` (what the validator measured).
Metres, kilograms, radians, z up; joint value 0 is the pose of the input, and lower limits \
are closed.

{count} assets: {train} for training, {test} for testing. The split follows from an asset's id \
alone, so that a larger
export moves none of them. Each asset has its own license: [LICENSES.md](LICENSES.md).

## Use

    factory registry import <this folder or archive> --output out/   # checks every digest
    sha256sum --check --quiet SHA256SUMS                             # without this program

`out/` is then a registry as `factory build` writes it, whose joints are opened in
`gym.make("asset_factory.envs:OpenJoint-v1", registry="out/")`. `entries.jsonl` \
has a line for every asset.

## Columns

| column | meaning |
|---|---|
| `id`, `name`, `category` | of the object; the id ends with the first digits \
of the input's SHA-256 |
| `status`, `reason`, `message` | `passed`; or why not, as a code and a sentence |
| `parts`, `joints`, `hulls` | how many parts, movable joints and convex pieces |
| `split` | `train` or `test` |
| `license` | of the input, as its file or its owner said |
| `solved` | `yes` or `no`: whether a scripted robot opened one of its joints; \
empty if nobody tried |
| `tags` | what people called it |
| `key` | what it was made from: input, settings, versions |
"""


def card_text(entries: Sequence[Entry], tables: Mapping[str, bytes]) -> str:
    """Return README.md, with the hub's front matter if there are tables for it."""
    splits = Counter(entry.split for entry in entries)
    text = _TEXT.format(count=len(entries), **{split: splits[split] for split in SPLITS})
    lists = (
        ("Categories", "category", Counter(entry.category or UNKNOWN for entry in entries)),
        ("Verdicts", "status", Counter(str(entry.status) for entry in entries)),
    )
    for heading, column, counts in lists:
        text += f"\n## {heading}\n\n{_table((column, 'assets'), _sorted(counts))}"
    return (_front_matter(entries, tables) if tables else "") + text


def licenses_text(entries: Sequence[Entry]) -> str:
    """Return LICENSES.md: how many assets are under which terms, and which ones."""
    by_license: dict[str, list[str]] = {}
    for entry in entries:
        by_license.setdefault(entry.license or UNKNOWN, []).append(entry.id)
    counts = Counter({license: len(ids) for license, ids in by_license.items()})
    text = f"# Licenses\n\n{_table(('license', 'assets'), _sorted(counts))}"
    if UNKNOWN in by_license:
        text += "\nNobody said under which terms those of unknown license are: "
        text += "ask before handing them on.\n"
    for license, ids in sorted(by_license.items()):
        text += f"\n## {_cell(license)}\n\n" + "".join(f"- {each}\n" for each in sorted(ids))
    return text


def _front_matter(entries: Sequence[Entry], tables: Mapping[str, bytes]) -> str:
    licenses = {entry.license.lower() for entry in entries}
    known = len(licenses) == 1 and licenses.issubset(_HUB_LICENSES)
    license = next(iter(licenses)) if known else "other"
    size = _SIZES[bisect_right(_SIZES_END, len(entries))]
    files = "".join(
        f"      - split: {split}\n        path: {name}\n"
        for split in SPLITS
        for name in sorted(tables)
        if name.startswith(f"metadata/{split}.")
    )
    other = "license_name: mixed\nlicense_link: LICENSES.md\n" if license == "other" else ""
    return (
        f"---\nlicense: {license}\n{other}pretty_name: Articulated assets\n"
        "task_categories:\n  - robotics\ntags:\n"
        "  - robotics\n  - simulation\n  - URDF\n  - MJCF\n  - articulated-objects\n"
        f"size_categories:\n  - {size}\nconfigs:\n  - config_name: default\n    data_files:\n"
        f"{files}---\n\n"
    )


def _sorted(counts: Counter[str]) -> list[tuple[str, int]]:
    return sorted(counts.items(), key=lambda item: (-item[1], item[0]))


def _table(heading: tuple[str, str], rows: Iterable[tuple[str, int]]) -> str:
    lines = [f"| {heading[0]} | {heading[1]} |", "|---|---:|"]
    return "\n".join([*lines, *(f"| {_cell(name)} | {count} |" for name, count in rows)]) + "\n"


def _cell(text: str) -> str:
    """Return a text from elsewhere that can neither end a cell nor begin a tag or a line."""
    plain = "".join(letter if letter.isprintable() else " " for letter in text)[:200]
    return plain.replace("|", "\\|").replace("<", "&lt;").replace("#", "\\#")
