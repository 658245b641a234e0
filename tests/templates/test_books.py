"""Committed workbooks. What the script writes alike into all of them is looked at in one edition of each."""

from __future__ import annotations

import math
import re
import zipfile
from datetime import datetime

import pytest
from committed_books import BOOKS, EXAMPLES, TEMPLATES
from openpyxl.utils.datetime import to_excel
from recalculated_books import RECALCULATED
from simulated import simulated
from xlsxwriter.workbook import Workbook

from templates.vehicles import label_formula, name_cell, names_a_vehicle
from templates.writer import book, write_book
from templates.writer.cached import computed
from xlmc.errors import ErrorCode

REFERENCE = re.compile(r"=Model!D\d+")
LIKE_A_CELL = re.compile(r"[A-Z]{1,3}\d+|R\d*(C\d*)?|C\d*", re.IGNORECASE)
ROUND_OFF = 1e-12
"""Of a difference of numbers near 1 to 100 that comes out as 0 or almost; LibreOffice makes some of them 0."""
NUMBER = re.compile(rb"(?<=<v>)[^<]*(?=</v>)|(?<=<c:v>)[^<]*(?=</c:v>)")

TABLES = {
    "xlmc_assumptions": (
        "Inputs",
        [
            "Name",
            "Symbol",
            "Cell name",
            "Value",
            "Units",
            "Distribution",
            "Low",
            "High",
            "Likeliest",
            "Low likeliest",
            "High likeliest",
            "Mean",
            "Std dev",
            "Lower cutoff",
            "Upper cutoff",
            "Frozen",
            "Source",
        ],
    ),
    "xlmc_forecasts": ("Results wanted", ["Name", "Cell", "Units", "Range %", "Threshold", "Symbol", "Note"]),
    "xlmc_filters": ("Results wanted", ["Name", "Cell", "At least", "At most", "Above", "Below", "Because"]),
    "xlmc_checks": ("Results wanted", ["Name", "Cell", "Because"]),
    "xlmc_correlations": ("Results wanted", ["First", "Second", "Correlation"]),
    "xlmc_settings": ("Results wanted", ["Setting", "Value"]),
}
MORE = {"xlmc_forecasts": ["Only if"], "xlmc_filters": ["Only for"]}
"""Where a filter is about one forecast."""


def formula_cells(book):
    return {
        (sheet.title, cell.coordinate): cell.value
        for sheet in book
        for row in sheet.iter_rows()
        for cell in row
        if isinstance(cell.value, str) and cell.value.startswith("=")
    }


def rows(book, table):
    sheet = book[TABLES[table][0]]
    header, *body = sheet[sheet.tables[table].ref]
    return [dict(zip([cell.value for cell in header], row, strict=True)) for row in body]


@pytest.mark.parametrize("name", RECALCULATED)
def test_cached_values_are_what_libreoffice_computes(name, read, recalculated):
    """They are also what xlmc computes in every cell of every book; see `test_cached_values_are_what_xlmc_computes`.

    But for a 0 of LibreOffice that is none in Excel: it makes 0 of every sum that cancels, in brackets, too.
    """
    result = 0
    for sheet in read(name).sheets.values():
        computed = recalculated(name, sheet.name)
        for at, content in sheet.cells.items():
            if content.formula is not None:
                result += 1
                shown, truth = content.value, computed.get(at, "")
                if isinstance(shown, int | float) and not isinstance(shown, bool):
                    assert isinstance(truth, float), (sheet.name, at, truth)
                    assert math.isclose(shown, truth, rel_tol=1e-12, abs_tol=ROUND_OFF), (sheet.name, at)
                else:
                    assert shown == truth, (sheet.name, at)
                    assert type(shown) is type(truth), (sheet.name, at)
    assert result > 15


@pytest.mark.parametrize("name", RECALCULATED)
def test_tables_stand_where_they_belong(name, book_path, described, opened):
    book = opened(book_path[name])
    one_forecast = any(row.only_for for row in described[name].filters)
    for table, (sheet, headers) in TABLES.items():
        if table == "xlmc_assumptions":
            headers = [*headers[:6], *described[name].columns, *headers[-2:]]
        if one_forecast:
            headers = [*headers, *MORE.get(table, ())]
        headers = [*headers, *(["Report to", "Kind", "Role"] if table == "xlmc_forecasts" else [])]
        assert [column.name for column in book[sheet].tables[table].tableColumns] == headers
        assert list(rows(book, table)[0]) == headers


@pytest.mark.parametrize("name", RECALCULATED)
def test_every_quantity_is_a_named_cell(name, book_path, described, opened):
    book = opened(book_path[name])
    template = described[name]
    symbols = {quantity.symbol for quantity in (*template.inputs, *template.equations)}
    names = [name_cell(j, template.named) for j, _ in enumerate(template.vehicles, 1)]
    readings = {row.named for row in template.evidence if row.named}
    readings |= {each.symbol for each in template.read}
    readings |= {each.name for each in template.data}
    assert set(book.defined_names) == symbols | readings | {*names}
    for name, called in zip(names, template.vehicles, strict=True):
        [(sheet, place)] = book.defined_names[name].destinations
        assert book[sheet][place].value == called
    for given in template.inputs:
        [(sheet, place)] = book.defined_names[given.symbol].destinations
        value = book[sheet][place].value
        assert (to_excel(value) if isinstance(value, datetime) else value) == given.base
    for equation in template.equations:
        [(sheet, place)] = book.defined_names[equation.symbol].destinations
        assert book[sheet][place].value == f"={equation.formula}"


@pytest.mark.parametrize("name", RECALCULATED)
def test_forecasts_and_filters_point_at_their_cells(name, book_path, described, opened):
    book, template = opened(book_path[name]), described[name]
    for table, described_rows in (("xlmc_forecasts", template.forecasts), ("xlmc_filters", template.filters)):
        for row, wanted in zip(rows(book, table) if described_rows else (), described_rows, strict=True):
            named = names_a_vehicle(wanted.name)
            assert row["Name"].value == (f"={label_formula(wanted.name)}" if named else wanted.name)
            assert REFERENCE.fullmatch(row["Cell"].value)
            [(_, place)] = book.defined_names[wanted.symbol].destinations
            assert row["Cell"].value == f"=Model!{place.replace('$', '')}"


def test_the_case_study_says_what_the_paper_says(book_path, opened, model_of):
    book = opened(book_path["intersection"])
    assumptions = rows(book, "xlmc_assumptions")
    assert len(assumptions) == 17
    assert {row["Distribution"].value for row in assumptions} == {"Uniform"}
    assert all(row["Value"].value == (row["Low"].value + row["High"].value) / 2 for row in assumptions)
    assert all(row["Source"].value for row in assumptions)
    headers = ("At least", "At most", "Above", "Below")
    limits = [[row[header].value for header in headers] for row in rows(book, "xlmc_filters")]
    assert limits == [[0, None, None, 1], [0, 0.25, None, None], [None, None, 0, None]]
    assert [forecast.name for forecast in model_of("intersection").forecasts] == [
        "Chevrolet delta-V",
        "Nissan delta-V",
        "Chevrolet impact speed",
        "Nissan impact speed",
    ]
    settings = [(row["Setting"].value, row["Value"].value) for row in rows(book, "xlmc_settings")]
    assert settings == [("Trials", 200_000), ("Seed", 999)]
    assert [cell.value for cell in rows(book, "xlmc_correlations")[0].values()] == [None, None, None]


@pytest.mark.parametrize("name", RECALCULATED)
def test_assumption_cells_are_green_and_forecast_cells_blue(name, book_path, described, opened):
    book = opened(book_path[name])
    colours = {}
    for kind, symbols in (
        ("green", [given.symbol for given in described[name].assumptions]),
        ("blue", [row.symbol for row in described[name].forecasts]),
        ("yellow", [given.symbol for given in described[name].constants]),
    ):
        places = [next(iter(book.defined_names[symbol].destinations)) for symbol in symbols]
        colours[kind] = {book[sheet][place].fill.fgColor.rgb for sheet, place in places}
    assert colours == {"green": {"FFC6E7B5"}, "blue": {"FFBBDDF7"}, "yellow": {"FFFFF2C2"}}


@pytest.mark.parametrize("name", RECALCULATED)
def test_formulas_are_guarded_and_inputs_are_open(name, book_path, described, opened):
    """A formula is locked, or Excel asks before it is typed over; no input is locked; there is no password."""
    book = opened(book_path[name])
    asked = {
        (sheet.title, cell)
        for sheet in book
        for rule in sheet.data_validations.dataValidation
        if rule.type == "custom" and rule.formula1 == "FALSE"
        for cells in rule.sqref.ranges
        for row in sheet[cells.coord if ":" in cells.coord else f"{cells.coord}:{cells.coord}"]
        for cell in (cell.coordinate for cell in row)
    }
    for sheet, place in formula_cells(book):
        protected = book[sheet].protection.sheet and book[sheet][place].protection.locked
        assert protected or (sheet, place) in asked, (sheet, place)
    assert all(sheet.protection.password is None for sheet in book)
    for given in described[name].inputs:
        [(sheet, place)] = book.defined_names[given.symbol].destinations
        assert not book[sheet][place].protection.locked
        assert not book[sheet].protection.sheet


@pytest.mark.parametrize("name", BOOKS)
def test_names_are_names_to_excel(name, described):
    """It takes e and E for one name, and R2C3, R or AB12 for cells."""
    symbols = [quantity.symbol for quantity in (*described[name].inputs, *described[name].equations)]
    assert len({symbol.casefold() for symbol in symbols}) == len(symbols)
    assert not [symbol for symbol in symbols if LIKE_A_CELL.fullmatch(symbol)]


@pytest.mark.parametrize("name", TEMPLATES)
def test_every_default_has_a_source_and_every_filter_a_reason(name, described):
    template = described[name]
    assert all(given.source for given in template.inputs)
    assert all(given.parameters for given in template.assumptions)
    assert all(row.because for row in template.filters)
    assert template.question.endswith("?")
    assert template.needs


@pytest.mark.parametrize("name", [name for name in TEMPLATES if name not in RECALCULATED])
def test_the_other_edition_runs_and_keeps_trials(name, model_of):
    """Its ranges and limits are typed by hand for its units. Of planar impact some 1 in 90 trials is kept."""
    model = model_of(name)
    assert not model.definitions.problems
    assert simulated(model, 4_000).accepted > 20


@pytest.mark.parametrize("name", TEMPLATES)
def test_the_empty_template_shows_a_possible_case(name, described, shown):
    template, base = described[name], shown(name)
    assert base["checks_hold"] is True
    for row in (each for each in template.filters if not each.only_for):
        value = base[row.symbol]
        assert row.at_least is None or value >= row.at_least
        assert row.at_most is None or value <= row.at_most
        assert row.above is None or value > row.above
        assert row.below is None or value < row.below


@pytest.mark.parametrize("name", BOOKS)
def test_cached_values_are_what_xlmc_computes(name, read):
    """To 1e-12, since the last digit of a sine depends on the processor."""
    result = computed(read(name))
    cached = cached_values(read(name))
    assert result.keys() == cached.keys()
    for place, value in result.items():
        if isinstance(value, int | float) and not isinstance(value, bool):
            assert value == pytest.approx(cached[place], rel=1e-12, abs=ROUND_OFF), place
        else:
            assert (type(value), value) == (type(cached[place]), cached[place]), place


def cached_values(book):
    """(sheet, row, column), counted from 0 -> the value that a formula cell of a committed workbook shows."""
    return {
        (sheet.name, row - 1, column - 1): content.value.text if isinstance(content.value, ErrorCode) else content.value
        for sheet in book.sheets.values()
        for (row, column), content in sheet.cells.items()
        if content.formula is not None
    }


def test_every_committed_book_has_a_script(described):
    assert described.keys() == BOOKS.keys()


@pytest.mark.parametrize("name", BOOKS)
def test_the_committed_book_is_what_the_script_writes(name, book_path, described, read, tmp_path_factory):
    """With the values that its cells show; the test above says that they are those that the script computes."""
    path = tmp_path_factory.mktemp("written") / f"{name}.xlsx"
    with pytest.MonkeyPatch.context() as patch:  # XlsxWriter otherwise writes each part to a file first
        patch.setattr(book, "Workbook", lambda target, given: Workbook(target, given | {"in_memory": True}))
        write_book(described[name], path, cached_values(read(name)))
    expect_same_parts(book_path[name], path)


@pytest.mark.parametrize(
    ("folder", "first", "books"),
    [("templates", "critical-speed-yaw-si", TEMPLATES), ("examples", "yaw-mark", EXAMPLES)],
)
def test_the_script_builds_each_book_from_what_it_says(folder, first, books, builders, described, tmp_path_factory):
    """One of them is written as it is for a person: with the values that the script computes."""
    message = {}

    def write(template, path):
        message[path.stem] = template
        if path.stem == first:
            write_book(template, path)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(builders[folder], "write_book", write)
        paths = builders[folder].build(tmp_path_factory.mktemp(folder))
    assert [path.stem for path in paths] == list(message)
    assert message == {name: described[name] for name in books}
    (path,) = (path for path in paths if path.stem == first)
    expect_same_parts(books[first], path)


def expect_same_parts(one, other):
    """Part by part; cached numbers to 1e-12, since the last digit of a sine depends on the processor."""
    with zipfile.ZipFile(one) as committed, zipfile.ZipFile(other) as fresh:
        assert committed.namelist() == fresh.namelist()
        for part in committed.namelist():
            old, new = committed.read(part), fresh.read(part)
            if old != new and part.startswith(("xl/worksheets/sheet", "xl/charts/chart")):
                assert [float(x) for x in NUMBER.findall(old) if is_number(x)] == pytest.approx(
                    [float(x) for x in NUMBER.findall(new) if is_number(x)], rel=1e-12, abs=ROUND_OFF
                )
                old, new = NUMBER.sub(b"", old), NUMBER.sub(b"", new)
            assert old == new, part


def is_number(cached):
    try:
        float(cached)
    except ValueError:
        return False
    return True
