from __future__ import annotations

from copy import deepcopy

import pytest
import witness
from committed_books import BOOKS


@pytest.fixture(scope="module")
def recorded():
    return witness.recorded()


def test_every_book_has_a_witness(recorded):
    runs = {" ".join(run) for run in witness.RUNS}
    assert list(recorded["books"]) == list(BOOKS)
    assert all(runs | {"parts"} == set(book) for book in recorded["books"].values())


@pytest.mark.parametrize(("name", "first"), [("yaw-mark", 0), ("collinear-head-on", 1)])
def test_a_book_gives_what_was_recorded(recorded, name, first):
    """Of the two books each has every other run, so that both engines and all sampling methods are seen.

    `python benchmarks/witness.py --record` writes the record anew where a change of numbers is meant.
    """
    bits = recorded["made on"] == witness.features()
    result = witness.witnessed(BOOKS[name], runs=witness.RUNS[first::2])
    assert ("parts" in result) == (first == 0)
    before = {of: recorded["books"][name][of] for of in result}
    assert list(witness.differences(before, result, bits=bits)) == []


def _changed(book, change):
    other = deepcopy(book)
    change(other)
    return other


@pytest.mark.parametrize(
    ("change", "to_the_bit", "about"),
    [
        (lambda book: book["numpy mc"].update(accepted=1), ["numpy mc: accepted"], ["numpy mc: accepted"]),
        (lambda book: book["jit sobol"].update(trials="0"), ["jit sobol: trials"], []),
        (lambda book: book["numpy lhs"].update(statistics="0"), ["numpy lhs: statistics"], []),
        (
            lambda book: book["parts"].update({"xl/charts/chart1.xml": "0"}),
            ["1 of 1 parts of the result workbook, first xl/charts/chart1.xml"],
            [],
        ),
        (lambda book: book.pop("parts"), ["parts: missing"], ["parts: missing"]),
        (
            lambda book: book["numpy mc"]["numbers"].update(x=[1.0, 2.0 + 1e-9]),
            ["numpy mc: x from [1.0, 2.0] to [1.0, 2.000000001]"],
            ["numpy mc: x from [1.0, 2.0] to [1.0, 2.000000001]"],
        ),
        (lambda book: book["numpy mc"]["numbers"].update(x=[1.0, 2.0 + 1e-13]), [], []),
        (lambda book: book["numpy mc"]["numbers"].update(y=[1.0]), ["numpy mc: forecasts"], ["numpy mc: forecasts"]),
    ],
)
def test_what_differs_is_named(change, to_the_bit, about):
    run = {"accepted": 2, "trials": "a", "statistics": "b", "numbers": {"x": [1.0, 2.0]}}
    book = {name: deepcopy(run) for name in ("numpy mc", "numpy lhs", "jit sobol")}
    book["parts"] = {"xl/charts/chart1.xml": "c"}
    assert list(witness.differences(book, _changed(book, change), bits=True)) == to_the_bit
    assert list(witness.differences(book, _changed(book, change), bits=False)) == about
