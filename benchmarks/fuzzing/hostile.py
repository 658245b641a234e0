"""Values that programs trip over: numbers, texts, addresses."""

from __future__ import annotations

import random
from typing import Final

__all__ = ["ADDRESSES", "ERRORS", "NUMBERS", "TEXTS", "address", "number", "text"]

NUMBERS: Final = (
    "0", "-0", "1", "-1", "2", "0.5", "-0.5", "1E-308", "5E-324", "1E308", "-1E308", "1.7976931348623157E+308", "1E15",
    "9007199254740993", "2147483648", "-2147483649", "4294967296", "1E100", "1E-100", "0.1", "1.0000000000000002",
    "60", "2958465", "2958466", "-657434", "45000.75", "255", "256", "32767", "32768", "1048576", "1048577", "16384",
    "16385", "99999999999999999999", "3.141592653589793", "1E-16", "0.999999999999999", "NaN", "INF", "-INF", "1e",
    "", " 1 ", "1,5", "0x10", "٣", "1_000", "--1", "1E400", "-1E400", "1E-400",
)  # fmt: skip
TEXTS: Final = (
    "", " ", "x", "TRUE", "#N/A", "#REF!", "=1", "'", '"', "a" * 300, "a" * 40_000, "Ünïcödé", "日本語", "\u202eabc",
    "\U0001f600", "\u0301", "a\nb", "a\tb", "_x0000_", "_x001B_[31m", "_x0007_", "_xD800_", "_xFFFE_", "_x000D_",
    "%s%n{0}{x!r}", "<b>&amp;</b>", "]]>", "[Low]", "S!A1", "'S'!A1", "[1]S!A1", "../x", "C:\\x", "xlmc_settings",
    "12/31/1999", "1/0", "50%", "$3", "1e5", "inf", "nan", "A1:B2", "R1C1", "\u00a0", "İ", "ß", "ﬀ",
)  # fmt: skip
ERRORS: Final = ("#NULL!", "#DIV/0!", "#VALUE!", "#REF!", "#NAME?", "#NUM!", "#N/A", "#SPILL!", "#CALC!", "#BUSY!")
ADDRESSES: Final = (
    "A0", "A1", "a1", "$A$1", "XFD1048576", "XFE1", "A1048577", "ZZZZ1", "1A", "A", "1", "", "A1:", ":A1", "A1:A1:A1",
    "B2:A1", "A1:XFD1048576", "A:A", "1:1", "R1C1", "S!A1", "A-1", "A99999999999999999999", "A1 B2", "é1", "A1:B2,C3",
    "#REF!",
)  # fmt: skip


def number(rng: random.Random) -> str:
    """A number as a file or a formula writes it, often one at the edge of some range."""
    if rng.random() < 0.3:
        return repr(rng.choice([1.0, -1.0]) * rng.random() * 10.0 ** rng.randint(-12, 12))
    return rng.choice(NUMBERS)


def text(rng: random.Random) -> str:
    """A text, often one that means something somewhere."""
    if rng.random() < 0.2:
        return "".join(
            chr(rng.choice([rng.randint(32, 126), rng.randint(160, 0x2FFF)])) for _ in range(rng.randint(1, 9))
        )
    return rng.choice(TEXTS)


def address(rng: random.Random) -> str:
    """The address of a cell or an area, or what looks like one."""
    return rng.choice(ADDRESSES)
