from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from fewer_sheets import SHORT, keep_sheets
from simulated import simulated

from xlmc.analysis.results.record import Entry, Record, RecordTable, make_record
from xlmc.analysis.results.record.record_parts import read_record
from xlmc.api import Simulation
from xlmc.errors import WorkbookError, XlmcError
from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.writer import package_bytes
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.rare import learning, search
from xlmc.montecarlo.simulation import simulate
from xlmc.outputs.replay import Change, replay
from xlmc.outputs.replay import repeat as repeating

EXAMPLE = Path(__file__).resolve().parents[3] / "examples/intersection.xlsx"


@pytest.fixture(scope="module", autouse=True)
def _shortest_books():
    """What the sheets show is compared in `test_shown_results.py`; goals are reached in the first of short blocks."""
    with pytest.MonkeyPatch.context() as patch:
        keep_sheets(patch, *SHORT)
        patch.setattr(simulate, "BLOCK", 4_096)
        patch.setattr(search, "_SURVEY", 4_096)
        patch.setattr(learning, "_POPULATION", 512)
        patch.setattr(learning, "_FIRST", 8_192)
        patch.setattr(learning, "_FITTED", 2_048)
        patch.setattr(learning, "_TRIALS", 4_096)
        yield


@pytest.fixture(scope="session")
def model(small_book):
    return load(small_book)


def put(sheet, address, value):
    def change(book):
        book[sheet][address] = value

    return change


def test_the_case_study_is_identical_and_a_changed_cell_is_named(tmp_path):
    """The bar of this command."""
    path = tmp_path / "results.xlsx"
    Simulation(simulated(load(EXAMPLE), 20_000)).save(path)
    result = replay(path)
    assert result.identical
    assert result.to_the_last_bit
    assert (result.changes, result.environment, result.numbers) == ((), (), ())
    part, parts = read_workbook(path).sheets["Model"].part, read_parts(path.read_bytes())
    was, now = b"<f>SQRT(2*g*f_1*s_1)</f>", b"<f>SQRT(2*g*f_1*s_1)*1.001</f>"
    assert parts[part].count(was) == 1
    path.write_bytes(package_bytes(parts | {part: parts[part].replace(was, now)}))
    result = replay(path)
    assert not result.identical
    assert result.changes == (Change("cell", "Model!D9", "=SQRT(2*g*f_1*s_1)", "=SQRT(2*g*f_1*s_1)*1.001"),)
    assert {number.name for number in result.numbers} > {"Chevrolet delta-V: mean", "Nissan delta-V: low"}


def test_a_result_that_is_shown_with_other_decimals_is_named(results, tmp_path):
    """As where another program's styles shift those of the result sheets: 2.975 is shown as 3."""
    parts = read_parts(results.read_bytes())
    styles = parts["xl/styles.xml"].decode()
    code = re.search(r'formatCode="([^"]*0\.00)"', styles)[1]
    shown = tmp_path / "shown.xlsx"
    shown.write_bytes(package_bytes(parts | {"xl/styles.xml": styles.replace(f'"{code}"', '"0"').encode()}))
    result = replay(shown)
    assert not result.identical
    assert result.shown.differences
    assert {each.says for each in result.shown.differences} == {"shown with 0 decimals"}
    assert {each.gives for each in result.shown.differences} == {"shown with 2 decimals"}


RUNS = {
    "by default": {},
    "other settings than the book's": {"trials": 777, "seed": 10**20},
    "Latin hypercube": {"sampling": "lhs", "trials": 1000},
    "Latin hypercube in blocks": {"sampling": "lhs500", "trials": 9_000},
    "Sobol": {"sampling": "sobol", "trials": 1000},
    "until accepted": {"until_accepted": 100},
    "until accepted, and not reached": {"until_accepted": 10_000, "trials": 1000},
    "precision": {"precision": "20%", "precision_of": "p50", "forecasts": "area"},
    "time": {"precision": 1e-9, "time_limit": 0.001},
    "jit": {"engine": "jit", "trials": 35_000},
    "slow reference": {"engine": "formulas", "trials": 40},
    "some draws kept": {"keep_inputs": 5},
    "Nothing accepted": {"trials": 1, "seed": 7},
    "rare": {"until_accepted": 100, "rare": "always"},
}


OF_ALL = {"precision of all": {"precision": "20%", "precision_of": "p50"}}
"""Likewise, of which only the goal is looked at."""

AS_IN_THE_WORKBOOK = {
    "other settings than the book's",
    "Latin hypercube",
    "Sobol",
    "until accepted",
    "precision",
    "slow reference",
    "rare",
}
"""Runs that their records alone tell from others, and a saved run has the same record.

`tests/analysis/results/saved` shows that all else comes back from one.
"""


@pytest.fixture(scope="module")
def run_of(model):
    """Name among `RUNS` -> the run, which is made once."""
    return cache(lambda kind: simulated(model, **(RUNS | OF_ALL)[kind]))


@pytest.mark.parametrize("kind", RUNS)
def test_every_kind_of_run_is_repeated_to_the_last_bit(run_of, tmp_path, kind):
    run = run_of(kind)
    paths = [Simulation(run).save(tmp_path / "r.xlsx")]
    if kind not in AS_IN_THE_WORKBOOK:
        paths.append(Simulation(run).keep(tmp_path / "r.xlmcrun"))
    for path in paths:
        result = replay(path)
        assert result.to_the_last_bit, (path, result.changes, result.numbers)
        assert result.record["counts.trials"] == run.trials


def refused_without(run, key, message):
    """The repeat of the run refuses its record without an entry."""
    record = make_record(run)
    sections = [
        replace(section, entries=tuple(each for each in section.entries if f"{section.key}.{each.key}" != key))
        for section in record.sections
    ]
    assert sections != [*record.sections]
    with pytest.raises(WorkbookError, match=message):
        repeating._replay(run.model.workbook, Record(tuple(sections)), run.model, 1, None)


@pytest.mark.parametrize(
    ("kind", "key"),
    [("until accepted", "until_accepted"), ("precision of all", "precision"), ("rare", "until_accepted")],
)
def test_a_record_without_the_goal_that_was_reached_is_refused(run_of, kind, key):
    assert run_of(kind).stopped.reached
    refused_without(run_of(kind), f"settings.{key}", rf"The record lacks 'settings\.{key}'")


@pytest.mark.parametrize("asked", [{"until_accepted": 10_000}, {"precision": 1e-6}, {"adaptive": 6}])
def test_a_record_without_the_goal_that_was_not_reached_is_refused(model, asked):
    run = simulated(model, trials=200, **asked)
    assert not run.stopped.reached
    refused_without(run, f"settings.{next(iter(asked))}", "The record lacks the setting that asked for its goal, ")


def test_nothing_was_accepted_in_the_run_that_should_have_accepted_nothing(run_of):
    assert run_of("Nothing accepted").accepted == 0


def test_an_interrupted_run_is_repeated(model, tmp_path):
    from xlmc.montecarlo.loop.stopping import Stopped

    run = replace(simulated(model, 500), stopped=Stopped("interruption", "it was interrupted"))
    Simulation(run).save(tmp_path / "r.xlsx")
    assert replay(tmp_path / "r.xlsx").to_the_last_bit


def test_threads_change_nothing(results):
    assert replay(results, jobs=2).to_the_last_bit


def test_another_program_may_save_and_what_the_run_did_not_need_may_change(edited):
    def change(book):
        for name in ("Record", "Results", "Trials"):
            book[name].title = f"Old {name}"
        book.move_sheet("Old Record", -5)
        book["Inputs"]["H9"] = "=1+1"
        book.create_sheet("Notes")["A1"] = "Rate"

    assert replay(edited(change)).to_the_last_bit


CHANGES = {
    "a parameter": (
        put("Inputs", "C2", 1.25),
        [
            Change("cell", "Inputs!C2", "1", "1.25"),
            Change("assumption", "width, parameters", "Low 1, High 3", "Low 1.25, High 3"),
        ],
    ),
    "a constant": (put("Inputs", "B5", 2.75), [Change("cell", "Inputs!B5", "2.5", "2.75")]),
    "a blank of a range": (put("Inputs", "C6", 7), [Change("cell", "Inputs!C6", None, "7")]),
    "a value that was deleted": (put("Inputs", "D6", None), [Change("cell", "Inputs!D6", "2", None)]),
    "a formula": (put("Model", "A2", "=A1-B1"), [Change("cell", "Model!A2", "=A1+B1", "=A1-B1")]),
    "the limit of a filter": (
        put("Wanted", "C6", 1.1),
        [
            Change("cell", "Wanted!C6", "1.2", "1.1"),
            Change("filter", "root, limits", "at most 1.2", "at most 1.1"),
        ],
    ),
    "a threshold": (
        put("Wanted", "D2", 21),
        [Change("cell", "Wanted!D2", "20", "21"), Change("forecast", "area, threshold", "20", "21")],
    ),
}
NEEDLESS = {
    "a formula that became a value": (put("Model", "B1", 3), [Change("cell", "Model!B1", "=SUM(Inputs!B6:D6)", "3")]),
}
"""With it, cells that changed are no longer needed."""
UNTOUCHED = {
    "a note": (put("Inputs", "F2", "laser"), [Change("cell", "Inputs!F2", '"tape"', '"laser"')]),
    "a setting that the repeat does not take": (put("Wanted", "B10", 8), [Change("cell", "Wanted!B10", "7", "8")]),
}
"""What does not touch the trials."""


def changed(edited, changes):
    """The repeat of a workbook after all these changes, of which each is named and nothing else is."""

    def change(book):
        for each, _ in changes.values():
            each(book)

    result = replay(edited(change))
    expected = [named for _, names in changes.values() for named in names]
    assert not result.identical
    assert len(result.changes) == len(expected)
    assert set(result.changes) == set(expected)
    return result


def test_changed_cells_are_named_with_old_and_new_content(edited):
    assert not changed(edited, CHANGES).same_bits
    assert changed(edited, NEEDLESS).same_bits  # it was 3 in every trial


def test_what_does_not_touch_the_trials_is_named_too(edited):
    assert changed(edited, UNTOUCHED).same_bits


def test_a_name_that_means_another_cell_and_a_table_that_lost_its_last_row(edited):
    def change(book):
        book.defined_names["Rate"].attr_text = "Inputs!$B$6"
        book["Inputs"].tables["xlmc_assumptions"].ref = "A1:F2"

    result = replay(edited(change))
    assert Change("defined name", "Rate", "Inputs!$B$5", "Inputs!$B$6") in result.changes
    [table] = [each for each in result.changes if each.kind == "table"]
    assert (table.where, table.old.split(":")[:2], table.new.split(":")[:2]) == (
        "xlmc_assumptions",
        ["Inputs!A1", "F3"],
        ["Inputs!A1", "F2"],
    )


def test_an_assumption_that_was_taken_out(edited):
    def change(book):
        for column in "ABCDEF":
            book["Inputs"][f"{column}3"] = None
        book["Model"]["A3"] = 1

    result = replay(edited(change))
    assert Change("assumption", "=length", "defined", None) in result.changes


def test_a_workbook_that_cannot_be_run_any_more_still_names_the_cell(edited):
    result = replay(edited(put("Model", "A1", "=NOSUCH(1)")))
    assert result.changes == (Change("cell", "Model!A1", "=Inputs!B2*Inputs!B3*Rate", "=NOSUCH(1)"),)
    assert "NOSUCH" in str(result.fault)
    assert result.repeated is None
    assert not result.identical


def test_a_formula_that_was_filled_down_reads_as_it_does_in_its_cell(tmp_path, small_book):
    """Excel moves the text of a shared formula to another cell when it saves."""
    path = tmp_path / "r.xlsx"
    Simulation(simulated(load(small_book), 100)).save(path)
    old = read_record(read_workbook(path))
    workbook = read_workbook(path)
    cells = dict(workbook.sheets["Model"].cells)
    cells[2, 1] = replace(cells[2, 1], formula=replace(cells[2, 1].formula, text="B4+C4", row=5, column=2))
    sheets = {name: workbook.sheets[name] for name in workbook.sheets}
    sheets["Model"] = replace(sheets["Model"], cells=cells)
    result = repeating._replay(replace(workbook, sheets=sheets), old, None, 1, None, path)
    assert result.to_the_last_bit


# A record that says something else than the run.


def altered(record, changes):
    """A record with other values: `section.entry`, or `section/name/column`."""
    sections = {section.key: section for section in record.sections}
    for key, value in changes.items():
        if "/" in key:
            section, name, column = key.split("/")
            table = sections[section].table
            place = [key for key, _ in table.columns].index(column)
            rows = tuple((*r[:place], value, *r[place + 1 :]) if r[0] == name else r for r in table.rows)
            sections[section] = replace(sections[section], table=RecordTable(table.columns, rows))
        else:
            section, _, entry = key.partition(".")
            entries = (replace(e, value=value) if e.key == entry else e for e in sections[section].entries)
            sections[section] = replace(sections[section], entries=tuple(entries))
    return Record(tuple(sections.values()))


@pytest.fixture
def against(run):
    """`against(changes)`: a repeat compared with a record in which some values are others."""

    def compare(changes):
        return repeating._replay(run.model.workbook, altered(make_record(run), changes), run.model, 1, None)

    return compare


def nearly(value):
    return value * (1 + 1e-14)


def test_another_processor_may_round_otherwise(run, against):
    mean = run["area"].mean.value
    changes = {
        "run.fingerprint": "0" * 64,
        "forecasts/area/mean": nearly(mean),
        "processor.vector_instructions": "NEON",
    }
    result = against(changes)
    assert result.identical
    assert not result.to_the_last_bit
    [number] = result.numbers
    assert (number.name, number.close) == ("area: mean", True)
    assert [change.where for change in result.environment] == ["vector_instructions"]


def test_another_version_is_told_and_does_not_matter_where_the_numbers_are_the_same(against):
    result = against({"software.numpy": "1.0"})
    assert result.to_the_last_bit
    assert [(each.kind, each.where, each.old) for each in result.environment] == [("software", "numpy", "1.0")]


DIFFERENT = {
    "other bits on the same machine": {"run.fingerprint": "0" * 64},
    "a mean further off than rounding": {
        "run.fingerprint": "0" * 64,
        "forecasts/area/mean": 17.0,
        "processor.machine": "other",
    },
    "a count off by one, whatever the processor": {
        "run.fingerprint": "0" * 64,
        "filters/root/rejected": 115,
        "processor.machine": "other",
    },
    "a number that was edited in the record": {"forecasts/area/mean": 17.0, "processor.machine": "other"},
    "a definition that is understood otherwise": {"assumptions/width/distribution": "Normal"},
}


@pytest.mark.parametrize("changes", DIFFERENT.values(), ids=[*DIFFERENT])
def test_what_is_not_the_same_run(against, changes):
    assert not against(changes).identical


# What cannot be replayed.


UNREADABLE = {
    "an edited cell": ("cells[0]", '"Nome"', "are not those that were written"),
    "an edited number of cells": ("cells.count", 3, "are not those that were written"),
    "a seed that is none": ("settings.seed", "x", "The settings in the record cannot be read"),
    "a number of trials that is none": ("settings.trials", 2.5, "2.5 is not a whole number"),
    "a count that is none": ("counts.trials", "many", "The record counts 'many' trials"),
}


def refused(book, message):
    with pytest.raises(WorkbookError, match=message) as reported:
        replay(book)
    assert str(reported.value).startswith((f"{book}: ", f"{book.name}: ", "Record!"))


@pytest.mark.parametrize(("key", "value", "message"), UNREADABLE.values(), ids=[*UNREADABLE])
def test_a_record_that_cannot_be_used(typed, in_record, key, value, message):
    refused(typed({("Record", in_record(key), 3): value}), message)


def test_a_record_of_an_older_xlmc(typed, results):
    cells = read_workbook(results).sheets["Record"].cells
    gone = [
        row for (row, column), cell in cells.items() if column == 1 and str(cell.value).startswith(("cells", "sett"))
    ]
    refused(typed({("Record", row, 1): None for row in gone}), "an older xlmc wrote it.*xlmc simulate")


def test_no_record_and_two(edited):
    refused(edited(lambda book: book.remove(book["Record"])), "The workbook holds no record of a run")
    refused(edited(lambda book: book.copy_worksheet(book["Record"])), "each hold a record")


def test_a_workbook_that_could_never_be_run_is_refused(results, monkeypatch):
    def refuse(*_):
        raise XlmcError("No")

    monkeypatch.setattr(repeating, "build_model", refuse)
    with pytest.raises(XlmcError, match="No"):
        replay(results)


def test_entries_are_read_back_as_they_were(results, run):
    written, read = make_record(run), read_record(read_workbook(results))
    for section in written.sections:
        for entry in section.entries:
            expected = None if entry.value == "" else entry.value
            assert read[f"{section.key}.{entry.key}"] == expected
    assert isinstance(read.section("run").entries[0], Entry)


def test_a_record_without_one_of_its_sections_is_refused_by_name(typed, results):
    keys = {
        (name, *at): None
        for name, sheet in read_workbook(results).sheets.items()
        for at, cell in sheet.cells.items()
        if isinstance(cell.value, str) and re.match(r"forecasts(\W|$)", cell.value)
    }
    assert keys
    book = typed(keys)
    with pytest.raises(WorkbookError, match="The record lacks 'forecasts'"):
        replay(book)
