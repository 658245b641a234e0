from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.financial.annuities import growth
from xlmc.excel.functions.values import Value

NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

EXACT = [
    ("FV", (0.01, 10, 100), -1046.2212541120473),
    ("FV", (0, 0, 0), 0),
    ("FV", (0, 12, -100, -1000, 1), 2200),
    ("FV", (0.06 / 12, 10, -200, -500, 1), 2581.4033740601),
    ("FV", (-1, 10, 100, 5), -100),
    ("FV", (-2, 3, 0, 100), 100),
    ("FV", (-2, 2.5, 0, 100), NUM),
    ("FV", (0.01, 10, "x"), VALUE),
    ("FV", (NA, "x", 0), NA),
    ("PV", (0.1, 10, True), -6.144567105704685),
    ("PV", (0, 12, 500), -6000),
    ("PV", (-1, 10, 100), NUM),
    ("PMT", (0.08 / 12, 10, 10000), -1037.0320893591522),
    ("PMT", (0.06 / 12, 18 * 12, 0, 50000), -129.08116086799092),
    ("PMT", ("0.01", "12", "200", "-300", True), 5.82661274042987),
    ("PMT", (0.01, 12, 200, -300, "TRUE"), VALUE),
    ("PMT", (0, 10, 1000), -100),
    ("PMT", (0.01, 0, 1000), NUM),
    ("NPER", (0.01, 1, 10), -9.578594039813161),
    ("NPER", (0.01, "100", "1000", -2000, True), 8.669093074120488),
    ("NPER", (0.05, 10, 100, -200, None), 5.896312860369899),
    ("NPER", (0, -100, 1000), 10),
    ("NPER", (0, 0, 1000), NUM),
    ("NPER", (12, 4500, 100000, 100000), NUM),
    ("NPER", (-1, 10, 100), NUM),
    ("RATE", (58, -200, 8000), 0.013541257643259374),
    ("RATE", (0, -200, 8000), NUM),
    ("RATE", (10, 100, 100), NUM),
    ("RATE", (100, 0, 1000), NUM),
    ("RATE", (100, 0, -1000, 2000), 2**0.01 - 1),
    ("RATE", (2, 10, 0, -21), 0.1),
    ("RATE", (2, 10, 0, -23.1, True, "0.2"), 0.1),
    ("IPMT", (0.1, 3, 3, 8000), -292.4471299093658),
    ("IPMT", (0.1, 1, 3, 8000, 0, 1), 0),
    ("IPMT", (0.1, 4, 3, 8000), NUM),
    ("IPMT", (0.1, 0.9, 3, 8000), NUM),
    ("IPMT", (0, 2, 3, 8000), 0),
    ("PPMT", (0.08, 10, 10, 200000), -27598.0534624214),
    ("PPMT", (0.08, 11, 10, 200000), NUM),
    ("ISPMT", (0.1 / 12, 1, 36, 8000000), -64814.8148148148),
    ("ISPMT", (0.1, 0, 3, 8000000), -800000),
    ("ISPMT", (0.1, 1, 0, 100), NUM),
    ("CUMIPMT", (0.09 / 12, 360, 125000, 13, 24, 0), -11135.2321307508),
    ("CUMIPMT", (0.09 / 12, 360, 125000, 1, 1, 0), -937.5),
    ("CUMIPMT", (0.09 / 12, 360, 125000, 1, 1, 1), 0),
    ("CUMPRINC", (0.09 / 12, 360, 125000, 13, 24, 0), -934.107123420868),
    ("CUMPRINC", (0.09 / 12, 360, 125000, 1, 1, 0), -68.2782711809784),
    ("CUMPRINC", (0.01, 12, 100, 1, 12, 0), -100),
    ("CUMPRINC", (0.01, 12, 100, 1, 13, 0), NUM),
    ("CUMPRINC", (0.01, 12, 100, 3, 2, 0), NUM),
    ("CUMPRINC", (0.01, 12, 100, 0, 2, 0), NUM),
    ("CUMPRINC", (0, 12, 100, 1, 2, 0), NUM),
    ("CUMPRINC", (0.01, 12, 100, 1, 2, 2), NUM),
    ("CUMPRINC", (0.01, 12, True, 1, 2, 0), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), EXACT)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-12)


rates = st.floats(-0.3, 0.5).filter(lambda rate: rate == 0 or abs(rate) > 1e-6)
amounts = st.floats(-1e4, 1e4)


@given(rates, st.floats(1, 40), amounts, amounts, st.booleans())
def test_what_is_paid_grows_to_what_is_owed(rate, nper, pv, fv, due):
    """The payment solves the equation of the module, written out with powers."""
    call = function_named("PMT")
    pmt = call([Value.of_numbers(np.array([x])) for x in (rate, nper, pv, fv, float(due))]).numbers[0]
    grown = (1 + rate) ** nper
    paid = nper if rate == 0 else (grown - 1) / rate
    assert pv * grown + pmt * (1 + rate * due) * paid + fv == pytest.approx(
        0, abs=1e-6 * (1 + abs(fv) + abs(pv) * grown)
    )


@given(st.floats(-0.5, 1.0), st.integers(1, 60), st.floats(10, 1000), st.booleans())
def test_the_rate_of_a_loan_is_found_again(evaluate, rate, nper, pv, due):
    if abs(rate) < 1e-6:
        return
    pmt = evaluate("PMT", rate, float(nper), pv, 0.0, float(due))
    if nper == 1 and due:
        return  # paid back at once: any rate will do
    assert evaluate("RATE", float(nper), pmt, pv, 0.0, float(due)) == pytest.approx(rate, rel=1e-8, abs=1e-9)


@given(st.floats(0.001, 0.3), st.integers(2, 40), st.floats(1, 1e5), st.data())
def test_parts_of_payments_add_up(evaluate, rate, nper, pv, data):
    due = float(data.draw(st.booleans()))
    first = data.draw(st.integers(1, nper))
    last = data.draw(st.integers(first, nper))
    periods = range(first, last + 1)
    interest = [evaluate("IPMT", rate, float(per), float(nper), pv, 0.0, due) for per in periods]
    principal = [evaluate("PPMT", rate, float(per), float(nper), pv, 0.0, due) for per in periods]
    pmt = evaluate("PMT", rate, float(nper), pv, 0.0, due)
    assert [i + p for i, p in zip(interest, principal, strict=True)] == pytest.approx([pmt] * len(periods))
    arguments = (rate, float(nper), pv, float(first), float(last), due)
    assert evaluate("CUMIPMT", *arguments) == pytest.approx(sum(interest), rel=1e-9, abs=1e-9 * pv)
    assert evaluate("CUMPRINC", *arguments) == pytest.approx(sum(principal), rel=1e-9, abs=1e-9 * pv)


def test_small_rates_keep_their_digits(evaluate):
    """100·(1 + 11/2·rate + …): the next term is below the last digit."""
    assert evaluate("FV", 1e-10, 12.0, -100.0) == pytest.approx(1200 * (1 + 5.5e-10), rel=1e-15)


def test_growth_takes_whole_periods_at_rates_below_a_total_loss():
    with np.errstate(invalid="ignore"):
        assert growth(np.array([-3.0, -3.0]), np.array([2.0, 0.5])) == pytest.approx([4.0, np.nan], nan_ok=True)


def test_a_rate_may_be_nothing(evaluate):
    assert evaluate("RATE", 10.0, -100.0, 1000.0) == pytest.approx(0, abs=1e-15)


NUM_OF_INTEREST, VALUE_OF_INTEREST, DIV0, NA_OF_INTEREST = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.DIV0, ErrorCode.NA

VALUES = [
    ("EFFECT", (0.0525, 4), 0.0535426673707584),
    ("EFFECT", (0.0525, 4.9), 0.0535426673707584),
    ("EFFECT", (0, 4), NUM_OF_INTEREST),
    ("EFFECT", (0.05, 0.5), NUM_OF_INTEREST),
    ("EFFECT", (True, 4), VALUE_OF_INTEREST),
    ("NOMINAL", (0.053543, 4), 0.0525003198683558),
    ("NOMINAL", (-0.05, 4), NUM_OF_INTEREST),
    ("RRI", (96, 10000, 11000), 0.000993307376291),
    ("RRI", (96, 10000, 0), -1),
    ("RRI", (1, -100, -110), 0.1),
    ("RRI", (0, 10000, 11000), NUM_OF_INTEREST),
    ("RRI", (96, 0, 11000), NUM_OF_INTEREST),
    ("RRI", (96, -1, 11000), NUM_OF_INTEREST),
    ("PDURATION", (0.025, 2000, 2200), 3.85986616262266),
    ("PDURATION", (0.025 / 12, 1000, 1200), 87.6054764193714),
    ("PDURATION", (0, 2000, 2200), NUM_OF_INTEREST),
    ("PDURATION", (0.025, 0, 2200), NUM_OF_INTEREST),
    ("FVSCHEDULE", (1, [[0.09, 0.11, 0.1]]), 1.33089),
    ("FVSCHEDULE", (1, [[0.09, None, 0.1]]), 1.199),
    ("FVSCHEDULE", (1, [[0.09, "x", NA_OF_INTEREST]]), VALUE_OF_INTEREST),
    ("FVSCHEDULE", (1, [[0.09, NA_OF_INTEREST, True]]), NA_OF_INTEREST),
    ("FVSCHEDULE", ("x", [[NA_OF_INTEREST]]), VALUE_OF_INTEREST),
    ("FVSCHEDULE", (200, 0.5), 300),
    ("DOLLARDE", (1.02, 16), 1.125),
    ("DOLLARDE", (1.1, 32), 1.3125),
    ("DOLLARDE", (-1.1, 32), -1.3125),
    ("DOLLARDE", (1.1, 10), 1.1),
    ("DOLLARDE", (1.1, 1), 1.1),
    ("DOLLARDE", (1.1, 0.5), DIV0),
    ("DOLLARDE", (1.1, -1), NUM_OF_INTEREST),
    ("DOLLARFR", (1.125, 16.5), 1.02),
    ("DOLLARFR", (1.125, 32), 1.04),
    ("DOLLARFR", (1.125, 1000), 1.125),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values_interest(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-12)


def test_a_schedule_of_the_trial_and_a_principal_of_many_cells():
    """(2, 1, 2) rates, and principals that are one, as many as the trials, or cells."""
    rates = Value.of_numbers(np.array([[[0.5, 0.0]], [[1.0, 1.0]]]))
    call = function_named("FVSCHEDULE")
    assert call([Value.of_numbers(np.array([2.0])), rates]).numbers.tolist() == [3.0, 8.0]
    assert call([Value.of_numbers(np.array([2.0, 4.0])), rates]).numbers.tolist() == [3.0, 16.0]
    assert call([Value.of_numbers(np.array([[[2.0, 4.0]]])), rates]).numbers.tolist() == [[[3.0, 6.0]], [[8.0, 16.0]]]
