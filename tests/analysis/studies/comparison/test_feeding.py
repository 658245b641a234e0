"""Whether a book needs another one, whose answer would be its assumption."""

from __future__ import annotations

import openpyxl
import pytest
from openpyxl.worksheet.table import Table
from simulated import simulated

from xlmc.analysis.studies.comparison import Verdict, compare
from xlmc.analysis.studies.comparison.feeding import fed_model
from xlmc.analysis.studies.comparison.verdicts import verdict_text
from xlmc.errors import SimulationError
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.simulation.simulate import simulate

SIZE = {"trials": 20_000, "seed": 1}


def test_draws_come_from_what_the_other_book_answers_in_the_unit_of_the_first(answering):
    mine, other = answering("a", 0, 100, "km/h"), answering("b", 9, 11, "m/s", shift=1.0)
    result = compare(mine, other, "1 km/h", feeds={"A": "y"}, **SIZE)
    (each,) = result.forecasts
    assert result.runs == 3
    assert result.source.model.path.name == "b.xlsx"
    for number, expected in ((each.difference.mean, 39.6), (each.difference.standard_deviation, 7.2 * 12**-0.5)):
        # the second is drawn from 20,000 trials, which have an error of their own
        assert abs(number.second.value - expected) < 4 * 2**0.5 * number.second.error
    assert each.judgement.verdict is Verdict.BEYOND
    assert verdict_text(result)[0].startswith("a.xlsx without b.xlsx is not enough for y to 1 km/h: the upper end")


def test_time_and_distance_need_no_model_of_the_impact_where_every_speed_gives_one_answer(filled_in, momentum):
    """At 25 mph the driver stops in time, whatever the speed at the impact was; the speed before braking needs it."""
    rough = filled_in("time-distance", {"v_impact": (25, 45), "limit": 25})
    result = compare(rough, momentum, feeds={"Vehicle speed at the impact": "Chevrolet impact speed"}, **SIZE)
    verdicts = {each.first.name: each.judgement.verdict for each in result.forecasts}
    assert verdicts["Same driver: avoided, at most (1 = yes)"] is Verdict.WITHIN
    assert verdicts["Vehicle speed before braking"] is Verdict.BEYOND
    assert "time-distance.xlsx without intersection-momentum.xlsx is enough for " in verdict_text(result)[0]


@pytest.mark.parametrize(
    ("feeds", "units", "message"),
    [
        ({"x": "y"}, "mph", "There is no assumption 'x'"),
        ({"a": "x"}, "mph", "There is no forecast 'x'"),
        ({"a": "y"}, "deg", "have the units 'mph' and 'deg'"),
    ],
)
def test_what_cannot_be_fed_is_refused(answering, feeds, units, message):
    with pytest.raises(SimulationError, match=message):
        compare(answering("a", 0, 1, "mph"), answering("b", 0, 1, units), feeds=feeds, **SIZE)


def test_a_draw_that_its_formula_may_shift_is_refused(answering, tmp_path):
    book = openpyxl.Workbook()
    book.active["A1"], book.active["A2"] = '=RiskNormal(5,1,RiskShift(3),RiskName("a"))', '=A1+RiskOutput("y")'
    book.save(tmp_path / "shifted.xlsx")
    with pytest.raises(SimulationError, match="drawn by a call in a formula") as refused:
        compare(load(tmp_path / "shifted.xlsx"), answering("b", 0, 1), feeds={"a": "y"}, **SIZE)
    assert str(refused.value.where) == "Sheet!A1"


@pytest.fixture
def joint(tmp_path):
    """`joint("a", "=v-w", correlations)`: a book of v and w from 0 to 1, and z, with one answer for each formula."""

    def make(name, *formulas, correlations=()):
        book = openpyxl.Workbook()
        sheet = book.active
        for row in (["Name", "Value", "Low", "High"], *([each, 0.5, 0, 1] for each in "vwz")):
            sheet.append(row)
        for column, (heading, values) in enumerate(
            (("Name", [f"y{number}" for number in range(len(formulas))]), ("Value", formulas)), start=6
        ):
            for row, value in enumerate((heading, *values), start=1):
                sheet.cell(row, column, value)
        sheet.add_table(Table(displayName="xlmc_assumptions", ref="A1:D4"))
        sheet.add_table(Table(displayName="xlmc_forecasts", ref=f"F1:G{1 + len(formulas)}"))
        for row, each in enumerate(correlations, start=11):
            for column, value in enumerate(each, start=1):
                sheet.cell(row, column, value)
        if correlations:
            for column, heading in enumerate(("First", "Second", "Correlation"), start=1):
                sheet.cell(10, column, heading)
            sheet.add_table(Table(displayName="xlmc_correlations", ref=f"A10:C{10 + len(correlations)}"))
        book.save(tmp_path / f"{name}.xlsx")
        return load(tmp_path / f"{name}.xlsx")

    return make


def test_several_assumptions_are_drawn_from_the_same_trial(joint):
    """Both answers are nearly one number: their difference hardly varies, though each of them does. By both engines."""
    first = joint("a", "=B2-B3+0*B4", "=B2+B3", "=B2", "=B3+B4*0", correlations=[("v", "w", -0.9)])
    source = joint("b", "=B2^2", "=B2^2+B3/100", "=IF(B4<0.1,NA(),1)")
    result = compare(first, source, feeds={"v": "y0", "w": "y1"}, engine="jit", **SIZE)
    for each, mean, sd in zip(
        result.forecasts,
        (-0.005, 2 / 3 + 0.005, 1 / 3, 1 / 3 + 0.005),
        (0.01 * 12**-0.5, 2 * (4 / 45) ** 0.5, (4 / 45) ** 0.5, (4 / 45) ** 0.5),
        strict=True,
    ):
        number = each.difference.mean.second, each.difference.standard_deviation.second
        assert abs(number[0].value - mean) < 5 * 2**0.5 * number[0].error, each.first.name
        assert number[1].value == pytest.approx(sd, rel=0.02), each.first.name
    answers = simulated(source, **SIZE)
    run = simulate(fed_model(first, answers, {"v": "y0", "w": "y1"}), engine="numpy", **SIZE)
    pairs = set(zip(*(answers.forecasts[name].tolist() for name in ("y0", "y1")), strict=True))
    assert set(zip(run.inputs["v"].tolist(), run.inputs["w"].tolist(), strict=True)) <= pairs


def test_trials_in_which_one_answer_is_no_number_feed_nothing(joint):
    source = simulated(joint("b", "=IF(B2<0.5,NA(),B2)", "=IF(B3<0.5,NA(),B2)"), **SIZE)
    run = simulate(fed_model(joint("a", "=B2", "=B3"), source, {"v": "y0", "w": "y1"}), **SIZE)
    assert run.inputs["v"].tolist() == run.inputs["w"].tolist()
    assert run.inputs["v"].min() >= 0.5


def test_one_of_several_that_is_correlated_with_another_assumption_is_refused(joint):
    first = joint("a", "=B2-B3+B4", correlations=[("w", "z", 0.5)])
    source = joint("b", "=B2", "=B3")
    assert compare(first, source, feeds={"w": "y0"}, **SIZE).runs == 3
    with pytest.raises(SimulationError, match="only one of them is fed") as refused:
        compare(first, source, feeds={"v": "y0", "w": "y1"}, **SIZE)
    assert str(refused.value.where) == "Sheet!A11"


def test_too_few_trials_are_no_distribution(answering):
    with pytest.raises(SimulationError, match="too few to draw from"):
        compare(answering("a", 0, 1), answering("b", 0, 1), feeds={"a": "y"}, trials=50, seed=1)


def test_a_book_is_fed_or_paired(answering):
    with pytest.raises(SimulationError, match="not paired"):
        compare(answering("a", 0, 1), answering("b", 0, 1), feeds={"a": "y"}, pairs={"y": "y"}, **SIZE)
