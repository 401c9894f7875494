"""The tree is the most probable one, in the released reading and in the paper's."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from stored_arrays import arrays

from asset_factory.factory.models.particulate.decoding import induced, spanning_arborescence


def weight(logits, edges):
    return -sum(np.logaddexp(0.0, -float(logits[i, j])) for i, j in edges)


def every_tree(parts):
    """All rooted trees over ``parts``, as (parent, child)."""
    for root in parts:
        others = [p for p in parts if p != root]
        for parents in itertools.product(parts, repeat=len(others)):
            above = dict(zip(others, parents, strict=True))
            if all(leads_to(root, part, above) for part in others):
                yield [(parent, child) for child, parent in above.items()]


def leads_to(root, part, above):
    for _ in above:
        part = above[part]
        if part == root:
            return True
    return False


@pytest.mark.parametrize("index", range(12))
def test_the_tree_is_that_of_the_release_or_a_likelier_one(fixtures, index):
    held = arrays(fixtures / "geometry" / "arborescence.npz")
    logits = held[f"m{index}_logits"]
    edges = [tuple(e) for e in held[f"m{index}_edges"].tolist()]
    found = spanning_arborescence(logits, np.arange(len(logits)))
    assert weight(logits, edges) == pytest.approx(float(held[f"m{index}_weight"]), abs=1e-5)
    if index < 11:
        assert sorted(found) == sorted(edges)
    else:
        # Single precision, as the release has it, cannot tell the best of these.
        assert weight(logits, found) >= weight(logits, edges)


@given(st.integers(0, 10**6), st.integers(1, 4))
def test_no_tree_is_likelier(seed, count):
    logits = np.random.default_rng(seed).normal(size=(count, count)) * 5
    found = spanning_arborescence(logits, np.arange(count))
    best = max((weight(logits, edges) for edges in every_tree(list(range(count)))), default=0.0)
    assert weight(logits, found) == pytest.approx(best)
    assert len(found) == count - 1
    assert len({child for _, child in found}) == count - 1


def test_only_the_parts_asked_for_take_part():
    logits = np.zeros((5, 5))
    logits[2, :] = 9.0
    logits[1, 3] = 5.0
    assert spanning_arborescence(logits, np.array([1, 3])) == ((1, 3),)
    assert spanning_arborescence(logits, np.array([3])) == ()
    assert spanning_arborescence(logits, np.array([], dtype=int)) == ()


def test_a_lost_parts_children_go_to_its_nearest_surviving_ancestor():
    chain = ((0, 1), (1, 2), (2, 3), (1, 4))
    assert induced(chain, np.array([0, 3, 4])) == ((0, 3), (0, 4))
    assert induced(chain, np.array([0, 2, 3])) == ((0, 2), (2, 3))
    assert induced(chain, np.arange(5)) == ((0, 1), (1, 2), (2, 3), (1, 4))
    assert induced(chain, np.array([2, 4])) == (), "without the root there may be several trees"


def test_the_paper_and_the_release_read_different_trees():
    """In the paper a part that nobody sees can still stand between two others."""
    logits = np.full((3, 3), -2.0)
    logits[0, 1] = logits[1, 2] = 6.0
    logits[2, 0] = -1.0
    present = np.array([0, 2])
    paper = induced(spanning_arborescence(logits, np.arange(3)), present)
    released = spanning_arborescence(logits, present)
    assert paper == ((0, 2),)
    assert released == ((2, 0),)
