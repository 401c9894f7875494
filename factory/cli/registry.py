"""``factory registry``: what a registry holds, keeps, exports, imports."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from itertools import chain
from pathlib import Path
from typing import Annotated, Any

import tyro
from tyro.conf import Positional

from ..errors import ConfigError, Exit
from ..registry import Registry
from ..registry.diff import diff
from ..registry.rebuild import rebuild
from ..registry.sources import entries_of
from ..registry.split import SPLITS
from ..registry.verify import verify
from ..runtime.remote import is_url, shown
from ..runtime.terminal import say
from .flags import AssetId, AssetIds, OfPassed, OfRegistry, Printed
from .registry_printing import print_diff, print_problems, print_rebuilt, size

_GB = 1e9


@dataclass(frozen=True)
class Rebuild(OfRegistry):
    """Rebuild the database from the folders, where it was deleted or is damaged too."""


@dataclass(frozen=True)
class Verify(Printed, OfRegistry):
    """Compare every file with its digest at publication, and every row with its folder.

    Exit codes: 0 all is as it was published; 1 something is not; 2 wrong usage.
    """

    ids: AssetIds = ()
    """Only these assets."""


@dataclass(frozen=True)
class Difference(Printed):
    """Compare two registries or exports: new, gone, newly passed, newly failed and why, changed."""

    before: Positional[Path]
    """A registry, an export, or an export's entries.jsonl."""
    after: Positional[Path]
    """The same, later."""
    strict: bool = False
    """Exit with 1 when something newly failed or is gone."""


@dataclass(frozen=True, kw_only=True)
class Handing(OfPassed):
    """Assets to hand on, and how they are laid out."""

    layout: str = "plain"
    """plain, or huggingface: with the tables and the front matter that its hub shows."""

    def files(self) -> Iterator[tuple[str, bytes]]:
        """Yield paths and contents. Raises ConfigError: no such layout, or none of the assets."""
        from ..registry.export import LAYOUTS, contents

        if self.layout not in LAYOUTS:
            raise ConfigError(
                f"--layout: no layout {self.layout!r}; there are {', '.join(LAYOUTS)}"
            )
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


@dataclass(frozen=True)
class Sync(Handing):
    """Keep a copy of assets at a URL: only what is missing is sent, the index last.

    Each file's digest at the URL is compared with the one here. What was cut off goes on with the
    same command. What is no asset here any more is removed there.

    Example: factory registry sync s3://bucket/assets --output out/
    """

    url: Positional[str]
    """URL of a folder, as fsspec understands it: s3://, gs://, hf://, file://."""


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


@dataclass(frozen=True)
class Tag(OfRegistry):
    """Give an asset tags."""

    id: AssetId
    """As `factory list` prints it."""
    tags: Positional[tuple[str, ...]]
    """Letters, digits, and ._:- within."""


@dataclass(frozen=True)
class Untag(OfRegistry):
    """Take tags from an asset; all of them if none is named."""

    id: AssetId
    """As `factory list` prints it."""
    tags: Positional[tuple[str, ...]] = ()
    """Tags to take; those that it does not have are ignored."""


@dataclass(frozen=True)
class SplitCommand(Printed, OfPassed):
    """List the assets for training and those for testing, one id a line."""


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
    actions: dict[type, Callable[[Any], int]] = {
        Rebuild: _rebuild,
        Verify: _verify,
        Difference: _diff,
        Export: _export,
        Sync: _sync,
        Import: _import,
        Tag: _tag,
        Untag: _untag,
        SplitCommand: _split,
    }
    return actions[type(command.action)](command.action)


def _rebuild(command: Rebuild) -> int:
    print_rebuilt(rebuild(command.output))
    return Exit.OK


def _verify(command: Verify) -> int:
    registry = Registry(command.output)
    ids = [registry.named(asset_id).id for asset_id in command.ids]
    problems = verify(registry, ids or None)
    if command.json:
        say(json.dumps([asdict(problem) for problem in problems], indent=2))
    else:
        print_problems(problems, len(ids) or registry.count())
    return Exit.REJECTED if problems else Exit.OK


def _diff(command: Difference) -> int:
    found = diff(entries_of(command.before), entries_of(command.after))
    if command.json:
        say(json.dumps(found.to_dict(), indent=2))
    else:
        print_diff(found)
    return Exit.REJECTED if command.strict and (found.newly_failed or found.gone) else Exit.OK


def _export(command: Export) -> int:
    from ..registry.export import write_export

    written = write_export(command.files(), command.target)
    say(f"{shown(command.target)}: {written.files} files, {size(written.bytes)}")
    return Exit.OK


def _sync(command: Sync) -> int:
    from ..registry.sync import sync

    files = command.files()
    if not is_url(command.url):
        raise ConfigError(f"{command.url}: is no URL, want e.g. s3://bucket/assets or file:///copy")
    synced = sync(files, command.url)
    sent = f"{synced.sent} sent ({size(synced.bytes)}), {synced.removed} removed"
    say(f"{shown(command.url)}: {synced.files} files, {sent}")
    return Exit.OK


def _import(command: Import) -> int:
    from ..registry.imports import ImportLimits, import_export

    if not command.max_gb > 0.0:
        raise ConfigError(f"--max-gb must be more than 0, not {command.max_gb:g}")
    if not command.source.exists():
        raise ConfigError(
            f"{command.source}: no such file or folder; `factory registry export` writes one"
        )
    registry = Registry(command.output, create=True)
    limits = ImportLimits(total_bytes=int(command.max_gb * _GB))
    imported = import_export(
        registry, command.source, replace=command.replace, trusted=command.trust, limits=limits
    )
    say(f"{len(imported.published)} assets imported, {len(imported.same)} were there already")
    return Exit.OK


def _tag(command: Tag) -> int:
    return _retag(command.output, command.id, lambda tags: tags | set(command.tags))


def _untag(command: Untag) -> int:
    return _retag(
        command.output, command.id, lambda tags: tags - set(command.tags) if command.tags else set()
    )


def _retag(output: Path, asset_id: str, change: Callable[[set[str]], set[str]]) -> int:
    registry = Registry(output)
    entry = registry.named(asset_id)
    entry = registry.note(entry.id, tags=tuple(change(set(entry.tags))))
    say(f"{entry.id}: {', '.join(entry.tags) or 'no tags'}")
    return Exit.OK


def _split(command: SplitCommand) -> int:
    chosen: dict[str, list[str]] = {name: [] for name in SPLITS}
    for entry in command.entries():
        chosen[entry.split].append(entry.id)
    if command.json:
        say(json.dumps(chosen, indent=2))
    else:
        for name, ids in chosen.items():
            for asset_id in ids:
                say(f"{name}\t{asset_id}")
    return Exit.OK
