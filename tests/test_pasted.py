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

#: The mesh of ``make demo`` that the pages name and do not build; all twelve would take a minute.
DEMO = "examples/meshes/dishwasher.glb"
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
    asked = ["build", "--input", str(folder / DEMO), "--output", str(folder / "out"), "--quiet"]
    assert run(asked) == 0
    return folder


@pytest.fixture(scope="module")
def typed():
    """Lines that were typed in the clone: several pages have the same ones."""
    return set()


def paste(text, folder, *program):
    """Run a text as a program's input, as a terminal would."""
    path = os.pathsep.join((str(ROOT / "src"), os.environ.get("PYTHONPATH", "")))
    quiet = {**os.environ, "PYTHONPATH": path, "PYTHONWARNINGS": "ignore"}
    done = subprocess.run(
        program, input=text, cwd=folder, env=quiet, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{text}\n{done.stdout}\n{done.stderr}"


@pytest.mark.parametrize("page", PASTED)
def test_every_block_runs_as_it_is_pasted(page, clone, typed):
    text = (ROOT / page).read_text(encoding="utf-8")
    for unrun, language, block in BLOCK.findall(text):
        match language:
            case "python":
                compile(block, page, "exec")
            case "sh" if not unrun:
                # ``make demo`` is what the fixture stands for.
                lines = (line.split("  #")[0].strip() for line in block.splitlines())
                new = [line for line in lines if line not in typed and not line.startswith("make ")]
                typed |= {line for line in new if line.startswith("factory ")}
                if any(line.startswith("factory ") for line in new):
                    pasted = "\n".join(("source .venv/bin/activate", *new))
                    paste(pasted, clone, "bash", "-euo", "pipefail")
            case "json":
                stated_from(json.loads(block))
            case "toml":
                tomllib.loads(block)
            case _:
                assert language == "sh", f"a block of {page} is {language or 'nothing'}:\n{block}"
    assert INDENTED.findall(text) == [], f"commands of {page} stand in no block"


def test_the_python_of_every_page_runs_as_it_is_pasted(clone):
    pages = {}
    for page in PASTED:
        found = BLOCK.findall((ROOT / page).read_text(encoding="utf-8"))
        pages[page] = "".join(
            block for unrun, kind, block in found if kind == "python" and not unrun
        )
    # A file, since worker processes import what started them. One process imports torch once.
    (clone / "pasted.py").write_text(
        f"pages = {pages!r}\n"
        "if __name__ == '__main__':\n"
        "    for page, code in pages.items():\n"
        "        exec(compile(code, page, 'exec'), {'__name__': '__main__'})\n",
        encoding="utf-8",
    )
    paste("", clone, sys.executable, "pasted.py")
