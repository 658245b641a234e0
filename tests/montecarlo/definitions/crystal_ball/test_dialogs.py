"""What Crystal Ball's dialogs define, read from books that are laid out as genuine ones."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import openpyxl
import pytest
from crystal_ball_book import Asked, Decided, Drawn, Tied, block, object_guid, read_parts, save, write_parts
from openpyxl.worksheet.table import Table
from simulated import simulated

from xlmc.analysis.results.saved import keep, open_run
from xlmc.engine.engines import ENGINES
from xlmc.excel.address import Cell
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.definitions.definitions import Settings
from xlmc.montecarlo.definitions.definitions_reader import read_definitions
from xlmc.montecarlo.model.loading import load

S = "Sheet1"
SKID = Drawn(S, "$B$2", "Skid", "Normal", {"Mean": 100.0, "StdDev": 15.0})
OFFSET = Drawn(S, "$B$3", "Offset", "LogNormal", {"Mean": 50.0, "StdDev": 10.0, "Location": 0.0})
TOTAL = Asked(S, "$B$5", "Total", "ft")
CELLS = {S: {"A2": "Skid", "B2": 100, "A3": "Offset", "B3": 50, "B5": "=2*B2-B3+30", "B6": "=2*B3"}}


@pytest.fixture
def read(tmp_path):
    """The definitions of a book of these objects, in one block; the keywords are those of `save`."""

    def definitions(*items, cells=CELLS, blocks=None, **more):
        path = tmp_path / "book.xlsx"
        save(path, cells, blocks or [list(items)], **more)
        return read_definitions(read_workbook(path), ENGINES)

    return definitions


def test_assumptions_and_forecasts_are_read_with_their_cells_and_names(read):
    result = read(TOTAL, OFFSET, SKID)
    assert [(a.name, str(a.cell), a.distribution, a.parameters, a.base) for a in result.assumptions] == [
        ("Skid", "Sheet1!B2", "Normal", {"mean": 100.0, "std_dev": 15.0}, 100.0),
        ("Offset", "Sheet1!B3", "Lognormal", {"mean": 50.0, "std_dev": 10.0, "location": 0.0}, 50.0),
    ]
    assert [(f.name, str(f.cell), f.units) for f in result.forecasts] == [("Total", "Sheet1!B5", "ft")]
    assert not result.problems
    assert not result.refused
    assert any("no run preferences" in notice.message for notice in result.notices)


FAMILIES = [
    ("Normal", {"Mean": 1.0, "StdDev": 2.0}, "Normal", True),
    ("Beta", {"Min": 0.1, "Max": 0.9, "Alpha": 2.0, "Beta": 5.0}, "Beta", True),
    ("DPoisson", {"Rate": 12.0}, "Poisson", True),
    ("LogNormal", {"Mean": 5.0, "StdDev": 2.0, "Location": 0.0}, "Lognormal", True),
    ("Uniform", {"Min": 0.5, "Max": 1.5}, "Uniform", False),
    ("Triangular", {"Min": 0.0, "Likeliest": 1.0, "Max": 3.0}, "Triangular", False),
    ("BetaPERT", {"Minimum": 0.0, "Likeliest": 1.0, "Maximum": 3.0}, "BetaPERT", False),
    ("Gamma", {"Location": 0.0, "Scale": 1.0, "Shape": 3.0}, "Gamma", False),
    ("DYesNo", {"Prob": 0.5}, "Yes-No", False),
    ("DBinomial", {"Probability": 0.5, "Trials": 6.0}, "Binomial", False),
]


def test_families_go_by_their_text_and_those_not_met_in_genuine_books_are_pointed_out(read):
    cells = {S: {f"B{row}": 1 for row in range(1, len(FAMILIES) + 1)} | {"D1": "=SUM(B1:B20)"}}
    items = [Drawn(S, f"$B${row}", f"x{row}", f[0], f[1]) for row, f in enumerate(FAMILIES, 1)]
    result = read(*items, Asked(S, "$D$1", "Sum"), cells=cells)
    assert [a.distribution for a in result.assumptions] == [family for _, _, family, _ in FAMILIES]
    expected = {str(notice.where) for notice in result.notices if "not yet met" in notice.message}
    assert expected == {str(a.cell) for a, f in zip(result.assumptions, FAMILIES, strict=True) if not f[3]}


UNREADABLE = {
    "unknown family": (replace(SKID, family="Unheard", code=77), "is not known"),
    "unknown parameter": (replace(SKID, parameters={"Mean": 1.0, "Sigma": 2.0}), "needs Mean, StdDev"),
    "code of another family": (replace(SKID, code=4), "the code 4 LogNormal"),
    "another slot": (replace(SKID, slots={3: 100.0, 4: 16.0}), "disagree on StdDev"),
    "more slots": (replace(SKID, slots={3: 100.0, 4: 15.0, 5: 1.0}), "that the text lacks"),
    "a cutoff in the slots alone": (replace(SKID, slots={1: 0.0, 3: 100.0, 4: 15.0}), "disagree on LoCut"),
    "custom data": (replace(SKID, custom=True), "custom data"),
    "no distribution": (replace(SKID, parameters={"Mean": 1.0, "StdDev": -2.0}), "Std dev"),
    "a family that was not met, with a known code": (
        replace(SKID, family="Uniform", parameters={"Min": 0.0, "Max": 1.0}, code=3),
        "the code 3 Normal",
    ),
    "a parameter that nobody knows": (replace(SKID, references={7: "$A$2"}), "it is not clear which"),
    "a lost reference": (replace(SKID, references={2: "#REF!"}), "has lost its cell"),
}


@pytest.mark.parametrize(("skid", "why"), UNREADABLE.values(), ids=list(UNREADABLE))
def test_what_cannot_be_read_is_no_constant_but_costs_the_forecasts_that_need_it(read, skid, why):
    result = read(skid, OFFSET, TOTAL, Asked(S, "$B$6", "Other"))
    assert [f.name for f in result.forecasts] == ["Other"]
    (refused,) = result.refused
    assert "'Total' needs Sheet1!B2" in refused.message
    assert why in refused.message
    assert not result.problems


def test_nothing_is_run_where_all_forecasts_need_what_cannot_be_read(read):
    problems = [str(problem) for problem in read(replace(SKID, family="Unheard"), TOTAL).problems]
    assert any("'Total' needs Sheet1!B2" in problem for problem in problems)


def test_cutoffs_and_parameters_may_come_from_cells(read):
    speed = Drawn(S, "$B$3", "=B9", "Normal", {"Mean": 20.0, "StdDev": 2.0}, {"LoCut": -1.0, "HiCut": 30.0})
    speed = replace(speed, references={2: "$B$2", 3: "$D$1*2"}, named_by='$A$3&" of "&$A$2')
    cells = {S: {**CELLS[S], "D1": 1}}
    result = read(SKID, replace(speed, references={2: "$B$2", 3: 'Sheet1!$D$1*2&""'}), TOTAL, cells=cells)
    assert result.assumptions[1].name == "Offset of Skid"
    result = read(SKID, speed, TOTAL, cells=cells)
    drawn = result.assumptions[1]
    assert str(drawn.parameters["mean"]) == "Sheet1!B2"
    assert [*drawn.cutoffs.values()] == [-1.0, 30.0]


def test_a_parameter_of_another_family_comes_from_the_cell_that_holds_its_number(read):
    share = Drawn(
        S, "$B$2", "Share", "Beta", {"Min": 0.0, "Max": 9.0, "Alpha": 2.0, "Beta": 5.0}, references={5: "$D$1"}
    )
    result = read(share, TOTAL, cells={S: {**CELLS[S], "B2": 1, "D1": 9}})
    assert str(result.assumptions[0].parameters["high"]) == "Sheet1!D1"


def test_correlations_take_their_coefficient_from_the_cell(read):
    tied = Tied(S, "$D$1", SKID, OFFSET, 0.6)
    (result,) = read(SKID, OFFSET, tied, TOTAL, cells={S: {**CELLS[S], "D1": -0.3}}).correlations
    assert (result.first, result.second, result.value, str(result.row)) == ("Skid", "Offset", -0.3, "Sheet1!D1")
    (typed,) = read(SKID, OFFSET, replace(tied, cell=""), TOTAL).correlations
    assert typed.value == 0.6
    assert not read(SKID, tied, TOTAL).correlations


def test_cells_move_with_their_names_and_what_was_deleted_with_its_cell_is_left_out(read):
    moved = {f"CB_{object_guid(SKID).hex}": f"{S}!$B$9", f"CB_{object_guid(OFFSET).hex}": "#REF!"}
    result = read(SKID, OFFSET, TOTAL, cells={S: {**CELLS[S], "B9": 1, "B5": "=B9"}}, names=moved)
    assert [str(a.cell) for a in result.assumptions] == ["Sheet1!B9"]
    assert any("'Offset' was deleted with its cell" in notice.message for notice in result.notices)


def test_a_cell_whose_object_is_missing_is_no_constant(read, tmp_path):
    """The block with the assumption is damaged; its defined name still says that the cell held something."""
    cells = {S: {**CELLS[S], "D1": "=B2"}}
    blocks = [[SKID, TOTAL, Asked(S, "$D$1", "Skid alone")], [OFFSET]]
    result = read(cells=cells, blocks=blocks, spoil=lambda shape, text: text[:-9] if shape.endswith("_2") else text)
    assert [f.name for f in result.forecasts] == ["Skid alone"]
    damage, missing, total = result.refused
    assert "the block CB_Block_7.0.0.0:2 of the sheet 'Sheet1' is damaged" in damage.message
    assert "something of Sheet1!B3:" in missing.message
    assert "'Total' needs Sheet1!B3" in total.message


def test_a_forecast_or_a_correlation_that_is_missing_is_told(read):
    """Its block is gone, and with it a filter that would have rejected trials."""
    keep = {"fFilterPrefs": {"fUseFilter": True, "fFilterMin": 90.0, "fFilterAllOnDiscard": True}}
    gone = [Asked(S, "$B$6", "Other", prefs=keep), Tied(S, "$D$1", SKID, OFFSET, 0.6)]
    cells, blocks = {S: {**CELLS[S], "D1": 0.6}}, [[SKID, OFFSET, TOTAL], gone]
    result = read(cells=cells, blocks=blocks, spoil=lambda shape, text: block([]) if shape.endswith("_2") else text)
    (missing,) = result.refused
    assert "something of Sheet1!B6, Sheet1!D1:" in missing.message
    assert [f.name for f in result.forecasts] == ["Total"]


def test_one_cell_has_one_assumption(read):
    twice = Drawn(S, "$B$4", "Other", "Normal", {"Mean": 1.0, "StdDev": 1.0})
    names = {f"CB_{object_guid(twice).hex}": f"{S}!$B$2"}
    (problem,) = read(SKID, twice, TOTAL, names=names).problems
    assert "two assumptions on Sheet1!B2" in problem.message


def test_two_objects_of_one_name_are_told_apart_by_their_cells(read):
    result = read(SKID, replace(OFFSET, name="skid"), TOTAL)
    assert [a.name for a in result.assumptions] == ["Skid", "skid (Sheet1!B3)"]


def test_the_range_of_a_certainty_is_a_threshold(read):
    low = {"fCertaintyChartPrefs": {"fCertaintyRangeMin": 120.0}}
    both = {"fCertaintyChartPrefs": {"fCertaintyRangeMin": 120.0, "fCertaintyRangeMax": 150.0}}
    assert read(SKID, replace(TOTAL, prefs=low)).forecasts[0].threshold == 120.0
    result = read(SKID, replace(TOTAL, prefs=both))
    assert (result.forecasts[0].threshold, result.forecasts[0].asked) == (None, (120.0, 150.0))
    assert any("the certainty of this range is reported" in notice.message for notice in result.notices)


def test_decision_variables_are_decisions_and_are_named_once(read):
    result = read(SKID, TOTAL, Decided(S, "$B$3", "Share"))
    (sentence,) = [notice for notice in result.notices if "decision" in notice.message]
    assert "'Share' (Sheet1!B3, 0 to 1 in steps of 0.05)" in sentence.message
    (decision,) = result.decisions
    assert (decision.name, decision.cell, decision.between) == ("Share", Cell(S, 3, 2), None)
    assert decision.values == pytest.approx([0.05 * number for number in range(21)])


def test_decision_variables_of_a_kind_that_was_not_met_keep_their_values(read):
    result = read(SKID, TOTAL, Decided(S, "$B$3", "Share", kind=0))
    (sentence,) = [notice for notice in result.notices if "Decision" in notice.message]
    assert "keep the values of their cells: 'Share' (Sheet1!B3)" in sentence.message
    assert not result.decisions


def test_the_answers_are_those_of_the_distributions(tmp_path):
    """Means and standard deviations within 4 standard errors of the exact ones, at 20,000 trials."""
    model = "Other's data"
    share = Drawn(model, "$A$1", "Share", "Beta", {"Min": 0.1, "Max": 0.9, "Alpha": 2.0, "Beta": 5.0})
    cells = {**CELLS, model: {"A1": 0.3, "A2": "=10*A1+Sheet1!B2"}}
    sum_ = Asked(model, "$A$2", "Sum")
    path = tmp_path / "book.xlsx"
    blocks = [[SKID, OFFSET, TOTAL, Tied(S, "", SKID, OFFSET, 0.5)], [share], [sum_]]
    save(path, cells, blocks, comments=[(S, "B2", "a comment")])
    parts = read_parts(path)
    drawing = next(name for name in parts if name.startswith("xl/drawings/comments"))
    parts[drawing] = parts[drawing].replace(b"<xml>", b"<xml><div>Excel leaves it open<br></div>")
    write_parts(path, parts)
    result = simulated(load(path), 20_000)
    spread = 0.8 * math.sqrt(2 * 5 / 8) / 7
    mean, sd = 100 + 10 * (0.1 + 0.8 * 2 / 7), math.hypot(15, 10 * spread)
    assert abs(result["Sum"].mean.value - mean) < 4 * result["Sum"].mean.error
    assert abs(result["Sum"].standard_deviation.value - sd) < 4 * result["Sum"].standard_deviation.error
    assert abs(result["Total"].mean.value - 180) < 4 * result["Total"].mean.error


FILTERS = {
    "keeps what is above": ({"fFilterMin": 110.0}, (110.0, None), ("Total",), False),
    "keeps what is between": ({"fFilterMin": 110.0, "fFilterMax": 200.0}, (110.0, 200.0), ("Total",), False),
    "of all forecasts": ({"fFilterMax": 200.0, "fFilterAllOnDiscard": True}, (None, 200.0), (), True),
    "keeps what is outside": (
        {"fFilterMin": 110.0, "fFilterMax": 200.0, "fFilterInside": True, "fFilterOutside": False},
        (None, None),
        ("Total",),
        True,
    ),
}


@pytest.mark.parametrize(("members", "limits", "only_for", "expected"), FILTERS.values(), ids=list(FILTERS))
def test_a_filter_is_of_its_forecast_unless_it_says_all(read, members, limits, only_for, expected):
    filtered = replace(TOTAL, prefs={"fFilterPrefs": {"fUseFilter": True, **members}})
    result = read(SKID, filtered, Asked(S, "$B$6", "Other"))
    (each,) = (*result.filters, *result.forecast_filters)
    assert (each.at_least, each.at_most, each.only_for) == (*limits, only_for)
    assert bool(only_for) == bool(result.forecast_filters)
    assert any("not yet met" in notice.message for notice in result.notices) == expected


def test_a_filter_of_one_forecast_is_saved_and_repeated(tmp_path):
    filtered = replace(TOTAL, prefs={"fFilterPrefs": {"fUseFilter": True, "fFilterMin": 180.0, "fFilterMax": 200.0}})
    inside = {
        "fUseFilter": True,
        "fFilterMin": 95.0,
        "fFilterMax": 120.0,
        "fFilterInside": True,
        "fFilterOutside": False,
    }
    path = tmp_path / "book.xlsx"
    save(
        path,
        CELLS,
        [[SKID, OFFSET, filtered, replace(TOTAL, cell="$B$6", name="Other", prefs={"fFilterPrefs": inside})]],
    )
    run = simulated(load(path), 3000)
    total, other = run.forecasts["Total"], run.forecasts["Other"]
    skid, offset = run.inputs["Skid"], run.inputs["Offset"]
    np.testing.assert_array_equal(np.isnan(total), (total_of(skid, offset) < 180) | (total_of(skid, offset) > 200))
    np.testing.assert_array_equal(np.isnan(other), (2 * offset >= 95) & (2 * offset <= 120))
    assert run.discards["Total"].total() == np.count_nonzero(np.isnan(total))
    opened = open_run(keep(run, tmp_path / "run.xlmcrun"))
    assert opened.discards == run.discards
    assert opened["Total"].statistics == run["Total"].statistics


def total_of(skid, offset):
    return 2 * skid - offset + 30


def precision(**members):
    return {"fPrecisionPrefs": {"fUsePrecision": True, **members}}


SHARE = {"fAbsolute": False, "fRelative": True, "fRelativePct": 0.01}
OTHER = Asked(S, "$B$6", "Other")
NONE = (None, False, None, ())
PRECISIONS = {
    "absolute": ([precision()], None, (0.05, False, ("mean",), ("Total",)), "mean to within 0.05 of 'Total'"),
    "relative, of several numbers": (
        [precision(**SHARE, fUseStdDev=True, fUsePercentile=True)],
        None,
        (0.01, True, ("mean", "sd", "p95"), ("Total",)),
        "mean and sd and p95 to within 1 %",
    ),
    "of all forecasts": ([precision(**SHARE), precision(**SHARE)], None, (0.01, True, ("mean",), ()), "goes on until"),
    "of two kinds": ([precision(**SHARE), precision()], None, NONE, "the forecasts ask for several"),
    "both widths": ([precision(fRelative=True)], None, NONE, "neither an absolute nor a relative width, or both"),
    "no number": ([precision(fUseMean=False)], None, NONE, "no number was named"),
    "no width": ([precision(fAbsoluteUnits=0.0)], None, NONE, "is not a precision"),
    "beside settings": ([precision()], "Seed", NONE, "xlmc_settings says how to run"),
}


@pytest.mark.parametrize(("prefs", "setting", "goal", "sentence"), PRECISIONS.values(), ids=PRECISIONS)
def test_precision_control_is_the_goal_of_a_run(tmp_path, prefs, setting, goal, sentence):
    path = tmp_path / "book.xlsx"
    asked = [replace(each, prefs=own) for each, own in zip((TOTAL, OTHER), [*prefs, {}], strict=False)]
    save(path, CELLS, [[SKID, *asked]])
    if setting:
        book = openpyxl.load_workbook(path, keep_vba=True)  # keeps the drawings
        book[S]["F1"], book[S]["G1"], book[S]["F2"], book[S]["G2"] = "Setting", "Value", setting, 7
        book[S].add_table(Table(displayName="xlmc_settings", ref="F1:G2"))
        book.save(path)
        book.vba_archive.close()
    result = read_definitions(read_workbook(path), ENGINES)
    ends = result.settings.stopping
    width, relative, numbers, forecasts = goal
    if width is None:
        assert result.settings == replace(Settings(), seed=result.settings.seed)
    else:
        assert (ends.goal.tolerance, ends.goal.relative, ends.goal.numbers) == (width, relative, numbers)
        assert ends.forecasts == forecasts
    (notice,) = [each.message for each in result.notices if "precision control" in each.message]
    assert sentence in notice
    assert ("not yet met" in notice) == (width is not None)


def test_a_call_in_the_cell_of_an_old_assumption_wins(read):
    """Crystal Ball's own assumptions stand in constants: the formula is the newer one."""
    cells = {S: {**CELLS[S], "B2": "=RiskNormal(100,15)"}}
    result = read(TOTAL, OFFSET, SKID, cells=cells)
    assert {(a.name, a.source) for a in result.assumptions} == {
        ("Offset", "Crystal Ball"),
        ("Skid", "RiskNormal in the cell"),
    }
    assert not result.problems
    assert not result.refused
    assert any("old assumption 'Skid' is left out" in notice.message for notice in result.notices)


def test_formulas_of_crystal_balls_own_sheet_make_no_answer_unusable(tmp_path):
    path = tmp_path / "book.xlsx"
    save(path, CELLS, [[TOTAL, OFFSET, SKID]])
    parts = read_parts(path)
    sheet = next(each for each in read_workbook(path).sheets.values() if each.name == "CB_DATA_").part
    cell = '<row r="2"><c r="P2"><f>CB.RecalcCounterFN()</f><v>3</v></c></row>'
    xml = re.sub(r"<sheetData ?/>|<sheetData>.*</sheetData>", f"<sheetData>{cell}</sheetData>", parts[sheet].decode())
    assert cell in xml
    write_parts(path, {**parts, sheet: xml.encode()})
    run = simulated(load(path), 500)
    assert run.warnings == []
    assert run.shown_results.cells == {}
