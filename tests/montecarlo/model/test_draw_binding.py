from __future__ import annotations

from dataclasses import replace

import numpy as np
import openpyxl
import pytest
from openpyxl.workbook.defined_name import DefinedName
from openpyxl.worksheet.table import Table
from simulated import simulated

from xlmc.analysis.studies.comparison.variations import with_changes
from xlmc.engine.engines import ENGINES
from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.workbook import CellContent
from xlmc.montecarlo.definitions.definitions import Assumption
from xlmc.montecarlo.definitions.definitions_reader import read_definitions
from xlmc.montecarlo.distributions import FAMILIES, ByPercentiles, Family
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel

UNIT = {"low": 0, "high": 1}


def drawn(model, name, n=64, seed=1):
    return model.sampler(seed, n).draw(0)[name]


def test_parameters_that_no_assumption_reaches_become_numbers(book):
    cells = {"A1": 1.0, "B1": "=B2*2", "B2": 5.0, "B3": "=B1+1"}
    model = book(cells, {"a": {"cell": "A1", "low": "B1", "high": "B3"}}, {"x": "A1"})
    assert model.fallible == frozenset()
    values = drawn(model, "a")
    assert 10 <= values.min() < values.max() <= 11


def test_cutoffs(book):
    given = {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1, "lower_cutoff": "B1"}
    model = book({"A1": 1.0, "B1": "=1/2"}, {"a": given}, {"x": "A1"})
    assert drawn(model, "a").min() >= 0.5


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"low": 2, "high": 1}, "a: Low (2) is above High (1)"),
        ({"low": 2, "high": "B1"}, "a: Low (2) is above High (1)"),
        ({**UNIT, "lower_cutoff": 0.9, "upper_cutoff": 0.1}, "a: Lower cutoff (0.9) is not below Upper cutoff (0.1)"),
        ({**UNIT, "lower_cutoff": 5}, "a: Lower cutoff (5) leaves nothing of the distribution"),
    ],
)
def test_numbers_that_are_no_distribution(book, given, message):
    with pytest.raises(DefinitionError) as caught:
        book({"A1": 1.0, "B1": "=2-1"}, {"a": {"cell": "A1", **given}}, {"x": "A1"})
    assert (caught.value.message, caught.value.where) == (message, "S!A1")
    assert caught.value.hint


def by_percentiles(book, p10, **cutoffs):
    """A model with one assumption `a` in A1, normal by its percentiles 10 and 90; `b` is uniform in A2."""
    model = book(
        {"A1": 1.0, "A2": 1.0, "B1": "=2/2", "B2": "=A2+1"}, {"b": {"cell": "A2", **UNIT}}, {"x": "A1", "y": "A2"}
    )
    given = {"p10": p10, "p90": 9.0, **cutoffs}
    family = ByPercentiles(FAMILIES["Normal"], (), (10.0, 90.0))
    a = Assumption("a", Cell("S", 1, 1), "Normal", given, Cell("S", 1, 1), base=1.0, own_family=family)
    definitions = replace(model.definitions, assumptions=(a, *model.definitions.assumptions))
    return CompiledModel(model.workbook, definitions, model.path)


@pytest.mark.parametrize("p10", [1.0, Cell("S", 1, 2)])
def test_percentiles_in_place_of_parameters(book, p10):
    """Of 100,000 draws a tenth lies below each, give or take four standard errors."""
    values = drawn(by_percentiles(book, p10), "a", n=100_000)
    error = 4 * np.sqrt(0.1 * 0.9 / 100_000)
    assert abs((values < 1).mean() - 0.1) < error
    assert abs((values > 9).mean() - 0.1) < error


def test_percentiles_of_a_truncated_distribution(book):
    values = drawn(by_percentiles(book, 1.0, lower_cutoff=5.0), "a")
    assert values.min() >= 5


def test_percentiles_that_no_member_has(book):
    with pytest.raises(DefinitionError) as caught:
        by_percentiles(book, 10.0)
    assert caught.value.message == "a: P10 (10) is not below P90 (9)"


def test_percentiles_cannot_vary(book):
    with pytest.raises(DefinitionError) as caught:
        by_percentiles(book, Cell("S", 2, 2))
    assert caught.value.message == "a: a distribution given by percentiles cannot depend on another assumption"
    assert (caught.value.where, caught.value.hint) == ("S!B2", "give it by its parameters, or by numbers")


@pytest.mark.parametrize(("formula", "message"), [("=1/0", "the error #DIV/0!"), ('="x"', "the error #VALUE!")])
def test_a_parameter_that_is_no_number(book, formula, message):
    with pytest.raises(DefinitionError, match=f"High of 'a' is {message}") as caught:
        book({"A1": 1.0, "B1": formula}, {"a": {"cell": "A1", "low": 0, "high": "B1"}}, {"x": "A1"})
    assert caught.value.where == "S!B1"


def test_parameters_that_vary(book):
    cells = {"A1": 1.0, "A2": 2.0, "B1": "=A1+1"}
    given = {"a": {"cell": "A1", **UNIT}, "b": {"cell": "A2", "low": "A1", "high": "B1"}}
    model = book(cells, given, {"x": "A2"})
    assert model.fallible == {"b"}
    draws = model.sampler(1, 256).draw(0)
    assert ((draws["a"] <= draws["b"]) & (draws["b"] <= draws["a"] + 1)).all()


def test_a_varying_cutoff(book):
    given = {"a": {"cell": "A1", **UNIT}, "b": {"cell": "A2", "upper_cutoff": "A1", **UNIT}}
    draws = book({"A1": 1.0, "A2": 2.0}, given, {"x": "A2"}).sampler(1, 256).draw(0)
    assert (draws["b"] <= draws["a"]).all()


def test_a_chain_of_parameters(book):
    given = {
        "c": {"cell": "A3", "low": "A2", "high": "B2"},
        "b": {"cell": "A2", "low": "A1", "high": "B1"},
        "a": {"cell": "A1", **UNIT},
    }
    cells = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "B1": "=A1+1", "B2": "=A2+1"}
    draws = book(cells, given, {"x": "A3"}).sampler(1, 256).draw(0)
    assert ((draws["a"] <= draws["b"]) & (draws["b"] <= draws["c"]) & (draws["c"] <= draws["a"] + 2)).all()


def test_trials_whose_parameters_are_errors_are_nan(book):
    given = {"a": {"cell": "A1", "low": -1, "high": 1}, "b": {"cell": "A2", "low": 0, "high": "B1"}}
    draws = book({"A1": 1.0, "A2": 2.0, "B1": "=SQRT(A1)"}, given, {"x": "A2"}).sampler(1, 256).draw(0)
    assert np.array_equal(np.isnan(draws["b"]), draws["a"] < 0)
    assert (draws["a"] < 0).any()


def test_a_parameter_may_come_to_terms_with_an_error(book):
    given = {
        "a": {"cell": "A1", "low": -1, "high": 1},
        "b": {"cell": "A2", "low": 0, "high": "B1"},
        "c": {"cell": "A3", "low": 5, "high": "B2"},
    }
    cells = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "B1": "=SQRT(A1)", "B2": "=IFERROR(A2+6,5)"}
    draws = book(cells, given, {"x": "A3"}).sampler(1, 256).draw(0)
    assert (draws["a"] < 0).any()
    assert (draws["c"][draws["a"] < 0] == 5).all()
    assert (draws["c"][draws["a"] > 0] > 5).all()


CELLS = {"A1": 100.0, "A2": 2.0, "C1": "=A1*0.97", "C2": "=A1*1.03", "B1": "=A1"}
MEASURED = {"cell": "A1", "low": "C1", "high": "C2"}


def parameters(model):
    return dict(model.assumptions[0].parameters)


@pytest.mark.parametrize(
    ("cells", "of_workbook"),
    [
        ({}, {}),
        ({"C1": "=Measured*0.97"}, {"names": {"Measured": "S!$A$1"}}),
        ({"C1": "=A1-D1", "D1": "=A1*3%"}, {}),
        ({"C1": "=A1-D1*A1", "D1": 0.03}, {}),
        ({"C1": "=SUM(A1:A1)-D1", "D1": "=D2*MAX(A1:B1)", "D2": 0.03}, {}),
        ({"C1": "=ROUND(A1*0.97,2)"}, {}),
        ({"C1": "=A1*OFFSET(D1,0,1)", "E1": 0.97}, {}),
    ],
    ids=["direct", "name", "helper column", "constant", "ranges", "function", "offset"],
)
def test_a_limit_of_the_own_cell_is_one_of_its_base_value(book, cells, of_workbook):
    model = book(CELLS | cells, {"v": MEASURED}, {"x": "B1"}, **of_workbook)
    assert parameters(model) == {"low": 97.0, "high": 103.0}
    values = simulated(model, 2000, seed=1).results["x"].values
    assert values.size == 2000
    assert 97 <= values.min() < 97.1 < 102.9 < values.max() <= 103


def test_every_parameter_and_cutoff_may_be_one(book):
    given = {"cell": "A1", "distribution": "Triangular", "low": "C1", "likeliest": "C3", "high": "C2"}
    cutoffs = {"lower_cutoff": "C4", "upper_cutoff": "C5"}
    more = {"C3": "=A1", "C4": "=A1-1", "C5": "=A1+2"}
    assumption = book(CELLS | more, {"v": given | cutoffs}, {"x": "B1"}).assumptions[0]
    assert assumption.parameters == {"low": 97.0, "likeliest": 100.0, "high": 103.0}
    assert [*assumption.cutoffs.values()] == [99.0, 102.0]


def test_a_frozen_assumption_shows_the_same_limits(book):
    model = book(CELLS, {"v": MEASURED | {"frozen": True}, "w": {"cell": "A2", "low": 1, "high": 3}}, {"x": "A2"})
    assert parameters(model) == {"low": 97.0, "high": 103.0}


def test_what_a_frozen_assumption_is_held_at_counts(book):
    cells = CELLS | {"C1": "=A1*A2-103"}
    model = book(cells, {"v": MEASURED, "w": {"cell": "A2", "low": 1, "high": 3, "frozen": True}}, {"x": "B1"})
    assert parameters(model) == {"low": 97.0, "high": 103.0}


def test_a_limit_that_indirect_leads_to_another_assumption_waits_for_it(book):
    cells = CELLS | {"C1": '=INDIRECT("A"&2)*30', "C2": 120.0}
    given = {"v": MEASURED | {"high": 120}, "w": {"cell": "A2", "low": 1, "high": 3}}
    model = book(cells, given, {"v": "B1", "w": "A2"})
    assert [list(stage) for stage in model.needed.stages] == [["w"], ["v"]]
    results = simulated(model, 1000, seed=1).results
    assert (results["v"].values >= 30 * results["w"].values).all()


def test_a_limit_of_another_assumption_stays_dynamic(book):
    cells = CELLS | {"C3": "=A1*2"}
    model = book(cells, {"v": MEASURED, "w": {"cell": "A2", "low": 0, "high": "C3"}}, {"x": "A2", "y": "B1"})
    simulation = simulated(model, 2000, seed=1)
    assert list(model.needed.stages[1]) == ["w"]
    ratio = simulation.results["x"].values / simulation.results["y"].values
    assert 1.99 < ratio.max() <= 2.0


def test_the_cell_of_a_limit_keeps_its_formula_for_the_forecasts(book):
    model = book(CELLS, {"v": MEASURED}, {"x": "C1", "y": "B1"})
    results = simulated(model, 100, seed=1).results
    assert np.allclose(results["x"].values, 0.97 * results["y"].values, rtol=1e-15)


def test_a_notice_says_what_was_done(book):
    model = book(CELLS, {"v": MEASURED}, {"x": "B1"})
    text = "S!A1: Parameters are computed from the base value of the assumption's own cell (100): Low 97, High 103"
    assert [str(notice) for notice in model.notices] == [text]
    again = CompiledModel(model.workbook, model.definitions, model.path)
    assert [str(notice) for notice in again.notices] == [text]


@pytest.mark.parametrize(
    ("cells", "more", "message", "hint", "where"),
    [
        (
            {"C1": "=A1*0.97-A2"},
            {"w": {"cell": "A2", "low": 1, "high": 2}},
            "Low of 'v' depends on the assumption's own cell and on the assumption 'w'",
            "In its formula, type the number 100 instead of S!A1",
            "S!C1",
        ),
        (
            {"A1": None},
            {},
            "Low of 'v' depends on the assumption's own cell, which is blank",
            "Type the measured value into S!A1",
            "S!C1",
        ),
        ({"C1": "=1/(A1-100)"}, {}, "Low of 'v' is the error #DIV/0!", "Correct the cell's formula", "S!C1"),
        (
            {"C1": '=INDIRECT("A"&1)*0.97'},
            {},
            "parameters of assumptions need each other in a circle: 'v' → 'v'",
            "refer to S!A1 in its parameters without OFFSET and INDIRECT, or type them as numbers",
            "S!A1",
        ),
        ({"C1": "=A1*1.05"}, {}, "v: Low (105) is above High (103)", None, "S!A1"),
    ],
    ids=["another assumption too", "blank", "error", "indirect", "no distribution"],
)
def test_what_cannot_be_taken_from_the_base_value_is_refused(book, cells, more, message, hint, where):
    with pytest.raises(DefinitionError) as caught:
        book(CELLS | cells, {"v": MEASURED, **more}, {"x": "B1"})
    assert (caught.value.message, caught.value.where) == (message, where)
    assert hint is None or caught.value.hint == hint


HEADINGS = ["Name", "Value", "Low", "High", "Upper cutoff", "Frozen"]


def saved_book(path, rows, headings=HEADINGS, corner="A1", outside=(), name=None, answer=None):
    """A workbook whose first sheet holds the assumptions, and whose forecast is the sum of their cells."""
    file = openpyxl.Workbook()
    sheet = file.active
    sheet.title = "Inputs"
    for row in [headings, *rows]:
        sheet.append(row)
    end = sheet.cell(len(rows) + 1, len(headings)).coordinate
    sheet.add_table(Table(displayName="xlmc_assumptions", ref=f"{corner}:{end}"))
    for address, value in outside:
        sheet[address] = value
    if name:
        file.defined_names[name[0]] = DefinedName(name[0], attr_text=name[1])
    answers = file.create_sheet("Answers")
    for row in (["Name", "Cell"], ["speed", "=Answers!D1"]):
        answers.append(row)
    answers["D1"] = answer or ("=Inputs!B2" if "Value" in headings else "=Inputs!J1")
    answers.add_table(Table(displayName="xlmc_forecasts", ref="A1:B2"))
    file.save(path)
    return path


@pytest.mark.parametrize(
    ("low", "high"),
    [
        ("=B2*0.97", "=$B$2*1.03"),
        ("=xlmc_assumptions[[#This Row],[Value]]*0.97", "=xlmc_assumptions[[#This Row],[Value]]*(1+3%)"),
        ("=speed*0.97", "=Inputs!speed*1.03"),
    ],
    ids=["cell", "structured", "name"],
)
def test_the_column_value_of_a_saved_table(tmp_path, low, high):
    rows = [["speed", 40, low, high, "=B2*1.02", None]]
    model = load(saved_book(tmp_path / "a.xlsx", rows, name=("speed", "Inputs!$B$2")))
    assumption = model.assumptions[0]
    assert dict(assumption.parameters) == pytest.approx({"low": 38.8, "high": 41.2}, rel=1e-15)
    assert assumption.cutoffs["upper_cutoff"] == pytest.approx(40.8, rel=1e-15)


def test_the_column_cell_of_a_saved_table(tmp_path):
    rows = [["speed", "=Inputs!J1", "=J1*0.97", "=K1"]]
    headings = ["Name", "Cell", "Low", "High"]
    path = saved_book(tmp_path / "a.xlsx", rows, headings, outside=[("J1", 40), ("K1", "=J1*1.03")])
    assert dict(load(path).assumptions[0].parameters) == pytest.approx({"low": 38.8, "high": 41.2}, rel=1e-15)


CUT = ["Name", "Value", "Distribution", "Low", "High", "Lower cutoff"]
FAMILIES_READ = [["speed", 40, None, 38, 42, None], ["time", 2, "Discrete Uniform", 1, 6, 2.5]]


@pytest.fixture
def read_book(tmp_path):
    """A uniform and a discrete uniform, cut off, whose numbers are typed; the forecast is the first."""
    return load(saved_book(tmp_path / "a.xlsx", FAMILIES_READ, CUT))


def test_numbers_are_checked_once(tmp_path, monkeypatch):
    checks, valid, broken_rule = [], Family.valid, Family.broken_rule

    def rule(self, *values):
        checks.append((self.name, values))
        return broken_rule(self, *values)

    monkeypatch.setattr(Family, "broken_rule", rule)
    monkeypatch.setattr(Family, "valid", lambda *given: pytest.fail(f"checked again: {given}") and valid(*given))
    path = saved_book(tmp_path / "a.xlsx", FAMILIES_READ, CUT, answer="=Inputs!B2+Inputs!B3")
    simulated(load(path), 1000, seed=1)
    assert checks == [("Uniform", (38.0, 42.0)), ("Discrete Uniform", (1.0, 6.0))]


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"given": {"low": 43.0, "high": 42.0}}, "speed: Low (43) is above High (42)"),
        (
            {"given": {"low": 38.0, "high": 42.0, "lower_cutoff": 50.0}},
            "speed: Lower cutoff (50) leaves nothing of the distribution",
        ),
        ({"given": {"low": 38.0, "high": 42.0, "upper_cutoff": np.nan}}, "speed: Upper cutoff must be a number"),
        ({"given": {"low": 38.0, "high": np.nan}}, "speed: High (nan) must be a number between -1E150 and 1E150"),
        (
            {"distribution": "Discrete Uniform", "given": {"low": 38.5, "high": 42.0}},
            "speed: Low (38.5) must be a whole number from -1,000,000,000 to 1,000,000,000",
        ),
    ],
)
def test_numbers_that_take_the_place_of_those_that_were_read_are_checked(read_book, changed, message):
    speed, *others = read_book.assumptions
    definitions = replace(read_book.definitions, assumptions=(replace(speed, **changed), *others))
    with pytest.raises(DefinitionError) as caught:
        CompiledModel(read_book.workbook, definitions, read_book.path)
    assert (caught.value.message, caught.value.where) == (message, "Inputs!A2")


@pytest.mark.parametrize("number", [int, np.int64, np.float32, np.float64])
def test_numbers_of_other_types_are_taken_as_floats(read_book, number):
    speed, *others = read_book.assumptions
    same = replace(speed, given={"low": number(38), "high": number(42)})
    definitions = replace(read_book.definitions, assumptions=(same, *others))
    result = simulated(CompiledModel(read_book.workbook, definitions, read_book.path), 100, seed=1)
    assert result.inputs["speed"].tolist() == simulated(read_book, 100, seed=1).inputs["speed"].tolist()


@pytest.mark.parametrize(
    "changed", [{"distribution": "Discrete Uniform"}, {"own_family": FAMILIES["Discrete Uniform"]}]
)
def test_the_same_numbers_are_checked_for_another_family(tmp_path, changed):
    model = load(saved_book(tmp_path / "a.xlsx", [["speed", 40, None, 38.5, 42, None]], CUT))
    with pytest.raises(DefinitionError, match=r"^Inputs!A2: speed: Low \(38.5\) must be a whole number"):
        with_changes(model, drawn_as={"speed": replace(model.assumptions[0], **changed)})


@pytest.mark.parametrize("low", ["=B2*1.1", "=Answers!D2"], ids=["own cell", "another cell"])
def test_a_number_that_excel_saved_does_not_vouch_for_the_one_that_is_computed(tmp_path, low):
    """Excel saved 38, a good one; the formula gives 44."""
    path = saved_book(tmp_path / "a.xlsx", [["speed", 40, None, low, 42, None]], CUT)
    book = read_workbook(path)
    held = dict(book.sheets["Inputs"].cells)
    held[2, 4] = replace(held[2, 4], value=38.0)
    sheets = {**{name: book.sheets[name] for name in book.sheets}, "Inputs": replace(book.sheets["Inputs"], cells=held)}
    answers = {**sheets["Answers"].cells, (2, 4): CellContent(44.0)}
    book = replace(book, sheets=sheets | {"Answers": replace(sheets["Answers"], cells=answers)})
    definitions = read_definitions(book, ENGINES)
    assert not definitions.problems
    with pytest.raises(DefinitionError) as caught:
        CompiledModel(book, definitions, path)
    assert (caught.value.message, caught.value.where) == ("speed: Low (44) is above High (42)", "Inputs!A2")
