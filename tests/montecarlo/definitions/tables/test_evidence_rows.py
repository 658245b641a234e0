from __future__ import annotations

import numpy as np
import pytest

from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.evidence import Bell, Within

HEADINGS = ["Name", "Cell", "Reading", "Error", "±", "Std dev", "Percent", "Resolution", "Source", "Use"]
SPEED = ("=Model!B1", 41.5)
TABLE = {"xlmc_evidence": "Answers!A40:J41"}


def rows(blocks, *given):
    return blocks("Answers!A40", [HEADINGS, *([*row, *[None] * (len(HEADINGS) - len(row))] for row in given)])


LAWS = [
    # Error, ±, Std dev, Percent, Resolution -> the law of a reading of 12
    ((None, 0.5), Within(12.0, 0.0, 0.5)),
    (("uniform", None, None, 25), Within(12.0, 0.0, 3.0)),
    (("Instrument", None, None, 10, 0.3), Within(12.0, 0.1, 0.3)),
    (("instrument", None, None, None, 0.3), Within(12.0, 0.0, 0.3)),
    (("Normal", None, 0.6), Bell(12.0, 0.6)),
    (("gaussian", None, None, 25), Bell(12.0, 3.0)),
    (("log-normal", None, 0.2), Bell(12.0, 0.2, logarithmic=True)),
    (("Lognormal", None, None, 20), Bell(12.0, 0.2, logarithmic=True)),
    (("At least",), Within(12.0, 0.0, 0.0, (True, False))),
    (("at most", 1), Within(12.0, 0.0, 1.0, (False, True))),
    (("at least", None, None, 10, 0.3), Within(12.0, 0.1, 0.3, (True, False))),
    (("at least", None, 0.5, None, None), Bell(12.0, 0.5, sides=(True, False))),
    (("at most", None, 0.5, None, None), Bell(12.0, 0.5, sides=(False, True))),
]


def test_each_error_has_its_law(read, blocks):
    for given, law in LAWS:
        error, *sizes = given
        row = ["y", SPEED, 12, error, *sizes, *[None] * (4 - len(sizes)), "tape"]
        result = read(rows(blocks, row), TABLE)
        assert result.problems == result.notices == (), given
        (item,), filter_ = result.evidence, result.filters[-1]
        assert item.law == law, given
        assert (filter_.name, filter_.cell, filter_.because) == ("y", Cell("Model", 1, 2), "tape")
        limits = (law.low, law.high) if isinstance(law, Within) else (None, None)
        assert (filter_.at_least, filter_.at_most) == limits, given


@pytest.mark.parametrize("reading", [12.0, 0.2, 0.0, -0.2, -12.0])
def test_the_limits_of_an_instrument_keep_what_lies_within_its_tolerance(reading):
    law, m = Within(reading, 0.1, 0.5), np.linspace(-20.0, 20.0, 4_001)
    kept = np.abs(reading - m) <= 0.1 * np.abs(m) + 0.5
    within = (m >= law.low) & (m <= law.high)
    near = np.minimum(np.abs(m - law.low), np.abs(m - law.high)) < 1e-9  # rounding decides there
    assert np.array_equal(kept[~near], within[~near])
    assert np.array_equal(law.beyond(m)[~near] == 0.0, within[~near])
    assert np.all(np.diff(law.reached(m)) <= 1e-12)


MISTAKES = [
    (["y", SPEED, "fast", None, 1], "Answers!C41", "Reading holds the text 'fast'", "Type a number"),
    (["y", SPEED, 12, "sure", 1], "Answers!D41", "There is no kind of error 'sure'", "Use one of Uniform"),
    (["y", SPEED, 12, "Nromal", None, 1], "Answers!D41", "There is no kind of error 'Nromal'", "Did you mean Normal?"),
    (["y", SPEED, 12], "Answers!A41", "The error Uniform of 'y' says nothing of its size", "Plus or minus"),
    (["y", SPEED, 12, None, 1, None, 10], "Answers!G41", "is given twice, by Plus or minus and Percent", "Fill in"),
    (["y", SPEED, 12, None, None, 1], "Answers!F41", "The error Uniform of 'y' takes no Std dev", "Plus or minus"),
    (["y", SPEED, 12, "Normal", 1], "Answers!E41", "The error Normal of 'y' takes no Plus or minus", "Std dev"),
    (["y", SPEED, 12, None, -1], "Answers!E41", "Plus or minus (-1) of 'y' is negative", "without a sign"),
    (["y", SPEED, 12, "Normal", None, 0], "Answers!A41", "The error of 'y' is 0: no reading is exact", "Std dev"),
    (["y", SPEED, 12, None, None, None, 0.1], "Answers!G41", "may be 0.1 % or 10 %", "Type 5 for 5 %"),
    (["y", SPEED, 12, "instrument", None, None, 100], "Answers!G41", "Percent (100) of 'y' must be below 100", "one-"),
    (["y", SPEED, -2, "lognormal", None, 0.2], "Answers!A41", "The reading of 'y' (-2) has no logarithm", "above 0"),
    (["y", ("=Inputs!A2", "Weight"), 12, None, 1], "Answers!A41", "holds 'Weight' and no formula", "Point Cell to"),
    (["y", ("=Model!Z9", 0.0), 12, None, 1], "Answers!A41", "Model!Z9 is blank", "what was measured is Reading"),
    (["y", SPEED, None, None, 1, *[None] * 4, True], "Answers!C41", "Use is on, and there is no reading", "Fill in"),
    (["y", SPEED, 12, None, 1, *[None] * 4, "maybe"], "Answers!J41", "neither TRUE nor FALSE", "Type TRUE"),
    (["e", SPEED, 12, None, 1], "Answers!A41", "'e' is the name of a filter, too (Answers!A11)", "each fact once"),
]


@pytest.mark.parametrize(("row", "where", "message", "hint"), MISTAKES)
def test_mistakes(only_problem, blocks, row, where, message, hint):
    only_problem(where, message, hint, rows(blocks, row), TABLE)


def test_a_row_that_is_off_or_has_no_reading_is_said_and_changes_nothing(read, blocks):
    off = ["a", SPEED, 12, "whatever", *[None] * 5, "off"]
    empty = ["b", SPEED, None, None, None, None, 10]
    result = read(rows(blocks, off, empty), {"xlmc_evidence": "Answers!A40:J42"})
    assert result.problems == ()
    assert [each.unused for each in result.evidence] == ["Use is off", "it has no reading"]
    assert [each.name for each in result.filters] == ["e", "Positive"]
    assert sorted(map(str, result.notices)) == [
        "Answers!A41: Evidence that is not used, because Use is off: 'a'",
        "Answers!A42: Evidence that is not used, because there is no reading: 'b'",
    ]


def test_two_items_may_be_about_one_cell_and_numbers_may_be_formulas(read, blocks):
    first = ["EDR", SPEED, ("=40+1", 41.0), "Normal", None, ("=1/2", 0.5), None, None, "EDR"]
    result = read(rows(blocks, first, ["Video", SPEED, 42, None, 2]), {"xlmc_evidence": "Answers!A40:J42"})
    assert result.problems == ()
    assert list(result.evidence[0].cells) == [Cell("Answers", 41, 3), Cell("Answers", 41, 6)]
    assert [str(notice) for notice in result.notices] == [
        "Answers!I42: The evidence 'Video' gives no Source, the first thing that a reader asks for"
    ]
