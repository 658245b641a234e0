"""The bars of `method_advice.py --truth`, its committed result, and what it takes for the truth."""

from __future__ import annotations

import json
from types import SimpleNamespace

import numpy as np
import pytest
from known_books import KNOWN
from method_truth import (
    PAGE,
    RESULTS,
    Truth,
    misses,
    misstated,
    need_of_percentile,
    table,
    true_need,
    truth_of,
)
from scipy.special import ndtr, ndtri

BOOKS = {book.name: book for book in KNOWN}


def test_the_committed_result_meets_both_bars():
    records = json.loads(RESULTS.read_text(encoding="utf-8"))
    assert set(records) == set(BOOKS)
    assert misses(records) == []
    assert table(records) in PAGE.read_text(encoding="utf-8")


SOUND = {"stated": 1_000, "true": 1_000, "ratio": 1.0, "seconds": 1.0}


@pytest.mark.parametrize(
    ("changed", "recommended", "message"),
    [
        ({"ratio": 2.1, "stated": 2_100}, "mc", ["b: mc is said to need 2,100 trials, and needs 1,000"]),
        ({"ratio": 0.4, "stated": 400}, "mc", ["b: mc is said to need 400 trials, and needs 1,000"]),
        ({"seconds": 1.6}, "mc", ["b: mc is recommended, 1.6 s, where lhs takes 1 s"]),
        ({"seconds": 1.4}, "mc", []),
        ({}, None, ["b: nothing is recommended"]),
    ],
)
def test_what_misses_a_bar(changed, recommended, message):
    result = {"b": {"recommended": recommended, "needs": {"mc": {**SOUND, **changed}, "lhs": SOUND}}}
    assert misses(result) == message


def test_a_tenth_of_a_second_does_not_matter_and_other_methods_are_only_named():
    needs = {"mc": {**SOUND, "seconds": 0.1}, "lhs": {**SOUND, "ratio": 3.0, "stated": 3_000, "seconds": 0.01}}
    result = {"b": {"recommended": "mc", "needs": needs}}
    assert misses(result) == []
    assert misstated(result) == ["b: lhs is said to need 3,000 trials, and needs 1,000"]


def test_the_need_of_a_percentile_is_that_of_its_density():
    """c = √(p(1 − p))/f, n = (1.96 c/tolerance)²; beside a gap both counts decide, and no density is known."""
    q, tolerance = ndtri(0.245), 0.005
    ends = ndtr(q - tolerance), ndtr(q + tolerance)
    density = np.exp(-(q**2) / 2) / np.sqrt(2 * np.pi)
    expected = (1.959964 / tolerance) ** 2 * 0.245 * 0.755 / density**2
    assert need_of_percentile(0.245, *ends) == pytest.approx(expected, rel=0.01)


def test_the_truth_of_a_sum_of_normals():
    truth = truth_of(BOOKS["sum"])
    assert truth.numbers == pytest.approx((0.0, 2**0.5, 2**0.5 * ndtri(0.245), 2**0.5 * ndtri(0.755)), abs=1e-5)
    assert truth.tolerance == pytest.approx(0.02 * 2**0.5 * ndtri(0.95), rel=1e-5)


@pytest.mark.parametrize("stated", [300, 1_000, 5_000])
def test_the_true_need_is_found_wherever_the_search_begins(stated):
    """Errors of a normal with SD 1/√n, and a tolerance that 95 of 100 runs of 1,000 trials keep: found to 1/√200."""

    def run(_model, trials, seed):
        error = np.random.default_rng(seed + trials).normal() / trials**0.5
        return SimpleNamespace(answers={"y": SimpleNamespace(mean=error, sd=0.0, low=0.0, high=0.0)})

    truth = Truth((0.0, 0.0, 0.0, 0.0), 1.959964 / 1_000**0.5, 1.0)
    assert true_need(None, SimpleNamespace(run=run), stated, 128, truth) == pytest.approx(1_000, rel=0.35)
