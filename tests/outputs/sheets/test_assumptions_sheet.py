from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated

from xlmc.montecarlo.definitions.definitions import Correlation
from xlmc.montecarlo.statistics import rank_correlation
from xlmc.outputs.filter_effect import filter_effect, shapes
from xlmc.outputs.sheets.assumptions_sheet import HEADER


@pytest.fixture
def lines(book, rows_of):
    """Name with its units -> its three lines, without empty cells at their ends."""
    rows = rows_of(book["Assumptions"])
    return {row[0]: rows[n : n + 3] for n, row in enumerate(rows[:-2]) if row}


def test_definition_and_draws_before_and_after_stand_together(run, lines):
    before, accepted, change = lines["width (ft)"]
    result = filter_effect(run.prior["width"], run.inputs["width"])
    assert before[:5] == ["width (ft)", None, 2.0, "before", run.prior["width"].size]
    assert accepted[:5] == ["Uniform: Low 1, High 3", None, "S!A1", "accepted", run.accepted]
    for line, part in ((before, result.prior), (accepted, result.accepted)):
        estimates = [part.mean, part.standard_deviation, *part.percentiles.values()]
        assert line[5:15] == [number for estimate in estimates for number in (estimate.value, estimate.error)]
    changes = [result.shift.value, result.shift.error, result.narrowing.value, result.narrowing.error]
    assert change == ["tape", None, None, "change", None, *changes]


def test_the_numbers_agree_with_plain_ones(run, lines):
    _, accepted, _ = lines["width (ft)"]
    assert accepted[5] == pytest.approx(np.mean(run.inputs["width"]))
    assert accepted[9] == pytest.approx(np.percentile(run.inputs["width"], 5))


def test_what_the_filters_changed_is_marked(book, lines):
    sheet = book["Assumptions"]
    row = next(cell.row for cell in sheet["A"] if cell.value == "width (ft)") + 2
    mean, deviation = sheet.cell(row, 6), sheet.cell(row, 8)
    assert deviation.value < 0.8
    assert deviation.fill.fgColor.rgb == "FFFCE4B6"
    assert deviation.number_format.startswith('"× "')
    assert abs(mean.value) < 0.5
    assert mean.fill.fgColor.rgb != "FFFCE4B6"
    assert mean.number_format.endswith('" SD"')


@pytest.mark.parametrize(("name", "status"), [("idle", "not needed"), ("held", "frozen")])
def test_assumptions_that_are_not_drawn_are_listed_too(lines, name, status):
    first, _, _ = lines[name]
    assert first[2:] == [1.0 if name == "idle" else 10.0, status]


def test_a_source_that_looks_like_a_formula_stays_text(lines):
    assert lines["length (ft)"][2][0] == "=plan"


def test_the_header_is_frozen_and_repeated(book):
    sheet = book["Assumptions"]
    assert sheet.freeze_panes == f"B{HEADER + 2}"
    assert sheet.print_title_rows == f"${HEADER + 1}:${HEADER + 1}"


def test_correlations_are_listed(make, opened, row_of):
    assumptions = [make.uniform(name, cell, 0.0, 1.0, base=0.5) for name, cell in (("a", "A1"), ("b", "A2"))]
    pair = Correlation("a", "b", 0.7, make.cell("E1"))
    run = make.simulate(
        {"A1": 0.5, "A2": 0.5, "B1": "=A1+A2"}, assumptions, [make.forecast("x", "B1")], correlations=[pair]
    )
    sheet = opened(run, "Assumptions", "Curves")["Assumptions"]
    rows = [row for row in sheet.iter_rows(values_only=True) if row[0] == "a" and row[1] == "b"]
    assert [(row[5], row[7]) for row in rows] == [(0.7, 0.7)]
    result = rank_correlation(run.inputs["a"], run.inputs["b"])
    assert [row[9:11] for row in rows] == [(result.value, result.error)]


def test_a_correlation_of_0_that_changes_nothing_is_not_listed(make, opened):
    assumptions = [make.uniform(name, cell, 0.0, 1.0, base=0.5) for name, cell in (("a", "A1"), ("b", "A2"))]
    pair = Correlation("a", "b", 0.0, make.cell("E1"))
    run = make.simulate(
        {"A1": 0.5, "A2": 0.5, "B1": "=A1+A2"}, assumptions, [make.forecast("x", "B1")], correlations=[pair]
    )
    sheet = opened(run, "Assumptions", "Curves")["Assumptions"]
    assert "Rank correlations of assumptions" not in [cell.value for cell in sheet["A"]]


@pytest.mark.parametrize("count", [16, 17, 18, 19, 20, 21, 22, 40])
def test_no_page_repeats_the_heading_without_an_assumption_below_it(make, opened, count):
    """A page begins with an assumption, so that what is said below all of them stands on the last one's page."""
    cells = {f"A{n}": 0.5 for n in range(1, count + 1)} | {"B1": f"=SUM(A1:A{count})"}
    assumptions = [make.uniform(f"a{n}", f"A{n}", 0.0, 1.0, base=0.5) for n in range(1, count + 1)]
    run = make.simulate(cells, assumptions, [make.forecast("x", "B1")], trials=50)
    sheet = opened(run, "Assumptions", "Curves")["Assumptions"]
    begins = [brk.id + 1 for brk in sheet.row_breaks.brk]
    assert begins or sheet.page_setup.fitToHeight != 0
    assert {str(sheet.cell(row, 1).value)[0] for row in begins} <= {"a"}


def test_the_sheets_of_a_run_in_replicates(make, opened, rows_of):
    """How it was sampled stands on Results, and errors of accepted draws come from the replicates."""
    assumptions = [make.uniform(name, cell, 0.0, 1.0, base=0.5) for name, cell in (("a", "A1"), ("b", "A2"))]
    cells = {"A1": 0.5, "A2": 0.5, "B1": "=A1+A2", "C1": "=A1>0.3"}
    model = make.simulate(cells, assumptions, [make.forecast("x", "B1")], [make.filter("f", "C1")]).model
    run = simulated(model, 4_000, 1, sampling="lhs")
    book = opened(run, "Results", "Assumptions", "Curves")
    results = [row[0] for row in rows_of(book["Results"]) if row]
    sentence = "Latin hypercube: 16 independent replicates of 250 trials; errors come from the differences between "
    assert any(str(text).startswith(sentence) for text in results)
    assert any("independent trials; the error of these samples is hardly ever larger" in str(text) for text in results)
    texts = [row[0] for row in rows_of(book["Assumptions"]) if row]
    assert any(str(text).startswith("Before filtering, ± is that of independent trials") for text in texts)
    result = filter_effect(run.prior["b"], run.inputs["b"], run.replicate)
    assert result.accepted.mean.error < filter_effect(run.prior["b"], run.inputs["b"]).accepted.mean.error
    line = next(
        row
        for row in rows_of(book["Assumptions"])
        if len(row) > 6 and row[3] == "accepted" and row[5] == result.accepted.mean.value
    )
    assert line[6] == result.accepted.mean.error


def test_small_charts_show_the_shapes_of_the_draws(run, book):
    """Each assumption that is drawn has one: its draws before filtering and the accepted ones, over the same bins."""
    charts = book["Assumptions"]._charts
    assert len(charts) == len(run.inputs)
    row = next(cell.row for cell in book["Assumptions"]["A"] if cell.value == "width (ft)")
    (chart,) = [chart for chart in charts if chart.anchor._from.row == row - 1]
    expected = shapes(run.prior["width"], run.inputs["width"])
    for part, shares in zip(chart._charts, (expected.before, expected.accepted), strict=True):
        (series,) = part.series
        sheet, _, area = series.val.numRef.f.partition("!")
        assert [cell.value for (cell,) in book[sheet][area]] == list(shares)
