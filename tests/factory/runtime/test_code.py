"""The digest of a stage's source: it changes with what the stage runs, and with nothing else."""

import ast
import sys
from importlib.util import resolve_name
from pathlib import Path

import pytest
from command_line import ran
from laid import laid

import asset_factory
from asset_factory.factory.registry.keys import PIPELINE, STAGES
from asset_factory.factory.runtime import code
from asset_factory.factory.runtime.code import code_digest, modules_run_by

ROOT = Path(asset_factory.__file__).parent
WEIGHTS = ROOT / "configs" / "weights"
SOURCES = {
    "kitchen/__init__.py": "",
    "kitchen/cook.py": "from .tools import knife\nfrom .tools.pots import (\n    pan as it,\n)\n",
    "kitchen/bake.py": "def bake():\n    from kitchen.oven import hot\n",
    "kitchen/oven.py": "import kitchen.plates as plates\nhot = 1\n",
    "kitchen/plates.py": "import json\n",
    "kitchen/tools/__init__.py": (
        "from .knives import knife\nfrom .spoons import spoon\nfrom . import shelf\n"
    ),
    "kitchen/tools/knives.py": "knife = 1\n",
    "kitchen/tools/spoons.py": "spoon = 1\n",
    "kitchen/tools/pots.py": "pan = 1\n",
    "kitchen/look.py": "from .tools import shelf\n",
    "kitchen/guest.py": (
        "from typing import TYPE_CHECKING\n\nif TYPE_CHECKING:\n    from .cook import it\n\nx = 1\n"
    ),
}


@pytest.fixture
def digest(tmp_path, monkeypatch):
    """What takes the digest of modules of a small package, anew each time."""
    for name, text in SOURCES.items():
        laid(tmp_path / name, text)
    monkeypatch.syspath_prepend(tmp_path)

    def taken(*names):
        forget()
        return code_digest(*names)

    yield taken
    forget()


def forget():
    for kept in (code.code_digest, code._module, code._imported_by, code._sources):
        kept.cache_clear()


@pytest.mark.parametrize(
    ("changed", "stages"),
    [
        ("kitchen/cook.py", {"kitchen.cook"}),
        ("kitchen/tools/knives.py", {"kitchen.cook"}),
        ("kitchen/tools/pots.py", {"kitchen.cook"}),
        # A package that only hands on what it has: nobody took this from it.
        ("kitchen/tools/spoons.py", set()),
        ("kitchen/oven.py", {"kitchen.bake"}),
        ("kitchen/plates.py", {"kitchen.bake"}),
        ("kitchen/guest.py", {"kitchen.guest"}),
    ],
)
def test_a_changed_line_changes_the_digest_of_those_who_run_it(changed, stages, digest, tmp_path):
    names = ("kitchen.cook", "kitchen.bake", "kitchen.guest")
    before = {name: digest(name) for name in names}
    with (tmp_path / changed).open("a") as file:
        file.write("more = 2\n")
    assert {name for name in names if digest(name) != before[name]} == stages


def test_a_package_counts_as_all_that_is_in_it(digest, tmp_path):
    before = digest("kitchen.tools")
    (tmp_path / "kitchen/tools/spoons.py").write_text("spoon = 2\n")
    assert digest("kitchen.tools") != before
    (tmp_path / "kitchen/tools/spoons.py").write_text("spoon = 1\n")
    assert digest("kitchen.tools") == before
    # So it does where a name is its own.
    tools = {"kitchen.tools", "kitchen.tools.knives", "kitchen.tools.spoons"}
    assert modules_run_by("kitchen.look") == {"kitchen.look", *tools}
    (tmp_path / "kitchen/tools/forks.py").write_text("")
    assert digest("kitchen.tools") != before


def test_line_ends_change_nothing(digest, tmp_path):
    before = digest("kitchen")
    for path in tmp_path.rglob("*.py"):
        path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert digest("kitchen") == before


def test_a_module_that_is_not_there_is_an_error(digest):
    for name in ("kitchen.cellar", "no_such_package"):
        with pytest.raises(ValueError, match=name):
            digest(name)


def test_no_import_of_this_package_is_overlooked():
    """Compared with what Python's own parser sees, in every module that makes or judges."""
    for name, file in code._sources("asset_factory").items():
        if ".learn" in name:
            continue
        tree = ast.parse(Path(file).read_text(encoding="utf-8"))
        assert _seen_by_python(tree, name, file) <= code._imported_by(name), name


def _seen_by_python(tree, name, file):
    package = name if file.endswith("__init__.py") else name.rpartition(".")[0]
    typed = {
        id(each)
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        for each in ast.walk(node)
    }
    found = set()
    for node in ast.walk(tree):
        if id(node) in typed:
            continue
        if isinstance(node, ast.Import):
            found |= {(alias.name, "") for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            source = resolve_name("." * node.level + (node.module or ""), package)
            found |= {(source, alias.name) for alias in node.names}
    own = {each for each in found if each[0].partition(".")[0] == "asset_factory"}
    return {code._home(*each) for each in own}


def test_articulators_imported_by_name_and_all_weights_are_among_what_the_stage_runs():
    (stage,) = (stage for stage in STAGES if stage.name == "articulate")
    for name in ("geometric.geometric", "seams.knobs", "auto.articulator"):
        package = f"asset_factory.factory.articulate.{name.partition('.')[0]}."
        assert any(each.startswith(package) for each in modules_run_by(*stage.code))
    files = {f"weights/{file.name}" for file in WEIGHTS.iterdir() if file.suffix != ".md"}
    # The network's own are named in the settings.
    assert files - {"weights/small.safetensors"} <= {*stage.data}


@pytest.mark.parametrize("stage", STAGES, ids=lambda stage: stage.name)
def test_a_stage_runs_its_own_module_and_no_page_or_command(stage):
    run = modules_run_by(*stage.code)
    assert run <= modules_run_by(PIPELINE, *stage.code)
    above = ("cli", "jobs", "report", "registry")
    packages = tuple(f"asset_factory.factory.{name}." for name in above)
    assert not any(module.startswith(packages) for module in run)


def test_the_digest_imports_nothing_heavy_and_takes_no_time():
    script = (
        "import sys, time\n"
        "from asset_factory.factory.runtime.code import code_digest\n"
        "started = time.process_time()\n"
        "code_digest('asset_factory.factory.build')\n"
        "spent = time.process_time() - started\n"
        "print(spent, *{'torch', 'scipy', 'trimesh', 'sapien', 'mujoco'} & set(sys.modules))\n"
    )
    said = ran(sys.executable, "-c", script).split()
    assert len(said) == 1
    # Some thirty milliseconds on a quiet machine.
    assert float(said[0]) < 0.5
