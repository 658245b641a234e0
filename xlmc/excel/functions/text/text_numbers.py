"""Numbers as texts in a format, and texts as numbers."""

from __future__ import annotations

import math
from decimal import ROUND_HALF_UP, Context, Decimal
from typing import Final

from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.functions.number_text import parse_number, parse_plain_number, round_to_15_digits
from xlmc.excel.functions.per_element import object_text, per_element, per_object
from xlmc.excel.functions.registry import Anything, Kind, Logical, Number, Text, excel

__all__: list[str] = []

_MOST_DECIMALS: Final = 127
_WIDE: Final = Context(prec=1000, rounding=ROUND_HALF_UP)


@excel("TEXT", Anything, Text, returns=Kind.TEXT, dated=True)
@per_object
def text(value: object, code: object, *, date1904: bool = False) -> object:
    """Write a number in a number format, `TEXT(0.285, "0.0%")`; a text or logical as the format writes texts.

    Raises:
        FormulaError: the format asks for numerals, or for names of months and days, that are not known here.
    """
    from xlmc.excel.functions.number_format import FormatError, UnknownFormat, parse_format  # few books call it

    try:
        form = parse_format(object_text(code))
        number = _number_to_write(value, date1904)
        if number is not None:
            return form.number(number, date1904)
        return form.text(object_text(value)) if code not in (None, "") else ""
    except FormatError:
        return ErrorCode.VALUE
    except UnknownFormat as unknown:
        raise FormulaError(f"in the number format {code!r} {unknown}", hint="Use a format of plain numbers") from None


def _number_to_write(value: object, date1904: bool) -> float | None:
    """Return a number, a blank as 0, or a text that is a number; None for any other."""
    if isinstance(value, str):
        return parse_number(value, date1904)
    return None if isinstance(value, bool) else 0.0 if value is None else float(value)  # type: ignore[arg-type]


@excel("FIXED", Number, Number(default=2.0), Logical(default=False), returns=Kind.TEXT)
@per_element
def fixed(number: float, decimals: float, no_commas: bool) -> object:
    """Write a number rounded to so many decimals, with commas between thousands unless `no_commas`."""
    return _write_rounded(number, decimals, "0" if no_commas else "#,##0", "-{}")


@excel("DOLLAR", Number, Number(default=2.0), returns=Kind.TEXT, aliases=("USDOLLAR",))
@per_element
def dollar(number: float, decimals: float) -> object:
    """Write an amount in dollars, rounded to so many decimals; in brackets if negative."""
    return _write_rounded(number, decimals, "$#,##0", "({})")


def _write_rounded(number: float, decimals: float, whole: str, negative: str) -> object:
    """Write the rounded number in the format `whole` with decimals; a negative one inserted in the text `negative`."""
    digits = math.trunc(max(decimals, -400.0))
    if digits > _MOST_DECIMALS:
        return ErrorCode.VALUE
    size = float(round_to_15_digits(number).quantize(Decimal(1).scaleb(-digits), context=_WIDE))
    if math.isinf(size):
        return ErrorCode.NUM
    from xlmc.excel.functions.number_format import parse_format

    text = parse_format(whole + "." * (digits > 0) + "0" * digits).number(abs(size))
    return negative.format(text) if size < 0 else text


@excel("VALUE", Anything, dated=True)
@per_object
def value(item: object, *, date1904: bool = False) -> object:
    """Return the number that a text stands for, as arithmetic would read it: amounts, percentages, fractions, dates,
    times.
    """
    if isinstance(item, bool):
        return ErrorCode.VALUE
    number = _number_to_write(item, date1904)
    return ErrorCode.VALUE if number is None else number


@excel("NUMBERVALUE", Text, Text(default="."), Text(default=","))
@per_element
def number_value(source: str, point: str, group: str) -> object:
    """Return the number that a text stands for, with these characters as decimal point and as separator of thousands.

    Spaces do not count, each percent sign divides by 100, and an empty text is 0.
    """
    if not point or not group:
        return ErrorCode.VALUE
    packed = source.replace(" ", "")
    body = packed.rstrip("%")
    whole, mark, decimals = body.partition(point[0])
    if group[0] in decimals or not packed:
        return 0.0 if not packed else ErrorCode.VALUE
    number = parse_plain_number(whole.replace(group[0], "") + ("." if mark else "") + decimals)
    return ErrorCode.VALUE if number is None else number / 100 ** (len(packed) - len(body))
