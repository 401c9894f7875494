"""Descriptions are read where the world lays them out, and never beyond the folders allowed."""

import os

import pytest
from PIL import Image
from ros_packages import PACKAGE, urdf_text, write_meshes, write_mjcf_package, write_package
from small_cabinet import codes

from asset_factory.sim_checks.read.gather import gather
from asset_factory.sim_checks.read.roots import (
    MOST_LEVELS,
    OWN_PACKAGE,
    ReadOptions,
    ros_package_path,
)


@pytest.fixture
def checked(judge):
    """Have a file judged that may be read from some roots too."""
    return lambda path, *roots, outside=False: judge.check(
        path, (), options=ReadOptions(roots, outside)
    )


def told(report):
    return [finding.message for finding in report.findings if finding.code == "read_from_root"]


def is_sound(report):
    """Tell whether the cabinet was read whole: its drawer passes 3 mm beside the shell."""
    sweeps = report.measurements["penetration"]["joints"] if report.passed else []
    return [round(sweep["clearance_mm"], 2) for sweep in sweeps] == [3.0]


@pytest.mark.parametrize(
    "before",
    [
        "../../meshes/",
        "..\\..\\meshes\\",
        "package://cabinet/meshes/",
        "model://cabinet/meshes/",
        "file://{root}/meshes/",
        "{root}/meshes/",
        "package://cabinet/robots/../meshes/",
    ],
)
def test_a_package_is_read_wherever_its_urdf_lies(tmp_path, checked, before):
    """Named by its package.xml, though its folder is called otherwise."""
    folder = tmp_path / "cabinet-main"
    path = write_package(folder, "cabinet", before.format(root=folder), "robots/a/cabinet.urdf")
    report = checked(path)
    assert is_sound(report)
    assert "package.xml lies 2 folders above" in told(report)[0]
    assert str(tmp_path) not in report.to_json()


def test_what_lies_in_one_folder_is_read_in_place(tmp_path, checked):
    path = write_package(tmp_path, "cabinet", "package://anything/meshes/", "cabinet.urdf")
    assert gather(path, tmp_path / "copy", OWN_PACKAGE).path == path
    report = checked(path)
    assert is_sound(report)
    assert not told(report)


def test_escaped_names_are_those_of_files(tmp_path, checked):
    path = write_package(tmp_path, "", "my%20meshes/", "cabinet.urdf")
    (tmp_path / "meshes").rename(tmp_path / "my meshes")
    assert is_sound(checked(path))


def test_a_package_is_looked_for_a_few_levels_up_and_no_further(tmp_path, checked):
    deep = "/".join("abcdefgh"[:MOST_LEVELS])
    named = ("cabinet", "package://cabinet/meshes/")
    assert is_sound(checked(write_package(tmp_path / "near", *named, f"{deep}/c.urdf")))
    path = write_package(tmp_path / "far", *named, f"{deep}/z/c.urdf")
    report = checked(path)
    assert codes(report) == ["missing_file"]
    assert "--root" in report.errors[0].message
    assert is_sound(checked(path, tmp_path / "far"))


@pytest.mark.parametrize("away", ["../meshes/", "{root}/meshes/", "file://{root}/meshes/"])
def test_what_no_root_holds_is_refused_with_the_flag_that_helps(tmp_path, checked, away):
    path = write_package(tmp_path, "", away.format(root=tmp_path))
    report = checked(path)
    assert codes(report) == ["outside_folder"]
    assert "--root" in report.errors[0].message
    assert "--allow-outside" in report.errors[0].message
    assert is_sound(checked(path, tmp_path))
    trusted = checked(path, outside=True)
    assert is_sound(trusted)
    assert str(tmp_path) not in trusted.to_json()


def test_another_package_is_found_in_a_root_its_folders_and_the_ros_path(
    tmp_path, checked, monkeypatch
):
    """As in a workspace: in a root or a repository, by the folder's name or the package's."""
    path = write_package(tmp_path / "bringup", "bringup", "package://description/meshes/")
    assert codes(checked(path)) == ["missing_file"]
    for where in ("description", "repository/description", "repository/main"):
        workspace = tmp_path / where.replace("/", "_")
        write_meshes(workspace / where / "meshes")
        if where.endswith("main"):
            (workspace / where / "package.xml").write_text(PACKAGE.format("description"))
        assert codes(checked(path)) == ["missing_file"]
        assert is_sound(checked(path, workspace))
        monkeypatch.setenv("ROS_PACKAGE_PATH", f"/nowhere{os.pathsep}{workspace}")
        assert is_sound(checked(path, *ros_package_path()))


def test_materials_and_pictures_come_along(tmp_path, checked):
    path = write_package(tmp_path, "cabinet", "../meshes/")
    textures = tmp_path / "textures"
    textures.mkdir()
    Image.new("RGB", (4, 4)).save(textures / "wood.png")
    (textures / "wood.mtl").write_text("newmtl wood\nmap_Kd wood.png\n")
    mesh = tmp_path / "meshes" / "drawer.obj"
    mesh.write_text("mtllib ../textures/wood.mtl\n" + mesh.read_text())
    gathered = gather(path, tmp_path / "copy", OWN_PACKAGE)
    names = {"cabinet.urdf", "shell.obj", "drawer.obj", "wood.mtl", "wood.png"}
    assert {file.name for file in gathered.files} == names
    assert len(list((tmp_path / "copy").rglob("textures/wood.png"))) == 1
    assert is_sound(checked(path))


def test_links_pipes_and_secrets_are_not_copied(tmp_path, checked):
    """A hostile package reaches nothing outside, by links, materials or devices."""
    secret = tmp_path / "secret.obj"
    write_meshes(tmp_path / "elsewhere")
    secret.write_text((tmp_path / "elsewhere" / "drawer.obj").read_text())
    path = write_package(tmp_path / "pkg", "cabinet", "../meshes/")
    mesh = tmp_path / "pkg" / "meshes" / "drawer.obj"
    whole = mesh.read_text()
    mesh.unlink()
    mesh.symlink_to(secret)
    assert codes(checked(path)) == ["outside_folder"]
    mesh.unlink()
    os.mkfifo(mesh)
    assert codes(checked(path)) == ["missing_file"]
    mesh.unlink()
    mesh.write_text(f"mtllib ../../secret.obj\nmtllib {secret}\nmtllib drawer.obj\n{whole}")
    assert secret not in gather(path, tmp_path / "copy", OWN_PACKAGE).files
    assert not list((tmp_path / "copy").rglob("secret*"))
    (tmp_path / "pkg" / "package.xml").unlink()
    (tmp_path / "pkg" / "package.xml").symlink_to("package.xml")
    assert codes(checked(path)) == ["outside_folder"]
    path.write_text(urdf_text("http://example.org/"))
    assert codes(checked(path)) == ["outside_folder"]


def test_meshes_of_one_name_in_two_packages_stay_two(tmp_path, checked):
    path = write_package(tmp_path / "one" / "pkg", "cabinet", "package://cabinet/meshes/")
    write_meshes(tmp_path / "other" / "pkg" / "meshes")
    other = f"file://{tmp_path}/other/pkg/meshes/drawer.obj"
    path.write_text(path.read_text().replace("package://cabinet/meshes/drawer.obj", other))
    mesh = tmp_path / "one" / "pkg" / "meshes" / "drawer.obj"
    mesh.write_text(mesh.read_text().replace("v ", "v 9"))
    assert is_sound(checked(path, tmp_path / "other" / "pkg"))


@pytest.mark.parametrize(
    ("compiler", "before", "include"),
    [
        ('meshdir="../meshes"', "", ""),
        ('assetdir="../meshes/"', "", ""),
        ("", "../meshes/", ""),
        ("", "{root}/meshes/", ""),
        ('meshdir="../meshes"', "", "../common/assets.xml"),
        ('meshdir="../meshes" strippath="true"', "C:\\robots\\", "parts/assets.xml"),
    ],
)
def test_an_mjcf_is_read_from_its_package_as_mujoco_reads_it(
    tmp_path, checked, compiler, before, include
):
    mujoco = pytest.importorskip("mujoco")
    path = write_mjcf_package(tmp_path, compiler, before.format(root=tmp_path), include)
    report = checked(path)
    assert is_sound(report)
    assert told(report)
    assert mujoco.MjModel.from_xml_path(str(path)).njnt == 1
    (tmp_path / "package.xml").unlink()
    report = checked(path)
    assert codes(report) == ["outside_folder"]
    assert "--root" in report.errors[0].message
    assert is_sound(checked(path, tmp_path))


def test_an_mjcf_that_attaches_another_model_keeps_the_files_of_both(tmp_path, checked):
    pytest.importorskip("mujoco")
    inner = write_mjcf_package(tmp_path / "cabinet", 'meshdir="../meshes"', "")
    path = tmp_path / "kitchen" / "mjcf" / "kitchen.xml"
    path.parent.mkdir(parents=True)
    (tmp_path / "package.xml").write_text(PACKAGE.format("kitchen"))
    path.write_text(
        f'<mujoco><asset><model name="cabinet" file="{os.path.relpath(inner, path.parent)}"/>'
        '</asset><worldbody><body name="wall"><attach model="cabinet" body="shell" prefix="a_"/>'
        "</body></worldbody></mujoco>"
    )
    assert is_sound(checked(path))
