from __future__ import annotations

import json

import openpyxl
import pytest


@pytest.fixture
def spoiled(case_study, tmp_path):
    """The case study with one saved value that its formula does not give."""
    import zipfile

    target = tmp_path / "spoiled.xlsx"
    with zipfile.ZipFile(case_study) as source, zipfile.ZipFile(target, "w") as copy:
        for name in source.namelist():
            data = source.read(name)
            if name == "xl/worksheets/sheet2.xml":
                start = data.index(b'<c r="D54"')
                value = data.index(b"<v>", start) + 3
                end = data.index(b"</v>", value)
                data = data[:value] + b"99" + data[end:]
            copy.writestr(name, data)
    return target


def test_every_needed_cell_matches(xlmc, case_study):
    outcome = xlmc("verify", case_study)
    assert outcome.code == 0
    assert "42 formula cells: 42 matched." in outcome.out


def test_all_cells(xlmc, case_study):
    outcome = xlmc("verify", case_study, "--all")
    assert outcome.code == 0
    assert "287 formula cells: 287 matched." in outcome.out


def test_a_cell_that_differs_is_shown_and_is_exit_code_1(xlmc, spoiled):
    outcome = xlmc("verify", spoiled)
    assert outcome.code == 1
    assert "1 differing" in outcome.out
    assert "Model!D54" in outcome.out
    assert " 99 " in outcome.out


def test_json(xlmc, spoiled):
    outcome = xlmc("verify", spoiled, "--json")
    result = json.loads(outcome.out)
    assert outcome.code == 1
    assert result["differing"] == 1
    (cell,) = result["cells"]
    assert cell["cell"] == "Model!D54"
    assert cell["expected"] == 99
    assert cell["relative_difference"] == pytest.approx(1 - cell["got"] / 99)


def test_what_is_unsupported_is_named_with_its_cell(xlmc, tmp_path):
    book = openpyxl.Workbook()
    book.active["A1"] = "=NOSUCHFUNCTION(1)"
    book.save(tmp_path / "book.xlsx")
    outcome = xlmc("verify", tmp_path / "book.xlsx", "--all")
    assert outcome.code == 0
    assert "1 unsupported" in outcome.out
    assert "NOSUCHFUNCTION is not known to xlmc (Sheet!A1)" in outcome.out


def test_cells_without_saved_values_are_told_with_the_cure(xlmc, tmp_path):
    book = openpyxl.Workbook()
    book.active["A1"] = "=1+1"
    book.save(tmp_path / "book.xlsx")
    words = " ".join(xlmc("verify", tmp_path / "book.xlsx", "--all").out.split())
    assert "1 formula cell: 1 not cached. 1 cell cannot be compared, because no value is saved there. Save" in words


def test_a_workbook_without_definitions_needs_all(xlmc, tmp_path):
    openpyxl.Workbook().save(tmp_path / "plain.xlsx")
    outcome = xlmc("verify", tmp_path / "plain.xlsx")
    assert outcome.code == 2
    assert "--all" in outcome.err


def test_files_say_what_the_terminal_says(xlmc, spoiled, tmp_path):
    sheet, page = tmp_path / "found.xlsx", tmp_path / "found.html"
    outcome = xlmc("verify", spoiled, "-o", sheet, "--html", page)
    assert outcome.code == 1
    assert outcome.out.count("Written: ") == 2
    cells = [cell for row in openpyxl.load_workbook(sheet).active.iter_rows(values_only=True) for cell in row]
    assert "42 formula cells: 41 matched, 1 differing." in cells
    assert "Model!D54" in cells
    assert "Model!D54" in page.read_text(encoding="utf-8")


def test_a_file_that_is_the_workbook_is_refused(xlmc, case_study):
    outcome = xlmc("verify", case_study, "-o", case_study)
    assert outcome.code == 2
    assert "This is the file that is read" in outcome.err
