from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated

from xlmc.analysis.studies.methods import Corners, ImportanceGrid, Optimised, WorstCase
from xlmc.analysis.studies.methods import corners as corners_file
from xlmc.analysis.studies.methods.answer import extremes_of
from xlmc.analysis.studies.methods.optimised import widen_bounds
from xlmc.analysis.studies.methods.points import Evaluation, box_of
from xlmc.analysis.studies.methods.sampled import SAMPLERS
from xlmc.errors import SimulationError

DOMAIN = {
    "Chevrolet delta-V": ((8.87, 18.70), (8.85, 15.88)),
    "Nissan delta-V": ((17.83, 36.07), (17.80, 30.32)),
    "Chevrolet impact speed": ((27.15, 41.42), (27.66, 40.41)),
    "Nissan impact speed": ((-3.24, 24.88), (0.0, 15.49)),
}
"""Forecast -> corners, and optimised with the filters: mph, computed independently of this project."""


def ends(result, name):
    return result.answers[name].least, result.answers[name].most


@pytest.fixture(scope="module")
def searched(small):
    """What the search finds for the case study."""
    return next(curve for curve in small.once if curve.method.key == "optimised")


def test_corners_of_the_case_study(case_study):
    result = Corners().run(case_study, 0, 1)
    assert result.evaluations == 1024
    for name, (expected, _) in DOMAIN.items():
        assert ends(result, name) == pytest.approx(expected, abs=0.02)


def test_optimised_bounds_of_the_case_study(searched):
    for name, (_, expected) in DOMAIN.items():
        assert searched.ranges[name] == pytest.approx(expected, abs=0.02)


def test_corners_of_a_monotone_function_are_exact(book):
    model = book(
        {"A1": 1.5, "B1": 4.0, "C1": "=A1^3-SQRT(B1)"},
        {"a": {"cell": "A1", "low": 1, "high": 2}, "b": {"cell": "B1", "low": 1, "high": 9}},
        {"f": "C1"},
    )
    for method in (Corners(), Optimised()):
        assert ends(method.run(model, 0, 1), "f") == pytest.approx((1 - 3, 8 - 1), rel=1e-6)


def test_an_extreme_inside_the_box_is_found_by_the_search_alone(book):
    model = book({"A1": 0.2, "B1": "=(A1-0.3)^2"}, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"f": "B1"})
    assert ends(Corners().run(model, 0, 1), "f") == pytest.approx((0.09, 0.49))
    assert ends(Optimised().run(model, 0, 1), "f") == pytest.approx((0.0, 0.49), abs=1e-6)


def test_the_search_minds_filters_and_corners_do_not(halved):
    assert ends(Corners().run(halved, 0, 1), "y") == (0.0, 1.0)
    least, most = ends(Optimised().run(halved, 0, 1), "y")
    assert least == pytest.approx(0.25, abs=1e-6)
    assert least > 0.25  # the filter is above, not at least: the end is a point that the workbook accepts
    assert most == pytest.approx(1.0)


def test_a_filter_limit_may_stand_in_a_cell(book):
    model = book(
        {"A1": 0.5, "B1": "=A1", "D1": 0.25, "E1": "=2*D1"},
        {"x": {"cell": "A1", "low": 0, "high": 1}},
        {"y": "B1"},
        {"upper half": {"cell": "A1", "at_least": "E1"}},
    )
    assert ends(Optimised().run(model, 0, 1), "y") == pytest.approx((0.5, 1.0), abs=1e-6)


def test_whole_numbers_stay_whole(book):
    model = book(
        {"A1": 2.0, "B1": 0.5, "C1": "=A1*10+B1*(1-B1)"},
        {
            "n": {"cell": "A1", "distribution": "Discrete Uniform", "low": 1, "high": 3},
            "b": {"cell": "B1", "low": 0, "high": 1},
        },
        {"f": "C1"},
    )
    result = Optimised().run(model, 0, 1)
    assert ends(result, "f") == pytest.approx((10.0, 30.25), abs=1e-5)
    assert any("not continuous: n" in remark for remark in result.remarks)


def test_worst_case_of_a_straight_function_is_exact(book):
    model = book(
        {"A1": 1.0, "B1": 2.0, "C1": "=5+2*A1-3*B1"},
        {"a": {"cell": "A1", "low": 0, "high": 2}, "b": {"cell": "B1", "low": 1, "high": 2}},
        {"f": "C1"},
    )
    assert ends(WorstCase().run(model, 0, 1), "f") == pytest.approx((5 + 0 - 6, 5 + 4 - 3))


def test_an_unbounded_end_is_cut_and_that_is_said(sum_of_normals):
    box = box_of(sum_of_normals, 1)
    assert box.low == pytest.approx([3 - 3.0902323, 3 - 0.5 * 3.0902323])
    assert box.high == pytest.approx([3 + 3.0902323, 3 + 0.5 * 3.0902323])
    assert "0.1 and 99.9 %" in box.remarks[0]


def test_a_bounded_end_is_not_cut(book):
    model = book({"A1": 1.0, "B1": "=A1"}, {"a": {"cell": "A1", "distribution": "Exponential", "rate": 1}}, {"f": "B1"})
    box = box_of(model, 1)
    assert box.low[0] == 0.0
    assert box.high[0] == pytest.approx(-np.log(0.001))


def test_parameters_that_vary(book):
    model = book(
        {"A1": 1.0, "B1": 1.5, "C1": "=B1", "D1": "=A1+1"},
        {"a": {"cell": "A1", "low": 0, "high": 1}, "b": {"cell": "B1", "low": "A1", "high": "D1"}},
        {"f": "C1"},
    )
    box = box_of(model, 1)
    assert box.low[1] == pytest.approx(0.0, abs=0.05)
    assert box.high[1] == pytest.approx(2.0, abs=0.05)
    assert any("parameters vary" in remark and "b" in remark for remark in box.remarks)


def test_many_assumptions_have_random_corners(book, monkeypatch):
    monkeypatch.setattr(corners_file, "_MOST_CORNERS", 4)
    cells = {f"A{row}": 0.5 for row in range(1, 4)} | {"B1": "=SUM(A1:A3)"}
    given = {f"a{row}": {"cell": f"A{row}", "low": 0, "high": 1} for row in range(1, 4)}
    result = Corners().run(book(cells, given, {"f": "B1"}), 0, 1)
    assert result.evaluations == 4
    assert "random corners" in result.remarks[0]


def test_nowhere_to_start_from(book):
    model = book(
        {"A1": 0.5, "B1": "=A1"},
        {"a": {"cell": "A1", "low": 0, "high": 1}},
        {"f": "B1"},
        {"no": {"cell": "A1", "above": 2}},
    )
    with pytest.raises(SimulationError, match="nothing to start from"):
        Optimised().run(model, 0, 1)


def test_very_many_assumptions(book):
    """No search, and as many corners as there is room for; the differential method has no trouble."""
    count = 300
    cells = {f"A{row}": 0.5 for row in range(1, count + 1)} | {"B1": f"=SUM(A1:A{count})"}
    given = {f"a{row}": {"cell": f"A{row}", "low": 0, "high": 1} for row in range(1, count + 1)}
    model = book(cells, given, {"f": "B1"})
    with pytest.raises(SimulationError, match="no more than 200"):
        Optimised().run(model, 0, 1)
    assert Corners().run(model, 0, 1).evaluations == (1 << 22) // count
    assert ends(WorstCase().run(model, 0, 1), "f") == pytest.approx((0.0, count))


def accepted_forecast(model, name, point):
    """The forecast that the workbook gives at a point, and whether it accepts that."""
    result = Evaluation(model)(np.array([[point[a.name] for a in model.live]]))
    return result.forecasts[0, [f.name for f in model.forecasts].index(name)], result.accepted[0]


def test_every_optimised_end_names_a_point_that_the_workbook_accepts(case_study, searched):
    assert len(searched.ends) == 2 * len(case_study.forecasts)
    for (name, end), point in searched.ends.items():
        value, accepted = accepted_forecast(case_study, name, point)
        assert accepted
        assert value == searched.ranges[name][("least", "most").index(end)]


def test_no_drawn_trial_lies_outside_the_optimised_bounds(small, searched):
    """Of the reference and of every run of the study."""
    for each in small.reference.extremes:
        least, most = searched.ranges[each.forecast]
        assert least <= each.value <= most


def test_bounds_are_widened_by_trials_that_lie_outside_and_searched_from_there(book):
    """y = cos x + x/40: from its middle the search ends at a nearer hill; a trial on the next one leads it up there."""
    model = book({"A1": 0.1, "B1": "=COS(A1)+A1/40"}, {"x": {"cell": "A1", "low": -1, "high": 7}}, {"y": "B1"})
    run = simulated(model, 4_096, 1)
    extremes = extremes_of(run.forecasts, run.trial_index, 1, run.plan)
    answers, ends = widen_bounds(model, 1, {"y": (-1.0, 1.0003)}, extremes)
    top = float(np.arcsin(1 / 40)) + 2 * np.pi
    assert answers["y"].most == pytest.approx(np.cos(top) + top / 40, rel=1e-9)
    assert ends["y", "most"]["x"] == pytest.approx(top, abs=1e-3)
    assert np.isnan(answers["y"].least) == (("y", "least") not in ends)
    assert widen_bounds(model, 1, {"y": (-2.0, 2.0)}, extremes) == ({}, {})


@pytest.mark.parametrize("method", [*SAMPLERS, ImportanceGrid()], ids=lambda method: method.key)
def test_an_extreme_trial_is_drawn_again_as_it_was(case_study, method):
    extremes = method.run(case_study, 8_192, 7).extremes
    assert len(extremes) == 2 * len(case_study.forecasts)
    for each in extremes:
        drawn = case_study.sampler(each.seed, 1, plan=each.plan).draw(each.trial)
        point = {a.name: drawn[a.name][0] for a in case_study.live}
        value, accepted = accepted_forecast(case_study, each.forecast, point)
        assert accepted
        assert value == pytest.approx(each.value, rel=1e-12)
