from __future__ import annotations

import json
import shutil

import openpyxl
import pandas
import pytest
from fewer_sheets import keep_few_trials
from openpyxl.worksheet.table import Table

import xlmc as package
from xlmc.errors import WorkbookError
from xlmc.excel.workbook.package import read_parts
from xlmc.montecarlo.simulation import simulate
from xlmc.montecarlo.simulation.simulation import KEPT_INPUTS

pytestmark = pytest.mark.usefixtures("short_books")


@pytest.fixture
def book(small_book, tmp_path):
    return shutil.copy(small_book, tmp_path / "book.xlsx")


@pytest.fixture
def case_book(plain_book):
    return plain_book


def test_what_is_reported_is_what_simulate_wrote(xlmc, whole_book, case_book, tmp_path, monkeypatch):
    keep_few_trials(monkeypatch)
    options = ("--save-run", "case.xlmcrun", "--json", "a.json", "--extract", "a.csv", "--extract", "a.parquet")
    run = xlmc("simulate", case_book, *options)
    assert run.code == 0
    for words in (
        "The run is saved in case.xlmcrun",
        "as JSON are in a.json",
        "trials are in a.csv",
        "are in a.parquet",
    ):
        assert words in run.out
    again = ("-o", "b.xlsx", "--json", "b.json", "--extract", "b.csv", "--extract", "b.parquet")
    report = xlmc("report", "case.xlmcrun", *again)
    assert report.code == 0
    assert summary(report.out) == summary(run.out)
    for first, second in (("case-results.xlsx", "b.xlsx"), *((f"a.{e}", f"b.{e}") for e in ("json", "csv", "parquet"))):
        assert (tmp_path / first).read_bytes() == (tmp_path / second).read_bytes(), second


def summary(printed):
    return printed.partition("\nResults are in")[0]


def test_a_saved_run_that_was_changed_is_told(xlmc, simulated, book, tmp_path):
    """Its zip is whole, and the seal at its end is not that of its bytes."""
    simulated(book, "--save-run", "run.xlmcrun")
    whole, changed = tmp_path / "run.xlmcrun", tmp_path / "changed.xlmcrun"
    data = bytearray(whole.read_bytes())
    at = data.index(b"sha256=") + 7
    data[at : at + 4] = b"0000" if data[at : at + 4] != b"0000" else b"1111"
    changed.write_bytes(data)
    text = "was changed since xlmc wrote it (its seal is broken)"
    assert text in xlmc("report", changed, "--json", "changed.json").err
    assert text not in xlmc("report", whole, "--json", "whole.json").err


def test_nothing_is_simulated(xlmc, simulated, book, monkeypatch):
    simulated(book, "--save-run", "first.xlmcrun")

    def refuse(*_, **__):
        raise AssertionError("a run was simulated")

    monkeypatch.setattr("xlmc.montecarlo.simulation.simulate.run_model", refuse)
    assert xlmc("report", "first.xlmcrun", "-o", "b.xlsx").code == 1  # errors in cells


def test_a_second_run_stands_beside_the_first_on_the_page(xlmc, case_book, tmp_path):
    for seed in (1, 2):
        xlmc("simulate", case_book, "--seed", seed, "--save-run", f"{seed}.xlmcrun")
    assert xlmc("report", "1.xlmcrun", "2.xlmcrun", "--html", "both.html").code == 0
    assert "Beside a second run" in (tmp_path / "both.html").read_text("utf-8")
    assert not (tmp_path / "1-results.xlsx").exists()
    for options in ((), ("--json", "a.json"), ("--html", "a.html", "--pdf", "a.pdf")):
        refused = xlmc("report", "1.xlmcrun", "2.xlmcrun", *options)
        assert refused.code == 2
        assert "give -o PAGE.html, and no other file" in refused.err
    missing = xlmc("report", "1.xlmcrun", "3.xlmcrun", "--html", "more.html")
    assert (missing.code, (tmp_path / "more.html").exists()) == (2, False)
    shutil.copy(tmp_path / "2.xlmcrun", tmp_path / "two.html")
    taken = xlmc("report", "1.xlmcrun", "two.html", "--html", "two.html", "--overwrite")
    assert taken.code == 2
    assert (tmp_path / "two.html").read_bytes() == (tmp_path / "2.xlmcrun").read_bytes()


def test_by_default_it_writes_the_result_workbook(xlmc, simulated, book, tmp_path):
    simulated(book, "--save-run", "first.xlmcrun")
    outcome = xlmc("report", "first.xlmcrun")
    assert outcome.code == 1  # errors in cells
    assert (tmp_path / "first-results.xlsx").read_bytes() == (tmp_path / "book-results.xlsx").read_bytes()
    assert "were lost to errors in cells" in outcome.err


def test_it_writes_no_workbook_where_something_else_is_asked_for(xlmc, simulated, book, tmp_path):
    simulated(book, "--save-run", "first.xlmcrun")
    xlmc("report", "first.xlmcrun", "--json", "first.json")
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "book-results.xlsx",
        "book.xlsx",
        "first.json",
        "first.xlmcrun",
    ]
    assert json.loads((tmp_path / "first.json").read_text(encoding="utf-8"))["trials"]["run"] == 400


def test_a_run_with_an_extract_keeps_every_draw(xlmc, book, monkeypatch):
    asked = []
    run_model = simulate.run_model

    def noting(model, options, **named):
        asked.append(options.keep_inputs)
        return run_model(model, options, **named)

    monkeypatch.setattr(simulate, "run_model", noting)
    xlmc("simulate", book)
    xlmc("simulate", book, "--extract", "t.csv")
    assert asked == [KEPT_INPUTS, None]


def test_draws_that_were_not_saved_are_blank_and_said_to_be(xlmc, small_book, tmp_path):
    package.load(small_book).simulate(keep_inputs=10).keep(tmp_path / "run.xlmcrun")
    outcome = xlmc("report", "run.xlmcrun", "--extract", "t.csv")
    assert "draws of 10 of 284 accepted trials were kept; the others are blank" in outcome.err
    assert pandas.read_csv(tmp_path / "t.csv")["width"].notna().sum() == 10


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--json", "a.xlsx"), "JSON must end in .json. Name it 'a.json'"),
        (("--json", "no/a.json"), "There is no folder"),
        (("--extract", "a.xlsx"), "A table of trials must end in .csv or .parquet"),
        (("--extract", "no/a.csv"), "There is no folder"),
        (("--save-run", "book.xlsx"), "A saved run must end in .xlmcrun"),
        (("-o", "a.xlsm"), "must end in .xlsx. Name it 'a.xlsx'"),
        (("-o", "no/a.xlsx"), "There is no folder"),
        (("-o", "a.txt"), "a.txt: This command writes no file that ends in .txt"),
        (("-o", "a"), "a: The name of the file has no ending. The ending says what is written: .xlsx"),
        (("-o", "a.pdf", "-o", "no/a.html"), "There is no folder"),
        (("-o", "a.json", "--json", "a.json"), "Two outputs would be written to this file"),
        (("--in-place", "-o", "a.xlsx"), "--in-place and -o with a workbook cannot both be given"),
        (("--pdf", "a.docx"), "The report must end in .pdf. Name it 'a.pdf'"),
        (("--docx", "a.pdf"), "The report must end in .docx. Name it 'a.docx'"),
        (("--pdf", "no/a.pdf"), "There is no folder"),
        (("--pdf", "a.pdf", "--sections", "answer,nothing"), "A report has no section 'nothing'"),
        (("--pdf", "a.pdf", "--case", "nothing"), "A field of the case is not 'nothing'"),
        (("--pdf", "a.pdf", "--paper", "a5"), "'a5' is not one of letter, a4"),
        (("--sections", "answer"), "give -o REPORT.pdf or -o REPORT.docx"),
    ],
)
def test_names_are_refused_before_the_run(xlmc, book, tmp_path, monkeypatch, options, message):
    monkeypatch.setattr("xlmc.montecarlo.model.loading.load", lambda path: 1 / 0)
    before = book.read_bytes()
    outcome = xlmc("simulate", book, *options)
    assert outcome.code == 2
    assert message in outcome.err
    assert book.read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["book.xlsx"]


def refuse(*_, **__):
    raise WorkbookError("The disk is full", where="book-results.xlsx")


@pytest.mark.parametrize("command", ["simulate", "report"])
def test_a_file_that_cannot_be_written_takes_no_other_with_it(xlmc, simulated, book, tmp_path, monkeypatch, command):
    simulated(book, "--save-run", "first.xlmcrun")
    source = book if command == "simulate" else "first.xlmcrun"
    monkeypatch.setattr("xlmc.api.Simulation.save", refuse)
    monkeypatch.setattr("xlmc.api.Simulation.save_page", refuse)
    outcome = xlmc(command, source, "-o", "b.xlsx", "--html", "b.html", "--json", "b.json", "--extract", "b.csv")
    assert outcome.code == 2
    assert outcome.err.count("xlmc: book-results.xlsx: The disk is full") == 2
    assert "Results are in" not in outcome.out
    assert "area" in outcome.out  # the numbers are there
    assert "warning: " in outcome.err
    assert (tmp_path / "b.json").exists()
    assert (tmp_path / "b.csv").exists()


def test_what_is_no_saved_run(xlmc, book):
    other = shutil.copy(book, book.with_suffix(".xlmcrun"))
    outcome = xlmc("report", other)
    assert outcome.code == 2
    assert outcome.err.startswith(
        f"xlmc: {other}: The file is not a saved run. Save one with xlmc simulate BOOK -o RUN.xlmcrun"
    )


def test_results_of_another_kind_of_workbook_are_refused(xlmc, simulated, book):
    simulated(book, "--save-run", "first.xlmcrun")
    outcome = xlmc("report", "first.xlmcrun", "-o", "b.xlsm")
    assert outcome.code == 2
    assert "must end in .xlsx" in outcome.err


def test_reports_are_written_of_a_run_and_of_a_saved_run_alike(xlmc, case_book, tmp_path):
    asked = ("--sections", "answer, repeat", "--forecasts", "double", "--case", "Case number=17")
    run = xlmc("simulate", case_book, "--save-run", "case.xlmcrun", "--pdf", "a.pdf", *asked)
    assert run.code == 0, run.err
    assert "The report is a.pdf" in run.out
    report = xlmc("report", "case.xlmcrun", "--pdf", "b.pdf", "--docx", "b.docx", *asked)
    assert report.code == 0, report.err
    assert "The report is b.docx" in report.out
    assert not (tmp_path / "case-results-2.xlsx").exists()
    assert (tmp_path / "a.pdf").read_bytes() == (tmp_path / "b.pdf").read_bytes()
    again = xlmc("report", "case.xlmcrun", "--pdf", "b.pdf")
    assert again.code == 2
    assert "replace it with --overwrite" in again.err
    assert (tmp_path / "a.pdf").read_bytes() == (tmp_path / "b.pdf").read_bytes()


def test_a_forecast_that_is_not_there_is_refused_before_the_run(xlmc, book, tmp_path, monkeypatch):
    monkeypatch.setattr("xlmc.montecarlo.simulation.simulate.run_model", lambda *_, **__: 1 / 0)
    outcome = xlmc("simulate", book, "--pdf", "a.pdf", "--forecasts", "nothing")
    assert outcome.code == 2
    assert "There is no forecast 'nothing'" in outcome.err
    assert [path.name for path in tmp_path.iterdir()] == ["book.xlsx"]


def test_the_report_of_a_result_workbook_is_that_of_its_run(xlmc, case_book, tmp_path):
    asked = ("--sections", "answer,filters,repeat")
    assert xlmc("simulate", case_book, "--pdf", "a.pdf", *asked).code == 0
    report = xlmc("report", "case-results.xlsx", "--pdf", "b.pdf", *asked)
    assert report.code == 0, report.err
    assert (tmp_path / "a.pdf").read_bytes() == (tmp_path / "b.pdf").read_bytes()
    results = openpyxl.load_workbook(tmp_path / "case-results.xlsx")
    results["Inputs"]["C2"] = 0.25
    results.save(tmp_path / "edited.xlsx")
    refused = xlmc("report", "edited.xlsx", "--pdf", "c.pdf")
    assert refused.code == 2
    assert "cannot be repeated as it was. xlmc replay edited.xlsx says what differs" in refused.err
    assert not (tmp_path / "c.pdf").exists()


def test_every_kind_is_written_by_its_ending_and_nothing_else(xlmc, case_book, tmp_path):
    """Of the workbook, of the saved run and of the result workbook: the same bytes."""
    endings = ("xlsx", "pdf", "docx", "html", "json", "csv", "parquet", "xlmcrun")
    run = xlmc("simulate", case_book, *(part for ending in endings for part in ("-o", f"a.{ending}")))
    assert run.code == 0, run.err
    assert {path.name for path in tmp_path.iterdir()} == {case_book.name, *(f"a.{ending}" for ending in endings)}
    for source, stem in (("a.xlmcrun", "b"), ("a.xlsx", "c")):
        report = xlmc("report", source, *(part for ending in endings[:-1] for part in ("-o", f"{stem}.{ending}")))
        assert report.code == 0, report.err
        for ending in endings[1:-1]:
            assert (tmp_path / f"{stem}.{ending}").read_bytes() == (tmp_path / f"a.{ending}").read_bytes(), ending
        sheets, again = (read_parts((tmp_path / f"{each}.xlsx").read_bytes()) for each in ("a", stem))
        del sheets["xl/xlmc/seal1.json"], again["xl/xlmc/seal1.json"]  # lists the parts in the order of the file
        assert sheets == again


def test_an_option_of_one_kind_adds_a_file_to_the_result_workbook_and_o_replaces_it(xlmc, case_book, tmp_path):
    assert xlmc("simulate", case_book, "--json", "a.json").code == 0
    assert {path.name for path in tmp_path.iterdir()} == {case_book.name, "a.json", "case-results.xlsx"}
    assert xlmc("simulate", case_book, "-o", "b.json", "-o", "c.json", "--html", "c.html").code == 0
    assert (tmp_path / "c.json").read_bytes() == (tmp_path / "b.json").read_bytes()
    assert {path.suffix for path in tmp_path.iterdir() if path.stem in ("b", "c")} == {".json", ".html"}


@pytest.mark.parametrize(
    ("options", "message"), [((), "name a file, as -o REPORT.pdf"), (("-o", "b.xlmcrun"), "has not kept")]
)
def test_what_a_result_workbook_cannot_give(xlmc, book, tmp_path, options, message):
    outcome = xlmc("report", book, *options)
    assert outcome.code == 2
    assert message in outcome.err
    assert [path.name for path in tmp_path.iterdir()] == ["book.xlsx"]


def test_a_workbook_without_results_has_no_report(xlmc, book):
    outcome = xlmc("report", book, "--pdf", "a.pdf")
    assert outcome.code == 2
    assert "The workbook holds no record of a run" in outcome.err


@pytest.mark.parametrize("options", [(), ("--pdf", "report.pdf")])
def test_a_table_of_the_case_that_is_not_one_is_refused_before_the_run(xlmc, book, tmp_path, monkeypatch, options):
    opened = openpyxl.load_workbook(book)
    opened.create_sheet("Case").append(["Field", "Text", "More"])
    opened["Case"].append(["Title", "Main St", "?"])
    opened["Case"].add_table(Table(displayName="xlmc_case", ref="A1:C2"))
    opened.save(book)
    monkeypatch.setattr(simulate, "run_model", None)
    run = xlmc("simulate", book, *options)
    assert run.code == 2
    assert "Case!A2: The table xlmc_case must have two columns" in run.err
    assert list(tmp_path.iterdir()) == [book]
