"""Mutants: one change each, in what is run, and tests that mirror the module."""

from __future__ import annotations

import ast
from pathlib import Path

import mutants
import pytest

SOURCE = '''"""Text with 1 < 2."""
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    n: int = 3


Number: TypeAlias = int | float
pairs = zip([], [], strict=True)


@overload
def f(x: int, flag: bool = True) -> int: ...


def f(x: "int | None", flag: bool = True) -> "int | None":
    if not flag and (x) <= 4:
        return x // 2
    return x + 1.0 if x is not None else 0
'''
CHANGES = {
    ("True", "False"),
    ("not ", ""),
    ("and", "or"),
    ("<=", "<"),
    ("4", "5"),
    ("//", "*"),
    ("2", "3"),
    ("+", "-"),
    ("1.0", "1.5"),
    ("is not", "is"),
    ("0", "1"),
}


def test_a_mutant_is_one_change_of_what_is_run():
    found = list(mutants.mutants(Path("a.py"), SOURCE))
    assert {(each.old, each.new) for each in found} == CHANGES
    assert len(found) == len(CHANGES)
    for each in found:
        changed = each.text(SOURCE)
        ast.parse(changed)
        differing = [
            n for n, (a, b) in enumerate(zip(SOURCE.splitlines(), changed.splitlines(), strict=True), 1) if a != b
        ]
        assert differing == [each.line]


@pytest.mark.parametrize(
    ("module", "tests"),
    [
        ("xlmc/api/models.py", [["tests/api"]]),
        (
            "xlmc/montecarlo/sampling/latin.py",
            [["tests/montecarlo/sampling/test_latin.py"], ["tests/montecarlo/sampling"]],
        ),
        ("xlmc/excel/functions/criteria.py", [["tests/excel/functions/test_criteria.py"], ["tests/excel/functions"]]),
        ("xlmc/__main__.py", []),
    ],
)
def test_the_tests_of_a_module_are_those_that_mirror_it(module, tests):
    assert mutants.tests_of(Path(module))[:2] == [[str(Path(each)) for each in group] for group in tests]


def test_tests_near_by_that_import_a_module_come_before_its_folder(tmp_path, monkeypatch):
    monkeypatch.setattr(mutants, "ROOT", tmp_path)
    for name, text in [
        ("excel/functions/test_few.py", ""),
        ("excel/functions/test_own.py", "from xlmc.excel.functions.few import f\n"),
        ("excel/test_above.py", "import xlmc.excel.functions.few_more as more\n"),
        ("excel/workbook/test_near.py", "import xlmc.excel.functions.few as few\n"),
        ("engine/test_far.py", "import xlmc.excel.functions.few as few\n"),
    ]:
        (tmp_path / "tests" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "tests" / name).write_text(text, encoding="utf-8")
    assert [[Path(each).name for each in group] for group in mutants.tests_of(Path("xlmc/excel/functions/few.py"))] == [
        ["test_few.py"],
        ["test_own.py", "test_near.py"],
        ["functions"],
        ["test_above.py"],
    ]


@pytest.mark.parametrize(
    ("change", "end"), [(("True", "False"), "killed"), (("False", "True"), "survived")], ids=["killed", "survived"]
)
def test_a_mutant_that_a_test_finds_is_killed(tmp_path, monkeypatch, change, end):
    monkeypatch.setattr(mutants, "ROOT", tmp_path)
    (tmp_path / "xlmc").mkdir()
    (tmp_path / "tests").mkdir()
    source = "SEEN = True\nUNSEEN = False\n"
    (tmp_path / "xlmc" / "few.py").write_text(source, encoding="utf-8")
    test = "import sys\nsys.path.insert(0, 'xlmc')\nimport few\n\n\ndef test_few():\n    assert few.SEEN\n"
    (tmp_path / "tests" / "test_few.py").write_text(test, encoding="utf-8")
    [mutant] = (each for each in mutants.mutants(Path("xlmc/few.py"), source) if (each.old, each.new) == change)
    assert mutants.fate(mutant, tmp_path, 60.0)[0] == end
    assert (tmp_path / "xlmc" / "few.py").read_text(encoding="utf-8") == source
