"""Which links each engine lets touch: seen in its contacts, and said the same way in the report."""

from contextlib import closing
from dataclasses import replace

import numpy as np
import pytest
from box_world import joint_text, write_urdf
from engines import skipped_if_missing

from asset_factory.sim_checks.config import MotionConfig
from asset_factory.sim_checks.simulators.catalog import simulator

ENGINES = skipped_if_missing("sapien", "mujoco", "pybullet")
CUBE = (0.2, 0.2, 0.2)
NEAR = 0.1
FAR = 5.0
#: Kind of pair -> where each link's cube stands along x [m], and the joints as (kind, parent,
#: child). Of every world, the cubes of ``a`` and ``b``, and no others, overlap, by 10
#: cm.
WORLDS = {
    "static_parent": ({"a": 0.0, "b": NEAR}, [("prismatic", "a", "b")]),
    "moving_parent": (
        {"base": FAR, "a": 0.0, "b": NEAR},
        [("prismatic", "base", "a"), ("prismatic", "a", "b")],
    ),
    "siblings": (
        {"base": FAR, "a": 0.0, "b": NEAR},
        [("prismatic", "base", "a"), ("prismatic", "base", "b")],
    ),
    "across_fixed": (
        {"a": 0.0, "mid": FAR, "b": NEAR},
        [("fixed", "a", "mid"), ("prismatic", "mid", "b")],
    ),
    "grandparent": (
        {"base": 2 * FAR, "a": 0.0, "mid": FAR, "b": NEAR},
        [("prismatic", "base", "a"), ("prismatic", "a", "mid"), ("prismatic", "mid", "b")],
    ),
}
#: Engine, whether parents touch -> the kinds of pairs that do not touch.
APART = {
    ("sapien", True): {"static_parent", "moving_parent"},
    ("sapien", False): {"static_parent", "moving_parent"},
    ("mujoco", True): set(),
    ("mujoco", False): {"moving_parent"},
    ("pybullet", True): set(),
    ("pybullet", False): {"static_parent", "moving_parent"},
}


def write_world(folder, name):
    places, joints = WORLDS[name]
    text = "".join(joint_text(child, "1 0 0", 0.5, parent, kind) for kind, parent, child in joints)
    return write_urdf(folder, {name: ((x, 0.0, 0.0), CUBE) for name, x in places.items()}, text)


def look(path, engine, *, parents_touch=True):
    """Pairs that press on each other in the first step, and what the engine is said to enforce."""
    config = replace(MotionConfig(), parents_touch=parents_touch)
    with closing(simulator(engine).open(path, config)) as world:
        world.place(np.zeros(len(world.joints)))
        world.step(np.zeros(len(world.joints)))
        assert world.model.pairs is not None
        pressing = {pair for pair, touch in world.contacts().items() if touch.presses}
        return pressing, world.model.pairs


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("parents_touch", [True, False])
@pytest.mark.parametrize("kind", WORLDS)
def test_what_is_said_to_touch_is_seen_to_press(tmp_path, engine, kind, parents_touch):
    pressing, rules = look(write_world(tmp_path, kind), engine, parents_touch=parents_touch)
    assert pressing == (set() if kind in APART[engine, parents_touch] else {("a", "b")})
    assert bool(pressing) == {
        "static_parent": rules.static_parent,
        "moving_parent": rules.moving_parent,
    }.get(kind, True)
    assert rules.excluded == ()


@pytest.mark.parametrize(
    "exemption",
    [
        '<contact><exclude body1="b" body2="a"/></contact>',
        '<default><geom contype="2" conaffinity="4"/></default>',
    ],
)
def test_what_an_mjcf_exempts_is_named_and_does_not_touch(tmp_path, exemption):
    pytest.importorskip("mujoco")
    path = tmp_path / "boxes.xml"
    text = """<mujoco>EXEMPTION<worldbody>
        <body name="a"><geom type="box" size=".1 .1 .1"/><joint type="slide" axis="1 0 0"/></body>
        <body name="b" pos=".1 0 0"><geom type="box" size=".1 .1 .1"/>
        <joint type="slide" axis="1 0 0"/></body>
        </worldbody></mujoco>"""
    path.write_text(text.replace("EXEMPTION", ""))
    pressing, rules = look(path, "mujoco")
    assert (pressing, rules.excluded) == ({("a", "b")}, ())
    path.write_text(text.replace("EXEMPTION", exemption))
    pressing, rules = look(path, "mujoco")
    assert (pressing, rules.excluded) == (set(), (("a", "b"),))
    assert rules.words()["excluded"] == [["a", "b"]]


BARE = '<disable_collisions link1="b" link2="a"/><disable_collisions link1="a" link2="gone"/>'


@pytest.mark.parametrize(
    ("engine", "exempt"),
    [
        # It reads the file itself, wants reasons and knows of no link that is gone.
        ("sapien", '<disable_collisions link1="a" link2="b" reason="Default"/>'),
        ("mujoco", BARE),
        ("pybullet", BARE),
    ],
)
def test_what_an_srdf_exempts_is_named_and_does_not_touch(tmp_path, engine, exempt):
    pytest.importorskip(engine)
    path = write_world(tmp_path, "siblings")
    assert look(path, engine)[0] == {("a", "b")}
    path.with_suffix(".srdf").write_text(f'<robot name="boxes">{exempt}</robot>')
    pressing, rules = look(path, engine)
    assert (pressing, rules.excluded) == (set(), (("a", "b"),))
