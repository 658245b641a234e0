"""The record's account of what a run needed of its workbook: contents of cells, names, tables, hidden rows.

Contents are kept as texts, to be compared.

Each cell has a row. Where cells are very many, they are packed instead: JSON (cell -> content), deflated, in base64,
cut into pieces that fit into a cell of a worksheet.
"""

from __future__ import annotations

import base64
import binascii
import hashlib
import json
import re
import zlib
from collections.abc import Collection, Container, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.record.record_parts import EDITED, Entry, Record, RecordTable, Section
from xlmc.analysis.results.statements.in_words import plain_text
from xlmc.errors import ErrorCode, WorkbookError
from xlmc.excel.address import Area, Cell, host_of, parse_address, quote_sheet
from xlmc.excel.formula.shape import text_at
from xlmc.excel.workbook.workbook import CellValue, Formula
from xlmc.montecarlo.definitions.tables.reserved_tables import KINDS
from xlmc.montecarlo.distributions.spelling import name_key

if TYPE_CHECKING:
    from xlmc.excel.workbook.workbook import DataTable, DefinedName, Table, Workbook
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = [
    "MOST_ROWS",
    "SAVED",
    "TABULATED",
    "cell_section",
    "content_text",
    "definition_cells",
    "needed_contents",
    "recorded_cells",
    "structure_section",
]

SAVED: Final = "  (Excel saved "
"""What stands between the formula of a cell that xlmc cannot compute and the value that was used for it."""

TABULATED: Final = "{=TABLE("
"""What the content of a cell of a data table begins with that a run computes."""

MOST_ROWS: Final = 1_000
"""Cells that are listed one a row."""

_PIECE: Final = 30_000
_LONGEST: Final = 32_000
_MOST_BYTES: Final = 256 << 20
"""Bytes of the contents unpacked: xlmc writes no record with more."""

_COLUMNS: Final[tuple[tuple[str, str], ...]] = (("cell", "Cell"), ("content", "Content"))

_WORD: Final = re.compile(r"[^\W\d][\w.\\?]*")
_NOT_HIDDEN: Final = frozenset({"subtotal", "aggregate"})
"""Functions that can leave out hidden rows."""

_LONGEST_MEANING: Final = 30_000
"""Characters that a cell of the record holds."""

_STRUCTURE_COLUMNS: Final = (("name", "Name"), ("what", "Is a"), ("means", "Means"))


def needed_contents(model: CompiledModel) -> dict[Cell, str]:
    """Return the cells that a run of the model is a function of, with their contents, by sheets, rows and columns.

    These are the cells that forecasts and filters read, those of assumptions and of their data, and the reserved
    tables. Blank cells are left out.
    """
    workbook, saved, tabulated = model.workbook, model.saved, model.tabulated
    cells = {host_of(cell) for cell in model.read} | {host_of(a.cell) for a in model.assumptions}
    cells |= definition_cells(workbook)
    for assumption in model.assumptions:
        if assumption.data is not None:
            cells.update(_filled_cells(workbook, assumption.data.area))
    linked = sorted({cell.sheet for cell in cells if cell.sheet not in workbook.sheets and workbook.sheet_of(cell)})
    ranks = {name: rank for rank, name in enumerate((*workbook.sheets, *linked))}
    known = (cell for cell in cells if cell.sheet in ranks)
    result = {}
    for cell in sorted(known, key=lambda cell: (ranks[cell.sheet], cell)):
        if text := content_text(workbook, cell, saved, tabulated):
            result[cell] = text
    return result


def definition_cells(workbook: Workbook) -> set[Cell]:
    """Return the cells of the reserved tables that hold something, headings among them."""
    areas = (table.area for table in workbook.tables if table.name.casefold().startswith(KINDS))
    return {cell for area in areas for cell in _filled_cells(workbook, area)}


def content_text(workbook: Workbook, cell: Cell, saved: Container[Cell] = (), tabulated: Container[Cell] = ()) -> str:
    """Write what a cell holds as a formula would: `=A1*2`, `6661`, `"text"`, `TRUE`, `#N/A`; empty if it is blank.

    Args:
        workbook: that it stands in.
        cell: to look at.
        saved: the cells whose saved values a run uses although they hold formulas.
        tabulated: the cells of what-if data tables that a run computes: `{=TABLE(,A2)} in D2:E5`.
    """
    if cell in tabulated and (table := next((each for each in workbook.data_tables if cell in each.area), None)):
        return f"{_table_formula(table)} in {table.area.a1}"
    content = workbook.content(cell)
    if content.formula is None:
        return value_text(content.value)
    written = _formula_text(content.formula, cell)
    return f"{written}{SAVED}{value_text(content.value)})" if cell in saved else written


def _table_formula(table: DataTable) -> str:
    """Write a what-if data table as Excel shows it, with the input cell for the row above first."""
    first, second = [*(each.a1 for each in table.inputs), "#REF!", "#REF!"][:2]
    inputs = (first, second) if table.two_inputs else (first, "") if table.by_row else ("", first)
    return f"{TABULATED}{','.join(inputs)})}}"


def value_text(value: CellValue) -> str:
    """Write a value as a formula does."""
    match value:
        case None:
            return ""
        case bool():
            return "TRUE" if value else "FALSE"
        case ErrorCode():
            return value.text
        case str():
            doubled = value.replace('"', '""')
            return f'"{doubled}"'
        case _:
            return plain_text(value)


def _formula_text(formula: Formula, cell: Cell) -> str:
    if formula.array is not None and not formula.dynamic:
        return f"{{={formula.text}}} in {formula.array.a1}"
    return f"={text_at(formula.text, cell.row - formula.row, cell.column - formula.column)}"


def _filled_cells(workbook: Workbook, area: Area) -> list[Cell]:
    """Return the cells of an area that hold something."""
    sheet = workbook.sheet_of(area)
    if sheet is None:
        return []
    filled = sheet.cells.keys()
    if area.rows * area.columns > len(filled):
        return [cell for cell in (Cell(area.sheet, *address) for address in filled) if cell in area]
    return [cell for cell in area.cells() if cell[1:] in filled]


def cell_section(needed: Mapping[Cell, str], *, rows: int = MOST_ROWS) -> Section:
    """Every needed cell with its content, so that one that was changed can be named.

    Args:
        needed: the cells and their contents.
        rows: the most cells to list one a row.
    """
    sheets = {name: quote_sheet(name) for name in {cell.sheet for cell in needed}}  # once each: cells may be very many
    contents = dict(zip([f"{sheets[cell.sheet]}!{cell.a1}" for cell in needed], needed.values(), strict=True))
    packed = _json(contents)
    entries = (
        Entry("count", "Cells", len(contents)),
        Entry("sha256", "SHA-256 of their contents", hashlib.sha256(packed).hexdigest()),
    )
    listed = len(contents) <= rows and max(map(len, contents.values()), default=0) <= _LONGEST
    title = "Cells that the run needed"
    if listed:
        return Section("cells", title, entries, RecordTable(_COLUMNS, tuple(contents.items())))
    return Section("cells", title, (*entries, *_pieces(packed)))


def recorded_cells(record: Record) -> dict[Cell, str]:
    """Return the cells of a record with their contents.

    Raises:
        KeyError: the record does not hold them.
        WorkbookError: what it holds of them is damaged.
    """
    count, expected = record["cells.count"], record["cells.sha256"]
    contents = {str(row["cell"]): str(row["content"]) for row in record.rows("cells")}
    if not contents:
        contents = _unpack(record)
    if len(contents) != count or hashlib.sha256(_json(contents)).hexdigest() != expected:
        raise WorkbookError(
            "the cells in the record are not those that were written there",
            hint=EDITED,
        )
    return {_cell(address): text for address, text in contents.items()}


def _json(contents: Mapping[str, str]) -> bytes:
    return json.dumps(contents, ensure_ascii=False, separators=(",", ":")).encode()


def _pieces(packed: bytes) -> Iterator[Entry]:
    text = base64.b64encode(zlib.compress(packed, 6)).decode()
    for number, start in enumerate(range(0, len(text), _PIECE), 1):
        yield Entry(f"packed_{number}", f"Packed, part {number}", text[start : start + _PIECE])


def _unpack(record: Record) -> dict[str, str]:
    pieces = [entry.value for entry in record.section("cells").entries if entry.key.startswith("packed_")]
    try:
        stream = zlib.decompressobj()
        packed = stream.decompress(base64.b64decode("".join(map(str, pieces)), validate=True), _MOST_BYTES)
        value = json.loads(packed or b"{}")
    except (binascii.Error, zlib.error, ValueError) as error:
        raise WorkbookError("the cells in the record cannot be read", hint=EDITED) from error
    return {str(address): str(text) for address, text in dict(value).items()}


def _cell(address: str) -> Cell:
    try:
        reference = parse_address(address)
    except ValueError:
        reference = None
    if not isinstance(reference, Cell):
        raise WorkbookError(f"the record names the cell {address!r}, which is not one", hint=EDITED)
    return reference


def structure_section(model: CompiledModel, contents: Collection[str]) -> Section:
    """Return the names and tables that the needed cells mention, and the hidden rows where a function asks for them.

    Args:
        model: that was run.
        contents: of the needed cells.
    """
    workbook = model.workbook
    words = _words(contents) | {name_key(a.name) for a in model.assumptions}
    words |= {name_key(f.name) for f in model.forecasts} | {name_key(f.name) for f in model.filters}
    words |= {name_key(check.name) for check in model.checks}
    names = sorted(_find_mentioned(workbook.names, words), key=_order)
    words |= _words([name.text for name in names])
    rows = [(f"{name.sheet}!{name.name}" if name.sheet else name.name, "defined name", name.text) for name in names]
    tables = (t for t in workbook.tables if t.name.casefold().startswith(KINDS) or t.name.casefold() in words)
    rows += [(table.name, "table", _table_text(table)) for table in tables]
    if words & _NOT_HIDDEN:
        rows += [(name, "hidden rows", _ranges(workbook.sheets[name].hidden_rows)) for name in _sheets_read(model)]
    if workbook.date1904:
        rows.append(("dates", "count", "from 1904"))
    listed = tuple((name, what, means[:_LONGEST_MEANING]) for name, what, means in rows)
    return Section("structure", "Names and tables that the run needed", table=RecordTable(_STRUCTURE_COLUMNS, listed))


def _order(name: DefinedName) -> tuple[str, str]:
    return name.name.casefold(), name.sheet or ""


def _words(texts: Collection[str]) -> set[str]:
    """Return the words of cells in small letters; those of texts too, which may name a cell or be read by INDIRECT."""
    return set(_WORD.findall("\n".join(texts).casefold()))


def _find_mentioned(names: Collection[DefinedName], words: set[str]) -> Iterator[DefinedName]:
    """Return the names among the words, and those that these mention in turn."""
    waiting = {name for name in names if not name.name.casefold().startswith(("_xlnm.", "_xlmc_"))}
    while defined_names := {name for name in waiting if name.name.casefold() in words}:
        yield from defined_names
        waiting -= defined_names
        words = words | _words([name.text for name in defined_names])


def _sheets_read(model: CompiledModel) -> list[str]:
    """Return the sheets with hidden rows that a needed cell stands on."""
    read = {cell.sheet for cell in model.read}
    sheets = model.workbook.sheets  # parsed when looked up: those not read are left alone
    return [name for name in sheets if name in read and sheets[name].hidden_rows]


def _ranges(rows: Iterable[int]) -> str:
    """`{3, 4, 5, 9} -> '3-5, 9'`."""
    result: list[list[int]] = []
    for row in sorted(rows):
        if result and row == result[-1][1] + 1:
            result[-1][1] = row
        else:
            result.append([row, row])
    return ", ".join(str(first) if first == last else f"{first}-{last}" for first, last in result)


def _table_text(table: Table) -> str:
    totals = f", {table.totals_rows} rows of totals" * bool(table.totals_rows)
    headings = f", {table.header_rows} rows of headings" * (table.header_rows != 1)
    return f"{table.area}{headings}{totals}: {'; '.join(table.columns)}"
