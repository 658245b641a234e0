"""What studies find, as a sheet and as a page."""

from __future__ import annotations

import json

import openpyxl
import pytest
from openpyxl.worksheet.table import Table

from xlmc.errors import WorkbookError
from xlmc.outputs import study_report


@pytest.fixture
def book(tmp_path):
    """`a` and `<b>`, uniform on (0, 1); the forecast is their sum, and its threshold 1.5."""
    made = openpyxl.Workbook()
    sheet = made.active
    sheet.title = "Inputs"
    for row in (["Name", "Value", "Low", "High"], ["a", 0.5, 0, 1], ["<b>", 0.5, 0, 1]):
        sheet.append(row)
    sheet["F1"] = "=B2+B3"
    sheet.add_table(Table(displayName="xlmc_assumptions", ref="A1:D3"))
    answers = made.create_sheet("Answers")
    answers.append(["Name", "Cell", "Units", "Threshold"])
    answers.append(["Speed", "=Inputs!F1", "mph", 1.5])
    answers.add_table(Table(displayName="xlmc_forecasts", ref="A1:D2"))
    path = tmp_path / "book.xlsx"
    made.save(path)
    return path


TRIALS = ("-n", "2000")
OPTIONS = {
    "screen": TRIALS,
    "compare": TRIALS,
    "stability": TRIALS,
    "stress": TRIALS,
    "uncertainty": ("--uncertain", "a", "--outer", "40", "--inner", "50"),
}


@pytest.fixture(params=OPTIONS)
def command(request, book):
    books = [book] * (2 if request.param == "compare" else 1)
    return [request.param, *books, *OPTIONS[request.param], "--quiet"]


SAYS = {
    "screen": "P(> 1.5)",
    "compare": "P(> 1.5), %",
    "stability": "What cells amplify and lose",
    "stress": "Inputs where Speed is above P90",
    "uncertainty": "The 95th percentile of Speed is between",
}
NOT_WRITTEN = {
    "compare": [("found.csv", "This command writes no file that ends in .csv")],
    "uncertainty": [("found.xlmcrun", "This run cannot be kept. The command gives the same trials again")],
}


def test_sheet_and_page_say_what_the_terminal_says(xlmc, command, tmp_path):
    sheet, page = tmp_path / "found.xlsx", tmp_path / "found.html"
    outcome = xlmc(*command, "-o", sheet, "--html", page)
    assert outcome.code == 0, outcome.err
    assert outcome.out.count("Written: ") == 2
    texts = [str(cell) for row in openpyxl.load_workbook(sheet).active.iter_rows(values_only=True) for cell in row]
    text = page.read_text(encoding="utf-8")
    assert SAYS[command[0]] in " ".join(texts)
    assert SAYS[command[0]].replace(">", "&gt;") in text
    assert "<b>" not in text
    again = xlmc(*command, "-o", sheet, "--html", page)  # untouched files of ours are replaced
    assert again.code == 0, again.err


def test_documents_say_what_the_terminal_says(xlmc, command, tmp_path):
    pypdf, docx = pytest.importorskip("pypdf"), pytest.importorskip("docx")
    pytest.importorskip("typst")
    outcome = xlmc(*command, "--pdf", tmp_path / "found.pdf", "--docx", tmp_path / "found.docx")
    assert outcome.code == 0, outcome.err
    assert outcome.out.count("Written: ") == 2
    message = "".join(SAYS[command[0]].split())
    pdf = "".join(page.extract_text() for page in pypdf.PdfReader(tmp_path / "found.pdf").pages)
    assert message in "".join(pdf.split())
    written = docx.Document(str(tmp_path / "found.docx"))
    cells = [cell.text for table in written.tables for row in table.rows for cell in row.cells]
    assert message in "".join("".join([*cells, *(each.text for each in written.paragraphs)]).split())
    again = xlmc(*command, "--pdf", tmp_path / "found.pdf")  # a document bears no mark of who wrote it
    assert again.code == 2
    assert "The file exists already" in again.err


def test_every_kind_is_written_by_its_ending(xlmc, command, book, tmp_path):
    for library in ("typst", "docx", "pyarrow"):
        pytest.importorskip(library)
    of_the_run = {"compare": [], "uncertainty": ["csv", "parquet"]}.get(command[0], ["csv", "parquet", "xlmcrun"])
    names = [f"found.{ending}" for ending in ("xlsx", "pdf", "docx", "html", "json", *of_the_run)]
    outcome = xlmc(*command, *(part for name in names for part in ("-o", tmp_path / name)))
    assert outcome.code == 0, outcome.err
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(["book.xlsx", *names])
    written = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"))
    assert written.pop("seal")
    assert written == json.loads(xlmc(*command, "--json").out)
    if "csv" in of_the_run:
        assert len((tmp_path / "found.csv").read_text(encoding="utf-8").splitlines()) == 2_001
    if "xlmcrun" in of_the_run:
        assert xlmc("report", tmp_path / "found.xlmcrun", "-o", tmp_path / "again.csv").code == 0
        assert (tmp_path / "again.csv").read_bytes() == (tmp_path / "found.csv").read_bytes()
    again = xlmc(*command, "-o", tmp_path / "found.json")  # an untouched file of ours is replaced
    assert again.code == 0, again.err


def test_what_cannot_be_written_is_refused_before_anything_is_run(xlmc, command, book, tmp_path):
    before = book.read_bytes()
    for given, message in (
        (["-o", book], "This is the file that is read"),
        (["-o", tmp_path / "found.txt"], "This command writes no file that ends in .txt"),
        (["-o", tmp_path / "found.xlsm"], "This command writes no file that ends in .xlsm"),
        *((["-o", tmp_path / name], message) for name, message in NOT_WRITTEN.get(command[0], [])),
        (["--html", tmp_path / "found.xlsx"], "must end in .html"),
        (["--html", tmp_path / "nowhere" / "found.html"], "nowhere"),
        (["--pdf", tmp_path / "found.docx"], "must end in .pdf"),
        (["--docx", tmp_path / "found.doc"], "must end in .docx"),
        (["-o", tmp_path / "both.html", "--html", tmp_path / "both.html"], "Two outputs would be written to this file"),
    ):
        outcome = xlmc(*command, *given)
        assert outcome.code == 2
        assert message in outcome.err
    theirs = tmp_path / "theirs.html"
    theirs.write_text("mine", encoding="utf-8")
    assert xlmc(*command, "--html", theirs).code == 2
    assert theirs.read_text(encoding="utf-8") == "mine"
    assert xlmc(*command, "--html", theirs, "--overwrite").code == 0
    assert book.read_bytes() == before


def test_a_full_disk_costs_neither_the_answer_nor_the_other_files(xlmc, book, tmp_path, monkeypatch):
    write = study_report.write_workbook

    def fill(path, *arguments):
        if path.suffix == ".xlsx":
            raise WorkbookError("The disk is full", where=path)
        write(path, *arguments)

    monkeypatch.setattr(study_report, "write_workbook", fill)
    sheet, page = tmp_path / "found.xlsx", tmp_path / "found.html"
    outcome = xlmc("verify", book, "--all", "-o", sheet, "--html", page)
    assert outcome.code == 2
    assert outcome.err == f"xlmc: {sheet}: The disk is full.\n"
    assert "formula cell" in outcome.out
    assert outcome.out.endswith(f"Written: {page}\n")
    assert page.stat().st_size > 100


def test_a_file_that_becomes_the_workbook_during_a_study_spares_it(xlmc, book, tmp_path, monkeypatch):
    before, page = book.read_bytes(), tmp_path / "found.html"
    made = study_report._page

    def made_meanwhile(report):
        page.symlink_to(book)
        return made(report)

    monkeypatch.setattr(study_report, "_page", made_meanwhile)
    outcome = xlmc("verify", book, "--all", "--html", page, "--overwrite")
    assert outcome.code == 2
    assert outcome.err == f"xlmc: {page}: This is the file that is read. Name another file.\n"
    assert book.read_bytes() == before
