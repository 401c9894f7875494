"""Files that cannot be read, or must not be."""

from functools import partial

from .exhibits import edited, filed, listed, mjcf, restated, urdf
from .good_things import kiosk

URDF = urdf(kiosk())
MJCF = mjcf(kiosk())
HULL = "door_hull_0.obj"
SHAPE = f'<mesh filename="{HULL}"/>'
DOOR = ".//body[@name='door']/inertial"
LID = ".//body[@name='lid']"
LID_ORIGIN = ".//joint[@name='flap']/origin"
ENDLESS = '<cylinder radius="0.1" length="inf"/>'
#: Nine levels of ten: a billion words, were anyone to expand them.
BOMB = (
    '<!DOCTYPE robot [<!ENTITY a "ha">'
    + "".join(
        f'<!ENTITY {here} "{10 * f"&{before};"}">'
        for before, here in zip("abcdefgh", "bcdefghi", strict=True)
    )
    + ']><robot name="&i;">'
)
#: A grey pixel.
PNG = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108000000003a7e9b55"
    "0000000a49444154789c636800000082008177cd72b60000000049454e44ae426082"
)
ASSET = '<mujoco><asset><mesh name="inner" file="../secret.obj"/></asset></mujoco>'
MODEL = '<mujoco><worldbody><body name="inner"><geom size="0.1"/></body></worldbody></mujoco>'
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
#: A pyramid.
SOLID = TRIANGLE + "v 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
LOST_CORNER = "v nan 0 1\nf 1 2 3\nf 1 2 4\n"
INCLUDE = '<include file="../more.xml"/>'


def in_urdf(old, new):
    """The kiosk as URDF, with one text in the place of another."""
    return edited(URDF, (old, new))


def in_mjcf(old, new):
    """The kiosk as MJCF, edited in the same way."""
    return edited(MJCF, (old, new))


def _padded(folder):
    path = URDF(folder)
    with path.open("r+b") as file:
        file.truncate(2**26 + 1)
    return path


def _garbage(name):
    return filed(in_urdf(HULL, name), {name: b"neither a mesh nor a text \0\1\2"})


#: Writes in a subfolder, so that files may lie outside.
_beside = partial(filed, home="home")
INNER = in_mjcf("<worldbody>", '<include file="inner.xml"/><worldbody>')
TEXTURE = in_mjcf("<asset>", '<asset><texture name="t" type="2d" file="../secret.png"/>')
ATTACHED = in_mjcf("<asset>", '<asset><model name="m" file="../secret.xml"/>')
SECRET = {"../secret.obj": SOLID}
#: One file for every code of the readers.
BROKEN = listed(
    ("mesh_missing.urdf", "missing_file", filed(URDF, {HULL: None})),
    ("visual_missing.urdf", "missing_file", filed(URDF, {"door_seen_0.obj": None})),
    ("mesh_missing.mjcf", "unreadable", filed(MJCF, {HULL: None})),
    ("mesh_outside.urdf", "outside_folder", in_urdf(HULL, f"../{HULL}")),
    ("mesh_absolute.urdf", "outside_folder", in_urdf(HULL, "/etc/hostname")),
    ("mesh_from_the_net.urdf", "outside_folder", in_urdf(HULL, f"http://example.org/{HULL}")),
    ("mesh_outside.mjcf", "outside_folder", in_mjcf(HULL, f"../{HULL}")),
    ("include_outside.mjcf", "outside_folder", in_mjcf("<asset>", f"{INCLUDE}<asset>")),
    ("entity_bomb.urdf", "forbidden_doctype", in_urdf('<robot name="kiosk">', BOMB)),
    ("cut_off.urdf", "invalid_xml", in_urdf("</robot>", "")),
    ("cut_off.mjcf", "invalid_xml", in_mjcf("</mujoco>", "")),
    ("other_format.urdf", "unknown_format", edited(URDF, ("robot", "sdf"), count=-1)),
    ("empty_robot.urdf", "no_links", filed(URDF, {"kiosk.urdf": '<robot name="nothing"/>'})),
    ("link_without_name.urdf", "missing_name", in_urdf('<link name="door">', "<link>")),
    ("joint_without_child.urdf", "missing_element", in_urdf('<child link="door"/>', "")),
    ("no_geometry.urdf", "missing_geometry", in_urdf(SHAPE, "")),
    ("cone.urdf", "unknown_geometry", in_urdf(SHAPE, '<cone radius="1"/>')),
    ("no_radius.urdf", "missing_number", in_urdf(SHAPE, '<sphere diameter="1"/>')),
    ("origin_nan.urdf", "not_finite", in_urdf('xyz="0.0 -0.004', 'xyz="nan -0.004')),
    ("sphere_nan.urdf", "not_finite", in_urdf(SHAPE, '<sphere radius="nan"/>')),
    ("rod_without_end.urdf", "not_finite", in_urdf(SHAPE, ENDLESS)),
    ("origin_1e300.urdf", "not_finite", restated(URDF, LID_ORIGIN, xyz="1e300 0 0")),
    ("scale_1e200.urdf", "not_finite", in_urdf(f'"{HULL}"/>', f'"{HULL}" scale="1e200 1 1"/>')),
    ("lid_at_nan.mjcf", "not_finite", restated(MJCF, LID, pos="nan 0 0")),
    ("geom_at_infinity.mjcf", "not_finite", restated(MJCF, f"{LID}/geom", pos="inf 0 0")),
    ("limit_in_words.urdf", "invalid_number", in_urdf('upper="0.3"', 'upper="wide"')),
    ("step_file.urdf", "unsupported_mesh", _garbage("door.step")),
    ("garbage_mesh.urdf", "unreadable_mesh", _garbage("door.glb")),
    ("face_out_of_range.urdf", "unreadable_mesh", filed(URDF, {HULL: TRIANGLE + "f 1 2 9\n"})),
    ("empty_mesh.urdf", "empty_mesh", filed(URDF, {HULL: "# nothing\n"})),
    ("mesh_nan.urdf", "not_finite", filed(URDF, {HULL: TRIANGLE + LOST_CORNER})),
    ("needle_inertia.mjcf", "unreadable", restated(MJCF, DOOR, fullinertia="0.9 0.01 0.01 0 0 0")),
    ("negative_mass.mjcf", "unreadable", in_mjcf('mass="2.5"', 'mass="-2.5"')),
    ("axis_zero.mjcf", "unreadable", in_mjcf('axis="0.0 -1.0 0.0"', 'axis="0 0 0"')),
    ("limits_swapped.mjcf", "unreadable", in_mjcf('range="0.0 0.3"', 'range="0.3 0.0"')),
    ("names_twice.mjcf", "unreadable", in_mjcf('<joint name="hinge"', '<joint name="slide"')),
    ("huge_document.urdf", "too_large", _padded),
    # References that lead to a file just outside the folder, which is there.
    ("include_reaches_out.mjcf", "outside_folder", _beside(INNER, SECRET | {"inner.xml": ASSET})),
    ("texture_outside.mjcf", "outside_folder", _beside(TEXTURE, {"../secret.png": PNG})),
    ("model_outside.mjcf", "outside_folder", _beside(ATTACHED, {"../secret.xml": MODEL})),
    ("mesh_just_outside.urdf", "outside_folder", _beside(in_urdf(HULL, "../secret.obj"), SECRET)),
)
