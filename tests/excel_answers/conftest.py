"""The tables of this folder, read, and their formulas evaluated: all rows of a table in one workbook.

A table is a file `family.tsv`. Its lines:

    # text                      where the answers below come from, and why a row is there
    @ A1 {"a",1;,TRUE}          cells from A1 on, as an array constant; an item left out is an empty cell
    =LEFT("abc",2)   "ab"       a formula, a tab, Excel's answer
    {=SUM({1,2}*2)}  6          in braces: an array formula
    =A1:A3   1   B2             a third column: the cell in which the formula stands
    =ISREF(5)   FALSE   !       a `!` there: the numbers in it must stay numbers

An answer is a number, a "text", TRUE, FALSE or an error. `~0.301137432` is an answer as Excel's help prints it: the
result must round to these digits. Other numbers are met to 13 digits.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from xlmc.engine.engine import TEXT_RESULT, Column, Target
from xlmc.engine.engines import ENGINES
from xlmc.engine.graph.lowering import Lowering, lower_until_complete
from xlmc.errors import ErrorCode
from xlmc.excel.address import Area, Cell, column_letters, parse_address
from xlmc.excel.formula import Resolver, build_graph
from xlmc.excel.workbook.workbook import CellContent, Formula, Sheet, Workbook

FOLDER = Path(__file__).parent
DRAWN = "Drawn"
TRIALS = 3
FIRST, RESULTS = 100, 26
"""A formula stands in this row and its line, and in this column, unless told otherwise."""

Held = tuple[np.ndarray, np.ndarray]
"""The numbers and codes of a column, in memory of their own."""

_PLAIN = re.compile(
    r'"(?:[^"]|"")*"'  # a text
    r"|'(?:[^']|'')*'"  # a sheet's name
    r"|\{[^}]*\}"  # an array constant
    r"|#[A-Z/0!?]+"  # an error
    r"|\$?[0-9]+:\$?[0-9]+"  # rows
    r"|[A-Za-z_\\$][\w.$!?]*"  # a name, a function, a cell
    r"|(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
)
_ITEM = re.compile(r'\s*("(?:[^"]|"")*"|[^",;{}]*)\s*([,;}])')


@dataclass(frozen=True)
class Row:
    """One line of a table: a formula and Excel's answer.

    Attributes:
        answer: a number, a text, a logical or an `ErrorCode`.
        digits: decimals that the help prints; None where the answer is exact.
        cell: where the formula stands.
        keeps_numbers: the numbers in it must stay numbers.
    """

    family: str
    line: int
    text: str
    answer: object
    digits: int | None
    cell: Cell
    array: bool
    keeps_numbers: bool

    def __str__(self) -> str:
        return f"{self.family}.tsv:{self.line} {self.text}"

    @property
    def body(self) -> str:
        """The formula without its braces and `=`."""
        return self.text[2:-1] if self.array else self.text[1:]

    def formula(self, numbers: Mapping[float, Cell] | None) -> Formula:
        """The formula to put into the cell, its numbers replaced by cells that hold them unless None."""
        text = self.body if numbers is None else with_cells(self.body, numbers)
        return Formula(text, self.cell.row, self.cell.column, self._area() if self.array else None)

    @property
    def asked(self) -> Cell:
        """Where a question to the result stands; what it needs stands to its right."""
        return Cell(self.family, FIRST + self.line, RESULTS + 1)

    @property
    def asked_of(self) -> Cell:
        """Where the text stands that it should be."""
        return Cell(self.family, self.asked.row, self.asked.column + 1)

    def _area(self) -> Area:
        return Area(self.cell.sheet, self.cell.row, self.cell.column, self.cell.row, self.cell.column)

    def is_met_by(self, got: object) -> bool:
        """Whether a value is the answer: of the same kind, and as close as it should be."""
        if not isinstance(self.answer, float) or type(got) is not float:
            return type(got) is type(self.answer) and got == self.answer
        if self.digits is None:
            return bool(np.isclose(got, self.answer, rtol=1e-13, atol=0))
        return bool(abs(got - self.answer) <= 0.5 * 10.0**-self.digits * (1 + 1e-6))


@dataclass(frozen=True, eq=False)
class Table:
    """A family: its rows, and the cells beside them."""

    family: str
    rows: tuple[Row, ...]
    cells: Mapping[tuple[int, int], object]


def with_cells(text: str, numbers: Mapping[float, Cell]) -> str:
    """A formula whose numbers are replaced by the cells that hold them; those in array constants are not."""

    def replaced(match: re.Match[str]) -> str:
        if match["number"] is None:
            return match[0]
        cell = numbers[float(match["number"])]
        return f"{cell.sheet}!$A${cell.row}"

    return _PLAIN.sub(replaced, text)


def numbers_in(text: str) -> set[float]:
    """The numbers that `with_cells` replaces."""
    return {float(result["number"]) for result in _PLAIN.finditer(text) if result["number"]}


def read_table(path: Path) -> Table:
    """A table from its file."""
    family, cells, rows = path.stem, {}, []
    for line, text in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if text.startswith("@"):
            _, anchor, block = text.split(" ", 2)
            cells |= _block(parse_address(anchor, family), block)
        elif text.startswith(("=", "{=")):
            rows.append(_row(family, line, text))
        elif text.strip() and not text.startswith("#"):
            raise ValueError(f"{path.name}:{line} is no line of a table: {text!r}")
    return Table(family, tuple(rows), cells)


def _row(family: str, line: int, text: str) -> Row:
    formula, answer, *note = text.split("\t")
    place = note[0] if note else ""
    cell = Cell(family, FIRST + line, RESULTS) if place in ("", "!") else parse_address(place, family)
    digits = len(answer.partition(".")[2].partition("E")[0]) if answer.startswith("~") else None
    if digits is not None and "E" in answer:
        digits -= int(answer.partition("E")[2])
    return Row(family, line, formula, _item(answer.lstrip("~")), digits, cell, formula[0] == "{", place == "!")


def _block(anchor: Cell, text: str) -> Iterator[tuple[tuple[int, int], object]]:
    """The cells of an array constant, (row, column) and value."""
    row, column, start = anchor.row, anchor.column, 1
    while start < len(text):
        result = _ITEM.match(text, start)
        assert result, f"{text!r} is no array constant"
        if result[1].strip():
            yield (row, column), _item(result[1].strip())
        row, column = (row + 1, anchor.column) if result[2] == ";" else (row, column + 1)
        start = result.end()


def _item(text: str) -> object:
    if text.startswith('"'):
        return text[1:-1].replace('""', '"')
    if text in ("TRUE", "FALSE"):
        return text == "TRUE"
    return ErrorCode.from_text(text) if text.startswith("#") else float(text)


@cache
def tables() -> tuple[Table, ...]:
    """All tables of this folder."""
    return tuple(read_table(path) for path in sorted(FOLDER.glob("*.tsv")))


class Answers:
    """What the rows of all tables give, each way evaluated once: a value, or `Refused`.

    The ways are `constant`, as they stand, and the engines, their numbers drawn.
    """

    def __init__(self) -> None:
        self.rows = [row for table in tables() for row in table.rows]
        self._known: dict[str, dict[Row, object]] = {}

    def by_way(self, way: str) -> dict[Row, object]:
        """Row -> its value."""
        if way not in self._known:
            result = [constant_answers(t) if way == "constant" else drawn_answers(t, way) for t in tables()]
            self._known[way] = {row: value for answers in result for row, value in answers.items()}
        return self._known[way]

    def expected_failures(self, way: str) -> set[Row]:
        """The rows that `expected_failures.txt` names for that way."""
        rows = {(row.family, row.text): row for row in self.rows}
        result = set()
        for line in (FOLDER / "expected_failures.txt").read_text(encoding="utf-8").splitlines():
            if not line.startswith("#"):
                which, how, _ = line.split(" | ")
                family, _, text = which.partition(" ")
                if how in ("all", way) or (how == "drawn" and way != "constant"):
                    result.add(rows[family, text])
        return result


@pytest.fixture(scope="session")
def answers() -> Answers:
    """All rows of all tables, and what they give."""
    return Answers()


@dataclass(frozen=True)
class Refused:
    """A row that xlmc does not compute, and what it says about it."""

    message: str


def constant_answers(table: Table) -> dict[Row, object]:
    """Every row of a family as it stands."""
    lowering, _ = _lowered(table, {})
    return {row: _known(lowering, row) for row in table.rows}


def _known(lowering: Lowering, row: Row) -> object:
    if row.cell in lowering.faults:
        return Refused(lowering.faults[row.cell].message)
    value = lowering.value(row.cell)
    assert value is not None, f"{row} is not constant"
    return value.objects().ravel()[0]


@cache
def _drawn(table: Table) -> tuple[Lowering, Mapping[str, np.ndarray]]:
    """A family, its numbers replaced by cells that are drawn, and the draws, which always give them."""
    numbers = sorted(set().union(*(numbers_in(row.body) for row in table.rows if not row.keeps_numbers)))
    return _lowered(table, {number: Cell(DRAWN, i, 1) for i, number in enumerate(numbers, 1)})


def drawn_answers(table: Table, engine: str) -> dict[Row, object]:
    """Every row of a family, its numbers drawn."""
    lowering, draws = _drawn(table)
    faults = lowering.faults
    result: dict[Row, object] = {row: Refused(faults[row.cell].message) for row in table.rows if row.cell in faults}
    groups = _groups([row for row in table.rows if row not in result], engine)
    while groups:
        group = groups.pop()
        cells = [cell for row in group for cell in (row.cell, row.asked)]
        program = ENGINES[engine].load()(lowering, [Target(cell, cell) for cell in cells], [], frozenset())
        evaluator = program.evaluator(TRIALS)
        columns = [_held(column) for column in evaluator.filters(draws, TRIALS)]
        if engine == "numpy" and len(group) > 1 and evaluator._left_fast_path:
            groups += [[row] for row in group]
        else:
            result |= {row: _seen(row, *pair) for row, pair in zip(group, batched(columns), strict=True)}
    return result


def batched(columns: list[Held]) -> Iterator[tuple[Held, Held]]:
    """Two by two."""
    return zip(columns[::2], columns[1::2], strict=True)


def _groups(rows: list[Row], engine: str) -> list[list[Row]]:
    """Which rows are evaluated together: of those that give no error NumPy takes few, as an error leads all of a block
    off the fast path, and each error alone; the compiled engine, which takes long to compile, all, and all errors."""
    errors = [row for row in rows if isinstance(row.answer, ErrorCode)]
    others = [row for row in rows if row not in errors]
    alone, few = (1, 6) if engine == "numpy" else (len(rows), len(rows))
    return [*_shares(errors, alone), *_shares(others, few)]


def _shares(rows: list[Row], size: int) -> list[list[Row]]:
    return [rows[start : start + size] for start in range(0, len(rows), size)]


def _held(column: Column) -> Held:
    codes = np.zeros(TRIALS, np.uint8) if column.codes is None else column.codes.copy()
    return np.array(column.values, np.float64), codes


def _seen(row: Row, result: Held, asked: Held) -> object:
    """The value of a row, the same in all trials, from what it gives and the answer to `_question`."""
    assert all((part == part[0]).all() for part in (*result, *asked)), f"{row} differs between trials"
    number, code = float(result[0][0]), int(result[1][0])
    if code == TEXT_RESULT:
        return row.answer if isinstance(row.answer, str) and asked[0][0] else "another text"
    if code:
        return ErrorCode(code)
    return bool(number) if not isinstance(row.answer, str) and asked[0][0] else number


def _lowered(table: Table, numbers: Mapping[float, Cell]) -> tuple[Lowering, Mapping[str, np.ndarray]]:
    """All rows of a family lowered in one workbook, and the draws of the numbers."""
    book = _workbook(table, numbers)
    inputs = {cell: f"number {number!r}" for number, cell in numbers.items()}
    wanted = [cell for row in table.rows for cell in ((row.cell, row.asked) if numbers else (row.cell,))]
    resolver = Resolver(book, inputs, strict=False)

    def lower(more: Mapping[Cell, set[Cell]]) -> Lowering:
        graph = build_graph(resolver, wanted, frozenset(inputs), more=more, strict=False)
        return Lowering(graph, inputs, {}, audit=True)

    return lower_until_complete(lower), {inputs[cell]: np.full(TRIALS, number) for number, cell in numbers.items()}


def _workbook(table: Table, numbers: Mapping[float, Cell]) -> Workbook:
    """A sheet of the family, and one of the numbers."""
    drawn = {(cell.row, cell.column): CellContent(number) for number, cell in numbers.items()}
    laid = {place: CellContent(value) for place, value in table.cells.items()}
    for row in table.rows:
        formula = row.formula(None if row.keeps_numbers or not numbers else numbers)
        laid[row.cell.row, row.cell.column] = CellContent(None, formula)
        laid[row.asked.row, row.asked.column] = CellContent(None, _question(row))
        if isinstance(row.answer, str):
            laid[row.asked_of.row, row.asked_of.column] = CellContent(row.answer)
    sheets = {
        name: Sheet(name, f"xl/worksheets/{name}.xml", held) for name, held in ((table.family, laid), (DRAWN, drawn))
    }
    return Workbook("answers.xlsx", sheets, (), ())


def _question(row: Row) -> Formula:
    """Of a row that should give a text, whether it is that text, which stands to the right; else, whether it is a
    logical."""
    result, answer = (f"{column_letters(cell.column)}{cell.row}" for cell in (row.cell, row.asked_of))
    text = f"IFERROR(EXACT({result},{answer}),FALSE)" if isinstance(row.answer, str) else f"ISLOGICAL({result})"
    return Formula(text, row.asked.row, row.asked.column)
