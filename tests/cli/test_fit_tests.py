"""`xlmc fit --tests`: crash tests come from a file into the sheet Stiffness, in its units, and nothing else changes."""

from __future__ import annotations

import shutil
import zipfile

import openpyxl
import pytest
from click.testing import CliRunner
from committed_books import TEMPLATES

from xlmc import engine, excel
from xlmc.cli import xlmc

TESTS = """Test;Mass (kg);Vehicle speed (km/h);C1 (mm);C2 (mm);C3 (mm);C4 (mm);C5 (mm);C6 (mm);Crush width (mm)
4241;1650;56.3;420;500;540;540;500;420;1600
4250;1662;56.5;400;490;520;530;500;410;1600
4300;1640;40.2;250;300;330;330;300;250;1590
"""
ROWS = [[float(item) for item in line.split(";")] for line in TESTS.splitlines()[1:]]


@pytest.fixture
def case(tmp_path):
    """`case(name)`: a copy of the template."""
    return lambda name: shutil.copy(TEMPLATES[name], tmp_path / "case.xlsx")


def run(*arguments):
    return CliRunner().invoke(xlmc, ["fit", *map(str, arguments)])


def entered(path):
    """Rows of the sheet Stiffness that hold tests, columns A to K."""
    rows = excel.load(path).sheets["Stiffness"].cells
    return [[rows[row, column].value for column in range(1, 12)] for row in range(6, 22) if (row, 3) in rows]


@pytest.mark.parametrize(
    ("name", "per_kg", "per_kmh", "per_mm"),
    [("crush-energy", 1 / 0.45359237, 1 / 1.609344, 1 / 25.4), ("crush-energy-si", 1.0, 1.0, 0.1)],
)
def test_rows_stand_in_the_units_of_the_sheet(name, per_kg, per_kmh, per_mm, case, tmp_path):
    path, source = case(name), tmp_path / "tests.csv"
    source.write_text(TESTS, encoding="utf-8")
    done = run(source, "--tests", 2, "--into", path)
    assert done.exit_code == 0, done.output
    result = [row for row in entered(path) if row[2] is not None]
    assert [row[:2] for row in result] == [[f"tests.csv: {number}", 2] for number in (4241, 4250, 4300)]
    for row, given in zip(result, ROWS, strict=True):
        scales = [per_kg, per_kmh, *[per_mm] * 7]
        assert row[2:] == pytest.approx([scale * value for scale, value in zip(scales, given[1:], strict=True)])
    shown = engine.calculate(excel.load(path))
    assert shown["tests_2"] == 3
    assert shown["b1_sd_2"] > 0
    assert f"{shown['b1_tests_2']:.6g}" in done.output
    again = run(source, "--tests", 1, "--into", path)
    assert again.exit_code == 0
    assert engine.calculate(excel.load(path))["tests_2"] == 3
    assert len([row for row in entered(path) if row[2] is not None]) == 6


def test_nothing_else_changes_and_a_range_does_as_well(case, tmp_path):
    path, source = case("crush-energy-si"), tmp_path / "tests.xlsx"
    book = openpyxl.Workbook()
    for row in (TESTS.splitlines()[0].replace("mm", "cm").split(";"), *ROWS):
        book.active.append(row)
    book.save(source)
    before = {name: zipfile.ZipFile(path).read(name) for name in zipfile.ZipFile(path).namelist()}
    done = run(f"{source}!A1:J4", "--tests", 1, "--into", path)
    assert done.exit_code == 0, done.output
    after = {name: zipfile.ZipFile(path).read(name) for name in zipfile.ZipFile(path).namelist()}
    assert len([name for name in before if after[name] != before[name]]) == 1
    assert entered(path)[0][4] == 420


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda text: text.replace("500;540", "500;", 1), "row 2: c3 is"),
        (lambda text: text.replace("1662", "heavy"), "row 3: weight is 'heavy'"),
        (lambda text: text.replace("Crush width", "Remark"), "no column for width"),
        (lambda text: text.replace("km/h", "furlongs"), "furlongs, which is not converted"),
        (lambda text: text.splitlines()[0], "holds no crash tests"),
        (lambda text: text + text.splitlines()[1] * 0 + "\n".join([text.splitlines()[1]] * 20), "room for 16 more"),
    ],
)
def test_what_is_no_test_is_refused_and_nothing_is_written(spoil, message, case, tmp_path):
    path, source = case("crush-energy"), tmp_path / "tests.csv"
    source.write_text(spoil(TESTS), encoding="utf-8")
    before = path.read_bytes()
    done = run(source, "--tests", 1, "--into", path)
    assert done.exit_code
    assert message in (done.output + str(done.exception))
    assert path.read_bytes() == before


def test_it_needs_a_workbook_with_the_sheet(case, tmp_path):
    source = tmp_path / "tests.csv"
    source.write_text(TESTS, encoding="utf-8")
    assert "--tests needs --into" in run(source, "--tests", 1).output
    done = run(source, "--tests", 1, "--into", case("skid"))
    assert "no sheet Stiffness" in (done.output + str(done.exception))
