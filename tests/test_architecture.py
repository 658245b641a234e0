"""The house: imports run down the table of rooms.py, and each door has one keeper."""

from __future__ import annotations

import ast
import re
from collections import Counter

from rooms import DOORS, LISTS, MODULES, PACKAGE, ROOMS, arrows, circles, imported, pieces, room_of, upwards


def test_every_room_stands_in_the_table():
    assert {room_of(path) for path in MODULES} - {*DOORS} == set(ROOMS)


def test_no_import_runs_up_the_table_not_even_a_lazy_one_or_one_for_type_checkers():
    assert list(upwards()) == []


def test_no_modules_import_each_other_in_a_circle():
    assert circles() == []


def test_a_module_that_only_one_other_needs_is_not_small():
    assert list(pieces()) == []
    assert {*LISTS} <= {str(path.relative_to(PACKAGE)) for path in MODULES}


def test_a_name_says_which_module_is_meant_but_a_command_may_have_the_name_of_what_it_runs():
    names = Counter(path.name for path in MODULES if room_of(path) != "cli" and path.name != "__init__.py")
    assert [name for name, times in names.items() if times > 1] == []


def test_an_arrow_up_would_be_seen():
    assert ("cli", "run") in arrows()
    assert ("run", "evaluation") in arrows()
    assert "cli/simulate.py" in arrows()["cli", "api"]


def importers(*modules: str) -> set[str]:
    """The files that import any of these modules, anywhere in them."""
    found = set()
    for path in MODULES:
        names = imported(path)
        if any(name == module or name.startswith(f"{module}.") for name in names for module in modules):
            found.add(str(path.relative_to(PACKAGE)))
    return found


def test_one_door_to_formulas():
    assert importers("formulas", "schedula") == {"formula/parse.py", "formula/formula_tokens.py"}


def test_only_the_live_window_listens_and_only_its_command_imports_it():
    serving = importers("socket", "starlette", "uvicorn", "websockets", "watchfiles")
    assert {name for name in serving if not name.startswith("live/")} == set()
    assert {name for name in importers("xlmc.live") if not name.startswith("live/")} == {"cli/open.py"}


def test_rooms_that_must_not_see_each_other():
    blind = ("evaluation", "sampling", "functions", "statistics", "distributions", "studies/fitting")
    assert not {name for name in importers("xlmc.workbook") if name.startswith(blind)}
    assert not {name for name in importers("xlmc.formula") if name.startswith(("report", "sampling", "statistics"))}


def test_scipy_stats_is_never_imported():
    assert importers("scipy.stats") == set()


def test_no_text_is_run_as_code_and_only_the_command_line_prints():
    forbidden = ("eval", "exec", "compile", "__import__", "print")
    called_perhaps = re.compile(rf"(?<![\w.])(?:{'|'.join(forbidden)})\b(?!=)")  # spares parsing what calls none
    texts = {path: path.read_text(encoding="utf-8") for path in MODULES}
    called = [
        f"{path.relative_to(PACKAGE)}:{node.lineno}: {node.func.id}"
        for path, text in texts.items()
        if called_perhaps.search(text)
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in forbidden
    ]
    assert called == []
