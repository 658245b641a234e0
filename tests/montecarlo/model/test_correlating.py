from __future__ import annotations

import numpy as np
import pytest
from scipy import stats
from simulated import simulated

import xlmc.montecarlo.statistics as xs
from xlmc.analysis.results.record.definition_tables import correlations_met
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Copula, Correlation
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.model.correlating import copula_groups, correlated_groups, drawn_correlation, repair_notices
from xlmc.montecarlo.sampling.copula import GaussianCopula
from xlmc.montecarlo.sampling.draws import Draw
from xlmc.montecarlo.sampling.sampling_methods import METHODS

UNIT = {"low": 0, "high": 1}


DRAWS = {name: Draw(name, FAMILIES["Uniform"], (0.0, 1.0)) for name in "abcde"}


def row(first, second, value):
    return Correlation(first, second, value, Cell("C", 1, 1))


@pytest.mark.parametrize(
    ("pairs", "groups"),
    [
        ([], []),
        ([("a", "b")], [("a", "b")]),
        ([("d", "b")], [("b", "d")]),  # in the order in which they are drawn
        ([("a", "b"), ("c", "d")], [("a", "b"), ("c", "d")]),
        ([("a", "c"), ("c", "e"), ("b", "d")], [("a", "c", "e"), ("b", "d")]),
        ([("a", "b"), ("c", "d"), ("b", "c")], [("a", "b", "c", "d")]),
        ([("a", "elsewhere"), ("b", "c")], [("b", "c")]),  # an assumption that is not drawn
    ],
)
def test_groups_of_correlated_assumptions(pairs, groups):
    result = correlated_groups([row(*pair, 0.3) for pair in pairs], DRAWS)
    assert [group.names for group in result] == groups


def test_a_correlation_of_0_is_none():
    rows = [row("a", "b", 0.3), row("b", "c", 0), row("d", "e", 0)]
    assert [group.names for group in correlated_groups(rows, DRAWS)] == [("a", "b")]


CELLS = dict.fromkeys(("A1", "A2", "A3", "A4"), 1.0) | {"B1": "=A1+A2+A3+A4"}
GIVEN = {name: {"cell": name, **UNIT} for name in ("A1", "A2", "A3", "A4")}
CONTRADICTORY = {("A1", "A2"): 0.9, ("A3", "A2"): 0.9, ("A1", "A3"): -0.9}


def test_contradictory_correlations_are_repaired_and_told(book):
    model = book(CELLS, GIVEN, {"x": "B1"}, correlations=CONTRADICTORY)
    result = [drawn_correlation(model.groups, *pair) for pair in CONTRADICTORY]
    assert result == pytest.approx([0.4826, 0.4826, -0.4826], abs=1e-4)
    [notice] = [each for each in model.notices if "correlations" in each.message]
    assert str(notice.where) == "Correlations!A1"
    assert "the largest change is 0.42: " in notice.message
    assert "'A1' and 'A2' 0.9 → 0.483 (Correlations!A1)" in notice.message
    assert "'A1' and 'A3' -0.9 → -0.483 (Correlations!A1)" in notice.message


def test_pairs_in_no_row_count_as_0_and_the_notice_says_so(book):
    model = book(CELLS, GIVEN, {"x": "B1"}, correlations={("A1", "A2"): 0.9, ("A2", "A3"): 0.9})
    [notice] = repair_notices(model.groups, model.definitions.correlations)
    between = drawn_correlation(model.groups, "A1", "A3")
    assert between > 0.1
    assert f"'A1' and 'A3' 0 → {between:.3f} (in no row, which counts as 0)" in notice.message
    assert drawn_correlation(model.groups, "A1", "A4") is None


def test_what_is_possible_is_no_news(book):
    possible = {("A1", "A2"): 0.6, ("A2", "A3"): 0.6, ("A3", "A4"): 1.0, ("A2", "A4"): 0.6}
    model = book(CELLS, GIVEN, {"x": "B1"}, correlations=possible)
    assert not list(repair_notices(model.groups, model.definitions.correlations))


def test_correlated_draws(book):
    given = {name: {"cell": name, **UNIT} for name in ("A1", "A2")}
    model = book({"A1": 1.0, "A2": 1.0, "B1": "=A1+A2"}, given, {"x": "B1"}, correlations={("A1", "A2"): 0.8})
    draws = model.sampler(1, 20_000).draw(0)
    ranks = [np.argsort(np.argsort(draws[name])) for name in ("A1", "A2")]
    assert abs(np.corrcoef(ranks)[0, 1] - 0.8) < 4 * (1 - 0.8**2) * np.sqrt((1 + 0.8**2 / 2) / 20_000)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("correlations", [CONTRADICTORY, {("A1", "A2"): 0.8, ("A3", "A4"): -1.0, ("A2", "A3"): 0.3}])
def test_unfiltered_runs_have_the_correlations_and_the_margins(book, method, correlations):
    """Spearman's matrix within family-wise 99.9 % limits of the target: 6 pairs of independent trials, whose errors no
    method exceeds; margins by Kolmogorov and Smirnov at 99.9 % for each of the 4 (family-wise 99.6 %)."""
    model = book(CELLS, GIVEN, {"x": "B1"}, correlations=correlations)
    run = simulated(model, 10_000, 11, sampling=method)
    n, names = run.accepted, list(GIVEN)
    seen = np.corrcoef(stats.rankdata([run.inputs[name] for name in names], axis=1))
    z = stats.norm.isf(0.001 / 6 / 2)
    for i, first in enumerate(names):
        for j, second in enumerate(names[:i]):
            target = drawn_correlation(model.groups, first, second) or 0.0
            error = (1 - target**2) * np.sqrt((1 + target**2 / 2) / (n - 3))
            assert abs(seen[i, j] - target) <= z * error + 1e-9
    for values in run.inputs.values():
        assert stats.kstest(values, "uniform", method="asymp").statistic < 1.95 / np.sqrt(n)


@pytest.mark.parametrize("method", ["mc", "lhs", "sobol"])
def test_with_filters_the_accepted_correlation_stands_beside_the_target(book, method):
    """Two uniforms whose sum is above 1.2: what was correlated by 0.3 is by -0.24."""
    cells = {"A1": 1.0, "A2": 1.0, "B1": "=A1+A2"}
    given = {name: GIVEN[name] for name in ("A1", "A2")}
    model = book(cells, given, {"x": "B1"}, {"f": {"cell": "B1", "above": 1.2}}, {("A1", "A2"): 0.3})
    run = simulated(model, 20_000, 1, sampling=method)
    [met] = correlations_met(run)
    assert (met.asked, met.used) == (0.3, pytest.approx(0.3))
    assert met.accepted.value == pytest.approx(stats.spearmanr(run.inputs["A1"], run.inputs["A2"]).statistic)
    assert met.accepted.value == pytest.approx(-0.24, abs=0.06)
    assert 0.0005 < met.accepted.error < 0.03
    assert (met.accepted == xs.rank_correlation(run.inputs["A1"], run.inputs["A2"])) is (method == "mc")


MIXED = {"A1": {"cell": "A1", **UNIT}, "A2": {"cell": "A2", "distribution": "Yes-No", "probability": 0.1}}


@pytest.mark.parametrize("method", METHODS)
def test_a_yes_no_has_the_correlation_asked_for_where_it_can(book, method):
    model = book({"A1": 1.0, "A2": 1.0, "B1": "=A1+A2"}, MIXED, {"x": "B1"}, correlations={("A1", "A2"): 0.4})
    [met] = correlations_met(simulated(model, 40_000, 3, sampling=method))
    assert met.used == pytest.approx(0.4, abs=1e-9)
    assert met.accepted.value == pytest.approx(0.4, abs=4 * 1.2 / np.sqrt(40_000))
    assert not [each for each in model.notices if "rank correlation" in each.message]


def test_a_correlation_out_of_reach_is_named_with_what_is_attainable(book):
    model = book({"A1": 1.0, "A2": 1.0, "B1": "=A1+A2"}, MIXED, {"x": "B1"}, correlations={("A1", "A2"): 0.9})
    [notice] = [each for each in model.notices if "rank correlation" in each.message]
    assert "'A1' and 'A2' cannot have the rank correlation 0.9" in notice.message
    assert "0.52 is the most that any two can have" in notice.message
    [met] = correlations_met(simulated(model, 40_000, 3))
    assert met.used == pytest.approx(0.5196, abs=1e-4)
    assert met.accepted.value == pytest.approx(0.52, abs=0.01)


def test_a_rare_yes_no_is_named_too(book):
    given = {**MIXED, "A2": {"cell": "A2", "distribution": "Yes-No", "probability": 0.0001}}
    model = book({"A1": 1.0, "A2": 1.0, "B1": "=A1+A2"}, given, {"x": "B1"}, correlations={("A1", "A2"): 0.9})
    [notice] = [each for each in model.notices if "rank correlation" in each.message]
    assert "0.0173 is the most that any two can have; they are drawn with that" in notice.message


def test_what_is_drawn_beside_other_correlations_is_said_and_why(book):
    """Both alone are attainable; it is the copula that cannot join them to two that have none between them."""
    given = {**MIXED, "A3": {"cell": "A3", **UNIT}}
    asked = {("A1", "A2"): 0.9, ("A2", "A3"): 0.5}
    model = book({"A1": 1.0, "A2": 1.0, "A3": 1.0, "B1": "=A1+A2+A3"}, given, {"x": "B1"}, correlations=asked)
    first, second = [each.message for each in model.notices if "orrelation" in each.message]
    drawn = drawn_correlation(model.groups, "A1", "A2")
    assert drawn < 0.5
    assert f"they are drawn with {drawn:.3g}, for the other correlations leave no more" in first
    assert "cannot all be drawn at once in the one way that xlmc has, a Gaussian copula" in second


def test_what_varying_parameters_leave_open_is_said(book):
    given = {**MIXED, "A2": {"cell": "A2", "distribution": "Yes-No", "probability": "A3"}, "A3": {"cell": "A3", **UNIT}}
    cells = {"A1": 1.0, "A2": 1.0, "A3": 0.5, "B1": "=A1+A2"}
    model = book(cells, given, {"x": "B1"}, correlations={("A1", "A2"): 0.4})
    [notice] = [each for each in model.notices if "rank correlation" in each.message]
    assert "the parameters vary from trial to trial" in notice.message


def test_continuous_assumptions_keep_their_draws_to_the_bit(book):
    model = book(CELLS, GIVEN, {"x": "B1"}, correlations={("A1", "A2"): 0.8, ("A2", "A3"): 0.3})
    draws = model.sampler(5, 1000).draw(0)
    matrix = np.array([[1.0, 0.8, 0.0], [0.8, 1.0, 0.3], [0.0, 0.3, 1.0]])
    free = book(CELLS, GIVEN, {"x": "B1"}).sampler(5, 1000).draw(0)
    u = np.array([free[name] for name in ("A1", "A2", "A3")])
    GaussianCopula(matrix).join(u)
    assert (np.array([draws[name] for name in ("A1", "A2", "A3")]) == u).all()


def test_the_matrix_of_a_gaussian_copula_correlates_the_normal_scores():
    """Their correlation in 20,000 trials; its standard error is (1 - r²)/√n."""
    copula = Copula("Gaussian", ("a", "b"), Cell("C", 1, 1), matrix=((1.0, 0.6), (0.6, 1.0)))
    (group,) = copula_groups([copula], DRAWS)
    u = np.random.default_rng(7).random((2, 20_000))
    group.copula.join(u)
    assert abs(np.corrcoef(stats.norm.ppf(u))[0, 1] - 0.6) < 4 * (1 - 0.6**2) / np.sqrt(20_000)
