"""Runs that another version of xlmc made."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

import xlmc
from xlmc.outputs.replay import versions
from xlmc.outputs.replay.versions import RULES, Rule, install, rules_since

REPOSITORY = Path(__file__).resolve().parents[3]


@pytest.fixture
def rules(monkeypatch):
    made = tuple(
        Rule(version, version, re.compile(met)) for version, met in (("0.3.0", "a"), ("0.10.0", "a"), ("9.0", "a"))
    )
    monkeypatch.setattr(versions, "RULES", made)
    monkeypatch.setattr(versions, "__version__", "0.10.1")


@pytest.mark.parametrize(
    ("version", "contents", "expected"),
    [
        ("0.1.0", ["=a"], ["0.3.0", "0.10.0"]),
        ("0.3.0", ["=b", "=a"], ["0.10.0"]),
        ("0.10.0", ["=a"], []),
        ("0.1.0", ["=b"], []),
        ("0.1.0", [], []),
        ("", ["=a"], ["0.3.0", "0.10.0"]),
        ("0.3.0rc1", ["=a"], ["0.10.0"]),
    ],
)
def test_rules_are_those_since_the_version_that_the_cells_may_meet(rules, version, contents, expected):
    assert [rule.sentence for rule in rules_since(version, contents)] == expected


def test_rules_are_in_the_order_of_versions_and_none_is_of_the_future():
    numbers = [versions._parts(rule.since) for rule in RULES]
    assert numbers == sorted(numbers)
    assert numbers[-1] <= versions._parts(xlmc.__version__)


@pytest.mark.parametrize(
    ("made", "formula", "met"),
    [
        ("TRUNC", "=1+trunc(A1,2)", True),
        ("TRUNC", "=MYTRUNC(A1)", False),
        ("TRUNC", '="TRUNC"', False),
        ("numbers below", "=EXP(A1)", True),
        ("numbers below", "=A1*1E-200", True),
        ("numbers below", "=A1*1E-3", False),
        ("FORMULATEXT", "=_xlfn.FORMULATEXT(A1)", True),
        ("functions that xlmc has no body for", "=_xlfn.FORECAST.ETS(A1,B1:B9,C1:C9)", True),
        ("functions that xlmc has no body for", "=FORECAST(A1,B1:B9,C1:C9)", False),
        ("a LAMBDA that is named like", "=Sum(A1)", True),
        ("a LAMBDA that is named like", "=SUM(A1)", False),
        ("a text that is a date", '="2020-01-01"+A1', True),
        ("a text that is a date", '=IF(A1>1,"no. 5",A1)', False),
        ("all cells of a dynamic array", "=SUM(_xlfn.ANCHORARRAY(A1))", True),
    ],
)
def test_what_a_rule_concerns(made, formula, met):
    [rule] = [rule for rule in RULES if rule.sentence.startswith(made)]
    assert bool(rule.met.search(formula)) is met


def test_the_changelog_names_the_last_commit_of_every_version_before_this_one():
    changelog, archive = ((REPOSITORY / name).read_text("utf-8") for name in ("CHANGELOG.md", "CHANGELOG-archive.md"))
    newest, *earlier = re.findall(r"^## (\S+)(?: - \d{4}-\d\d-\d\d)?$", changelog, re.MULTILINE)
    commits = dict(re.findall(r"^## (\S+)\n\nLast commit: ([0-9a-f]{40})$", archive, re.MULTILINE))
    assert newest == xlmc.__version__
    assert list(commits) == earlier
    for version, commit in commits.items():
        shown = subprocess.run(
            ["git", "-C", str(REPOSITORY), "show", f"{commit}:pyproject.toml"], capture_output=True, encoding="utf-8"
        )
        if shown.returncode:
            pytest.skip("the history is not here")
        assert f'version = "{version}"' in shown.stdout


def test_a_version_is_installed_by_its_tag():
    assert install("0.9.0").startswith("git worktree add ../xlmc-0.9.0 v0.9.0 && ")


def test_a_rule_that_concerns_two_cells_together():
    correlated = "assumptions that take few values"
    for contents, expected in (
        (["Yes-No", "Correlation"], True),
        (["=RiskBernoulli(A1,RiskCorrmat(B1:C2,1))"], True),
        (["Normal", "Correlation"], False),
        (["Yes-No"], False),
    ):
        made = [rule.sentence for rule in rules_since("0.1.0", contents)]
        assert any(each.startswith(correlated) for each in made) is expected
