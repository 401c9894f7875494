"""Settings whose types say which numbers they can be, and one check of them all."""

from __future__ import annotations

import re
from dataclasses import asdict
from typing import Annotated, Any

import msgspec
from msgspec import Meta

from asset_factory.factory.errors import ConfigError

#: No setting is larger; so that none is infinite.
_MOST = 1e15
Whole = Annotated[int, Meta(ge=0, le=2**63 - 1)]
Count = Annotated[int, Meta(ge=1, le=2**63 - 1)]
Amount = Annotated[float, Meta(ge=0.0, le=_MOST)]
Share = Annotated[float, Meta(ge=0.0, le=1.0)]


def require_possible(config: Any, where: str) -> None:
    """Refuse a dataclass of settings, or one within it, whose values its types do not allow.

    Raises:
        ConfigError: names the first such setting, ``where`` it is from, and what it can be.
    """
    try:
        msgspec.convert(asdict(config), type(config))
    except msgspec.ValidationError as error:
        said, _, name = str(error).partition(" - at `$.")
        name = name.rstrip("`")
        value: Any = config
        for step in re.findall(r"\w+", name):
            value = value[int(step)] if step.isdigit() else getattr(value, step)
        wanted = said.removeprefix("Expected ").replace("`", "").partition(", got")[0]
        raise ConfigError(f"{where}: {name} must be {wanted}, not {value!r}") from error
