"""A real S3 server on this machine."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

BUCKET = "bucket"
SECRET = "kX9secretsecretsecret"  # noqa: S105 - of a server that lives for one test
KEY = "AKIAEXAMPLEEXAMPLE"


@contextmanager
def s3_server(listens_on: str = "127.0.0.1") -> Iterator[str]:
    """Its address; this process's fsspec and its children use it."""
    from moto.server import ThreadedMotoServer

    logging.getLogger("werkzeug").setLevel(logging.ERROR)
    server = ThreadedMotoServer(ip_address=listens_on, port=0, verbose=False)
    server.start()
    _, port = server.get_host_and_port()
    told = {
        "AWS_ENDPOINT_URL": f"http://{listens_on}:{port}",
        "AWS_ACCESS_KEY_ID": KEY,
        "AWS_SECRET_ACCESS_KEY": SECRET,
        "AWS_DEFAULT_REGION": "us-east-1",
    }
    with pytest.MonkeyPatch.context() as environment:
        for name, value in told.items():
            environment.setenv(name, value)
        try:
            yield told["AWS_ENDPOINT_URL"]
        finally:
            server.stop()
