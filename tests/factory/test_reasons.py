"""Every code that somebody says, or asks for, is declared with its meaning, and none else is."""

import ast
from functools import cache
from itertools import chain

from repository import ROOT

from asset_factory.factory import reasons
from asset_factory.sim_checks import Severity
from asset_factory.sim_checks import reasons as judge

#: Calls whose first argument, or ``code``, is a code.
SAYING = {"Finding", "InputRejected", "DescriptionError", "found", "_finding"}


@cache
def parsed(folder):
    """Files and what Python's parser makes of them."""
    paths = sorted((ROOT / folder).rglob("*.py"))
    return [(path, ast.parse(path.read_text(encoding="utf-8"))) for path in paths]


def sources(*folders):
    return chain.from_iterable(parsed(folder) for folder in folders)


def said(tree):
    """Codes in calls that say one."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        name = getattr(node.func, "id", getattr(node.func, "attr", ""))
        if name not in SAYING:
            continue
        named = [keyword.value for keyword in node.keywords if keyword.arg == "code"]
        for argument in (*node.args[:1], *named):
            value = getattr(argument, "value", None)
            if isinstance(value, str) and value.isidentifier():
                yield value


def asked(tree):
    """Codes that a finding's code is compared with."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare) and getattr(node.left, "attr", "") == "code":
            for value in ast.walk(ast.Tuple(node.comparators)):
                if isinstance(value, ast.Constant) and isinstance(value.value, str):
                    yield value.value


def test_the_judge_says_and_asks_only_what_is_declared():
    declared = {*judge.UNREADABLE, *judge.ERRORS, *judge.WARNINGS, *judge.NOTES, *judge.UNJUDGED}
    for path, tree in sources("sim_checks"):
        assert {*said(tree), *asked(tree)} <= declared, path


def test_the_factory_says_and_asks_only_what_is_declared():
    for path, tree in sources("factory", "envs"):
        assert {*said(tree), *asked(tree)} <= reasons.CODES, path


def test_a_code_means_one_thing_at_each_severity():
    assert sum(len(table.meanings) for table in reasons.TABLES) == len(reasons.MEANINGS)
    for severity, table in ((Severity.ERROR, judge.ERRORS), (Severity.WARNING, judge.WARNINGS)):
        assert reasons.meaning_of(severity, "collision_gap") == table["collision_gap"]
    assert reasons.meaning_of(Severity.WARNING, "energy_grows") == judge.ERRORS["energy_grows"]
    assert reasons.meaning_of(Severity.ERROR, "unheard_of") == ""


def test_what_is_declared_is_said_somewhere():
    literals = {
        node.value
        for _, tree in sources("sim_checks", "factory")
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    }
    # Codes made of a quantity and what became of it.
    literals |= {
        f"{name}_{end}" for name in ("friction", "damping") for end in ("ignored", "excessive")
    }
    assert literals >= reasons.CODES
