from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.functions.text.characters import char, code

VALUE = ErrorCode.VALUE

TABLE = [
    ("CHAR", (65,), "A"),
    ("CHAR", (33.9,), "!"),
    ("CHAR", (128,), "€"),
    ("CHAR", (129,), "\x81"),
    ("CHAR", (255,), "ÿ"),
    ("CHAR", (0,), VALUE),
    ("CHAR", (256,), VALUE),
    ("CHAR", ("abc",), VALUE),
    ("CODE", ("A",), 65),
    ("CODE", ("Alphabet",), 65),
    ("CODE", ("€",), 128),
    ("CODE", ("\x81",), 129),
    ("CODE", ("Ω",), 63),
    ("CODE", ("",), VALUE),
    ("UNICHAR", (66,), "B"),
    ("UNICHAR", (128512,), "😀"),
    ("UNICHAR", (0,), VALUE),
    ("UNICHAR", (1114112,), VALUE),
    ("UNICHAR", (0xD800,), ErrorCode.NA),
    ("UNICHAR", (0xFFFE,), ErrorCode.NA),
    ("UNICODE", ("B",), 66),
    ("UNICODE", ("😀x",), 128512),
    ("UNICODE", ("",), VALUE),
    ("UPPER", ("Total é ß",), "TOTAL É ß"),
    ("LOWER", ("E. E. Cummings",), "e. e. cummings"),
    ("LOWER", ("ΑΣ",), "ασ"),
    ("PROPER", ("this is a TITLE",), "This Is A Title"),
    ("PROPER", ("2-way street",), "2-Way Street"),
    ("PROPER", ("76BudGet",), "76Budget"),
    ("PROPER", ("o'neil's",), "O'Neil'S"),
    ("PROPER", ("",), ""),
    ("TRIM", ("  First   Quarter ",), "First Quarter"),
    ("TRIM", ("\u00a0a\u00a0",), "\u00a0a\u00a0"),
    ("TRIM", ("\ta ",), "\ta"),
    ("CLEAN", ("\x07text\x1f\r\n",), "text"),
    ("CLEAN", ("a\x7fb\u00a0",), "a\x7fb\u00a0"),
    ("ENCODEURL", ("http://a.b/Profit and Loss-1_2~.xlsx",), "http%3A%2F%2Fa.b%2FProfit%20and%20Loss-1_2~.xlsx"),
    ("ENCODEURL", ("é",), "%C3%A9"),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected)


@pytest.mark.parametrize("macintosh", [False, True])
def test_codes_come_back(macintosh):
    codes = np.arange(1.0, 256.0)
    characters = char(codes, macintosh=macintosh).texts
    assert len(set(characters)) == 255
    assert np.array_equal(code(characters, macintosh=macintosh).numbers, codes)


def test_the_macintosh_has_its_own_characters():
    assert list(char(np.array([65.0, 128.0, 165.0]), macintosh=True).texts) == ["A", "Ä", "•"]
