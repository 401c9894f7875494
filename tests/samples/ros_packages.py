"""Small packages laid out as those of the world are: a cabinet whose drawer slides, in boxes."""

from pathlib import Path

import trimesh

PACKAGE = '<?xml version="1.0"?><package format="2"><name>{}</name></package>'
SLIDE = (
    '<joint name="slide" type="prismatic"><parent link="shell"/><child link="drawer"/>'
    '<axis xyz="1 0 0"/><limit lower="0" upper="0.3" effort="10" velocity="1"/></joint>'
)
#: Size and centre [m] of the two meshes, in the frame of the whole.
MESHES = {
    "shell": ((0.4, 0.1, 0.4), (0.0, 0.3, 0.0)),
    "drawer": ((0.4, 0.2, 0.4), (0.0, 0.147, 0.0)),
}


def write_meshes(folder: Path) -> None:
    """Write a box for each link."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, (size, center) in MESHES.items():
        box = trimesh.creation.box(size)
        box.apply_translation(center)
        box.export(folder / f"{name}.obj")


def link(name: str, reference: str) -> str:
    """Return a link that is seen and touched as one mesh."""
    shape = f'<geometry><mesh filename="{reference}"/></geometry>'
    inertial = (
        '<inertial><origin xyz="0 0.2 0"/><mass value="2"/><inertia ixx="0.03" ixy="0" ixz="0"'
        ' iyy="0.03" iyz="0" izz="0.03"/></inertial>'
    )
    return (
        f'<link name="{name}">{inertial}<visual>{shape}</visual><collision>{shape}</collision>'
        "</link>"
    )


def urdf_text(before: str) -> str:
    """Return a cabinet whose meshes' names begin so."""
    links = "".join(link(name, f"{before}{name}.obj") for name in MESHES)
    return f'<?xml version="1.0"?><robot name="cabinet">{links}{SLIDE}</robot>'


def write_package(folder: Path, name: str, before: str, urdf: str = "urdf/cabinet.urdf") -> Path:
    """Write a package with ``urdf`` and ``meshes``; returns its URDF.

    Args:
        folder: of the package, whose ``package.xml`` gives it ``name``.
        name: empty for a folder without ``package.xml``.
        before: what names of meshes begin with.
        urdf: where the URDF lies.
    """
    write_meshes(folder / "meshes")
    if name:
        (folder / "package.xml").write_text(PACKAGE.format(name))
    path = folder / urdf
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(urdf_text(before))
    return path


def write_mjcf_package(folder: Path, compiler: str, before: str, include: str = "") -> Path:
    """Write a package whose MJCF lies beside its meshes' folder; returns the MJCF."""
    write_meshes(folder / "meshes")
    (folder / "package.xml").write_text(PACKAGE.format("cabinet"))
    bodies = (
        '<worldbody><body name="shell"><geom type="mesh" mesh="shell"/><body name="drawer">'
        '<joint name="slide" type="slide" axis="1 0 0" range="0 0.3"/>'
        '<geom type="mesh" mesh="drawer"/></body></body></worldbody>'
    )
    assets = "".join(f'<mesh file="{before}{name}.obj"/>' for name in MESHES)
    path = folder / "mjcf" / "cabinet.xml"
    path.parent.mkdir(parents=True, exist_ok=True)
    if include:
        (path.parent / include).parent.mkdir(parents=True, exist_ok=True)
        (path.parent / include).write_text(f"<mujoco><asset>{assets}</asset></mujoco>")
        assets = ""
    included = f'<include file="{include}"/>' if include else ""
    path.write_text(
        f"<mujoco><compiler {compiler}/>{included}<asset>{assets}</asset>{bodies}</mujoco>"
    )
    return path
