"""Whole numbers as people type them."""

from __future__ import annotations

import re
from decimal import Decimal
from typing import Final

__all__ = ["typed_whole_number"]

_GROUPED: Final = re.compile(
    r"([+-]?)([1-9][0-9]{0,2}([,_' \u2019\u00a0\u202f])[0-9]{3}(?:\3[0-9]{3}){0,9}|[0-9]{1,100})"
)
_SCALED: Final = re.compile(r"([+-]?[0-9]{1,18}(?:\.[0-9]{1,18})?)(?:e\+?([0-9]{1,2})| ?(k|m))", re.IGNORECASE)
_UNITS: Final = {"k": 3, "m": 6}


def typed_whole_number(text: str) -> int | None:
    """The number; None where the text is none, or could mean two (`200.000`).

    >>> [typed_whole_number(text) for text in ("200000", "200,000", "2e5", "1.5e6", "200k", "1.5M", "200.000", "2,5")]
    [200000, 200000, 200000, 1500000, 200000, 1500000, None, None]
    """
    text = text.strip()
    grouped = _GROUPED.fullmatch(text)
    if grouped is not None:
        return int(grouped[1] + re.sub("[^0-9]", "", grouped[2]))
    scaled = _SCALED.fullmatch(text)
    if scaled is None:
        return None
    number, exponent, unit = scaled.groups()
    found = Decimal(number).scaleb(int(exponent) if exponent else _UNITS[unit.casefold()])
    return int(found) if found == found.to_integral_value() else None
