"""Every function with too few, too many, empty and missing arguments; functions that xlmc does not compute."""

from __future__ import annotations

import importlib.util
from dataclasses import replace

import numpy as np
import pytest

from xlmc.engine.engine import TEXT_RESULT, Target
from xlmc.engine.engines import ENGINES
from xlmc.engine.graph.called_functions import LEFT_OUT, MOST, SPECIAL, check_count
from xlmc.engine.graph.choices import CHOICES
from xlmc.engine.graph.lambdas import LAMBDAS
from xlmc.engine.graph.lowering import WRITTEN_OUT, Lowering, lower_until_complete
from xlmc.engine.graph.reference_functions import REFERENCE_FUNCTIONS
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.errors import ErrorCode, FormulaError, XlmcError
from xlmc.excel.address import Cell, parse_address
from xlmc.excel.formula import Resolver, build_graph
from xlmc.excel.functions.families import REGISTRY

OURS = sorted(name for name in {*REGISTRY, *CHOICES, *REFERENCE_FUNCTIONS, *LAMBDAS, *WRITTEN_OUT} if name[0].isalpha())
CELLS = {"A1": 0.0, "A2": 2.0, "A3": "x", "B1": 1.5, "B2": True, "C1": 3.0, "C2": "=1/0", "C3": "=A1*2"}

LOST = ['INDIRECT("no such")', "OFFSET(A1,-1,0)", "INDEX(A1:B2,9,9)", "INDEX(A1:B2,A1+2,1)", "CHOOSE(9,A1:A2,B1:B2)"]
"""References that lead nowhere; the fourth in some trials only."""


def _limits(name):
    return SPECIAL[name] if name in SPECIAL else REGISTRY[name].arity()


@pytest.fixture(scope="module")
def outcome(workbook):
    """`outcome("SUM(A1)")`: the codes of three trials, the last of an error; the message where it is refused."""

    def compute(formula):
        book = workbook({**CELLS, "Z9": f"={formula}"})
        inputs, cell = {parse_address("A1", "S"): "A1"}, parse_address("Z9", "S")
        try:
            graph = build_graph(Resolver(book, inputs), [cell], frozenset(inputs), frozenset())
            program = NumpyProgram.of(Lowering(graph, inputs, {}), [], [Target(cell, cell)], frozenset(["A1"]))
        except XlmcError as error:
            return str(error)
        evaluator = program.evaluator(3)
        evaluator.filters({"A1": np.array([1.0, 2.0, np.nan])}, 3)
        (column,) = evaluator.forecasts(np.arange(3))
        return np.zeros(3, int) if column.codes is None else column.codes.astype(int)

    return compute


OF_MANY = [name for name in OURS if _limits(name)[1] >= 255]


@pytest.mark.parametrize(("number", "name"), [*enumerate(OURS)])
def test_a_wrong_number_of_arguments_is_refused_with_the_cell(outcome, number, name):
    """Each function has too few or too many in a cell, the other is checked alone.

    Every eighth of the functions that take as many arguments as Excel allows is given one more.
    """
    fewest, most = _limits(name)
    too_many = [most + 1] if name not in OF_MANY or OF_MANY.index(name) % 8 == 0 else []
    wrong = [*([fewest - 1] if fewest else []), *too_many]
    for at, count in enumerate(wrong):
        if at == number % len(wrong):
            refused = outcome(f"{name}({','.join(['1'] * count)})")
            assert isinstance(refused, str)
            assert "S!Z9" in refused
        else:
            with pytest.raises(FormulaError):
                check_count(name, (1,) * count)


PARTS = [("", "A1:B3", part) for lost in LOST for part in ("{1,2;3,4}", lost)]


VOLATILE = [name for name in OURS if name in REGISTRY and REGISTRY[name].volatile]


@pytest.mark.parametrize("name", VOLATILE)
def test_what_changes_by_itself_gives_values_or_a_refusal_with_the_cell(outcome, name):
    """A book that lists what is refused does not compute these."""
    result = outcome(f"{name}({','.join(['A1'] * _limits(name)[0])})")
    assert "S!Z9" in result if isinstance(result, str) else result.shape == (3,)


@pytest.mark.parametrize("at", range(3), ids=["left out", "ranges", "arrays and references that lead nowhere"])
def test_any_arguments_give_values_or_a_refusal_with_the_cell(workbook, at):
    """All functions in one book, which lists what is refused; each trial has its codes, the last is of an error."""
    asked = [(PARTS[i % len(PARTS)][at], name) for i, name in enumerate(OURS) if name not in VOLATILE]
    cells = [Cell("S", row, 26) for row, _ in enumerate(asked, 9)]
    texts = {
        f"Z{cell.row}": f"={name}({','.join([part] * max(_limits(name)[0], 1))})"
        for cell, (part, name) in zip(cells, asked, strict=True)
    }
    inputs = {parse_address("A1", "S"): "A1"}
    resolver = Resolver(workbook(CELLS | texts), inputs, strict=False)

    def lowered(more):
        graph = build_graph(resolver, cells, frozenset(inputs), more=more, strict=False)
        return Lowering(graph, inputs, {}, audit=True)

    lowering = lower_until_complete(lowered)
    assert all(str(fault).startswith(f"{cell}: ") for cell, fault in lowering.faults.items())
    assert len(lowering.faults) < len(OURS) / 2
    targets = [Target(cell, cell) for cell in cells if cell not in lowering.faults]
    evaluator = NumpyProgram.of(lowering, [], targets, frozenset(["A1"])).evaluator(3)
    evaluator.filters({"A1": np.array([1.0, 2.0, np.nan])}, 3)
    assert {column.values.shape for column in evaluator.forecasts(np.arange(3))} == {(3,)}


def test_a_count_that_is_wrong_says_what_is_right():
    with pytest.raises(FormulaError, match="INDIRECT has 0 arguments; it takes 1 to 2"):
        check_count("INDIRECT", ())
    with pytest.raises(FormulaError, match="MAP has 1 argument; it takes 2 or more"):
        check_count("MAP", (1,))
    check_count("NOSUCH", ())


def test_every_function_that_is_lowered_in_a_way_of_its_own_has_a_count():
    special = {*CHOICES, *REFERENCE_FUNCTIONS, *LAMBDAS, *WRITTEN_OUT}
    assert special - SPECIAL.keys() <= REGISTRY.keys()
    assert all(0 <= fewest <= most <= MOST for fewest, most in SPECIAL.values())


ENGINES_HERE = ["numpy", *(["jit"] if importlib.util.find_spec("llvmlite") else [])]


def _of(book, formula):
    cells = {"A1": 1.0, "A2": 2.0, "A3": 4.0, "B1": f"={formula}"}
    return book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, {"answer": "B1"})


@pytest.mark.parametrize("name", sorted(LEFT_OUT))
def test_a_function_of_excel_without_a_body_is_refused_by_name_with_its_cell(book, name):
    with pytest.raises(FormulaError, match=f"xlmc does not compute the function {name} of Excel") as caught:
        _of(book, f"_xlfn.{name}(A1:A3,A1:A3,A1:A3)")
    assert str(caught.value.where) == "S!B1"
    assert "docs/functions.md" in str(caught.value)


@pytest.mark.parametrize("name", ["DUMMYFUNCTION", "ARRAYROW", "SUMM"])
def test_what_nobody_knows_is_refused_as_unknown(book, name):
    with pytest.raises(FormulaError, match=f"The function {name} is not known to xlmc") as caught:
        _of(book, f"{name}(A1)")
    assert str(caught.value.where) == "S!B1"


NAME = ErrorCode.NAME
SAVED = {
    "a function": ("NOSUCHFUNCTION(1)", NAME, "#NAME?"),
    "a function of a drawn number": ("NOSUCHFUNCTION(A1)+A1", NAME, "#NAME?"),
    "caught": ('IFERROR(NOSUCHFUNCTION(A1),"none")', "none", "text"),
    "caught and counted": ("IF(ISERROR(NOSUCHFUNCTION(A1)),7,A1)", 7.0, 7.0),
    "told apart": ("ERROR.TYPE(NOSUCHFUNCTION(1))", 5.0, 5.0),
    "a name": ("nosuchname*2", NAME, "#NAME?"),
}


@pytest.mark.parametrize("engine", ENGINES_HERE)
@pytest.mark.parametrize(("formula", "saved", "expected"), SAVED.values(), ids=SAVED)
def test_what_excel_did_not_know_is_its_error_with_a_notice(lower, engine, formula, saved, expected):
    draws = {"A1": np.array([1.0, 2.0])}
    lowering, targets = lower({"A1": 1.0, "B1": (f"={formula}", saved)}, draws, ["B1"])
    columns = ENGINES[engine].load()(lowering, targets, [], frozenset()).evaluator(2).filters(draws, 2)
    assert [*_shown(columns[0])] == [expected] * 2
    (notice,) = {str(notice) for notice in lowering.notices}
    assert notice.upper().startswith("S!B1: EXCEL DOES NOT KNOW NOSUCH")


def _shown(column):
    codes = np.zeros(column.values.size, int) if column.codes is None else column.codes
    for value, code in zip(column.values, codes, strict=True):
        yield float(value) if not code else "text" if code == TEXT_RESULT else ErrorCode(int(code)).text


REFUSED = {
    "no saved value": ("NOSUCHFUNCTION(A1)", None, {}),
    "another saved value": ("NOSUCHFUNCTION(A1)", 3.0, {}),
    "caught, no saved value": ('IFERROR(NOSUCHFUNCTION(A1),"none")', None, {}),
    "caught, another saved value": ('IFERROR(NOSUCHFUNCTION(A1),"none")', 3.0, {}),
    "of the book's own code": ("NOSUCHFUNCTION(A1)", NAME, {"xl/vbaProject.bin": b""}),
    "of a macro sheet": ("NOSUCHFUNCTION(A1)", NAME, {"xl/macrosheets/sheet1.xml": b""}),
    "of an add-in": ("_xll.NOSUCHFUNCTION(A1)", NAME, {}),
    "of an add-in by its prefix": ("RiskNoSuchFunction(A1)", NAME, {}),
    "of a newer Excel": ("_xlfn.NOSUCHFUNCTION(A1)", NAME, {}),
    "of Excel itself": ("PHONETIC(A1)", NAME, {}),
    "a name, another saved value": ("nosuchname*A1", 3.0, {}),
    "a name, no saved value": ("nosuchname*A1", None, {}),
}


@pytest.mark.parametrize(("formula", "saved", "parts"), REFUSED.values(), ids=REFUSED)
def test_what_somebody_may_know_is_refused_by_cell(workbook, formula, saved, parts):
    book = replace(workbook({"A1": 1.0, "B1": (f"={formula}", saved)}), parts=parts)
    cell = parse_address("A1", "S")

    def lowered():
        graph = build_graph(Resolver(book, {cell}), [parse_address("B1", "S")], frozenset({cell}))
        return Lowering(graph, {cell: "A1"}, {})

    with pytest.raises(FormulaError, match="S!B1"):
        lowered()


def test_filled_down_each_cell_answers_for_itself(workbook):
    """The second was computed where the function was known: it is not what the first is."""
    book = workbook({"A1": 1.0, "B1": ("=NOSUCHFUNCTION(A1)", NAME), "B2": ("=NOSUCHFUNCTION(A2)", 4.0)})
    cells = [parse_address(address, "S") for address in ("B1", "B2")]
    lowering = Lowering(build_graph(Resolver(book), cells, frozenset()), {}, {})
    first, second = (lowering.value(cell).objects()[0] for cell in cells)
    assert (first, second) == (NAME, 4.0)
    assert [str(notice.where) for notice in lowering.notices] == ["S!B1", "S!B2"]


def test_nothing_that_has_a_body_is_said_to_have_none():
    assert not LEFT_OUT & {*REGISTRY, *CHOICES, *LAMBDAS, *REFERENCE_FUNCTIONS, *WRITTEN_OUT, "LET", "LAMBDA"}
