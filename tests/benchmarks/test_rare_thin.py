"""How rare_thin.py judges runs, and that its books have layers that are solved."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.rare.layered import Layered, search_space_of
from xlmc.montecarlo.rare.limit_state_function import LimitStateFunction


@pytest.fixture(scope="module")
def bench():
    import rare_thin

    return rare_thin


def test_the_bar_names_what_misses_it(bench):
    good = bench.Judged(runs=30, warned=0, held=29, wrong=0, width=0.01, work=2e6)
    seconds = dict.fromkeys(bench.THIN, 4.0)
    assert list(bench.faults(dict.fromkeys(bench.THIN, good), seconds)) == []
    bad = {"1e-5": good._replace(wrong=1), "ring": good._replace(held=0)}
    faults = list(bench.faults({**dict.fromkeys(bench.THIN, good), **bad}, {**seconds, "branch": 61.0}))
    assert [each.partition(":")[0] for each in faults] == [
        "1e-5",
        "branch",
        "of 330 runs without a warning 290 hold the truth",
    ]
    assert "| 30 | 0 | 97% | 0 | 2,000,000 | 4 |" in bench.table({"ring": good}, seconds)


def test_every_book_has_a_layer_that_is_solved(bench):
    for name, book in bench.THIN.items():
        model = book.model
        result = search_space_of(model, LimitStateFunction(model, np.random.default_rng(3)), np.random.default_rng(4))
        assert isinstance(result, Layered), name
        assert len(result.layers) == (2 if name == "two layers" else 1)
