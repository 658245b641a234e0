"""Compare the result sheets of a workbook with those that the repeated run writes, cell by cell.

The run's sheets are built again in memory, and read in the same way as those of the file. A sheet of the file is found
by xlmc's mark and its name, or by what it holds.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Final

from xlmc.engine.graph.lowering import Lowering
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, build_graph
from xlmc.excel.formula.precedents import mentioned
from xlmc.excel.workbook.inject import marked_names
from xlmc.excel.workbook.injection.content_types import roles
from xlmc.excel.workbook.lazy_sheets import LazySheets
from xlmc.excel.workbook.number_formats import NumberFormat, number_formats
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.workbook import CellContent, CellValue
from xlmc.excel.workbook.writer import package_bytes
from xlmc.outputs.replay.changes import Closeness, is_number
from xlmc.outputs.sheets.book import build_sheets
from xlmc.outputs.sheets.trials_sheet import HEADER, TRIAL_ROWS

if TYPE_CHECKING:
    from xlmc.excel.workbook.workbook import Sheet, Workbook
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["CellDifference", "SheetComparison", "compare_sheets"]

_RECORD: Final = "Record"
_COMPARED_ELSEWHERE: Final = re.compile(
    r"(file\.\w*sha256|run\.fingerprint|run\.format|software|processor|structure|cells)\b"
)
"""Keys of the Record that say something of the file or of the machine; `xlmc.outputs.replay.changes` compares them."""

_MACHINE: Final = re.compile(r"(software|processor)\b")

_ONLY_FIRST: Final = re.compile(r"Only the first ([\d,]+) of [\d,]+ accepted trials stand here\.")
_BLANK: Final = CellContent()
_RowColumn = tuple[int, int]
_NUMBERED: Final = re.compile(r" \(\d+\)$")
_SAMPLE: Final = 400
"""Cells of a sheet that are looked at to find it again."""

_ENOUGH: Final = 0.5
"""The share of them that must be the same on a sheet of another name."""

_REWRITTEN: Final = Closeness(rewritten=True)


@dataclass(frozen=True, slots=True)
class CellDifference:
    """A cell that does not show what the repeated run gives.

    Attributes:
        says: what the file holds; the formula, with `=`, where it holds one that is not the run's.
        gives: what the run gives; None if it leaves the cell blank.
    """

    where: Cell
    says: CellValue
    gives: CellValue


@dataclass(frozen=True, slots=True)
class SheetComparison:
    """What a file shows of its run, compared with what the repeated run gives.

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


def compare_sheets(workbook: Workbook, run: RunResult, command: str | None, closeness: Closeness) -> SheetComparison:
    """Compare all result sheets of a file.

    Args:
        workbook: the file.
        run: the repeated run, with the name, the settings and the ending of the recorded one.
        command: what the person typed, as recorded.
        closeness: how far numbers may be apart.
    """
    built = _build(run, command, TRIAL_ROWS)
    quick = _compare_short(workbook, built, closeness)
    if quick is not None:
        return quick
    result = _match_sheets(workbook, built)
    rows = _trial_rows(result["Trials"]) if "Trials" in result else TRIAL_ROWS
    if rows != TRIAL_ROWS:
        built = _build(run, command, rows)
    return _compared(workbook, built, result, closeness)


def _compared(
    workbook: Workbook, built: Workbook, result: Mapping[str, Sheet], closeness: Closeness
) -> SheetComparison:
    pairs = [
        _Pair(built, workbook, built.sheets[name], result[name], closeness) for name in built.sheets if name in result
    ]
    return SheetComparison(
        sheets=tuple(pair.sheet.name for pair in pairs),
        differences=tuple(difference for pair in pairs for difference in pair.differences()),
        missing=tuple(name for name in built.sheets if name not in result),
        left_out=tuple(sentence for pair in pairs for sentence in pair.left_out()),
    )


def _compare_short(workbook: Workbook, built: Workbook, closeness: Closeness) -> SheetComparison | None:
    """Compare the sheets without the rows that both files write in the same words; None where anything differs.

    Nearly all rows are such, of numbers alone, and parsing hundreds of thousands of cells takes seconds. Where a
    difference is found, or a range that a person typed, whose certainty all trials tell, all rows are compared.
    """
    marked = _marked(workbook, built)
    if set(marked) != set(built.sheets) or not isinstance(workbook.sheets, LazySheets):
        return None
    assert isinstance(built.sheets, LazySheets)
    parts_built, parts_file = dict(built.parts), dict(workbook.parts)
    for name, own in marked.items():
        here, there = built.sheets.part(name), workbook.sheets.part(own)
        parts_built[here], parts_file[there] = _without_common_rows(built.parts[here], workbook.parts[there])
    short_built = replace(built, parts=parts_built, sheets=built.sheets.with_parts(parts_built))
    short_file = replace(workbook, parts=parts_file, sheets=workbook.sheets.with_parts(parts_file))
    sheets = {name: short_file.sheets[own] for name, own in marked.items()}
    comparison = _compared(short_file, short_built, sheets, closeness)
    return comparison if comparison.same and not comparison.left_out else None


_ROW: Final = re.compile(rb"<row [^>]*[^/]>.*?</row>", re.DOTALL)
_STYLE: Final = re.compile(rb' s="(\d+)"')
_NOT_NUMBERS_ALONE: Final = re.compile(rb' t="|<f|<!|<\?|<is|<row .*<row ', re.DOTALL)


def _without_common_rows(first: bytes, second: bytes) -> tuple[bytes, bytes]:
    """Take the rows of plain numbers out of two worksheets that both hold, but for the numbers of their styles.

    The first row of each combination of styles stays, so that what these show can be compared. Worksheets that hold
    anything but rows among their cells stay as they are.
    """
    rows = _rows_by_text(first), _rows_by_text(second)
    if not all(rows):
        return first, second
    seen: set[tuple[tuple[bytes, ...], tuple[bytes, ...]]] = set()
    common = set()
    for text in rows[0].keys() & rows[1].keys():
        styles = rows[0][text], rows[1][text]
        if styles in seen:
            common.add(text)
        seen.add(styles)
    return _without(first, common), _without(second, common)


def _rows_by_text(xml: bytes) -> dict[bytes, tuple[bytes, ...]]:
    """Return the rows of numbers alone, without the numbers of their styles -> these; none of a worksheet that holds
    anything else there.
    """
    before, start, rest = xml.partition(b"<sheetData>")
    cells, end, after = rest.partition(b"</sheetData>")
    if not (start and end) or b"<!" in xml or _ROW.sub(b"", cells).strip():
        return {}
    if b"<row" in before or b"<row" in after:
        return {}
    rows = [row for row in _ROW.findall(cells) if not _NOT_NUMBERS_ALONE.search(row)]
    return {_STYLE.sub(b"", row): tuple(_STYLE.findall(row)) for row in rows}


def _without(xml: bytes, rows: Collection[bytes]) -> bytes:
    return _ROW.sub(lambda match: b"" if _STYLE.sub(b"", match[0]) in rows else match[0], xml)


def _build(run: RunResult, command: str | None, rows: int) -> Workbook:
    return read_workbook(package_bytes(build_sheets(run, command=command, rows=rows)), "the result sheets")


def _trial_rows(trials: Sheet) -> int:
    """Return the most trials that were to be written, as the sheet says, or else as its rows show."""
    sentence = _ONLY_FIRST.fullmatch(str(trials.cells.get((HEADER, 1), _BLANK).value))
    if sentence is not None:
        return int(sentence[1].replace(",", ""))
    last = max((row for row, column in trials.cells if column == 1), default=0)
    return max(TRIAL_ROWS, last - HEADER - 1)


@dataclass(frozen=True)
class _Pair:
    """A sheet of the run and the one in the file."""

    built: Workbook
    file: Workbook
    expected: Sheet
    sheet: Sheet
    closeness: Closeness

    def differences(self) -> Iterator[CellDifference]:
        """Return the cells that show something else, from the top down."""
        last, lower = self._machine
        below = {(row - lower, column) for row, column in self.sheet.cells if row > last + lower}
        above = {at for at in self.sheet.cells if at[0] <= min(last, last + lower)}
        for at in sorted(self.expected.cells.keys() | above | below):
            where = Cell(self.sheet.name, *self._in_file(at))
            if self._is_compared(at) and not self._same(at):
                yield CellDifference(where, self._says(at), self._expected(at).value)
            elif is_number(self._expected(at).value):
                yield from self._shown_otherwise(at, where)

    def _shown_otherwise(self, at: _RowColumn, where: Cell) -> Iterator[CellDifference]:
        """Return the difference where a number is there, and is shown with other decimals than the run's."""
        says, gives = self._formats[1].get(self._in_file(at)), self._formats[0].get(at)
        if says is not None and gives is not None and says != gives and not self._shows_all(at, says, gives):
            yield CellDifference(where, f"shown {says}", f"shown {gives}")

    def _shows_all(self, at: _RowColumn, says: NumberFormat, gives: NumberFormat) -> bool:
        """Report whether a number is shown to its last digit, where the run leaves its decimals to the program.

        A base case of 16 digits has a fixed number of decimals, and none where another program has saved 15 of them.
        """
        number = self._expected(at).value
        if gives.decimals is not None or says.decimals is None or says.exponent or not is_number(number):
            return False
        return number == round(number, says.decimals + 2 * says.percent)

    @cached_property
    def _formats(self) -> tuple[Mapping[_RowColumn, NumberFormat], Mapping[_RowColumn, NumberFormat]]:
        """The number formats of the run's sheet, and of the one in the file."""
        pairs = ((self.built, self.expected), (self.file, self.sheet))
        first, second = (number_formats(book.parts, roles(book.parts).workbook, sheet.part) for book, sheet in pairs)
        return first, second

    def left_out(self) -> Iterator[str]:
        """Return the rows in which a person has typed a range of their own."""
        for row in sorted(self._own_rows):
            where = Cell(self.sheet.name, row, min(column for line, column in self._fillable if line == row))
            yield f"{where} holds a range that a person typed, as people may; formulas count its certainty"

    def _is_compared(self, at: _RowColumn) -> bool:
        if self.expected.name == _RECORD:
            return _COMPARED_ELSEWHERE.match(self._keys.get(at[0], "")) is None
        return at not in self._fillable

    def _same(self, at: _RowColumn) -> bool:
        says, gives = self._content(at), self._expected(at)
        if says.formula is not None and gives.formula is None:
            # LibreOffice saves the logical values TRUE and FALSE as formulas.
            return isinstance(gives.value, bool) and _bare(says.formula.text) == f"{gives.value}()".upper()
        if says.formula is not None and gives.formula is not None and says.value is None:
            # A program that does not compute has saved it: what it will show is known by the formula alone.
            return _bare(says.formula.text) == _bare(gives.formula.text)
        scale = self._scale(at[0]) if self.closeness.elsewhere else 0.0
        return self.closeness.equal(says.value, gives.value, scale, computed=says.formula is not None)

    def _says(self, at: _RowColumn) -> CellValue:
        content = self._content(at)
        shows_formula = content.formula is not None and (content.value is None or self._expected(at).formula is None)
        return f"={content.formula.text}" if shows_formula and content.formula is not None else content.value

    @cached_property
    def _machine(self) -> tuple[int, int]:
        """The last row on the Record that tells of software and processor, and how many rows lower it is in the file.

        Another machine may have more to tell, or less, and what stands below moves with it. Both are 0 elsewhere.
        """
        if self.expected.name != _RECORD:
            return 0, 0
        ends = [
            max(
                (
                    row
                    for (row, column), shown in sheet.cells.items()
                    if column == 1 and _MACHINE.match(str(shown.value))
                ),
                default=0,
            )
            for sheet in (self.expected, self.sheet)
        ]
        return ends[0], ends[1] - ends[0]

    def _in_file(self, at: _RowColumn) -> _RowColumn:
        """Where in the file stands what the run writes there."""
        last, lower = self._machine
        return (at[0] + lower, at[1]) if at[0] > last else at

    @cached_property
    def _keys(self) -> dict[int, str]:
        """Row of the Record -> its key, or its section's key where the row has none, as the headings of a table."""
        result, section = {}, ""
        for row in range(1, max((row for row, _ in {**self.expected.cells, **self.sheet.cells}), default=0) + 1):
            key = self._expected((row, 1)).value
            section = key if isinstance(key, str) and key.isalpha() else section
            result[row] = key if isinstance(key, str) else section
        return result

    def _scale(self, row: int) -> float:
        return self._scales.get(row, 0.0)

    @cached_property
    def _scales(self) -> dict[int, float]:
        """Row -> its largest number."""
        result: dict[int, float] = {}
        for (row, _), content in self.expected.cells.items():
            if is_number(content.value):
                result[row] = max(result.get(row, 0.0), abs(content.value))
        return result

    @cached_property
    def _fillable(self) -> frozenset[_RowColumn]:
        """The cells that a person may fill in: the formulas beside them read them."""
        result = set()
        for (row, column), content in self.expected.cells.items():
            if content.formula is not None:
                host = Cell(self.expected.name, row, column)
                areas = mentioned(content.formula, host, self.built)
                result |= {cell[1:] for area in areas if area.sheet == self.expected.name for cell in area.cells()}
        return frozenset(at for at in result if at in self.expected.cells and self.expected.cells[at].formula is None)

    @cached_property
    def _own_rows(self) -> frozenset[int]:
        """The rows in which such a cell holds something else than the run gives."""
        return frozenset(
            at[0]
            for at in self._fillable
            if not self.closeness.equal(self._content(at).value, self.expected.cells[at].value)
        )

    def _expected(self, at: _RowColumn) -> CellContent:
        return self._recomputed.get(at) or self.expected.cells.get(at, _BLANK)

    @cached_property
    def _recomputed(self) -> dict[_RowColumn, CellContent]:
        """The formulas of these rows, with what they give then."""
        result = {at: self.sheet.cells.get(at, _BLANK) for at in self._fillable}
        return _count_formulas(self.built, self.expected, result, self._own_rows) if self._own_rows else {}

    def _content(self, at: _RowColumn) -> CellContent:
        return self.sheet.cells.get(self._in_file(at), _BLANK)


def _bare(formula: str) -> str:
    """Write a formula without what each program writes in its own way: spaces, quotes, the names of sheets."""
    return re.sub(r"(?:'[^']*'|[\w.]+)!|\s+", "", formula).upper()


def _match_sheets(workbook: Workbook, built: Workbook) -> dict[str, Sheet]:
    """Return the sheets of a file that are those the run writes, by the names that the run gives them.

    Args:
        workbook: the file.
        built: the result sheets of the run, and nothing else.
    """
    result = _by_mark(workbook, built)
    for name in built.sheets:
        if name not in result:
            taken = {sheet.name for sheet in result.values()}
            likest = _likest(built.sheets[name], workbook, taken)
            if likest is not None:
                result[name] = likest
    return result


def _by_mark(workbook: Workbook, built: Workbook) -> dict[str, Sheet]:
    """Return the sheets with a mark; `Results (2)` is Results in a workbook that had a sheet of that name already."""
    return {name: workbook.sheets[own] for name, own in _marked(workbook, built).items()}


def _marked(workbook: Workbook, built: Workbook) -> dict[str, str]:
    """Return the names in the file of the sheets with a mark, by the names that the run gives them."""
    marked = [name for name in marked_names(workbook.names) if name in workbook.sheets]
    names = {name if name in built.sheets else _NUMBERED.sub("", name): name for name in marked}
    return {name: names[name] for name in built.sheets if name in names}


def _likest(expected: Sheet, workbook: Workbook, taken: Collection[str]) -> Sheet | None:
    """Return the sheet that shares most cells with the expected one; a sheet of the same name may share fewer than
    half.
    """
    shares = {name: _share(expected, workbook.sheets[name]) for name in workbook.sheets if name not in taken}
    best = max(shares, key=lambda name: (shares[name], name == expected.name), default=None)
    if best is not None and shares[best] > _ENOUGH:
        return workbook.sheets[best]
    return workbook.sheets[expected.name] if shares.get(expected.name, 0.0) > 0.0 else None


def _share(expected: Sheet, sheet: Sheet) -> float:
    """Return the share of the expected sheet's cells, some hundreds of them, that another sheet holds where
    they stand.
    """
    filled = [at for at, content in expected.cells.items() if content.value is not None]
    filled = filled[:: max(1, len(filled) // _SAMPLE)]
    same = sum(at in sheet.cells and _REWRITTEN.equal(sheet.cells[at].value, expected.cells[at].value) for at in filled)
    return same / len(filled) if filled else 0.0


def _count_formulas(
    built: Workbook, sheet: Sheet, typed: Mapping[_RowColumn, CellContent], rows: Collection[int]
) -> dict[_RowColumn, CellContent]:
    """Compute the formulas of these rows anew.

    Args:
        built: the result sheets of the run.
        sheet: the one among them with the formulas.
        typed: what the file holds in the cells that a person may fill in.
        rows: that are looked at.
    """
    filled = replace(sheet, cells={**sheet.cells, **typed})
    workbook = replace(built, sheets={**built.sheets, sheet.name: filled})
    formulas_at = [at for at, content in sheet.cells.items() if content.formula is not None and at[0] in rows]
    cells = {at: Cell(sheet.name, *at) for at in formulas_at}
    lowering = Lowering(build_graph(Resolver(workbook), [*cells.values()], frozenset()), {}, {})
    result = {}
    for at, cell in cells.items():
        value = lowering.value(cell)
        assert value is not None  # nothing that it reads is drawn
        result[at] = replace(sheet.cells[at], value=value.objects().ravel()[0])
    return result
