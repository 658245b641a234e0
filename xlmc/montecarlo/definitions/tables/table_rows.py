"""The rows of a reserved table, and what their cells mean: a text, a number, a parameter, a yes or no.

Each reader of a cell raises a `DefinitionError` that names the cell and says what to do.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NoReturn, Protocol

from xlmc.errors import DefinitionError, ErrorCode
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import CellContent, Workbook
from xlmc.montecarlo.definitions.definitions import Parameter
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.stating import Named, named
from xlmc.montecarlo.definitions.tables.reserved_tables import NEAR_MISS, DefinitionTable, as_text
from xlmc.montecarlo.distributions.spelling import name_key, nearest, plain
from xlmc.montecarlo.number_text import count_text, number_text

__all__ = [
    "Row",
    "as_text",
    "central_share",
    "holds_rows",
    "is_used",
    "logical",
    "logical_in",
    "named_rows",
    "number",
    "number_in",
    "optional_text",
    "parameter",
    "required_text",
    "rows_of",
    "static_value",
    "word_in",
]

_MISSPELT = 0.85  # likeness above which a heading is taken for one that the table lacks

_REMARKS = frozenset({"units", "source", "because"})
"""Columns that are only shown: a slip in their heading changes no number."""

_MOST_NAMED: Final = 4
"""Rows that one notice names."""

_DECIMAL_COMMA: Final = re.compile(r"[+-]?\d+,(?:\d{1,2}|\d{4,})")
"""A text that is a number to those who write commas for points; `1,234` has thousands."""

_WORDS = {"true": True, "yes": True, "on": True, "false": False, "no": False, "off": False}


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a reserved table; columns go by any spelling of their heading."""

    workbook: Workbook
    table: DefinitionTable
    number: int

    def has(self, heading: str) -> bool:
        """Whether the table has the column at all."""
        return plain(heading) in self.table.columns

    def filled(self, heading: str) -> bool:
        """Whether the table has the column and the row holds something in it."""
        return self.has(heading) and not self.content(heading).is_blank

    @property
    def headings(self) -> tuple[str, ...]:
        """Every heading of the table, as written."""
        return tuple(written for written, _ in self.table.columns.values())

    def heading(self, heading: str) -> str:
        """Return the heading as this table writes it."""
        return self.table.columns[plain(heading)][0]

    def cell(self, heading: str) -> Cell:
        """Return the table's own cell in that column."""
        return Cell(self.table.table.area.sheet, self.number, self.table.columns[plain(heading)][1])

    def content(self, heading: str) -> CellContent:
        """Return what the table's own cell holds; blank where the table has no such column."""
        return self.workbook.content(self.cell(heading)) if self.has(heading) else CellContent()

    @property
    def where(self) -> Cell:
        """The cell that stands for the row: its first."""
        return Cell(self.table.table.area.sheet, self.number, self.table.table.area.left)

    def notes(self, known: Iterable[str]) -> dict[str, str]:
        """Return the filled cells of the columns that nobody else reads, heading as written -> text."""
        spellings = {plain(heading) for heading in known}
        return {
            written: as_text(self.content(written).value)
            for spelling, (written, _) in self.table.columns.items()
            if spelling not in spellings and self.filled(written)
        }


def rows_of(
    workbook: Workbook,
    tables: Iterable[DefinitionTable],
    required: Iterable[str],
    known: Iterable[str],
    findings: Findings,
) -> Iterator[Row]:
    """Yield the rows of these tables that hold anything, without header and totals.

    A table that lacks a required column is a problem and gives no rows. A heading that nobody reads but that looks
    like a known one is pointed out, because its column is kept as a note only; where the table lacks the known one,
    and numbers depend on it, the heading is a problem.
    """
    required, known = tuple(required), tuple(known)
    for table in tables:
        _point_out_slips(workbook, table, known, required, findings)
        if _complete(table, required, findings):
            _point_out_row_below(workbook, table, required, findings)
            yield from _filled_rows(workbook, table)


def holds_rows(workbook: Workbook, table: DefinitionTable) -> bool:
    """Whether any row of the table holds anything."""
    return next(_filled_rows(workbook, table), None) is not None


def _complete(table: DefinitionTable, required: tuple[str, ...], findings: Findings) -> bool:
    missing = [heading for heading in required if plain(heading) not in table.columns]
    for heading in missing:
        slip = nearest(heading, (written for written, _ in table.columns.values()))
        hint = f"Rename the column {slip!r} to {heading}" if slip else f"Add a column {heading}"
        findings.problem(f"The table {table.table.name} has no column {heading}", table.where, hint)
    return not missing


def _point_out_slips(
    workbook: Workbook, table: DefinitionTable, known: tuple[str, ...], required: tuple[str, ...], findings: Findings
) -> None:
    spellings = {plain(heading) for heading in known}
    missing = [heading for heading in known if plain(heading) not in table.columns and plain(heading) not in _REMARKS]
    missing = [heading for heading in missing if heading not in required]  # `_complete` tells of these
    for spelling, (written, number) in table.columns.items():
        slip = None if spelling in spellings else nearest(written, known, NEAR_MISS)
        if slip is None:
            continue
        where = table.heading_cell(number)
        meant = nearest(written, missing, _MISSPELT)
        if meant is not None and any(row.filled(written) for row in _filled_rows(workbook, table)):
            hint = f"Rename the column {meant}; if it is a note, give it a heading that is less like {meant}"
            findings.problem(f"The column {written!r} is not read: did you mean {meant}?", where, hint)
        else:
            findings.notice(f"The column {written!r} is kept as a note only: did you mean {slip}?", where)


def _point_out_row_below(
    workbook: Workbook, table: DefinitionTable, required: Iterable[str], findings: Findings
) -> None:
    """Excel takes a row that is typed below a table into it; other programs do not, and nobody would miss the row."""
    area = table.table.area
    row = Row(workbook, table, area.bottom + 1)
    filled = sum(row.filled(written) for written in row.headings)
    taken = table.table.totals_rows or any(row.where in other.area for other in workbook.tables)
    if filled > 1 and all(map(row.filled, required)) and not taken:
        name = table.table.name
        message = f"This row is right below the table {name} and is not read: drag the table's corner over it"
        findings.notice(f"{message}, or leave a blank row above it", row.where)


def _filled_rows(workbook: Workbook, table: DefinitionTable) -> Iterator[Row]:
    body = table.table.body
    for number in range(body.top, body.bottom + 1):
        row = Row(workbook, table, number)
        if any(row.filled(written) for written, _ in table.columns.values()):
            yield row


def required_text(row: Row, heading: str) -> str:
    """Return the text of the cell, trimmed.

    Raises:
        DefinitionError: the cell is blank or holds an error.
    """
    text = optional_text(row, heading)
    if not text:
        message = f"{row.heading(heading)} is blank"
        raise DefinitionError(message, where=row.cell(heading), hint=f"Fill in {heading}, or clear the whole row")
    return text


def optional_text(row: Row, heading: str) -> str:
    """Return the text of the cell, trimmed; '' where it is blank or the table has no such column.

    Raises:
        DefinitionError: the cell holds an error, or a formula that was never calculated.
    """
    if not row.filled(heading):
        return ""
    value = row.content(heading).value
    if value is None or isinstance(value, ErrorCode):
        refuse(row.heading(heading), row.content(heading), row.cell(heading))
    return as_text(value)


def number(row: Row, heading: str) -> float | None:
    """Return the number in the cell, typed in or as Excel cached it; None if it is blank.

    Raises:
        DefinitionError: the cell holds anything else.
    """
    if not row.filled(heading):
        return None
    return number_in(row.heading(heading), row.content(heading), row.cell(heading))


def parameter(row: Row, heading: str, called: str = "") -> Parameter | None:
    """Return the number in the cell, or the cell itself where it holds a formula; None if it is blank.

    Args:
        row: with the cell.
        heading: of its column.
        called: what messages call the number; by default as the heading is written.

    Raises:
        DefinitionError: the cell holds text, a logical or an error, typed in or as Excel cached it. A formula that
            was #NAME? is no such error.
    """
    content = row.content(heading)
    if content.is_blank:
        return None
    if content.formula is not None and (content.value is None or content.value is ErrorCode.NAME):
        # Never calculated yet, or by a program that does not know a function of @RISK: each run calculates it.
        return row.cell(heading)
    value = number_in(called or row.heading(heading), content, row.cell(heading))
    return value if content.formula is None else row.cell(heading)


def static_value(given: Parameter | None, workbook: Workbook) -> float | None:
    """Return the number, or the number that Excel cached for the cell, if any."""
    if not isinstance(given, Cell):
        return given
    value = workbook.content(given).value
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool | ErrorCode) else None


def word_in(row: Row, heading: str, words: type[Named]) -> Named | None:
    """Return which of some words the cell holds; None if it is blank.

    Raises:
        DefinitionError: the cell holds another word.
    """
    text = optional_text(row, heading)
    result = named(words, text) if text else None
    if text and result is None:
        known = [each.value for each in words]
        meant = nearest(text, known)
        hint = f"Did you mean {meant}? " if meant else ""
        hint += f"Type {', '.join(known[:-1])} or {known[-1]}; a column of notes needs another heading"
        raise DefinitionError(f"{row.heading(heading)} {text!r} is unknown", where=row.cell(heading), hint=hint)
    return result


def logical(row: Row, heading: str) -> bool:
    """Read TRUE or FALSE, also as the words true, false, yes, no, on, off; blank is FALSE.

    Raises:
        DefinitionError: the cell holds anything else.
    """
    return row.filled(heading) and logical_in(row.heading(heading), row.content(heading), row.cell(heading))


def logical_in(what: str, content: CellContent, where: Cell) -> bool:
    """Read TRUE or FALSE, also as these words, of a cell that is not blank.

    Raises:
        DefinitionError: the cell holds anything else.
    """
    value = content.value
    if isinstance(value, bool):
        return value
    if value is None or isinstance(value, ErrorCode):
        refuse(what, content, where)
    word = _WORDS.get(value.strip().casefold()) if isinstance(value, str) else None
    if word is None:
        message = f"{what} holds {as_text(value)!r}, neither TRUE nor FALSE"
        raise DefinitionError(message, where=where, hint="Type TRUE or FALSE, or leave the cell blank")
    return word


def is_used(row: Row, switched: Mapping[str, bool]) -> bool:
    """Whether a row counts: its column `Use` does not switch it off, blank is on.

    Args:
        row: with a column `Name`.
        switched: rows that are used, or not, whatever their column says, by the keys of their names.

    Raises:
        DefinitionError: `Use` is neither on nor off.
    """
    own = not row.filled("Use") or logical(row, "Use")
    return switched.get(name_key(as_text(row.content("Name").value)), own)


def named_rows(rows: Sequence[_HasName]) -> str:
    """Name some rows for one message, the first few of them."""
    more = f" and {count_text(len(rows) - _MOST_NAMED)} more" if len(rows) > _MOST_NAMED else ""
    return ", ".join(repr(each.name) for each in rows[:_MOST_NAMED]) + more


class _HasName(Protocol):
    @property
    def name(self) -> str: ...


def central_share(what: str, value: float, where: Cell, findings: Findings) -> float:
    """Read a percentage above 0 and below 100 as a share.

    A number below 1 is taken for a share, as a cell in percent format holds it, with a notice.

    Args:
        what: what a person calls the number, for the message.
        value: the number.
        where: its cell.
        findings: takes the notice.

    Raises:
        DefinitionError: the number lies outside.
    """
    if not 0 < value < 100:
        message = f"{what} ({as_text(value)}) must be above 0 and below 100"
        raise DefinitionError(message, where=where, hint="Type the central range in percent, such as 51")
    share = value if value < 1 else value / 100
    if value <= 1:
        findings.notice(f"{what} {as_text(value)} is read as {number_text(share * 100, 12)} %", where)
    return share


def number_in(what: str, content: CellContent, where: Cell) -> float:
    """Return the number that a cell holds.

    Args:
        what: what a person calls the cell, for the message.
        content: what the cell holds; not blank.
        where: the cell.

    Raises:
        DefinitionError: it holds text, a logical, an error, or a formula that was never calculated.
    """
    value = content.value
    if value is None or isinstance(value, bool | str | ErrorCode):
        refuse(what, content, where)
    return float(value)


def refuse(what: str, content: CellContent, where: Cell) -> NoReturn:
    """Say what the cell holds where it should hold something else."""
    match content.value:
        case None:
            message = f"{what} has never been calculated"
            hint = "Open the workbook in Excel, calculate it and save it, or run xlmc calculate on it"
        case ErrorCode() as code:
            message, hint = f"{what} holds the error {code.text}", "Correct the cell, or what it depends on"
        case bool() as value:
            message, hint = f"{what} holds {as_text(value)}, not a number", "Type a number"
        case value:
            message = f"{what} holds the text {as_text(value)!r}, not a number"
            hint = "Type it again as a number" if _reads_as_number(str(value)) else "Type a number"
            text = str(value).strip()
            if _DECIMAL_COMMA.fullmatch(text):
                hint = f"Type the number with the decimal mark of your Excel, such as {text.replace(',', '.')}"
    raise DefinitionError(message, where=where, hint=hint)


def _reads_as_number(text: str) -> bool:
    try:
        float(text.replace(",", ""))
    except ValueError:
        return False
    return True
