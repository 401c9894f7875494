"""Joints driven at the same time: only where nothing that they move can meet."""

import pytest

from asset_factory.sim_checks.geometry.apart import joints_apart
from asset_factory.sim_checks.read.read import read_description

BOX = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'


def joint(name, at, kind="prismatic", parent="base", more=""):
    return f"""<link name="{name}_box">{BOX}</link>
    <joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{name}_box"/>
    <origin xyz="{at} 0 0"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.3" effort="1" velocity="1"/>{more}</joint>"""


def groups(folder, *joints):
    path = folder / "row.urdf"
    path.write_text(f'<robot name="row"><link name="base"/>{"".join(joints)}</robot>')
    return joints_apart(read_description(path))


@pytest.mark.parametrize(("gap", "found"), [(0.004, ()), (0.006, (("a", "b"),))])
def test_slides_side_by_side_are_apart_by_more_than_a_margin(tmp_path, gap, found):
    assert groups(tmp_path, joint("a", 0.0), joint("b", 0.1 + gap)) == found


def test_neighbours_go_into_different_groups(tmp_path):
    row = [joint(name, 0.102 * i) for i, name in enumerate("abcde")]
    assert groups(tmp_path, *row) == (("a", "c", "e"), ("b", "d"))


def test_a_hinge_needs_room_for_its_whole_turn(tmp_path):
    # The corner of a box that turns about its centre comes nearer than its side.
    assert groups(tmp_path, joint("a", 0.0, "revolute"), joint("b", 0.107)) == ()
    assert groups(tmp_path, joint("a", 0.0, "revolute"), joint("b", 0.13)) == (("a", "b"),)


def test_what_carries_or_follows_another_joint_is_driven_alone(tmp_path):
    carrying = joint("rider", 0.2, parent="a_box")
    found = groups(tmp_path, joint("a", 0.0), carrying, joint("b", 0.5), joint("c", 0.8))
    assert found == (("rider", "b", "c"),)
    following = joint("led", 0.2, more='<mimic joint="a"/>')
    assert groups(tmp_path, joint("a", 0.0), following, joint("b", 0.5)) == ()
