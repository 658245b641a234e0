"""The record's account of what formulas need beside cells: defined names, tables, hidden rows."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from typing import TYPE_CHECKING, Final

from xlmc.definitions.model import name_key
from xlmc.definitions.tables.tables import KINDS
from xlmc.results.record.record_parts import RecordTable, Section

if TYPE_CHECKING:
    from xlmc.run.model import Model
    from xlmc.workbook.model import DefinedName, Table

__all__ = ["structure_section"]

_WORD: Final = re.compile(r"[^\W\d][\w.\\?]*")
_NOT_HIDDEN: Final = frozenset({"subtotal", "aggregate"})
"""Functions that can leave out hidden rows."""

_LONGEST: Final = 30_000
"""Characters that a cell of the record holds."""

_COLUMNS: Final = (("name", "Name"), ("what", "Is a"), ("means", "Means"))


def structure_section(model: Model, contents: Collection[str]) -> Section:
    """The names and tables that the needed cells mention, and the hidden rows where a function asks for them.

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
    listed = tuple((name, what, means[:_LONGEST]) for name, what, means in rows)
    return Section("structure", "Names and tables that the run needed", table=RecordTable(_COLUMNS, listed))


def _order(name: DefinedName) -> tuple[str, str]:
    return name.name.casefold(), name.sheet or ""


def _words(texts: Collection[str]) -> set[str]:
    """The words of cells in small letters; those of texts too, which may name a cell or be read by INDIRECT."""
    return set(_WORD.findall("\n".join(texts).casefold()))


def _find_mentioned(names: Collection[DefinedName], words: set[str]) -> Iterator[DefinedName]:
    """The names among the words, and those that these mention in turn."""
    waiting = {name for name in names if not name.name.casefold().startswith(("_xlnm.", "_xlmc_"))}
    while found := {name for name in waiting if name.name.casefold() in words}:
        yield from found
        waiting -= found
        words = words | _words([name.text for name in found])


def _sheets_read(model: Model) -> list[str]:
    """The sheets with hidden rows that a needed cell stands on."""
    read = {cell.sheet for cell in model.read}
    sheets = model.workbook.sheets  # parsed when looked up: those not read are left alone
    return [name for name in sheets if name in read and sheets[name].hidden_rows]


def _ranges(rows: Iterable[int]) -> str:
    """`{3, 4, 5, 9} -> '3-5, 9'`."""
    found: list[list[int]] = []
    for row in sorted(rows):
        if found and row == found[-1][1] + 1:
            found[-1][1] = row
        else:
            found.append([row, row])
    return ", ".join(str(first) if first == last else f"{first}-{last}" for first, last in found)


def _table_text(table: Table) -> str:
    totals = f", {table.totals_rows} rows of totals" * bool(table.totals_rows)
    headings = f", {table.header_rows} rows of headings" * (table.header_rows != 1)
    return f"{table.area}{headings}{totals}: {'; '.join(table.columns)}"
