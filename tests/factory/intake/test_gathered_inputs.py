"""Inputs whose files lie in a package or a root are read, known again and told."""

import pytest
from refusing import refusal
from ros_packages import PACKAGE, write_meshes, write_mjcf_package, write_package

from asset_factory.factory.cli.build import Build, build_config
from asset_factory.factory.cli.check import Check
from asset_factory.factory.cli.check import run as check
from asset_factory.factory.cli.flags import InputFlags, RootFlags
from asset_factory.factory.config import BuildConfig, IntakeConfig
from asset_factory.factory.errors import ConfigError, Exit
from asset_factory.factory.intake.reads import ABSENT, unchanged
from asset_factory.factory.intake.source import Source


def source(path, **settings):
    return Source(path, BuildConfig(intake=IntakeConfig(**settings)))


def test_a_package_is_an_input_wherever_it_lies_and_known_by_all_its_files(tmp_path):
    digests = []
    for place in ("here", "there/again"):
        path = write_package(tmp_path / place, "cabinet", "package://cabinet/meshes/")
        read = source(path)
        intake = read.load()
        digests.append(intake.provenance.digest)
        assert len(intake.mesh.faces) == 24
        assert any("package.xml lies 1 folder above" in note for note in intake.provenance.notes)
        assert str(tmp_path) not in " ".join(intake.provenance.notes)
    assert digests[0] == digests[1]
    assert set(read.reads) >= {"cabinet.urdf", "../meshes/drawer.obj", "../package.xml"}
    assert unchanged(path, read.reads)
    mesh = path.parent.parent / "meshes" / "drawer.obj"
    mesh.write_text(mesh.read_text() + "\n")
    assert not unchanged(path, read.reads)


def test_an_mjcf_of_a_package_is_an_input(tmp_path):
    path = write_mjcf_package(tmp_path, 'meshdir="../meshes"', "", "../common/assets.xml")
    read = source(path)
    assert len(read.load().mesh.faces) == 24
    assert {"../meshes/drawer.obj", "../common/assets.xml"} <= set(read.reads)


def test_a_refused_input_is_another_one_once_it_is_a_package(tmp_path):
    path = write_package(tmp_path, "", "../meshes/")
    read = source(path)
    found = refusal(read.load)
    assert (found.code, "--root" in found.message) == ("external_reference", True)
    assert read.reads["../package.xml"] == ABSENT
    (tmp_path / "package.xml").write_text(PACKAGE.format("cabinet"))
    assert not unchanged(path, read.reads)


@pytest.mark.parametrize("setting", ["roots", "given", "allow_outside"])
def test_roots_let_an_input_read_elsewhere(tmp_path, setting):
    path = write_package(tmp_path, "", "../meshes/")
    value = True if setting == "allow_outside" else (str(tmp_path),)
    assert len(source(path, **{setting: value}).load().mesh.faces) == 24


def test_roots_are_those_of_flags_of_the_ros_path_and_the_folders_of_inputs(tmp_path, monkeypatch):
    folders = [tmp_path / name for name in ("given", "root", "ros")]
    for folder in folders:
        folder.mkdir()
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(folders[2]))
    flags = InputFlags(roots=RootFlags(root=(folders[1],)))
    config = build_config(Build((str(folders[0]),), tmp_path / "out", loading=flags))
    assert config.intake.roots == (str(folders[1]),)
    assert config.intake.given == (str(folders[0]), str(folders[2]))
    path = write_package(folders[0] / "bringup", "", "package://description/meshes/")
    write_meshes(folders[0] / "description" / "meshes")
    assert check(Check((path,), sim="", strict=True)) == Exit.REJECTED
    assert check(Check((folders[0],), sim="", strict=True)) == Exit.OK
    (folders[0] / "description").rename(folders[2] / "description")
    assert check(Check((path,), sim="", strict=True)) == Exit.OK
    with pytest.raises(ConfigError, match="--root"):
        check(Check((path,), roots=RootFlags(root=(tmp_path / "nowhere",))))


def test_a_xacro_file_is_an_input_by_all_that_it_includes_and_its_arguments(tmp_path):
    path = write_package(tmp_path, "cabinet", "package://cabinet/meshes/", "urdf/cabinet.xacro")
    namespace = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    limits = f'<robot {namespace}><xacro:arg name="travel" default="0.1"/></robot>'
    path.with_name("limits.xacro").write_text(limits)
    text = path.read_text().replace('upper="0.3"', 'upper="$(arg travel)"')
    include = '<xacro:include filename="$(find cabinet)/urdf/limits.xacro"/>'
    path.write_text(text.replace('name="cabinet">', f'name="cabinet" {namespace}>{include}', 1))
    read = {given: source(path, arguments=given) for given in ((), ("travel:=0.2",))}
    travels = []
    for each in read.values():
        annotation = each.load().annotation
        assert annotation is not None
        travels.append(annotation.joints[0].upper)
        assert "limits.xacro" in each.reads
        assert "../meshes/shell.obj" in each.reads
    assert travels == [0.1, 0.2]
    first, second = read.values()
    assert first.id != second.id
