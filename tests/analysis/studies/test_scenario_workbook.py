"""A scenario typed into a workbook: these cells, the formulas that depend on them, and not a byte more."""

from __future__ import annotations

import io
import re
import shutil
import zipfile
from pathlib import Path

import openpyxl
import pytest
from openpyxl.worksheet.table import Table
from simulated import simulated

from xlmc.analysis.studies.scenario_answers import model_of
from xlmc.analysis.studies.scenario_workbook import edited_workbook, write_edited
from xlmc.analysis.studies.verify import Status, verify
from xlmc.api import Model, Simulation
from xlmc.errors import DefinitionError, SimulationError, WorkbookError
from xlmc.excel.address import parse_address
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.definitions.scenarios import Band, Frozen, Limits, Range, Scenario, Typed
from xlmc.montecarlo.model.applied_changes import applied
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.simulation.simulate import simulate

CASE = Path("examples/intersection.xlsx")
FRICTION = "Nissan post-impact deceleration"
STATES = {
    "a range, a limit and a cell": (
        (
            Range(FRICTION, 0.7, 0.8),
            Limits("Restitution, tangential", {"at_most": 0.5}),
            Typed(parse_address("Inputs!D28"), -20.0),
        ),
        {"Inputs!G17": 0.7, "Inputs!H17": 0.8, "'Results wanted'!D16": 0.5, "Inputs!D28": -20.0},
    ),
    "held at a value, and the lowest tenth": (
        (Frozen(FRICTION, 0.7), Band("Chevrolet post-impact deceleration", 0, 10)),
        {"Inputs!D17": 0.7, "Inputs!P17": True, "Inputs!O11": 0.635},
    ),
    "a text": ((Typed(parse_address("Inputs!F17"), "Triangular"), Typed(parse_address("Inputs!I17"), 0.8)), None),
}


@pytest.fixture(scope="module")
def case():
    return load(CASE)


def parts_of(source):
    with zipfile.ZipFile(source) as package:
        return {name: package.read(name) for name in package.namelist()}


def contents(workbook):
    return {
        (name, *position): content
        for name, sheet in workbook.sheets.items()
        for position, content in sheet.cells.items()
    }


def test_the_copy_says_what_the_scenario_says_and_nothing_else_is_changed(case, tmp_path, subtests):
    before, old = parts_of(CASE), contents(case.workbook)
    for kind, (changes, cells) in STATES.items():
        with subtests.test(kind):
            scenario = Scenario(kind, changes)
            edited = edited_workbook(case, scenario)
            path = write_edited(edited, tmp_path / "copy.xlsx", overwrite=True)
            assert not edited.calculates
            if cells is not None:
                assert {str(cell): now for cell, (_, now) in edited.cells.items()} == cells
            copy = load(path)
            mine, theirs = (simulate(each, trials=2_000) for each in (copy, applied(case, changes)))
            assert mine.trial_index.tolist() == theirs.trial_index.tolist()
            assert all(mine.forecasts[name].tobytes() == theirs.forecasts[name].tobytes() for name in mine.forecasts)
            after = parts_of(path)
            assert list(before) == list(after)
            changed = {name for name in before if before[name] != after[name]}
            assert all(name.startswith("xl/worksheets/sheet") for name in changed)
            if cells is not None:
                assert {each.status for each in verify(copy.workbook).cells} == {Status.MATCHED}
            now = contents(copy.workbook)
            others = {key for key in old if old[key] != now.get(key)} - {tuple(cell) for cell in edited.cells}
            assert len(others) <= edited.computed
            assert all(now[key].formula == old[key].formula is not None for key in others)


def test_bytes_between_the_cells_stay(case):
    """With the elements of the changed cells taken out, the sheet is what it was."""
    cell = re.compile(rb'<c r="D28"[^>]*?(?:/>|>.*?</c>)')
    values = re.compile(rb"(?<=</f>)<v>[^<]*</v>")
    edited = edited_workbook(case, Scenario("x", (Typed(parse_address("Inputs!D28"), -20.0),)))
    after = parts_of(io.BytesIO(edited.data))
    for name, xml in parts_of(CASE).items():
        mine, theirs = (values.sub(b"", cell.sub(b"", each)) for each in (xml, after[name]))
        assert mine == theirs, name


@pytest.fixture
def small(tmp_path):
    """A book without a column Frozen, with a parameter that is a formula, a volatile formula, and a draw in a cell."""
    book = openpyxl.Workbook()
    sheet = book.active
    for row in (
        ["Name", "Value", "Low", "High"],
        ["a", 1, 0, 2],
        ["b", 1, "=B2-1", 2],
        [],
        ["Name", "Cell"],
        ["x", "=B9"],
        [],
        ["Rate", 3],
        ["Sum", '=B2*B8+B3+RiskUniform(0,1,RiskName("u"))', "=B8+NOW()", "=C9*2", "=B8*2", "=E9+1"],
    ):
        sheet.append(row)
    sheet.add_table(Table(displayName="xlmc_assumptions", ref="A1:D3"))
    sheet.add_table(Table(displayName="xlmc_forecasts", ref="A5:B6"))
    book.save(tmp_path / "small.xlsx")
    return load(tmp_path / "small.xlsx")


def rate(value):
    return Scenario("rate", (Typed(parse_address("Sheet!B8"), value),))


def test_what_cannot_be_computed_is_left_to_excel(small):
    edited = edited_workbook(small, rate(5.0))
    assert {str(cell) for cell in edited.left} == {"Sheet!B6", "Sheet!B9", "Sheet!C9", "Sheet!D9"}
    assert edited.calculates
    after = read_workbook(edited.data, "small.xlsx")
    assert after.content(parse_address("Sheet!E9")).value == 10
    assert after.content(parse_address("Sheet!F9")).value == 11  # never calculated before, and right nevertheless
    assert b'fullCalcOnLoad="1"' in after.parts["xl/workbook.xml"]
    untouched = {name: data for name, data in small.workbook.parts.items() if "worksheets/sheet" not in name}
    assert all(after.parts[name] == data for name, data in untouched.items() if name != "xl/workbook.xml")


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ((Frozen("a", 1.5),), DefinitionError, "needs a column Frozen for 'a', and the table has none"),
        ((Range("b", 0.5, 2.0),), WorkbookError, "Sheet!C3: The cell holds a formula, which would be lost"),
        ((Range("u", 0.5, None),), DefinitionError, "changes 'u', which stands in no table"),
        ((Typed(parse_address("Sheet!E9"), 1.0),), WorkbookError, "Sheet!E9: The cell holds a formula"),
        ((Range("a", 2.0, 1.0),), DefinitionError, "Low (2) is above High (1)"),
    ],
)
def test_what_cannot_be_typed_is_refused(small, changes, error, message):
    before = small.path.read_bytes()
    with pytest.raises(error) as caught:
        Model(small).save_scenario(Scenario("x", changes), small.path.with_name("copy.xlsx"))
    assert message in str(caught.value)
    assert caught.value.hint
    assert not small.path.with_name("copy.xlsx").exists()
    assert small.path.read_bytes() == before


def test_a_workbook_is_typed_into_only_on_request_and_while_nobody_else_has_it(small):
    path, edited = small.path, edited_workbook(small, rate(5.0))
    with pytest.raises(WorkbookError, match="This is the file that is read"):
        write_edited(edited, path)
    lock = path.with_name(f"~${path.name}")
    lock.touch()
    with pytest.raises(WorkbookError, match="Excel holds the workbook open"):
        write_edited(edited, path, overwrite=True)
    lock.unlink()
    before = path.read_bytes()
    path.write_bytes(before + b" ")
    with pytest.raises(WorkbookError, match="has changed since it was read"):
        write_edited(edited, path, overwrite=True)
    path.write_bytes(before)
    write_edited(edited, path, overwrite=True)
    assert load(path).workbook.content(parse_address("Sheet!B8")).value == 5
    again = edited_workbook(load(path), rate(5.0))
    assert (dict(again.cells), again.data) == ({}, path.read_bytes())


def test_a_file_that_is_there_is_not_replaced(small):
    copy = shutil.copy(small.path, small.path.with_name("copy.xlsx"))
    with pytest.raises(WorkbookError, match="exists already"):
        Model(small).save_scenario(rate(5.0), copy)
    with pytest.raises(WorkbookError, match=r"A copy of a \.xlsx workbook must end in \.xlsx"):
        Model(small).save_scenario(rate(5.0), copy.with_suffix(".xlsm"))
    assert copy.read_bytes() == small.path.read_bytes()


def test_a_scenario_asks_for_the_same_forecasts(case):
    other_name = Scenario("x", (Typed(parse_address("'Results wanted'!A6"), "Other"),))
    with pytest.raises(DefinitionError, match="In the scenario 'x': the change alters which forecasts there are"):
        model_of(case, other_name)


def test_the_run_of_a_scenario_is_not_saved_as_a_run_of_the_file(small, tmp_path):
    run = simulated(model_of(small, rate(5.0)), 200)
    with pytest.raises(SimulationError, match="No file holds the workbook of this run"):
        Simulation(run).save(tmp_path / "r.xlsx")
    with pytest.raises(SimulationError):
        Simulation(run).keep(tmp_path / "r.xlmcrun")


def test_a_correlated_assumption_is_held():
    """Its correlation, which then has no effect, is no longer read from the file."""
    model = load("examples/intersection-momentum.xlsx")
    correlation = model.definitions.correlations[0]
    edited = edited_workbook(model, Scenario("held", (Frozen(correlation.first),)))
    assert len(edited.cells) == 1
