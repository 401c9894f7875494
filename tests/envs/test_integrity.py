"""An asset that is no longer what was judged is refused."""

import json
import shutil

import pytest
from openable_samples import cabinet, oven, write_registry

from asset_factory.envs.assets import read_registry
from asset_factory.envs.integrity import check_unaltered, file_digests
from asset_factory.factory.errors import RegistryError


@pytest.fixture
def asset(tmp_path):
    return read_registry(write_registry(tmp_path, cabinet(), oven()))["oven"]


def register(asset):
    (asset.folder / "report.json").write_text(json.dumps({"files": file_digests(asset.folder)}))


def test_an_untouched_asset_passes(asset):
    check_unaltered(asset)
    register(asset)
    check_unaltered(asset)


def test_a_deleted_asset_is_named_with_those_that_are_left(asset):
    shutil.rmtree(asset.folder)
    with pytest.raises(RegistryError, match=r"'oven': .*asset\.json is gone.*there are 'cabinet'"):
        check_unaltered(asset)


def test_a_manifest_that_changed_since_it_was_read_is_refused(asset):
    manifest = asset.folder / "asset.json"
    manifest.write_text(manifest.read_text() + " ")
    with pytest.raises(RegistryError, match=r"asset\.json changed since the registry was read"):
        check_unaltered(asset)


@pytest.mark.parametrize("change", ["altered", "removed", "added"])
def test_a_file_that_is_not_as_registered_is_named(asset, change):
    register(asset)
    hull = sorted((asset.folder / "meshes/collision").iterdir())[0]
    if change == "altered":
        hull.write_text(hull.read_text().replace("v ", "v 1", 1))
    elif change == "removed":
        hull.unlink()
    else:
        hull = hull.with_name("more.obj")
        hull.write_text("")
    with pytest.raises(RegistryError, match=f"{hull.name}' not as registered"):
        check_unaltered(asset)
