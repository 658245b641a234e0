"""The style numbers that the cells, rows and columns of a sheet name: indices into the list `cellXfs`."""

from __future__ import annotations

import re
from functools import cache
from typing import Final

__all__ = ["styles_from"]

_STYLED: Final = re.compile(rb"""<(?:\w+:)?(?:c|row|col)\b[^<>]*?\s(?:s|style)=["']([0-9]{1,9})["']""")
"""Slower than `_suspect`, which may find one in a cell's text."""


def styles_from(xml: bytes, least: int) -> set[int]:
    """Return the style numbers in a sheet's part that are at least this; a sheet without them is looked through
    quickly.
    """
    if _suspect(least).search(xml) is None:
        return set()
    return {number for match in _STYLED.finditer(xml) if (number := int(match[1])) >= least}


@cache
def _suspect(least: int) -> re.Pattern[bytes]:
    """Return the pattern of an attribute that may be such a style number; its first letter is found fast."""
    digits = str(least)
    larger = [
        f"{digits[:at]}[{int(digit) + 1}-9]{'[0-9]' * (len(digits) - at - 1)}"
        for at, digit in enumerate(digits)
        if digit != "9"
    ]
    numbers = "|".join([digits, *larger, f"[1-9][0-9]{{{len(digits)},}}"])
    return re.compile(rf"""s(?:tyle)?=["'](?:{numbers})["']""".encode())
