"""The result workbook while it is built: XlsxWriter's own, with exact numbers, as parts instead of a file.

XlsxWriter writes 16 digits of a number, and a double needs up to 17 to be read back as the same double. It packs a
file, too, which would only be unpacked again. And it writes every cell as if it might be of any kind; most are plain
numbers and texts with a style. Columns of numbers are therefore kept as arrays, and a row of them is written as one
string. What is overridden here are methods of its inside, so tests hold each of them against what XlsxWriter writes by
itself.
"""

from __future__ import annotations

import io
from array import array
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, pairwise
from types import MethodType
from typing import Any

from xlsxwriter import Workbook
from xlsxwriter.chart import Chart
from xlsxwriter.format import Format
from xlsxwriter.packager import Packager
from xlsxwriter.utility import xl_col_to_name
from xlsxwriter.worksheet import CellNumberTuple, CellStringTuple, Worksheet

__all__ = ["ExactBook", "ExactSheet"]


@dataclass(frozen=True, slots=True)
class _Run:
    """Numbers one below the other in a column, from a row on; both are counted from 0."""

    row: int
    column: int
    numbers: array[float]
    style: Format

    @property
    def end(self) -> int:
        """The row behind the last number."""
        return self.row + len(self.numbers)

    def cells(self, start: int, end: int) -> array[float]:
        """Return the numbers of the rows from `start` up to `end`, which is left out."""
        return self.numbers[start - self.row : end - self.row]


@dataclass(frozen=True, slots=True)
class _Band:
    """Rows from `start` to before `end` that the same runs cross: by their column, from left to right."""

    start: int
    end: int
    runs: dict[int, _Run]


class ExactSheet(Worksheet):  # type: ignore[misc]  # the library has no types
    """A worksheet whose numbers are read back as the same numbers, so that a trial can be repeated to the last bit."""

    table: dict[int, dict[int, Any]]
    row_spans: dict[int, str]
    fh: io.StringIO

    def __init__(self) -> None:
        super().__init__()
        self._letters: dict[int, str] = {}
        self._runs: list[_Run] = []
        self._in_column: defaultdict[int, list[_Run]] = defaultdict(list)
        self._openings: dict[tuple[Any, ...], str] = {}

    def write_numbers(self, row: int, column: int, values: Sequence[float], style: Format) -> None:
        """Write finite numbers one below the other: what `write_number` does for each, in less time.

        Raises:
            ValueError: the sheet has no room for them.
        """
        run = _Run(row, column, array("d", values), style)
        for end in (row, run.end - 1):
            if self._check_dimensions(end, column):
                raise ValueError(f"a sheet has no row {end + 1} or no column {column + 1}")
        for at in [at for at in self.table if row <= at < run.end]:  # cells win over runs: these were there before
            self.table[at].pop(column, None)
        self._runs.append(run)
        self._in_column[column].append(run)

    def _bands(self) -> list[_Band]:
        """Return the rows of runs, cut where one begins or ends; where runs overlap, the later one counts."""
        cuts = sorted({edge for run in self._runs for edge in (run.row, run.end)})
        bands = []
        for start, end in pairwise(cuts):
            runs = {run.column: run for run in self._runs if run.row <= start < run.end}
            if runs:
                bands.append(_Band(start, end, dict(sorted(runs.items()))))
        return bands

    def _write_rows(self) -> None:
        """Write the rows from the top down; result sheets have no comments, which would make rows, too."""
        bands, row = self._bands(), self.dim_rowmin
        self._find_spans(bands)
        for band in bands:
            self._write_rows_of_cells(row, band.start)
            self._write_band(band)
            row = band.end
        self._write_rows_of_cells(row, self.dim_rowmax + 1)

    def _write_rows_of_cells(self, start: int, end: int) -> None:
        for row in range(start, end):
            if cells := self.table.get(row):
                self._write_cells(row, cells)
            elif row in self.row_info:
                self._write_empty_row(row, self.row_spans.get(row // 16), self.row_info[row])

    def _write_cells(self, row: int, cells: dict[int, Any]) -> None:
        self.fh.write(self._opening(row))
        for column in sorted(cells):
            self._write_cell(row, column, cells[column])
        self.fh.write("</row>")

    def _write_band(self, band: _Band) -> None:
        """Write rows of numbers, each in one piece, but cell by cell where other cells stand among them."""
        numbers = zip(*[run.cells(band.start, band.end) for run in band.runs.values()], strict=True)
        row_of_cells = "".join(
            f'<c r="{xl_col_to_name(column)}#" s="{run.style._get_xf_index()}"><v>%r</v></c>'
            for column, run in band.runs.items()
        )
        for row, line in enumerate(numbers, band.start):
            if others := self.table.get(row):
                runs = zip(band.runs.items(), line, strict=True)
                self._write_cells(row, {c: CellNumberTuple(number, run.style) for (c, run), number in runs} | others)
                continue
            written = (row_of_cells.replace("#", str(row + 1)) % line).replace(".0</v>", "</v>")
            self.fh.write(f"{self._opening(row)}{written}</row>")

    def _opening(self, row: int) -> str:
        """Return the tag that begins a row; XlsxWriter writes it once for rows that differ in their number alone."""
        span, info = self.row_spans.get(row // 16), self.row_info.get(row)
        key = (span, info and (info.height, info.row_format, info.hidden, info.level, info.collapsed))
        behind = self._openings.get(key)
        if behind is None:
            whole, self.fh = self.fh, io.StringIO()
            try:
                self._write_row(0, span, info)
                behind = self._openings[key] = self.fh.getvalue().removeprefix('<row r="1"')
            finally:
                self.fh = whole
        return f'<row r="{row + 1}"{behind}'

    def _get_range_data(self, row_start: int, col_start: int, row_end: int, col_end: int) -> Any:
        """Return the cells that a chart shows, those of runs among them."""
        whole = self.table
        try:
            self.table = self._with_runs(row_start, col_start, row_end, col_end)
            return super()._get_range_data(row_start, col_start, row_end, col_end)
        finally:
            self.table = whole

    def _with_runs(self, top: int, left: int, bottom: int, right: int) -> dict[int, dict[int, Any]]:
        """Return the cells of these rows and columns; of wide sheets, charts read few."""
        result: dict[int, dict[int, Any]] = {}
        for run in chain.from_iterable(self._in_column.get(column, ()) for column in range(left, right + 1)):
            start, end = max(top, run.row), min(bottom + 1, run.end)
            for row, number in enumerate(run.cells(start, end) if start < end else (), start):
                result.setdefault(row, {})[run.column] = CellNumberTuple(number, run.style)
        for row in range(top, bottom + 1):
            if (cells := self.table.get(row)) is not None:
                own = {column: cells[column] for column in range(left, right + 1) if column in cells}
                result[row] = result.get(row, {}) | own
        return result

    def _write_cell(self, row: int, col: int, cell: Any) -> None:
        kind = type(cell)
        if cell.format is None or (kind is not CellNumberTuple and kind is not CellStringTuple):
            super()._write_cell(row, col, cell)
            return
        letters = self._letters.get(col)
        if letters is None:
            letters = self._letters[col] = xl_col_to_name(col)
        start = f'<c r="{letters}{row + 1}" s="{cell.format._get_xf_index()}"'
        if kind is CellNumberTuple:
            self.fh.write(f"{start}><v>{repr(float(cell.number)).removesuffix('.0')}</v></c>")
        else:
            self.fh.write(f'{start} t="s"><v>{cell.string}</v></c>')

    def _xml_number_element(self, number: float, attributes: Sequence[tuple[str, str]] = ()) -> None:
        written = "".join([f' {key}="{value}"' for key, value in attributes])  # reference, style: nothing to escape
        self.fh.write(f"<c{written}><v>{repr(float(number)).removesuffix('.0')}</v></c>")

    def _find_spans(self, bands: Sequence[_Band]) -> None:
        """Find the first and last column of every 16 rows; result sheets have no comments, which would count, too."""
        result: dict[int, tuple[int, int]] = {}

        def add(group: int, first: int, last: int) -> None:
            low, high = result.get(group, (first, last))
            result[group] = min(low, first), max(high, last)

        for row, cells in self.table.items():
            if cells:
                add(row // 16, min(cells), max(cells))
        for band in bands:
            first, last = min(band.runs), max(band.runs)
            for group in range(band.start // 16, (band.end - 1) // 16 + 1):
                add(group, first, last)
        self.row_spans = {group: f"{low + 1}:{high + 1}" for group, (low, high) in result.items()}


class ExactBook(Workbook):  # type: ignore[misc]  # the library has no types
    """A workbook in memory, of `ExactSheet`s; when it is closed, `parts` are what its file would hold."""

    def __init__(self) -> None:
        super().__init__(io.BytesIO(), {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False})
        self.worksheet_class = ExactSheet
        self._packager = _PartsAlone()

    @property
    def parts(self) -> dict[str, bytes]:
        """Name -> content, in the order of a file."""
        return self._packager.parts

    def add_chart(self, options: dict[str, Any]) -> Any:
        """Add a chart that writes its stored numbers in one piece."""
        chart = super().add_chart(options)
        chart._write_num_cache = MethodType(_write_kept_numbers, chart)
        return chart

    def _get_packager(self) -> Packager:
        return self._packager


def _write_kept_numbers(chart: Any, data: Sequence[Any]) -> None:
    """Write what a chart shows until a program reads its cells: what XlsxWriter writes, where all of it is numbers."""
    kept, points = list(data or ()), []
    try:
        for index, number in enumerate(kept):
            if number is not None:
                float(number)  # so that a text that is none is found
                points.append(f'<c:pt idx="{index}"><c:v>{number}</c:v></c:pt>')
    except ValueError:
        Chart._write_num_cache(chart, data)
        return
    head = f'<c:numCache><c:formatCode>General</c:formatCode><c:ptCount val="{len(kept)}"/>'
    chart.fh.write(f"{head}{''.join(points)}</c:numCache>")


class _PartsAlone(Packager):  # type: ignore[misc]  # the library has no types
    """Keeps the parts, and leaves none to be packed."""

    def __init__(self) -> None:
        super().__init__()
        self.parts: dict[str, bytes] = {}

    def _create_package(self) -> list[Any]:
        for written, name, is_binary in super()._create_package():
            self.parts[name] = written.getvalue() if is_binary else written.getvalue().encode()
        return []
