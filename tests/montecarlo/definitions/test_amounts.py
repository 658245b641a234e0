"""Widths, shares, durations and whole numbers as people type them."""

from __future__ import annotations

import pytest

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.amounts import (
    as_confidence,
    as_numbers,
    as_seconds,
    as_tolerance,
    typed_whole_number,
)


@pytest.mark.parametrize(
    ("given", "result"),
    [
        ("1%", (0.01, True)),
        (" 1 % ", (0.01, True)),
        ("0.1", (0.1, False)),
        (2, (2.0, False)),
        ("1e-3", (1e-3, False)),
        ("250%", (2.5, True)),
    ],
)
def test_precisions(given, result):
    assert as_tolerance(given) == result


@pytest.mark.parametrize("given", ["0", "0%", "-1", "-1%", "inf", "nan", "", "%", "1 mph", "1%%"])
def test_what_is_no_precision(given):
    with pytest.raises(SimulationError, match="is not a precision"):
        as_tolerance(given)


@pytest.mark.parametrize(
    ("given", "result"),
    [
        ("mean", ("mean",)),
        (" Mean , SD,mean", ("mean", "sd")),
        ("p0.1,p99.9,range", ("p0.1", "p99.9", "range")),
        (["P5", "p95"], ("p5", "p95")),
    ],
)
def test_numbers_whose_precision_counts(given, result):
    assert as_numbers(given) == result


@pytest.mark.parametrize("given", ["", "median", "p0", "p100", "p-5", "p5,", "sd mean", "pp5"])
def test_what_is_no_such_number(given):
    with pytest.raises(SimulationError, match="is not a number whose precision can be asked for"):
        as_numbers(given)


def test_at_least_one_is_named():
    with pytest.raises(SimulationError, match="No number was named"):
        as_numbers([])


@pytest.mark.parametrize(
    ("given", "result"),
    [("95%", 0.95), ("95", 0.95), (0.95, 0.95), ("0.5%", 0.005), (1, 0.01), (99.9, 0.999), ("0.999", 0.999)],
)
def test_confidences(given, result):
    assert as_confidence(given) == pytest.approx(result, rel=1e-15)


@pytest.mark.parametrize("given", ["0", "100", "100%", "-5", "0%", "high", "101", "nan"])
def test_what_is_no_confidence(given):
    with pytest.raises(SimulationError, match="is not a confidence level"):
        as_confidence(given)


@pytest.mark.parametrize(
    ("given", "result"),
    [
        ("60s", 60.0),
        ("5m", 300.0),
        ("5 min", 300.0),
        ("1h30m", 5400.0),
        ("1.5H", 5400.0),
        ("1h 2m 3.5s", 3723.5),
        ("90", 90.0),
        (0.5, 0.5),
        ("2h5s", 7205.0),
    ],
)
def test_durations(given, result):
    assert as_seconds(given) == result


@pytest.mark.parametrize("given", ["", "0", "0s", "-1", "1d", "5 m 1 h", "soon", "1h30m20s5"])
def test_what_is_no_duration(given):
    with pytest.raises(SimulationError, match="is not a length of time"):
        as_seconds(given)


@pytest.mark.parametrize(
    ("text", "result"),
    [
        ("7", 7),
        ("+7", 7),
        ("-7", -7),
        ("0", 0),
        ("1,234", 1234),
        ("1'234'567", 1_234_567),
        ("12 345", 12_345),
        ("123_456", 123_456),
        ("1,234_567", None),  # two kinds of marks
        ("1,23", None),
        ("1234,567", None),
        ("0,123", None),
        ("2e5", 200_000),
        ("2E+5", 200_000),
        ("1.5e0", None),
        ("1.5e1", 15),
        ("2e-1", None),
        ("200k", 200_000),
        ("200 K", 200_000),
        ("1.5m", 1_500_000),
        ("0.0005k", None),
        ("1.2345k", None),
        ("200.000", None),
        ("", None),
        ("many", None),
    ],
)
def test_whole_numbers(text, result):
    assert typed_whole_number(text) == result
