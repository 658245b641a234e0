"""Names that steer a terminal or that XML cannot hold: every part that a run writes is well-formed and shows them."""

from __future__ import annotations

import json
import re
import zipfile
from xml.etree import ElementTree

import openpyxl
import pytest
from fewer_sheets import keep_few_trials, leave_out_fits
from openpyxl.workbook.defined_name import DefinedName

pytestmark = pytest.mark.usefixtures("short_books")

RAW = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069\ufffe\uffff]")
# openpyxl writes `_x001B_` as it stands, which is how Excel writes the character.
MARKS = '_x001B_[2J_x0007_\x9b\u202e_xFFFF_<&">'


@pytest.fixture
def hostile(plain_book):
    """Names, units and reasons end in marks."""
    book = openpyxl.load_workbook(plain_book)
    for sheet in (book["Inputs"], book["Wanted"]):
        for row in sheet.iter_rows():
            for cell in row:
                if isinstance(cell.value, str) and cell.value in (
                    "a",
                    "b",
                    "c",
                    "mph",
                    "Speed",
                    "Double",
                    "fast",
                    "seen",
                ):
                    cell.value += MARKS
    book.save(plain_book)
    return plain_book


def test_every_part_is_well_formed_and_no_control_is_raw(xlmc, whole_book, hostile, tmp_path, monkeypatch):
    """All the sheets, with few of their many rows of numbers."""
    keep_few_trials(monkeypatch)
    leave_out_fits(monkeypatch)
    outputs = ("-o", "r.xlsx", "--html", "p.html", "--json", "j.json", "--extract", "t.csv", "--save-run", "s.xlmcrun")
    outcome = xlmc("simulate", hostile, *outputs)
    assert outcome.code == 0, outcome.err
    assert "\\x1b[2J\\x07\\x9b\\u202e\\uffff" in outcome.out
    assert not RAW.search(outcome.out + outcome.err)
    with zipfile.ZipFile(tmp_path / "r.xlsx") as package:
        for name in package.namelist():
            if name.endswith((".xml", ".rels", ".vml")):
                ElementTree.fromstring(package.read(name))
    for name in ("p.html", "t.csv"):
        assert not RAW.search((tmp_path / name).read_text(encoding="utf-8-sig")), name
    assert not RAW.search(
        json.dumps(json.loads((tmp_path / "j.json").read_text(encoding="utf-8"))["forecasts"], ensure_ascii=False)
    )
    assert xlmc("replay", "s.xlmcrun").code == 0


@pytest.fixture
def with_headings(plain_book, tmp_path):
    """A book with a column, now of notes, whose heading steers a terminal, and with such a defined name."""

    def made(name):
        book = openpyxl.load_workbook(plain_book)
        book.defined_names["Sum"] = DefinedName("Sum", attr_text="Model!$A$1")
        book.save(plain_book)
        with zipfile.ZipFile(plain_book) as old, zipfile.ZipFile(tmp_path / name, "w") as new:
            for part in old.namelist():
                data = old.read(part)
                if part == "xl/workbook.xml":
                    data = data.replace(b"<definedName name=", b'<definedName comment="_x001B_[2J" name=')
                new.writestr(part, data.replace(b"Distribution", b"Distribution_x001B_[2J\xe2\x80\xae"))
        return tmp_path / name

    return made


def test_headings_and_file_names_that_steer_a_terminal_are_escaped(xlmc, with_headings, tmp_path):
    book = with_headings("ca\x1b[2Jse\x07.xlsx")
    outputs = ("-o", "r.xlsx", "--html", "p.html", "--json", "j.json")
    outcome = xlmc("simulate", book.name, "-n", 2_000, *outputs)
    assert outcome.code == 0, outcome.err
    for done in (outcome, xlmc("check", book.name), xlmc("replay", "r.xlsx")):
        assert done.code == 0, done.err
        assert not RAW.search(done.out + done.err)
    with zipfile.ZipFile(tmp_path / "r.xlsx") as package:
        for name in package.namelist():
            if name.endswith((".xml", ".rels", ".vml")):
                ElementTree.fromstring(package.read(name))
    assert not RAW.search((tmp_path / "p.html").read_text(encoding="utf-8"))
    written = json.loads((tmp_path / "j.json").read_text(encoding="utf-8"))
    for exact in ("cells", "structure"):  # what the run was made from, to the letter: a replay compares it
        del written["record"][exact]
    assert not RAW.search(json.dumps(written, ensure_ascii=False))
    assert "Distribution\\x1b[2J" in json.dumps(written, ensure_ascii=False).replace("\\\\", "\\")


def test_the_book_that_is_not_there_is_named_without_steering(xlmc):
    outcome = xlmc("simulate", "no\x1b[2Jbook.xlsx")
    assert outcome.code == 2
    assert "no\\x1b[2Jbook.xlsx" in outcome.err
    assert not RAW.search(outcome.out + outcome.err)


@pytest.mark.parametrize("mark", ["&#x9B;", "&#x202E;", "_x001B_"])
def test_a_sheet_whose_name_steers_a_terminal_is_escaped_or_refused_with_its_name(xlmc, case_study, tmp_path, mark):
    with zipfile.ZipFile(case_study) as old, zipfile.ZipFile(tmp_path / "case.xlsx", "w") as new:
        for part in old.namelist():
            data = old.read(part)
            if part == "xl/workbook.xml":
                data = data.replace(b'name="Guide"', f'name="Gui{mark}de"'.encode())
            new.writestr(part, data)
    outcome = xlmc("simulate", "case.xlsx", "-n", 2_000, "-o", "r.xlsx")
    assert outcome.code in (0, 2)
    assert not RAW.search(outcome.out + outcome.err)
    assert (tmp_path / "r.xlsx").exists() == (outcome.code == 0)


def test_forecast_names_are_escaped_in_json_keys_and_headings_of_extracts(xlmc, hostile, tmp_path):
    outputs = ("-o", "r.xlsx", "--json", "j.json", "--extract", "t.csv")
    assert xlmc("simulate", hostile, *outputs).code == 0

    def keys(value):
        if isinstance(value, dict):
            yield from value
            for each in value.values():
                yield from keys(each)
        elif isinstance(value, list):
            for each in value:
                yield from keys(each)

    written = json.loads((tmp_path / "j.json").read_text(encoding="utf-8"))
    assert not [key for key in keys(written) if RAW.search(key)]
    head = (tmp_path / "t.csv").read_text(encoding="utf-8-sig").splitlines()[0]
    assert "\\x1b[2J\\x07" in head
    assert not RAW.search(head)
    assert xlmc("replay", "r.xlsx").code == 0
