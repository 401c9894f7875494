"""A sidecar of parts is read strictly, and says what is wrong where."""

import json
import math
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusing import refusal

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.intake.files import InputFiles
from asset_factory.factory.intake.stated import (
    MOST_BYTES,
    MOST_PARTS,
    Hinge,
    read_stated,
    schema,
    stated_from,
)
from asset_factory.factory.part import PartKind
from asset_factory.factory.views.raster import Side

DOOR = {"kind": "door", "side": "front", "box": [0.1, 0.1, 0.9, 0.9]}


def named(name, parent):
    return {**DOOR, "name": name, "parent": parent}


def read(tmp_path, text, name="fridge.parts.json"):
    (tmp_path / name).write_text(text)
    return read_stated(tmp_path / "fridge.glb", InputFiles(tmp_path, IntakeConfig()))


def test_json_and_toml_state_the_same_and_no_file_nothing(tmp_path):
    assert read_stated(tmp_path / "fridge.glb", InputFiles(tmp_path, IntakeConfig())) is None
    by_json = read(tmp_path, json.dumps({"parts": [{**DOOR, "hinge": "left"}]}))
    (tmp_path / "fridge.parts.json").unlink()
    toml = '[[parts]]\nkind = "door"\nside = "front"\nbox = [0.1, 0.1, 0.9, 0.9]\nhinge = "left"\n'
    assert read(tmp_path, toml, "fridge.parts.toml") == by_json
    (part,) = by_json.parts
    assert (part.kind, part.side, part.hinge) == (PartKind.DOOR, Side.FRONT, Hinge.LEFT)
    # A kind alone is enough.
    assert stated_from({"parts": [{"kind": "drawer", "count": 3}]}).parts[0].count == 3


def test_the_name_with_its_ending_wins(tmp_path):
    (tmp_path / "fridge.glb.parts.json").write_text('{"opens": false}')
    assert read(tmp_path, "{}").opens is False


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"part": []}, "did you mean 'parts'?"),
        ({"parts": [{"kind": "dor"}]}, "$.parts[0].kind is 'dor'; did you mean 'door'?"),
        ({"parts": [{"kind": "body"}]}, "$.parts[0].kind is 'body'"),
        ({"parts": [{**DOOR, "hing": "left"}]}, "does not know 'hing'; did you mean 'hinge'?"),
        ({"parts": [{**DOOR, "side": "frnt"}]}, "$.parts[0].side is 'frnt'"),
        ({"parts": [{**DOOR, "side": "bottom"}]}, "$.parts[0].side is 'bottom'"),
        ({"parts": [{**DOOR, "also": [{"sid": "top"}]}]}, "$.parts[0].also[0] does not know 'sid'"),
        ({"parts": [{**DOOR, "box": [0, 0, 2, 1]}]}, "$.parts[0].box[2]"),
        ({"parts": [{**DOOR, "box": [0, 1, 1, 0]}]}, "x0 < x1 and y0 < y1"),
        ({"parts": [{**DOOR, "box": [0, 1]}]}, "$.parts[0].box"),
        ({"parts": [{"kind": "door", "side": "front"}]}, "side and box come together"),
        ({"parts": [{**DOOR, "count": 2}]}, "count is for parts without a box"),
        ({"parts": [{**DOOR, "name": "<b>door</b>"}]}, "name is a letter"),
        ({"parts": [{**DOOR, "name": "a"}, {**DOOR, "name": "a"}]}, "2 parts are named 'a'"),
        ({"parts": [{**DOOR, "parent": "left"}]}, "parent 'left' is no part's name"),
        ({"parts": [named("a", "b"), named("b", "a")]}, "is carried by what it carries"),
        ({"parts": [{**DOOR, "name": "base"}]}, "name is not base or world"),
        ({"parts": [{**DOOR, "alternatives": [{}]}]}, "a kind, a hinge or both"),
        ({"parts": [{**DOOR, "drawn": 1e30}]}, "$.parts[0].drawn"),
        ({"parts": [{**DOOR, "range": [1, 0]}]}, "range is [lower, upper]"),
        ({"parts": [{**DOOR, "range": [10, 90]}]}, "since 0 is as drawn"),
        ({"parts": [{**DOOR, "range": [0, 90], "drawn": 90}]}, "range starts below 0"),
        ({"parts": [{**DOOR, "drawn": -20}]}, "$.parts[0].drawn"),
        ({"parts": [{**DOOR, "drawn": "shut"}]}, "$.parts[0].drawn"),
        ({"parts": [{"kind": "drawer", "hinge": "left"}]}, "a drawer slides"),
        ({"parts": [DOOR] * (MOST_PARTS + 1)}, "$.parts"),
        ({"opens": False, "parts": [DOOR]}, "want one of the two"),
        ({"size": [1, 0, 1]}, "size is three positive numbers"),
        ({"parts": 3}, "$.parts"),
        ([], "Expected `object`"),
    ],
)
def test_what_cannot_be_meant_is_refused_with_its_place(values, said):
    with pytest.raises(ConfigError) as caught:
        stated_from(values)
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        *((text, "") for text in ("{", "[" * 100_000, "\x00", '{"parts": [{"kind": NaN}]}')),
        *(
            (json.dumps({"parts": [{**DOOR, "box": [0.0, 0.0, number, 1.0]}]}), "box")
            for number in (math.inf, math.nan)
        ),
        # It is not read.
        (" " * (MOST_BYTES + 1), f"at most {MOST_BYTES}"),
    ],
    ids=range(7),
)
def test_broken_text_is_refused(tmp_path, text, said):
    found = refusal(read, tmp_path, text)
    assert found.code == "bad_sidecar"
    assert "fridge.parts.json" in found.message
    assert said in found.message


def test_a_link_out_of_the_folder_is_refused(tmp_path):
    (tmp_path / "secret.json").write_text("{}")
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "fridge.parts.json").symlink_to(tmp_path / "secret.json")
    found = refusal(read_stated, inner / "fridge.glb", InputFiles(inner, IntakeConfig()))
    assert found.code == "external_reference"


FIELDS = st.sampled_from(["kind", "side", "box", "hinge", "name", "range", "drawn", "also"])
PLAIN = st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=8)
OBJECTS = st.lists(st.dictionaries(FIELDS, PLAIN, max_size=3), max_size=2)
VALUES = (
    PLAIN | st.lists(PLAIN, max_size=4) | OBJECTS | st.dictionaries(FIELDS, OBJECTS, max_size=1)
)


@given(st.lists(st.dictionaries(FIELDS, VALUES, max_size=4), max_size=3))
def test_any_document_is_a_statement_or_a_sentence(parts):
    with suppress(ConfigError):
        assert len(stated_from({"parts": parts}).parts) == len(parts)


def test_the_schema_names_every_field():
    text = json.dumps(schema())
    fields = ("parts", "front", "opens", "size", "box", "hinge", "drawn", "alternatives", "also")
    assert [name for name in fields if f'"{name}"' not in text] == []
