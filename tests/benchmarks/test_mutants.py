"""Mutants: one change each, in what is run, and tests that mirror the module."""

from __future__ import annotations

import ast
import os
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
    result = list(mutants.mutants(Path("a.py"), SOURCE))
    assert {(each.old, each.new) for each in result} == CHANGES
    assert len(result) == len(CHANGES)
    for each in result:
        changed = each.text(SOURCE)
        ast.parse(changed)
        differing = [
            n for n, (a, b) in enumerate(zip(SOURCE.splitlines(), changed.splitlines(), strict=True), 1) if a != b
        ]
        assert differing == [each.line]


@pytest.mark.parametrize(
    ("module", "first"),
    [
        ("xlmc/api/models.py", "tests/api/test_api.py"),
        ("xlmc/montecarlo/sampling/latin.py", "tests/montecarlo/sampling/test_latin.py"),
        ("xlmc/excel/functions/criteria.py", "tests/excel/functions/test_criteria.py"),
        ("xlmc/__main__.py", None),
    ],
)
def test_the_tests_of_a_module_are_those_that_mirror_it(module, first):
    tests = [each for group in mutants.tests_of(Path(module), mutants.ROOT) for each in group]
    assert len(tests) == len({*tests})
    if first is None:
        assert not tests
    else:
        assert tests[0] == str(Path(first))
        assert {*tests} >= {
            str(each.relative_to(mutants.ROOT)) for each in (mutants.ROOT / first).parent.glob("test_*.py")
        }


def test_tests_near_by_that_import_a_module_come_before_its_folder(tmp_path):
    for name, text in [
        ("tests/excel/functions/test_few.py", ""),
        ("tests/excel/functions/test_own.py", "from xlmc.excel.functions.few import f\n"),
        ("tests/excel/functions/inner/test_deep.py", ""),
        ("tests/excel/functions/test_other.py", ""),
        ("tests/excel/functions/test_user.py", ""),
        ("tests/excel/test_above.py", "import xlmc.excel.functions.few_more as more\n"),
        ("tests/excel/workbook/test_near.py", "import xlmc.excel.functions.few as few\n"),
        ("tests/engine/test_far.py", "import xlmc.excel.functions.few as few\n"),
        ("xlmc/excel/functions/few.py", ""),
        ("xlmc/excel/functions/user.py", "from xlmc.excel.functions.few import f\n"),
        ("xlmc/engine/far.py", "from xlmc.excel.functions.few import f\n"),
    ]:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    tests = mutants.tests_of(Path("xlmc/excel/functions/few.py"), tmp_path)
    assert [[Path(each).name for each in group] for group in tests] == [
        ["test_few.py"],
        ["test_own.py", "test_near.py", "test_user.py"],
        ["test_other.py", "test_deep.py"],
        ["test_above.py"],
    ]


@pytest.mark.parametrize(
    ("change", "end"), [(("True", "False"), "killed"), (("False", "True"), "survived")], ids=["killed", "survived"]
)
def test_a_mutant_that_a_test_finds_is_killed(tmp_path, change, end):
    (tmp_path / "xlmc").mkdir()
    (tmp_path / "tests").mkdir()
    source = "SEEN = True\nUNSEEN = False\n"
    (tmp_path / "xlmc" / "few.py").write_text(source, encoding="utf-8")
    test = "import sys\nsys.path.insert(0, 'xlmc')\nimport few\n\n\ndef test_few():\n    assert few.SEEN\n"
    (tmp_path / "tests" / "test_few.py").write_text(test, encoding="utf-8")
    [mutant] = (each for each in mutants.mutants(Path("xlmc/few.py"), source) if (each.old, each.new) == change)
    assert mutants.fate(mutant, tmp_path, 60.0)[0] == end
    assert (tmp_path / "xlmc" / "few.py").read_text(encoding="utf-8") == source


def test_bytecode_is_kept_once_and_never_that_of_another_text(tmp_path):
    (tmp_path / "xlmc").mkdir()
    (tmp_path / "tests").mkdir()
    (tmp_path / "xlmc" / "__init__.py").touch()
    (tmp_path / "xlmc" / "few.py").write_text("SEEN = 10\n", encoding="utf-8")
    (tmp_path / "tests" / "test_few.py").write_text(
        "from xlmc.few import SEEN\n\ndef test_few():\n    assert SEEN == 10\n", encoding="utf-8"
    )
    mutants.keep_bytecode(tmp_path)
    kept = {each: each.read_bytes() for each in tmp_path.rglob("*.pyc")}
    assert {each.name.partition(".")[0] for each in kept} == {"__init__", "few", "test_few"}
    assert not mutants.failures(["tests/test_few.py"], tmp_path, 60.0)
    times = (tmp_path / "xlmc" / "few.py").stat()
    (tmp_path / "xlmc" / "few.py").write_text("SEEN = 11\n", encoding="utf-8")
    os.utime(tmp_path / "xlmc" / "few.py", ns=(times.st_atime_ns, times.st_mtime_ns))
    assert mutants.failures(["tests/test_few.py"], tmp_path, 60.0)
    assert kept == {each: each.read_bytes() for each in tmp_path.rglob("*.pyc")}


def test_of_tests_that_are_equally_near_those_that_killed_most_come_first(tmp_path, monkeypatch):
    given = []
    ends = {"a": set(), "b": {"tests/excel/test_z.py::test_z[x]"}}
    monkeypatch.setattr(mutants, "failures", lambda tests, copy, seconds, *_: given.append(tests) or ends[copy.name])
    for copy in ("a", "b"):
        (tmp_path / copy / "tests" / "excel").mkdir(parents=True)
        for name in ("test_few.py", "test_y.py", "test_z.py"):
            (tmp_path / copy / "tests" / "excel" / name).touch()
        (tmp_path / copy / "xlmc" / "excel").mkdir(parents=True)
        (tmp_path / copy / "xlmc" / "excel" / "few.py").write_text("SEEN = 1\n", encoding="utf-8")
    kills = mutants.Counter()
    mutant = mutants.Mutant(Path("xlmc/excel/few.py"), 1, 7, "1", "2")
    assert [mutants.fate(mutant, tmp_path / copy, 60.0, kills)[0] for copy in "ba"] == ["killed", "survived"]
    assert kills == {str(Path("tests/excel/test_z.py")): 1}
    assert [[Path(each).name for each in tests] for tests in given] == [
        ["test_few.py"],
        ["test_few.py"],
        ["test_z.py", "test_y.py"],
    ]
