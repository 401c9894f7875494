"""Every setting, library and source is in the key of each stage that it can change."""

from dataclasses import fields, is_dataclass, replace
from functools import cache
from importlib.metadata import version

import pytest

from asset_factory.factory.config import GATE, BuildConfig
from asset_factory.factory.registry import keys as registry_keys
from asset_factory.factory.registry.keys import STAGES, build_key, failure_key
from asset_factory.factory.runtime import keys as runtime_keys
from asset_factory.sim_checks.config import LIMIT
from asset_factory.sim_checks.simulators import catalog

#: Sections and single settings by the stages whose keys they are in; nothing else is in any.
EXPECTED = {
    "intake": {"load"},
    "articulator": {"articulate"},
    "particulate": {"articulate"},
    "auto": {"articulate"},
    "vlm": {"articulate"},
    "solids": {"solids"},
    "readings": set(),
    "decompose": {"decompose"},
    "decompose.max_vertices": {"decompose", "finish"},
    "separate": {"finish"},
    "inertia": {"finish"},
    "checks": {"inspect", "validate"},
    "simulators": {"validate"},
    # Repairs and readings choose what is made; its stages are keyed by what they are given.
    "repair": set(),
    # Export is not kept: it is made anew each time.
    "formats": set(),
    "hulls": set(),
}
#: Distributions by the stages whose results another version of them can change.
LIBRARIES = {
    "numpy": {"load", "articulate", "solids", "finish", "inspect"},
    "scipy": {"load", "articulate", "solids", "decompose", "finish", "inspect"},
    "trimesh": {"load", "articulate", "finish", "inspect"},
    "manifold3d": {"load", "solids", "decompose", "finish"},
    "python-fcl": {"inspect"},
    "coacd": {"decompose"},
    "torch": {"articulate"},
    "sapien": {"validate"},
    "mujoco": {"load", "validate"},
    "pybullet": {"validate"},
}


def settings(value, path="", marks=frozenset()):
    """Every single setting of a configuration: its path, its value, its marks."""
    for field in fields(value):
        name = f"{path}.{field.name}".lstrip(".")
        current = getattr(value, field.name)
        all_marks = marks | (field.metadata.keys() & {LIMIT, GATE})
        if is_dataclass(current):
            yield from settings(current, name, all_marks)
        else:
            yield name, current, all_marks


SETTINGS = {name: (value, marks) for name, value, marks in settings(BuildConfig())}


def another(name, value):
    """Any other value of a setting; the names of things must exist."""
    known = {"articulator": "geometric", "simulators": ("mujoco",)}
    if name in known:
        return known[name]
    if isinstance(value, bool):
        return not value
    if isinstance(value, int | float):
        return value + 1
    if isinstance(value, str):
        return value + "x"
    if isinstance(value, tuple):
        return (*value, *(value[:1] or ("x",)))
    assert value is None
    return 0.5


def changed(config, path):
    """The configuration with one setting changed."""
    head, _, rest = path.partition(".")
    current = getattr(config, head)
    new = changed(current, rest) if rest else another(head, current)
    return replace(config, **{head: new})


@cache
def keys_of(config):
    return {stage.name: stage.key(config, "an input") for stage in STAGES}


def expected(path):
    """Of the longest path that is listed."""
    parts = path.split(".")
    found = (".".join(parts[:length]) for length in range(len(parts), 0, -1))
    return next(EXPECTED[each] for each in found if each in EXPECTED)


@pytest.mark.parametrize("path", SETTINGS)
def test_a_setting_changes_the_keys_of_its_stages_and_no_others(path):
    plain = BuildConfig()
    other = changed(plain, path)
    told = {name for name, key in keys_of(other).items() if key != keys_of(plain)[name]}
    marks = SETTINGS[path][1]
    built = (build_key("an input", plain), build_key("an input", other))
    if LIMIT in marks:
        assert told == set()
        assert built[0] == built[1]
        assert failure_key(built[0], plain) != failure_key(built[0], other)
        return
    assert told == (set() if GATE in marks else expected(path))
    assert built[0] != built[1]


def test_every_section_is_expected_somewhere():
    sections = {path.partition(".")[0] for path, (_, marks) in SETTINGS.items() if not marks}
    assert sections <= {path.partition(".")[0] for path in EXPECTED}


def test_a_section_that_a_stage_declares_and_that_is_not_there_is_an_error():
    stage = replace(STAGES[0], settings=("nowhere",))
    with pytest.raises(AttributeError, match="nowhere"):
        stage.key(BuildConfig())


@pytest.fixture
def told(monkeypatch):
    """Of which stages, and whether of a build, the keys are others while something is patched."""
    config = replace(BuildConfig(), simulators=("sapien", "mujoco", "pybullet"))

    def keys():
        runtime_keys.installed_version.cache_clear()
        registry_keys._pipeline_key.cache_clear()
        found = {stage.name: stage.key(config, "an input") for stage in STAGES}
        return {**found, "build": build_key("an input", config)}

    def changed_by(name, value, *modules):
        before = keys()
        with monkeypatch.context() as patch:
            for module in modules:
                patch.setattr(module, name, value)
            after = keys()
        assert keys() == before
        return {name for name in before if after[name] != before[name]}

    return changed_by


@pytest.mark.parametrize(
    ("module", "changed"),
    [(runtime_keys, {"build", *(stage.name for stage in STAGES)}), (registry_keys, {"build"})],
    ids=["in what stages run", "beside the stages"],
)
def test_a_changed_line_changes_the_key_of_a_build_and_of_stages_that_run_it(told, module, changed):
    assert told("code_digest", lambda *names: f"edited {names}", module) == changed


@pytest.mark.parametrize("library", LIBRARIES)
def test_another_version_of_a_library_changes_the_keys_of_what_it_makes(told, library):
    def another_of_it(name):
        return "another" if name == library else version(name)

    assert told("version", another_of_it, runtime_keys, catalog) == {"build", *LIBRARIES[library]}
