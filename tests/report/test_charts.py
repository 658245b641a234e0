from __future__ import annotations

import io
import re
import zipfile

import numpy as np
import openpyxl
import pytest
from openpyxl.chart.chartspace import ChartSpace
from openpyxl.chart.reader import read_chart
from openpyxl.utils import range_boundaries
from openpyxl.xml.functions import fromstring

from xlmc.report.bins import HEADER, TABLE
from xlmc.report.book import build_sheets
from xlmc.report.figure import figures_of


@pytest.fixture(scope="session")
def charts(run):
    """The histograms as openpyxl reads them, in order."""
    with zipfile.ZipFile(io.BytesIO(build_sheets(run))) as package:
        names = sorted(name for name in package.namelist() if re.fullmatch(r"xl/charts/chart\d+\.xml", name))
        drawn = [xml for xml in map(package.read, names) if b"<c:f>Bins!" in xml]
        return [read_chart(ChartSpace.from_tree(fromstring(xml))) for xml in drawn]


def _cells(book, reference):
    name, _, area = reference.rpartition("!")
    left, top, right, bottom = range_boundaries(area)
    sheet = book[name.strip("'")]
    return [sheet.cell(row, column).value for row in range(top, bottom + 1) for column in range(left, right + 1)]


def test_there_is_a_chart_for_each_forecast(run, charts):
    assert len(charts) == len(run.forecasts)


def test_charts_draw_the_bins_of_their_forecast(run, book, charts):
    for figure, chart in zip(figures_of(run), charts, strict=True):
        inside, outside = chart.series
        assert chart.grouping == "stacked"
        assert chart.overlap == 100
        assert _cells(book, inside.val.numRef.f) == figure.bins.inside.tolist()
        assert _cells(book, outside.val.numRef.f) == figure.bins.outside.tolist()
        labels = [text or "" for text in _cells(book, inside.cat.strRef.f)]
        assert labels == figure.bins.labels
        assert _cells(book, inside.tx.strRef.f) == ["Inside 51 % range"]
        assert _cells(book, outside.tx.strRef.f) == ["Outside"]
        assert _cells(book, chart.title.tx.strRef.f) == [figure.name]
        assert _cells(book, chart.x_axis.title.tx.strRef.f) == [figure.axis]
        assert chart.x_axis.tickLblSkip == chart.x_axis.tickMarkSkip == figure.bins.step


def test_bins_hold_every_trial_once(run, book):
    sheet = book["Bins"]
    for place, result in enumerate(run.results.values()):
        left = place * (TABLE + 1) + 1
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
    )
    packed = build_sheets(run)
    book = openpyxl.load_workbook(io.BytesIO(packed))
    titles = [book["Bins"].cell(HEADER - 1, 1 + place * (TABLE + 1)) for place in range(2)]
    assert [title.data_type for title in titles] == ["s", "s"]
    assert titles[0].value == "=HYPERLINK(1)"
    assert titles[1].value == "x" * 89 + "…"
    with zipfile.ZipFile(io.BytesIO(packed)) as package:
        assert b"HYPERLINK" in package.read("xl/charts/chart1.xml")
        assert b"<c:f>HYPERLINK" not in package.read("xl/charts/chart1.xml")


def test_without_accepted_trials_there_are_no_charts(none_accepted, opened):
    book = opened(none_accepted)
    assert book["Charts"]._charts == []
    assert book["Charts"]["A4"].value == "No forecast has a number in an accepted trial: nothing to draw."


def test_a_single_trial_is_one_bar(one_accepted):
    (figure,) = figures_of(one_accepted)
    assert figure.bins.inside.sum() == 1
