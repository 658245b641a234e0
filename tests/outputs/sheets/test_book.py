from __future__ import annotations

import io
import math
import re
import subprocess
import sys
import zipfile
from xml.etree import ElementTree

import openpyxl
import pytest
from openpyxl.worksheet.table import Table
from packed_sheets import packed_sheets
from simulated import simulated

from xlmc.montecarlo.columns import column_store, on_disk
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.document.sections import in_order
from xlmc.outputs.sheets.book import SHEETS, build_sheets

OF_SOME = ("Evidence results", "Scenarios")  # which these books do not have
NAMES = [name for name in in_order("sheets", {sheet.name: sheet for sheet in SHEETS}, {}) if name not in OF_SOME]
RUNS = ["run", "none_accepted", "one_accepted"]


@pytest.fixture(scope="module")
def books(request, package_of, book):
    """Name of each of `RUNS` -> its result sheets."""
    other = {name: package_of(request.getfixturevalue(name)) for name in RUNS if name != "run"}
    return {"run": book} | {name: openpyxl.load_workbook(io.BytesIO(data)) for name, data in other.items()}


@pytest.mark.parametrize("name", RUNS)
def test_the_answer_comes_first_and_every_sheet_is_there(books, name):
    expected = NAMES if name == "run" else [sheet for sheet in NAMES if sheet != "Filter limits"]  # none to move
    assert books[name].sheetnames == expected
    assert expected[0] == "Results"


@pytest.mark.parametrize("name", RUNS[1:])
def test_the_same_run_gives_the_same_bytes(request, package_of, name):
    run = request.getfixturevalue(name)
    assert packed_sheets(run) == package_of(run)


def test_another_run_threads_and_results_on_disk_do_not_change_a_byte(run, package_of, monkeypatch):
    monkeypatch.setattr(column_store, "IN_MEMORY", 0)
    again = simulated(run.model, jobs=2)
    assert on_disk(again.trial_index)
    assert packed_sheets(again) == package_of(run)


def test_draws_that_were_not_kept_are_told(run, opened, rows_of):
    again = simulated(run.model, keep_inputs=100)
    book = opened(again, "Assumptions", "Curves", "Trials", "Record")
    messages = [str(row[0]) for row in rows_of(book["Assumptions"]) if row]
    assert f"Accepted: the first 100 of {again.accepted:,} accepted trials." in messages
    assert f"Only the first 100 of {again.accepted:,} accepted trials stand here." in str(rows_of(book["Trials"]))
    assert ["counts.inputs_kept", "Accepted trials whose draws are kept", 100] in rows_of(book["Record"])


@pytest.mark.parametrize("name", RUNS)
def test_only_certainty_has_formulas_and_every_number_is_finite(books, name):
    for sheet in books[name]:
        for row in sheet.iter_rows():
            for cell in row:
                assert cell.data_type in ("s", "n", "b") or (cell.data_type == "f" and sheet.title == "Certainty")
                if cell.data_type == "n" and cell.value is not None:
                    assert math.isfinite(cell.value)


@pytest.mark.parametrize("name", RUNS)
def test_parts_hold_no_clock_and_nothing_that_cannot_be_injected(request, package_of, name):
    with zipfile.ZipFile(io.BytesIO(package_of(request.getfixturevalue(name)))) as package:
        workbook = package.read("xl/workbook.xml").decode()
        core = package.read("docProps/core.xml").decode()
    assert "2000-01-01T00:00:00Z" in core
    assert re.findall("<definedName (?!.*localSheetId)", workbook) == []


def test_every_sheet_is_set_up_for_printing(book):
    for sheet in book:
        assert sheet.sheet_properties.pageSetUpPr.fitToPage
        assert sheet.oddFooter.left.text == "book.xlsx"
        assert "Page" in sheet.oddFooter.right.text
        assert not sheet.sheet_view.showGridLines


def test_odd_names_do_no_harm(make):
    numbered = list(enumerate(["=1+1", "a'b\"c<d>&[e]:/\\?*", "ü" * 400, "\n\tx_x000D_y"], 1))
    cells = {}
    for n, _ in numbered:
        cells |= {f"A{n}": 0.5, f"B{n}": f"=A{n}*2", f"C{n}": f"=A{n}"}
    run = make.simulate(
        cells,
        [make.uniform(name, f"A{n}", 0.0, 1.0, base=0.5, units=name[:9], source=name) for n, name in numbered],
        [make.forecast(name, f"B{n}", units=name[:9], threshold=1.0) for n, name in numbered],
        [make.filter(name, f"C{n}", at_most=0.9, because=name) for n, name in numbered],
        trials=200,
    )
    packed = io.BytesIO(packed_sheets(run))
    with zipfile.ZipFile(packed) as package:
        for part in package.namelist():
            ElementTree.fromstring(package.read(part))
    book = openpyxl.load_workbook(packed, read_only=True)
    assert book.sheetnames == NAMES
    names = {row[0].value for row in book["Results"].iter_rows(max_col=1)}
    assert {"=1+1", "a'b\"c<d>&[e]:/\\?*", "ü" * 400} <= names


def test_the_library_that_writes_is_imported_only_when_something_is_written():
    """Nor is the page, or a library that draws, which documents never import."""
    code = (
        "import sys, xlmc.outputs.summary, xlmc.outputs, xlmc.cli.simulate\n"
        "early = any(name in sys.modules for name in ('xlsxwriter', 'xlmc.outputs.page', 'matplotlib'))\n"
        "import xlmc.outputs.document.build, xlmc.outputs.document.report_file, xlmc.outputs.document.typst_writer\n"
        "sys.exit(early or 'matplotlib' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.mark.parametrize(
    ("typed", "absent"),
    [
        (["--version"], ("numpy", "xlmc.cli.simulate", "xlmc.engine")),
        (
            ["check"],
            ("scipy", "xlsxwriter", "rich", "distributed", "xlmc.outputs.sheets.book", "xlmc.montecarlo.simulation"),
        ),
    ],
    ids=["version", "check"],
)
def test_a_command_imports_what_it_needs(small_book, typed, absent):
    code = (
        "import sys\nfrom xlmc.cli import main\n"
        f"sys.argv = ['xlmc', *{typed}, *([{str(small_book)!r}] if 'check' in {typed} else [])]\n"
        "try:\n    main()\nexcept SystemExit as end:\n    assert not end.code, end.code\n"
        f"print('loaded:', [name for name in {absent} if name in sys.modules])"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, encoding="utf-8")
    assert result.stdout.splitlines()[-1] == "loaded: []", result.stderr


def test_the_case_stands_on_top_of_every_printed_page(small_book, tmp_path):
    book = openpyxl.load_workbook(small_book)
    sheet = book.create_sheet("Case")
    for row in (("Field", "Text"), ("Case number", "2026-17 & 18"), ("Analyst", "J. Doe"), ("Client", "A. B.")):
        sheet.append(row)
    sheet.add_table(Table(displayName="xlmc_case", ref="A1:B4"))
    book.save(tmp_path / "book.xlsx")
    run = simulated(load(tmp_path / "book.xlsx"), trials=300)
    sheets = [part for name, part in build_sheets(run).items() if name.startswith("xl/worksheets/sheet")]
    heads = [re.findall(rb"<oddHeader>(.*?)</oddHeader>", sheet) for sheet in sheets]
    assert heads == [[b"&amp;R2026-17 &amp;&amp; 18, J. Doe"]] * len(NAMES)
