"""The server gives one page to this machine, and nothing else to anybody."""

import http.client
from threading import Thread

import pytest

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.report.site.server import HOST, one_page, serve


@pytest.fixture
def address():
    with serve(one_page(b"<p>here</p>")) as server:
        thread = Thread(target=server.run)
        thread.start()
        yield int(server.url.rsplit(":", 1)[1].strip("/"))
        server.stop()
        thread.join()


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
    with pytest.raises(ConfigError, match="--port"), serve(one_page(b""), address):
        pass
