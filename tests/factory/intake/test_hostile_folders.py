"""A folder of hostile files is searched within bounds: of time, of memory, and of its root."""

import os
import resource
import socket
import sys

import pytest

from asset_factory.factory.errors import InputRejected
from asset_factory.factory.intake.companions import companions
from asset_factory.factory.intake.discover import find_inputs
from asset_factory.factory.intake.importers.xml_source import read_xml
from asset_factory.factory.intake.reads import ABSENT, ReadLog, content_digest
from asset_factory.sim_checks.description import DescriptionError
from asset_factory.sim_checks.processes.isolation import Limits, run_isolated
from asset_factory.sim_checks.read.document import parse_document

#: Of the search alone: what is hostile here took minutes or gigabytes.
LIMITS = Limits(wall_s=60.0, cpu_s=20.0)
MOST_BYTES = 300 * 2**20


def search(folder):
    """What is found, the memory that it took [bytes], and what was opened outside the folder."""
    opened = []

    def hear(event, arguments):
        if event == "open" and isinstance(arguments[0], str) and "secret" in arguments[0]:
            opened.append(arguments[0])

    sys.addaudithook(hear)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    found = [path.name for path in find_inputs((folder,))]
    for name in found:
        companions(folder / name)
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    return found, grown * 1024, opened


def includes_itself(folder):
    include = '<include file="scene.xml"/>'
    (folder / "scene.xml").write_text(f"<mujoco>{include * 3000}</mujoco>")
    return ["scene.xml"]


def includes_each_other(folder):
    every = "".join(f'<include file="part{k}.xml"/>' for k in range(300))
    for k in range(300):
        (folder / f"part{k}.xml").write_text(f"<mujocoinclude>{every}</mujocoinclude>")
    (folder / "scene.xml").write_text(f"<mujoco>{every}</mujoco>")
    return ["scene.xml"]


def is_sparse(folder):
    names = [f"huge{suffix}" for suffix in (".urdf", ".obj", ".glb", ".stl", ".ply", ".off")]
    for name in (*names, "huge.xml", "huge.json", "huge.toml", "huge.npz", "huge.mtl"):
        with (folder / name).open("wb") as file:
            file.truncate(6 * 2**30)
    return sorted(names)


def includes_a_huge_file(folder):
    with (folder / "huge.xml").open("wb") as file:
        file.truncate(6 * 2**30)
    (folder / "scene.xml").write_text('<mujoco><include file="huge.xml"/></mujoco>')
    return ["scene.xml"]


def leads_out(folder):
    (folder.parent / "secret.xml").write_text("<mujocoinclude/>")
    (folder / "link.xml").symlink_to(folder.parent / "secret.xml")
    text = '<include file="../secret.xml"/><include file="link.xml"/>'
    (folder / "scene.xml").write_text(f"<mujoco>{text}</mujoco>")
    return ["scene.xml"]


def holds_no_files(folder):
    for name in ("pipe.xml", "pipe.urdf", "pipe.obj", "door.xml", "chest.mtl"):
        os.mkfifo(folder / name)
    # Its path is longer than a socket's may be.
    here = os.getcwd()
    os.chdir(folder)
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind("socket.urdf")
    os.chdir(here)
    (folder / "zero.xml").symlink_to("/dev/zero")
    (folder / "chest.obj").write_text("mtllib chest.mtl\n")
    text = '<include file="door.xml"/><include file="zero.xml"/><include file="socket.urdf"/>'
    (folder / "scene.xml").write_text(f"<mujoco>{text}</mujoco>")
    return ["chest.obj", "scene.xml"]


def names_without_end(folder):
    long = f"<mesh filename='{'a/' * 500_000}x.obj'/>"
    many = "".join(f"<mesh filename='{k}.obj'/>" for k in range(200_000))
    open_end = "<mesh file = " + "file " * 500_000
    (folder / "robot.urdf").write_text(f"<robot>{long}{many}{open_end}</robot>")
    return ["robot.urdf"]


ATTACKS = (includes_itself, includes_each_other, is_sparse, includes_a_huge_file)
ATTACKS += (leads_out, holds_no_files, names_without_end)


@pytest.mark.parametrize("attack", ATTACKS)
def test_a_hostile_folder_is_searched_within_bounds(tmp_path, attack):
    folder = tmp_path / "in"
    folder.mkdir()
    wanted = attack(folder)
    found, grown, opened = run_isolated(search, folder, limits=LIMITS).unwrap()
    assert sorted(found) == wanted
    assert opened == []
    assert grown < MOST_BYTES


def test_a_file_too_large_for_anybody_is_told_apart_without_being_read(tmp_path):
    digests = []
    for size in (2**40, 2**40 + 1):
        with (tmp_path / "huge.obj").open("wb") as file:
            file.truncate(size)
        digests.append(content_digest(tmp_path / "huge.obj"))
    assert len({*digests, ABSENT}) == 3


def test_a_pipe_has_no_digest_and_no_content(tmp_path):
    os.mkfifo(tmp_path / "pipe.xml")
    assert content_digest(tmp_path / "pipe.xml") == ABSENT
    with pytest.raises(InputRejected, match="not a regular file"):
        read_xml(tmp_path / "pipe.xml", 100, ReadLog())
    with pytest.raises(DescriptionError, match="not a regular file"):
        parse_document(tmp_path / "pipe.xml")
