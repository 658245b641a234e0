"""Excel tables: the table parts that a worksheet points to."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from xlmc.errors import WorkbookError
from xlmc.workbook.model import Table
from xlmc.workbook.package import relationships
from xlmc.workbook.reference import area_of
from xlmc.workbook.safe_xml import REPAIR, tree, whole_number
from xlmc.workbook.strings import decode

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from xlmc.address import Area

__all__ = ["read_table", "tables_of"]


def tables_of(parts: Mapping[str, bytes], sheet_part: str, sheet: str) -> Iterator[Table]:
    """The tables on one worksheet.

    Raises:
        WorkbookError: a table part is missing or damaged.
    """
    for rel in relationships(parts, sheet_part).values():
        if rel.kind == "table":
            if rel.target not in parts:
                raise WorkbookError(f"a table of sheet {sheet!r} is missing from the file", hint=REPAIR)
            yield read_table(parts[rel.target], rel.target, sheet)


def read_table(xml: bytes, part: str, sheet: str) -> Table:
    """One table part.

    Raises:
        WorkbookError: the part is damaged, or its columns or rows do not fit its range.
    """
    root = tree(xml, part)
    name = decode(root.get("displayName", root.get("name", "")))
    columns = tuple(decode(column.get("name", "")) for column in root.findall("{*}tableColumns/{*}tableColumn"))
    area = area_of(root.get("ref"), sheet, f"the table {name!r}")
    header, totals = (whole_number(root.get(key, default)) for key, default in _ROWS)
    if header is None or totals is None or header + totals > area.rows or len(columns) != area.columns:
        raise WorkbookError(f"the table {name!r} of sheet {sheet!r} does not fit its range {area.a1}", hint=REPAIR)
    return Table(name, area, columns, header, totals, _filtered(root, sheet, name))


def _filtered(root: Element, sheet: str, name: str) -> Area | None:
    """The range of its filter; None where no column of it has a condition."""
    element = root.find("{*}autoFilter")
    if element is None or not any(len(column) for column in element.findall("{*}filterColumn")):
        return None
    return area_of(element.get("ref"), sheet, f"the filter of the table {name!r}")


_ROWS = (("headerRowCount", "1"), ("totalsRowCount", "0"))
