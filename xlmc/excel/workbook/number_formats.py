"""The number formats of cells: with how many decimals, as a percentage or with an exponent a number is shown."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

from xlmc.excel.address import column_number
from xlmc.excel.workbook.package import relationships
from xlmc.excel.workbook.safe_xml import tree

__all__ = ["BUILT_IN", "NumberFormat", "cell_formats", "number_formats"]

BUILT_IN: Final = {0: "General", 1: "0", 2: "0.00", 3: "#,##0", 4: "#,##0.00", 9: "0%", 10: "0.00%", 11: "0.00E+00"}
"""The formats that a file names by their number alone and that result sheets use."""

_OTHERS: Final = {
    **dict.fromkeys((5, 6), '"$"#,##0'),
    **dict.fromkeys((7, 8), '"$"#,##0.00'),
    14: "yyyy-mm-dd",
    15: "d-mmm-yy",
    16: "d-mmm",
    17: "mmm-yy",
    18: "h:mm AM/PM",
    19: "h:mm:ss AM/PM",
    20: "h:mm",
    21: "h:mm:ss",
    22: "yyyy-mm-dd h:mm",
    45: "mm:ss",
    46: "[h]:mm:ss",
    47: "mm:ss.0",
    49: "@",
    **dict.fromkeys((37, 38, 41), "#,##0"),
    **dict.fromkeys((39, 40, 43), "#,##0.00"),
    42: '"$"#,##0',
    44: '"$"#,##0.00',
}
"""Further formats named by their number; dates that Excel writes as the machine's region asks are ISO's here."""

_CELL: Final = re.compile(rb'<(?:\w+:)?c\b[^>]*? r="([A-Z]{1,3})([0-9]+)"[^>]*? s="([0-9]+)"')
_STYLE: Final = re.compile(rb'\bs="([0-9]+)"')
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
        match = _DECIMALS.search(positive)
        return cls(len(match[1]) if match else 0, "%" in positive, "E" in positive.upper())

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
    known = [NumberFormat.of(code or _built_in(number)) for number, code in _formats(parts, workbook)]
    result = _CELL.findall(parts[sheet])
    return {
        (int(row), column_number(column.decode())): known[int(style)]
        for column, row, style in result
        if int(style) < len(known)
    }


def cell_formats(
    parts: Mapping[str, bytes], workbook: str, places: Iterable[tuple[str, str]]
) -> dict[tuple[str, str], str]:
    """Give the format code of some cells, such as `0.0%`; `General` where one has none.

    Args:
        parts: of the package.
        workbook: the part of the workbook.
        places: the part of each cell's sheet, and its address there, as `B7`.

    Raises:
        WorkbookError: the styles are damaged.
    """
    known, result = _formats(parts, workbook), {}
    passed: dict[str, int] = {}
    for sheet, place in places:
        xml, reference = parts.get(sheet, b""), f' r="{place}"'.encode()
        start = passed.get(sheet, 0)  # cells are often asked for in the order in which they stand
        at = xml.find(reference, start)
        if at < 0:
            at = xml.find(reference, 0, start + len(reference))
        passed[sheet] = max(at, 0)
        tag = xml[xml.rfind(b"<", 0, at) : xml.find(b">", at)] if at > 0 else b""
        style = _STYLE.search(tag)
        number, code = known[int(style[1])] if style and int(style[1]) < len(known) else ("0", "")
        result[sheet, place] = code or (_OTHERS.get(int(number)) if number.isdecimal() else None) or _built_in(number)
    return result


def _formats(parts: Mapping[str, bytes], workbook: str) -> list[tuple[str, str]]:
    """Return the number of each style's format, and its code where the file gives one."""
    styles = next((r.target for r in relationships(parts, workbook).values() if r.kind == "styles"), None)
    if styles is None or styles not in parts:
        return []
    root = tree(parts[styles], styles)
    codes = {each.get("numFmtId", ""): each.get("formatCode", "") for each in root.findall("{*}numFmts/{*}numFmt")}
    lists = root.find("{*}cellXfs")
    numbers = [each.get("numFmtId", "0") for each in (lists if lists is not None else ())]
    return [(number, codes.get(number, "")) for number in numbers]


def _built_in(number: str) -> str:
    return BUILT_IN.get(int(number), "General") if number.isdecimal() else "General"
