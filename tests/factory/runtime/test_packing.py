"""What is packed comes back equal, and what was not packed is refused."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from asset_factory.factory.articulation import Joint, Part
from asset_factory.factory.runtime.packing import pack, unpack
from asset_factory.factory.runtime.store import Store


@dataclass(frozen=True)
class Box:
    """One field of each kind."""

    name: str
    size: float
    count: int
    whole: bool
    pair: tuple[str, float]
    many: tuple[int, ...]
    chosen: frozenset[str]
    shares: Mapping[str, float | None]
    free: Mapping[str, Any]
    inner: Box | None = None
    more: tuple[Box, ...] = ()


texts = st.text(max_size=8)
numbers = st.floats(allow_nan=False)
data = st.dictionaries(
    texts, st.none() | numbers | texts | st.lists(st.integers(), max_size=3), max_size=3
)


def boxes_with(**more):
    shares = st.dictionaries(texts, st.none() | numbers, max_size=3)
    pair = st.tuples(texts, numbers)
    return st.builds(Box, size=numbers, pair=pair, shares=shares, free=data, **more)


boxes = st.recursive(
    boxes_with(),
    lambda inner: boxes_with(inner=inner, more=st.lists(inner, max_size=2).map(tuple)),
    max_leaves=4,
)


@given(boxes)
def test_everything_comes_back_equal(box):
    assert unpack(Box, pack(box)) == box


def test_arrays_keep_their_bits_through_the_store(tmp_path):
    axis = np.array([1.0, 0.0, 0.0])
    joint = Joint("hinge", "revolute", 0, 1, axis, np.array([0.1, 1 / 3, 5e-324]), -0.0, 0.1 + 0.2)
    parts = (Part("base", np.arange(5), None), Part("door", np.arange(5, 9), 0.7))
    store = Store(tmp_path)
    store.save("some-key", pack((parts, (joint,))))
    kept = store.load("some-key")
    assert kept is not None
    back, (same,) = unpack(tuple[tuple[Part, ...], tuple[Joint, ...]], kept)
    assert same.origin.tobytes() == joint.origin.tobytes()
    assert (same.kind, same.lower, same.upper) == (joint.kind, joint.lower, joint.upper)
    assert not same.origin.flags.writeable
    assert [part.confidence for part in back] == [None, 0.7]
    assert [part.faces.tolist() for part in back] == [part.faces.tolist() for part in parts]


@dataclass(frozen=True)
class Other:
    """Nothing that a box has."""

    weight: float
    tags: tuple[str, ...] = field(default=())


@pytest.mark.parametrize(
    "arrays", [{}, {"text": np.array("{")}, {"text": np.array("[1]")}, pack(Other(1.0))]
)
def test_what_was_not_packed_is_refused(arrays):
    with pytest.raises(ValueError, match=r"no Box: |Expecting"):
        unpack(Box, arrays)
