"""Result workbooks as LibreOffice prints them: every sheet has a page, every chart draws something, pages are few."""

from __future__ import annotations

import io
import re
import subprocess
from dataclasses import dataclass
from html import unescape
from itertools import repeat
from zipfile import ZipFile

import numpy as np
import openpyxl
import pytest
from committed_books import BOOKS, ROOT
from document_texts import squeezed, texts_of
from fewer_sheets import leave_out, leave_out_drawings
from needed_programs import missing
from packed_sheets import packed_sheets
from simulated import simulated

from xlmc.engine.engines import ENGINES
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.definitions.definitions_reader import read_definitions
from xlmc.montecarlo.model.loading import load
from xlmc.outputs import save
from xlmc.outputs.document import Wanted
from xlmc.outputs.document.build import build
from xlmc.outputs.document.report_file import save_report
from xlmc.outputs.sheets.exact_book import ExactSheet

EXAMPLE = ROOT / "examples/intersection.xlsx"
OWN = {
    *("Results", "Charts", "Statistics", "Certainty", "Pairs", "Assumptions", "Sensitivity", "Filter limits"),
    *("Trials", "Bins", "Curves", "Record"),
}
DPI, POINTS = 60, 72

CHART = (180.0, 150.0)
"""What is looked at of a chart on paper, width and height in points: it lies within the chart, whatever the font."""

ENDS = [(1.5, 7.5), (None, 13.0), (11.0, None), (None, None)]
"""Of ranges that a person types, one for each forecast."""

CASE, MOST = 15, 25
"""The most pages of the case study, and of any book that belongs to the project."""

OF_REPORT = {"Case number": "2026-17", "Client": '#x *b* <i> & "q"'}

MISSING = missing("soffice", "pdftotext", "pdftoppm")

pytestmark = pytest.mark.skipif(bool(MISSING), reason=MISSING)


@dataclass(frozen=True)
class Printed:
    """A page: the sheet it shows, its words as (text, left, top) in points, and `(rows, columns, 3)` pixels or None."""

    sheet: str
    words: list[tuple[str, float, float]]
    pixels: np.ndarray | None

    @property
    def text(self):
        return " ".join(word for word, _, _ in self.words)


FIRST_PAGE = 'pdf:calc_pdf_Export:{"PageRange":{"type":"string","value":"1"}}'
"""A PDF of the first page alone, whose footer says how many there are: LibreOffice draws no other."""


def converted(to, folder, *books):
    """Several in one call: LibreOffice takes longer to start than for a small book."""
    profile = f"-env:UserInstallation={(folder / 'profile').as_uri()}"
    command = ["soffice", profile, "--headless", "--convert-to", to, "--outdir", str(folder / "out")]
    subprocess.run([*command, *map(str, books)], check=True, capture_output=True, timeout=600)
    return [folder / "out" / f"{book.stem}.{to.partition(':')[0]}" for book in books]


@pytest.fixture(scope="module")
def case():
    return simulated(load(EXAMPLE), trials=50_000)


@pytest.fixture(scope="module")
def drawn(make):
    """A run whose charts are few, yet of every kind; two of its three forecasts have one unit."""
    cells = {"A1": 2.0, "A2": 3.0, "B1": "=A1*A2+9", "B2": "=A1-A2", "B3": "=A2^2", "C1": "=A1"}
    assumptions = [make.uniform("width", "A1", 1.0, 3.0, base=2.0), make.uniform("length", "A2", 2.0, 4.0, base=3.0)]
    forecasts = [make.forecast(f"way {k}", f"B{k}", units=units) for k, units in enumerate(("ft", "ft", "s"), 1)]
    filters = [make.filter("narrow", "C1", above=1.1, below=2.5)]
    return make.simulate(cells, assumptions, forecasts, filters, trials=400)


@pytest.fixture(scope="module")
def typed(make):
    """A run of a forecast for each of `ENDS`."""
    cells = {"A1": 0.5, **{f"B{k}": f"={10 * k}*A1" for k in range(1, 5)}}
    forecasts = [make.forecast(f"way {k}", f"B{k}") for k in range(1, 5)]
    return make.simulate(cells, [make.uniform("a", "A1", 0.0, 1.0, base=0.5)], forecasts, trials=60)


@pytest.fixture(scope="module")
def printed(case, drawn, typed, tmp_path_factory):
    """Name -> PDF: `case` as it prints, the charts of `drawn`, `typed` with other ranges, and the report of `drawn`."""
    folder = tmp_path_factory.mktemp("rendering")
    with pytest.MonkeyPatch.context() as patch:
        leave_out_drawings(patch)
        book = _without_charts(save(case, folder / "case.xlsx", rows=60))
    others = _unprinted(drawn, folder / "charts.xlsx"), _with_ranges(typed, folder / "typed.xlsx")
    report = save_report(drawn, folder / "report.docx", Wanted(OF_REPORT))
    files = converted("pdf", folder, book, *others, report)
    return {file.stem: file for file in files}  # without the report where LibreOffice Writer is not installed


@pytest.fixture(scope="module")
def longest():
    """The names of the books that no other one exceeds; an SI edition has the sheets of the imperial one.

    How many pages a book takes is decided by how much it defines and how many cells it has. A book that has no more of
    anything than another one is left out; so a new one that could be longer than those printed is itself printed.
    """
    sizes = {_size(read_workbook(path)): name for name, path in BOOKS.items() if not name.endswith("-si")}
    return [name for size, name in sizes.items() if not any(map(_exceeds, sizes.keys() - {size}, repeat(size)))]


def _size(workbook):
    """How many assumptions, forecasts, filters (evidence among them) and cells it has."""
    defined = read_definitions(workbook, ENGINES)
    assert defined.forecasts
    assert not defined.problems
    filters = len(defined.filters) + len(defined.forecast_filters) + len(defined.evidence)
    cells = sum(len(sheet.cells) for sheet in workbook.sheets.values())
    return len(defined.assumptions), len(defined.forecasts), filters, cells


def _exceeds(one, other):
    return all(a >= b for a, b in zip(one, other, strict=True))


@pytest.fixture(scope="module")
def longest_printed(longest, tmp_path_factory):
    """Name -> PDF of the first page of the results of each of `longest`."""
    folder = tmp_path_factory.mktemp("books")
    with pytest.MonkeyPatch.context() as patch:
        leave_out_drawings(patch)
        books = [
            _without_charts(save(simulated(load(BOOKS[name]), trials=5_000), folder / f"{name}.xlsx", rows=60))
            for name in longest
        ]
    return {file.stem: file for file in converted(FIRST_PAGE, folder, *books)}


def _without_charts(book):
    """The workbook without its charts, on which no page depends, and which take most of the time to print."""
    bare = book.with_suffix(".part")
    with ZipFile(book) as whole, ZipFile(bare, "w") as package:
        for name in whole.namelist():
            part = whole.read(name)
            if name.startswith("xl/worksheets/sheet"):
                part = re.sub(rb"<drawing r:id=[^>]*/>", b"", part)
            package.writestr(name, part)
    return bare.replace(book)


def _unprinted(run, path):
    """The sheets of numbered charts of a run, with all that they leave out of print."""
    print_area, data = ExactSheet.print_area, ("Trials", "Bins", "Curves")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ExactSheet, "print_area", lambda sheet, *area: sheet.name in data and print_area(sheet, *area))
        leave_out(patch, *OWN - {"Charts", "Pairs", *data})
        path.write_bytes(packed_sheets(run, rows=60))
    return path


def _with_ranges(run, path):
    """The sheet Certainty of a run with `ENDS` for its ranges, and a sheet that says what is counted in each."""
    with pytest.MonkeyPatch.context() as patch:
        leave_out(patch, *OWN - {"Certainty", "Trials"})
        book = openpyxl.load_workbook(io.BytesIO(packed_sheets(run, rows=60)))
    sheet, counted = book["Certainty"], book.create_sheet("Counted", 0)
    rows = [row[0].row for row in sheet.iter_rows() if str(row[4].value).startswith("=SUMPRODUCT")]
    for row, (low, high) in zip(rows, ENDS, strict=True):
        sheet.cell(row, 3).value, sheet.cell(row, 4).value = low, high
        counted.append([f'="counted "&TEXT(Certainty!E{row},"0.{"0" * 15}")&" of "&Certainty!G{row}'])
    book.save(path)
    return path


def _count(pdf):
    """The number of pages, as the footer of the first one says it."""
    shown = subprocess.run(["pdftotext", str(pdf), "-"], check=True, capture_output=True, text=True).stdout
    (count,) = re.findall(r"^Page 1 of (\d+)$", shown, re.MULTILINE)
    return int(count)


def _pieces(pdf):
    """The words of each page, with their boxes."""
    shown = subprocess.run(["pdftotext", "-bbox", str(pdf), "-"], check=True, capture_output=True, text=True).stdout
    return re.split(r"<page [^>]*>", shown)[1:]


@pytest.fixture(scope="module")
def pages(printed):
    """Of the case as it prints."""
    return [_printed(piece) for piece in _pieces(printed["case"])]


@pytest.fixture(scope="module")
def all_pages(printed):
    """Of the charts, with what is left out of print, and their pixels."""
    pdf = printed["charts"]
    subprocess.run(["pdftoppm", "-r", str(DPI), str(pdf), str(pdf.with_name("page"))], check=True)
    pictures = sorted(pdf.parent.glob("page-*.ppm"))
    return [_printed(piece, _pixels(picture)) for piece, picture in zip(_pieces(pdf), pictures, strict=True)]


def _printed(piece, pixels=None):
    result = re.findall(r'<word xMin="([\d.]+)" yMin="([\d.]+)"[^>]*>([^<]*)<', piece)
    words = [(unescape(text), float(left), float(top)) for left, top, text in result]
    foot = max((top for _, _, top in words), default=0.0)
    footer = [text for text, _, top in words if foot - top < 3.0]
    return Printed(" ".join(footer[1 : footer.index("Page")]) if "Page" in footer else "", words, pixels)


def _pixels(path):
    data = path.read_bytes()
    _, size, _, pixels = data.split(b"\n", 3)
    width, height = map(int, size.split())
    return np.frombuffer(pixels, np.uint8).reshape(height, width, 3).astype(int)


def captions(pages, word):
    """Where each chart's caption begins: number -> page, left, top."""
    result = {}
    for page in pages:
        following = zip(page.words, page.words[1:], page.words[2:], strict=False)
        for (text, left, top), (second, _, _), (third, _, _) in following:
            number = {"Figure": second, "Scatter": third}.get(word) if text == word else None
            if number and re.fullmatch(r"\d+\.", number):
                result[int(number[:-1])] = page, left, top
    return result


def coloured(page, left, top):
    """The share of coloured pixels above a caption, where its chart stands."""
    width, height = CHART
    rows, columns = (
        slice(int(a * DPI / POINTS), int(b * DPI / POINTS)) for a, b in ((top - height, top), (left, left + width))
    )
    area = page.pixels[rows, columns]
    return float(np.mean(area.max(axis=2) - area.min(axis=2) > 60))


def test_every_sheet_has_a_page_with_something_on_it(pages):
    assert {page.sheet for page in pages} >= OWN - {"Trials", "Bins", "Curves"}
    assert all(len(page.words) > 8 for page in pages)


@pytest.mark.parametrize(("word", "count"), [("Figure", 11), ("Scatter", 3)])
def test_every_chart_draws_something_above_its_caption(all_pages, word, count):
    result = captions(all_pages, word)
    assert sorted(result) == list(range(1, count + 1))
    for number, at in result.items():
        assert coloured(*at) > 0.004, f"{word} {number}"


def test_charts_show_their_titles_and_axes(all_pages, drawn):
    shown = " ".join(page.text for page in all_pages if page.sheet == "Charts")
    for name in drawn.forecasts:
        assert f"{name}: cumulative" in shown
        assert f"{name}: reverse cumulative" in shown
    assert "Overlay of forecasts in ft" in shown
    assert "Trend of forecasts in ft" in shown
    assert "Inside 51 % range" in shown


def test_the_sentences_are_printed_whole(pages, case):
    from xlmc.analysis.results.statements.sentences import statements

    printed = " ".join(page.text for page in pages if page.sheet == "Certainty")
    for statement in statements(case):
        assert statement.text in printed


@pytest.mark.parametrize(
    ("sheet", "count"),
    [
        *(("Results", 1), ("Charts", 1), ("Statistics", 1), ("Certainty", 1), ("Pairs", 1), ("Assumptions", 1)),
        *(("Sensitivity", 1), ("Filter limits", 1), ("Trials", 0), ("Bins", 0), ("Curves", 0), ("Record", 1)),
    ],
)
def test_no_table_is_broken_across_pages_and_details_are_not_printed(pages, sheet, count):
    assert [page.sheet for page in pages].count(sheet) == count


def test_the_whole_case_prints_on_few_pages(pages, printed):
    """The sheets of the book are among them."""
    assert {page.sheet for page in pages} - OWN
    assert len(pages) <= CASE
    assert len(pages) == _count(printed["case"])


def test_every_book_prints_on_few_pages(longest_printed, longest):
    """Whole, with the sheets of the book."""
    pages = {name: _count(pdf) for name, pdf in longest_printed.items()}
    assert list(pages) == longest
    assert {name: count for name, count in pages.items() if count > MOST} == {}


def test_no_cell_is_too_narrow_for_its_number(pages):
    assert not [page.sheet for page in pages if page.sheet in OWN and "###" in page.text]


def test_ranges_that_a_person_types_are_counted_anew(printed, typed):
    """openpyxl saves no values with formulas, so that LibreOffice has to compute them."""
    shown = " ".join(_printed(piece).text for piece in _pieces(printed["typed"]))
    counted = re.findall(r"counted (\d\.\d{15}) of (\d+)", shown)
    assert len(counted) == len(ENDS)
    for (share, trials), (low, high), result in zip(counted, ENDS, typed.results.values(), strict=True):
        values = result.values[:60]
        inside = (values >= (-np.inf if low is None else low)) & (values <= (np.inf if high is None else high))
        assert float(share) == pytest.approx(inside.mean(), abs=1e-12)
        assert trials == "60"


def test_a_report_for_word_shows_all_its_texts(printed, drawn):
    pytest.importorskip("docx")
    if not printed["report"].exists():
        pytest.skip("LibreOffice Writer is not installed (apt-get install libreoffice-writer-nogui)")
    pages = subprocess.run(
        ["pdftotext", "-raw", str(printed["report"]), "-"], check=True, capture_output=True, text=True
    ).stdout
    text = re.sub(r"book\.xlsx,seed1Page\d+of\d+|Case2026-17", "", squeezed(pages))
    texts = list(texts_of(build(drawn, Wanted(OF_REPORT))))
    assert len(texts) > 150
    assert [each for each in texts if squeezed(each) not in text and squeezed(each) != "2026-17"] == []
