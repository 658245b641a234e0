"""A text that must be one reference, and what it stands for.

One cell: `Inputs!B7`, `'My sheet'!$B$7` or a defined name. One range: `Inputs!B2:C9`, a defined name, or columns of a
table.
"""

from __future__ import annotations

import re
from typing import NoReturn

from xlmc.errors import DefinitionError
from xlmc.excel.address import Area, Cell, column_letters, column_number, parse_address, quote_sheet
from xlmc.excel.workbook.workbook import DefinedName, Formula, Table, Workbook
from xlmc.montecarlo.distributions.spelling import did_you_mean, nearest
from xlmc.montecarlo.number_text import count_text

__all__ = [
    "area_of_reference",
    "cell_of_name",
    "cell_of_reference",
    "formula_at",
    "is_address",
    "refuse_name_of_other_sheet",
    "split_sheet",
]

_CORNER = re.compile(r"(\$?)([A-Za-z]{1,3})(\$?)([1-9][0-9]{0,6})")
_ABSOLUTE = re.compile(r"\$[A-Za-z]{1,3}\$[0-9]+(:\$[A-Za-z]{1,3}\$[0-9]+)?")
_NAME = re.compile(r"[^\W\d][\w.\\?]*|\\[\w.\\?]*")
_SHEET = re.compile(r"'(?:[^']|'')+'|[\w. ]+")
_ONE_CELL = "Write one cell, such as =Inputs!B7"

_COLUMNS = re.compile(r"(?P<table>[^\W\d][\w.]*)\[\[?(?P<first>[^\[\]]+)\]?(?::\[(?P<last>[^\[\]]+)\])?\]?")

_MOST = 1_048_576

_ONE_RANGE = "Write one range, such as Inputs!Q2:Q9, a defined name, or a column of a table, such as Tests[Value]"


def formula_at(formula: Formula, cell: Cell) -> str:
    """Return the text of a formula that is a reference, as the cell means it; the plus of `=+B7` is dropped.

    Cells filled down share their master's text; the references that `$` does not hold move with them.
    """
    down, across = cell.row - formula.row, cell.column - formula.column
    text = formula.text.strip().lstrip("+ ")
    head, bang, tail = text.rpartition("!")
    if not (down or across) or not is_address(tail):
        return text

    def moved(corner: re.Match[str]) -> str:
        fixed_column, letters, fixed_row, row = corner.groups()
        column = column_number(letters) + (0 if fixed_column else across)
        line = int(row) + (0 if fixed_row else down)
        return f"{fixed_column}{column_letters(column)}{fixed_row}{line}" if column > 0 and line > 0 else "#REF!"

    return f"{head}{bang}{_CORNER.sub(moved, tail)}"


def cell_of_reference(workbook: Workbook, text: str, sheet: str, where: Cell) -> Cell:
    """Return the cell that one reference stands for.

    Args:
        workbook: where sheets and names are looked up.
        text: the reference, without `=`; names follow Excel: those of the sheet first, then the workbook's.
        sheet: the sheet of a reference that names none.
        where: the cell that holds the text, for the message.

    Raises:
        DefinitionError: it is not one reference, its sheet or name is missing, or it is more than one cell.
    """
    head, tail = split_sheet(text)
    if head is not None:
        sheet = _sheet_named(workbook, head, text, where)
    if is_address(tail):
        return _one_cell(parse_address(tail, sheet), where)
    if not _NAME.fullmatch(tail):
        _not_one_reference(text, where)
    name = workbook.defined_name(tail, sheet)
    if name is None:
        refuse_name_of_other_sheet(workbook, tail, where)
        known = nearest(tail, {each.name for each in workbook.names})
        hint = f"Did you mean {known}?" if known else _ONE_CELL
        raise DefinitionError(f"{text!r} is neither a cell nor a defined name", where=where, hint=hint)
    return cell_of_name(workbook, name, where)


def cell_of_name(workbook: Workbook, name: DefinedName, where: Cell) -> Cell:
    """Return the cell that a defined name stands for.

    Args:
        workbook: where its sheet is looked up.
        name: the name.
        where: the cell that asks, for the message.

    Raises:
        DefinitionError: the name does not stand for one fixed cell.
    """
    text = name.text.strip().removeprefix("=")
    head, tail = split_sheet(text)
    if "#REF!" in text:
        message = f"The name {name.name} has lost its cell ({text})"
        raise DefinitionError(message, where=where, hint="Correct it under Formulas ▸ Name Manager")
    if head is None or not is_address(tail):
        message = f"The name {name.name} stands for {text}, not for one cell"
        raise DefinitionError(message, where=where, hint=_ONE_CELL)
    if not _ABSOLUTE.fullmatch(tail):
        message = f"The name {name.name} stands for {text}, which moves with the cell that uses it"
        raise DefinitionError(message, where=where, hint="Write it with $ under Formulas ▸ Name Manager")
    return _one_cell(parse_address(tail, _sheet_named(workbook, head, text, where)), where)


def refuse_name_of_other_sheet(workbook: Workbook, name: str, where: object) -> None:
    """Say where a name that is not in sight would be.

    Raises:
        DefinitionError: other sheets have a name of their own like it.
    """
    owners = [each.sheet for each in workbook.names if each.sheet and each.name.casefold() == name.strip().casefold()]
    if owners:
        message = f"{name!r} is a name of the sheet {' and '.join(sorted(owners))} only"
        hint = f"Fill in Cell with the formula ={quote_sheet(owners[0])}!{name.strip()}"
        raise DefinitionError(message, where=where, hint=hint)


def is_address(text: str) -> bool:
    """Whether the text, which names no sheet, is a cell or an area."""
    try:
        parse_address(text, "-")
    except ValueError:
        return False
    return "!" not in text


def split_sheet(text: str) -> tuple[str | None, str]:
    """`"'My sheet'!B7" -> ("'My sheet'", "B7")`; None if no sheet is named."""
    head, bang, tail = text.strip().rpartition("!")
    return (head if bang else None), tail.strip()


def _sheet_named(workbook: Workbook, head: str, text: str, where: object) -> str:
    """Return the sheet that a reference names, as the workbook spells it.

    Args:
        workbook: where it is looked up.
        head: the name, in quotes or not.
        text: the whole reference, for the message.
        where: what holds it, likewise.

    Raises:
        DefinitionError: there is no such sheet, or it lies in another workbook.
    """
    quoted = len(head) > 2 and head[0] == head[-1] == "'"
    name = head[1:-1].replace("''", "'") if quoted else head
    sheet = workbook.sheet_named(name)
    if sheet is not None:
        return sheet.name
    if "[" in head:
        message = f"{text!r} lies in another workbook"
        raise DefinitionError(message, where=where, hint="Assumptions, forecasts and filters must be in this workbook")
    if not _SHEET.fullmatch(head):
        _not_one_reference(text, where)
    raise DefinitionError(f"There is no worksheet {name!r}", where=where, hint=did_you_mean(name, workbook.sheets))


def _one_cell(area: Cell | Area, where: Cell) -> Cell:
    if isinstance(area, Cell):
        return area
    if area.rows == area.columns == 1:
        return Cell(area.sheet, area.top, area.left)
    raise DefinitionError(f"{area} is more than one cell", where=where, hint=_ONE_CELL)


def _not_one_reference(text: str, where: object) -> NoReturn:
    raise DefinitionError(f"{text!r} is not one reference to a cell", where=where, hint=_ONE_CELL)


def area_of_reference(workbook: Workbook, text: str, sheet: str | None, where: object) -> Area:
    """Return the cells that one reference stands for.

    Args:
        workbook: where sheets, names and tables are looked up.
        text: the reference, without `=`.
        sheet: the sheet of a reference that names none; None if it must name one.
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
            sheet = _sheet_named(workbook, head, text, where)
        if sheet is None:
            hint = f"Write the sheet, too, such as {next(iter(workbook.sheets), 'Sheet1')}!{tail}"
            raise DefinitionError(f"{text!r} names no sheet", where=where, hint=hint)
        return _checked_size(parse_address(tail, sheet), where)
    table = workbook.table_named(text)
    if table is not None:
        return table.body
    name = workbook.defined_name(tail, sheet if head is None else _sheet_named(workbook, head, text, where))
    if name is None:
        refuse_name_of_other_sheet(workbook, tail, where)
        raise DefinitionError(f"{text!r} is neither a range of cells nor the name of one", where=where, hint=_ONE_RANGE)
    return _area_of_name(workbook, name.text, where)


def _area_of_name(workbook: Workbook, meaning: str, where: object) -> Area:
    text = meaning.strip().removeprefix("=")
    head, tail = split_sheet(text)
    columns = _COLUMNS.fullmatch(text)
    if columns:
        return _columns(workbook, columns, text, where)
    if head is None or not is_address(tail):
        raise DefinitionError(f"The name stands for {text}, not for one range", where=where, hint=_ONE_RANGE)
    return _checked_size(parse_address(tail, _sheet_named(workbook, head, text, where)), where)


def _columns(workbook: Workbook, match: re.Match[str], text: str, where: object) -> Area:
    table = workbook.table_named(match["table"])
    if table is None:
        hint = did_you_mean(match["table"], [each.name for each in workbook.tables]) if workbook.tables else _ONE_RANGE
        raise DefinitionError(f"There is no table {match['table']!r} ({text})", where=where, hint=hint)
    first = _column(table, match["first"], where)
    last = _column(table, match["last"] or match["first"], where)
    body = table.body
    return Area(body.sheet, body.top, min(first, last), body.bottom, max(first, last))


def _column(table: Table, heading: str, where: object) -> int:
    known = {each.casefold(): column for column, each in enumerate(table.columns, start=table.area.left)}
    if heading.strip().casefold() not in known:
        message = f"The table {table.name} has no column {heading.strip()!r}"
        raise DefinitionError(message, where=where, hint=did_you_mean(heading, table.columns))
    return known[heading.strip().casefold()]


def _checked_size(cell: Cell | Area, where: object) -> Area:
    area = cell if isinstance(cell, Area) else Area(cell.sheet, cell.row, cell.column, cell.row, cell.column)
    if area.rows * area.columns > _MOST:
        message = f"{area} is {count_text(area.rows * area.columns)} cells"
        raise DefinitionError(message, where=where, hint=f"Choose a range of {count_text(_MOST)} cells at most")
    return area
