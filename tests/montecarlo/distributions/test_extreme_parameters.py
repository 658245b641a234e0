"""Parameters at the ends of what a number can be: the draws are finite, or the parameters are refused."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from simulated import simulated

from xlmc.errors import DefinitionError, SimulationError
from xlmc.montecarlo.distributions import FAMILIES, Truncated
from xlmc.montecarlo.distributions.base import TRIED_U
from xlmc.montecarlo.distributions.parameters import DataError
from xlmc.montecarlo.sampling.draws import Draw

NUMBERS = (
    *(0.0, 5e-324, 1e-308, 1e-300, 1e-150, 1e-10, 0.01, 0.05, 0.3, 1.0, 1.5, 2.0, 3.0, 7.0, 100.0, 1e6, 1e9, 1e17),
    *(1e100, 1e149, 1e150, -5e-324, -1e-308, -0.01, -1.0, -2.5, -1e17, -1e149, -1e150),
)
CUTOFFS = (-np.inf, -1.7e308, -1e300, -1e17, -1.0, 0.0, 5e-324, 0.5, 1.0, 2.0, 3.5, 1e9, 1e17, 1e300, 1.7e308, np.inf)
U = np.array([0.0, *TRIED_U, 0.25, 0.75])
COUNTS = {
    "Binomial": (0.3, 20.0),
    "Discrete Uniform": (2.0, 7.0),
    "Geometric": (0.25,),
    "Geomet": (0.25,),
    "Hypergeometric": (20.0, 10.0, 50.0),
    "Negative Binomial": (0.25, 3.0),
    "Negbin": (0.25, 3.0),
    "Poisson": (4.0,),
    "Yes-No": (0.25,),
}
REFUSED = [
    ("Student's t", (0.0, 1.0, 0.01), "Degrees of freedom (0.01) is too extreme"),
    ("Student's t", (0.0, 1.0, 5e-324), "Degrees of freedom (4.94065645841e-324) is too extreme"),
    ("Pareto", (1.0, 0.01), "Shape (0.01) is too extreme"),
    ("Exponential", (1e-308,), "Rate (1e-308) is too extreme"),
    ("Exponential", (5e-324,), "Rate (4.94065645841e-324) is too extreme"),
    ("Weibull", (0.0, 1.0, 0.001), "Shape (0.001) is too extreme"),
    ("Gamma", (0.0, 1.0, 5e-324), "Shape (4.94065645841e-324) is too extreme"),
    ("Lognormal", (0.0, 1e-308, 1e149), "Std dev (1e+149) is too extreme"),
]


@pytest.mark.parametrize("name", FAMILIES)
@settings(max_examples=24, deadline=None)
@given(data=st.data())
def test_what_is_not_refused_gives_finite_draws(name, data):
    family = _family(name, data)
    if family is None:
        return
    values = st.lists(st.sampled_from(NUMBERS), min_size=len(family.keys), max_size=len(family.keys))
    drawn = data.draw(values | values.map(sorted) | values.map(lambda result: [abs(each) for each in result]))
    lower, upper = sorted(data.draw(st.tuples(st.sampled_from(CUTOFFS), st.sampled_from(CUTOFFS))))
    with np.errstate(all="raise", under="ignore"):
        if family.fault(*drawn) is None:
            assert np.isfinite(family.ppf(U, *drawn)).all()
            family.mean(*drawn), family.variance(*drawn), family.cdf(U, *drawn), family.sf(U, *drawn)
        if family.keys:
            varying = family.ppf(U, *(np.full(U.shape, value) for value in drawn))
            assert not np.isinf(varying).any()
        cut = Truncated(family)
        if (family.data is None or family.data.truncates) and cut.fault(lower, upper, *drawn) is None:
            x = cut.ppf(U, lower, upper, *drawn)
            assert np.isfinite(x).all()
            assert np.all((lower <= x) & (x <= upper))


def _family(name, data):
    """The family, of data that are drawn where it needs them; None where these are refused."""
    family = FAMILIES[name]
    if family.data is None:
        return family
    columns = data.draw(st.sampled_from(family.data.columns or (1,)))
    row = st.lists(st.sampled_from((*NUMBERS, 1.7e308)), min_size=columns, max_size=columns)
    table = np.array(data.draw(st.lists(row, min_size=1, max_size=4).map(sorted)))
    if columns > 1:
        table[:, 1] = data.draw(st.sampled_from([np.abs(table[:, 1]), np.linspace(0.1, 0.9, len(table))]))
    try:
        return family.built(table)
    except DataError:
        return None


@pytest.mark.parametrize(("name", "params", "message"), REFUSED)
def test_draws_that_would_be_no_numbers_are_refused_with_the_parameter(name, params, message):
    fault = FAMILIES[name].fault(*params)
    assert fault is not None
    assert fault.message.startswith(message)
    assert fault.key in FAMILIES[name].keys


@pytest.mark.parametrize(("name", "params"), [(name, params) for name, params, _ in REFUSED])
def test_the_same_parameters_that_vary_by_trial_are_errors_of_the_trial(name, params):
    columns = [np.full(U.shape, value) for value in params]
    draws = U.copy()
    keys = tuple(range(len(params)))
    Draw("a", FAMILIES[name], keys).fill(draws, dict(zip(keys, columns, strict=True)))
    assert np.isnan(draws).any()
    assert not np.isinf(draws).any()


def test_cutoffs_at_both_ends_make_a_distribution_of_them():
    for name, params in (("Pareto", (1.0, 0.01)), ("Student's t", (0.0, 1.0, 0.01))):
        assert Truncated(FAMILIES[name]).fault(2.0, 50.0, *params) is None
        x = Truncated(FAMILIES[name]).ppf(U, 2.0, 50.0, *params)
        assert np.all((x >= 2.0) & (x <= 50.0))
    fault = Truncated(FAMILIES["Pareto"]).fault(2.0, np.inf, 1.0, 0.01)
    assert fault is not None
    assert "cutoffs at both ends" in fault.hint


@pytest.mark.parametrize("name", COUNTS)
@pytest.mark.parametrize("end", [1e17, 1e300, 1.7e308, np.inf])
def test_far_cutoffs_of_counts_change_no_draw(name, end):
    family, params = FAMILIES[name], COUNTS[name]
    inner = np.array([0.01, 0.25, 0.5, 0.75, 0.99])
    assert Truncated(family).fault(-end, end, *params) is None
    np.testing.assert_array_equal(Truncated(family).ppf(inner, -end, end, *params), family.ppf(inner, *params))


@pytest.mark.parametrize("name", COUNTS)
@pytest.mark.parametrize("cutoffs", [(1e17, np.inf), (1e300, 1.7e308), (-np.inf, -1e17), (-1.7e308, -1e300)])
def test_cutoffs_far_outside_of_counts_leave_nothing(name, cutoffs):
    fault = Truncated(FAMILIES[name]).fault(*cutoffs, *COUNTS[name])
    assert fault is not None
    assert "leaves nothing of the distribution" in fault.message


@pytest.mark.parametrize("bandwidth", [5e-324, 1e-308, 1e-301, 1e-17, 1e151, 1.7e308])
def test_a_bandwidth_that_smooths_nothing_or_everything_is_refused(bandwidth):
    with pytest.raises(DataError, match="Bandwidth"):
        FAMILIES["Empirical smoothed"].built(np.array([[1.0], [2.0], [4.0]]), bandwidth=bandwidth)


@pytest.mark.parametrize("values", [[1.0, 1.0 + 2e-16], [1e150, -1e150], [5e-324, 1e-323, 0.0], [1e17, 1e17 + 16]])
def test_measurements_at_the_ends_of_what_a_number_can_be_are_smoothed_or_refused(values):
    with np.errstate(all="raise", under="ignore"):
        try:
            family = FAMILIES["Empirical smoothed"].built(np.array([values]).T)
        except DataError:
            return
        assert np.isfinite(family.ppf(U)).all()
        assert np.isfinite(family.cdf(values)).all()


@pytest.mark.parametrize(("name", "params", "message"), REFUSED)
def test_a_book_with_them_is_refused(book, name, params, message):
    given_ = {"cell": "A1", "distribution": name, **dict(zip(FAMILIES[name].keys, params, strict=True))}
    with pytest.raises(DefinitionError, match=re.escape(message)) as refused:
        simulated(book({"A1": 1.0}, {"a": given_}, {"x": "A1"}), 100)
    assert refused.value.where is not None


def test_parameters_that_vary_count_the_draws_that_are_no_numbers(book):
    cells = {"A1": 1.0, "A2": 1.0, "B1": "=IF(A1<0.5,0.001,3)"}
    assumptions = {
        "a": {"cell": "A1", "low": 0, "high": 1},
        "b": {"cell": "A2", "distribution": "Pareto", "location": 1.0, "shape": "B1"},
    }
    run = simulated(book(cells, assumptions, {"x": "A2"}), 2000)
    assert run.invalid["b"] > 100
    assert run.accepted == 2000 - run.invalid["b"]
    assert np.isfinite(run.forecasts["x"]).all()
    assert run.error_trials == run.invalid["b"]


def test_a_fixed_draw_that_is_no_number_ends_the_run(book, monkeypatch):
    """Whatever a quantile function may do between the places where it was tried out."""
    pareto = FAMILIES["Pareto"]
    plain = type(pareto)._ppf

    def holed(self, u, *params):
        middle = (u > 0.4) & (u < 0.41)
        return np.where(middle, np.nan, plain(self, u, *params))

    monkeypatch.setattr(type(pareto), "_ppf", holed)
    given_ = {"cell": "A1", "distribution": "Pareto", "location": 1.0, "shape": 3.0}
    with pytest.raises(SimulationError, match="Pareto of the assumption 'a' gives draws that are not numbers"):
        simulated(book({"A1": 1.0}, {"a": given_}, {"x": "A1"}), 2000)
