"""What a job does about nodes, told apart by what Ray says of them."""

import socket

import pytest

from asset_factory.factory.jobs.ray.nodes import Nodes


class Cluster:
    """Says of nodes what it is told to."""

    def __init__(self, **alive):
        self.alive = alive

    def nodes(self):
        return [
            {"NodeID": name, "Alive": alive, "NodeManagerAddress": "127.0.0.1", "Resources": {}}
            for name, alive in self.alive.items()
        ]


@pytest.fixture(params=["127.0.0.1", "::ffff:127.0.0.1"])
def connection(request):
    """To a host that will never answer."""
    family = socket.AF_INET6 if ":" in request.param else socket.AF_INET
    with (
        socket.create_server(("127.0.0.1", 0)) as server,
        socket.socket(family, socket.SOCK_STREAM) as near,
    ):
        near.connect((request.param, server.getsockname()[1]))
        near.settimeout(0.2)
        yield near


def is_open(connection):
    try:
        return connection.recv(1) != b""
    except TimeoutError:
        return True


def test_connections_to_a_dead_host_are_ended(connection):
    cluster = Cluster(a=True)
    nodes = Nodes(cluster)
    nodes.hang_up()
    assert is_open(connection)
    cluster.alive["a"] = False
    nodes.hang_up()
    assert not is_open(connection)


def test_those_to_a_host_that_is_back_or_has_another_node_stay(connection):
    Nodes(Cluster(a=False, b=True)).hang_up()
    assert is_open(connection)
    cluster = Cluster(a=True)
    nodes = Nodes(cluster)
    cluster.alive |= {"a": False, "b": True}
    nodes.hang_up()
    cluster.alive |= {"b": True}
    nodes.hang_up()
    assert is_open(connection)
