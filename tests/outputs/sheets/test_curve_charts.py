"""The tables behind cumulative, overlay and trend charts, counted by NumPy; what the charts draw of them."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest
import xlsxwriter
from simulated import simulated

from xlmc.montecarlo.statistics.sample import Sample
from xlmc.outputs.histogram import figures_of, histogram
from xlmc.outputs.sheets.curve_charts import (
    MOST,
    _cumulative,
    _polygon,
    _ranges,
    cumulative_charts,
    group_by_units,
    overlay_chart,
    trend_chart,
)
from xlmc.outputs.sheets.curves_sheet import TableAt


@pytest.fixture(scope="module")
def run(model_of):
    cells = {"A1": 5.0, "B1": "=A1*2", "B2": "=A1-20", "B3": "=A1*1"}
    model = model_of(
        cells, {"u": {"cell": "A1", "low": 0.0, "high": 10.0}}, {"double": "B1", "less": "B2", "same": "B3"}
    )
    return simulated(model, trials=2_001, seed=3)


@pytest.fixture(scope="module")
def figures(run):
    return [replace(each, answer=replace(each.answer, units="ft")) for each in figures_of(run)]


class Tables:
    """Instead of the sheet Curves: what is written to it."""

    def __init__(self):
        self.written = []

    def write(self, titles, axis, heads, rows):
        self.written.append((titles, axis, heads, [[cell.value for cell in row] for row in rows]))
        return TableAt("Curves", 10 * len(self.written), len(self.written[-1][3]))


@pytest.fixture
def book():
    with xlsxwriter.Workbook(io.BytesIO()) as made:
        made.add_worksheet()
        yield made


def test_a_cumulative_curve_counts_the_trials(run, figures):
    figure, x = figures[0], run.forecasts["double"]
    low, high = np.quantile(x, [0.25, 0.75])
    bins = figure.bins
    curve = _cumulative(run.results["double"].sample, bins, low, high)
    pieces = -(-120 // bins.edges.size)
    assert curve.at.size == bins.edges.size * pieces + 1 > 120
    assert (curve.at[0], curve.at[-1]) == (bins.edges[0], bins.upper_edges[-1])
    np.testing.assert_allclose(np.diff(curve.at), bins.width / pieces)
    np.testing.assert_array_equal(curve.at[:-1:pieces], bins.edges)
    np.testing.assert_allclose(curve.at_most, [np.mean(x <= at) for at in curve.at], atol=1e-12)
    np.testing.assert_allclose(curve.above, [np.mean(x > at) for at in curve.at], atol=1e-12)
    np.testing.assert_array_equal(curve.central, (curve.at >= low) & (curve.at <= high))
    assert curve.labels[::pieces] == [*bins.labels, bins.last_label]
    assert {*curve.labels[1:pieces]} == {""}
    assert curve.step == bins.step * pieces


def test_the_ends_of_the_central_range_belong_to_it():
    x = np.arange(2000.0)
    bins = histogram(x, 500.0, 1500.0)
    curve = _cumulative(Sample.of(x), bins, float(bins.edges[2]), float(bins.edges[5]))
    inside = curve.at[curve.central]
    assert (inside[0], inside[-1]) == (bins.edges[2], bins.edges[5])


def test_labels_of_named_bars_stand_in_their_middle(model_of):
    cells = {"A1": 0.5, "B1": "=ROUND(A1*3,0)"}
    run = simulated(model_of(cells, {"u": {"cell": "A1", "low": 0.0, "high": 1.0}}, {"whole": "B1"}), 500)
    (figure,) = figures_of(run)
    assert figure.bins.names is not None
    curve = _cumulative(run.results["whole"].sample, figure.bins, 0.0, 2.0)
    pieces = -(-120 // figure.bins.edges.size)
    named = [at for at, label in enumerate(curve.labels) if label]
    assert named == [pieces // 2 + number * pieces for number in range(figure.bins.edges.size)]
    assert [curve.labels[at] for at in named] == [*figure.bins.labels]


def test_charts_of_a_cumulative_curve_have_two_areas_each(book, run, figures):
    curves, figure = Tables(), figures[0]
    charts = cumulative_charts(book, curves, run, figure)
    ((titles, axis, heads, rows),) = curves.written
    assert titles == ["double: cumulative", "double: reverse cumulative"]
    assert (axis, heads) == ("ft", ["Label", "Value", *["Inside 51 % range", "Outside"] * 2])
    low, high = figure.answer.low.value, figure.answer.high.value
    for _, at, inside, outside, above_inside, above_outside in rows:
        assert inside + outside + above_inside + above_outside == pytest.approx(1)
        if low <= at <= high:
            assert outside == above_outside == 0
        else:
            assert inside == above_inside == 0
    assert rows[-1][3] == pytest.approx(np.mean(run.forecasts["double"] <= rows[-1][1]))
    for chart, columns in zip(charts, ((2, 3), (4, 5)), strict=True):
        drawn = [each["values"] for each in chart.series]
        assert [each.partition("!")[2] for each in drawn] == [_column(10 + column, len(rows)) for column in columns]
        assert (chart.y_axis["min"], chart.y_axis["max"], chart.y_axis["major_unit"]) == (0, 1, 0.1)
        assert chart.x_axis["interval_unit"] == chart.x_axis["interval_tick"]
        assert all(each["line"]["none"] for each in chart.series)


def _column(column, rows):
    letter = xlsxwriter.utility.xl_col_to_name(column)
    return f"${letter}$7:${letter}${rows + 6}"


@pytest.mark.parametrize(
    ("units", "groups"),
    [
        (["ft", "m", "ft", "m", "s"], [[0, 2], [1, 3]]),
        (["", "", "ft"], []),
        ([" ft", "ft "], [[0, 1]]),
        (["ft"] * (MOST + 2), [[*range(MOST)], [MOST, MOST + 1]]),
        (["ft"] * (MOST + 1), [[*range(MOST)]]),
    ],
)
def test_forecasts_of_one_unit_stand_together(figures, units, groups):
    made = [replace(figures[0], number=n, answer=replace(figures[0].answer, units=u)) for n, u in enumerate(units)]
    assert [[each.number for each in group] for group in group_by_units(made)] == groups


def test_a_frequency_curve_has_the_density_of_its_bars(run, figures):
    figure, x = figures[0], run.forecasts["double"]
    rows = [[cell.value for cell in row] for row in _polygon(figure)]
    bins = figure.bins
    middles, heights = np.array(rows).T
    np.testing.assert_allclose(np.diff(middles), bins.width)
    np.testing.assert_allclose(middles[1:-1], bins.edges + bins.width / 2)
    assert (heights[0], heights[-1]) == (0, 0)
    counts = np.histogram(x, [*bins.edges, bins.upper_edges[-1]])[0]
    np.testing.assert_allclose(heights[1:-1], counts / x.size / bins.width)
    assert heights.sum() * bins.width == pytest.approx(1)


def test_an_overlay_has_a_line_for_each_forecast(book, figures):
    curves = Tables()
    chart = overlay_chart(book, curves, figures)
    assert [each[0] for each in curves.written] == [["Overlay of forecasts in ft"], [], []]
    assert [each[2] for each in curves.written] == [["Middle of bar", each.name] for each in figures]
    assert [each["values"].partition("!")[2] for each in chart.series] == [
        _column(10 * (number + 1) + 1, len(each[3])) for number, each in enumerate(curves.written)
    ]
    assert len({str(each["line"]) for each in chart.series}) == 3
    assert chart.x_axis["min"] is None  # one of them lies below 0


@pytest.mark.parametrize(("names", "least"), [(("double", "same"), 0), (("double", "less"), None)])
def test_an_overlay_begins_at_0_where_the_first_bar_is_near(book, figures, names, least):
    chart = overlay_chart(book, Tables(), [each for each in figures if each.name in names])
    assert chart.x_axis["min"] == least


def test_an_overlay_of_what_lies_far_above_0_has_no_end_there(book, model_of):
    run = simulated(model_of({"A1": 5.0}, {"u": {"cell": "A1", "low": 70.0, "high": 90.0}}, {"x": "A1"}), 500)
    figures = figures_of(run)
    assert overlay_chart(book, Tables(), [figures[0]] * 2).x_axis["min"] is None


def test_a_trend_has_open_high_low_and_close(book, run, figures):
    curves = Tables()
    chart = trend_chart(book, curves, run, figures)
    ((titles, axis, heads, rows),) = curves.written
    assert (titles, axis) == (["Trend of forecasts in ft"], "ft")
    assert heads == ["Forecast", "51 % range from", "95th percentile", "5th percentile", "51 % range to"]
    for figure, (name, *ends) in zip(figures, rows, strict=True):
        assert name == figure.name
        assert ends == pytest.approx(np.quantile(run.forecasts[name], [0.245, 0.95, 0.05, 0.755]), abs=0.02)
    assert [each["values"].partition("!")[2] for each in chart.series] == [_column(10 + n, 3) for n in range(1, 5)]
    assert chart.legend["position"] == "none"


def test_a_trend_of_different_shares_says_so(book, run, figures):
    first, *others = figures
    wider = replace(first, answer=replace(first.answer, share=0.9))
    curves = Tables()
    trend_chart(book, curves, run, [wider, *others])
    assert curves.written[0][2][1] == "Central range from"
    assert [len(row) for row in _ranges(run, [wider])] == [5]
