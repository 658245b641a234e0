"""Whether a book needs another one, whose answer would be its assumption."""

from __future__ import annotations

import openpyxl
import pytest

import xlmc
from xlmc.errors import SimulationError
from xlmc.studies.comparison import Verdict, compare
from xlmc.studies.comparison.verdicts import verdict_text

SIZE = {"trials": 20_000, "seed": 1}


def test_draws_come_from_what_the_other_book_answers_in_the_unit_of_the_first(answering):
    mine, other = answering("a", 0, 100, "km/h"), answering("b", 9, 11, "m/s", shift=1.0)
    found = compare(mine, other, "1 km/h", feeds={"A": "y"}, **SIZE)
    (each,) = found.forecasts
    assert found.runs == 3
    assert found.source.model.path.name == "b.xlsx"
    for number, expected in ((each.difference.mean, 39.6), (each.difference.standard_deviation, 7.2 * 12**-0.5)):
        # the second is drawn from 20,000 trials, which have an error of their own
        assert abs(number.second.value - expected) < 4 * 2**0.5 * number.second.error
    assert each.judgement.verdict is Verdict.BEYOND
    assert verdict_text(found)[0].startswith("a.xlsx without b.xlsx is not enough for y to 1 km/h: the upper end")


def test_time_and_distance_need_no_model_of_the_impact_where_every_speed_gives_one_answer(filled_in, momentum):
    """At 25 mph the driver stops in time, whatever the speed at the impact was; the speed before braking needs it."""
    rough = filled_in("time-distance", {"v_impact": (25, 45), "limit": 25})
    found = compare(rough, momentum, feeds={"Vehicle speed at the impact": "Chevrolet impact speed"}, **SIZE)
    verdicts = {each.first.name: each.judgement.verdict for each in found.forecasts}
    assert verdicts["Same driver: avoided (1 = yes)"] is Verdict.WITHIN
    assert verdicts["Vehicle speed before braking"] is Verdict.BEYOND
    assert "time-distance.xlsx without intersection-momentum.xlsx is enough for " in verdict_text(found)[0]


@pytest.mark.parametrize(
    ("feeds", "units", "said"),
    [
        ({"x": "y"}, "mph", "there is no assumption 'x'"),
        ({"a": "x"}, "mph", "there is no forecast 'x'"),
        ({"a": "y"}, "deg", "have the units 'mph' and 'deg'"),
    ],
)
def test_what_cannot_be_fed_is_refused(answering, feeds, units, said):
    with pytest.raises(SimulationError, match=said):
        compare(answering("a", 0, 1, "mph"), answering("b", 0, 1, units), feeds=feeds, **SIZE)


def test_a_draw_that_its_formula_may_shift_is_refused(answering, tmp_path):
    book = openpyxl.Workbook()
    book.active["A1"], book.active["A2"] = '=RiskNormal(5,1,RiskShift(3),RiskName("a"))', '=A1+RiskOutput("y")'
    book.save(tmp_path / "shifted.xlsx")
    with pytest.raises(SimulationError, match="drawn by a call in a formula") as refused:
        compare(xlmc.load(tmp_path / "shifted.xlsx"), answering("b", 0, 1), feeds={"a": "y"}, **SIZE)
    assert str(refused.value.where) == "Sheet!A1"


def test_too_few_trials_are_no_distribution(answering):
    with pytest.raises(SimulationError, match="too few to draw from"):
        compare(answering("a", 0, 1), answering("b", 0, 1), feeds={"a": "y"}, trials=50, seed=1)


def test_a_book_is_fed_or_paired(answering):
    with pytest.raises(SimulationError, match="not paired"):
        compare(answering("a", 0, 1), answering("b", 0, 1), feeds={"a": "y"}, pairs={"y": "y"}, **SIZE)
