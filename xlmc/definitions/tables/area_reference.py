"""A text that must be one range, `Inputs!B2:C9`, a defined name, or columns of a table, and the cells it stands for."""

from __future__ import annotations

import re

from xlmc.address import Area, Cell, parse_address
from xlmc.definitions.references import is_address, refuse_name_of_other_sheet, sheet_named, split_sheet
from xlmc.distributions.naming import did_you_mean
from xlmc.errors import DefinitionError
from xlmc.workbook.model import Table, Workbook

__all__ = ["area_of_reference"]

_COLUMNS = re.compile(r"(?P<table>[^\W\d][\w.]*)\[\[?(?P<first>[^\[\]]+)\]?(?::\[(?P<last>[^\[\]]+)\])?\]?")
_MOST = 1_048_576
_ONE_RANGE = "Write one range, such as Inputs!Q2:Q9, a defined name, or a column of a table, such as Tests[Value]"


def area_of_reference(workbook: Workbook, text: str, sheet: str | None, where: object) -> Area:
    """The cells that one reference stands for.

    Args:
        workbook: where sheets, names and tables are looked up.
        text: the reference, without `=`.
        sheet: the sheet of a reference that names none; None where it must name one.
        where: what holds the text, for the message.

    Raises:
        DefinitionError: it is not one range of cells, or its sheet, name or table is missing.
    """
    text = text.strip().lstrip("+@ ")
    columns = _COLUMNS.fullmatch(text)
    if columns:
        return _columns(workbook, columns, text, where)
    head, tail = split_sheet(text)
    if is_address(tail):
        if head is not None:
            sheet = sheet_named(workbook, head, text, where)
        if sheet is None:
            hint = f"Write the sheet, too, such as {next(iter(workbook.sheets), 'Sheet1')}!{tail}"
            raise DefinitionError(f"{text!r} names no sheet", where=where, hint=hint)
        return _held_to_size(parse_address(tail, sheet), where)
    table = workbook.table_named(text)
    if table is not None:
        return table.body
    name = workbook.defined_name(tail, sheet if head is None else sheet_named(workbook, head, text, where))
    if name is None:
        refuse_name_of_other_sheet(workbook, tail, where)
        raise DefinitionError(f"{text!r} is no range of cells and no name of one", where=where, hint=_ONE_RANGE)
    return _area_of_name(workbook, name.text, where)


def _area_of_name(workbook: Workbook, meaning: str, where: object) -> Area:
    text = meaning.strip().removeprefix("=")
    head, tail = split_sheet(text)
    columns = _COLUMNS.fullmatch(text)
    if columns:
        return _columns(workbook, columns, text, where)
    if head is None or not is_address(tail):
        raise DefinitionError(f"The name stands for {text}, not for one range", where=where, hint=_ONE_RANGE)
    return _held_to_size(parse_address(tail, sheet_named(workbook, head, text, where)), where)


def _columns(workbook: Workbook, found: re.Match[str], text: str, where: object) -> Area:
    table = workbook.table_named(found["table"])
    if table is None:
        hint = did_you_mean(found["table"], [each.name for each in workbook.tables]) if workbook.tables else _ONE_RANGE
        raise DefinitionError(f"There is no table {found['table']!r} ({text})", where=where, hint=hint)
    first = _column(table, found["first"], where)
    last = _column(table, found["last"] or found["first"], where)
    body = table.body
    return Area(body.sheet, body.top, min(first, last), body.bottom, max(first, last))


def _column(table: Table, heading: str, where: object) -> int:
    known = {each.casefold(): place for place, each in enumerate(table.columns, start=table.area.left)}
    if heading.strip().casefold() not in known:
        message = f"The table {table.name} has no column {heading.strip()!r}"
        raise DefinitionError(message, where=where, hint=did_you_mean(heading, table.columns))
    return known[heading.strip().casefold()]


def _held_to_size(place: Cell | Area, where: object) -> Area:
    area = place if isinstance(place, Area) else Area(place.sheet, place.row, place.column, place.row, place.column)
    if area.rows * area.columns > _MOST:
        message = f"{area} is {area.rows * area.columns:,} cells"
        raise DefinitionError(message, where=where, hint=f"Choose a range of {_MOST:,} cells at most")
    return area
