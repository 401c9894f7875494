"""``factory registry``: what a registry holds, keeps, exports, imports."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import chain
from pathlib import Path
from typing import Annotated, Literal

import tyro
from rich.filesize import decimal
from tyro.conf import Positional

from ..errors import ConfigError, Exit
from ..registry import Registry
from ..registry.diff import Diff, EntryChange, diff
from ..registry.entry import SPLITS, Entry
from ..registry.rebuild import rebuild
from ..registry.sources import entries_of
from ..registry.verify import verify
from ..runtime.remote import is_url, shown
from ..runtime.terminal import one_line, say
from .flags import AssetId, AssetIds, OfPassed, OfRegistry, Printed

_GB = 1e9
#: Lines of one kind that are shown before the rest is only counted.
SHOWN = 50


def _retag(output: Path, asset_id: str, change: Callable[[set[str]], set[str]]) -> int:
    registry = Registry(output)
    entry = registry.named(asset_id)
    entry = registry.note(entry.id, tags=tuple(change(set(entry.tags))))
    say(f"{entry.id}: {', '.join(entry.tags) or 'no tags'}")
    return Exit.OK


@dataclass(frozen=True)
class Rebuild(OfRegistry):
    """Rebuild the database from the folders, where it was deleted or is damaged too."""

    def run(self) -> int:
        """Print how many rows there are now, and which folders have none."""
        unreadable = rebuild(self.output)
        _lines("unreadable", unreadable)
        entries = Registry(self.output).count()
        say(f"{entries} entries; {len(unreadable)} folders could not be read")
        return Exit.OK


@dataclass(frozen=True)
class Verify(Printed, OfRegistry):
    """Compare every file with its digest at publication, and every row with its folder.

    Exit codes: 0 all is as it was published; 1 something is not; 2 wrong usage.
    """

    ids: AssetIds = ()
    """Only these assets."""

    def run(self) -> int:
        """Print the files that differ from the published ones."""
        registry = Registry(self.output)
        ids = [registry.named(asset_id).id for asset_id in self.ids]
        problems = verify(registry, ids or None)
        if self.json:
            say(json.dumps([asdict(problem) for problem in problems], indent=2))
            return Exit.REJECTED if problems else Exit.OK
        for kind, _ in Counter(problem.kind for problem in problems).most_common():
            _lines(kind, [problem.message for problem in problems if problem.kind == kind])
        wrong = {problem.id for problem in problems}
        entries = len(ids) or registry.count()
        say(f"{entries} entries: {len(wrong)} are not as they were published")
        return Exit.REJECTED if problems else Exit.OK


@dataclass(frozen=True)
class Difference(Printed):
    """Compare two registries or exports: new, gone, newly passed, newly failed and why, changed."""

    before: Positional[Path]
    """A registry, an export, or an export's entries.jsonl."""
    after: Positional[Path]
    """The same, later."""
    strict: bool = False
    """Exit with 1 when something newly failed or is gone."""

    def run(self) -> int:
        """Print what differs."""
        found = diff(entries_of(self.before), entries_of(self.after))
        if self.json:
            say(json.dumps(asdict(found), indent=2))
        else:
            print_diff(found)
        return Exit.REJECTED if self.strict and (found.newly_failed or found.gone) else Exit.OK


@dataclass(frozen=True, kw_only=True)
class Handing(OfPassed):
    """Assets to hand on, and how they are laid out."""

    layout: Literal["plain", "huggingface"] = "plain"
    """How they are laid out; huggingface: with the tables and front matter that its hub shows."""

    def files(self) -> Iterator[tuple[str, bytes]]:
        """Yield paths and contents. Raises ConfigError: there are none of the assets."""
        from ..registry.export import contents

        entries = self.entries()
        first = next(entries, None)
        if first is None:
            # A copy of nothing would be in the way of the next one, or remove all at a URL.
            raise ConfigError(f"no assets with {self.where or 'status = passed'} to hand on")
        return contents(Registry(self.output), chain((first,), entries), self.layout)


@dataclass(frozen=True)
class Export(Handing):
    """Write assets to hand on, with licenses and a card: the same bytes for the same assets."""

    target: Positional[str]
    """A new folder, a file (.tar, .tar.gz), or a URL of either that fsspec understands."""

    def run(self) -> int:
        """Write the export."""
        from ..registry.export import write_export

        written = write_export(self.files(), self.target)
        say(f"{shown(self.target)}: {written.files} files, {decimal(written.bytes)}")
        return Exit.OK


@dataclass(frozen=True)
class Sync(Handing):
    """Keep a copy of assets at a URL: only what is missing is sent, the index last.

    Each file's digest at the URL is compared with the one here. What was cut off goes on with the
    same command. What is no asset here any more is removed there.

    Example: factory registry sync s3://bucket/assets --output out/
    """

    url: Positional[str]
    """URL of a folder, as fsspec understands it: s3://, gs://, hf://, file://."""

    def run(self) -> int:
        """Bring the copy up to date."""
        from ..registry.sync import sync

        files = self.files()
        if not is_url(self.url):
            want = "want e.g. s3://bucket/assets or file:///copy"
            raise ConfigError(f"{self.url}: is no URL, {want}")
        synced = sync(files, self.url)
        sent = f"{synced.sent} sent ({decimal(synced.bytes)}), {synced.removed} removed"
        say(f"{shown(self.url)}: {synced.files} files, {sent}")
        return Exit.OK


@dataclass(frozen=True)
class Import:
    """Import the assets of an export; all of them are checked before one is registered."""

    source: Positional[Path]
    """A folder, or a .tar or .tar.gz file, that `factory registry export` wrote."""
    output: Path
    """The registry's folder; made if it is not there."""
    replace: bool = False
    """Let its assets take the place of others with the same ids."""
    trust: bool = False
    """Answer builds of the same inputs with its assets; otherwise those are built again."""
    max_gb: float = 200.0
    """Refuse an export of more than this [GB]."""

    def run(self) -> int:
        """Register the assets."""
        from ..registry.imports import import_export

        if not self.max_gb > 0.0:
            raise ConfigError(f"--max-gb must be more than 0, not {self.max_gb:g}")
        if not self.source.exists():
            advice = "`factory registry export` writes one"
            raise ConfigError(f"{self.source}: no such file or folder; {advice}")
        registry = Registry(self.output, create=True)
        imported = import_export(
            registry,
            self.source,
            replace=self.replace,
            trusted=self.trust,
            most_bytes=int(self.max_gb * _GB),
        )
        say(f"{len(imported.published)} assets imported, {len(imported.same)} were there already")
        return Exit.OK


@dataclass(frozen=True)
class Tag(OfRegistry):
    """Give an asset tags."""

    id: AssetId
    """As `factory list` prints it."""
    tags: Positional[tuple[str, ...]]
    """Letters, digits, and ._:- within."""

    def run(self) -> int:
        """Add the tags."""
        return _retag(self.output, self.id, lambda tags: tags | set(self.tags))


@dataclass(frozen=True)
class Untag(OfRegistry):
    """Take tags from an asset; all of them if none is named."""

    id: AssetId
    """As `factory list` prints it."""
    tags: Positional[tuple[str, ...]] = ()
    """Tags to take; those that it does not have are ignored."""

    def run(self) -> int:
        """Take the tags."""
        return _retag(self.output, self.id, lambda tags: tags - set(self.tags or tags))


@dataclass(frozen=True)
class SplitCommand(Printed, OfPassed):
    """List the assets for training and those for testing, one id a line."""

    def run(self) -> int:
        """Print the ids."""
        chosen: dict[str, list[str]] = {name: [] for name in SPLITS}
        for entry in self.entries():
            chosen[entry.split].append(entry.id)
        if self.json:
            say(json.dumps(chosen, indent=2))
        for name, ids in chosen.items() if not self.json else ():
            for asset_id in ids:
                say(f"{name}\t{asset_id}")
        return Exit.OK


@dataclass(frozen=True)
class RegistryCommand:
    """Verify, rebuild, compare, export, import or tag a registry."""

    action: tyro.conf.OmitArgPrefixes[
        Annotated[Rebuild, tyro.conf.subcommand("rebuild", prefix_name=False)]
        | Annotated[Verify, tyro.conf.subcommand("verify", prefix_name=False)]
        | Annotated[Difference, tyro.conf.subcommand("diff", prefix_name=False)]
        | Annotated[Export, tyro.conf.subcommand("export", prefix_name=False)]
        | Annotated[Sync, tyro.conf.subcommand("sync", prefix_name=False)]
        | Annotated[Import, tyro.conf.subcommand("import", prefix_name=False)]
        | Annotated[Tag, tyro.conf.subcommand("tag", prefix_name=False)]
        | Annotated[Untag, tyro.conf.subcommand("untag", prefix_name=False)]
        | Annotated[SplitCommand, tyro.conf.subcommand("split", prefix_name=False)]
    ]


def run(command: RegistryCommand) -> int:
    """Do one of them; returns the exit code."""
    return command.action.run()


def print_diff(diff: Diff) -> None:
    """Print which assets are new, gone, better, worse or otherwise changed."""
    _lines("new", [_verdict(entry) for entry in diff.new])
    _lines("gone", [_verdict(entry) for entry in diff.gone])
    _lines("newly passed", [f"{each.id}: was {_why(each.before)}" for each in diff.newly_passed])
    _lines("newly failed", [f"{each.id}: {_why(each.after)}" for each in diff.newly_failed])
    _lines("changed", [f"{each.id}: {_columns(each)}" for each in diff.changed])
    groups = ("new", "gone", "newly_passed", "newly_failed", "changed")
    counts = [f"{len(getattr(diff, name))} {name.replace('_', ' ')}" for name in groups]
    say(", ".join([*counts, f"{diff.same} the same"]))


def _lines(kind: str, sentences: Sequence[str]) -> None:
    for sentence in sentences[:SHOWN]:
        say(one_line(f"{kind}: {sentence}"))
    if len(sentences) > SHOWN:
        say(f"{kind}: and {len(sentences) - SHOWN} more; --json has all")


def _verdict(entry: Entry) -> str:
    return f"{entry.id}: {entry.status}" + (f", {_why(entry)}" if entry.reason else "")


def _why(entry: Entry) -> str:
    return f"{entry.reason or entry.status}" + (f": {entry.message}" if entry.message else "")


def _columns(change: EntryChange) -> str:
    return ", ".join(
        f"{name} {_shown(getattr(change.before, name))} -> {_shown(getattr(change.after, name))}"
        for name in change.columns
    )


def _shown(value: object) -> str:
    text = ",".join(map(str, value)) if isinstance(value, tuple) else str(value)
    return text or "none"
