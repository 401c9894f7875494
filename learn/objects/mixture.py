"""What training sees: objects of all kinds, as artists, CAD and image-to-3D tools give them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.errors import ConfigError

from ..surfaces import artist_like, fused_like, skin_like
from .catalog import CATEGORIES, make_object
from .kit.chance import Chance

#: Seeds of objects, of which training may use all; tests make theirs from seeds below this.
FIRST_SEED = 1_000_000
_LARGEST_SEED = 2**31 - 1
#: Whose surface an object has: ours, an artist's, an early image-to-3D tool's, a recent one's.
CHARACTERS: dict[str, Callable[[Articulation, int], Articulation]] = {
    "plain": lambda articulation, _: articulation,
    "artist": artist_like,
    "generated": fused_like,
    "skin": skin_like,
}
#: Objects made in search of one with few enough parts.
TRIES = 200


@dataclass(frozen=True)
class MixtureSettings:
    """Which objects, and in which shares.

    Attributes:
        categories: to draw from, each as often; empty: all there are.
        artist: weight of objects as artists and CAD programs leave them.
        generated: weight of objects as early image-to-3D tools gave them: coarse and bumpy.
        skin: weight of objects as recent ones give them.
        plain: share of the first kind that stays as made: closed solids side by side.
        most_parts: others are not used: the network cannot answer for more.
    """

    categories: tuple[str, ...] = ()
    artist: float = 0.7
    generated: float = 0.3
    skin: float = 0.0
    plain: float = 0.15
    most_parts: int = 16

    def __post_init__(self) -> None:
        object.__setattr__(self, "categories", tuple(self.categories))
        unknown = sorted(set(self.categories) - set(CATEGORIES))
        if unknown:
            names = ", ".join(CATEGORIES)
            raise ConfigError(f"categories: there is no {unknown}, want some of {names}")
        shares = self.weights.values()
        if min(shares) < 0.0 or sum(shares) <= 0.0:
            weights = ", ".join(f"{name} {weight}" for name, weight in self.weights.items())
            raise ConfigError(f"{weights}: want at least 0, one of them above")
        if not 0.0 <= self.plain <= 1.0:
            raise ConfigError(f"plain must be 0 to 1, not {self.plain}")
        if self.most_parts < 2:
            raise ConfigError(f"most_parts must be at least 2, not {self.most_parts}")

    @property
    def weights(self) -> dict[str, float]:
        """Return the weight of each character but the plain one."""
        return {"artist": self.artist, "generated": self.generated, "skin": self.skin}


def sample_object(
    rng: np.random.Generator, settings: MixtureSettings | None = None
) -> tuple[str, Articulation]:
    """Return a labelled object and its name, ``category-seed-character-seed``.

    Joint values 0 are closed, the front looks towards -Y.

    Raises:
        ConfigError: hardly any object of these categories has as few parts as wanted.
    """
    chosen = settings or MixtureSettings()
    kinds = chosen.categories or CATEGORIES
    chance = Chance(rng)
    for _ in range(TRIES):
        category = kinds[int(rng.integers(len(kinds)))]
        made, look = (int(seed) for seed in rng.integers(FIRST_SEED, _LARGEST_SEED, 2))
        character = chance.weighted(chosen.weights)
        if chance.happens(chosen.plain) and character == "artist":
            character = "plain"
        articulation = make_object(category, made)
        if sum(joint.movable for joint in articulation.joints) < chosen.most_parts:
            changed, character = in_character(articulation, character, look)
            return f"{category}-{made}-{character}-{look}", changed
    wanted = f"most_parts is {chosen.most_parts}, too few for {', '.join(kinds)}"
    raise ConfigError(f"{wanted}; want more, or other kinds")


def in_character(articulation: Articulation, character: str, seed: int) -> tuple[Articulation, str]:
    """Return the object with the surface of a certain origin, and which that is.

    One of :data:`CHARACTERS` with a part hidden from outside becomes ``artist``: no image shows it.

    Raises:
        ValueError: no such character.
    """
    if character not in CHARACTERS:
        wanted = f"want one of {', '.join(CHARACTERS)}"
        raise ValueError(f"character {character!r}: there is none of that name, {wanted}")
    try:
        return CHARACTERS[character](articulation, seed), character
    except ValueError:
        return artist_like(articulation, seed), "artist"
