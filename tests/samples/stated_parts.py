"""What comes of stated parts, and blocks to state them of."""

import numpy as np
from manifold3d import Manifold

from asset_factory.factory.articulate.stated import StatedArticulator
from asset_factory.factory.intake.stated import stated_from

#: A pixel of a side's picture, and a groove's half [m].
FINE = 0.02


def articulated(mesh, *parts, **stated):
    return StatedArticulator(stated_from({"parts": list(parts), **stated})).hypotheses(mesh)


def block(low, high):
    return Manifold.cube(np.subtract(high, low).tolist()).translate(low)


def box_of(articulation, part):
    """Lower and upper corner of a part [m], shape [2, 3]."""
    return articulation.part_mesh(part).bounds
