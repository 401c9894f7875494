"""What only shows once a simulator holds the file: other loaders, other worlds, motion."""

from pathlib import Path

import numpy as np
import trimesh

from .broken_files import HULL, MJCF, URDF, in_mjcf
from .broken_lint import HINGE, SLIDE
from .exhibits import ENGINES, Exhibit, edited, mjcf, restated, urdf
from .good_things import button, cabinet, fridge, kiosk, nested, oven
from .things import with_body


def _as_ply(folder: Path) -> Path:
    path = edited(URDF, (HULL, "door.ply"))(folder)
    (folder / "door.ply").write_bytes(trimesh.load(folder / HULL).export(file_type="ply"))
    return path


REFUSED = {"mujoco": "load_failed", "pybullet": "load_failed"}
MISPLACED = {"pybullet": "pose_mismatch"}
NO_MJCF = ("sapien", "pybullet")
DRIVEN = {"mujoco": "energy_grows"}
LONG_AXIS = restated(URDF, f"{SLIDE}/axis", xyz="0 -2 0")
RUBBING = edited(URDF, ("<limit ", '<dynamics damping="0.5" friction="0.5"/><limit '))
BARE = edited(URDF, ("<inertial>", "<!--"), ("</inertial>", "-->"))
WELD = '<equality><weld body1="door" body2="carcass"/></equality></mujoco>'
SPRUNG = restated(MJCF, SLIDE, stiffness="1e9", springref="0.15")
DRIVING = restated(MJCF, HINGE, damping="-20")
PRESS = ".//joint[@name='press']"
#: A button that its friction should hold, five times its weight.
SOFT = restated(mjcf(button()), PRESS, frictionloss="1", damping="0.04")
STATED = edited(urdf(button()), ("<limit ", '<dynamics friction="1" damping="0.04"/><limit '))
STIFF = restated(SOFT, PRESS, solimpfriction="0.9999 0.9999 0.001")
LIGHT = with_body(cabinet(), "carcass", mass=1.0)
(BLOCK,) = kiosk().bodies[0].pieces
POINT = np.vstack([BLOCK[BLOCK[:, 2] > 0.1], [0.0, 0.2, 0.0]])
POINTED = urdf(with_body(kiosk(), "carcass", pieces=(POINT,)))
BROKEN = (
    # Files that loaders refuse, or of which they keep something else than is written.
    Exhibit("ply_collision.urdf", _as_ply, "load_failed", "error", (), REFUSED),
    Exhibit("axis_of_length_2.urdf", LONG_AXIS, "axis_not_unit", engines=MISPLACED),
    Exhibit("joint_with_friction.urdf", RUBBING, "friction_ignored", "note", ("sapien",)),
    Exhibit("base_without_inertia.urdf", BARE, "inertia_invented", "warning", ("sapien",)),
    Exhibit("not_every_engine_s_format.mjcf", MJCF, "format_not_loaded", "note", NO_MJCF),
    # Sound on paper, or told there in another word; wrong as soon as it moves.
    Exhibit("welded_door.mjcf", in_mjcf("</mujoco>", WELD), "jammed", "error", ("mujoco",)),
    Exhibit("spring_that_explodes.mjcf", SPRUNG, "not_finite", "error", ("mujoco",)),
    Exhibit("damping_that_drives.mjcf", DRIVING, "invalid_dynamics", engines=DRIVEN),
    Exhibit("tray_on_a_door.urdf", urdf(nested()), "others_moved", "warning", ENGINES),
    Exhibit("door_that_falls_open.urdf", urdf(oven()), "opens_by_itself", "warning", ENGINES),
    Exhibit("button_that_creeps.mjcf", SOFT, "creeps", "error", ("mujoco",)),
    Exhibit("button_of_a_urdf.urdf", STATED, "creeps", "warning", ("mujoco",)),
    # Assets on the floor that would not stay there.
    Exhibit("top_heavy.urdf", urdf(with_body(fridge(), "shell", mass=1.0)), "topples", "warning"),
    Exhibit("too_light_to_pull.urdf", urdf(LIGHT), "topples_when_pulled", "warning"),
    Exhibit("on_a_point.urdf", POINTED, "no_stable_footing", "warning"),
)
#: The same button, its friction as stiff as MuJoCo lets it be.
SOUND = (Exhibit("button_that_holds.mjcf", STIFF, None, "error", ()),)
