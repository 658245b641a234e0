"""Books whose costs are known: y = a + w·b with `a` and `b` uniform on (0, 1), and the paper's case study.

Holding b at 1/2 leaves the mean and takes w²/12 from the variance: the SD falls from √((1 + w²)/12) to √(1/12).
"""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from xlmc.analysis.studies.comparison import Verdict, compare
from xlmc.analysis.studies.comparison.verdicts import undecided_text
from xlmc.analysis.studies.screening import screen
from xlmc.errors import SimulationError
from xlmc.montecarlo.model.model import CompiledModel

SIZE = {"trials": 20_000, "seed": 1}


@pytest.fixture
def weighted(book):
    """y = Σ w·x, each x uniform on (0, 1) with a base value of 1/2."""

    def make(weights, filters=None, more=None):
        cells = {f"A{row}": 0.5 for row in range(1, len(weights) + 1)}
        terms = [f"{weight!r}*A{row}" for row, weight in enumerate(weights.values(), start=1)]
        cells |= {"D1": "=" + "+".join(terms), **(more or {})}
        given = {name: {"cell": f"A{row}", "low": 0, "high": 1} for row, name in enumerate(weights, start=1)}
        return book(cells, given, {"y": "D1"}, filters or {})

    return make


def cost_of(result, name):
    return next(cost for cost in result.single if cost.names == (name,))


@pytest.mark.parametrize("weight", [0.1, 0.5, 1.0])
def test_the_cost_of_holding_an_assumption(weighted, weight):
    result = screen(weighted({"a": 1.0, "b": weight}), "0.05", **SIZE)
    change = cost_of(result, "b").forecasts["y"].standard_deviation.difference
    assert abs(change.value - (math.sqrt(1 / 12) - math.sqrt((1 + weight**2) / 12))) < 4 * change.error
    moved = cost_of(result, "b").forecasts["y"].mean.difference
    assert abs(moved.value) < 4 * moved.error
    assert moved.error == pytest.approx(weight * math.sqrt(1 / 12 / 20_000), rel=0.05)  # of b alone: a cancels


def test_what_is_not_needed_is_held_and_what_is_needed_is_not(weighted):
    result = screen(weighted({"a": 1.0, "b": 0.01}), **SIZE)
    assert result.joint.names == ("b",)
    assert cost_of(result, "a").judgement.verdict is Verdict.BEYOND
    assert [each.name for each in result.expected] == ["b", "a"]
    assert result.tolerances["y"] == (pytest.approx(0.1 * math.sqrt(1.0001 / 12), rel=0.02), False)


def test_many_small_ones_are_not_held_together_when_they_add_up(weighted):
    """Each b of weight 0.2 takes 0.006 from the SD of 0.34, all ten 0.05: about five fit into a tolerance of 0.03."""
    result = screen(weighted({"a": 1.0, **{f"b{i}": 0.2 for i in range(10)}}), "0.03", trials=10_000, seed=1)
    assert all(cost_of(result, f"b{i}").judgement.verdict is Verdict.WITHIN for i in range(10))
    assert 2 <= len(result.joint.names) <= 6
    assert result.joint.judgement.verdict is Verdict.WITHIN
    assert result.joint.size <= 1.0
    assert set(result.only_alone) | set(result.joint.names) == {f"b{i}" for i in range(10)}


def test_filters_that_decide_nothing_and_the_cells_that_only_they_need(weighted):
    more = {"E1": "=A2^2", "F1": "=E1+1", "G1": "=A1*2"}
    filters = {"idle": {"cell": "F1", "at_least": 0}, "half": {"cell": "G1", "above": 1}}
    result = screen(weighted({"a": 1.0, "b": 0.01}, filters, more), **SIZE)
    assert result.reduced.names == ("idle",)
    assert [str(cell) for cell in result.dropped] == ["S!E1", "S!F1"]
    assert result.cells == 4
    verdicts = {cost.names[0]: cost.judgement.verdict for cost in result.filters}
    assert verdicts == {"idle": Verdict.WITHIN, "half": Verdict.BEYOND}


def test_cells_that_only_held_assumptions_feed_do_not_vary(weighted):
    model = weighted({"a": 1.0, "b": 0.0}, {"kept": {"cell": "E1", "at_least": 0}}, {"E1": "=A2+A1", "F1": "=A2"})
    assert screen(model, **SIZE).constant == ()
    model = weighted({"a": 1.0, "b": 0.0}, {"half": {"cell": "E1", "above": 0.5}}, {"E1": "=A1+0*F1", "F1": "=A2^2"})
    result = screen(model, **SIZE)
    assert [str(cell) for cell in result.constant] == ["S!F1"]
    assert result.varying == 2


def test_a_change_of_the_acceptance_counts_too(weighted):
    """a + b > 1.5 with b held at 1/2 accepts none; y = a alone would hardly move."""
    model = weighted({"a": 1.0, "b": 0.0}, {"sum": {"cell": "E1", "above": 1.5}}, {"E1": "=A1+A2"})
    cost = cost_of(screen(model, "10", **SIZE), "b")
    assert cost.judgement.verdict is Verdict.BEYOND
    assert cost.judgement.largest == "acceptance"
    assert cost.acceptance.relative.value == -1.0


def test_nothing_can_be_held_and_nothing_is_there_to_be_held(weighted):
    assert screen(weighted({"a": 1.0, "b": 1.0}), **SIZE).joint is None
    assert screen(weighted({"a": 1.0}), **SIZE).joint is None


def cancelling(book, formula, correlations):
    """Normals in A1 to A4 with a base value of 0."""
    given = {
        name: {"cell": f"A{row}", "distribution": "Normal", "mean": 0, "std_dev": 1}
        for row, name in enumerate("abcd", start=1)
    }
    return book({**{f"A{row}": 0.0 for row in range(1, 5)}, "D1": formula}, given, {"y": "D1"}, None, correlations)


@pytest.mark.parametrize(
    ("formula", "correlations", "held"),
    [
        pytest.param("=A3+A1-A2+0*A4", {("a", "b"): 0.999}, {"a", "b", "d"}, id="two that cancel"),
        pytest.param("=A3+A1+A2+0*A4", {("a", "b"): -0.999}, {"a", "b", "d"}, id="two that cancel by their sign"),
        pytest.param(
            "=A3+2*A1-2*A2+A4",
            {("a", "b"): 0.998, ("a", "c"): 0.6, ("b", "c"): 0.6},
            {"a", "b"},
            id="two of three that are correlated",
        ),
        pytest.param(
            "=A4+A1-0.5*A2-0.5*A3",
            {("a", "b"): 0.998, ("a", "c"): 0.998, ("b", "c"): 0.998},
            {"a", "b", "c"},
            id="three that cancel",
        ),
        pytest.param("=A3+A1+A2+0*A4", {("a", "b"): 0.999}, {"d"}, id="two that add up"),
    ],
)
def test_correlated_assumptions_are_tried_together(book, formula, correlations, held):
    result = screen(cancelling(book, formula, correlations), **SIZE)
    assert set(result.joint.names) == held
    assert result.joint.judgement.verdict is Verdict.WITHIN
    assert not {"a", "b", "c"} & {cost.names[0] for cost in result.single if cost.judgement.verdict is Verdict.WITHIN}


def test_assumptions_without_strong_correlations_are_in_no_group(weighted):
    assert screen(weighted({"a": 1.0, "b": 1.0, "c": 0.01}), **SIZE).groups == ()


def test_sets_by_pattern(weighted):
    model = weighted({"a": 1.0, "b one": 0.1, "b two": 0.2, "c": 0.3})
    result = screen(model, sets=["B *", "c, b one"], **SIZE)
    assert [cost.names for cost in result.sets] == [("b one", "b two"), ("c", "b one")]
    with pytest.raises(SimulationError, match="No assumption that is drawn has the name 'd'"):
        screen(model, sets=["d"], **SIZE)


def test_an_assumption_without_a_base_value_is_named(book):
    given = {"a": {"cell": "A1", "low": 0, "high": 1}, "b": {"cell": "A2", "low": 0, "high": 1}}
    result = screen(book({"A1": 0.5, "D1": "=A1+A2"}, given, {"y": "D1"}), **SIZE)
    assert result.baseless == ("b",)
    assert [cost.names for cost in result.single] == [("a",)]


def test_correlated_assumptions_can_be_held(book):
    given = {name: {"cell": f"A{row}", "low": 0, "high": 1} for row, name in enumerate("abc", start=1)}
    model = book(
        {"A1": 0.5, "A2": 0.5, "A3": 0.5, "D1": "=A1+0.01*A2+0.01*A3"}, given, {"y": "D1"}, None, {("b", "c"): 0.5}
    )
    assert set(screen(model, **SIZE).joint.names) == {"b", "c"}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"acceptance_tolerance": 0.0}, "tolerance of the acceptance"),
        ({"tolerance": "soft"}, "cannot be read"),
    ],
)
def test_arguments_out_of_range(weighted, given, message):
    with pytest.raises(SimulationError, match=message):
        screen(weighted({"a": 1.0}), **given)


def test_a_book_that_accepts_nothing(weighted):
    with pytest.raises(SimulationError, match="too few to compare"):
        screen(weighted({"a": 1.0}, {"never": {"cell": "A1", "above": 2}}), **SIZE)


def test_the_model_stays_as_it_is(weighted):
    model = weighted({"a": 1.0, "b": 0.01})
    before = model.definitions
    screen(model, **SIZE)
    assert model.definitions is before
    assert not any(a.frozen for a in model.assumptions)


def test_the_trials_are_independent_whatever_the_book_says(weighted):
    model = weighted({"a": 1.0, "b": 0.01})
    settings = replace(model.definitions.settings, sampling="sobol")
    other = CompiledModel(model.workbook, replace(model.definitions, settings=settings), model.path)
    result, plain = screen(other, **SIZE), screen(model, **SIZE)
    assert result.run.settings.sampling == "mc"
    assert cost_of(result, "b").size == cost_of(plain, "b").size
    assert compare(other, other, **SIZE).second.settings.sampling == "mc"


TRIALS = 60_000
INERTIAS = {"Chevrolet yaw moment of inertia", "Nissan yaw moment of inertia"}


@pytest.fixture(scope="module")
def case(planar):
    sets = [
        "*inertia*",
        "*impact centre*, Orientation of tangent",
        "*inertia*, *impact centre*, Orientation of tangent",
    ]
    return screen(planar, "0.3 mph", sets=sets, trials=TRIALS)


def test_the_case_study_does_not_need_the_inertias(case):
    """Held at midpoint they change nothing to two decimals: to what 60,000 trials can tell."""
    assert set(case.joint.names) >= INERTIAS
    assert set(case.sets[0].names) == INERTIAS
    assert case.sets[0].judgement.verdict is Verdict.WITHIN
    for difference in case.sets[0].forecasts.values():
        for _, change in difference.changes:
            assert abs(change.difference.value) < 0.005 + 4 * change.difference.error
    assert abs(case.sets[0].acceptance.relative.value) < 0.005 + 4 * case.sets[0].acceptance.relative.error


def test_what_impact_centre_and_tangent_cost(case):
    """Held with the inertias they give V2 4.69 ± 1.86 mph (mean ± SD), where the book gives 4.742 ± 2.0005."""
    geometry = [name for name in case.sets[1].names if "impact centre" in name]
    assert len(geometry) == 4
    assert all(cost_of(case, name).acceptance.first.value == case.run.acceptance.value for name in geometry)
    result = case.sets[2].forecasts["Nissan impact speed"]
    for change, value in ((result.mean, 4.69), (result.standard_deviation, 1.86)):
        assert abs(change.second.value - value) < 0.005 + 4 * change.second.error
    change = result.standard_deviation.difference
    assert -0.3 + 3 * change.error < change.value < -3 * change.error  # the book needs them, but not by 0.3 mph
    assert case.sets[2].judgement.verdict is not Verdict.BEYOND


def test_what_the_case_study_needs(case):
    beyond = {cost.names[0] for cost in case.single if cost.judgement.verdict is Verdict.BEYOND}
    assert beyond == {
        "Chevrolet approach angle",
        "Chevrolet departure angle",
        "Chevrolet post-impact deceleration",
        "Nissan departure angle",
        "Nissan post-impact deceleration",
    }
    filters = {cost.names[0]: cost.judgement.verdict for cost in case.filters}
    assert filters["Restitution, normal"] is filters["Restitution, tangential"] is Verdict.BEYOND


def test_the_cheap_ranking_foretells_the_runs(case):
    """The five that the answer needs are ranked last."""
    last = {each.name for each in case.expected[-5:]}
    assert last == {cost.names[0] for cost in case.single if cost.judgement.verdict is Verdict.BEYOND}


def test_an_assumption_that_alone_decides_the_probability_is_needed(book):
    """In 3 of 100 trials y is moved by up to 4.5: mean, SD and range stay within 2, and P(y > 12) is theirs alone."""
    cells = {"A1": 0.5, "A2": 0.5, "A3": 0.5, "D1": "=10+A3+IF(A1>0.97,9*(A2-0.5),0)"}
    given = {
        "tail": {"cell": "A1", "low": 0, "high": 1},
        "switch": {"cell": "A2", "low": 0, "high": 1},
        "rest": {"cell": "A3", "low": 0, "high": 1},
    }
    model = book(cells, given, {"y": "D1"})
    above = replace(model.definitions.forecasts[0], threshold=12.0)
    asked = CompiledModel(model.workbook, replace(model.definitions, forecasts=(above,)), model.path)
    plain, honoured = (screen(one, "2", **SIZE) for one in (model, asked))
    assert {"switch", "tail"} <= set(plain.joint.names)
    assert not {"switch", "tail"} & set(honoured.joint.names if honoured.joint else ())
    cost = cost_of(honoured, "switch")
    assert cost.judgement.verdict is Verdict.BEYOND
    assert cost.judgement.largest == "y, P(> 12)"
    change = cost.forecasts["y"].above
    assert change.second.value == 0.0
    assert change.first.value == pytest.approx(0.03 * (0.5 - 1.5 / 9), abs=0.004)
    assert change.difference.error == pytest.approx(math.sqrt(change.first.value / 20_000), rel=0.05)
    loose = screen(asked, "2", chance=5, **SIZE)
    assert {"switch", "tail"} <= set(loose.joint.names)


def test_the_range_of_each_forecast_is_its_own(book):
    model = book({"A1": 0.5, "D1": "=A1"}, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"y": "D1"})
    wide = replace(model.definitions.forecasts[0], central=0.9)
    result = screen(
        CompiledModel(model.workbook, replace(model.definitions, forecasts=(wide,)), model.path), "0.1", **SIZE
    )
    each = cost_of(result, "a").forecasts["y"]
    assert each.share == 0.9
    assert each.low.first.value == pytest.approx(0.05, abs=0.01)


@pytest.mark.parametrize("chance", [0.0, -1.0, 100.0])
def test_a_tolerance_of_the_probability_out_of_its_range(weighted, chance):
    with pytest.raises(SimulationError, match="percentage points"):
        screen(weighted({"a": 1.0}), chance=chance, **SIZE)


def test_a_forecast_without_numbers_judges_nothing(book):
    """It is named; the others are judged without it. Where none has numbers there is nothing to say."""
    cells = {"A1": 0.5, "A2": 0.5, "B1": "=A1+A2/100", "B2": "=SQRT(-1-A1)"}
    given = {name: {"cell": cell, "low": 0, "high": 1} for name, cell in (("a", "A1"), ("b", "A2"))}
    result = screen(book(cells, given, {"y": "B1", "error": "B2"}), **SIZE)
    assert result.valueless == ("error",)
    assert [*result.tolerances] == ["y"]
    assert result.joint.names == ("b",)
    assert cost_of(result, "b").size < 1
    with pytest.raises(SimulationError, match="No forecast has an answer in two accepted trials"):
        screen(book(cells, given, {"error": "B2"}), **SIZE)


def test_why_a_change_is_undecided(book):
    """Held at its base value it is an error; two trials tell no error: neither is as large as the tolerance."""
    cells = {"A1": 0.5, "A2": 0.5, "B1": "=IF(A1=0.5,NA(),A1)+A2"}
    given = {name: {"cell": cell, "low": 0, "high": 1} for name, cell in (("a", "A1"), ("b", "A2"))}
    model = book(cells, given, {"y": "B1"})
    assert undecided_text(cost_of(screen(model, **SIZE), "a"), 20_000) == "a ('y' is then hardly ever a number)"
    few = screen(model, trials=2, seed=1).undecided
    assert {undecided_text(cost, 2).partition(" (")[2] for cost in few if not cost.lost} == {
        "too few trials are accepted)"
    }


def test_held_at_the_ends_of_a_range(weighted):
    """b of weight 0.1 may be held at 0.5; at 0.025 and 0.975 it moves the mean by 0.0475, beyond a tolerance of 0.02.

    c of weight 0.02 moves it by 0.0095.
    """
    result = screen(weighted({"a": 1.0, "b": 0.1, "c": 0.02}), "0.02", ends=True, **SIZE)
    free = {each.name: each.free for each in result.ends}
    assert free == {"b": False, "c": True}
    (b,) = [each for each in result.ends if each.name == "b"]
    for value, cost, sign in zip(b.values, b.costs, (-1, 1), strict=True):
        share = (1 + sign) / 2 * 0.95 + 0.025
        assert abs(value - share) < 4 * (share * (1 - share) / 20_000) ** 0.5
        moved = cost.forecasts["y"].mean.difference
        assert abs(moved.value - 0.1 * (value - 0.5)) < 4 * moved.error
    assert screen(weighted({"a": 1.0, "b": 0.1}), **SIZE).ends is None
