"""Parts of reading tokens by themselves: references with a `$`, line breaks, and where a token may begin."""

from __future__ import annotations

import pytest

from xlmc.excel.formula.formula_tokens import TOKENS, absolute_reference, tokens_at, without_line_breaks


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("Model!$D$29", "Model!$D$29"), ("$A$1:$B$2", "$A$1:$B$2"), ("'My data'!$A1", "My data!$A1"),
        ("Data!$A:$B", "Data!$A:$B"), ("[1]Data!$A$1", "[1]Data!$A$1"), ("A$1", "A$1"),
    ],
)  # fmt: skip
def test_texts_that_are_one_absolute_reference(shown, text, tree):
    assert shown(absolute_reference(text)) == tree


@pytest.mark.parametrize(
    "text", ["A1", "Rate", "$A$1+1", "SUM($A$1)", "$XFE$1", "$A$1048577", "$A$1:$XFE$2", "'$'!A1", "$A", "=$A$1", ""]
)
def test_other_texts(text):
    assert absolute_reference(text) is None


@pytest.mark.parametrize(
    ("text", "clean"),
    [
        ("A1+B1", "A1+B1"), ("A1\n+B1", "A1 +B1"), ("A1\r\n+\tB1", "A1  + B1"), ('"a\nb"&\nA1', '"a\0b"& A1'),
        ("T[a\nb]\n+1", "T[a\0b] +1"), ("'a\nb'!A1\n", "'a\0b'!A1 "), ('"a\tb"\t', '"a\tb" '),
    ],
)  # fmt: skip
def test_line_breaks_between_tokens_are_blanks(text, clean):
    assert without_line_breaks(text) == clean


@pytest.mark.parametrize(
    "text", ["5+A1", "  5%", "A1", "\nabc", "(A1)", "=1", "{1}", '"x"', "$A$1", "#REF!", "_x", ".5", ""]
)
def test_every_token_that_fits_is_among_those_that_may_stand_there(text):
    """Whatever matches at the start is among them, so that nothing is read in another way."""
    possible = tokens_at(text)
    assert {token for token in TOKENS if token._re.match(text)} <= set(possible)
    assert (len(possible) < len(TOKENS)) == text.strip().startswith(("5", "A", "a", "(", "=", "{"))
