"""Texts that INDIRECT reads: addresses in both styles, as trees in one line; nothing for other texts."""

from __future__ import annotations

import pytest

from xlmc.excel.address import Cell
from xlmc.excel.formula.indirect_text import read_a1, read_r1c1

HOST = Cell("S", 5, 4)
"""D5."""


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("A1", "A1"), ("a1", "A1"), ("$B$2", "$B$2"), ("A1:B2", "A1:B2"), ("A:B", "A:B"), ("2:3", "2:3"),
        ("Data!A1", "Data!A1"), ("'My data'!A1:B2", "My data!A1:B2"), ("A02", "A2"), ("A02:B003", "A2:B3"),
        ("$A$0012", "$A$12"), ("Data!A02", "Data!A2"), ("XFD01", "XFD1"), ("A10", "A10"), ("Rate", "<Rate>"),
        ("T[a]", 'T["a"]'),
    ],
)  # fmt: skip
def test_addresses(shown, text, tree):
    assert shown(read_a1(text)) == tree


@pytest.mark.parametrize("text", ["", "1+", "A1:", "!A1!", "a b c(", "'x"])
def test_texts_that_are_none(text):
    assert read_a1(text) is None


def test_names_with_zeros_stay_names(shown):
    """No column is called XFE: what looks like a cell there is a name."""
    assert shown(read_a1("XFE01")) == "<XFE01>"
    assert shown(read_a1("A0")) == "<A0>"


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("R1C2", "$B$1"), ("r1c2", "$B$1"), ("RC", "$D$5"), ("R[1]C[-1]", "$C$6"), ("R[-4]C", "$D$1"),
        ("RC2", "$B$5"), ("R2", "$2:$2"), ("R", "$5:$5"), ("C3", "$C:$C"), ("C[1]", "$E:$E"), ("C", "$D:$D"),
        ("R1C1:R[1]C[1]", "$A$1:$E$6"), ("R1:R3", "$1:$3"), ("C1:C[2]", "$A:$F"), (" R1C1 ", "$A$1"),
        ("Data!R1C1", "Data!$A$1"), ("'My data'!R1C1:R2C2", "My data!$A$1:$B$2"), ("'It''s'!R1C1", "It's!$A$1"),
        ("Rate", "<Rate>"), ("T[a]", 'T["a"]'),
    ],
)  # fmt: skip
def test_addresses_by_numbers(shown, text, tree):
    """A single cell is a range from itself to itself."""
    place = tree.rpartition("!")[2]
    assert shown(read_r1c1(text, HOST)) == (f"{tree}:{place}" if place[0] == "$" and ":" not in place else tree)


@pytest.mark.parametrize("text", ["", "A1", "R1C1:R2", "R1C1:C2", "R1:C2", "R1C1:R2C2:R3C3", "R[x]C1", "1+1", "B2:C3"])
def test_texts_that_are_none_by_numbers(text):
    assert read_r1c1(text, HOST) is None
