"""The number formats of cells: with how many decimals, as a percentage or with an exponent a number is shown."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from xlmc.excel.address import column_number
from xlmc.excel.workbook.package import relationships
from xlmc.excel.workbook.safe_xml import tree

__all__ = ["BUILT_IN", "NumberFormat", "number_formats"]

BUILT_IN: Final = {0: "General", 1: "0", 2: "0.00", 3: "#,##0", 4: "#,##0.00", 9: "0%", 10: "0.00%", 11: "0.00E+00"}
"""The formats that a file names by their number alone and that result sheets use."""

_CELL: Final = re.compile(rb'<(?:\w+:)?c\b[^>]*? r="([A-Z]{1,3})([0-9]+)"[^>]*? s="([0-9]+)"')
_NOT_DIGITS: Final = re.compile(r'"[^"]*"|\[[^\]]*\]|\\.|_.|\*.')
_DECIMALS: Final = re.compile(r"\.([0#?]+)")


@dataclass(frozen=True, slots=True)
class NumberFormat:
    """What a format code shows of a number, whatever program wrote it.

    Attributes:
        decimals: the most that are shown; None if the program decides (General).
    """

    decimals: int | None
    percent: bool
    exponent: bool

    @classmethod
    def of(cls, code: str) -> NumberFormat:
        """Read a format code.

        >>> NumberFormat.of('#,##0.000" mph"')
        NumberFormat(decimals=3, percent=False, exponent=False)
        """
        positive = _NOT_DIGITS.sub("", code).split(";")[0]
        if positive.strip().casefold() in ("", "general", "standard"):
            return cls(None, False, False)
        found = _DECIMALS.search(positive)
        return cls(len(found[1]) if found else 0, "%" in positive, "E" in positive.upper())

    def __str__(self) -> str:
        """In words, as a message needs it."""
        if self.decimals is None:
            return "as the program likes"
        form = " percent" * self.percent + " with an exponent" * self.exponent
        return f"with {self.decimals} decimal{'s' * (self.decimals != 1)}{form}"


def number_formats(parts: Mapping[str, bytes], workbook: str, sheet: str) -> dict[tuple[int, int], NumberFormat]:
    """Give the format of each cell of a sheet that has a style, by (row, column).

    Args:
        parts: of the package.
        workbook: the part of the workbook.
        sheet: the part of the sheet.

    Raises:
        WorkbookError: the styles are damaged.
    """
    styles = next((r.target for r in relationships(parts, workbook).values() if r.kind == "styles"), None)
    if styles is None or styles not in parts:
        return {}
    root = tree(parts[styles], styles)
    codes = {each.get("numFmtId", ""): each.get("formatCode", "") for each in root.findall("{*}numFmts/{*}numFmt")}
    lists = root.find("{*}cellXfs")
    numbers = [each.get("numFmtId", "0") for each in (lists if lists is not None else ())]
    known = [NumberFormat.of(codes.get(number) or _built_in(number)) for number in numbers]
    found = _CELL.findall(parts[sheet])
    return {
        (int(row), column_number(column.decode())): known[int(style)]
        for column, row, style in found
        if int(style) < len(known)
    }


def _built_in(number: str) -> str:
    return BUILT_IN.get(int(number), "General") if number.isdecimal() else "General"
