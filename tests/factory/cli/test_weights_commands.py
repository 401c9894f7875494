"""``factory weights``: a checkpoint's contents and origin, and its conversion to safetensors."""

import sys
import types
from unittest.mock import Mock

import numpy as np
import pytest
import torch  # noqa: TID253
from laid import laid
from tiny_model import TINY, TINY_FIELD, random_cloud, tiny_model
from weight_rule import weights

from asset_factory.factory.cli.commands import run
from asset_factory.factory.cli.flags import InputFlags, input_config
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.partfield.shape import UNUSED
from asset_factory.factory.models.partfield.shape import expected_tensors as expected_field_tensors
from asset_factory.factory.models.particulate.field import load_field
from asset_factory.factory.models.particulate.model import load_model
from asset_factory.factory.models.weights.checkpoint import convert
from asset_factory.factory.models.weights.safetensors import read_safetensors
from asset_factory.factory.models.weights.sources import PARTFIELD, PARTICULATE, fetch
from asset_factory.factory.runtime.store import digest_file

pytestmark = pytest.mark.usefixtures("warm_reader")


@pytest.fixture
def released(tmp_path):
    """A transformer's weights as the release stores them: a bare mapping, saved by torch."""
    file = tmp_path / "model.pt"
    torch.save(tiny_model()._network.state_dict(), file)
    return file


@pytest.fixture
def released_field(tmp_path):
    """A field's weights as the release stores them, with tensors that nothing uses."""
    file = tmp_path / "model_objaverse.ckpt"
    state = weights(expected_field_tensors(TINY_FIELD), 0)
    state |= {f"{name}weight" if name.endswith(".") else name: torch.zeros(2) for name in UNUSED}
    torch.save({"state_dict": state, "epoch": 1}, file)
    return file


def test_info_names_the_network_its_sizes_and_its_terms(released, capsys):
    assert run(["weights", "info", str(released)]) == 0
    shown = capsys.readouterr().out
    network = ("Part Articulation Transformer", "3", "points + normals + 6 features")
    assert all(part in shown for part in (*network, "CC-BY-4.0"))


def test_a_converted_transformer_answers_the_same(released, tmp_path, capsys):
    target = tmp_path / "model.safetensors"
    assert run(["weights", "convert", str(released), str(target)]) == 0
    assert str(target) in capsys.readouterr().out
    models = [load_model(str(released)), load_model(str(target)), tiny_model()]
    assert models[0].shape == models[1].shape == TINY
    before, after, made = (each.predict(random_cloud(30)).mask_logits for each in models)
    assert np.array_equal(before, after)
    assert np.array_equal(before, made)


def test_a_converted_field_keeps_its_terms_and_its_features(released_field, tmp_path):
    target = tmp_path / "field.safetensors"
    assert convert(released_field, target).network == "PartField"
    assert "NON-COMMERCIAL" in read_safetensors(target).metadata["published_terms"]
    cloud = np.random.default_rng(0).uniform(-0.5, 0.5, (200, 3))
    fields = [load_field(str(file)) for file in (released_field, target)]
    before, after = (field.features(cloud, cloud[:9]) for field in fields)
    assert before.shape == (9, 8)
    assert np.array_equal(before, after)


def test_a_transformer_is_no_field_and_the_reverse(released, released_field):
    with pytest.raises(ConfigError, match=r"model\.pt: .*pos_embed: missing; this is no PartField"):
        load_field(str(released))
    with pytest.raises(ConfigError, match=r"pos_embed.mlp.2.weight: missing"):
        load_model(str(released_field))


@pytest.mark.parametrize("target", ["model.pt", "no/such/folder/model.safetensors"])
def test_a_target_that_cannot_be_written_is_refused(released, tmp_path, target):
    with pytest.raises(ConfigError, match=r"safetensors|no such folder"):
        convert(released, tmp_path / target)


COMMIT = "0123456789abcdef" * 2 + "01234567"


@pytest.mark.parametrize("name", ["model.pt", "own/model.pt", "", "own//m"])
def test_a_malformed_address_shows_a_good_one(name):
    with pytest.raises(ConfigError, match=PARTICULATE.source):
        fetch(f"hf:{name}")


@pytest.mark.parametrize("pin", ["@main", "@v1.0", "#abc", "@", f"#{'0' * 64}@{COMMIT}"])
def test_a_branch_or_half_a_digest_is_no_pin(pin):
    with pytest.raises(ConfigError, match="40 hexadecimal digits"):
        fetch(f"hf:a/b/file.pt{pin}")


class DownloadError(OSError):
    """As the hub's library raises it."""


def stand_in_hub(monkeypatch, download):
    library = types.ModuleType("huggingface_hub")
    errors = types.ModuleType("huggingface_hub.errors")
    library.hf_hub_download = download
    for name in ("HfHubHTTPError", "HFValidationError", "LocalEntryNotFoundError"):
        setattr(errors, name, DownloadError)
    monkeypatch.setitem(sys.modules, "huggingface_hub", library)
    monkeypatch.setitem(sys.modules, "huggingface_hub.errors", errors)


def test_an_address_is_downloaded(monkeypatch, released):
    download = Mock(return_value=str(released))
    stand_in_hub(monkeypatch, download)
    assert fetch(PARTICULATE.source) == released
    assert fetch(PARTFIELD.source) == released
    assert fetch("hf:a/b/deep/er/file.pt") == released
    assert fetch(f"hf:a/b/file.pt@{COMMIT}") == released
    assert [tuple(asked.kwargs.values()) for asked in download.call_args_list] == [
        ("rayli/Particulate", "model.pt", None),
        ("mikaelaangel/partfield-ckpt", "model_objaverse.ckpt", None),
        ("a/b", "deep/er/file.pt", None),
        ("a/b", "file.pt", COMMIT),
    ]


def hub_of(monkeypatch, folder):
    """A hub whose newest commit holds one file, laid out as its library's cache."""
    file = laid(folder / "snapshots" / COMMIT / "file.pt", "weights")
    stand_in_hub(monkeypatch, lambda repo_id, filename, revision: str(file))
    return file


def test_a_download_with_another_digest_is_refused_before_it_is_read(monkeypatch, tmp_path):
    file = hub_of(monkeypatch, tmp_path)
    digest = digest_file(file)
    assert fetch(f"hf:a/b/file.pt@{COMMIT}#{digest}") == file
    with pytest.raises(ConfigError, match=digest):
        fetch(f"hf:a/b/file.pt@{COMMIT}#{'0' * 64}")
    # The same address once more, and the hub has changed the file meanwhile.
    file.write_bytes(b"other weights")
    with pytest.raises(ConfigError, match="not the file that was asked"):
        fetch(f"hf:a/b/file.pt@{COMMIT}#{digest}")


def test_what_is_not_pinned_is_told_once_with_how_to_pin_it(monkeypatch, tmp_path, capsys):
    pinned = f"hf:a/b/file.pt@{COMMIT}#{digest_file(hub_of(monkeypatch, tmp_path))}"
    for _ in range(2):
        fetch("hf:a/b/file.pt")
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert said.endswith(f"this one is {pinned}\n")
    fetch(pinned)
    assert capsys.readouterr().err == ""


def test_published_weights_have_a_name_and_their_terms_are_said_before_a_fetch(monkeypatch, capsys):
    said = []

    def download(repo_id, filename, revision):
        said.append((repo_id, capsys.readouterr().err))
        raise DownloadError("the hub cannot be reached\nsecond line")

    stand_in_hub(monkeypatch, download)
    with pytest.raises(ConfigError, match=r"download failed: the hub cannot be reached$"):
        input_config(InputFlags(checkpoint="paper"))
    assert said[0][0] == "rayli/Particulate"
    assert "CC-BY-4.0" in said[0][1]
    assert "NON-COMMERCIAL" in said[0][1]


def test_without_the_hubs_library_the_remedy_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "huggingface_hub", None)
    with pytest.raises(ConfigError, match="pip install huggingface_hub"):
        fetch(PARTICULATE.source)
