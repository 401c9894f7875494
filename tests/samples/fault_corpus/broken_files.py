"""Files that cannot be read, or must not be."""

from .exhibits import Exhibit, edited, mjcf, refiled, restated, urdf
from .good_things import kiosk

URDF = urdf(kiosk())
MJCF = mjcf(kiosk())
DOOR = ".//body[@name='door']/inertial"
LID = ".//body[@name='lid']"
LID_ORIGIN = ".//joint[@name='flap']/origin"
NEEDLE = "0.9 0.01 0.01 0 0 0"
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
LOST_CORNER = "v nan 0 1\nf 1 2 3\nf 1 2 4\n"
INCLUDE = '<include file="../more.xml"/>'


def in_urdf(old, new):
    """The kiosk as URDF, with one text in the place of another."""
    return edited(URDF, (old, new))


def in_mjcf(old, new):
    """The kiosk as MJCF, edited in the same way."""
    return edited(MJCF, (old, new))


def broken_files():
    """One file for every code of the readers."""
    hull = "door_hull_0.obj"
    shape = f'<mesh filename="{hull}"/>'
    for name, code, build in (
        ("mesh_missing.urdf", "missing_file", refiled(URDF, hull, None)),
        ("visual_missing.urdf", "missing_file", refiled(URDF, "door_seen_0.obj", None)),
        ("mesh_missing.mjcf", "unreadable", refiled(MJCF, hull, None)),
        ("mesh_outside.urdf", "outside_folder", in_urdf(hull, f"../{hull}")),
        ("mesh_absolute.urdf", "outside_folder", in_urdf(hull, "/etc/hostname")),
        ("mesh_from_the_net.urdf", "outside_folder", in_urdf(hull, f"http://example.org/{hull}")),
        ("mesh_outside.mjcf", "outside_folder", in_mjcf(hull, f"../{hull}")),
        ("include_outside.mjcf", "outside_folder", in_mjcf("<asset>", f"{INCLUDE}<asset>")),
        ("entity_bomb.urdf", "forbidden_doctype", in_urdf('<robot name="kiosk">', BOMB)),
        ("cut_off.urdf", "invalid_xml", in_urdf("</robot>", "")),
        ("cut_off.mjcf", "invalid_xml", in_mjcf("</mujoco>", "")),
        ("other_format.urdf", "unknown_format", edited(URDF, ("robot", "sdf"), count=-1)),
        ("empty_robot.urdf", "no_links", lambda folder: _text(folder, '<robot name="nothing"/>')),
        ("link_without_name.urdf", "missing_name", in_urdf('<link name="door">', "<link>")),
        ("joint_without_child.urdf", "missing_element", in_urdf('<child link="door"/>', "")),
        ("no_geometry.urdf", "missing_geometry", in_urdf(shape, "")),
        ("cone.urdf", "unknown_geometry", in_urdf(shape, '<cone radius="1"/>')),
        ("no_radius.urdf", "missing_number", in_urdf(shape, '<sphere diameter="1"/>')),
        ("origin_nan.urdf", "not_finite", in_urdf('xyz="0.0 -0.004', 'xyz="nan -0.004')),
        ("sphere_nan.urdf", "not_finite", in_urdf(shape, '<sphere radius="nan"/>')),
        ("rod_without_end.urdf", "not_finite", in_urdf(shape, ENDLESS)),
        ("origin_1e300.urdf", "not_finite", restated(URDF, LID_ORIGIN, xyz="1e300 0 0")),
        ("scale_1e200.urdf", "not_finite", in_urdf(f'"{hull}"/>', f'"{hull}" scale="1e200 1 1"/>')),
        ("lid_at_nan.mjcf", "not_finite", restated(MJCF, LID, pos="nan 0 0")),
        ("geom_at_infinity.mjcf", "not_finite", restated(MJCF, f"{LID}/geom", pos="inf 0 0")),
        ("limit_in_words.urdf", "invalid_number", in_urdf('upper="0.3"', 'upper="wide"')),
        ("step_file.urdf", "unsupported_mesh", _renamed(hull, "door.step")),
        ("garbage_mesh.urdf", "unreadable_mesh", _renamed(hull, "door.glb")),
        ("face_out_of_range.urdf", "unreadable_mesh", refiled(URDF, hull, TRIANGLE + "f 1 2 9\n")),
        ("empty_mesh.urdf", "empty_mesh", refiled(URDF, hull, "# nothing\n")),
        ("mesh_nan.urdf", "not_finite", refiled(URDF, hull, TRIANGLE + LOST_CORNER)),
        ("needle_inertia.mjcf", "unreadable", restated(MJCF, DOOR, fullinertia=NEEDLE)),
        ("negative_mass.mjcf", "unreadable", in_mjcf('mass="2.5"', 'mass="-2.5"')),
        ("axis_zero.mjcf", "unreadable", in_mjcf('axis="0.0 -1.0 0.0"', 'axis="0 0 0"')),
        ("limits_swapped.mjcf", "unreadable", in_mjcf('range="0.0 0.3"', 'range="0.3 0.0"')),
        ("names_twice.mjcf", "unreadable", in_mjcf('<joint name="hinge"', '<joint name="slide"')),
        ("huge_document.urdf", "too_large", _padded),
    ):
        yield Exhibit(name, build, code)


def _text(folder, text):
    path = folder / "text.urdf"
    path.write_text(text)
    return path


def _renamed(hull, name):
    def write(folder):
        path = in_urdf(hull, name)(folder)
        (folder / name).write_bytes(b"neither a mesh nor a text \0\1\2")
        return path

    return write


def _padded(folder):
    path = URDF(folder)
    with path.open("r+b") as file:
        file.truncate(2**26 + 1)
    return path


def reaching_out():
    """References that lead to a file just outside the folder, which is there."""
    include = in_mjcf("<worldbody>", '<include file="inner.xml"/><worldbody>')
    texture = in_mjcf("<asset>", '<asset><texture name="t" type="2d" file="../secret.png"/>')
    model = in_mjcf("<asset>", '<asset><model name="m" file="../secret.xml"/>')
    mesh = in_urdf("door_hull_0.obj", "../secret.obj")
    copied = {"secret.obj": "door_hull_0.obj"}
    for name, build in (
        ("include_reaches_out.mjcf", _beside(include, {"inner.xml": ASSET.encode()}, copied)),
        ("texture_outside.mjcf", _beside(texture, {}, {"secret.png": PNG})),
        ("model_outside.mjcf", _beside(model, {}, {"secret.xml": MODEL.encode()})),
        ("mesh_just_outside.urdf", _beside(mesh, {}, copied)),
    ):
        yield Exhibit(name, build, "outside_folder")


def _beside(build, inside, outside):
    """Write in a subfolder, other files beside it and some outside; text names one to copy."""

    def write(folder):
        home = folder / "home"
        home.mkdir()
        path = build(home)
        for name, content in inside.items():
            (home / name).write_bytes(content)
        for name, source in outside.items():
            content = (home / source).read_bytes() if isinstance(source, str) else source
            (folder / name).write_bytes(content)
        return path

    return write
