"""What the construction knows of an object while it is made."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from ...articulation import Articulation, Joint
from ...asset import Hull, InnerSurface
from ...config import SolidsConfig
from ...intake.categories import Category
from ...mesh import BoolArray, FloatArray, IntArray
from ...views.raster import Side
from ...views.view import View
from ..poses import held_by
from .box import Box
from .bump import Bump
from .lattice import Lattice, Span
from .matter import PATH, Weights
from .panel import FlatPanel
from .seam import CutSkin

#: Surfaces that have the colour of an object's inside.
LINED = frozenset({"slab back", "frame", "hollow", "shelf"})


@dataclass
class Workpiece:
    """An object on its way, in the working frame.

    Attributes:
        source: parts and joints, turned into the working frame.
        config: of this stage.
        usual: inside of objects of its category.
        views: of its sides.
        joints: as they are now; hinges may have been moved.
        panels, bumps: by part.
        rest: parts of the mesh that are neither.
        skin: cut along the panels' sides.
        lattice: whose planes lie where panels and their gaps end.
        whole: cells within the mesh.
        owner: the part of every cell within the mesh; -1 outside.
        free: per part, how badly cells must stay free of its pieces, see ``pieces.py``.
        hollows: per panel, boxes behind it in its side's frame.
        lids: per panel, boxes within it.
        boards: per panel, of a drawer's box.
        shelves: per panel, behind it.
        hulls: per part, made so far.
        added: per part, and whether its inside has a colour of its own, triangles [m], [n, 3, 3].
        points: per part, of its surface [m], shape [n, 3]; see ``carve.surface_points``.
        filled: per panel, whether the space right behind it was filled.
        records: of every surface that was invented.
        notes: a sentence each.
    """

    source: Articulation
    config: SolidsConfig
    usual: Category
    views: dict[Side, View]
    joints: list[Joint]
    panels: dict[int, FlatPanel]
    bumps: dict[int, Bump]
    rest: list[int]
    skin: CutSkin
    lattice: Lattice
    whole: BoolArray
    owner: IntArray
    free: dict[int, Weights] = field(default_factory=dict)
    hollows: dict[int, tuple[Box, ...]] = field(default_factory=dict)
    lids: dict[int, tuple[Box, ...]] = field(default_factory=dict)
    boards: dict[int, tuple[Box, ...]] = field(default_factory=dict)
    shelves: dict[int, tuple[Box, ...]] = field(default_factory=dict)
    hulls: dict[int, tuple[Hull, ...]] = field(default_factory=dict)
    added: dict[tuple[int, bool], list[FloatArray]] = field(default_factory=dict)
    points: dict[int, FloatArray] = field(default_factory=dict)
    filled: dict[int, bool] = field(default_factory=dict)
    records: list[InnerSurface] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def name(self, part: int) -> str:
        """Return a part's name."""
        return self.source.parts[part].name

    def host(self, part: int) -> int:
        """Return the nearest part with faces that a part hangs on, or the root."""
        return held_by(self.source, part) or 0

    def closed_behind(self, part: int) -> bool:
        """Tell whether the space behind a panel is filled, so that its opening ends in a face."""
        return not self.panels[part].through and self.filled.get(part, True)

    def cells_of(self, panel: FlatPanel, box: Box) -> Span:
        """Return the cells whose centres lie in a box of a panel's frame."""
        return self.lattice.span(box.turned(panel.side.frame.T))

    def clear_way(self, part: int, passed: BoolArray | Span, weight: int = PATH) -> None:
        """Keep a part's pieces out of cells that something passes, and make its own nobody's."""
        self.block(part, passed, weight)
        owner = self.owner[passed]
        self.owner[passed] = np.where(owner == part, -1, owner)

    def add_boards(self, part: int, boards: Iterable[Box], panel: FlatPanel) -> None:
        """Add boards, in a panel's frame, to a part's pieces."""
        hulls = (board.turned(panel.side.frame.T).hull() for board in boards)
        self.hulls[part] += tuple(hull for hull in hulls if hull is not None)

    def block(self, part: int, cells: BoolArray | Span, weight: int) -> None:
        """Mark how badly cells must stay free of a part's pieces; worse marks stay."""
        known = self.blocked(part)
        known[cells] = np.maximum(known[cells], weight)

    def blocked(self, part: int) -> Weights:
        """Return how badly cells must stay free of a part's pieces, 0 where they need not."""
        if part not in self.free:
            self.free[part] = np.zeros(self.lattice.shape, dtype=np.uint8)
        return self.free[part]

    def add(
        self,
        part: int,
        triangles: FloatArray,
        kind: str,
        rule: str,
        *,
        panel: FlatPanel | None = None,
        thickness: float | None = None,
        depth: float | None = None,
    ) -> None:
        """Add a surface of a part, and a record of it; nothing where it has no triangles.

        Args:
            part: index.
            triangles: [m], shape [n, 3, 3]; in the panel's frame, if one is given.
            kind: as of :class:`~asset_factory.factory.asset.InnerSurface`, with what follows.
            rule: where its place comes from.
            panel: in whose frame the triangles are.
            thickness: of the matter behind it [m].
            depth: of a hollow or a box [m].
        """
        if not len(triangles):
            return
        turned = triangles if panel is None else triangles @ panel.side.frame
        if panel is not None and np.linalg.det(panel.side.frame) < 0.0:
            turned = turned[:, ::-1]
        lined = self.usual.liner is not None and kind in LINED
        self.added.setdefault((part, lined), []).append(turned)
        sizes = (None if each is None else round(float(each), 4) for each in (thickness, depth))
        self.records.append(InnerSurface(self.name(part), kind, rule, *sizes))
