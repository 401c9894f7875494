"""What the construction knows of an object while it is made."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...articulation import Articulation, Joint
from ...asset import Hull, InnerSurface
from ...config import SolidsConfig
from ...geometry.crossings import BoolArray, Side
from ...mesh import FloatArray, IntArray
from .box import Box
from .bump import Bump
from .lattice import Lattice
from .panel import Panel
from .seam import Skin
from .views import View


@dataclass
class Work:
    """An object on its way, in the working frame.

    Attributes:
        source: parts and joints, turned into the working frame.
        config: of this stage.
        views: of its sides.
        joints: as they are now; hinges may have been moved.
        panels, bumps: by part.
        rest: skin parts that are neither.
        skin: cut along the panels' sides.
        lattice: whose planes lie where panels and their gaps end.
        whole: cells within the skin.
        owner: the part of every cell within the skin; -1 outside.
        free: per part, cells that none of its pieces may fill.
        hollows: per panel, boxes behind it in its side's frame.
        lids: per panel, boxes within it.
        boards: per panel, of a drawer's box.
        hulls: per part, made so far.
        added: per part, triangles [m], shape [n, 3, 3].
        filled: per panel, whether what lies right behind it was filled.
        records: of every surface that was invented.
        notes: a sentence each.
    """

    source: Articulation
    config: SolidsConfig
    views: dict[Side, View]
    joints: list[Joint]
    panels: dict[int, Panel]
    bumps: dict[int, Bump]
    rest: list[int]
    skin: Skin
    lattice: Lattice
    whole: BoolArray
    owner: IntArray
    free: dict[int, BoolArray] = field(default_factory=dict)
    hollows: dict[int, tuple[Box, ...]] = field(default_factory=dict)
    lids: dict[int, tuple[Box, ...]] = field(default_factory=dict)
    boards: dict[int, tuple[Box, ...]] = field(default_factory=dict)
    hulls: dict[int, tuple[Hull, ...]] = field(default_factory=dict)
    added: dict[int, list[FloatArray]] = field(default_factory=dict)
    filled: dict[int, bool] = field(default_factory=dict)
    records: list[InnerSurface] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def name(self, part: int) -> str:
        """Of a part."""
        return self.source.parts[part].name

    def host(self, part: int) -> int:
        """The nearest part with faces that a part hangs on."""
        above = self.joints[part - 1].parent
        while above and not len(self.source.parts[above].faces):
            above = self.joints[above - 1].parent
        return above

    def closed_behind(self, part: int) -> bool:
        """Whether what lies behind a panel is filled, so that an opening would end in a face."""
        return self.filled.get(part, True)

    def blocked(self, part: int) -> BoolArray:
        """The cells that a part's pieces may not fill; to be added to."""
        if part not in self.free:
            self.free[part] = np.zeros(self.lattice.shape, dtype=bool)
        return self.free[part]

    def add(self, part: int, triangles: FloatArray, panel: Panel | None, record: InnerSurface) -> None:
        """A surface of a part; its triangles in the panel's frame, if one is given."""
        if not len(triangles):
            return
        turned = triangles if panel is None else triangles @ panel.side.frame
        if panel is not None and np.linalg.det(panel.side.frame) < 0.0:
            turned = turned[:, ::-1]
        self.added.setdefault(part, []).append(turned)
        self.records.append(record)
