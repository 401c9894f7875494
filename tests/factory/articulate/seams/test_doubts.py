"""What is no panel, and when doubts about panels count."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.samples import one_piece

from asset_factory.factory.articulate.seams import reading
from asset_factory.factory.articulate.seams.fronts import fronts_of
from asset_factory.factory.articulate.seams.lids import Lid
from asset_factory.factory.articulate.seams.panels import usable
from asset_factory.factory.articulate.seams.rectangles import Rectangle
from asset_factory.factory.articulate.seams.relief import reliefs_of
from asset_factory.factory.geometry.crossings import Side


def test_slivers_are_no_doors() -> None:
    scene = fronts_of(reliefs_of(one_piece.plain_box(), None))[Side.FRONT].scene
    bottom, top, left, _ = scene.relief.box
    tall = top - bottom - 20
    door, sliver = (
        Rectangle(
            np.array([bottom + 10, left + 10]),
            np.array([top - 10, left + 10 + round(share * tall)]),
            np.ones(4),
            np.ones(4),
        )
        for share in (0.2, 0.1)
    )
    assert usable(scene, [door, sliver]) == [door]


@pytest.mark.parametrize(("shown", "wanted"), [(0.95, ["door", "door"]), (0.5, ["lid"])])
def test_doubtful_panels_yield_to_a_lid_unless_the_network_sees_them(
    monkeypatch: pytest.MonkeyPatch, shown: float, wanted: list[str]
) -> None:
    seen = reading._Sides.of(reliefs_of(one_piece.doors(), None))
    assert len(seen.panels) == 2
    lid = Lid(seen.front.relief.box[1] // 2, seen.value - 2.0, ((Side.BACK, 0.0),))
    sight = seen.front.sight
    seen.front.__dict__["sight"] = replace(sight, panel=np.full_like(sight.panel, shown))
    monkeypatch.setattr(reading, "value_of", lambda *_: -1.0)
    movers = reading._openings(replace(seen, lids=[lid]), has_knobs=False)[0].movers
    assert [mover.name.split("_")[0] for mover in movers] == wanted
