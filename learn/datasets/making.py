"""From an object's files to its sampled object in the cache, or to the reason why there is none."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from asset_factory.factory.articulation import rotation_about
from asset_factory.factory.errors import AssetFactoryError, InputRejected
from asset_factory.factory.geometry.posing import UP

from ..samples.sampled_object import SampledObject, sampled_from, write_sampled
from .catalog import source
from .item import SourceItem
from .report import ItemRefusal
from .settings import FRONTS, SourceSettings

#: What readers of a broken file trip over.
TRIPPED = (OSError, MemoryError, ValueError, ArithmeticError, LookupError, RuntimeError)


def make_sampled(
    kind: str, item: SourceItem, settings: SourceSettings, key: str, path: Path
) -> ItemRefusal | None:
    """Read one object and keep it as points; made to be called in a process that may be killed.

    The ``key`` of its sampled object decides its points, too.
    """
    try:
        sampled = sampled_item(kind, item, settings, seed=int(key[-16:], 16))
    except InputRejected as error:
        return ItemRefusal(error.code, error.message)
    except (TimeoutError, ChildProcessError):
        # An accident of a reader's own process, not the object's fault: it may go well next time.
        raise
    except FileNotFoundError as error:
        missing = Path(str(error.filename)).name
        return ItemRefusal("missing_file", f"{item.name}: {missing} is not there")
    except (AssetFactoryError, *TRIPPED) as error:
        # Whatever a reader trips over is the object's fault: it costs that object, never the run.
        return ItemRefusal("unreadable", f"{item.name}: {type(error).__name__}: {error}"[:400])
    write_sampled(path, sampled)
    return None


def sampled_item(kind: str, item: SourceItem, settings: SourceSettings, seed: int) -> SampledObject:
    """Return one object's sample, front along -Y. Raises InputRejected and readers' errors."""
    known = source(kind)
    read = known.read(item, settings)
    if not isinstance(read, SampledObject):
        if settings.skin:
            from ..surfaces import skin_like

            read = skin_like(read, seed % 2**32)
        read = sampled_from(read, item.name, settings.points, np.random.default_rng(seed))
    quarters = FRONTS[known.front if settings.front == "auto" else settings.front]
    return turned_sampled(read, quarters * np.pi / 2.0)


def turned_sampled(sampled: SampledObject, yaw: float) -> SampledObject:
    """Turn an object and its joints about the vertical through the origin by ``yaw`` [rad]."""
    turn = rotation_about(UP, yaw).T
    vectors = ("points", "normals", "axis", "origin", "slide_direction")
    return replace(sampled, **{name: getattr(sampled, name) @ turn for name in vectors})
