"""The docs say what the code says, and every command in them is one.

Every code block of the first pages is pasted here, over what ``make demo`` leaves.
"""

import json
import os
import re
import shlex
import shutil
import sys
import tomllib
from pathlib import Path

import pytest
from command_line import ran
from repository import ROOT
from shown_registry import make_registry
from small_cabinet import write_urdf

from asset_factory.factory.cli.commands import parse, run
from asset_factory.factory.intake.stated import stated_from

#: Pages whose blocks are run as they stand.
PASTED = (
    "README.md",
    *(f"docs/{name}.md" for name in ("index", "installing", "building", "say-what-opens")),
    *(f"docs/{name}.md" for name in ("maniskill", "solving", "jobs")),
)
PAGES = sorted((*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")))
FENCED = re.compile(r"^```(?:console|sh|text)?\n(.*?)^```", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"^    (?=\S)(.*)$", re.MULTILINE)
PROGRAMS = ("factory", "make", "python")
#: Begin a command that is cheap enough to be run as it stands, over a registry at out/.
CHEAP = (
    "factory list",
    "factory show",
    "factory registry verify",
    "factory registry export cabinets",
    "factory train laptop >",
    "factory view",
)
#: What stands for the id of whatever asset is there.
ID = re.compile(r"[a-z_]+-[0-9a-f]{10}")


def commands_of(page):
    """Lines of code blocks that are to be typed, without prompt and folder."""
    text = page.read_text(encoding="utf-8")
    fenced = [line for block in FENCED.findall(text) for line in block.splitlines()]
    for line in (*fenced, *INDENTED.findall(FENCED.sub("", text))):
        typed = line.removeprefix("$ ").removeprefix(".venv/bin/").strip()
        if typed.split(" ")[0] in PROGRAMS:
            yield typed


def inline_commands_of(page):
    """Commands named within sentences and tables; they may leave out what they need."""
    yield from re.findall(r"`((?:factory|make) [^`]+)`", page.read_text(encoding="utf-8"))


TYPED = sorted({line for page in PAGES for line in commands_of(page)})
INLINE = sorted(
    {line for page in PAGES if page.stem != "CHANGELOG" for line in inline_commands_of(page)}
)
FLAGS = {
    heading: set(re.findall(r"`(-[\w-]+)`", text))
    for heading, text in re.findall(
        r"^##+ (factory .+?)\n(.*?)(?=^##|\Z)",
        (ROOT / "docs" / "commands.md").read_text(encoding="utf-8"),
        re.MULTILINE | re.DOTALL,
    )
}


def words_of(line):
    """A line's words up to where the shell does something with the result."""
    words = shlex.split(line, comments=True)
    ends = [place for place, word in enumerate(words) if word in {">", "|", "||", "&&", ";"}]
    return words[: min(ends, default=len(words))]


def targets():
    """What ``make`` can make."""
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    return set(re.findall(r"^([a-z][\w-]*):", text, re.MULTILINE))


def test_tables_are_as_the_code_would_write_them():
    ran(sys.executable, ROOT / "docs" / "generate.py", "--check")


def test_commands_are_found():
    assert len(TYPED) > 40
    assert len(INLINE) > 30


@pytest.mark.parametrize("line", TYPED)
def test_every_command_is_one(line):
    program, *words = words_of(line)
    if program == "factory":
        if not words[0].startswith("--tyro"):
            parse(words)
    elif program == "make":
        assert set(words) <= targets()
    elif words[0] == "-m" and not words[1].startswith("asset_factory."):
        pytest.skip("another package's")
    elif words[0] == "-m":
        module = ROOT / "src" / words[1].replace(".", "/")
        assert module.with_suffix(".py").is_file() or (module / "__main__.py").is_file()
    else:
        script = (ROOT / words[0]).read_text(encoding="utf-8")
        flags = [word for word in words[1:] if word.startswith("--")]
        assert [flag for flag in flags if flag not in script] == []


@pytest.mark.parametrize("line", INLINE)
def test_every_command_in_a_sentence_is_one(line):
    program, *words = words_of(line)
    if program == "make":
        assert words[0] in targets()
        return
    if words[0] in ("COMMAND", "...") or words[0].startswith("--tyro"):
        return
    name = f"factory {words[0]}"
    below = f"{name} {words[1]}" if len(words) > 1 else ""
    name = below if below in FLAGS else name
    known = {*FLAGS.get(name, ()), "--help"}
    assert name in FLAGS, f"no such command: {line}"
    assert [word for word in words if word.startswith("--") and word not in known] == []


def is_cheap(line):
    return line.startswith(CHEAP) and (not line.startswith("factory view") or "--save" in line)


ELSEWHERE = [page for page in PAGES if page.relative_to(ROOT).as_posix() not in PASTED]
SHORT = {line for page in ELSEWHERE for line in commands_of(page) if is_cheap(line)}


@pytest.mark.parametrize("line", sorted(SHORT))
def test_cheap_commands_do_what_they_say(line, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write_urdf(tmp_path)
    known = make_registry(tmp_path / "out").entries()[0].id
    assert run([known if ID.fullmatch(word) else word for word in words_of(line)[1:]]) == 0
    told = capsys.readouterr()
    assert told.out + told.err


@pytest.fixture(scope="session")
def site(tmp_path_factory):
    """The docs as a site, as ``make docs`` builds them."""
    folder = tmp_path_factory.mktemp("site")
    quiet = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    ran(sys.executable, "-m", "mkdocs", "build", "--site-dir", folder, cwd=ROOT, env=quiet)
    return folder


def test_the_site_is_built_without_a_broken_link_and_asks_no_network(site):
    pages = list(site.rglob("*.html"))
    assert len(pages) > 40
    for page in pages:
        text = page.read_text(encoding="utf-8")
        assert (
            re.findall(r"<(?:script|link|img|iframe)[^>]*(?:src|href)=\"?(?:https?:)?//", text)
            == []
        )


@pytest.mark.browser
def test_the_site_is_searched_without_a_server(browser, site):
    page = browser.new_page()
    page.goto((site / "index.html").as_uri())
    page.fill("[data-md-component=search-query]", "turntable")
    page.wait_for_selector(".md-search-result__item", timeout=20_000)
    page.close()


#: The mesh of ``make demo`` that the pages name and do not build; all twelve would take a minute.
DEMO = "examples/meshes/dishwasher.glb"
#: Blocks under such a comment are not run: their commands and flags are parsed.
BLOCK = re.compile(r"^(<!-- not run: .*? -->\n)?```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
#: Where commands of no block would stand.
STRAY = re.compile(r"^    (?:\$ )?(?:\.venv/bin/)?(?:factory|make|python|pip) .*$", re.MULTILINE)


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
    ran(*program, input=text, cwd=folder, env=quiet)


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
    assert STRAY.findall(text) == [], f"commands of {page} stand in no block"


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
