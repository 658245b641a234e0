"""The files of a study: an ending decides what is written, and what cannot be written is refused before it runs."""

from __future__ import annotations

import io
import json
import zipfile

import docx
import openpyxl
import pytest

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.target import TakenError
from xlmc.outputs import study_report
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.parts import Chart, Figure, Heading, Line, Lines, Paragraph, Table
from xlmc.outputs.study_report import TWO_LOOPS_NOT_KEPT, Files, StudyReport, book_parts

TABLE = Table("", ("Name", "Value"), (("Speed", Shown(12.5, "0.0")),))
LINES = Figure(Chart("", "x", Lines((Line("p", ((0.0, 0.0), (1.0, 1.0))),), "y"), "a line"), "Its caption.")


def report(**more):
    blocks = (Heading("Found"), Paragraph("All is well."), TABLE)
    return StudyReport("Study of 1 < 2", "book.xlsx, 9 trials", blocks, "Study", lambda: {"found": [1.5, None]}, **more)


@pytest.fixture
def files(tmp_path):
    """The files of a study of `book.xlsx`, by their names."""
    source = tmp_path / "book.xlsx"
    source.write_bytes(b"the workbook")

    def make(*names, overwrite=False, **more):
        return Files([tmp_path / name for name in names], [source], overwrite=overwrite, **more)

    return make


def _written(files, *names, made=None, **more):
    result = files(*names, **more)
    result.check()
    return [write() for _, write in result.writers(made or report())]


def test_a_workbook_has_the_title_and_all_blocks(files):
    [path] = _written(files, "found.xlsx")
    book = openpyxl.load_workbook(path)
    assert book.sheetnames == ["Study"]
    column = [cell.value for cell in book["Study"]["A"] if cell.value is not None]
    assert column == ["Study of 1 < 2", "book.xlsx, 9 trials", "Found", "All is well.", "Name", "Speed"]
    assert [cell.row for cell in book["Study"]["A"] if cell.value is not None] == [1, 2, 5, 6, 7, 8]
    assert book["Study"]["B8"].value == 12.5


@pytest.mark.parametrize("charted", [False, True])
def test_numbers_of_charts_stand_on_a_hidden_sheet_of_their_own(charted):
    made = report(
        on_sheet=(TABLE, LINES) if charted else (TABLE,), add_sheets=lambda book, _: book.add_worksheet("More")
    )
    with zipfile.ZipFile(io.BytesIO(_packed(book_parts(made)))) as packed:
        book = openpyxl.load_workbook(io.BytesIO(_packed({n: packed.read(n) for n in packed.namelist()})))
    assert [(sheet.title, sheet.sheet_state) for sheet in book] == [
        ("Study", "visible"),
        *[("Numbers", "hidden")] * charted,
        ("More", "visible"),
    ]
    assert "Found" not in [cell.value for cell in book["Study"]["A"]]
    if charted:
        assert book["Numbers"].print_title_rows == "$1:$1"


def _packed(parts):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    return packed.getvalue()


@pytest.mark.parametrize("name", ["found.html", "FOUND.HTM"])
def test_a_page_has_the_title_and_all_blocks(files, name):
    [path] = _written(files, name)
    text = path.read_text(encoding="utf-8")
    for part in ("Study of 1 &lt; 2", "book.xlsx, 9 trials", "All is well.", "Speed", "12.5"):
        assert part in text


def test_a_document_for_word_has_the_title_and_all_blocks(files):
    [path] = _written(files, "found.docx")
    written = docx.Document(path)
    texts = [each.text for each in written.paragraphs]
    for part in ("Study of 1 < 2", "book.xlsx, 9 trials", "Found", "All is well."):
        assert part in texts
    assert [cell.text for cell in written.tables[-1].rows[1].cells] == ["Speed", "12.5"]


def test_json_has_what_was_found(files):
    [path] = _written(files, "found.json")
    assert json.loads(path.read_text(encoding="utf-8"))["found"] == [1.5, None]


def test_a_picture_is_the_figure(files):
    [path] = _written(files, "found.png", made=report(drawn=lambda: b"a picture"), drawn=True)
    assert path.read_bytes() == b"a picture"


@pytest.mark.parametrize(
    ("names", "drawn", "shown"),
    [
        (["found.xlsx", "found.json"], True, False),
        (["found.xlsx", "found.PNG"], True, True),
        (["found.html"], True, True),
        (["found.pdf"], True, True),
        (["found.html"], False, False),
        ([], True, False),
    ],
)
def test_which_files_show_a_figure(files, names, drawn, shown):
    assert files(*names, drawn=drawn).show_figures is shown


@pytest.mark.parametrize(
    ("name", "more", "message"),
    [
        ("found.txt", {}, "This command writes no file that ends in .txt"),
        ("found.png", {}, "This command writes no file that ends in .png"),
        ("found.csv", {}, "This command writes no file that ends in .csv"),
        ("found.xlmcrun", {}, "This command writes no file that ends in .xlmcrun"),
        ("found.xlmcrun", {"of_run": True, "not_kept": TWO_LOOPS_NOT_KEPT}, "This run cannot be kept"),
        ("found.XLMCRUN", {"of_run": True, "not_kept": TWO_LOOPS_NOT_KEPT}, "This run cannot be kept"),
        ("nowhere/found.html", {}, "[Ff]older"),
    ],
)
def test_what_cannot_be_written_is_refused_at_once(files, name, more, message):
    with pytest.raises(WorkbookError, match=message):
        files(name, **more).check()


@pytest.mark.parametrize("name", ["found.csv", "found.parquet", "found.xlmcrun"])
def test_trials_of_a_run_can_be_written(files, name):
    files(name, of_run=True).check()
    if name != "found.xlmcrun":
        files(name, of_run=True, not_kept=TWO_LOOPS_NOT_KEPT).check()


@pytest.mark.parametrize(("names", "drawn", "refused"), [(["f.html"], True, True), (["f.json"], True, False)])
def test_a_figure_needs_its_library(files, monkeypatch, names, drawn, refused):
    monkeypatch.setattr(study_report, "find_spec", lambda name: None)
    if refused:
        with pytest.raises(WorkbookError, match="matplotlib, which is not installed"):
            files(*names, drawn=drawn).check()
    files(*names, drawn=drawn and not refused).check()


def test_the_workbook_that_is_studied_is_never_written_to(files, tmp_path):
    with pytest.raises(TakenError):
        files("book.xlsx", overwrite=True).check()
    assert (tmp_path / "book.xlsx").read_bytes() == b"the workbook"


@pytest.mark.parametrize("name", ["found.html", "found.xlsx", "found.json"])
def test_a_file_of_ours_is_replaced_and_that_of_a_person_is_not(files, tmp_path, name):
    [path] = _written(files, name)
    first = path.read_bytes()
    assert _written(files, name) == [path]
    assert path.read_bytes() == first
    path.write_bytes(b"of a person")
    with pytest.raises(TakenError):
        files(name).check()
    [write] = [write for _, write in files(name).writers(report())]
    with pytest.raises(TakenError):
        write()
    assert path.read_bytes() == b"of a person"
    assert _written(files, name, overwrite=True) == [path]
    assert path.read_bytes() == first
