"""A number with its error is one text, and two or four cells of a sheet."""

from __future__ import annotations

import math

import pytest

from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.statistics import Estimate, proportion
from xlmc.outputs.document.measured import Measured

HALF = proportion(500, 1_000)

CASES = [
    (Measured(Estimate(11.79921, 0.0132)), "11.799 ± 0.013"),
    (Measured(Estimate(11.79921, 0.0132), "change"), "+11.799 ± 0.013"),
    (Measured(Estimate(-11.79921, 0.0132), "change"), "-11.799 ± 0.013"),
    (Measured(Estimate(1e-9, 0.0132), "change"), "0.000 ± 0.013"),
    (Measured(HALF, "share"), "50.0 ± 1.6 %"),
    (Measured(proportion(0, 1_000), "share"), "0 %, at most 0.39 %"),
    (Measured(HALF, "points"), "+50.0 ± 1.6"),
    (Measured(Estimate(46_082.0, 1.25), form=Form(Kind.DATE)), "2026-03-01 ± 1.2 days"),
    (Measured(Estimate(3.5, 1.25), "spread", Form(Kind.DATE)), "3.5 ± 1.2 days"),
    (Measured(None, nothing="–"), "–"),
    (Measured(Estimate(math.nan), nothing="–"), "–"),
    (Measured(Estimate(math.nan), "change"), ""),
    (Measured(Estimate(2.0, 0.1), written="two"), "two"),
]


@pytest.mark.parametrize(("measured", "text"), CASES, ids=[text for _, text in CASES])
def test_it_is_written_as_what_it_measures(measured, text):
    assert measured.text == text


@pytest.mark.parametrize("what", ["number", "share", "spread", "change", "points"])
@pytest.mark.parametrize("result", [None, HALF, Estimate(math.nan), Estimate(1.0, 0.0), Estimate(0.3)])
def test_it_takes_as_many_cells_whatever_is_found(what, result):
    assert [len(Measured(result, what, interval=each).shown) for each in (False, True)] == [2, 4]


def test_its_cells_hold_the_full_numbers():
    low, high = HALF.interval
    assert [each.value for each in Measured(HALF, "share", interval=True).shown] == [0.5, HALF.error, low, high]
    assert [each.value for each in Measured(Estimate(1 / 3, 1 / 7), form=PLAIN).shown] == [1 / 3, 1 / 7]
