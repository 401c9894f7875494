"""The list of small wrong changes fits the code, and a change that no test notices is told."""

import runpy
import shutil

import pytest
from repository import ROOT

SCRIPT = runpy.run_path(str(ROOT / ".ci" / "mutants.py"))
MUTANTS = SCRIPT["read_mutants"](SCRIPT["LIST"])


@pytest.mark.parametrize("mutant", MUTANTS, ids=[mutant.says for mutant in MUTANTS])
def test_every_change_can_still_be_made_and_has_its_tests(mutant, tmp_path):
    copy = tmp_path / mutant.file
    copy.parent.mkdir(parents=True)
    shutil.copyfile(ROOT / mutant.file, copy)
    mutant.apply(tmp_path)
    assert copy.read_text(encoding="utf-8") != (ROOT / mutant.file).read_text(encoding="utf-8")
    for test in mutant.tests:
        file, _, name = test.partition("::")
        assert f"def {name}" in (ROOT / file).read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("before", "after", "asserted", "fault"),
    [
        ("/ 2", "/ 3", "assert half(4) == 2", ""),
        ("/ 2", "/ 3", "assert half(0) == 0", "SURVIVES"),
        ("/ 2", "/ twice", "assert half(4) == 2", "no test judged it"),
        ("def half", "def third", "assert half(4) == 2", "no test judged it"),
        ("/ 2", "/", "assert half(4) == 2", "cannot be made"),
        ("/ 4", "/ 2", "assert half(4) == 2", "cannot be made: its text before occurs 0 times"),
    ],
)
def test_only_a_test_that_fails_by_its_own_word_kills(tmp_path, before, after, asserted, fault):
    (tmp_path / "src").mkdir()
    source = tmp_path / "src" / "half.py"
    source.write_text("def half(number):\n    return number / 2\n")
    test = f"from half import half\n\n\ndef test_half():\n    {asserted}\n"
    (tmp_path / "test_half.py").write_text(test)
    mutant = SCRIPT["Mutant"]("src/half.py", before, after, ("test_half.py",), "halves are wrong")
    found = SCRIPT["judge"](mutant, tmp_path)
    assert found.startswith(fault)
    assert bool(found) is bool(fault)
    assert source.read_text() == "def half(number):\n    return number / 2\n"
