"""What is taken in is what was handed on; anything else is refused before any of it counts."""

import io
import shutil
import tarfile
from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from registry_samples import BAD_REPORT, REJECTED, REPORT, alter, dump, link, named, publish, remove

from asset_factory.factory.errors import RegistryError
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.export import contents, write_export
from asset_factory.factory.registry.export.contents import is_safe_path
from asset_factory.factory.registry.imports import import_export, unpacking
from asset_factory.factory.registry.rebuild import rebuild
from asset_factory.factory.registry.verify import verify
from asset_factory.factory.runtime.store import digest_bytes


@pytest.fixture
def other(tmp_path):
    return Registry(tmp_path / "other", create=True)


def export(registry, target):
    write_export(contents(registry, registry.entries()), str(target))
    return target


@pytest.mark.parametrize("name", ["x", "x.tar", "x.tar.gz"])
def test_a_round_trip_changes_nothing(registry, other, tmp_path, name):
    source = export(registry, tmp_path / name)
    wanted = ("cabinet-1", "chest-1", "fridge-1")
    assert import_export(other, source, trusted=True).published == wanted
    assert dump(other) == dump(registry)
    assert verify(other) == ()
    assert list((other.root / ".staging").iterdir()) == []
    again = import_export(other, source)
    assert (again.published, again.same) == ((), ("cabinet-1", "chest-1", "fridge-1"))


def test_what_was_rejected_arrives_with_its_model(registry, other, tmp_path):
    with registry.staging_folder() as staging:
        (staging / "view.glb").write_bytes(b"glTF")
        registry.add(replace(REJECTED, id="chest-1"), BAD_REPORT, staging)
    import_export(other, export(registry, tmp_path / "x"))
    assert (other.rejected / "chest-1" / "view.glb").read_bytes() == b"glTF"
    assert verify(other) == ()


NAMES = st.text("abc_é .", min_size=1, max_size=8).filter(is_safe_path)
FILES = st.dictionaries(NAMES, st.binary(max_size=50), max_size=3)
IDS = st.from_regex(r"[a-z]{1,5}-[0-9a-f]{4}", fullmatch=True)


@given(assets=st.dictionaries(IDS, FILES, max_size=3), compressed=st.booleans())
@settings(max_examples=6, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_small_registry_survives_the_round_trip(tmp_path_factory, assets, compressed):
    root = tmp_path_factory.mktemp("any")
    registry = Registry(root / "out", create=True)
    for asset_id, files in assets.items():
        with registry.staging_folder() as staging:
            bundle = staging / "bundle"
            bundle.mkdir()
            for name, content in files.items():
                (bundle / name).write_bytes(content)
            registry.add(named(asset_id), REPORT, bundle)
    other = Registry(root / "other", create=True)
    import_export(other, export(registry, root / ("x.tgz" if compressed else "x")), trusted=True)
    assert dump(other) == dump(registry)
    assert verify(other) == ()


def refused(other, source, match, **arguments):
    """The import is refused, and the registry as it was."""
    before = dump(other), sorted(path.name for path in other.assets.iterdir())
    with pytest.raises(RegistryError, match=match):
        import_export(other, source, **arguments)
    assert (dump(other), sorted(path.name for path in other.assets.iterdir())) == before
    assert list((other.root / ".staging").iterdir()) == []


def test_other_assets_of_the_same_id_are_not_replaced_unasked(registry, other, tmp_path):
    publish(other, "mine")
    source = export(registry, tmp_path / "x.tar")
    refused(other, source, "other assets of the same ids: cabinet-1; --replace")
    import_export(other, source, replace=True)
    assert (other.assets / "cabinet-1" / "meshes" / "a.obj").read_text() == "one"


@pytest.mark.parametrize("trusted", [False, True])
def test_builds_are_answered_with_an_import_only_if_it_is_trusted(
    registry, other, tmp_path, trusted
):
    key = "ab" * 32
    publish(registry, "one", named("oven-1", key=key))
    import_export(other, export(registry, tmp_path / "x"), trusted=trusted)
    assert (key in other.known_keys((key,))) == trusted
    rebuild(other.root)
    assert (key in other.known_keys((key,))) == trusted


def test_tags_add_up(registry, other, tmp_path):
    publish(other, "two", named("fridge-1", category="fridge", license=""))
    other.note("fridge-1", tags=("mine",), solved="no")
    import_export(other, export(registry, tmp_path / "x"))
    assert other.entry("fridge-1").tags == ("blue", "mine")
    assert other.entry("fridge-1").solved == "no"


def relist(folder):
    """Write the digests anew, as whoever alters an export would."""
    (folder / "SHA256SUMS").unlink(missing_ok=True)
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    names = {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}
    lines = [f"{digest_bytes(data)}  {name}\n" for name, data in names.items()]
    (folder / "SHA256SUMS").write_text("".join(lines))


def in_asset(damage):
    """The same damage to an asset of an export."""
    return lambda folder: damage(folder / "assets/cabinet-1")


def link_folder(folder):
    shutil.move(folder / "assets", folder.with_name("far"))
    (folder / "assets").symlink_to(folder.with_name("far"))


def rename(folder):
    (folder / "assets/cabinet-1").rename(folder / "assets/cabinet-9")


def promote(folder):
    shutil.move(folder / "rejected/chest-1", folder / "assets/chest-1")


def lie(folder):
    promote(folder)
    report = folder / "assets/chest-1/report.json"
    report.write_text(report.read_text().replace('"status": "rejected"', '"status": "passed"'))


def climb(folder):
    with (folder / "SHA256SUMS").open("a") as file:
        file.write(f"{'0' * 64}  ../secret\n")


@pytest.mark.parametrize(
    ("damage", "relisted", "match"),
    [
        (in_asset(alter), False, "'assets/cabinet-1/meshes/a.obj' is altered"),
        (in_asset(alter), True, "cabinet-1: its files are not those of its report"),
        (in_asset(remove), False, "cannot be unpacked"),
        (in_asset(link), False, "no file but a link or a device"),
        (link_folder, False, "no file but a link or a device"),
        (rename, True, "is of 'cabinet-1', not of its folder"),
        (promote, True, "is rejected, which belongs in another folder"),
        (lie, True, "chest-1: has passed, its report says otherwise"),
        (climb, False, r"'\.\./secret' is no path in an export"),
        (lambda folder: (folder / "SHA256SUMS").unlink(), False, "no SHA256SUMS; want an export"),
    ],
)
def test_a_damaged_folder_is_refused(registry, other, tmp_path, damage, relisted, match):
    folder = export(registry, tmp_path / "x")
    damage(folder)
    if relisted:
        relist(folder)
    refused(other, tmp_path / "x", match)


def member(name, content=b"x", **changes):
    info = tarfile.TarInfo(name)
    info.size = len(content)
    for key, value in changes.items():
        setattr(info, key, value)
    return info, content


OUT = "is no path in an export"
NO_FILE = "link or a device"
SPARSE = {"major": "1", "minor": "0", "realsize": "9" * 15}
HOSTILE = {
    "climbs": (member("../../etc/passwd"), OUT),
    "climbs_later": (member("assets/a/../../../b"), OUT),
    "absolute": (member("/etc/passwd"), OUT),
    "backslash": (member("assets\\..\\x"), OUT),
    "elsewhere": (member("bin/sh"), OUT),
    "newline": (member("assets/a\nb"), OUT),
    "symlink": (member("assets/a", b"", type=tarfile.SYMTYPE, linkname="/etc"), NO_FILE),
    "hard_link": (member("assets/a", b"", type=tarfile.LNKTYPE, linkname="README.md"), NO_FILE),
    "device": (member("assets/a", b"", type=tarfile.CHRTYPE), NO_FILE),
    "pipe": (member("assets/a", b"", type=tarfile.FIFOTYPE), NO_FILE),
    "twice": (member("README.md"), "cannot be unpacked"),
    "under_a_file": (member("README.md/x"), "cannot be unpacked"),
    "unlisted": (member("assets/cabinet-1/more.obj"), "'assets/cabinet-1/more.obj' is not listed"),
    "sparse": (
        member("assets/a", pax_headers={f"GNU.sparse.{key}": SPARSE[key] for key in SPARSE}),
        "link or a device|cannot be unpacked",
    ),
    "larger_than_it_says": (
        member("assets/a", pax_headers={"size": "9" * 15}),
        "cannot be unpacked|bytes, want at most",
    ),
}


@pytest.mark.parametrize("kind", HOSTILE)
def test_a_hostile_archive_is_refused(registry, other, tmp_path, kind):
    (info, content), match = HOSTILE[kind]
    source = export(registry, tmp_path / "x.tar")
    with tarfile.open(source, "a", format=tarfile.PAX_FORMAT) as archive:
        archive.addfile(info, io.BytesIO(content))
    refused(other, source, match)
    assert not (tmp_path / "etc").exists()


@pytest.mark.parametrize("name", ["x", "x.tar", "x.tar.gz"])
def test_sizes_are_bounded_before_anything_is_written(registry, other, tmp_path, name, monkeypatch):
    source = export(registry, tmp_path / name)
    refused(other, source, "more than 1e-06 GB", most_bytes=1000)
    monkeypatch.setattr(unpacking, "MOST_FILES", 3)
    refused(other, source, "more than 3 files")
    monkeypatch.setattr(unpacking, "MOST_FILE_BYTES", 10)
    refused(other, source, "bytes, want at most 10")


NO_ARCHIVE = "x.tar|SHA256SUMS"


def claiming(size, kind=tarfile.REGTYPE):
    """An archive whose only member says that it has so many bytes."""
    info = tarfile.TarInfo("README.md")
    info.size = size
    info.type = kind
    return info.tobuf(tarfile.GNU_FORMAT) + b"x"


@pytest.mark.parametrize(
    ("content", "match"),
    [
        (b"", NO_ARCHIVE),
        (b"no archive at all", NO_ARCHIVE),
        (b"\x1f\x8bnothing", NO_ARCHIVE),
        (b"\0" * 2000, NO_ARCHIVE),
        (b"\x1f\x8b", NO_ARCHIVE),
        (claiming(10**12), "bytes, want at most"),
        (claiming(10**9), "ends within 'README.md'"),
        (claiming(-512, tarfile.XHDTYPE), "has -512 bytes"),
    ],
)
def test_what_is_no_archive_or_claims_more_than_it_has_is_refused(other, tmp_path, content, match):
    (tmp_path / "x.tar").write_bytes(content)
    refused(other, tmp_path / "x.tar", match)


def test_a_cut_archive_imports_nothing(registry, other, tmp_path):
    source = export(registry, tmp_path / "x.tar.gz")
    source.write_bytes(source.read_bytes()[:-200])
    refused(other, source, "cannot be unpacked")
