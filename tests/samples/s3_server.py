"""A real S3 server on this machine."""

import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager

BUCKET = "bucket"
SECRET = "kX9secretsecretsecret"  # noqa: S105 - of a server that lives for one test
KEY = "AKIAEXAMPLEEXAMPLE"


@contextmanager
def s3_server(listens_on: str = "127.0.0.1") -> Iterator[str]:
    """Its address; this process's fsspec and its children use it. Skips where moto is missing."""
    import pytest

    pytest.importorskip("s3fs")
    server_module = pytest.importorskip("moto.server")
    logging.getLogger("werkzeug").setLevel(logging.ERROR)
    server = server_module.ThreadedMotoServer(ip_address=listens_on, port=0, verbose=False)
    server.start()
    _, port = server.get_host_and_port()
    told = {
        "AWS_ENDPOINT_URL": f"http://{listens_on}:{port}",
        "AWS_ACCESS_KEY_ID": KEY,
        "AWS_SECRET_ACCESS_KEY": SECRET,
        "AWS_DEFAULT_REGION": "us-east-1",
    }
    before = {name: os.environ.get(name) for name in told}
    os.environ.update(told)
    try:
        yield told["AWS_ENDPOINT_URL"]
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
        server.stop()
