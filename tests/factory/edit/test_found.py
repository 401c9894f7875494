"""What an object's parts are, is stated as a person would, so that stating it finds them again."""

import pytest
from msgspec import to_builtins
from one_piece import doors, drawers, fridge

from asset_factory.factory.articulate.stated import StatedArticulator
from asset_factory.factory.display.made import scene_of_articulation
from asset_factory.factory.edit.found import found_parts
from asset_factory.factory.intake.stated import stated_from

DRAWER = {"kind": "drawer", "side": "front", "box": [0.05, 0.38, 0.95, 0.67]}
HATCH = {"kind": "flap", "side": "right", "box": [0.1, 0.1, 0.9, 0.5], "hinge": "top"}
COFFER = {"kind": "lid", "side": "top", "box": [0.1, 0.2, 0.4, 0.8], "hinge": "back"}
LID = {"kind": "lid", "side": "front", "box": [0.0, 0.67, 1.0, 1.0], "hinge": "back"}
DOOR = {"kind": "door", "side": "front", "box": [0.03, 0.04, 0.5, 0.96], "hinge": "left"}
KNOB = {"kind": "knob", "side": "front", "box": [0.42, 0.44, 0.47, 0.71], "parent": "west"}


@pytest.mark.parametrize(
    ("mesh", "parts"),
    [
        (drawers(), [DRAWER]),
        (drawers(), [HATCH]),
        (doors(), [COFFER]),
        (fridge(), [LID]),
        (doors(), [{**DOOR, "name": "west"}, KNOB]),
    ],
)
def test_what_was_stated_is_found_in_what_it_became(mesh, parts):
    made = StatedArticulator(stated_from({"parts": parts})).articulate(mesh)
    kinds = {part.name: part.kind for part in made.parts}
    found = to_builtins(found_parts(mesh, scene_of_articulation("it", made), kinds))["parts"]
    for part, again in zip(parts, found, strict=True):
        # Handles belong to their panels, and reach beyond their outlines.
        assert again.pop("box") == pytest.approx(part["box"], abs=0.05)
        assert again == {name: value for name, value in part.items() if name != "box"}
