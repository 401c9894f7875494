"""Where Bullet's inverse dynamics refuses, the stand-in must say the same."""

from contextlib import closing

import numpy as np
import pytest

from asset_factory.sim_checks.config import MotionConfig
from asset_factory.sim_checks.simulators.pybullet_backend import PybulletSimulator

TURNED = """
<robot name="heavy">
  <link name="base"/>
  <link name="door">
    <inertial><origin xyz="0.52 0.23 -0.35" rpy="0.4 0 1"/><mass value="{mass}"/>
      <inertia ixx="{a}" iyy="{b}" izz="{c}" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0.3 0 0"/><geometry><box size="0.5 0.04 0.9"/></geometry></collision>
  </link>
  <link name="tray">
    <inertial><origin xyz="0 0.2 0.1" rpy="0.1 0.2 -0.4"/><mass value="{mass}"/>
      <inertia ixx="{b}" iyy="{c}" izz="{a}" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 3 0"/><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
  </link>
  <joint name="hinge" type="revolute"><parent link="base"/><child link="door"/>
    <origin xyz="0.1 0.2 0.3" rpy="0.2 -0.3 0.4"/><axis xyz="0 0.6 0.8"/>
    <limit lower="0" upper="1.5" effort="9" velocity="9"/></joint>
  <joint name="slide" type="prismatic"><parent link="door"/><child link="tray"/>
    <origin xyz="0.3 0 0" rpy="0 0.5 0"/><axis xyz="0.6 0 0.8"/>
    <limit lower="0" upper="0.4" effort="9" velocity="9"/></joint>
</robot>
"""


def opened(folder, mass, a, b, c):
    path = folder / "heavy.urdf"
    path.write_text(TURNED.format(mass=mass, a=a, b=b, c=c))
    return closing(PybulletSimulator().open(path, MotionConfig()))


def test_the_stand_in_agrees_with_bullet_where_bullet_answers(tmp_path):
    with opened(tmp_path, 2.0, 0.25, 0.25, 0.25) as world:
        world.place(np.array([0.7, 0.15]))
        theirs = world.mass_matrix(), world.balance(), world.energy()
        assert not world._dynamics._refuses
        world._dynamics._refuses = True
        ours = world.mass_matrix(), world.balance(), world.energy()
    np.testing.assert_allclose(ours[0], theirs[0], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(ours[1], theirs[1], rtol=1e-6, atol=1e-9)
    assert ours[2] == pytest.approx(theirs[2], rel=1e-6)


def test_kinetic_energy_agrees_in_motion(tmp_path):
    with opened(tmp_path, 2.0, 0.25, 0.25, 0.25) as world:
        world.place(np.array([0.2, 0.1]))
        for _ in range(30):
            world.step(np.array([3.0, 1.0]))
        theirs = world.energy()
        world._dynamics._refuses = True
        assert np.abs(world.velocities()).max() > 0.05
        assert world.energy() == pytest.approx(theirs, rel=1e-3)


def test_a_heavy_turned_body_is_balanced_though_bullet_refuses_it(tmp_path):
    with opened(tmp_path, 60.0, 4.0, 3.1, 6.0) as world:
        world.place(np.array([0.4, 0.1]))
        world.mass_matrix(), world.balance()
        said = "Bullet took it: this body no longer shows what the stand-in is for"
        assert world._dynamics._refuses, said
        for _ in range(120):
            world.step(world.balance())
        assert np.abs(world.positions() - [0.4, 0.1]).max() < 2e-3
