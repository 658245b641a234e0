"""What people call a cell: the text left of it or above it, and the unit beside it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell, column_letters
from xlmc.excel.workbook.printable import label
from xlmc.excel.workbook.workbook import Workbook

__all__ = ["Label", "is_year", "label_of"]

_FARTHEST: Final = 30
"""Cells to the left, and above, in which a label is looked for."""

_LONGEST: Final = 80

_IN_BRACKETS: Final = re.compile(r"^(?P<name>.*\S)\s*[(\[](?P<unit>[^()\[\]]{1,12})[)\]]\s*:?$")
_WHOLLY_IN_BRACKETS: Final = re.compile(r"^[(\[].*[)\]]$")
_SYMBOL: Final = re.compile(r"^[A-Za-z]\d?$|\w[(\[]")
"""A letter with an index, which may be of a quantity; `kN` and `ft` are no such letters."""
_SYMBOLS: Final = (
    "m mm cm km µm μm um nm in inch inches ft feet yd mi mile miles s sec second seconds ms min minutes h "
    "hr hrs hour hours d day days week weeks wk month months mo yr yrs year years a g kg mg t ton tons "
    "tonne tonnes lb lbs lbm lbf kip kips oz slug N kN MN J kJ MJ GJ W kW MW GW Wh kWh MWh GWh Btu BTU hp "
    "Pa kPa MPa GPa psi ksi psf ksf bar mbar atm K C F R deg rad mph kph kmh fps mps kn knots Hz kHz MHz "
    "rpm V kV mV A mA kA Ω kΩ ohm ohms l L ml mL gal gallon gallons % ‰ ppm $ € £ k$ M$ $k $M USD EUR GBP "
    "CHF pcs pc unit units each ea people persons acre acres ha sqft sf cf cy gpm cfs mol mmol kmol dB ° "
    "°C °F ºC ºF g's "
)
_BASES: Final = frozenset(_SYMBOLS.split())
_EXPONENT: Final = re.compile(r"(?:\^?-?\d|[²³⁴⁻¹]+)$")
_JOINED: Final = re.compile(r"[*·⋅./×\- ]+")


@dataclass(frozen=True, slots=True)
class Label:
    """A cell's name and unit; either may be empty."""

    name: str = ""
    unit: str = ""


def label_of(book: Workbook, cell: Cell) -> Label:
    """Return the name and the unit of a cell by the texts around it.

    The name is the nearest text to the left. Where another number stands between, or right of the cell under a heading
    of its own, the cell is one of a row of numbers, and the text above it is added; without a text to the left, it is
    that alone. So it is for a row of cells with headings right above, and nothing beside or below it. Years that head a
    row or a column are such texts. A symbol of a unit right of the cell, between it and its name
    or its heading, or in brackets behind the name, is its unit.
    """
    left, between = _left(book, cell)
    above, unit = _above(book, cell)
    between = between or (bool(left) and _is_first_of_row(book, cell))
    if _is_under_heading(book, cell):
        left = []
    if left and not between:
        unit = ""
    if len(left) > 1 and not between and _is_unit(left[0]):
        unit, left = left[0], left[1:]
    name = left[0] if left else ""
    if not name:
        name = above
    elif between and above and above != name:
        name = f"{name}, {above}"
    right = book.content(Cell(cell.sheet, cell.row, cell.column + 1))
    if not unit and right.formula is None and isinstance(right.value, str) and _is_unit(right.value.strip()):
        unit = right.value.strip()
    match = _IN_BRACKETS.match(name)
    if match is not None and (not unit or match["unit"].casefold() == unit.casefold()) and _is_unit(match["unit"]):
        name, unit = match["name"], match["unit"]
    if not name:
        name = next((each.name for each in book.names if _stands_for(book, each.text, cell)), "")
    return Label(label(name.strip().rstrip(":=").strip())[:_LONGEST], unit.strip("()[] "))


def _left(book: Workbook, cell: Cell) -> tuple[list[str], bool]:
    """Return the texts to the left, the nearest first, and whether a number stands before the first of them."""
    texts: list[str] = []
    between = False
    for column in range(cell.column - 1, max(0, cell.column - 1 - _FARTHEST), -1):
        content = book.content(Cell(cell.sheet, cell.row, column))
        if content.is_blank:
            if texts:
                break
            continue
        if isinstance(content.value, str) or is_year(book, Cell(cell.sheet, cell.row, column)):
            texts.append(_text(book, Cell(cell.sheet, cell.row, column)))
            if len(texts) > 1:
                break
        elif texts:
            break
        else:
            between = True
    return texts, between


def _above(book: Workbook, cell: Cell) -> tuple[str, str]:
    """Return the heading above and the unit between: `Gain (Per Year)` and `€` of a column with these in three rows."""
    unit, more = "", ""
    for row in range(cell.row - 1, max(0, cell.row - 1 - _FARTHEST), -1):
        text = _text(book, Cell(cell.sheet, row, cell.column))
        if not text:
            continue
        if not unit and not more and _is_plainly_unit(text) and _text(book, Cell(cell.sheet, row - 1, cell.column)):
            unit = text
        elif not more and _WHOLLY_IN_BRACKETS.match(text) and _text(book, Cell(cell.sheet, row - 1, cell.column)):
            more = f" {text}"
        else:
            begins = _text(book, Cell(cell.sheet, row - 1, cell.column)) if text[0].islower() and " " in text else ""
            return f"{begins} {text}{more}".lstrip(), unit
    return more.strip(), unit


def _text(book: Workbook, cell: Cell) -> str:
    """Return the text of a cell, or the year that it heads a row or a column with; otherwise an empty one."""
    if cell.row < 1:
        return ""
    value = book.content(cell).value
    if isinstance(value, str):
        return value.strip()
    return f"{value:.0f}" if isinstance(value, int | float) and is_year(book, cell) else ""


def is_year(book: Workbook, cell: Cell) -> bool:
    """Whether a number heads a column or a row of a table by years: the one beside it is the next or the last year."""
    year = book.content(cell).value
    if not isinstance(year, int | float) or year not in range(1900, 2101):
        return False
    beside = [(cell.row, cell.column + step) for step in (-1, 1)] + [(cell.row + step, cell.column) for step in (-1, 1)]
    contents = [book.content(Cell(cell.sheet, *place)) for place in beside if min(place) > 0]
    following = f"{column_letters(cell.column)}{cell.row}+1"
    return any(
        content.value in (year - 1, year + 1)
        or (content.formula is not None and content.formula.text.replace("$", "").replace(" ", "") == following)
        for content in contents
    )


def _is_first_of_row(book: Workbook, cell: Cell) -> bool:
    """Return whether a number stands right of the cell, and a heading right above the block over each of both."""
    right = book.content(Cell(cell.sheet, cell.row, cell.column + 1))
    if not isinstance(right.value, int | float) or isinstance(right.value, bool | ErrorCode):
        return False
    for row in range(cell.row - 1, max(0, cell.row - 1 - _FARTHEST), -1):
        texts = [_text(book, Cell(cell.sheet, row, cell.column + step)) for step in (0, 1)]
        if any(texts):
            return all(texts)
    return False


def _is_under_heading(book: Workbook, cell: Cell) -> bool:
    """Return whether a text stands right above, a blank cell below, and one left of the numbers beside the cell."""
    heading = book.content(Cell(cell.sheet, cell.row - 1, cell.column)).value if cell.row > 1 else None
    if (
        not isinstance(heading, str)
        or not heading.strip()
        or _is_unit(heading)
        or not book.content(Cell(cell.sheet, cell.row + 1, cell.column)).is_blank
    ):
        return False
    for column in range(cell.column - 1, 0, -1):
        content = book.content(Cell(cell.sheet, cell.row, column))
        if content.is_blank or isinstance(content.value, str):
            return content.is_blank
    return False


def _is_unit(text: str) -> bool:
    """Return whether a text may be a unit: `m/s²`, `lb`, `%`, `kN·m`; a word of a sentence is none.

    >>> [_is_unit(text) for text in ("mph", "m/s^2", "%", "kN*m", "Length", "total", "from the plan")]
    [True, True, True, True, False, False, False]
    """
    factors = [_EXPONENT.sub("", each) for each in _JOINED.split(re.sub(r"[()\[\]]", "", text)) if each]
    return bool(factors) and all(each in _BASES or each == "1" for each in factors) and len(text) <= 14


def _is_plainly_unit(text: str) -> bool:
    """Return whether a heading can be nothing but a unit; a letter alone may be the symbol of a quantity.

    >>> [_is_plainly_unit(text) for text in ("€", "kN", "(m)", "m/s²", "m", "l1", "m(i)")]
    [True, True, True, True, False, False, False]
    """
    if _WHOLLY_IN_BRACKETS.match(text):
        return _is_unit(text)
    return _is_unit(text) and not _SYMBOL.match(text)


def _stands_for(book: Workbook, text: str, cell: Cell) -> bool:
    return text.replace("$", "").casefold() in (
        f"{cell.sheet}!{cell.a1}".casefold(),
        f"'{cell.sheet}'!{cell.a1}".casefold(),
    )
