from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import openpyxl
import pytest
from fewer_sheets import keep_few_trials

from xlmc import __version__
from xlmc.errors import XlmcError
from xlmc.excel.workbook.package import read_parts
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.writer import package_bytes

DOCS = Path(__file__).resolve().parents[2] / "docs"


@pytest.fixture(scope="module")
def written():
    """What one run wrote: name -> bytes."""
    return {}


@pytest.fixture
def results(xlmc, short_books, written, plain_book, tmp_path):
    """The results of a plain book, in the folder that commands run in."""
    if not written:
        assert xlmc("simulate", plain_book, "--seed", 5, "--save-run", "case.xlmcrun").code == 0
        written |= {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    for name, content in written.items():
        (tmp_path / name).write_bytes(content)
    return tmp_path / "case-results.xlsx"


def edit(path, sheet, address, value):
    book = openpyxl.load_workbook(path)
    book[sheet][address] = value
    book.save(path)


def change_formula(path, sheet, address, more):
    """Put something behind a formula, in its own bytes: a book of many trials takes other programs long to save."""
    part, parts = read_workbook(path).sheets[sheet].part, read_parts(path.read_bytes())
    changed = re.sub(rb'(<c r="%b"[^>]*><f>[^<]*)' % address.encode(), rb"\1%b" % more.encode(), parts[part])
    assert changed != parts[part]
    path.write_bytes(package_bytes(parts | {part: changed}))


def replays_identically(xlmc, name):
    outcome = xlmc("replay", name)
    assert outcome.code == 0
    assert outcome.err == ""
    first, second = outcome.out.splitlines()
    assert first == f"{name} records a run of case.xlsx: 2,000 trials, seed 5."
    assert second.startswith("identical: the same ")
    assert second.endswith(" accepted trials to the last bit.")


def test_a_workbook_with_all_sheets_is_identical(xlmc, plain_book, monkeypatch):
    keep_few_trials(monkeypatch)
    assert xlmc("simulate", plain_book, "--seed", 5).code == 0
    replays_identically(xlmc, "case-results.xlsx")


def test_a_saved_run_is_identical(xlmc, results):
    replays_identically(xlmc, "case.xlmcrun")


def test_a_changed_cell_is_named(xlmc, results, monkeypatch):
    monkeypatch.setattr(import_module("xlmc.cli.replay"), "_MOST", 5)
    edit(results, "Inputs", "C3", 0.5)
    outcome = xlmc("replay", results)
    assert outcome.code == 1
    lines = outcome.out.splitlines()
    assert lines[1:6] == [
        "differs.",
        "Different from the record:",
        "  cell Inputs!C3",
        "    was  0",
        "    is   0.5",
    ]
    assert any(line.startswith("  Speed: mean: recorded 1.6") for line in lines)
    assert lines[-2].startswith("  … and ")
    assert lines[-1].startswith("Not compared: the result sheets: the model is no longer")


def test_as_json(xlmc, results):
    result = json.loads(xlmc("replay", results, "--json").out)
    assert result.pop("verdict").startswith("identical: the same ")
    shown = result.pop("result_sheets")
    assert set(shown.pop("compared")) == {"Results", "Trials", "Record"}
    assert shown == {"differences": [], "missing": [], "not_compared": []}
    assert result == {
        "identical": True,
        "to_the_last_bit": True,
        "same_accepted_trials": True,
        "changes": [],
        "environment": [],
        "numbers": [],
        "checks": [],
        "made_by": __version__,
        "rules_since": [],
        "fault": None,
    }
    edit(results, "Model", "A1", "=nosuchname")
    outcome = xlmc("replay", results, "--json")
    assert outcome.code == 1
    result = json.loads(outcome.out)
    assert result["changes"] == [
        {"kind": "cell", "where": "Model!A1", "was": "=SUM(Inputs!B2:B4)", "is": "=nosuchname"}
    ]
    assert "nosuchname" in result["fault"]


def test_an_edited_record_is_found_out(xlmc, results):
    book = openpyxl.load_workbook(results)
    sheet = book["Record"]
    row = next(row for row in range(1, sheet.max_row) if sheet.cell(row, 1).value == "forecasts[0]")
    place = next(column for column in range(1, sheet.max_column) if sheet.cell(row - 2, column).value == "mean")
    sheet.cell(row, place).value = 10.5
    book.save(results)
    outcome = xlmc("replay", results)
    assert outcome.code == 1
    assert "differs, although the" in outcome.out
    assert "Speed: mean: recorded 10.5, repeated 1.6" in outcome.out
    assert "Somebody edited the numbers in the record" in outcome.out


def test_a_run_of_an_older_version_that_gives_other_numbers(xlmc, results):
    """It is told which version made it, what has changed since, and how to have that version; nobody is accused."""
    book = openpyxl.load_workbook(results)
    sheet = book["Record"]
    rows = {sheet.cell(row, 1).value: row for row in range(1, sheet.max_row + 1)}
    sheet.cell(rows["software.xlmc"], 3).value = "0.1.0"
    place = next(c for c in range(1, sheet.max_column) if sheet.cell(rows["forecasts[0]"] - 2, c).value == "mean")
    sheet.cell(rows["forecasts[0]"], place).value = 10.5
    book.save(results)
    outcome = xlmc("replay", results)
    assert outcome.code == 1
    lines = outcome.out.splitlines()
    assert lines[1].startswith("differs, although the ")
    assert lines[2] == f"xlmc 0.1.0 made this run, and this is xlmc {__version__}."
    assert any(line.startswith("  git worktree add ../xlmc-0.1.0 ") for line in lines)
    assert "Speed: mean: recorded 10.5, repeated 1.6" in outcome.out
    assert "edited" not in outcome.out


def test_a_workbook_that_an_older_version_ran_and_this_one_refuses(xlmc, results, monkeypatch):
    book = openpyxl.load_workbook(results)
    sheet = book["Record"]
    row = next(row for row in range(1, sheet.max_row) if sheet.cell(row, 1).value == "software.xlmc")
    sheet.cell(row, 3).value = "0.1.0"
    book.save(results)

    def refuse(*_):
        raise XlmcError("no")

    monkeypatch.setattr("xlmc.outputs.replay.repeat.build_model", refuse)
    outcome = xlmc("replay", results)
    assert outcome.code == 1
    assert outcome.out.splitlines()[1:3] == ["differs.", f"xlmc 0.1.0 made this run, and this is xlmc {__version__}."]
    assert "The workbook cannot be run any more: No" in outcome.out
    assert "edited" not in outcome.out
    assert json.loads(xlmc("replay", results, "--json").out)["made_by"] == "0.1.0"


def test_edited_results_are_named_and_counted(xlmc, results):
    book = openpyxl.load_workbook(results)
    value = book["Results"]["D6"].value
    book["Results"]["D6"] = 12.9
    for row in range(5, 30):
        book["Trials"][f"C{row}"] = 0
    book.save(results)
    outcome = xlmc("replay", results)
    assert outcome.code == 1
    lines = outcome.out.splitlines()
    assert lines[1].startswith("differs, although the ")
    assert lines[2] == "26 cells that do not show what the run gives:"
    assert lines[3] == f"  Results!D6 says 12.9, the run gives {value!r}"
    assert lines[4].startswith("  Trials!C5 says 0, the run gives ")
    assert lines[23:] == ["  … and 6 more"]
    result = json.loads(xlmc("replay", results, "--json").out)["result_sheets"]["differences"]
    assert len(result) == 26
    assert result[0] == {"where": "Results!D6", "says": 12.9, "gives": value}


def test_another_processor(xlmc, results, monkeypatch):
    monkeypatch.setattr("xlmc.analysis.results.record.make.processor", lambda: {"machine": "arm64", "system": "Darwin"})
    outcome = xlmc("replay", results)
    assert outcome.code == 0
    assert "identical: the same" in outcome.out
    assert "Software and processor features that are not those of the recorded run:" in outcome.out
    assert "    is   arm64" in outcome.out


@pytest.mark.parametrize("name", ["case.xlsx", "nothing.xlsx", "nothing.xlmcrun"])
def test_what_holds_no_record_is_bad_input(xlmc, results, name):
    outcome = xlmc("replay", name)
    assert outcome.code == 2
    assert outcome.err.startswith(f"xlmc: {name}: ")


def test_a_macro_workbook(xlmc, short_books, plain_book, tmp_path):
    book = plain_book.with_suffix(".xlsm")
    types = b"application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml"
    macros = b"application/vnd.ms-excel.sheet.macroEnabled.main+xml"
    parts = read_parts(plain_book.read_bytes())
    parts["[Content_Types].xml"] = parts["[Content_Types].xml"].replace(types, macros)
    book.write_bytes(package_bytes(parts))
    assert xlmc("simulate", book, "--save-run", "case.xlmcrun").code == 0
    assert xlmc("replay", "case-results.xlsm").code == 0
    assert xlmc("replay", "case.xlmcrun").code == 0
    assert xlmc("report", "case.xlmcrun", "-o", "b.xlsm").code == 0
    assert (tmp_path / "b.xlsm").read_bytes() == (tmp_path / "case-results.xlsm").read_bytes()


def test_the_documents_show_what_is_printed(xlmc, short_books, case_study, tmp_path):
    """docs/saved-runs.md shows a replay before and after a cell was changed; docs/json.md a number and a program."""
    shutil.copy(case_study, tmp_path / "intersection.xlsx")
    xlmc("simulate", "intersection.xlsx", "--json", "book.json")
    before, after = re.findall(r"```text\n\$ (.*?)```", (DOCS / "saved-runs.md").read_text(encoding="utf-8"), re.DOTALL)
    for shown in (before, after):
        if shown is after:
            change_formula(tmp_path / "intersection-results.xlsx", "Model", "D9", "*1.001")
        command, *lines = shown.splitlines()
        printed = xlmc(*command.split()[1:]).out.splitlines()
        assert [line for line in lines if line != "  …"] == printed[: len(lines) - ("  …" in lines)]
    page = (DOCS / "json.md").read_text(encoding="utf-8")
    number, program = (re.search(rf"```{kind}\n(.*?)```", page, re.DOTALL)[1] for kind in ("json", "python"))
    result = json.loads((tmp_path / "book.json").read_text(encoding="utf-8"))
    # The last digit may differ between kinds of processors: docs/runs.md.
    assert result["forecasts"][0]["statistics"]["mean"] == pytest.approx(json.loads(number), rel=1e-12)
    printed = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True).stdout
    assert printed.splitlines()[0].startswith("Chevrolet delta-V 11.25")
