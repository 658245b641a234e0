"""How rare_regions.py judges runs, and that its books ask what their exact answers are of."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.rare.layered import search_space_of
from xlmc.montecarlo.rare.limit_state_function import LimitStateFunction
from xlmc.montecarlo.rare.unexplained import wide_assumptions


@pytest.fixture(scope="module")
def bench():
    import rare_regions

    return rare_regions


def test_a_run_is_wrong_in_silence_where_it_misses_by_three_half_widths(bench):
    near, far = bench.Run(1.0, 0.9, 1.1, False, 100), bench.Run(0.5, 0.49, 0.51, False, 300)
    warned = far._replace(warned=True)
    result = bench.judged([near, far, warned], 1.0)
    assert result == bench.Judged(runs=3, warned=1, held=1, wrong=1, width=pytest.approx(0.02), work=300.0)
    assert result.silent == 2


def test_the_bar_names_what_misses_it(bench):
    good = bench.Judged(200, 0, 190, 0, 0.01, 1e6)
    before = {"sum": good}
    assert list(bench.faults(dict.fromkeys(bench.BOOKS, good), before)) == []
    bad = {
        "switch": good._replace(wrong=1),
        "sum": good._replace(warned=7, width=0.016, work=2.1e6),
    }
    faults = list(bench.faults({**dict.fromkeys(bench.BOOKS, good), **bad}, before))
    assert len(faults) == 4
    assert "switch" in faults[0]


@pytest.mark.parametrize(
    ("name", "draws"),
    [
        ("speeds or weights", 50_000),
        ("larger of two", 50_000),
        ("1:10 uneven", 50_000),
        ("curved", 100_000),
        ("switch", 50_000),
        ("branch", 50_000),
        ("corner", 400_000),
    ],
)
def test_the_exact_answers_are_those_of_the_books(bench, name, draws):
    """Against draws from widened assumptions, weighted: 4.5 standard errors, which are below a third."""
    book, random = bench.BOOKS[name], np.random.default_rng(17)
    function = LimitStateFunction(book.model, random)
    spread = wide_assumptions(function.dimensions)
    points = spread.draw(draws, random)
    weights = np.exp(spread.log_weights(points)) * function.accepts(points)
    error = weights.std() / np.sqrt(weights.size)
    assert error < book.truth / 3
    assert abs(weights.mean() - book.truth) < 4.5 * error


def test_no_book_has_a_thin_layer_that_is_solved(bench):
    """What the search does well stays as it is."""
    random = np.random.default_rng(17)
    for book in bench.BOOKS.values():
        function = LimitStateFunction(book.model, random)
        assert search_space_of(book.model, function, random) is function
