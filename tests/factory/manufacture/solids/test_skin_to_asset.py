"""A small labelled skin becomes an asset of built solids, which is kept."""

from labelled_skins import cupboard
from manufactured import manufactured


def test_a_skin_is_built_once_says_what_was_invented_and_is_kept(tmp_path):
    asset, _, stages = manufactured(cupboard(), tmp_path)
    assert stages.done == ["solids", "finish"]
    assert {body.decomposition for body in asset.bodies} == {"built"}
    assert {"hollow", "slab back", "rim", "frame"} <= {each.kind for each in asset.invented}
    again, _, stages = manufactured(cupboard(), tmp_path)
    assert (stages.done, stages.reused) == ([], ["solids", "finish"])
    assert again.invented == asset.invented
    for one, other in zip(asset.bodies, again.bodies, strict=True):
        hulls = zip(one.hulls, other.hulls, strict=True)
        assert all(a.vertices.tobytes() == b.vertices.tobytes() for a, b in hulls)
