"""Areas as the parts of a workbook write them: `A1:B2`, without their sheet."""

from __future__ import annotations

from xlmc.address import Area, Cell, parse_address
from xlmc.errors import WorkbookError
from xlmc.workbook.safe_xml import REPAIR

__all__ = ["area_of"]


def area_of(reference: str | None, sheet: str, what: str) -> Area:
    """The area `reference` names on `sheet`; a single cell is an area of one.

    Raises:
        WorkbookError: there is no reference, or it is none; `what` says whose it is.
    """
    try:
        found = parse_address(reference or "", sheet)
    except ValueError as error:
        raise WorkbookError(f"{what} of sheet {sheet!r} has no valid range: {error}", hint=REPAIR) from None
    if isinstance(found, Cell):
        return Area(sheet, found.row, found.column, found.row, found.column)
    return found
