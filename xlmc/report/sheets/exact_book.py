"""The result workbook while it is built: XlsxWriter's own, with exact numbers, as parts instead of a file.

XlsxWriter writes 16 digits of a number, and a double needs up to 17 to be read back as the same double. It packs a
file, too, which would only be unpacked again. And it writes every cell as if it might be of any kind; most are plain
numbers and texts with a style. What is overridden here are methods of its inside, so tests hold each of them against
what XlsxWriter writes by itself.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

from xlsxwriter import Workbook
from xlsxwriter.format import Format
from xlsxwriter.packager import Packager
from xlsxwriter.utility import xl_col_to_name
from xlsxwriter.worksheet import CellNumberTuple, CellStringTuple, Worksheet

__all__ = ["ExactBook", "ExactSheet"]


class ExactSheet(Worksheet):  # type: ignore[misc]  # the library has no types
    """A worksheet whose numbers are read back as the same numbers, so that a trial can be repeated to the last bit."""

    def __init__(self) -> None:
        super().__init__()
        self._letters: dict[int, str] = {}

    def write_numbers(self, row: int, column: int, values: Sequence[float], style: Format) -> None:
        """Write finite numbers one below the other: what `write_number` does for each, in less time."""
        for end in (row, row + len(values) - 1):
            if self._check_dimensions(end, column):
                raise ValueError(f"a sheet has no row {end + 1} or no column {column + 1}")
        table = self.table
        for at, value in enumerate(values, row):
            table[at][column] = CellNumberTuple(value, style)

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

    def _calculate_spans(self) -> None:
        """The first and last column of every 16 rows; result sheets have no comments, which would count, too."""
        found: dict[int, tuple[int, int]] = {}
        for row, cells in self.table.items():
            if cells:
                low, high = found.get(row // 16, (1 << 20, -1))
                found[row // 16] = min(low, min(cells)), max(high, max(cells))
        self.row_spans = {group: f"{low + 1}:{high + 1}" for group, (low, high) in found.items()}


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

    def _get_packager(self) -> Packager:
        return self._packager


class _PartsAlone(Packager):  # type: ignore[misc]  # the library has no types
    """Keeps the parts, and leaves none to be packed."""

    def __init__(self) -> None:
        super().__init__()
        self.parts: dict[str, bytes] = {}

    def _create_package(self) -> list[Any]:
        for written, name, is_binary in super()._create_package():
            self.parts[name] = written.getvalue() if is_binary else written.getvalue().encode()
        return []
