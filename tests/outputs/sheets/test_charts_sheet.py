from __future__ import annotations

import io
import re
import zipfile

import numpy as np
import openpyxl
import pytest
from openpyxl.chart.chartspace import ChartSpace
from openpyxl.chart.reader import read_chart
from openpyxl.utils import column_index_from_string, get_column_letter, range_boundaries
from openpyxl.xml.functions import fromstring
from packed_sheets import packed_sheets

from xlmc.outputs.histogram import figures_of
from xlmc.outputs.sheets.bins_sheet import HEADER, TABLE


@pytest.fixture(scope="session")
def charts(run, package_of):
    """The charts of forecasts as openpyxl reads them, in order."""
    with zipfile.ZipFile(io.BytesIO(package_of(run))) as package:
        names = [name for name in package.namelist() if re.fullmatch(r"xl/charts/chart\d+\.xml", name)]
        names.sort(key=lambda name: int(re.sub(r"\D", "", name)))
        drawn = [xml for xml in map(package.read, names) if not re.search(rb"<c:f>(Sensitivity|'Filter limits')!", xml)]
        drawn = [xml for xml in drawn if b"<c:lineChart>" not in xml]  # the small ones of the sheet Assumptions
        return [read_chart(ChartSpace.from_tree(fromstring(xml))) for xml in drawn]


def _cells(book, reference):
    name, _, area = reference.rpartition("!")
    left, top, right, bottom = range_boundaries(area)
    sheet = book[name.strip("'")]
    return [sheet.cell(row, column).value for row in range(top, bottom + 1) for column in range(left, right + 1)]


def _title(book, chart):
    title = chart.title.tx
    return _cells(book, title.strRef.f)[0] if title.strRef else title.rich.p[0].r[0].t


def test_every_forecast_has_its_charts_and_those_of_one_unit_are_compared(book, charts):
    kinds = [(type(chart).__name__, _title(book, chart)) for chart in charts]
    assert kinds == [
        ("BarChart", "area"),
        ("BarChart", "difference"),
        ("ScatterChart", "Overlay of forecasts in ft"),
        ("StockChart", "Trend of forecasts in ft"),
        ("AreaChart", "area: cumulative"),
        ("AreaChart", "area: reverse cumulative"),
        ("AreaChart", "difference: cumulative"),
        ("AreaChart", "difference: reverse cumulative"),
        ("ScatterChart", "area and difference"),
    ]


def test_charts_draw_the_bins_of_their_forecast(run, book, charts):
    for figure, chart in zip(figures_of(run), charts, strict=False):
        inside, outside = chart.series
        assert chart.grouping == "stacked"
        assert chart.overlap == 100
        assert _cells(book, inside.val.numRef.f) == figure.bins.inside.tolist()
        assert _cells(book, outside.val.numRef.f) == figure.bins.outside.tolist()
        labels = [text or "" for text in _cells(book, inside.cat.strRef.f)]
        assert labels == [label.replace("-", "−") for label in figure.bins.labels]
        assert _cells(book, inside.tx.strRef.f) == ["Inside 51 % range"]
        assert _cells(book, outside.tx.strRef.f) == ["Outside"]
        assert _cells(book, chart.title.tx.strRef.f) == [figure.name]
        assert _cells(book, chart.x_axis.title.tx.strRef.f) == [figure.axis]
        assert chart.x_axis.tickLblSkip == chart.x_axis.tickMarkSkip == figure.bins.step


def test_axes_of_counts_and_densities_begin_at_0(charts):
    histogram, other, overlay = charts[:3]
    for chart in (histogram, other, overlay):
        assert (chart.y_axis.scaling.min, chart.y_axis.scaling.max) == (0.0, None)


@pytest.mark.parametrize(("first", "name", "above"), [(4, "area", False), (5, "area", True), (6, "difference", False)])
def test_cumulative_charts_draw_exact_shares_and_shade_the_central_range(run, book, charts, first, name, above):
    inside, outside = charts[first].series
    labels = _cells(book, inside.cat.strRef.f)
    at = _cells(book, re.sub("[A-Z]+(?=[$])", _next_column, inside.cat.strRef.f))
    values, (low, high) = run.results[name].values, run.results[name].central()
    dark, light = _cells(book, inside.val.numRef.f), _cells(book, outside.val.numRef.f)
    assert len(at) == len(dark) > 100
    for point, within, without in zip(at, dark, light, strict=True):
        share = np.mean(values > point) if above else np.mean(values <= point)
        expected = (share, 0.0) if low.value <= point <= high.value else (0.0, share)
        assert (within, without) == pytest.approx(expected, abs=1e-12)
    assert all(float(label) == pytest.approx(point) for label, point in zip(labels, at, strict=True) if label)
    assert (at[0], at[-1]) == (float(labels[0]), float(labels[-1]))


def _next_column(letters):
    return get_column_letter(column_index_from_string(letters[0]) + 1)


def test_overlaid_curves_have_an_area_of_one_and_start_and_end_at_none(run, book, charts):
    for series, name in zip(charts[2].series, run.results, strict=True):
        at, density = _cells(book, series.xVal.numRef.f), _cells(book, series.yVal.numRef.f)
        assert _cells(book, series.tx.strRef.f) == [name]
        assert np.trapezoid(density, at) == pytest.approx(1.0, abs=1e-9)
        assert density[0] == density[-1] == 0.0
        middle = np.trapezoid(np.multiply(at, density), at)
        assert middle == pytest.approx(run[name].mean.value, abs=at[1] - at[0])


def test_the_trend_chart_draws_percentiles_in_the_order_of_a_stock_chart(run, book, charts):
    drawn = [_cells(book, series.val.numRef.f) for series in charts[3].series]
    for name, (opening, high, low, closing) in zip(run.results, zip(*drawn, strict=True), strict=True):
        result = run[name]
        assert (opening, closing) == tuple(end.value for end in result.central())
        assert (low, high) == (result.percentile(5).value, result.percentile(95).value)


def test_a_forecast_that_does_not_vary_has_a_histogram_and_no_curve(make):
    run = make.simulate(
        {"A1": 1.0, "B1": "=A1", "B2": "=7"},
        [make.uniform("a", "A1", 0.0, 1.0, base=1.0)],
        [make.forecast("moves", "B1", units="m"), make.forecast("rests", "B2", units="m")],
    )
    with zipfile.ZipFile(io.BytesIO(packed_sheets(run, "Charts", "Bins", "Curves"))) as package:
        drawn = [package.read(name) for name in package.namelist() if "/charts/chart" in name]
    kinds = [kind for kind in drawn if b"<c:lineChart>" not in kind]
    assert sum(b"<c:barChart>" in kind for kind in kinds) == 2
    assert sum(b"<c:areaChart>" in kind for kind in kinds) == 2
    assert sum(b"<c:stockChart>" in kind for kind in kinds) == 0


@pytest.mark.parametrize(("count", "across"), [(6, 2), (7, 3)])
def test_many_histograms_stand_three_side_by_side_without_legends(make, count, across):
    cells = {"A1": 1.0} | {f"B{n}": f"=A1*{n}" for n in range(1, count + 1)}
    forecasts = [make.forecast(f"f{n}", f"B{n}", units=f"u{n}") for n in range(1, count + 1)]
    run = make.simulate(cells, [make.uniform("a", "A1", 0.0, 1.0, base=1.0)], forecasts, trials=50)
    book = openpyxl.load_workbook(io.BytesIO(packed_sheets(run, "Charts", "Bins", "Curves")))
    histograms = book["Charts"]._charts[:count]
    assert len({chart.anchor._from.col for chart in histograms}) == across
    assert all((chart.legend is None) == (across == 3) for chart in histograms)
    titles = [chart.x_axis.title.tx for chart in histograms]
    small = [title.rich.p[0].r[0].t for title in titles if not title.strRef]
    assert small == ([f"u{n}" for n in range(1, count + 1)] if across == 3 else [])


def test_bins_hold_every_trial_once(run, book):
    sheet = book["Bins"]
    for index, result in enumerate(run.results.values()):
        left = index * (TABLE + 1) + 1
        rows = sheet.iter_rows(min_row=HEADER + 2, min_col=left, max_col=left + TABLE - 1, values_only=True)
        table = [row for row in rows if row[5] is not None]
        bins, (below, above, everything) = table[:-3], table[-3:]
        low, high = (end.value for end in result.central())
        assert everything[5] == result.values.size
        assert sum(row[5] for row in bins) + below[5] + above[5] == result.values.size
        central = np.count_nonzero((result.values >= low) & (result.values <= high))
        assert sum(row[3] for row in bins) == central
        for _, start, end, inside, outside, count in bins:
            assert inside + outside == count == np.count_nonzero((result.values >= start) & (result.values < end))


def test_captions_say_mean_range_and_trials(run):
    figure = figures_of(run)[0]
    assert figure.caption.startswith("Figure 1. area: mean ")
    assert f" ft; the central 51 % of {run.accepted:,} accepted trials lie from " in figure.caption
    assert "Not drawn" not in figure.caption


def test_captions_count_what_is_not_drawn(make):
    run = make.simulate(
        {"A1": 1.0, "B1": "=1/(A1-0.5)"},
        [make.uniform("a", "A1", 0.0, 1.0, base=1.0)],
        [make.forecast("pole", "B1")],
    )
    (figure,) = figures_of(run)
    assert figure.bins.below > 0
    expected = f" Not drawn: {figure.bins.below:,} trials below and {figure.bins.above:,} above."
    assert figure.caption.endswith(expected)


def test_a_formula_like_name_is_a_title_and_a_long_one_is_shortened(make):
    names = ["=HYPERLINK(1)", "x" * 300]
    run = make.simulate(
        {"A1": 1.0, "B1": "=A1", "B2": "=A1*2"},
        [make.uniform("a", "A1", 0.0, 1.0, base=1.0)],
        [make.forecast(name, cell) for name, cell in zip(names, ("B1", "B2"), strict=True)],
        trials=200,
    )
    packed = packed_sheets(run, "Charts", "Bins", "Curves")
    book = openpyxl.load_workbook(io.BytesIO(packed))
    titles = [book["Bins"].cell(HEADER - 1, 1 + index * (TABLE + 1)) for index in range(2)]
    assert [title.data_type for title in titles] == ["s", "s"]
    assert titles[0].value == "=HYPERLINK(1)"
    assert titles[1].value == "x" * 89 + "…"
    with zipfile.ZipFile(io.BytesIO(packed)) as package:
        assert b"HYPERLINK" in package.read("xl/charts/chart1.xml")
        assert b"<c:f>HYPERLINK" not in package.read("xl/charts/chart1.xml")


def test_without_accepted_trials_there_are_no_charts(none_accepted, opened):
    book = opened(none_accepted, "Charts", "Bins", "Curves")
    assert book["Charts"]._charts == []
    assert book["Charts"]["A4"].value == "No forecast has a number in an accepted trial: nothing to draw."


def test_a_single_trial_is_one_bar(one_accepted):
    (figure,) = figures_of(one_accepted)
    assert figure.bins.inside.sum() == 1
