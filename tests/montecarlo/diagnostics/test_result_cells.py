"""Cells that show results of a run, filled in on writing: their values, their dependants', and nothing else."""

from __future__ import annotations

import math
import re
import zipfile
from contextlib import closing

import numpy as np
import openpyxl
import pytest
import xlsxwriter
from fewer_sheets import CHARTS, SENSITIVITY, leave_out
from simulated import simulated

from xlmc.analysis.studies.scenario_answers import scenario_answers
from xlmc.api import Simulation
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.workbook.inject import original_hash
from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.writer import package_bytes
from xlmc.montecarlo.diagnostics.result_cells import filled_sheets
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.conversion.convert import convert

FORMULAS = {
    "A1": ("=_xll.RiskNormal(5,1)", 5.25),
    "A2": ('=RiskOutput("x")+A1*2', 10.5),
    "A3": ("=A1+1", 6.25),
    "B1": ("=_xll.RiskMean(A2)", 0),
    "B2": ("=B1*2+A1", 0),
    "B3": ('=IF(B1>5,"a<b","")', ""),
    "B4": ("=[1]!CB.GetForeStatFN(A2,5)", 0),
    "B5": ("=RiskPercentile(A2,$D$1)", 0),
    "B6": ("=RiskTarget(A2,10)", 0),
    "B7": ("=CB.GetForeStatFN(A2,14)", 0),
    "B8": ('=ROUND(RiskMax("X")-RiskMin("x")-RiskRange(A2),9)', 1),
    "B9": ("=CB.GetForePercentFN(A2,90)-B5", 1),
    "B10": ("=CB.GetCertaintyFN(A2,10)-100*B6", 1),
    "B11": ("=RiskData(A2,3)", 0),
    "B12": ('=RiskMean("no such")', 7),
    "B13": ("=ISERROR(B12)", False),
    "B14": ("=RiskStdDev(A2)^2-RiskVariance(A2)", 1),
    "B15": ("=RiskPercentileD(A2,1-$D$1)-B5", 1),
    "B16": ("=RiskTargetD(A2,10)+B6", 0),
    "B17": ("=Unknown(B1)", 3),
    "B18": ("=CB.GetForeStatFN(A2,1)", 0),
    "B19": ("=_xll.CB.GetCertaintyFN(A2,10)", 0),
}


def build(path, formulas, extra=()):
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("S")
        other = book.add_worksheet("Other")
        sheet.write("D1", 0.9)
        for address, (formula, value) in formulas.items():
            sheet.write_formula(address, formula, None, value)
        other.write_formula("A1", "=S!B1+1", None, 0)
        other.write_formula("A2", "=S!A1", None, 5.25)
        for row, (formula, value) in enumerate(extra, start=3):
            other.write_formula(row, 0, formula, None, value)
    return path


@pytest.fixture(scope="module")
def filled(tmp_path_factory):
    folder = tmp_path_factory.mktemp("books")
    source = build(folder / "book.xlsx", FORMULAS)
    run = simulated(load(source), trials=20_000, seed=999)
    with pytest.MonkeyPatch.context() as patch:
        leave_out(patch, *CHARTS, *SENSITIVITY)
        Simulation(run).save(folder / "out.xlsx")
    return source, folder / "out.xlsx", run


@pytest.fixture(scope="module")
def saved(filled):
    """What the result workbook shows: sheet -> address -> value."""
    with closing(openpyxl.load_workbook(filled[1], data_only=True, read_only=True)) as book:
        return {
            name: {
                cell.coordinate: cell.value for row in book[name].iter_rows() for cell in row if cell.value is not None
            }
            for name in ("S", "Other")
        }


def test_values(filled, saved):
    _, _, run = filled
    x = run["x"]
    expected = {
        "B1": x.mean.value,
        "B2": 2 * x.mean.value + 5.25,
        "B3": "a<b",
        "B4": x.standard_deviation.value,
        "B5": x.percentile(90).value,
        "B6": 1 - x.probability_above(10).value,
        "B7": "#NUM!",
        "B8": 0,
        "B9": 0,
        "B10": 0,
        "B11": x.values[2],
        "B12": "#N/A",
        "B13": True,
        "B14": 0,
        "B15": 0,
        "B16": 1,
        "B17": "#N/A",
        "B18": 20_000,
        "B19": 100 * (1 - x.probability_above(10).value),
    }
    for address, value in expected.items():
        result = saved["S"][address]
        assert result == (value if isinstance(value, str | bool) else pytest.approx(value, rel=1e-12, abs=1e-12)), (
            address
        )
    assert abs(saved["S"]["B1"] - 10) < 5 * 2 / math.sqrt(20_000)


def test_other_cells_keep_what_excel_saved(saved):
    assert [saved["S"][address] for address in ("A1", "A2", "A3", "D1")] == [5.25, 10.5, 6.25, 0.9]
    assert saved["Other"]["A2"] == 5.25
    assert saved["Other"]["A1"] == saved["S"]["B1"] + 1


def test_only_values_change(filled):
    """Without the cached values of the filled cells, both sheets are the same bytes; so are all parts but five more."""
    source, target, run = filled
    before, after = (read_parts(path.read_bytes()) for path in (source, target))
    kept = {"[Content_Types].xml", "xl/workbook.xml", "xl/_rels/workbook.xml.rels", "xl/styles.xml", "docProps/app.xml"}
    sheets = {"xl/worksheets/sheet1.xml", "xl/worksheets/sheet2.xml"}
    assert {name for name in before if after[name] != before[name]} <= kept | sheets
    cells = {cell.a1 for cell in run.shown_results.cells}
    for name in sheets:
        assert _blanked(before[name], cells) == _blanked(after[name], cells)


def _blanked(xml, cells):
    for address in cells:
        cell = rf'(<c r="{address}")(?: t="\w+")?(>.*?</f>)<v>.*?</v>'
        xml = re.sub(cell.encode(), rb"\1\2", xml)
    return xml


def test_the_result_workbook_is_known_as_made_from_the_book(filled):
    source, target, _ = filled
    hashes = [original_hash(read_parts(path.read_bytes())) for path in (source, target)]
    assert hashes[0] == hashes[1]


def test_another_formula_is_another_workbook(filled, tmp_path):
    source, _, _ = filled
    changed = build(tmp_path / "changed.xlsx", {**FORMULAS, "A3": ("=A1+2", 6.25)})
    assert original_hash(read_parts(changed.read_bytes())) != original_hash(read_parts(source.read_bytes()))


def test_a_run_of_the_result_workbook_gives_the_same(filled, tmp_path):
    _, target, run = filled
    again = simulated(load(target), trials=20_000, seed=999)
    assert again["x"].mean == run["x"].mean
    with pytest.MonkeyPatch.context() as patch:
        leave_out(patch, *CHARTS, *SENSITIVITY)
        Simulation(again).save(tmp_path / "again.xlsx")
    with zipfile.ZipFile(tmp_path / "again.xlsx") as once, zipfile.ZipFile(target) as first:
        assert once.read("xl/worksheets/sheet1.xml") == first.read("xl/worksheets/sheet1.xml")


def test_results_of_a_run_without_accepted_trials_are_not_available(tmp_path):
    cells = {"A1": ("=RiskNormal(5,1)+RiskOutput()", 5), "A2": ("=RiskMean(A1)", 5), "A3": ("=A1/0+RiskOutput()", 0)}
    cells["A4"] = ("=RiskMean(A3)", 1)
    run = simulated(load(build(tmp_path / "book.xlsx", cells)), trials=100)
    values = {cell.a1: value for cell, value in run.shown_results.cells.items()}
    assert values["A4"] is ErrorCode.NA
    assert values["A2"] == run["S!A1"].mean.value


INPUTS = {"A1": ("=RiskNormal(5,1)", 5), "A2": ("=A1*2+RiskUniform(0,1)+RiskOutput()", 10)}


def test_results_of_an_assumption_are_those_of_its_accepted_draws(tmp_path):
    cells = {"B1": ("=RiskMean(A1)", 5), "B2": ("=RiskPercentile(A1,0.9)", 5), "B3": ("=CB.GetForeStatFN(A1,1)", 5)}
    run = simulated(load(build(tmp_path / "book.xlsx", {**INPUTS, **cells})), trials=500)
    draws = run.inputs["S!A1#1"]
    assert draws.size == 500
    values = {cell.a1: value for cell, value in run.shown_results.cells.items()}
    assert values["B1"] == pytest.approx(draws.mean(), rel=1e-14)
    assert values["B2"] == pytest.approx(np.percentile(draws, 90), rel=1e-14)
    assert values["B3"] == 500


OF_INPUTS = {
    "A1": ('=10+RiskNormal(5,1,RiskName("Speed"))', 15),
    "A2": ('=RiskUniform(0,1,RiskShift(5),RiskName("Share"))*A1+RiskOutput("y")', 80),
    "B1": ('=RiskMean("speed")', 77),
    "B2": ('=RiskPercentile("Share",0.9)', 77),
    "B3": ('=RiskCorrel("Speed","y",1)', 77),
    "B4": ('=RiskMean("nobody")', 77),
}


def test_results_of_an_input_by_its_name_are_those_of_its_draws(tmp_path):
    """As drawn, shifted where the call says so, and without the rest of the formula."""
    run = simulated(load(build(tmp_path / "book.xlsx", OF_INPUTS)), trials=500)
    result = {cell.a1: value for cell, value in run.shown_results.cells.items()}
    speed, share = run.inputs["Speed"], run.inputs["Share"] + 5
    assert result["B1"] == pytest.approx(speed.mean(), rel=1e-12)
    assert result["B2"] == pytest.approx(np.percentile(share, 90), rel=1e-12)
    assert result["B3"] == pytest.approx(np.corrcoef(speed, run.forecasts["y"])[0, 1], rel=1e-12)
    assert result["B4"] == ErrorCode.NA
    assert "no forecast is called so: nothing is shown" in " ".join(str(notice) for notice in run.notices)


def test_results_of_an_input_by_its_name_are_the_same_after_conversion(tmp_path):
    model = load(build(tmp_path / "book.xlsx", OF_INPUTS))
    convert(model, tmp_path / "converted.xlsx")
    runs = [simulated(each, trials=500) for each in (model, load(tmp_path / "converted.xlsx"))]
    one, other = ({c.a1: v for c, v in run.shown_results.cells.items() if c.sheet == "S"} for run in runs)
    assert one == other


ASKED_BY = {
    "C1": ("=RiskMean(A2)", -50),
    "C2": ("=RiskTarget(A2,C1)", 0.9),
    "C3": ("=RiskTarget(A2,C1*2-MAX(C1,0))", 0.9),
    "C4": ("=RiskPercentile(A2,C5)", 0.9),
    "C5": ("=1-C2", 0),
    "C6": ("=RiskTarget(A2,RiskMean(A2))", 0.9),
    "C7": ("=RiskMean(A2,RiskTruncate(C1,))", 0.9),
    "C8": ("=LET(p,0.9,RiskPercentile(A2,p))", 0.9),
    "C9": ("=RiskPercentile(A2,RiskTheoXtoP(A1,5))", 0.9),
    "C10": ("=RiskPercentile(A2,SUM($D$2:$D$3))", 0.9),
    "D2": ("=D3*2", 0.6),
    "D3": ("=RiskTheoXtoP(A1,4.4755995)", 0),
    "E1": ("=RiskTarget(A2,E1)", 0.9),
    "E2": ("=RiskTarget(A2,E3)", 0.9),
    "E3": ("=E2+1", 0.9),
    "E4": ("=RiskTarget(A2,RiskCpk(A2,1))", 0.9),
    "E5": ("=RiskTarget(A2,E4)", 0.9),
}


@pytest.mark.parametrize("saved", [True, False], ids=["calculated", "never calculated"])
def test_what_a_result_is_asked_by_is_computed_too(tmp_path, saved):
    """A number that depends on results is that of this run, and not what Excel saved in another one."""
    cells = {**MODEL, **ASKED_BY}
    path = tmp_path / "book.xlsx"
    if saved:
        build(path, cells)
    else:
        book = openpyxl.Workbook()
        book.active.title = "S"
        book.create_sheet("Other")
        for address, (formula, _) in cells.items():
            book.active[address] = formula
        book.save(path)
    run = simulated(load(path), trials=2000)
    result = {cell.a1: value for cell, value in run.shown_results.cells.items()}
    y = run["S!A2"]
    mean, below = y.mean.value, float(np.mean(y.values <= y.values.mean()))
    assert [result[each] for each in ("C1", "C2", "C3", "C6")] == pytest.approx([mean, below, below, below])
    assert result["C4"] == pytest.approx(y.percentile(100 * (1 - below)).value)
    assert result["C7"] == pytest.approx(y.values[y.values >= mean].mean())
    assert result["C8"] == pytest.approx(y.percentile(90).value)
    assert result["C9"] == pytest.approx(y.percentile(50).value)
    assert result["C10"] == pytest.approx(y.percentile(90).value, rel=1e-4)
    assert [result[each] for each in ("E1", "E2", "E3", "E4", "E5")] == [ErrorCode.NA] * 5
    warning = run.shown_results.warning
    assert "S!E1, S!E2 (asks for a result by a number that depends on itself)" in warning.replace("E1:E2", "E1, S!E2")


SIMULATIONS = {
    "A1": ("=RiskSimtable({10,20,30})+RiskNormal(0,1)", 10),
    "A2": ("=A1*2+RiskOutput()", 20),
    "B1": ("=RiskMean($A$2,C1)", 77),
    "B2": ("=RiskMean($A$2,C2)", 77),
    "B3": ("=RiskMean($A$2,C3)-B1", 77),
    "B4": ("=RiskTarget(A2,RiskMean(A2,2),2)", 77),
    "B5": ("=RiskMean(A2,4)", 77),
    "C1": ("=1", 1),
    "C2": ("=C1+1", 2),
    "C3": ("=C2+1", 3),
}


def test_results_of_further_simulations_are_those_of_the_scenarios(tmp_path):
    """Over the same random numbers, so that they differ by exactly twice what the table adds."""
    model = load(build(tmp_path / "book.xlsx", SIMULATIONS))
    plain = simulated(model, trials=500)
    result = shown(plain, tmp_path / "out.xlsx")
    assert [result[each] for each in ("B2", "B3", "B4", "B5")] == ["#N/A"] * 4
    assert "asks for simulation 2, and only simulate --scenarios runs further ones" in plain.shown_results.warning
    assert "RiskMean asks for simulation 4, and RiskSimtable has 3 values" in plain.shown_results.warning
    run = simulated(model, trials=500, scenarios=True)
    scenarios = scenario_answers(run)
    assert len(scenarios) == 3
    result = shown(run, tmp_path / "out.xlsx")
    mean, below = run["S!A2"].mean.value, float(np.mean(run["S!A2"].values <= run["S!A2"].mean.value))
    assert [result[f"B{row}"] for row in (1, 2, 3, 4)] == pytest.approx([mean, mean + 20, 40, below])
    assert result["B5"] == "#N/A"
    assert [each.warnings for each in scenarios[1:]] == [[], []]


RELATIVE = {
    "a mean": 'RiskNormal(INDIRECT("C1"),1)+RiskOutput()',
    "a place that moves": 'RiskNormal(INDIRECT("R1C3",FALSE),1)+RiskOutput()',
    "its own row": 'RiskNormal(INDIRECT("C"&ROW()),1)+RiskOutput()',
    "its own sheet": "RiskNormal(IF(SHEET()=2,50,0),1)+RiskOutput()",
    "within": 'RiskUniform(0,SUM(OFFSET(B1,0,1),INDIRECT("C1")))+RiskOutput()',
}


@pytest.mark.parametrize("formula", RELATIVE.values(), ids=RELATIVE)
def test_an_argument_of_a_draw_may_look_for_its_cell_on_its_own_sheet(tmp_path, formula):
    path = tmp_path / "book.xlsx"
    with xlsxwriter.Workbook(path) as book:
        book.add_worksheet("First").write("C1", -1000)
        sheet = book.add_worksheet("S")
        sheet.write_formula("A1", f"={formula}", None, 5)
        sheet.write("C1", 50)
    run = simulated(load(path), trials=500)
    assert 40 < run["S!A1"].mean.value < 60


def test_an_array_formula_of_results_fills_its_area(tmp_path):
    path = tmp_path / "book.xlsx"
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("S")
        sheet.write_formula("A1", "=RiskNormal(5,1)+RiskOutput()", None, 5)
        sheet.write_array_formula("B1:B2", "{=RiskMean(A1)*{1;2}}", None, 0)
        sheet.write_number("B2", 0)
    run = simulated(load(path), trials=1000)
    Simulation(run).save(tmp_path / "out.xlsx")
    sheet = read_workbook(tmp_path / "out.xlsx").sheets["S"]
    mean = run["S!A1"].mean.value
    assert [sheet.cells[row, 2].value for row in (1, 2)] == pytest.approx([mean, 2 * mean], rel=1e-15)


def test_a_book_without_such_cells_is_not_touched(tmp_path):
    cells = {"A1": ("=RiskNormal(5,1)+RiskOutput()", 5)}
    run = simulated(load(build(tmp_path / "book.xlsx", cells)), trials=100)
    assert run.shown_results.cells == {}


# Cells that cannot be computed: they and all that depends on them show #N/A, and are named.

STALE = 77.0


def run_of(path, cells, **more):
    return simulated(load(build(path, {**MODEL, **cells}, **more)), trials=200)


def shown(run, path):
    """What the result workbook shows: address on the sheet S -> value; others as `Other!A1`.

    Written without the result sheets, which say nothing of these; `filled` has them.
    """
    path.write_bytes(
        package_bytes({**run.model.workbook.parts, **filled_sheets(run.model.workbook, run.shown_results)})
    )
    book = openpyxl.load_workbook(path, data_only=True)
    result = {cell.coordinate: cell.value for row in book["S"].iter_rows() for cell in row}
    return result | {f"Other!{c.coordinate}": c.value for row in book["Other"].iter_rows() for c in row}


MODEL = {"A1": ("=RiskNormal(5,1)", 5), "A2": ("=A1*2+RiskOutput()", 10)}

NOT_COMPUTED = {
    "_xll.RiskCpk(A2,0.95,TRUE)": "RiskCpk is not computed by xlmc",
    "RiskPPMLower(A1)": "RiskPPMLower is not computed by xlmc",
    "RiskTheoMode(A1)": "RiskTheoMode is not computed by xlmc",
    "RiskConvergenceLevel(A2)": "RiskConvergenceLevel is not computed by xlmc",
    "RiskSimulationInfo(1)": "RiskSimulationInfo is not computed by xlmc",
    "[1]!CB.GetAssumStatFN(A1,50)": "CB.GetAssumStatFN is not computed by xlmc",
    "CB.GetForeFN(A1,1)": "CB.GetForeFN is not computed by xlmc",
    "CB.GetDecVarFN(1)": "CB.GetDecVarFN is not computed by xlmc",
    "CB.CheckDataFN()": "CB.CheckDataFN is not computed by xlmc",
    "CB.NobodyKnowsFN(A2)": "the function CB.NOBODYKNOWSFN is not supported",
    "RiskNobodyKnows(A2)": "the function RISKNOBODYKNOWS is not supported",
    "IFERROR(RiskCpk(A2,0.95),1)": "RiskCpk is not computed by xlmc",
    "RiskMean(A2)+RiskCpk(A2,0.95)": "RiskCpk is not computed by xlmc",
    "RiskMean(A2)+RAND()": "the formula both draws and shows results of the run",
    "RiskMean(A2,2)": "RiskMean asks for simulation 2, and RiskSimtable has no values",
    "RiskData(A2,1,RiskTruncate(1,2))": "RiskData of a part of the values is not computed",
    "CB.GetForeStatFN(A2,2,3)": "CB.GetForeStatFN has 1 arguments too many",
    "RiskMean(A1:A2)": "RiskMean must name the cell of an output first",
    "RiskPercentile(A2)": "RiskPercentile has 1 arguments",
    "RiskMean([7]Elsewhere!A1)": "refers to another workbook",
    "RiskMean(A2)+[7]Elsewhere!A1": "refers to another workbook",
    "RiskMean(NoSuchName)": "there is no name 'NoSuchName'",
}


def test_what_xlmc_does_not_compute_shows_not_available_and_is_named(tmp_path):
    """Cells of one reason are named together."""
    of = {f"B{row}": formula for row, formula in enumerate(NOT_COMPUTED, 1)}
    cells = {address: (f"={formula}", STALE) for address, formula in of.items()}
    cells |= {"C1": ("=A1+A2", 15), "D2": ("=RiskMean(A2)", STALE)}
    run = run_of(tmp_path / "book.xlsx", cells)
    result = shown(run, tmp_path / "out.xlsx")
    assert (result["C1"], result["D2"]) == (15, run["S!A2"].mean.value)
    assert {address: result[address] for address in of} == dict.fromkeys(of, "#N/A")
    assert {f"S!{address}" for address in of} == {str(each) for each in run.shown_results.missing if each.sheet == "S"}
    [warning] = run.warnings
    first = {reason: address for address, reason in reversed(list(zip(of, NOT_COMPUTED.values(), strict=True)))}
    for reason, address in first.items():
        assert reason in warning
        assert re.search(rf"\bS!{address}\b", warning)
        reported = [each.message for each in run.model.notices if str(each.where) == f"S!{address}"]
        assert (
            len([message for message in reported if "#N/A" in message and reason.casefold() in message.casefold()]) == 1
        )
    together = "RiskCpk is not computed by xlmc in S!B1, S!B12:B13: #N/A"
    assert any(together in each.message for each in run.model.notices)


DEPENDANTS = {
    "plain": "S!B1+1",
    "a range": "SUM(S!B1:B3)",
    "through another cell": "A1*2",
    "an error that is caught": "IFERROR(S!B1,0)",
    "an error that is asked for": "ISERROR(S!B1)",
    "a defined name": "Stale*2",
    "a name of its own": "Own+1",
    "a place that is looked for": 'INDIRECT("S!B"&1)',
    "an offset": "OFFSET(S!A1,0,1)",
    "what a cell holds": 'CELL("contents",S!B1)',
    "a function nobody knows": "NoSuchFunction(S!B1)",
    "another workbook": "S!$B$1+[7]Elsewhere!A1",
    "another workbook, by a name": "Stale+[7]Elsewhere!A1",
    "a clock": "S!B1+NOW()",
    "a circle": "S!B1+Other!A20",
}


UNKNOWN = ("plain", "an error that is caught", "a name of its own", "a place that is looked for")
"""Dependants that are tried with a function that nobody knows, too."""


@pytest.mark.parametrize(
    ("function", "formula"),
    [
        *(("RiskCpk(A2,0.95)", formula) for formula in DEPENDANTS.values()),
        *(("NoSuchFunction(RiskMean(A2))", DEPENDANTS[name]) for name in UNKNOWN),
    ],
)
def test_whatever_depends_on_such_a_cell_shows_not_available(tmp_path, formula, function):
    path = tmp_path / "book.xlsx"
    with xlsxwriter.Workbook(path) as book:
        sheet, other = book.add_worksheet("S"), book.add_worksheet("Other")
        book.define_name("Stale", "=S!$B$1")
        book.define_name("Own", f"={function.replace('A2', 'S!$A$2')}")
        for address, (text, value) in MODEL.items():
            sheet.write_formula(address, text, None, value)
        sheet.write_formula("B1", f"={function}", None, STALE)
        other.write_formula("A1", "=S!B1", None, STALE)
        other.write_formula("A20", f"={formula}", None, STALE)
        other.write_formula("A21", "=A20&A20", None, "stale")
        other.write_formula("A22", "=S!A2", None, 10)
    run = simulated(load(path), trials=200)
    result = shown(run, tmp_path / "out.xlsx")
    assert [result[address] for address in ("B1", "Other!A1", "Other!A20", "Other!A21")] == ["#N/A"] * 4
    assert result["Other!A22"] == 10
    [warning] = run.warnings
    assert warning.startswith(f"{len(run.shown_results.missing)} cells of the workbook depend on the run")
    assert "S!B1" in warning
    assert {"S!B1", "Other!A1", "Other!A20", "Other!A21"} <= {str(cell) for cell in run.shown_results.missing}


COMPUTED = {
    "a place that is looked for": 'INDIRECT("S!B"&1)*2',
    "an offset": "OFFSET(S!A1,0,1)*2",
    "a defined name": "Shown*2",
    "a name that holds the call": "Own*2",
    "a name of that name": "Twice",
}


@pytest.mark.parametrize("formula", COMPUTED.values(), ids=COMPUTED)
def test_results_are_followed_wherever_they_go(tmp_path, formula):
    path = tmp_path / "book.xlsx"
    with xlsxwriter.Workbook(path) as book:
        sheet, other = book.add_worksheet("S"), book.add_worksheet("Other")
        book.define_name("Shown", "=S!$B$1")
        book.define_name("Own", "=RiskMean(S!$A$2)")
        book.define_name("Twice", "=2*Own")
        for address, (text, value) in MODEL.items():
            sheet.write_formula(address, text, None, value)
        sheet.write_formula("B1", "=RiskMean(A2)", None, STALE)
        other.write_formula("A1", f"={formula}", None, STALE)
        other.write_formula("A2", "=A1+1", None, STALE)
        other.write_formula("A3", 'INDIRECT("S!A1")', None, 5)
    run = simulated(load(path), trials=200)
    assert run.warnings == []
    result, mean = shown(run, tmp_path / "out.xlsx"), run["S!A2"].mean.value
    assert (result["Other!A1"], result["Other!A2"], result["Other!A3"]) == (2 * mean, 2 * mean + 1, 5)


def test_a_name_that_draws_is_drawn(tmp_path):
    """What a name stands for is no constant, though its cell holds no call."""
    path = tmp_path / "book.xlsx"
    with xlsxwriter.Workbook(path) as book:
        book.define_name("Speed", "=RiskNormal(5,1)")
        sheet = book.add_worksheet("S")
        sheet.write_formula("A1", "=Speed*2+RiskOutput()", None, 10)
    run = simulated(load(path), trials=200)
    assert [a.name for a in run.model.assumptions] == ["S!A1#1"]
    assert run["S!A1"].standard_deviation.value > 1


def test_an_array_formula_that_cannot_be_computed(tmp_path):
    path = tmp_path / "book.xlsx"
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("S")
        book.add_worksheet("Other")
        for address, (text, value) in MODEL.items():
            sheet.write_formula(address, text, None, value)
        sheet.write_array_formula("B1:B2", "{=RiskCpk(A2,0.95)*{1;2}}", None, STALE)
        sheet.write_number("B2", STALE)
        sheet.write_formula("C1", "=B2", None, STALE)
        sheet.write_formula("D1", "=RiskMax(A2)", None, STALE)
        sheet.write_dynamic_array_formula("E1:E2", "=SEQUENCE(ROUND(D1,0))", None, STALE)
        sheet.write_number("E2", STALE)
        sheet.write_formula("F1", "=SUM(E1:E2)", None, STALE)
    run = simulated(load(path), trials=200)
    result = shown(run, tmp_path / "out.xlsx")
    assert [result[address] for address in ("B1", "B2", "C1", "E1", "E2", "F1")] == ["#N/A"] * 6
    assert result["D1"] == run["S!A2"].statistics.maximum.value
    assert "S!E1 (the formula spills into another area than when the file was saved)" in run.warnings[0]


def test_a_draw_that_xlmc_does_not_know_keeps_its_base_case(tmp_path):
    """The run does not need it, and what Excel saved is the base case."""
    run = run_of(tmp_path / "book.xlsx", {"B1": ("=RiskLaplace(1,2)", 1.5), "B2": ("=B1*2", 3)})
    result = shown(run, tmp_path / "out.xlsx")
    assert (result["B1"], result["B2"], run.warnings) == (1.5, 3, [])


def test_the_fingerprint_of_the_original_stays(tmp_path):
    run = run_of(tmp_path / "book.xlsx", {"B1": ("=RiskCpk(A2,0.95)", STALE), "B2": ("=B1*2", STALE)})
    with pytest.MonkeyPatch.context() as patch:
        leave_out(patch, *CHARTS, *SENSITIVITY)
        Simulation(run).save(tmp_path / "out.xlsx")
    hashes = [original_hash(read_parts((tmp_path / name).read_bytes())) for name in ("book.xlsx", "out.xlsx")]
    assert hashes[0] == hashes[1]


def test_a_forecast_cannot_depend_on_such_a_cell(tmp_path):
    cells = {"A3": ("=A1+B1+RiskOutput()", 1), "B1": ("=RiskCpk(A2,0.95)", STALE)}
    with pytest.raises(FormulaError, match="S!B1: RiskCpk is not computed by xlmc"):
        load(build(tmp_path / "book.xlsx", {**MODEL, **cells}))


# What-if data tables.

FILLED = '<c r="{0}"><f t="dataTable" ref="D2:D3" dt2D="0" dtr="0" r1="{1}"/><v>77</v></c>'


def with_table(path, cells, source="A1", header=("=A2", 10)):
    """A book with a data table in D2:D3: the formula above it, values on its left, and cells that read it."""
    plain = {"C2": ("=1", 1), "C3": ("=2", 2), "D2": ("=0", 77), "D3": ("=0", 77)}
    build(path, {**MODEL, **plain, "D1": header, "E1": ("=SUM(D2:D3)", 154), **cells})
    parts = read_parts(path.read_bytes())
    xml = parts["xl/worksheets/sheet1.xml"].decode()
    xml = re.sub(r'<c r="D2">.*?</c>', FILLED.format("D2", source), xml)
    xml = re.sub(r'<c r="D3">.*?</c>', '<c r="D3"><v>77</v></c>', xml)
    with zipfile.ZipFile(path, "w") as package:
        for name, content in {**parts, "xl/worksheets/sheet1.xml": xml.encode()}.items():
            package.writestr(name, content)
    return path


OF_THE_RUN = {
    "its formula shows a result": {"source": "F1", "header": ("=RiskMean(A2)", 77)},
    "its formula depends on a result": {"source": "F1", "header": ("=B1", 77), "cells": {"B1": ("=RiskMean(A2)", 77)}},
    "its formula cannot be computed": {"source": "F1", "header": ("=RiskCpk(A2,0.9)", 77)},
    "its formula looks for its cells, and there are results": {
        "source": "F1",
        "header": ('=INDIRECT("B1")', 10),
        "cells": {"B1": ("=RiskMean(A2)", 77)},
    },
    "a value on its left shows a result": {"source": "F1", "header": ("=7", 7), "cells": {"C3": ("=RiskMax(A2)", 10)}},
}

VARYING = {
    "its input is an assumption": {"cells": {"A1": ("=RiskNormal(5,1)", 5)}, "header": ("=7", 7)},
    "its formula depends on a draw": {"source": "F1"},
    "its formula draws": {"source": "F1", "header": ("=RiskNormal(1,2)+F1", 1)},
    "its formula looks for its cells": {"source": "F1", "header": ('=INDIRECT("A2")', 10)},
    "a value on its left depends on a draw": {"source": "F1", "header": ("=7", 7), "cells": {"C3": ("=A2", 10)}},
}


@pytest.mark.parametrize("made", OF_THE_RUN.values(), ids=OF_THE_RUN)
def test_a_data_table_of_the_run_shows_not_available_and_is_named(tmp_path, made):
    path = with_table(tmp_path / "book.xlsx", **{"cells": {}, **made})
    run = simulated(load(path), trials=200)
    result = shown(run, tmp_path / "out.xlsx")
    assert [result[address] for address in ("D2", "D3", "E1")] == ["#N/A"] * 3
    [warning] = run.warnings
    assert "S!D2:D3 (what-if data tables that depend on the run are not computed by xlmc)" in warning
    assert "S!E1 (depends on such a cell)" in warning
    [notice] = [notice for notice in run.model.notices if str(notice.where) == "S!D2:D3"]
    assert "show #N/A" in notice.message
    hashes = [original_hash(read_parts((tmp_path / name).read_bytes())) for name in ("book.xlsx", "out.xlsx")]
    assert hashes[0] == hashes[1]


def test_a_data_table_that_has_nothing_to_do_with_the_run_keeps_its_values(tmp_path):
    run = simulated(load(with_table(tmp_path / "book.xlsx", {}, "F1", ("=F1*2", 0))), trials=200)
    result = shown(run, tmp_path / "out.xlsx")
    assert [result[address] for address in ("D2", "D3", "E1")] == [77, 77, 154]
    assert run.warnings == []
    [notice] = [notice for notice in run.model.notices if str(notice.where) == "S!D2:D3"]
    assert "kept at the values Excel last calculated" in notice.message


@pytest.mark.parametrize("made", VARYING.values(), ids=VARYING)
def test_a_data_table_over_what_varies_keeps_its_base_case_like_every_other_cell(tmp_path, made):
    run = simulated(load(with_table(tmp_path / "book.xlsx", **{"cells": {}, **made})), trials=200)
    result = shown(run, tmp_path / "out.xlsx")
    assert [result[address] for address in ("D2", "D3", "E1")] == [77, 77, 154]
    assert run.warnings == []
    [notice] = [notice for notice in run.model.notices if str(notice.where) == "S!D2:D3"]
    assert "kept at the values Excel last calculated for the base case; where a forecast" in notice.message


@pytest.mark.parametrize("made", OF_THE_RUN.values(), ids=OF_THE_RUN)
def test_a_forecast_cannot_depend_on_a_data_table_that_shows_results(tmp_path, made):
    cells = {**made.get("cells", {}), "A5": ("=E1+A1+RiskOutput()", 1)}
    with pytest.raises(FormulaError, match="What-if data tables that depend on the run are not computed"):
        load(with_table(tmp_path / "book.xlsx", **{**made, "cells": cells}))


@pytest.mark.parametrize("made", VARYING.values(), ids=VARYING)
def test_a_forecast_may_depend_on_a_data_table_that_varies(tmp_path, made):
    """Its cells hold no formulas, and would pass for constants: 77."""
    cells = {**made.get("cells", {}), "A5": ("=D3+RiskOutput()", 1)}
    run = simulated(load(with_table(tmp_path / "book.xlsx", **{**made, "cells": cells})), trials=200)
    values = next(values for name, values in run.forecasts.items() if "A5" in str(run[name].definition.cell))
    assert not np.any(values == 77)


@pytest.mark.parametrize("writer", ["openpyxl", "XlsxWriter"])
def test_cells_that_were_never_calculated_are_computed_and_not_taken_for_0(tmp_path, writer):
    """Beside a cell that shows a result: a constant's double, and one that depends on a draw, at its base case."""
    formulas = {
        "A1": "=CB.Normal(100,10)",
        "A2": "=A1*2",
        "F1": 7,
        "F2": "=F1*2",
        "F3": "=F2+A1",
        "C1": "=CB.GetForeStatFN(A2,2)",
        "C2": "=C1-F2",
        "C3": '=IF(C1>F2*20,"over","within")',
        "C4": "=C1+F3",
        "C5": "=SUM(F1:F2)+C1*0",
    }
    path = tmp_path / "book.xlsx"
    if writer == "openpyxl":
        book = openpyxl.Workbook()
        for address, content in formulas.items():
            book.active[address] = content
        book.save(path)
    else:
        with xlsxwriter.Workbook(path) as book:
            sheet = book.add_worksheet("Sheet")
            for address, content in formulas.items():
                sheet.write(address, content)
    run = simulated(load(path), 2000, seed=4)
    shown = {cell.a1: value for cell, value in run.shown_results.cells.items()}
    mean = run.results[next(iter(run.results))].mean.value
    assert shown["C1"] == pytest.approx(mean, rel=1e-12)
    assert shown["C2"] == pytest.approx(mean - 14, rel=1e-12)
    assert (shown["C3"], shown["C5"]) == ("within", 21.0)
    assert shown["C4"] == pytest.approx(mean + 114, rel=1e-12)
    assert run.warnings == []


AT_BASE = {
    "A1": "=RiskNormal(100,10)",
    "A2": "=RiskTheoMean(A1)",
    "A3": '=RiskOutput("y")+A1-A2+7',
    "A4": '=RiskOutput("z")+RiskNormal(A2,1)+RiskUniform(0,A2)',
    "A5": "=A2*1.1",
    "A6": "=RiskDiscrete({1,5},{0.25,0.75},RiskShift(100),RiskStatic(106))+RAND()+A2*0",
    "A7": '=SUM(A1:A3)+RiskOutput("sum",,,RiskUnits("m"))',
    "B1": "=RiskMean(A3)-A1",
    "B2": '=IF(RiskMean("z")>A6,"a","b")',
    "B3": "=RiskMean(A7)+A4",
}


@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_cells_that_draw_or_mark_an_answer_keep_their_base_case_below_a_number_of_a_distribution(tmp_path, engine):
    path = tmp_path / "book.xlsx"
    book = openpyxl.Workbook()
    for address, content in AT_BASE.items():
        book.active[address] = content
    book.save(path)
    run = simulated(load(path), 2000, seed=4, engine=engine)
    shown = {cell.a1: value for cell, value in run.shown_results.cells.items()}
    y, total = run["y"].mean.value, run["sum"].mean.value
    assert [shown[each] for each in ("A2", "A3", "A4", "A5")] == pytest.approx([100, 7, 150, 110])
    assert [shown[each] for each in ("A6", "A7", "B1", "B3")] == pytest.approx([106.5, 207, y - 100, total + 150])
    assert shown["B2"] == "a"
    assert run.warnings == []


def test_a_draw_whose_base_case_is_not_known_is_named_as_that(tmp_path):
    path = tmp_path / "book.xlsx"
    book = openpyxl.Workbook()
    cells = {"A1": "=RiskNormal(0,1)", "A2": "=RiskNormal(A1*A1,1)+RiskOutput()", "B1": "=RiskMean(A2)-A2"}
    for address, content in cells.items():
        book.active[address] = content
    book.save(path)
    warning = simulated(load(path), 200).shown_results.warning
    assert "Sheet!A2 (the formula draws at random, and its base case is not known)" in warning


def test_percentiles_of_values_that_repeat_are_among_them(tmp_path):
    formulas = {
        "A1": ('=RiskOutput("y")+RiskDiscrete({10,20,30},{1,1,1})', 20),
        "A2": ('=RiskOutput("z")+RiskUniform(0,1)', 0.5),
        "A3": ('=RiskOutput("cut")+MAX(0,RiskNormal(0,1))', 0),
    }
    asked = {"A1": 0.3334, "A2": 0.25, "A3": 0.75}
    for row, (cell, p) in enumerate(asked.items(), start=1):
        formulas |= {
            f"B{row}": (f"=RiskPercentile({cell},{p})", 0),
            f"C{row}": (f"=CB.GetForePercentFN({cell},{100 * p})", 0),
            f"E{row}": (f"=RiskPercentileD({cell},1-{p})", 0),
        }
    run = simulated(load(build(tmp_path / "book.xlsx", formulas)), 3000)
    result = {str(cell): value for cell, value in run.shown_results.values.items()}
    for row, (cell, p) in enumerate(asked.items(), start=1):
        x = np.sort(run[{"A1": "y", "A2": "z", "A3": "cut"}[cell]].values)
        expected = np.percentile(x, 100 * p) if cell == "A2" else x[math.ceil(p * x.size - 1e-9) - 1]
        assert [result[f"S!{column}{row}"] for column in "BCE"] == pytest.approx([expected] * 3, rel=1e-12)
