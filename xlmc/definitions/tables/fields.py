"""What one cell of a table row means: a text, a number, a parameter, a yes or no.

Each reader raises a `DefinitionError` that names the cell and says what to do.
"""

from __future__ import annotations

from typing import NoReturn

from xlmc.address import Cell
from xlmc.definitions.definitions import Parameter
from xlmc.definitions.problems import Findings
from xlmc.definitions.tables.table_rows import Row, as_text
from xlmc.errors import DefinitionError, ErrorCode
from xlmc.workbook.workbook import CellContent, Workbook

__all__ = [
    "central_share",
    "logical",
    "number",
    "number_in",
    "optional_text",
    "parameter",
    "required_text",
    "static_value",
]

_WORDS = {"true": True, "yes": True, "on": True, "false": False, "no": False, "off": False}


def required_text(row: Row, heading: str) -> str:
    """The text of the cell, trimmed.

    Raises:
        DefinitionError: the cell is blank or holds an error.
    """
    text = optional_text(row, heading)
    if not text:
        message = f"{row.heading(heading)} is blank"
        raise DefinitionError(message, where=row.cell(heading), hint=f"Fill in {heading}, or clear the whole row")
    return text


def optional_text(row: Row, heading: str) -> str:
    """The text of the cell, trimmed; '' where it is blank or the table has no such column.

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
    """The number in the cell, typed in or as Excel cached it; None where it is blank.

    Raises:
        DefinitionError: the cell holds anything else.
    """
    if not row.filled(heading):
        return None
    return number_in(row.heading(heading), row.content(heading), row.cell(heading))


def parameter(row: Row, heading: str) -> Parameter | None:
    """The number in the cell, or the cell itself where it holds a formula; None where it is blank.

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
    value = number_in(row.heading(heading), content, row.cell(heading))
    return value if content.formula is None else row.cell(heading)


def static_value(given: Parameter | None, workbook: Workbook) -> float | None:
    """The number, or the one that Excel cached for the cell, if any."""
    if not isinstance(given, Cell):
        return given
    value = workbook.content(given).value
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool | ErrorCode) else None


def logical(row: Row, heading: str) -> bool:
    """TRUE or FALSE, also as the words true, false, yes, no, on, off; blank is FALSE.

    Raises:
        DefinitionError: the cell holds anything else.
    """
    if not row.filled(heading):
        return False
    value = row.content(heading).value
    if isinstance(value, bool):
        return value
    word = _WORDS.get(value.strip().casefold()) if isinstance(value, str) else None
    if word is None:
        message = f"{row.heading(heading)} holds {as_text(value)!r}, neither TRUE nor FALSE"
        raise DefinitionError(message, where=row.cell(heading), hint="Type TRUE or FALSE, or leave the cell blank")
    return word


def central_share(what: str, value: float, where: Cell, findings: Findings) -> float:
    """A percentage above 0 and below 100 as a share.

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
        findings.notice(f"{what} {as_text(value)} is read as {share * 100:.12g} %", where)
    return share


def number_in(what: str, content: CellContent, where: Cell) -> float:
    """The number that a cell holds.

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
            message, hint = f"{what} has never been calculated", "Open the workbook in Excel, calculate it and save it"
        case ErrorCode() as code:
            message, hint = f"{what} holds the error {code.text}", "Correct the cell, or what it depends on"
        case bool() as value:
            message, hint = f"{what} holds {as_text(value)}, not a number", "Type a number"
        case value:
            message = f"{what} holds the text {as_text(value)!r}, not a number"
            hint = "Type it again as a number" if _reads_as_number(str(value)) else "Type a number"
    raise DefinitionError(message, where=where, hint=hint)


def _reads_as_number(text: str) -> bool:
    try:
        float(text.replace(",", ""))
    except ValueError:
        return False
    return True
