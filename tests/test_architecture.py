"""The house of DESIGN §6: imports run downwards, and each door has one keeper."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1] / "xlmc"

# From the ground up; what stands in one line does not import each other.
FLOORS = [
    {"errors", "collecting", "printable"},
    {"address", "scratch"},
    {"distributions", "statistics"},
    {"workbook", "fitting"},
    {"formula", "templates_folder"},
    {"definitions"},
    {"functions"},
    {"compile", "sampling"},
    {"scene", "drawing", "correlating", "remarks", "stopping"},
    {"base_parameters", "filter_values"},
    {"model", "verify"},
    {"blocks", "cell_errors", "checking", "derivatives", "digits", "result_cells", "tail_notices"},
    {"simulation", "scheduling"},
    {"rounding", "pilot", "rare"},
    {"simulate"},
    {"record", "statements"},
    {"saved"},
    {"analysis", "methods", "sensitivity", "stability"},
    {"report"},
    {"replay"},
    {"cli"},
    {"__main__"},
]
FLOOR = {room: number for number, rooms in enumerate(FLOORS) for room in rooms}
MODULES = sorted(path for path in PACKAGE.rglob("*.py") if "templates" not in path.relative_to(PACKAGE).parts)


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


@pytest.fixture(scope="module", autouse=True)
def trees_are_kept_for_this_file_alone():
    yield
    tree_of.cache_clear()


@cache
def imported(path: Path, *, at_run_time_only: bool = True) -> set[str]:
    """Full names of the modules a file imports at its top level, those for type checkers left out."""
    tree = tree_of(path)
    names: set[str] = set()
    for node in tree.body if at_run_time_only else ast.walk(tree):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.update({node.module, *(f"{node.module}.{alias.name}" for alias in node.names)})
    return names


def room_of(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def test_every_room_has_a_floor():
    assert {room_of(path) for path in MODULES} - {"__init__"} == set(FLOOR)


def test_imports_run_downwards():
    upwards = []
    for path in MODULES:
        own = room_of(path)
        for name in imported(path) if own != "__init__" else ():
            first, _, rest = name.partition(".")
            room = rest.partition(".")[0]
            if first == "xlmc" and room in FLOOR and room != own and FLOOR[room] >= FLOOR[own]:
                upwards.append(f"{path.relative_to(PACKAGE)} imports {name}")
    assert upwards == []


def importers(*modules: str) -> set[str]:
    """The files that import any of these modules, anywhere in them."""
    found = set()
    for path in MODULES:
        names = imported(path, at_run_time_only=False)
        if any(name == module or name.startswith(f"{module}.") for name in names for module in modules):
            found.add(str(path.relative_to(PACKAGE)))
    return found


def test_one_door_to_formulas():
    assert importers("formulas", "schedula") == {"formula/parse.py"}


def test_rooms_that_must_not_see_each_other():
    blind = ("compile", "sampling", "functions", "statistics", "distributions", "fitting")
    assert not {name for name in importers("xlmc.workbook") if name.startswith(blind)}
    assert not {name for name in importers("xlmc.formula") if name.startswith(("report", "sampling", "statistics"))}


def for_type_checkers(tree: ast.Module) -> set[ast.AST]:
    guards = (node for node in tree.body if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING")
    return {inner for guard in guards for inner in ast.walk(guard)}


def test_only_doors_for_people_reach_upwards():
    """`Model.simulate`, `Simulation.save…`, `.keep` and the like are doors; they import what they open when called."""
    reached = set()
    for path in MODULES:
        tree, own = tree_of(path), room_of(path)
        skipped = for_type_checkers(tree)
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.module and node not in skipped:
                first, _, rest = node.module.partition(".")
                room = rest.partition(".")[0]
                if first == "xlmc" and room not in ("", own) and own in FLOOR and FLOOR[room] >= FLOOR[own]:
                    reached.add((own, room))
    assert reached == {("model", "simulate"), ("simulation", "report"), ("simulation", "saved")}


def test_scipy_stats_is_never_imported():
    assert importers("scipy.stats") == set()


def test_no_text_is_run_as_code_and_only_the_command_line_prints():
    forbidden = ("eval", "exec", "compile", "__import__", "print")
    called = [
        f"{path.relative_to(PACKAGE)}:{node.lineno}: {node.func.id}"
        for path in MODULES
        for node in ast.walk(tree_of(path))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in forbidden
    ]
    assert called == []
