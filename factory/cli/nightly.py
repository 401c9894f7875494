"""``factory nightly``: a night, for cron, systemd, Slurm and Ray."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ..runtime.layout import NIGHTS
from ..runtime.terminal import say
from . import console
from .flags import given, on_device, simulators_named, with_repairs
from .report import report_after

if TYPE_CHECKING:
    from ..jobs.nightly.settings import NightConfig

#: Without a terminal a night says so often how far it is [s].
EVERY_S = 60.0


@dataclass(frozen=True)
class Nightly:
    """Verify and repair a registry, build new inputs, and compare with earlier nights.

    The page is <output>/nights/<name>/index.html. An interrupted night goes on with the next run.
    Exit codes, the first that applies: 2 wrong usage, or another night runs there;
    130 interrupted; 4 a registered asset is damaged and could not be mended; 5 the yield fell by
    more than failure.yield_drop, or a source's by more than failure.source.drop; 3 some input could
    not be validated; 0 none of these.

    Example: factory nightly --config nightly.toml
    """

    config: Path | None = None
    """A TOML file, such as configs/nightly.toml; paths in it start from its folder. Flags win."""
    input: tuple[str, ...] = ()
    """Mesh, URDF and MJCF files, or folders of them; also by URLs that fsspec understands."""
    output: Path | None = None
    """The registry's folder; made if it is not there."""
    sim: str | None = None
    """Simulators that validate, separated by commas; 'all' is sapien,mujoco,pybullet."""
    repairs: str | None = None
    """What may be repaired: none, geometry (collision geometry only), or all (joints too)."""
    workers: int | None = None
    """Inputs built at once; 0: as many as there are processors and memory for."""
    executor: str | None = None
    """Where workers run: local or ray."""
    ray_address: str | None = None
    """With executor ray: 'auto' or host:port of a cluster that runs; 'local' starts one."""
    max_hours: float | None = None
    """Stop so long after the start [h]; what runs then is left to the next night; 0: no limit."""
    limit: int | None = None
    """Inputs begun at most, those known from before not counted; 0: all."""
    name: str | None = None
    """Name of the night; by default the one that was interrupted, else the next number."""
    no_report: bool = False
    """Leave the pages of the registry as they are; see `factory report`."""
    fresh: bool = False
    """Begin a new night even if one was interrupted."""


def run(command: Nightly) -> int:
    """Run a night; returns the exit code."""
    from ..jobs.nightly.run import run_night
    from ..jobs.nightly.work import Work
    from ..jobs.signals import interruptible
    from ..report.nightly.files import PAGE
    from ..report.nightly.report import message
    from ..report.pages import require_libraries

    config = night_config(command)
    require_libraries("the nightly report", ("jinja2", "pyarrow"), "nightly")
    with interruptible():
        work = Work(config, partial(console.follow, every_s=EVERY_S))
        report = run_night(config, work, name=command.name, fresh=command.fresh)
    if not command.no_report:
        report_after(config.output, config.workers or None)
    say(message(report))
    for sentence in report.attention:
        say(f"  {sentence}")
    say(config.output / NIGHTS / report.night.name / PAGE)
    return report.night.exit_code


def night_config(command: Nightly) -> NightConfig:
    """Return the night that file and flags ask for. Raises ConfigError for what cannot be."""
    from ..jobs.nightly import settings

    here = Path.cwd()
    config = settings.NightConfig()
    if command.config is not None:
        config = settings.load_night(command.config)
    config = replace(
        config,
        **given(command, "sim", "workers", "executor", "ray_address"),
        inputs=tuple(settings.place_from(each, here) for each in command.input) or config.inputs,
        output=(command.output or config.output).absolute(),
        budget=replace(config.budget, **given(command, "max_hours", "limit")),
    )
    settings.require_possible(config)
    build = replace(config.build, simulators=simulators_named(config.sim))
    network = on_device(build.particulate, here=config.executor == "local")
    build = replace(build, particulate=network)
    config = replace(config, build=with_repairs(build, command.repairs))
    return settings.with_licenses(config)
