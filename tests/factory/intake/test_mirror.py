"""Inputs behind URLs: fetched once, whole, again where they changed; secrets stay unsaid."""

import json
from pathlib import Path
from unittest.mock import Mock

import pytest
from laid import laid
from s3_server import BUCKET, KEY, SECRET

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.intake import mirror as mirror_module
from asset_factory.factory.intake.discover import find_inputs
from asset_factory.factory.intake.mirror import local_inputs, mirror_of
from asset_factory.factory.runtime.remote import is_url, located, shown, told

FILES = {"a.stl": b"solid a", "a.toml": b"license = 'CC0-1.0'", "chairs/b.glb": b"glTF", ".x": b""}


@pytest.fixture(params=["memory", "s3"])
def remote(request, tmp_path):
    """A folder with some files, by its URL; gives that, the file system and the path there."""
    if request.param == "s3":
        import s3fs

        request.getfixturevalue("server")
        s3fs.S3FileSystem.clear_instance_cache()
        url = f"s3://{BUCKET}/{tmp_path.name}"
    else:
        url = f"memory://{tmp_path.name}/meshes"
    system, path = located(url)
    system.makedirs(path, exist_ok=True)
    for name, data in FILES.items():
        system.pipe_file(f"{path}/{name}", data)
    return url, system, path


def fetched(url, output):
    """What is seen in the copy."""
    (folder,) = local_inputs((url,), output)
    paths = (path for path in folder.rglob("[!.]*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


def copies(monkeypatch):
    """Gives the names of files that are fetched from now on."""
    copy = Mock(wraps=mirror_module._copy)
    monkeypatch.setattr(mirror_module, "_copy", copy)
    return lambda: [call.args[2].name for call in copy.call_args_list]


def test_a_folder_is_fetched_once_and_then_what_changed(remote, tmp_path, monkeypatch):
    url, system, path = remote
    names = copies(monkeypatch)
    wanted = {name: data for name, data in FILES.items() if name != ".x"}
    assert fetched(url, tmp_path) == wanted
    assert sorted(names()) == ["a.stl", "a.toml", "b.glb"]
    assert fetched(url, tmp_path) == wanted
    assert len(names()) == 3
    # Of the same size, so that the size does not tell.
    system.pipe_file(f"{path}/chairs/b.glb", b"gltf")
    system.rm_file(f"{path}/a.toml")
    system.invalidate_cache()
    assert fetched(url, tmp_path) == {"a.stl": b"solid a", "chairs/b.glb": b"gltf"}
    assert names()[3:] == ["b.glb"]
    # What somebody spoiled here comes again too.
    (mirror_of(url, tmp_path) / "a.stl").write_bytes(b"solid")
    assert fetched(url, tmp_path)["a.stl"] == b"solid a"


def test_a_copy_that_was_cut_off_goes_on(remote, tmp_path, monkeypatch):
    url, system, _ = remote
    get = system.get_file

    def cut(path, target):
        if path.endswith("b.glb"):
            Path(target).write_bytes(b"gl")
            raise OSError("the line went dead")
        return get(path, target)

    with monkeypatch.context() as dying:
        dying.setattr(system, "get_file", cut)
        with pytest.raises(ConfigError, match="cannot be read: the line went dead"):
            fetched(url, tmp_path)
    mirror = mirror_of(url, tmp_path)
    assert list(mirror.rglob(".writing-*")) == []
    assert not (mirror / "chairs" / "b.glb").exists()
    names = copies(monkeypatch)
    assert fetched(url, tmp_path)["chairs/b.glb"] == b"glTF"
    assert "b.glb" in names()
    # A file that came shorter than it was listed is not taken for whole.
    monkeypatch.setattr(system, "get_file", lambda path, to: Path(to).write_bytes(b"g"))
    (mirror / "a.stl").unlink()
    with pytest.raises(ConfigError, match=r"a\.stl: 1 bytes came, 7 were listed"):
        fetched(url, tmp_path)
    assert not (mirror / "a.stl").is_file()


def test_a_single_file_comes_with_what_is_named_after_it(remote, tmp_path):
    url, system, path = remote
    system.pipe_file(f"{path}/abc.stl", b"solid abc")
    (mesh,) = local_inputs((f"{url}/a.stl",), tmp_path)
    assert mesh.read_bytes() == b"solid a"
    names = {each.name for each in mesh.parent.iterdir() if not each.name.startswith(".")}
    assert names == {"a.stl", "a.toml"}
    assert find_inputs((mesh,)) == (mesh,)


def test_paths_and_local_urls_are_what_they_are(tmp_path):
    mesh = laid(tmp_path / "in" / "a.stl", "solid")
    given = (mesh, str(mesh), f"file://{mesh}")
    assert local_inputs(given, tmp_path / "out") == (mesh,) * 3
    assert not (tmp_path / "out").exists()


def test_what_is_not_there_is_one_sentence(remote, tmp_path):
    url, *_ = remote
    with pytest.raises(ConfigError, match="nothing there"):
        fetched(f"{url}/nowhere", tmp_path)
    with pytest.raises(ConfigError, match="nosuch"):
        fetched("nosuch://x/y", tmp_path)


@pytest.mark.parametrize(
    ("url", "without"),
    [
        (f"ftp://{KEY}:{SECRET}@host:9/in?token={SECRET}#x", "ftp://host:9/in"),
        (f"https://host/in?X-Amz-Signature={SECRET}", "https://host/in"),
        ("s3://bucket/in", "s3://bucket/in"),
        (f"sftp://{SECRET}@host", "sftp://host"),
    ],
)
def test_no_secret_is_told(url, without, tmp_path):
    assert shown(url) == without
    assert SECRET not in str(mirror_of(url, tmp_path))
    assert SECRET not in told(OSError(f"cannot connect to {url}, refused"), url)


def test_an_error_of_a_server_names_no_secret(tmp_path, capfd):
    with pytest.raises(ConfigError) as failed:
        fetched(f"ftp://user:{SECRET}@127.0.0.1:9/in", tmp_path)
    assert failed.value.__cause__ is None
    assert SECRET not in str(failed.value) + json.dumps(capfd.readouterr())


@pytest.mark.parametrize("text", ["C:/meshes", "meshes", "./s3:/x", "a//b"])
def test_what_is_no_url(text):
    assert not is_url(text)
