"""Which way an input is turned and how large it is, as somebody says: an option, or a sidecar."""

from ..config import IntakeConfig
from ..errors import ConfigError, InputRejected
from ..mesh import FloatArray
from .orientation import parse_up
from .sidecar import Sidecar
from .sizes import Scale


def check_config(config: IntakeConfig) -> None:
    """Refuse settings that cannot be.

    Raises:
        ConfigError: of the up axis or the height.
    """
    if config.up != "auto":
        parse_up(config.up)
    if config.height is not None and not 0.0 < config.height < float("inf"):
        raise ConfigError(f"height {config.height}: want a positive number of metres")


def given_up(config: IntakeConfig, sidecar: Sidecar) -> tuple[str, str] | None:
    """Return the up axis and who says so; ``None`` if nobody does."""
    if config.up != "auto":
        return parse_up(config.up), "option"
    return (sidecar.up, "sidecar") if sidecar.up is not None else None


def given_scale(
    extents: FloatArray, config: IntakeConfig, sidecar: Sidecar, name: str
) -> Scale | None:
    """Return the factor to metres that follows from a height or scale; ``None`` if nobody says.

    Args:
        extents: of the mesh, z up, input units, shape [3].
        config: its height wins over the sidecar's.
        sidecar: of the input.
        name: of the file, which opens the sentence.

    Raises:
        InputRejected: ``zero_size``: there is no height to scale.
    """
    height = config.height if config.height is not None else sidecar.height
    if height is None:
        return None if sidecar.scale is None else Scale(sidecar.scale, "sidecar")
    if not extents[2] > 0.0:
        raise InputRejected(
            "zero_size", f"{name}: has no height to scale to {height:g} m; give a scale instead"
        )
    source = "option" if config.height is not None else "sidecar"
    return Scale(height / float(extents[2]), source)
