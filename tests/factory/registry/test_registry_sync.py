"""A registry at a URL: a real S3 server, cuts in the middle, nothing named before it is there."""

import os
import signal
import subprocess
import time

import fsspec  # noqa: TID253
import pytest
from command_line import COMMAND
from registry_samples import named, publish
from s3_server import BUCKET, SECRET

from asset_factory.factory.cli.commands import run
from asset_factory.factory.errors import ConfigError, RegistryError
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry import sync as sync_module
from asset_factory.factory.registry.export import contents
from asset_factory.factory.registry.sync import UNFINISHED, sync
from asset_factory.factory.runtime.store import digest_bytes

URL = f"s3://{BUCKET}/copy"


@pytest.fixture
def bucket(server):
    """An empty bucket; gives a function that reads all of it."""
    import s3fs

    s3fs.S3FileSystem.clear_instance_cache()
    system = s3fs.S3FileSystem(skip_instance_cache=True, use_listings_cache=False)
    if system.exists(BUCKET):
        system.rm(BUCKET, recursive=True)
    system.mkdir(BUCKET)

    def stored():
        return {name.split("/", 2)[2]: system.cat_file(name) for name in system.find(BUCKET)}

    stored.system = system
    return stored


@pytest.fixture
def registry(tmp_path):
    made = Registry(tmp_path / "out", create=True)
    for number in range(12):
        publish(made, f"mesh {number}", entry=named(f"cabinet-{number:02d}"))
    return made


def files(registry):
    return dict(contents(registry, registry.walk()))


def synced(registry, url=URL):
    return sync(contents(registry, registry.walk()), url)


def test_all_files_are_there_and_the_second_time_nothing_is_sent(registry, bucket):
    first = synced(registry)
    assert bucket() == files(registry)
    assert (first.files, first.sent) == (len(files(registry)),) * 2
    again = synced(registry)
    assert (again.files, again.sent, again.removed) == (first.files, 0, 0)


@pytest.mark.cluster
def test_only_what_changed_is_sent_and_what_went_is_removed(registry, bucket):
    synced(registry)
    publish(registry, "another mesh", entry=named("cabinet-03"))
    registry.forget("cabinet-04")
    registry.note("cabinet-05", tags=("mine",))
    again = synced(registry)
    assert bucket() == files(registry)
    # Mesh and report of one, the note of another, its line and the lists.
    assert again.sent <= 3 + 4
    assert again.removed == len([name for name in files(registry) if "cabinet-03" in name])


@pytest.mark.cluster
def test_what_was_altered_at_the_url_is_sent_again(registry, bucket):
    synced(registry)
    name = f"{BUCKET}/copy/assets/cabinet-02/asset.urdf"
    bucket.system.pipe_file(name, bucket.system.cat_file(name)[::-1])
    assert synced(registry).sent == 1
    assert bucket() == files(registry)


@pytest.mark.cluster
def test_an_index_names_nothing_that_is_not_there(registry, bucket, monkeypatch):
    synced(registry)
    publish(registry, "another mesh", entry=named("cabinet-03"))
    old = bucket()["SHA256SUMS"]
    sent = sync_module._Sync._sent

    for dies_at in ("assets/cabinet-03/meshes/a.obj", "entries.jsonl", "README.md", "SHA256SUMS"):

        def dies(self, name, data, dies_at=dies_at):
            if name == dies_at:
                raise OSError("the line went dead")
            return sent(self, name, data)

        with monkeypatch.context() as cut:
            cut.setattr(sync_module._Sync, "_sent", dies)
            with pytest.raises(RegistryError, match=r"the line went dead.*goes on"):
                synced(registry)
        assert bucket()["SHA256SUMS"] == old
        assert UNFINISHED in bucket()
    synced(registry)
    assert bucket() == files(registry)


@pytest.mark.parametrize("killed_at", [1, 9, 30])
@pytest.mark.cluster
def test_a_process_killed_in_the_middle_is_gone_on_with(registry, bucket, killed_at):
    command = [*COMMAND, "registry", "sync", URL]
    command += ["--output", str(registry.root)]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    until = time.monotonic() + 60.0
    while process.poll() is None and time.monotonic() < until:
        if len(bucket.system.find(f"{BUCKET}/copy")) > killed_at:
            break
    process.send_signal(signal.SIGKILL)
    assert process.wait() == -signal.SIGKILL
    there = bucket()
    assert "SHA256SUMS" not in there
    # Whatever is there is whole.
    wanted = files(registry)
    assert all(wanted[name] == data for name, data in there.items() if name != UNFINISHED)
    rest = synced(registry)
    assert rest.sent <= len(wanted) - (len(there) - 1)
    assert bucket() == wanted


@pytest.mark.cluster
def test_what_does_not_arrive_as_it_was_sent_is_no_success(registry, bucket, monkeypatch):
    import s3fs

    pipe = s3fs.S3FileSystem.pipe_file

    def spoils(self, path, data, **more):
        pipe(self, path, data.replace(b"mesh 7", b"mess 7"), **more)

    monkeypatch.setattr(s3fs.S3FileSystem, "pipe_file", spoils)
    with pytest.raises(RegistryError, match=r"a\.obj: is not what was sent \(SHA-256\), 3 times"):
        synced(registry)
    assert "SHA256SUMS" not in bucket()


def test_others_files_are_left_alone(registry, bucket):
    bucket.system.pipe_file(f"{BUCKET}/copy/assets/theirs.txt", b"theirs")
    with pytest.raises(ConfigError, match="holds other files"):
        synced(registry)
    assert bucket() == {"assets/theirs.txt": b"theirs"}


@pytest.mark.parametrize("scheme", ["file", "memory"])
def test_other_file_systems(registry, tmp_path, scheme):
    url = f"file://{tmp_path}/copy" if scheme == "file" else f"memory://{tmp_path.name}/copy"
    synced(registry, url)
    registry.forget("cabinet-04")
    again = synced(registry, url)
    # entries.jsonl, LICENSES.md, README.md, SHA256SUMS at most.
    assert again.sent <= 4
    system, path = fsspec.core.url_to_fs(url)
    found = {name: system.cat_file(f"{path}/{name}") for name in files(registry)}
    assert found == files(registry)
    sums = dict(line.split("  ")[::-1] for line in found["SHA256SUMS"].decode().splitlines())
    assert all(digest_bytes(found[name]) == digest for name, digest in sums.items())
    assert len(system.find(path)) == len(found)


def test_the_command_says_what_it_did_and_no_secret(registry, bucket, capsys, monkeypatch):
    assert run(["registry", "sync", URL, "--output", str(registry.root)]) == 0
    assert f"{URL}: {len(files(registry))} files" in capsys.readouterr().out
    assert run(["registry", "sync", "out/copy", "--output", str(registry.root)]) == 2
    # Nobody listens there.
    secret = f"ftp://user:{SECRET}@127.0.0.1:9/copy?token={SECRET}"
    assert run(["registry", "sync", secret, "--output", str(registry.root)]) == 2
    monkeypatch.setenv("AWS_ENDPOINT_URL", "http://127.0.0.1:9")
    monkeypatch.setenv("AWS_MAX_ATTEMPTS", "1")
    import s3fs

    s3fs.S3FileSystem.clear_instance_cache()
    monkeypatch.setattr(s3fs.S3FileSystem, "retries", 1)
    assert run(["registry", "sync", URL, "--output", str(registry.root)]) == 2
    told = capsys.readouterr()
    assert "cannot be synchronised" in told.err
    assert SECRET not in told.out + told.err
    assert os.environ["AWS_SECRET_ACCESS_KEY"] == SECRET
