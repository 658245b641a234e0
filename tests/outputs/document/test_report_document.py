from __future__ import annotations

import re
import time
import zipfile
from datetime import date
from pathlib import Path

import pytest
from document_texts import squeezed, texts_of
from simulated import simulated

from xlmc.api import Simulation
from xlmc.errors import SimulationError, WorkbookError
from xlmc.montecarlo.definitions.vocabulary import CRASH
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.document import SECTIONS, Wanted
from xlmc.outputs.document.build import build
from xlmc.outputs.document.glossary import GLOSSARY, WORDS_OF_EVIDENCE, WORDS_OF_SCENARIOS
from xlmc.outputs.document.parts import Heading, Table
from xlmc.outputs.json_document import document as results

docx = pytest.importorskip("docx")
pikepdf = pytest.importorskip("pikepdf")
pypdf = pytest.importorskip("pypdf")
pytest.importorskip("typst")

ROOT = Path(__file__).parents[3]
BOOK = ROOT / "examples" / "intersection.xlsx"
CASE = {"Case number": "2026-17", "Analyst": "J. Doe", "Date": "2026-11-23", "Client": '#x *b* <i> & "q" \\n $a$ @y'}
NUMBER = re.compile(r"(?<![\w.,])[-−]?\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?(?![\w]|\.\d)")


@pytest.fixture(scope="module")
def case_study():
    return simulated(load(BOOK), trials=20_000)


@pytest.fixture(scope="module")
def built(case_study):
    return build(case_study, Wanted(CASE))


@pytest.fixture(scope="module")
def files(case_study, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    return [Simulation(case_study).save_report(folder / f"report{ending}", case=CASE) for ending in (".pdf", ".docx")]


@pytest.fixture(scope="module")
def pages(files):
    return [page.extract_text() for page in pypdf.PdfReader(files[0]).pages]


@pytest.fixture(scope="module")
def word(files):
    result = docx.Document(files[1])
    for run in result.element.iter("{http://schemas.openxmlformats.org/wordprocessingml/2006/main}t"):
        run.text = run.text.replace("\u00a0", " ")
    return result


def texts_of_word(word):
    for paragraph in word.paragraphs:
        yield paragraph.text
    for table in word.tables:
        yield from (cell.text for row in table.rows for cell in row.cells)


def numbers_in(value):
    """Every number of a JSON document, those in its texts too."""
    if isinstance(value, bool) or value is None:
        return
    if isinstance(value, int | float):
        yield float(value)
    elif isinstance(value, str):
        yield from (float(result.replace(",", "").replace("−", "-")) for result in NUMBER.findall(value))
    else:
        for each in value.values() if isinstance(value, dict) else value:
            yield from numbers_in(each)


def agrees(shown, known):
    """Whether a printed number is one of the known ones, or 100 times one, rounded to the digits that it has."""
    mantissa, _, power = shown.replace(",", "").replace("−", "-").partition("e")
    decimals = len(mantissa.partition(".")[2]) - int(power or 0)
    value, half = float(f"{mantissa}e{power or 0}"), 0.5000001 * 10.0**-decimals
    return any(abs(scale * each - value) <= half for scale in (1.0, 100.0) for each in known)


def test_the_case_study_has_five_to_ten_pages_with_the_case_and_the_page_on_each(pages):
    assert 5 <= len(pages) <= 10
    for number, text in enumerate(pages, 1):
        assert "Case 2026-17" in text
        assert f"Page {number} of {len(pages)}" in text


def test_every_section_stands_in_the_report_in_its_order(built, word):
    absent = (
        "Notices",
        SECTIONS["scene-trials"].heading,
        SECTIONS["evidence"].heading,
        SECTIONS["scenarios"].heading,
    )  # the paper's case has none of them
    expected = [each.title(CRASH) for each in SECTIONS.values() if not (each.asked_for or each.heading in absent)]
    assert [block.text for block in built.blocks if isinstance(block, Heading)] == expected
    assert [each.text for each in word.paragraphs if each.style.name == "Heading 1"] == expected


def test_both_files_hold_every_text_of_the_document(built, pages, word):
    in_pdf, in_word = squeezed("".join(pages)), squeezed("".join(texts_of_word(word)))
    result = list(texts_of(built))
    assert len(result) > 300
    in_pdf = re.sub(r"intersection\.xlsx,seed999Page\d+of\d+|Case2026-17", "", in_pdf)
    lost = [text for text in result if squeezed(text) not in in_word]
    assert lost == []
    lost = [text for text in result if squeezed(text) not in in_pdf and squeezed(text) != "2026-17"]
    assert lost == []


def test_every_number_in_both_files_is_one_of_the_run(case_study, built, files, pages, word):
    known = sorted(set(numbers_in(results(case_study))))
    sections = {block.text for block in built.blocks if isinstance(block, Heading)}
    assert sections >= {"The question and the answer", "Assumptions", "What the answers depend on"}
    count = 0
    for table in word.tables[:6]:
        if table.rows[0].cells[0].text == "Quantity":  # equations, which are texts of the workbook
            continue
        for row in table.rows[1:]:
            for cell in row.cells[1:]:
                for result in NUMBER.findall(cell.text):
                    assert agrees(result, known), (result, cell.text)
                    count += 1
    assert count > 200


def test_the_answers_are_those_of_the_json_digit_by_digit(case_study, word, pages):
    table, text = word.tables[0], squeezed("".join(pages))
    for row, forecast in zip(table.rows[1:], results(case_study)["forecasts"], strict=True):
        cells = [cell.text for cell in row.cells]
        assert cells[:2] == [forecast["name"], forecast["units"]]
        asked = forecast["statistics"], forecast["central_range"]
        result = (asked[0]["mean"], asked[0]["standard_deviation"], asked[1]["low"], asked[1]["high"])
        for cell, estimate in zip(cells[2:6], result, strict=True):
            value, _, error = cell.partition(" ± ")
            decimals = len(value.partition(".")[2])
            assert value == f"{estimate['value']:.{decimals}f}"
            assert error == f"{estimate['error']:.{decimals}f}"
            assert len(error.replace(".", "").lstrip("0")) == 2
        assert squeezed("".join(cells)) in text


def shown(estimate, text, scale=1.0):
    """Whether a printed number and its error are those of an estimate, to the digits printed."""
    value, _, error = text.removesuffix(" %").partition(" ± ")
    decimals = len(value.partition(".")[2])
    same = value == f"{scale * estimate['value']:,.{decimals}f}", error == f"{scale * estimate['error']:,.{decimals}f}"
    return all(same)


def table_with(word, head):
    (result,) = [table for table in word.tables if head in [cell.text for cell in table.rows[0].cells]]
    return [[cell.text for cell in row.cells] for row in result.rows[1:]]


def test_every_assumption_has_its_numbers_of_the_json(case_study, word):
    asked = results(case_study)["assumptions"]
    for row, each in zip(table_with(word, "Distribution and source"), asked, strict=True):
        assert row[0] == f"{each['name']}, {each['units']}"
        assert each["source"] in row[1]
        for text, name in zip(row[2:4], ("mean", "standard_deviation"), strict=True):
            before, accepted = text.split("\n")
            assert shown(each["prior"][name], before)
            assert shown(each["accepted"][name], accepted)


def test_every_equation_has_its_units_and_one_symbol(word):
    rows = table_with(word, "Quantity")
    by_symbol = {symbol: (units, equation) for _, symbol, units, equation, _ in rows}
    assert len(by_symbol) == len(rows)
    assert by_symbol["ΔV1 (mph)"] == ("mph", "ΔV1 · 3600/5280")
    assert by_symbol["V1f"] == ("ft/s", "√(2 · g · f1 · s1)")


def test_every_influence_has_its_numbers_of_the_json(case_study, word):
    known = {
        (forecast["forecast"], each["assumption"]): each
        for forecast in results(case_study)["sensitivity"]["forecasts"]
        for each in forecast["influences"]
    }
    forecast, compared = "", 0
    for first, assumption, explained, rank in table_with(word, "Variance explained"):
        forecast = first or forecast
        each = known[forecast, assumption]
        number = explained.removeprefix("at least ")
        assert explained == "noise" or (number != explained) == each["explained_at_least"]
        assert explained == "noise" or shown(each["explained"], number, 100.0)
        assert rank == "noise" or shown(each["rank_correlation"], rank)
        compared += (explained != "noise") + (rank != "noise")
    assert compared > 20


def test_what_each_filter_rejected_is_that_of_the_json(case_study, word):
    table = word.tables[1]
    for row, each in zip(table.rows[1:], results(case_study)["filters"], strict=True):
        cells = [cell.text for cell in row.cells]
        assert cells[2] == each["because"]
        assert (cells[3], cells[5]) == (f"{each['rejected']:,}", f"{each['only']:,}")


def test_the_pdf_is_pdf_a_with_an_intent_embedded_fonts_and_tags(files):
    with pikepdf.open(files[0]) as pdf:
        (intent,) = pdf.Root.OutputIntents
        assert intent.S == "/GTS_PDFA1"
        with pdf.open_metadata() as metadata:
            assert (metadata.pdfa_status, metadata.get("pdfuaid:part")) == ("2A", "1")
            assert metadata.get("dc:title") == "Results of intersection.xlsx"
        assert pdf.Root.MarkInfo.Marked
        assert str(pdf.Root.Lang) == "en"
        objects = [each for each in pdf.objects if isinstance(each, pikepdf.Dictionary)]
        tags = {str(each.S) for each in objects if "/S" in each}
        assert tags >= {"/H1", "/P", "/Table", "/TR", "/TH", "/TD", "/Figure", "/Caption", "/L", "/LI"}
        fonts = [each for each in objects if "/FontName" in each]
        assert fonts
        assert all(any(key in each for key in ("/FontFile", "/FontFile2", "/FontFile3")) for each in fonts)
        assert "D:20261123" in str(pdf.docinfo["/CreationDate"])
        pictures = [
            each for each in pdf.objects if isinstance(each, pikepdf.Dictionary) and each.get("/S") == "/Figure"
        ]
        assert pictures
        assert all(len(str(each.Alt)) > 10 for each in pictures)


@pytest.mark.parametrize("year", [1970, 2030, 2200])
def test_a_word_file_asks_no_clock(run, tmp_path, monkeypatch, year):
    """A zip holds no date before 1980 or after 2107."""
    monkeypatch.setattr("time.localtime", lambda *_: time.struct_time((year, 1, 2, 3, 4, 5, 4, 2, 0)))
    path = Simulation(run).save_report(tmp_path / f"{year}.docx")
    assert path.read_bytes() == Simulation(run).save_report(tmp_path / "again.docx").read_bytes()


def test_the_same_run_gives_the_same_bytes(run, tmp_path):
    first, again = Simulation(run), Simulation(simulated(run.model))
    for ending in (".pdf", ".docx"):
        fewer = {"sections": ["answer", "forecasts", "assumptions"]} if ending == ".pdf" else {}  # pictures and tables
        asked = {"case": CASE, **fewer}
        one, other = (each.save_report(tmp_path / f"{id(each)}{ending}", **asked) for each in (first, again))
        assert one.read_bytes() == other.read_bytes()


def test_word_has_headings_captions_heading_rows_and_numbered_pages(files, word):
    assert word.core_properties.author == "J. Doe"
    assert word.core_properties.created.date() == date(2026, 11, 23)
    captions = [each.text for each in word.paragraphs if each.style.name == "Caption"]
    assert len(captions) == len(word.tables) + 9
    with zipfile.ZipFile(files[1]) as package:
        assert package.read("word/document.xml").count(b"<w:tblHeader/>") == len(word.tables)
        foot = b"".join(package.read(name) for name in package.namelist() if "footer" in name)
    assert foot.count(b"fldSimple w:instr") == 2


def test_no_line_of_word_ends_between_a_number_and_its_percent_sign_unit_or_error(files):
    result = "\n".join(texts_of_word(docx.Document(files[1])))
    assert len(re.findall(r"\d\u00a0(?:%|mph)(?!\w)", result)) > 50
    assert len(re.findall(r"±\u00a0\d", result)) > 100
    assert not re.search(r"\d (?:%|mph)(?!\w)|± \d", result)


def test_texts_of_a_person_never_become_markup(pages, word):
    assert squeezed(CASE["Client"]) in squeezed(pages[0])
    assert CASE["Client"] in "\n".join(paragraph.text for paragraph in word.paragraphs)


def test_sections_forecasts_and_paper_can_be_chosen(case_study, tmp_path):
    wanted = Wanted({}, ["answer", "forecasts"], ["NISSAN delta-v "], "a4")
    result = build(case_study, wanted)
    assert [each.text for each in result.blocks if isinstance(each, Heading)] == [
        "The question and the answer",
        "The forecasts",
    ]
    (table,) = [each for each in result.blocks if isinstance(each, Table)]
    assert [row[0] for row in table.rows] == ["Nissan delta-V"]
    path = Simulation(case_study).save_report(tmp_path / "a.pdf", sections=["answer"], paper="a4")
    box = pypdf.PdfReader(path).pages[0].mediabox
    assert (round(float(box.width)), round(float(box.height))) == (595, 842)


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"sections": ["nothing"]}, "no section 'nothing'"),
        ({"forecasts": ["nothing"]}, "no forecast 'nothing'"),
        ({"paper": "a5"}, "no paper 'a5'"),
        ({"case": {" ": "x"}}, "no name"),
    ],
)
def test_what_no_report_has_is_refused(case_study, tmp_path, asked, message):
    with pytest.raises(SimulationError, match=message):
        Simulation(case_study).save_report(tmp_path / "report.pdf", **asked)
    assert list(tmp_path.iterdir()) == []


def test_no_file_is_replaced_unless_asked(case_study, tmp_path):
    path = tmp_path / "report.docx"
    path.write_bytes(b"a person's")
    with pytest.raises(WorkbookError, match="exists already"):
        Simulation(case_study).save_report(path)
    assert path.read_bytes() == b"a person's"
    Simulation(case_study).save_report(path, sections=["answer"], overwrite=True)
    assert docx.Document(path).tables
    with pytest.raises(WorkbookError, match=r"must end in \.pdf or \.docx"):
        Simulation(case_study).save_report(tmp_path / "report.txt")


def test_a_missing_library_is_named_with_what_to_install(case_study, tmp_path, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.document.report_file.find_spec", lambda name: None)
    with pytest.raises(SimulationError, match="typst, which is not installed") as refused:
        Simulation(case_study).save_report(tmp_path / "report.pdf")
    assert 'pip install "' in str(refused.value)


def test_words_are_those_of_the_glossary():
    text = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
    plain = squeezed(re.sub(r"[*`]", "", text))
    for word, meaning in (*GLOSSARY, *WORDS_OF_EVIDENCE, *WORDS_OF_SCENARIOS):
        rest = re.sub(r"^(or quantile|SD|written ±): ", "", meaning)
        assert squeezed(CRASH.fill(rest)) in plain, word
        assert squeezed(word) in plain


def test_rows_with_empty_cells_are_as_low_as_others(files):
    """A cell is at least as high as the mark at its paragraph's end, so that mark is as small as the texts."""
    tables = docx.Document(files[1]).tables
    cells = [cell for table in tables for row in table.rows for cell in row.cells]
    empty = [cell.paragraphs[0]._p for cell in cells if not cell.text and not cell._tc.xpath(".//w:drawing")]
    sizes = {size for paragraph in empty for size in paragraph.xpath("w:pPr/w:rPr/w:sz/@w:val")}
    assert len(empty) > 1
    assert all(len(paragraph.xpath("w:pPr/w:rPr/w:sz")) == 1 for paragraph in empty)
    assert max(map(int, sizes)) <= 17
