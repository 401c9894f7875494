"""Every code block of the first pages is pasted here, over what ``make demo`` leaves."""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from test_docs import PASTED, ROOT

from asset_factory.factory.cli.commands import run
from asset_factory.factory.intake.stated import stated_from

#: Those meshes of ``make demo`` that the pages name; all twelve would take a minute.
DEMO = ("examples/meshes/dishwasher.glb", "examples/stated/sideboard.glb")
#: Blocks under such a comment are not run: test_docs.py parses their commands and flags.
BLOCK = re.compile(r"^(<!-- not run: .*? -->\n)?```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
#: Where commands of no block would stand.
INDENTED = re.compile(r"^    (?:\$ )?(?:\.venv/bin/)?(?:factory|make|python|pip) .*$", re.MULTILINE)


@pytest.fixture(scope="module")
def clone(tmp_path_factory):
    """A folder as a clone is after ``make demo``, with fewer assets."""
    folder = tmp_path_factory.mktemp("clone")
    shutil.copytree(ROOT / "examples", folder / "examples")
    (folder / ".venv" / "bin").mkdir(parents=True)
    activate = folder / ".venv" / "bin" / "activate"
    activate.write_text(f"PATH={Path(sys.executable).parent}:$PATH\n", encoding="utf-8")
    inputs = [str(folder / each) for each in DEMO]
    assert run(["build", "--input", *inputs, "--output", str(folder / "out"), "--quiet"]) == 0
    return folder


def paste(text, folder, *program):
    """Run a text as a program's input, as a terminal would."""
    path = os.pathsep.join((str(ROOT / "src"), os.environ.get("PYTHONPATH", "")))
    quiet = {**os.environ, "PYTHONPATH": path, "PYTHONWARNINGS": "ignore"}
    done = subprocess.run(
        program, input=text, cwd=folder, env=quiet, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{text}\n{done.stdout}\n{done.stderr}"


@pytest.mark.parametrize("page", PASTED)
def test_every_block_runs_as_it_is_pasted(page, clone):
    text = (ROOT / page).read_text(encoding="utf-8")
    python = ""
    for unrun, language, block in BLOCK.findall(text):
        match language:
            case "python" if unrun:
                compile(block, page, "exec")
            case "python":
                python += block
            case "sh" if not unrun:
                # ``make demo`` is what the fixture stands for.
                typed = re.sub(r"^make .*$", "", block, flags=re.MULTILINE)
                paste(f"source .venv/bin/activate\n{typed}", clone, "bash", "-euo", "pipefail")
            case "json":
                stated_from(json.loads(block))
            case "toml":
                tomllib.loads(block)
            case _:
                assert language == "sh", f"a block of {page} is {language or 'nothing'}:\n{block}"
    if python:
        # A file, since worker processes import what started them.
        (clone / "pasted.py").write_text(
            f"if __name__ == '__main__':\n{_indented(python)}", encoding="utf-8"
        )
        paste("", clone, sys.executable, "pasted.py")
    assert INDENTED.findall(text) == [], f"commands of {page} stand in no block"


def _indented(text):
    return "".join(f"    {line}\n" for line in text.splitlines())
