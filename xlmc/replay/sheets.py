"""Compare the result sheets of a workbook with those that the repeated run writes, cell by cell.

The run's sheets are built anew in memory, and read as the file's are.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

from xlmc.address import Cell
from xlmc.formula.precedents import mentioned
from xlmc.replay.closeness import Closeness, is_number
from xlmc.replay.matching import matched
from xlmc.replay.own_ranges import counted
from xlmc.report.sheets.book import build_sheets
from xlmc.report.sheets.trials_sheet import HEADER, TRIAL_ROWS
from xlmc.workbook.model import CellContent, CellValue
from xlmc.workbook.reader import read_workbook

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation
    from xlmc.workbook.model import Sheet, Workbook

__all__ = ["CellDifference", "SheetComparison", "compare_sheets"]

_RECORD: Final = "Record"
_COMPARED_ELSEWHERE: Final = re.compile(
    r"(file\.\w*sha256|run\.fingerprint|run\.format|software|processor|structure|cells)\b"
)
"""Keys of the Record that say something of the file or of the machine; `xlmc.replay.changes` compares them."""

_ONLY_FIRST: Final = re.compile(r"Only the first ([\d,]+) of [\d,]+ accepted trials stand here\.")
_BLANK: Final = CellContent()

_Place = tuple[int, int]


@dataclass(frozen=True, slots=True)
class CellDifference:
    """A cell that shows something else than the repeated run gives.

    Attributes:
        says: what the file holds; the formula, with `=`, where it holds one that is not the run's.
        gives: what the run gives; None where it leaves the cell blank.
    """

    where: Cell
    says: CellValue
    gives: CellValue


@dataclass(frozen=True, slots=True)
class SheetComparison:
    """What a file shows of its run, beside what the repeated run gives.

    Attributes:
        sheets: the names, in the file, of the result sheets that were compared.
        differences: in the order of sheets, rows and columns.
        missing: result sheets that the file does not hold.
        left_out: what was not compared, in words.
    """

    sheets: tuple[str, ...] = ()
    differences: tuple[CellDifference, ...] = ()
    missing: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()

    @property
    def same(self) -> bool:
        """Whether nothing that was compared differs."""
        return not (self.differences or self.missing)


def compare_sheets(workbook: Workbook, run: Simulation, command: str | None, closeness: Closeness) -> SheetComparison:
    """Compare all result sheets of a file.

    Args:
        workbook: the file.
        run: the repeated run, with the name, the settings and the ending of the recorded one.
        command: what the person typed, as recorded.
        closeness: how far numbers may be apart.
    """
    built = _built(run, command, TRIAL_ROWS)
    found = matched(workbook, built)
    rows = _trial_rows(found["Trials"]) if "Trials" in found else TRIAL_ROWS
    if rows != TRIAL_ROWS:
        built = _built(run, command, rows)
    pairs = [_Pair(built, built.sheets[name], found[name], closeness) for name in built.sheets if name in found]
    return SheetComparison(
        sheets=tuple(pair.sheet.name for pair in pairs),
        differences=tuple(difference for pair in pairs for difference in pair.differences()),
        missing=tuple(name for name in built.sheets if name not in found),
        left_out=tuple(said for pair in pairs for said in pair.left_out()),
    )


def _built(run: Simulation, command: str | None, rows: int) -> Workbook:
    return read_workbook(build_sheets(run, command=command, rows=rows), "the result sheets")


def _trial_rows(trials: Sheet) -> int:
    """How many trials were to be written at most, by what the sheet says, or else by its rows."""
    said = _ONLY_FIRST.fullmatch(str(trials.cells.get((HEADER, 1), _BLANK).value))
    if said is not None:
        return int(said[1].replace(",", ""))
    last = max((row for row, column in trials.cells if column == 1), default=0)
    return max(TRIAL_ROWS, last - HEADER - 1)


@dataclass(frozen=True)
class _Pair:
    """A sheet of the run and the one in the file."""

    built: Workbook
    expected: Sheet
    sheet: Sheet
    closeness: Closeness

    def differences(self) -> Iterator[CellDifference]:
        """The cells that show something else, from the top down."""
        for place in sorted(self.expected.cells.keys() | self.sheet.cells.keys()):
            if self._is_compared(place) and not self._same(place):
                yield CellDifference(Cell(self.sheet.name, *place), self._says(place), self._expected(place).value)

    def left_out(self) -> Iterator[str]:
        """The lines in which a person has typed a range of their own."""
        for row in sorted(self._own_rows):
            where = Cell(self.sheet.name, row, min(column for line, column in self._typed if line == row))
            yield f"{where} holds a range that somebody typed, as they may, and its certainty is counted by formulas"

    def _is_compared(self, place: _Place) -> bool:
        if self.expected.name == _RECORD:
            return _COMPARED_ELSEWHERE.match(self._keys.get(place[0], "")) is None
        return place not in self._typed

    def _same(self, place: _Place) -> bool:
        says, gives = self._found(place), self._expected(place)
        if says.formula is not None and gives.formula is None:
            return False
        if says.formula is not None and gives.formula is not None and says.value is None:
            # A program that does not compute has saved it: what it will show is known by the formula alone.
            return _bare(says.formula.text) == _bare(gives.formula.text)
        scale = self._scale(place[0]) if self.closeness.elsewhere else 0.0
        return self.closeness.equal(says.value, gives.value, scale, computed=says.formula is not None)

    def _says(self, place: _Place) -> CellValue:
        content = self._found(place)
        shows_formula = content.formula is not None and (content.value is None or self._expected(place).formula is None)
        return f"={content.formula.text}" if shows_formula and content.formula is not None else content.value

    @cached_property
    def _keys(self) -> dict[int, str]:
        """Row of the Record -> its key; the section's where the row has none, as the headings of a table."""
        found, section = {}, ""
        for row in range(1, max((row for row, _ in {**self.expected.cells, **self.sheet.cells}), default=0) + 1):
            key = self._expected((row, 1)).value
            section = key if isinstance(key, str) and key.isalpha() else section
            found[row] = key if isinstance(key, str) else section
        return found

    def _scale(self, row: int) -> float:
        return self._scales.get(row, 0.0)

    @cached_property
    def _scales(self) -> dict[int, float]:
        """Row -> its largest number."""
        found: dict[int, float] = {}
        for (row, _), content in self.expected.cells.items():
            if is_number(content.value):
                found[row] = max(found.get(row, 0.0), abs(content.value))
        return found

    @cached_property
    def _typed(self) -> frozenset[_Place]:
        """The cells that a person may fill in: the formulas beside them read them."""
        found = set()
        for (row, column), content in self.expected.cells.items():
            if content.formula is not None:
                host = Cell(self.expected.name, row, column)
                areas = mentioned(content.formula, host, self.built)
                found |= {cell[1:] for area in areas if area.sheet == self.expected.name for cell in area.cells()}
        return frozenset(
            place for place in found if place in self.expected.cells and self.expected.cells[place].formula is None
        )

    @cached_property
    def _own_rows(self) -> frozenset[int]:
        """The rows of those that are filled in otherwise."""
        return frozenset(
            place[0]
            for place in self._typed
            if not self.closeness.equal(self._found(place).value, self.expected.cells[place].value)
        )

    def _expected(self, place: _Place) -> CellContent:
        return self._counted.get(place) or self.expected.cells.get(place, _BLANK)

    @cached_property
    def _counted(self) -> dict[_Place, CellContent]:
        """The formulas of the rows that are filled in otherwise, with what they give then."""
        found = {place: self.sheet.cells.get(place, _BLANK) for place in self._typed}
        return counted(self.built, self.expected, found, self._own_rows) if self._own_rows else {}

    def _found(self, place: _Place) -> CellContent:
        return self.sheet.cells.get(place, _BLANK)


def _bare(formula: str) -> str:
    """A formula without what programs write each in their own way: spaces, quotes, the names of sheets."""
    return re.sub(r"(?:'[^']*'|[\w.]+)!|\s+", "", formula).upper()
