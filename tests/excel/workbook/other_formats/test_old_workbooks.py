"""Old Excel workbooks: what is read of their records, and how it is joined with the cells that LibreOffice converts."""

from __future__ import annotations

import io
import os
import re
import struct
import subprocess
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from click.testing import CliRunner
from crystal_ball_book import Asked, Drawn, read_parts, save, write_parts
from needed_programs import missing
from old_format_book import art, drawing, number, plain_book, record, shape, shapes_of, with_shapes
from simulated import simulated

from xlmc.api import Simulation
from xlmc.cli import xlmc as command
from xlmc.errors import WorkbookError
from xlmc.excel.workbook.hidden_scripts import HiddenScript, hidden_scripts
from xlmc.excel.workbook.other_formats import joined_package, libreoffice
from xlmc.excel.workbook.other_formats.old_workbook import read_old_workbook
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.structure import read_structure
from xlmc.montecarlo.model.loading import load

TEXTS = [("CB_Block_0", "㜸㠰"), ("CB_Block_7.0.0.0:1", "㜸" * 9000), ("CB_Block_7.0.0.0:2", "㜸㐱")]
SHAPES = [shape(*each, n) for n, each in enumerate(TEXTS, 1)]


def short(value, *, hundred=False, whole=False):
    bits = (value & 0x3FFFFFFF) << 2 if whole else struct.unpack("<Q", struct.pack("<d", value))[0] >> 32
    return struct.pack("<I", (bits & 0xFFFFFFFC) | 2 * whole | hundred)


def test_numbers_of_all_kinds_are_read_to_the_last_bit():
    records = (
        number(1, 1, 0.1 + 0.2)
        + record(0x27E, struct.pack("<HHH", 1, 0, 0) + short(-7, whole=True))
        + record(0x27E, struct.pack("<HHH", 2, 0, 0) + short(1234, whole=True, hundred=True))
        + record(0xBD, struct.pack("<HH", 3, 1) + b"".join(b"\0\0" + short(v) for v in (0.5, -2.0)) + b"\2\0")
        + record(0x06, struct.pack("<HHHdHIH", 4, 0, 0, 1 / 3, 0, 0, 0))
        + record(0x06, struct.pack("<HHH8sHIH", 5, 0, 0, b"\0" * 6 + b"\xff\xff", 0, 0, 0))
        + record(0x221, struct.pack("<HHBBHI", 4, 6, 0, 1, 0, 0))
    )
    (sheet,) = read_old_workbook(plain_book({"Käse": records})).sheets
    assert sheet.name == "Käse"
    assert sheet.numbers == {(1, 1): 0.1 + 0.2, (2, 1): -7.0, (3, 1): 12.34, (4, 2): 0.5, (4, 3): -2.0}
    assert sheet.results == {(5, 1): 1 / 3}
    assert sheet.areas == [(5, 1, 7, 2)]


DRAWINGS = {
    "in one record": {},
    "continued": {"size": 1000},
    "beside a comment": {"note": True},
    "continued beside a comment": {"note": True, "size": 700},
    "in a group": {"group": True, "size": 8000},
}


@pytest.mark.parametrize("how", DRAWINGS.values(), ids=list(DRAWINGS))
def test_hidden_texts_are_read_from_drawings(how):
    chart = record(0x809, struct.pack("<HH12x", 0x600, 0x20)) + drawing([shape("Other", "x")]) + record(0x0A)
    result = read_old_workbook(plain_book({"Empty": b"", "S": drawing(SHAPES, **how) + chart}))
    assert [sheet.texts for sheet in result.sheets] == [[], [(*each, "Decisioneering:7.0.0.0") for each in TEXTS]]
    assert not result.macros


def long_property(data):
    """A table whose property claims more than there is."""
    return art(0xF004, art(0xF122, struct.pack("<HI", 0xC38E, 99), instance=1) + data, container=True)


def nested(depth):
    inner = b""
    for _ in range(depth):
        inner = art(0xF003, inner, container=True)
    return inner


REFUSED = {
    "encrypted": (plain_book({"S": b""}, before=record(0x2F, bytes(6))), "The workbook is encrypted"),
    "Excel 95": (
        plain_book({"S": b""}).replace(struct.pack("<HHH", 0x809, 16, 0x600), struct.pack("<HHH", 0x809, 16, 0x500)),
        "Excel 95",
    ),
    "a lost sheet": (
        plain_book({"S": b""}).replace(record(0x809, struct.pack("<HH12x", 0x600, 0x10)), record(1, bytes(16))),
        "the sheet 'S' is missing",
    ),
    "a record cut short": (plain_book({"S": record(0x203, b"\0")}), "damaged"),
    "a drawing cut short": (plain_book({"S": record(0xEC, drawing(SHAPES)[4:400])}), "drawing of the sheet 'S'"),
    "a property too long": (plain_book({"S": drawing([long_property(b"")])}), "longer than its table"),
    "too deep": (plain_book({"S": drawing([nested(40)])}), "nested too deeply"),
    "no workbook": (plain_book({"S": b""}).replace(b"W\0o\0r\0k", b"W\0o\0r\0d"), "not a workbook"),
    "cut short": (plain_book({"S": b""})[:3000], "damaged"),
}  # fmt: skip


@pytest.mark.parametrize(("data", "sentence"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_read_is_refused_before_libreoffice_is_started(data, sentence, monkeypatch):
    monkeypatch.setattr(subprocess, "Popen", None)
    with pytest.raises(WorkbookError) as reported:
        read_workbook(data, "case.xls")
    assert sentence in str(reported.value)
    assert "case.xls" in str(reported.value)
    assert reported.value.hint


def converted(cells, titles=("S",)):
    """What LibreOffice is said to make of a workbook."""
    book, file = openpyxl.Workbook(), io.BytesIO()
    book.remove(book.active)
    for title in titles:
        book.create_sheet(title)
    for address, value in cells.items():
        book[titles[0]][address] = value
    book.save(file)
    return file.getvalue()


def test_digits_and_texts_come_back(monkeypatch):
    exact = {(1, 1): 0.1 + 0.2, (2, 1): 5.464683003382316e-21, (3, 1): 7.0}
    records = b"".join(number(*at, value) for at, value in exact.items())
    records += record(0x06, struct.pack("<HHHdHIH", 3, 0, 0, 2 / 3, 0, 0, 0)) + drawing(SHAPES)
    new = converted({"A1": 0.3, "A2": 5.46468300338232e-21, "A3": 7, "A4": "=A1/A3"})
    monkeypatch.setattr(joined_package, "converted_to_xlsx", lambda *_: new)
    book = read_workbook(plain_book({"S": records}, macros=True), "case.xls")
    cells = book.sheets["S"].cells
    assert {at: cells[at].value for at in exact} == exact
    assert cells[4, 1].value == 2 / 3
    assert cells[4, 1].formula.text == "A1/A3"
    result = list(hidden_scripts(book.parts, read_structure(book.parts)))
    assert result == [HiddenScript("S", *each) for each in TEXTS]
    assert ["converted from an old" in n.message or "macros" in n.message for n in book.notices] == [True, True]


def test_the_results_of_formulas_are_those_that_excel_saved(monkeypatch, tmp_path):
    """LibreOffice does not know the functions of @RISK; an error's code is a whole number, 5 that of #NAME?."""
    path = tmp_path / "converted.xlsx"
    path.write_bytes(converted({"A1": "=RiskNormal(5,1)", "A2": "=2*3"}))
    parts = read_parts(path)
    (sheet,) = (name for name in parts if name.startswith("xl/worksheets/sheet"))
    old = re.compile(rb'<c r="A1"[^>]*><f>RiskNormal\(5,1\)</f>(<v ?/>|<v></v>)</c>')
    parts[sheet] = old.sub(b'<c r="A1" t="e"><f>RiskNormal(5,1)</f><v>#NAME?</v></c>', parts[sheet])
    assert b"#NAME?" in parts[sheet]
    write_parts(path, parts)
    monkeypatch.setattr(joined_package, "converted_to_xlsx", lambda *_: path.read_bytes())
    results = (struct.pack("<HHHdHIH", row, 0, 0, value, 0, 0, 0) for row, value in enumerate((5.0, 6.0)))
    data = plain_book({"S": b"".join(record(0x06, each) for each in results)})
    cells = read_workbook(data, "case.xls").sheets["S"].cells
    assert [cells[row, 1].value for row in (1, 2)] == [5.0, 6.0]
    assert type(cells[1, 1].value) is float


@pytest.mark.parametrize("saved", [True, False], ids=str)
def test_a_logical_that_a_formula_gives_is_one(monkeypatch, tmp_path, saved):
    """LibreOffice writes 1 or 0 for a formula that gives one."""
    path = tmp_path / "converted.xlsx"
    path.write_bytes(converted({"A1": "=2>1", "A2": "=1"}))
    monkeypatch.setattr(joined_package, "converted_to_xlsx", lambda *_: path.read_bytes())
    logical = struct.pack("<HHH8sHIH", 0, 0, 0, bytes([1, 0, saved, 0, 0, 0, 0xFF, 0xFF]), 0, 0, 0)
    number_ = struct.pack("<HHHdHIH", 1, 0, 0, 1.0, 0, 0, 0)
    data = plain_book({"S": record(0x06, logical) + record(0x06, number_)})
    cells = read_workbook(data, "case.xls").sheets["S"].cells
    assert cells[1, 1].value is saved
    assert cells[2, 1].value == 1.0
    assert type(cells[2, 1].value) is float


DIFFERENT = {
    "another number": (
        number(1, 1, 0.3),
        {"A1": 0.4},
        ("S",),
        "S!A1: LibreOffice has made the number 0.4 of the number 0.3",
    ),
    "an error": (number(1, 1, 5.0), {"A1": "#NAME?"}, ("S",), "LibreOffice has made #NAME? of the number 5.0"),
    "no number": (number(1, 1, 0.3), {}, ("S",), "S!A1: LibreOffice has made a blank cell of the number 0.3"),
    "no formula": (
        record(0x06, struct.pack("<HHHdHIH", 0, 0, 0, 2.0, 0, 0, 0)),
        {"A1": 2},
        ("S",),
        "S!A1: LibreOffice has lost the formula",
    ),
    "areas without end": (
        record(0x221, struct.pack("<HHBBHI", 0, 0xFFFF, 0, 0xFF, 0, 0)),
        {},
        ("S",),
        "The array formulas of the sheet 'S' fill too many cells",
    ),
    "no sheet": (b"", {}, ("T",), "lost the sheet 'S'"),
}


@pytest.mark.parametrize(("records", "cells", "titles", "sentence"), DIFFERENT.values(), ids=DIFFERENT)
def test_what_both_read_must_agree(records, cells, titles, sentence, monkeypatch):
    monkeypatch.setattr(joined_package, "converted_to_xlsx", lambda *_: converted(cells, titles))
    with pytest.raises(WorkbookError) as reported:
        read_workbook(plain_book({"S": records}), "case.xls")
    assert sentence in str(reported.value)


def test_without_libreoffice_one_message_says_what_to_do(tmp_path, monkeypatch):
    monkeypatch.setattr(libreoffice, "_ELSEWHERE", ())
    monkeypatch.setenv("PATH", str(tmp_path))
    path = tmp_path / "case.xls"
    path.write_bytes(plain_book({"S": number(1, 1, 1.0)}))
    reported = CliRunner().invoke(command, ["simulate", str(path)])
    message = str(reported.exception)
    assert "LibreOffice is not installed" in message
    assert "Install LibreOffice" in message
    assert "load Crystal Ball first" in message


NO_HELP = {
    "it fails": ("echo one >&2; echo 'cannot be loaded' >&2; exit 1", 600, "could not convert", "(cannot be loaded)"),
    "it says nothing": ("exit 0", 600, "could not convert the old Excel workbook (.xls). Open it", ""),
    "it hangs": ("sleep 600 & wait", 0.2, "has not converted", ""),
}  # fmt: skip


@pytest.mark.skipif(os.name != "posix", reason="a script stands for LibreOffice")
@pytest.mark.parametrize(("script", "seconds", "sentence", "more"), NO_HELP.values(), ids=NO_HELP)
def test_a_libreoffice_that_does_not_help_is_told(script, seconds, sentence, more, tmp_path, monkeypatch):
    program = tmp_path / "soffice"
    program.write_text(f"#!/bin/sh\n{script}\n", "utf-8")
    program.chmod(0o755)
    monkeypatch.setattr(libreoffice, "_program", lambda: str(program))
    monkeypatch.setattr(libreoffice, "_SECONDS", seconds)
    with pytest.raises(WorkbookError) as reported:
        read_workbook(plain_book({"S": b""}), "case.xls")
    assert sentence in str(reported.value)
    assert more in str(reported.value)


WRITTEN = Path(__file__).with_name("written_by_libreoffice.xls")
"""What `soffice --convert-to xls` makes of the workbook of the next test, without what Crystal Ball hides in it."""


@pytest.mark.skipif(bool(missing("soffice")), reason=missing("soffice"))
def test_a_workbook_of_crystal_ball_gives_the_draws_of_its_xlsx(tmp_path):
    skid = Drawn("Other's", "$B$2", "Skid", "Normal", {"Mean": 100.0, "StdDev": 15.0}, named_by="$A$2")
    offset = Drawn("Other's", "$B$3", "Offset", "Normal", {"Mean": 100.0, "StdDev": 15.0}, references={2: "$B$2"})
    keep = {"fFilterPrefs": {"fUseFilter": True, "fFilterMin": 90.0}}
    total = Asked("Other's", "$B$5", "Total", "ft", prefs=keep)
    cells = {"Other's": {"A2": "Skid", "B2": 100, "B3": 100, "B4": 0.1 + 0.2, "B5": "=2*B2-B3+B4"}}
    new, old = tmp_path / "case.xlsx", tmp_path / "case.xls"
    save(new, cells, [[skid, offset], [total]], comments=[("Other's", "B2", "a comment")])
    shapes = shapes_of(read_parts(new), ["CB_DATA_", "Other's"])
    old.write_bytes(with_shapes(WRITTEN.read_bytes(), shapes, size=500))
    before = old.read_bytes()
    expected, model = simulated(load(new), 500), load(old)
    run = simulated(model, 500)
    for column in ("inputs", "forecasts"):
        for name, values in getattr(expected, column).items():
            np.testing.assert_array_equal(getattr(run, column)[name], values)
    assert run.discards == expected.discards
    assert [
        n.message for n in model.notices if "converted from an old Excel workbook (.xls) by LibreOffice" in n.message
    ]
    result = tmp_path / "case-results.xlsx"
    Simulation(run).save(result)
    replayed = CliRunner().invoke(command, ["replay", str(result)])
    assert "identical" in replayed.output, replayed.output
    again = simulated(load(result), 500)  # the results are a workbook of Crystal Ball, too
    np.testing.assert_array_equal(again.forecasts["Total"], expected.forecasts["Total"])
    refused = CliRunner().invoke(command, ["simulate", str(old), "--in-place", "-n", "500"])
    assert "must end in .xlsx" in str(refused.exception)
    assert old.read_bytes() == before


def test_how_excel_calculates_is_told(monkeypatch):
    monkeypatch.setattr(joined_package, "converted_to_xlsx", lambda *_: converted({}))
    data = plain_book({"S": record(0x0D, b"\0\0")}, before=record(0x0E, b"\0\0"))
    notices = [each.message for each in read_workbook(data, "case.xls").notices]
    assert any("precision as displayed" in each for each in notices)
    assert any("Calculation is set to manual" in each for each in notices)


def test_the_records_tell_logicals_from_numbers():
    """An `.xls` says which result is TRUE and which is 1; an `.ods` that LibreOffice reads does not."""
    assert read_old_workbook(plain_book({"S": b""})).tells_logicals
