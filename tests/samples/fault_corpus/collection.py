"""Everything there is to see, in a fixed order."""

from . import broken_engines, broken_files, broken_lint, broken_motion
from .exhibits import Exhibit, both, urdf
from .good_things import GOOD, laptop
from .realistic import made

#: Kinds of the factory's generator that take part in every test; the others take too long for that.
QUICK = ("fridge", "laptop", "chest")
ALL = ("cabinet", "fridge", "oven", "microwave", "dishwasher", "laptop", "chest", "trash_can")


def good(categories: tuple[str, ...] = QUICK) -> tuple[Exhibit, ...]:
    """Sound exhibits: things of boxes, and the generator's objects of these categories."""
    things = [exhibit for make in GOOD for exhibit in both(make().name, make(), None)]
    objects = [
        Exhibit(f"made_{category}.{suffix}", made(category, 1, suffix), None, "error", ())
        for category in categories
        for suffix in ("urdf", "mjcf")
    ]
    return (*things, *broken_lint.SOUND, *broken_engines.SOUND, *objects)


def broken() -> tuple[Exhibit, ...]:
    """Each broken in one way."""
    modules = (broken_files, broken_lint, broken_motion, broken_engines)
    return tuple(exhibit for module in modules for exhibit in module.BROKEN)


def blind_spots() -> tuple[Exhibit, ...]:
    """Those on which the judge errs: a fault that it does not see, or a sound one it rejects."""
    # PyBullet keeps 1 mm around every hull: what is less than 2 mm apart jams there.
    return (Exhibit("tight_laptop.urdf", urdf(laptop(0.0018)), None, "error", ()),)
