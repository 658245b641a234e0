"""Numbers as other programs write them, and the last digit that somebody edited."""

from __future__ import annotations

from decimal import Decimal

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from xlmc.outputs.replay.changes import Closeness, same_definition

NUMBERS = st.floats(1e-300, 1e300) | st.floats(-1e300, -1e-300)
REWRITTEN = Closeness(rewritten=True)


@given(NUMBERS, st.integers(15, 17))
def test_a_number_that_was_written_with_fewer_digits_is_the_same(number, digits):
    assert REWRITTEN.equal(float(format(number, f".{digits}g")), number)


@pytest.mark.parametrize(
    ("says", "gives"),
    [
        (17.3335655181604, 17.33356551816035),  # LibreOffice rounds the shortest decimal, half up
        (0.562869379900207, 0.5628693799002065),
        (0.30000000000000004, 0.1 + 0.2),
        (0.333333333333333, 1 / 3),
        (0.666666666666666, 2 / 3),  # cut off
        (5, 5.0),
    ],
)
def test_what_programs_write(says, gives):
    assert REWRITTEN.equal(says, gives)


@given(NUMBERS, st.sampled_from([-3, -2, 2, 3]))
def test_an_edited_fifteenth_digit_is_seen(number, by):
    shown = Decimal(format(number, ".14e"))
    edited = float(shown + by * Decimal(1).scaleb(shown.adjusted() - 14))
    assume(edited != number)
    assert not REWRITTEN.equal(edited, number)
    assert not Closeness().equal(edited, number)


@pytest.mark.parametrize(("says", "gives"), [(344.000000000001, 344.0), (0.25000000000001, 0.25), (1e-300, 0.0)])
def test_a_round_number_is_seen_to_be_edited(says, gives):
    assert not REWRITTEN.equal(says, gives)


@pytest.mark.parametrize(
    ("was", "now"),
    [
        ("Low 0.1, High 0.3", "Low 10 %, High 30 %"),
        ("Low 1000, High 1400", "Low $1,000, High $1,400"),
        ("at least -1200.5", "at least -1,200.50 €"),
        ("180000 (=Estimate!B2)", "180,000 (=Estimate!B2)"),
    ],
)
def test_a_definition_is_the_same_however_its_numbers_are_written(was, now):
    assert same_definition(was, now)


@pytest.mark.parametrize(
    ("was", "now"),
    [
        ("Low 0.1", "Low 1 %"),
        ("Low 1000", "Low 100"),
        ("at least 5", "at least -5"),
        ("at least 5", "above 5"),
        ("5 (=Estimate!B2)", "5 (=Estimate!B3)"),
        ("Low 01.03.2027", "Low 02.03.2027"),
        ("1e-05", "1e-06"),
    ],
)
def test_another_definition_is_seen(was, now):
    assert not same_definition(was, now)
