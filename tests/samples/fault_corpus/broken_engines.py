"""What only shows once a simulator holds the file: other loaders, other worlds, motion."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import trimesh

from .broken_files import MJCF, URDF, in_mjcf
from .broken_lint import HINGE, HULL, SLIDE
from .exhibits import ENGINES, Exhibit, edited, mjcf, restated, urdf
from .good_things import button, cabinet, fridge, kiosk, nested, oven
from .things import with_body

PRESS = ".//joint[@name='press']"
SOFT_BUTTON = restated(mjcf(button()), PRESS, frictionloss="1", damping="0.04")


def broken_loading() -> Iterator[Exhibit]:
    """Files that loaders refuse, or of which they keep something else than what is written."""
    refuse = {"mujoco": "load_failed", "pybullet": "load_failed"}
    yield Exhibit("ply_collision.urdf", _as_ply, "load_failed", "error", (), refuse)
    long_axis = restated(URDF, f"{SLIDE}/axis", xyz="0 -2 0")
    misplaced = {"pybullet": "pose_mismatch"}
    yield Exhibit("axis_of_length_2.urdf", long_axis, "axis_not_unit", engines=misplaced)
    rubbing = edited(URDF, ("<limit ", '<dynamics damping="0.5" friction="0.5"/><limit '))
    yield Exhibit("joint_with_friction.urdf", rubbing, "friction_ignored", "note", ("sapien",))
    bare = edited(URDF, ("<inertial>", "<!--"), ("</inertial>", "-->"))
    yield Exhibit("base_without_inertia.urdf", bare, "inertia_invented", "warning", ("sapien",))
    without = ("sapien", "pybullet")
    yield Exhibit("not_every_engine_s_format.mjcf", MJCF, "format_not_loaded", "note", without)


def broken_dynamics() -> Iterator[Exhibit]:
    """Sound on paper, or told there in another word; wrong as soon as it moves."""
    weld = '<equality><weld body1="door" body2="carcass"/></equality></mujoco>'
    welded = in_mjcf("</mujoco>", weld)
    yield Exhibit("welded_door.mjcf", welded, "jammed", "error", ("mujoco",))
    spring = restated(MJCF, SLIDE, stiffness="1e9", springref="0.15")
    yield Exhibit("spring_that_explodes.mjcf", spring, "not_finite", "error", ("mujoco",))
    driving = restated(MJCF, HINGE, damping="-20")
    seen = {"mujoco": "energy_grows"}
    yield Exhibit("damping_that_drives.mjcf", driving, "invalid_dynamics", engines=seen)
    yield Exhibit("tray_on_a_door.urdf", urdf(nested()), "others_moved", "warning", ENGINES)
    yield Exhibit("door_that_falls_open.urdf", urdf(oven()), "opens_by_itself", "warning", ENGINES)


def creeping() -> Iterator[Exhibit]:
    """A button that its friction should hold, five times its weight."""
    rubbing = ("<limit ", '<dynamics friction="1" damping="0.04"/><limit ')
    yield Exhibit("button_that_creeps.mjcf", SOFT_BUTTON, "creeps", "error", ("mujoco",))
    stated = edited(urdf(button()), rubbing)
    yield Exhibit("button_of_a_urdf.urdf", stated, "creeps", "warning", ("mujoco",))


def holding() -> Iterator[Exhibit]:
    """The same button, its friction as stiff as MuJoCo lets it be."""
    stiff = restated(SOFT_BUTTON, PRESS, solimpfriction="0.9999 0.9999 0.001")
    yield Exhibit("button_that_holds.mjcf", stiff, None, "error", ())


def unsteady() -> Iterator[Exhibit]:
    """What stands on the floor and would not stay there."""
    heavy = with_body(fridge(), "shell", mass=1.0)
    yield Exhibit("top_heavy.urdf", urdf(heavy), "topples", "warning")
    light = with_body(cabinet(), "carcass", mass=1.0)
    yield Exhibit("too_light_to_pull.urdf", urdf(light), "topples_when_pulled", "warning")
    block = kiosk().bodies[0].pieces[0]
    point = np.vstack([block[block[:, 2] > 0.1], [0.0, 0.2, 0.0]])
    pointed = with_body(kiosk(), "carcass", pieces=(point,))
    yield Exhibit("on_a_point.urdf", urdf(pointed), "no_stable_footing", "warning")


def _as_ply(folder: Path) -> Path:
    path = edited(URDF, (HULL, "door.ply"))(folder)
    (folder / "door.ply").write_bytes(trimesh.load(folder / HULL).export(file_type="ply"))
    return path
