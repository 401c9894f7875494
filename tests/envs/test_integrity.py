"""An asset that is no longer what was judged is refused."""

import json
import shutil
from pathlib import Path

import pytest
from openable_samples import cabinet, oven, write_registry

from asset_factory.envs.assets import read_registry
from asset_factory.envs.integrity import check_unaltered, file_digests
from asset_factory.factory.errors import RegistryError


@pytest.fixture
def asset(tmp_path):
    return read_registry(write_registry(tmp_path, cabinet(), oven()))["oven"]


def spoil(path):
    path.write_text(path.read_text().replace("v ", "v 1", 1))


def extend(path):
    path.write_text(path.read_text() + " ")


@pytest.mark.parametrize(
    ("place", "change", "told"),
    [
        (".", shutil.rmtree, r"'oven': .*asset\.json is gone.*there are 'cabinet'"),
        ("asset.json", extend, r"asset\.json changed since the registry was read"),
        ("meshes/collision/{hull}", spoil, "{hull}' not as registered"),
        ("meshes/collision/{hull}", Path.unlink, "{hull}' not as registered"),
        ("meshes/collision/more.obj", Path.touch, "more.obj' not as registered"),
    ],
)
def test_what_is_not_as_registered_or_gone_is_named(asset, place, change, told):
    check_unaltered(asset)
    (asset.folder / "report.json").write_text(json.dumps({"files": file_digests(asset.folder)}))
    check_unaltered(asset)
    hull = sorted(path.name for path in (asset.folder / "meshes/collision").iterdir())[0]
    change(asset.folder / place.format(hull=hull))
    with pytest.raises(RegistryError, match=told.format(hull=hull)):
        check_unaltered(asset)
