"""The kinds of distribution that the window offers, and the numbers that suit them."""

from __future__ import annotations

import math

import pytest
from scipy import stats

from xlmc.outputs.live.kinds import KINDS, in_kind, kinds_of


@pytest.fixture(scope="module")
def of(model_of):
    """`of(distribution, **parameters)`: the assumption."""

    def make(distribution, **given):
        inputs = {"x": {"cell": "A1", "distribution": distribution, **given}}
        model = model_of({"A1": 1.0, "A2": 4.0, "B1": "=A1"}, inputs, {"y": "B1"})
        return model.definitions.assumptions[0]

    return make


def test_its_own_kind_is_first(of):
    assert kinds_of(of("Normal", mean=1.0, std_dev=2.0)) == ("Normal", "Uniform", "Triangular", "BetaPERT", "Lognormal")
    assert kinds_of(of("Weibull", location=0.0, scale=1.0, shape=2.0)) == ("Weibull", *KINDS)


def test_none_where_a_cell_gives_a_parameter(of):
    x = of("Uniform", low=0.0, high="A2")
    assert kinds_of(x) == ()
    assert in_kind(x, "Normal") is x


def test_its_own_kind_and_unknown_ones_change_nothing(of):
    x = of("Uniform", low=0.0, high=1.0)
    assert in_kind(x, "Uniform") is x
    assert in_kind(x, "Weibull") is x


@pytest.mark.parametrize(
    ("distribution", "given", "kind", "numbers"),
    [
        ("Uniform", {"low": 1.0, "high": 4.0}, "Triangular", {"low": 1, "likeliest": 2.5, "high": 4}),
        ("Triangular", {"low": 1.0, "likeliest": 2.0, "high": 4.0}, "Uniform", {"low": 1, "high": 4}),
        ("Triangular", {"low": 1.0, "likeliest": 2.0, "high": 4.0}, "BetaPERT", {"low": 1, "likeliest": 2, "high": 4}),
        ("Uniform", {"low": 1.0, "high": 4.0}, "Normal", {"mean": 2.5, "std_dev": 0.866}),  # 3/√12, in steps of 0.001
        ("Uniform", {"low": 1.0, "high": 4.0}, "Lognormal", {"location": 0, "mean": 2.5, "std_dev": 0.866}),
        ("Uniform", {"low": -1.0, "high": 1.0}, "Lognormal", {"location": -3, "mean": 0, "std_dev": 0.577}),
        ("Uniform", {"low": 0.0, "high": 1.0}, "Lognormal", {"location": -1, "mean": 0.5, "std_dev": 0.289}),
        ("Uniform", {"low": 1000.0, "high": 5000.0}, "Normal", {"mean": 3000, "std_dev": 1155}),
        ("Uniform", {"low": 0.1, "high": 0.2}, "Normal", {"mean": 0.15, "std_dev": 0.0289}),  # in steps of 0.0001
        ("Uniform", {"low": 3.0, "high": 3.0}, "Triangular", {"low": 2.7, "likeliest": 3, "high": 3.3}),
        ("Uniform", {"low": 0.0, "high": 0.0}, "Triangular", {"low": -0.1, "likeliest": 0, "high": 0.1}),
        ("Uniform", {"low": 3.0, "high": 3.0}, "Normal", {"mean": 3, "std_dev": 0.15}),  # a quarter of the width
    ],
)
def test_numbers_that_suit_a_kind(of, distribution, given, kind, numbers):
    other = in_kind(of(distribution, **given), kind)
    assert other.distribution == kind
    width = 0.51 * 10 ** (math.floor(math.log10(max(given["high"] - given["low"], 0.2))) - 3)
    assert other.given == pytest.approx(numbers, abs=width)


def test_the_ends_of_a_normal_are_those_of_two_thousand_parts(of):
    ends = stats.norm(10, 2).ppf([0.5 / 2000, 1999.5 / 2000])
    given = in_kind(of("Normal", mean=10.0, std_dev=2.0), "Uniform").given
    assert [given["low"], given["high"]] == pytest.approx(ends, abs=0.0051)


def test_ends_cut_off_are_those_that_are_drawn(of):
    x = of("Uniform", low=0.0, high=10.0, lower_cutoff=4.0)
    given = in_kind(x, "Triangular").given
    assert given["low"] == pytest.approx(4 + 6 * 0.5 / 2000, abs=0.00051)
    assert given["likeliest"] == pytest.approx(7, abs=0.002)
    assert given["high"] == pytest.approx(10 - 6 * 0.5 / 2000, abs=0.00051)


def test_numbers_are_round(of):
    given = in_kind(of("Uniform", low=0.1, high=0.7), "Normal").given
    assert repr(given["mean"]) == "0.4"
    assert len(repr(given["std_dev"])) <= len("0.1732")
