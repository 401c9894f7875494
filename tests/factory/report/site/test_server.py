"""The server gives one page to this machine, and nothing else to anybody."""

import http.client

import pytest
from waiting import running

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.report.site.alone import DroppedFiles, unpack_drop
from asset_factory.factory.report.site.server import HOST, serve

PAGE = DroppedFiles("<p>here</p>", lambda file: None)


@pytest.fixture
def address():
    with serve(PAGE) as server, running(server):
        yield int(server.url.rsplit(":", 1)[1].strip("/"))


def asked(port, path, **headers):
    connection = http.client.HTTPConnection(HOST, port, timeout=10)
    connection.request("GET", path, headers=headers)
    answer = connection.getresponse()
    return answer.status, answer.read()


def test_the_page_is_there_and_nothing_else_is(address):
    assert asked(address, "/") == (200, b"<p>here</p>")
    for path in ("/etc/passwd", "/../../etc/passwd", "/%2e%2e/etc/passwd", "//etc/passwd"):
        assert asked(address, path) == (404, b"")


def test_a_page_from_elsewhere_cannot_read_it_under_another_name(address):
    assert asked(address, "/", Host="attacker.example")[0] == 404
    assert asked(address, "/", Host=f"localhost:{address}")[0] == 200


def test_a_taken_port_is_said(address):
    with pytest.raises(ConfigError, match="--port"), serve(PAGE, address):
        pass


@pytest.mark.parametrize(
    ("body", "said"),
    [
        (b"", "cannot be read"),
        (b"{}", "nothing"),
        (b'[["../x.urdf", 1]]\nx', "cannot be read: ../x.urdf"),
        (b'[["/etc/x.urdf", 1]]\nx', "cannot be read: /etc/x.urdf"),
        (b'[["x.urdf", 2]]\nx', "cannot be read: x.urdf"),
        (b'[["x.txt", 1]]\nx', "no URDF, MJCF or mesh is among what was dropped: x.txt"),
    ],
)
def test_what_is_dropped_is_files_of_its_own_folder(tmp_path, body, said):
    (tmp_path / "own").mkdir()
    with pytest.raises(ConfigError, match=said):
        unpack_drop(body, tmp_path / "own")
    assert [path.name for path in tmp_path.iterdir()] == ["own"]


def test_a_description_is_shown_of_a_dropped_folder(tmp_path):
    mesh = b"v 0 0 0"
    shape = b"<visual><geometry><mesh filename='m/a.obj'/></geometry></visual>"
    robot = b"<robot name='x'><link name='a'>" + shape + b"</link></robot>"
    head = f'[["r/m/a.obj", {len(mesh)}], ["r/a.urdf", {len(robot)}]]\n'.encode()
    assert unpack_drop(head + mesh + robot, tmp_path) == tmp_path / "r" / "a.urdf"
    assert (tmp_path / "r" / "a.urdf").read_bytes() == robot
