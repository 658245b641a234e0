"""The formulas that may hold calls that stand for assumptions or results, and what is found in them.

Most workbooks have none, and the modules that read such calls are imported for those that do.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.workbook.lazy_sheets import LazySheets
from xlmc.excel.workbook.workbook import Formula, Workbook

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Assumption
    from xlmc.montecarlo.definitions.in_cells.reading import CellDraw, Output
    from xlmc.montecarlo.definitions.in_cells.result_functions import ResultCall

__all__ = ["InCells", "holds_call", "suspects", "without_texts"]

_CALL: Final = re.compile(r"(?<![\w.])(?:_xl\w+\.)*(?:RAND|RANDBETWEEN|RANDARRAY|Risk\w+|CB\.\w+)\s*\(", re.IGNORECASE)
_OTHER: Final = re.compile(r"(?<![\w.])(?:_xl\w+\.)*((?:Psi|Vose)\w+)\s*\(", re.IGNORECASE)
_TEXTS: Final = re.compile(r'"(?:[^"]|"")*"')
_MARKS: Final = (b"rand", b"risk", b"cb.", b"psi", b"vose")
_OF_CRYSTAL_BALL: Final = "cb_data_"
"""The hidden sheet that Crystal Ball adds; its formulas are Crystal Ball's own."""


def holds_call(text: str) -> bool:
    """Whether a formula holds a call that draws, shows results, or belongs to Crystal Ball, @RISK or their like."""
    result = without_texts(text)
    if _CALL.search(result) is not None:
        return True
    others = _OTHER.findall(result)
    if not others:
        return False
    from xlmc.montecarlo.definitions.in_cells.other_programs import of_another_program  # few workbooks have them

    return any(of_another_program(name.upper()) for name in others)


def without_texts(text: str) -> str:
    """Return the formula with every text in it empty."""
    return _TEXTS.sub('""', text)


@dataclass(slots=True)
class InCells:
    """What the calls in cells say.

    Attributes:
        assumptions: in the order of sheets, rows and columns.
        outputs: the cells that are marked as outputs, by their cell.
        rewritten: the formulas with assumptions instead of calls; or why a cell cannot be computed.
        draws: name of an assumption -> what its call says beside the distribution.
        results: the cells that show results -> what they ask for.
        shown: the cells that show results, or numbers of distributions -> their formula, with the latter.
        unavailable: the cells that should show results and cannot -> why.
        idle: property functions without an effect -> the first cell that has one.
        lognorms: the cells with `RiskLognorm`.
        simtables: the cells with `RiskSimtable` -> the values of each.
        taken: the calls that rows of a table stand for.
        shifted: the draws that are shifted, as cells -> the cell whose formula shifts them, and what it then says.
    """

    assumptions: list[Assumption] = field(default_factory=list)
    outputs: dict[Cell, Output] = field(default_factory=dict)
    rewritten: dict[Cell, ir.Expression | FormulaError] = field(default_factory=dict)
    draws: dict[str, CellDraw] = field(default_factory=dict)
    results: dict[Cell, list[ResultCall]] = field(default_factory=dict)
    shown: dict[Cell, ir.Expression] = field(default_factory=dict)
    unavailable: dict[Cell, str] = field(default_factory=dict)
    idle: dict[str, Cell] = field(default_factory=dict)
    lognorms: list[Cell] = field(default_factory=list)
    simtables: dict[Cell, list[tuple[ir.Expression, ...]]] = field(default_factory=dict)
    taken: set[Cell] = field(default_factory=set)
    shifted: dict[Cell, tuple[Cell, ir.Expression]] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self.rewritten)

    @property
    def refused(self) -> Iterator[FormulaError]:
        """Why cells that show no results cannot be computed."""
        for cell, expression in self.rewritten.items():
            if isinstance(expression, FormulaError) and cell not in self.results and cell not in self.unavailable:
                yield expression


def suspects(workbook: Workbook) -> Iterator[tuple[Cell, Formula]]:
    """Yield the formula cells that hold calls, sheet by sheet, row by row; sheets that cannot hold one are not parsed.

    A cell also holds a call by a defined name that stands for one.
    """
    sheets, named = workbook.sheets, _names_of_calls(workbook)
    words = [*_MARKS, *(name.encode() for name in named)]
    names: Iterable[str] = sheets
    if isinstance(sheets, LazySheets) and all(word.isascii() for word in words):
        names = sheets.mentioning(words)
    any_name = _any_of(named)
    for name in names:
        if name.casefold() == _OF_CRYSTAL_BALL:
            continue
        formulas = {at: content.formula for at, content in sheets[name].cells.items() if content.formula is not None}
        for at in sorted(formulas):
            formula = formulas[at]
            if holds_call(formula.text) or (any_name and any_name.search(formula.text)):
                yield Cell(name, *at), formula


def _names_of_calls(workbook: Workbook) -> set[str]:
    """Return the defined names, in small letters, that stand for calls, also by other names."""
    result: set[str] = set()
    while True:
        any_name = _any_of(result)
        more = {
            name.name.lower()
            for name in workbook.names
            if holds_call(name.text) or (any_name and any_name.search(name.text))
        }
        if more <= result:
            return result
        result |= more


def _any_of(names: Collection[str]) -> re.Pattern[str] | None:
    """Compile a pattern that finds any of these names in a formula."""
    if not names:
        return None
    return re.compile(rf"(?<![\w.\\])(?:{'|'.join(map(re.escape, sorted(names)))})(?![\w.])", re.IGNORECASE)
