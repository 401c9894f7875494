"""xacro files are expanded and checked as what they make; hostile ones reach nothing."""

import subprocess
import sys

import pytest
from ros_packages import MESHES, PACKAGE, SLIDE, link, write_meshes
from small_cabinet import codes

from asset_factory.sim_checks.read import xacro
from asset_factory.sim_checks.read.roots import ReadOptions

pytest.importorskip("xacro")
ROBOT = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
PART = link("${name}", "file://$(find cabinet)/meshes/${name}.obj")
SEEN = PART.replace("file://$(find cabinet)", "package://cabinet", 1)
MACROS = f'<xacro:macro name="part" params="name">{SEEN}</xacro:macro>'


def write_xacro(folder, body, name="cabinet.urdf.xacro"):
    write_meshes(folder / "meshes")
    (folder / "package.xml").write_text(PACKAGE.format("cabinet"))
    (folder / "urdf").mkdir(exist_ok=True)
    path = folder / "urdf" / name
    path.write_text(ROBOT.format(body))
    return path


def test_macros_includes_arguments_and_packages_are_expanded(tmp_path, judge):
    body = (
        '<xacro:include filename="$(find cabinet)/urdf/parts.xacro"/>'
        '<xacro:arg name="travel" default="0.1"/><xacro:property name="k" '
        "value=\"${xacro.load_yaml('sizes.yaml')['k'] * max(1, len('ab') - 1)}\"/>"
        '<xacro:part name="shell"/><xacro:if value="${True}"><xacro:part name="drawer"/></xacro:if>'
        + SLIDE.replace('upper="0.3"', 'upper="${$(arg travel) * k}"')
    )
    path = write_xacro(tmp_path, body)
    (path.parent / "parts.xacro").write_text(ROBOT.format(MACROS))
    (path.parent / "sizes.yaml").write_text("k: 2\n")
    report = judge.check(path, ())
    assert codes(report) == []
    assert report.description == "cabinet.urdf.xacro"
    assert "read_by_xacro" in [finding.code for finding in report.findings]
    sweep = report.measurements["penetration"]["joints"][0]
    assert (sweep["upper"], round(sweep["clearance_mm"], 2)) == (0.2, 3.0)
    longer = judge.check(path, (), options=ReadOptions(arguments=("travel:=0.15",)))
    assert longer.measurements["penetration"]["joints"][0]["upper"] == 0.3


def test_a_urdf_with_macros_needs_no_other_name(tmp_path, judge):
    links = "".join(link(name, f"../meshes/{name}.obj") for name in MESHES)
    path = write_xacro(tmp_path, f'<xacro:property name="a" value="1"/>{links}{SLIDE}', "a.urdf")
    assert codes(judge.check(path, ())) == []


@pytest.mark.parametrize(
    "inside",
    [
        '<xacro:include filename="{out}/secret.xacro"/>',
        "${{xacro.load_yaml('{out}/secret.yaml')}}",
        '<xacro:include filename="/etc/*"/>',
        "${{xacro.load_yaml.__globals__}}",
        "${{(lambda: ''.__class__.__base__.__subclasses__())()}}",
        "${{(x for x in [1]).gi_frame.f_back.f_builtins}}",
        "${{[c for c in python.type(1).mro()][1]}}",
        "$(find nowhere)",
        "${{1/0}}",
        "<xacro:nothing/>",
    ],
)
def test_what_reaches_out_is_refused(tmp_path, judge, inside):
    out = tmp_path / "out"
    out.mkdir()
    (out / "secret.xacro").write_text(ROBOT.format('<link name="secret"/>'))
    (out / "secret.yaml").write_text("secret: 1")
    said = inside.format(out=out)
    said = said if said.startswith("<") else f'<link name="a"><v x="{said}"/></link>'
    report = judge.check(write_xacro(tmp_path / "pkg", said), ())
    assert codes(report) == ["invalid_xacro"]
    assert report.measurements == {}


def test_the_interpreter_itself_refuses_what_gets_past_the_expressions(tmp_path):
    """As though a way round the first wall were known: the second one holds."""
    path = write_xacro(tmp_path, '<link name="a"/>')
    for act in ("os.system('true')", "open('/etc/passwd')", "open('x', 'w')", "os.fork()"):
        program = (
            "import os, sys; from pathlib import Path\n"
            "from asset_factory.sim_checks.read import xacro_child as child\n"
            "from asset_factory.sim_checks.read.roots import OWN_PACKAGE, Roots\n"
            f"child._close(Roots(Path({str(path)!r}), OWN_PACKAGE))\n"
            f"try:\n    {act}\nexcept child.NotAllowed:\n    os._exit(7)\n"
        )
        assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 7, act


def test_the_environment_stays_unseen(tmp_path, monkeypatch):
    monkeypatch.setenv("TOKEN", "abc")
    path = write_xacro(tmp_path, '<link name="a$(optenv TOKEN none)"/>')
    document, _ = xacro.expand_xacro(path, ReadOptions())
    assert [item.get("name") for item in document] == ["anone"]


def test_without_the_library_the_line_that_adds_it_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(xacro, "find_spec", lambda name: None)
    with pytest.raises(xacro.DescriptionError, match=r"pip install 'asset-factory\[xacro\]'"):
        xacro.expand_xacro(write_xacro(tmp_path, ""), ReadOptions())


def test_arguments_are_written_as_ros_writes_them():
    assert xacro.parse_arguments(("a:=1", "b:=x:=y")) == {"a": "1", "b": "x:=y"}
    with pytest.raises(ValueError, match="want name:=value"):
        xacro.parse_arguments(("a=1",))
