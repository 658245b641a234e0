"""The report as PDF and for a word processor: both say the same, and what they say is what the run gives."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import openpyxl
import pytest
from committed_books import BOOKS
from openpyxl.worksheet.table import Table as SheetTable

import xlmc
from xlmc.definitions.definitions import CaseDetails
from xlmc.errors import DefinitionError, SimulationError, WorkbookError
from xlmc.report.document import SECTIONS
from xlmc.report.document.parts import Bullets, Heading, Paragraph, Picture, Table
from xlmc.report.document.report_sections import describe
from xlmc.report.json_document import document as json_of

for library in ("docx", "pikepdf", "pypdf", "typst"):
    pytest.importorskip(library)

WRITER = Path(shutil.which("soffice") or "soffice").resolve().with_name("libswlo.so").exists()
CASE = {"title": "Impact at an intersection", "number": "2026-17", "analyst": "J. Doe", "date": "2026-11-20"}


@pytest.fixture(scope="module")
def run():
    return xlmc.load(BOOKS["intersection"]).simulate()


@pytest.fixture(scope="module")
def files(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("reports")
    return {ending: run.save_report(folder / f"report.{ending}", case=CASE) for ending in ("pdf", "docx")}


def pdf_pages(path):
    import pypdf

    return [page.extract_text() for page in pypdf.PdfReader(path).pages]


def docx_text(path):
    import docx

    found = docx.Document(str(path))
    cells = [cell.text for table in found.tables for row in table.rows for cell in row.cells]
    return "\n".join([*(paragraph.text for paragraph in found.paragraphs), *cells])


def squeezed(text):
    """Without blanks: lines are broken elsewhere in the two documents."""
    return re.sub(r"\s|\u200b|\u00ad", "", text)


@pytest.fixture(scope="module")
def texts(files):
    return {"pdf": squeezed("".join(pdf_pages(files["pdf"]))), "docx": squeezed(docx_text(files["docx"]))}


def whole(run, **given):
    asked = {"date": (2026, 11, 20), "paper": "a4", "sections": tuple(SECTIONS), "forecasts": list(run.results)}
    return describe(run, CaseDetails(**CASE), **{**asked, **given})


def said(document):
    """Every text of a document; captions of pictures among them, pictures in tables not."""
    for block in document.blocks:
        match block:
            case Heading(text):
                yield text
            case Paragraph(text, name):
                yield from (name, text)
            case Bullets(items):
                yield from (text for item in items for text in (item.name, item.text))
            case Picture():
                yield block.caption
            case Table(heads, rows):
                yield from heads
                yield from (cell for row in rows for cell in row if isinstance(cell, str))
    yield from (text for line in document.cover for text in line)


def test_the_case_study_has_five_to_ten_pages(files):
    pages = pdf_pages(files["pdf"])
    assert 5 <= len(pages) <= 10
    for number, page in enumerate(pages, 1):
        assert "2026-17" in page, number
        assert f"{number} of {len(pages)}" in page, number


def test_both_hold_every_text_of_the_description(run, texts):
    """LibreOffice and Typst may break a line anywhere, so blanks do not count."""
    pieces = {squeezed(text) for text in said(whole(run))} - {""}
    assert len(pieces) > 300
    for kind, text in texts.items():
        assert [piece for piece in pieces if piece not in text] == [], kind


def test_the_numbers_are_those_of_the_json(run, texts):
    for found in json.loads(json.dumps(json_of(run)))["forecasts"]:
        numbers = [found["statistics"]["mean"], found["statistics"]["standard_deviation"]]
        numbers += [found["central_range"]["low"], found["central_range"]["high"]]
        row = next(row for row in answers(run) if row[0] == found["name"])
        for cell, number in zip(row[2:6], numbers, strict=True):
            value, error = cell.split(" ± ")
            for shown, exact in ((value, number["value"]), (error, number["error"])):
                digits = len(shown.partition(".")[2])
                assert float(shown) == round(exact, digits), (found["name"], shown)
            assert all(squeezed(cell) in text for text in texts.values())


def answers(run):
    return next(block for block in whole(run).blocks if isinstance(block, Table)).rows


def test_the_counts_are_those_of_the_json(run):
    rows = [row for block in whole(run).blocks if isinstance(block, Table) for row in block.rows]
    for number, found in enumerate(json_of(run)["record"]["filters"]["rows"], 1):
        row = next(row for row in rows if row[0] == f"{number}. {found['name']}" and found["limits"] not in row)
        assert f"{found['rejected']:,}" in row, row
        assert f"{found['only']:,}" in row, row


def test_the_pdf_is_pdf_a_with_tags_and_its_fonts(files):
    import pikepdf

    with pikepdf.open(files["pdf"]) as pdf:
        root = pdf.Root
        assert root.MarkInfo.Marked
        assert "/StructTreeRoot" in root
        assert [intent.S for intent in root.OutputIntents] == ["/GTS_PDFA1"]
        with pdf.open_metadata() as about:
            assert (about["pdfaid:part"], about["pdfaid:conformance"]) == ("2", "A")
            assert about["dc:title"] == CASE["title"]
        fonts = [font for font in pdf.objects if isinstance(font, pikepdf.Dictionary) and font.get("/Type") == "/Font"]
        described = [font.FontDescriptor for font in fonts if "/FontDescriptor" in font]
        assert described
        assert all({"/FontFile", "/FontFile2", "/FontFile3"} & set(each.keys()) for each in described)
        assert "/CreationDate" in pdf.docinfo
        assert str(pdf.docinfo["/CreationDate"]).startswith("D:20261120")


@pytest.mark.parametrize("ending", ["pdf", "docx"])
def test_the_same_run_gives_the_same_bytes(run, files, tmp_path, ending):
    again = run.save_report(tmp_path / f"again.{ending}", case=CASE)
    assert again.read_bytes() == files[ending].read_bytes()


def test_the_word_file_has_headings_tables_and_captions(run, files):
    import docx

    found = docx.Document(str(files["docx"]))
    styles = {paragraph.style.name for paragraph in found.paragraphs}
    assert {"Title", "Heading 1", "Heading 2", "Caption", "List Bullet"} <= styles
    assert len(found.tables) > 6
    for table in found.tables[1:]:
        assert "w:tblHeader" in table.rows[0]._tr.xml
    pictures = found.element.xpath("//wp:docPr/@descr")
    assert len(pictures) == len(run.results) * 2 + len(run.model.live)
    assert all(pictures)
    assert "NUMPAGES" in found.sections[0].footer._element.xml
    assert "2026-17" in found.sections[0].header.paragraphs[0].text


@pytest.mark.skipif(not WRITER, reason="LibreOffice Writer is not installed (apt-get install libreoffice-writer-nogui)")
def test_libreoffice_shows_the_same_text(run, files, tmp_path):
    command = ["soffice", f"-env:UserInstallation=file://{tmp_path}/profile", "--headless", "--convert-to", "pdf"]
    subprocess.run(
        [*command, "--outdir", str(tmp_path), str(files["docx"])], check=True, capture_output=True, timeout=120
    )
    text = squeezed("".join(pdf_pages(tmp_path / "report.pdf")))
    cells = {squeezed(cell) for row in answers(run) for cell in row}
    heads = {squeezed(block.text) for block in whole(run).blocks if isinstance(block, Heading)}
    assert [piece for piece in cells | heads if piece not in text] == []


def test_sections_and_forecasts_are_those_asked_for(run, tmp_path):
    path = run.save_report(
        tmp_path / "short.pdf", sections=["repeat", "answer"], forecasts=["nissan DELTA-V"], paper="a4", case=CASE
    )
    (page,) = pdf_pages(path)
    assert page.index("Question and answer") < page.index("How to repeat it")
    assert "Nissan delta-V" in page
    assert "Chevrolet delta-V:" not in page
    assert "Trials and filters" not in page


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"sections": ["answers"]}, "the report has no section 'answers'"),
        ({"forecasts": ["Speed"]}, "there is no forecast 'Speed'"),
        ({"paper": "foolscap"}, "there is no paper 'foolscap'"),
        ({"case": {"date": "20.11.2026"}}, "'20.11.2026' is no date"),
        ({"case": {"judge": "N. N."}}, "a case has no 'judge'"),
    ],
)
def test_what_cannot_be_had_is_refused(run, tmp_path, given, said):
    with pytest.raises(SimulationError, match=re.escape(said)) as caught:
        run.save_report(tmp_path / "report.pdf", **given)
    assert caught.value.hint
    assert not list(tmp_path.iterdir())


def test_another_ending_and_a_file_that_is_there_are_refused(run, tmp_path):
    with pytest.raises(WorkbookError, match=r"must end in \.pdf or \.docx"):
        run.save_report(tmp_path / "report.doc")
    there = tmp_path / "report.pdf"
    there.write_bytes(b"theirs")
    with pytest.raises(WorkbookError, match="the file exists already"):
        run.save_report(there)
    assert there.read_bytes() == b"theirs"


MARKUP = '#strong[x] *a* _b_ `c` $d$ <e> & "f" \\g = h // i @j\u202e'


@pytest.fixture
def changed(small_book, tmp_path):
    """`changed(change)`: the model of the small book as `change` leaves it."""

    def make(change):
        book = openpyxl.load_workbook(small_book)
        change(book)
        book.save(tmp_path / "changed.xlsx")
        return xlmc.load(tmp_path / "changed.xlsx")

    return make


def test_names_in_a_workbook_are_no_markup(changed, tmp_path):
    def rename(book):
        for sheet, cell in (("Inputs", "A2"), ("Inputs", "F2"), ("Wanted", "A2"), ("Wanted", "A6"), ("Wanted", "D6")):
            book[sheet][cell] = MARKUP

    run = changed(rename).simulate(1_000)
    case = {**CASE, "title": MARKUP, "number": MARKUP, "analyst": MARKUP}
    shown = squeezed(MARKUP.removesuffix("\u202e"))
    for ending, text_of in (("pdf", lambda path: "".join(pdf_pages(path))), ("docx", docx_text)):
        text = squeezed(text_of(run.save_report(tmp_path / f"odd.{ending}", case=case)))
        assert text.count(shown) >= 6, ending


def test_a_character_that_no_font_has_is_named(run, tmp_path):
    """One of Unihan's latest: Typst would have to leave a hole, which PDF/A does not allow."""
    with pytest.raises(SimulationError, match=r"no font of this system has .\U0003134a") as caught:
        run.save_report(tmp_path / "report.pdf", case={"title": "Case \U0003134a"}, sections=["repeat"])
    assert "Install a font" in caught.value.hint
    assert run.save_report(tmp_path / "report.docx", case={"title": "Case \U0003134a"}, sections=["repeat"]).exists()


def test_what_no_file_can_hold_is_left_out(run, tmp_path):
    case = {"title": "A\ud83dB\x00C" + "x" * 400, "analyst": "\ud83d"}
    for ending, text_of in (("pdf", lambda path: "".join(pdf_pages(path))), ("docx", docx_text)):
        text = squeezed(text_of(run.save_report(tmp_path / f"r.{ending}", case=case, sections=["repeat"])))
        assert "ABCxxx" in text, ending


@pytest.mark.parametrize("limit", [None, -1.0], ids=["no filters", "nothing accepted"])
def test_runs_of_which_there_is_little_to_say(changed, tmp_path, limit):
    def change(book):
        if limit is None:
            del book["Wanted"].tables["xlmc_filters"]
        else:
            book["Wanted"]["C6"] = limit

    run = changed(change).simulate(500)
    assert run.accepted == (500 if limit is None else 0)
    for ending, text_of in (("pdf", lambda path: "".join(pdf_pages(path))), ("docx", docx_text)):
        text = squeezed(text_of(run.save_report(tmp_path / f"small.{ending}", case=CASE)))
        assert squeezed("has no filters" if limit is None else "Do not use these results") in text


def with_case(*rows):
    def change(book):
        sheet = book.create_sheet("Case")
        for row in (("Field", "Value"), *rows):
            sheet.append(row)
        sheet.add_table(SheetTable(displayName="xlmc_case", ref=f"A1:B{len(rows) + 1}"))

    return change


def test_the_table_of_the_case_is_on_the_cover(changed, tmp_path):
    model = changed(with_case(("Case number", "2026-18"), ("Organization", "ACME"), ("Date", 46053), ("Title", None)))
    assert model.definitions.case == CaseDetails(number="2026-18", organisation="ACME", date="2026-01-31")
    text = "".join(pdf_pages(model.simulate(400).save_report(tmp_path / "report.pdf", case={"number": "2026-19"})))
    assert "2026-19" in text
    assert "2026-18" not in text
    assert "ACME" in text
    assert "2026-01-31" in text


@pytest.mark.parametrize(
    ("rows", "where", "said"),
    [
        ([("Judge", "N. N.")], "Case!A2", "There is no field 'Judge'"),
        ([("Analyst", "A"), ("analyst", "B")], "Case!A3", "analyst is given twice"),
        ([("Date", "yesterday")], "Case!B2", "This is no date"),
        ([("Date", 1e300)], "Case!B2", "This is no date"),
    ],
)
def test_mistakes_in_the_table_of_the_case(changed, rows, where, said):
    with pytest.raises(DefinitionError, match=re.escape(said)) as caught:
        changed(with_case(*rows))
    assert str(caught.value.where) == where
