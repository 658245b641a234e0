"""A converted workbook gives the same accepted trials, and all its old parts are as they were."""

from __future__ import annotations

import re

import numpy as np
import openpyxl
import pytest
from crystal_ball_book import Asked, Decided, Drawn, Tied, read_parts, save, write_parts
from fewer_sheets import keep_sheets
from simulated import simulated

from xlmc.cli import xlmc as command
from xlmc.errors import WorkbookError
from xlmc.excel.workbook.package import read_parts as parts_of
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.conversion.convert import convert

CHANGED = {"[Content_Types].xml", "xl/workbook.xml", "xl/_rels/workbook.xml.rels", "xl/styles.xml", "docProps/app.xml"}

BOOKS = {
    "one call": {"A1": "=RiskNormal(5,1)", "B1": '=RiskOutput("out")+A1'},
    "inside a formula": {"A1": "=10+RiskNormal(5,1)*2", "B1": "=RiskOutput()+A1"},
    "two in a cell": {"A1": "=RiskUniform(0,1)+RiskTriang(0,1,3)", "B1": "=RiskOutput()+A1"},
    "cells for arguments": {"A1": "=RiskNormal(C1,C2)", "C1": 5, "C2": "=C1/10", "B1": "=RiskOutput()+A1"},
    "expressions": {"A1": "=RiskNormal(C1*2-1,ABS(C1))", "C1": 5, "B1": "=RiskOutput()+A1"},
    "a draw in a draw": {"A1": "=RiskNormal(RiskUniform(1,2),RiskUniform(1,2)+1)", "B1": "=RiskOutput()+A1"},
    "draws by draws": {"A1": "=RiskUniform(1,2)", "A2": "=RiskNormal(A1,A1/10)", "B1": "=RiskOutput()+A2"},
    "names and units": {
        "A1": '=RiskNormal(5,1,RiskName("mass"),RiskUnits("kg"),RiskStatic(4))',
        "B1": '=RiskOutput("out",,,RiskUnits("kg"))+A1',
    },
    "cut off and shifted": {
        "A1": "=RiskNormal(5,1,RiskTruncate(4,),RiskShift(2))",
        "A2": "=RiskNormal(5,1,RiskTruncate2(6,9),RiskShift(C1))",
        "A3": "=RiskNormal(5,1,RiskTruncateP(0.1,0.8))",
        "C1": 2,
        "B1": "=RiskOutput()+A1+A2+A3",
    },
    "locked": {"A1": "=RiskNormal(5,1,RiskLock())", "A2": "=RiskUniform(0,1)", "B1": "=RiskOutput()+A1*A2"},
    "a matrix": {
        "A1": "=RiskNormal(0,1,RiskCorrmat($D$1:$F$3,1))",
        "A2": "=RiskUniform(0,1,RiskCorrmat($D$1:$F$3,2))",
        "A3": "=RiskUniform(0,1,RiskCorrmat($D$1:$F$3,3))",
        "D1": 1,
        "D2": 0.5,
        "D3": -0.2,
        "E2": 1,
        "E3": 0,
        "F3": 1,
        "B1": "=RiskOutput()+A1+A2*A3",
    },
    "discrete": {
        "A1": "=RiskDiscrete(D1:D3,E1:E3)",
        "A2": "=RiskDUniform({1,2,5})",
        "D1": 1,
        "D2": 2,
        "D3": "=D2*3",
        "E1": 1,
        "E2": 2,
        "E3": 3,
        "B1": "=RiskOutput()+A1+A2",
    },
    "lists": {
        "A1": "=RiskCumul(0,10,{1,5,9},{0.1,0.5,0.9})",
        "A2": "=RiskHistogrm(0,3,{1,4,2})",
        "A3": "=RiskGeneral(0,3,{1,2},{3,1})",
        "B1": "=RiskOutput()+A1+A2+A3",
    },
    "percentiles": {
        "A1": "=RiskNormalAlt(5%,10,95%,20)",
        "A2": '=RiskTriangAlt("min",0,"m. likely",3,90%,8)',
        "A3": "=RiskUniformAltD(10%,9,90%,1)",
        "B1": "=RiskOutput()+A1+A2+A3",
    },
    "Crystal Ball's functions": {
        "A1": '=CB.Normal(5,1,4,6,"mass")',
        "A2": "=CB.Lognormal(5,1)",
        "A3": "=CB.Custom(D1:E2)",
        "D1": 1,
        "D2": 2,
        "E1": 3,
        "E2": 1,
        "B1": "=RiskOutput()+A1+A2+A3",
    },
    "counts": {
        "A1": "=RiskPoisson(4)+RiskBinomial(5,0.5)",
        "A2": "=RiskGeomet(0.3)+RiskNegbin(3,0.5)",
        "A3": "=CB.YesNo(0.25)+RiskIntUniform(1,6)",
        "B1": "=RiskOutput()+A1+A2+A3",
    },
    "Excel's own": {
        "A1": "=NORM.INV(RAND(),5,1)",
        "A2": "=RAND()*RANDBETWEEN(1,6)",
        "A3": "=-LN(RAND())*3",
        "B1": "=RiskOutput()+A1+A2+A3",
    },
    "results in cells": {"A1": "=RiskNormal(5,1)", "A2": "=A1*2", "B1": "=RiskMean(A2)", "B2": "=B1+1"},
    "a name for a call": {"A1": "=Draw*2", "B1": "=RiskOutput()+A1"},
    "a sheet with an apostrophe": {"A1": "=RiskNormal('It''s'!A1*XLMC!A1,1)", "B1": "=RiskOutput()+A1"},
    "of one name": {
        "A1": '=RiskNormal(5,1,RiskName("x"))',
        "A2": '=RiskNormal(5,1,RiskName("x"))',
        "B1": '=RiskOutput("x")+A1',
        "B2": '=RiskOutput("x")+A2',
    },
    "extremes": {
        "A1": "=RiskExtvalue(1,2)+RiskWeibull(2,3)",
        "A2": "=RiskLognorm(5,1)+RiskExpon(C1)",
        "C1": 3,
        "B1": "=RiskOutput()+A1+A2",
    },
}


def written(path, cells):
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "S"
    for address, value in cells.items():
        sheet[address] = value
    book.create_sheet("It's")["A1"] = 7
    book.create_sheet("XLMC")["A1"] = 3
    if "Draw" in str(cells.get("A1")):
        book.defined_names["Draw"] = openpyxl.workbook.defined_name.DefinedName("Draw", attr_text="RiskNormal(5,1)")
    book.save(path)
    return path


def converts(path, left=()):
    """Convert a book, and hold the new one against it: its file."""
    return converted(path, left)[0]


def converted(path, left=()):
    """Convert a book, and hold the new one against it: its file and its model."""
    model = load(path)
    new = path.with_name("new.xlsx")
    new.unlink(missing_ok=True)
    result = convert(model, new)
    assert [each[2] for each in result.left] == [*left]
    old, parts = (parts_of(each.read_bytes()) for each in (path, new))
    assert {name for name in old if old[name] != parts[name]} <= CHANGED
    made = load(new)
    one, other = simulated(model, 2_000, 5), simulated(made, 2_000, 5)
    np.testing.assert_array_equal(one.trial_index, other.trial_index)
    assert list(one.forecasts) == list(other.forecasts)
    for columns, others in ((one.inputs, other.inputs), (one.forecasts, other.forecasts)):
        for name, values in columns.items():
            np.testing.assert_array_equal(values, others[name])
    assert one.discards == other.discards
    return new, made


@pytest.mark.parametrize("cells", BOOKS.values(), ids=list(BOOKS))
def test_calls_become_rows(tmp_path, cells):
    _, made = converted(written(tmp_path / "book.xlsx", cells))
    with pytest.raises(WorkbookError, match="is in xlmc's tables already"):
        convert(made, tmp_path / "again.xlsx")


S = "Sheet1"
SKID = Drawn(S, "$B$2", "Skid", "Normal", {"Mean": 100.0, "StdDev": 15.0}, {"LoCut": 80.0}, references={3: "$D$2"})
OFFSET = Drawn(S, "$B$3", "Offset", "LogNormal", {"Mean": 50.0, "StdDev": 10.0, "Location": 0.0})
ODD = Drawn(S, "$B$4", "Odd", "Unheard", {"A": 1.0}, code=77)
CELLS = {
    S: {"B2": 100, "B3": 50, "B4": 1, "D2": "=B3/5", "B5": "=2*B2-B3+30", "B6": "=B3+B4", "B7": "=B3", "B8": "=B2"}
}
FILTER = {"fFilterPrefs": {"fUseFilter": True, "fFilterMin": 190.0}}
INSIDE = {"fFilterPrefs": {"fUseFilter": True, "fFilterInside": True, "fFilterMin": 45.0, "fFilterMax": 50.0}}
ALL = {"fFilterPrefs": {"fUseFilter": True, "fFilterMax": 120.0, "fFilterAllOnDiscard": True}}


def test_dialogs_become_rows_and_what_cannot_be_read_is_still_refused(tmp_path):
    answers = [
        Asked(S, "$B$5", "Total", "ft", prefs=FILTER),
        Asked(S, "$B$6", "With odd", prefs=FILTER),
        Asked(S, "$B$7", "Other", prefs=INSIDE),
        Asked(
            S,
            "$B$8",
            "Same",
            prefs=ALL | {"fCertaintyChartPrefs": {"fCertaintyRangeMin": 5.0, "fCertaintyRangeMax": 9.0}},
        ),
    ]
    path = tmp_path / "book.xlsx"
    save(path, CELLS, [[SKID, OFFSET, ODD, Tied(S, "", SKID, OFFSET, 0.5)], answers], comments=[(S, "A1", "hello")])
    new = converts(path, left=["Sheet1!B4", ""])
    model = load(new)
    assert [each.name for each in model.forecasts] == ["Total", "Other", "Same"]
    assert [each.asked for each in model.forecasts] == [None, None, (5.0, 9.0)]
    assert ["With odd" in str(each) and "Sheet1!B4" in str(each) for each in model.definitions.refused] == [True]
    assert {each.name for each in model.definitions.left_out} == {"With odd", "Filter of With odd"}
    assert not any("Crystal Ball keeps no run preferences" in str(notice) for notice in model.notices)
    sheet = openpyxl.load_workbook(new)["xlmc"]
    red = [
        cell.value for row in sheet.iter_rows() for cell in row if cell.font.color and cell.font.color.rgb == "FFC00000"
    ]
    assert "Sheet1!B4" in red


def test_decision_variables_become_rows_of_decisions(tmp_path):
    path, loss = tmp_path / "book.xlsx", Drawn("S", "$B$2", "Loss", "Normal", {"Mean": 100.0, "StdDev": 15.0})
    objects = [loss, Asked("S", "$B$5", "Kept", ""), Decided("S", "$B$3", "Share", (0.0, 1.0, 0.05))]
    save(path, {"S": {"B2": 100, "B3": 0.25, "B5": "=B2*(1-B3)"}}, [objects])
    (old,) = load(path).definitions.decisions
    (new,) = converted(path)[1].definitions.decisions
    assert (new.name, new.cell, new.between, new.listed) == (old.name, old.cell, None, False)
    np.testing.assert_allclose(new.values, old.values, rtol=1e-12)
    assert new.row.sheet != "S"


def test_settings_are_written_with_the_precision_that_dialogs_ask_for(tmp_path):
    path = tmp_path / "book.xlsx"
    for asked, trials in (
        ({}, 200_000),
        ({"fUsePrecision": True, "fAbsoluteUnits": 0.3, "fUsePercentile": True}, None),
    ):
        total = Asked(S, "$B$5", "Total", prefs={"fPrecisionPrefs": asked})
        save(path, CELLS, [[SKID, OFFSET, total, Asked(S, "$B$7", "Other")]])
        new = load(converts(path)).definitions.settings
        assert new == load(path).definitions.settings
        assert (new.trials == trials) == (new.stopping.goal is None)


def test_a_precision_that_no_row_can_say_is_red(tmp_path):
    path = tmp_path / "book.xlsx"
    tiny = {"fUsePrecision": True, "fAbsolute": False, "fRelative": True, "fRelativePct": 0.0005}
    save(path, CELLS, [[SKID, OFFSET, Asked(S, "$B$5", "Total", prefs={"fPrecisionPrefs": tiny})]])
    converts(path, left=[""])


def test_a_row_that_a_person_deletes_no_longer_draws(tmp_path):
    """What stands in a table counts, not what Crystal Ball's block still says."""
    path = tmp_path / "book.xlsx"
    save(path, CELLS, [[OFFSET, Asked(S, "$B$7", "Other"), Drawn(S, "$B$2", "Skid", "DPoisson", {"Rate": 9.0})]])
    new = converts(path)
    parts = read_parts(new)
    (sheet,) = (name for name, held in parts.items() if b"Definitions for xlmc" in held)
    parts[sheet] = re.sub(rb"<row [^>]*>(?:(?!</row>).)*>Skid<.*?</row>", b"", parts[sheet], count=1)
    write_parts(path, parts)
    assert [a.name for a in load(path).assumptions] == ["Offset"]


def test_what_is_refused_stays_refused_when_another_program_drops_the_blocks(tmp_path, monkeypatch):
    keep_sheets(monkeypatch, "Results")
    path = tmp_path / "book.xlsx"
    save(path, CELLS, [[OFFSET, ODD, Asked(S, "$B$7", "Other"), Asked(S, "$B$6", "With odd")]])
    new = converts(path, left=["Sheet1!B4", ""])
    openpyxl.load_workbook(new).save(path)
    (refused,) = load(path).definitions.refused
    assert "'With odd' needs Sheet1!B4" in refused.message
    from click.testing import CliRunner

    reported = CliRunner().invoke(command, ["simulate", str(new), "-n", "1000"])
    assert reported.exit_code == 1
    assert "this answer is missing, and the others do not need it" in " ".join(reported.stderr.split())
    assert "must not be used" not in reported.stderr
    text = openpyxl.load_workbook(new.with_stem(f"{new.stem}-results"))["Results"]["A3"].value
    assert text.startswith("An answer is missing: The forecast 'With odd' needs Sheet1!B4")
    assert text.endswith("The answers of other forecasts do not need it.")


def test_rows_for_calls_follow_their_cells_and_say_when_the_call_is_gone(tmp_path):
    new = converts(written(tmp_path / "book.xlsx", BOOKS["two in a cell"]))
    book = openpyxl.load_workbook(new)
    book["S"]["A1"] = "=RiskUniform(0,1)"
    book.save(new)
    with pytest.raises(Exception, match="replaces the call S!A1#2, and there is no such call"):
        load(new)


def test_the_command_says_what_it_wrote(tmp_path):
    from click.testing import CliRunner

    path = tmp_path / "book.xlsx"
    save(path, CELLS, [[OFFSET, ODD, Asked(S, "$B$7", "Other"), Asked(S, "$B$6", "With odd")]])
    before = read_parts(path)
    result = CliRunner().invoke(command, ["convert", str(path)])
    assert result.exit_code == 0, result.output
    assert "xlmc_assumptions" in result.output
    assert "Sheet1!B4" in result.output
    assert read_parts(path) == before
    assert (tmp_path / "book-converted.xlsx").exists()
    assert CliRunner().invoke(command, ["convert", str(path)]).exit_code != 0


OPEN, STRICT = "http://schemas.openxmlformats.org", "http://purl.oclc.org/ooxml"


def with_macros(parts):
    """The workbook with a project of macros, which nobody reads."""
    kind = b"application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml"
    types = parts["[Content_Types].xml"].replace(kind, b"application/vnd.ms-excel.sheet.macroEnabled.main+xml")
    project = b'<Override PartName="/xl/vbaProject.bin" ContentType="application/vnd.ms-office.vbaProject"/></Types>'
    of = b'<Relationship Id="rV" Type="http://schemas.microsoft.com/office/2006/relationships/vbaProject" Target="'
    rels = parts["xl/_rels/workbook.xml.rels"]
    return {
        **parts,
        "[Content_Types].xml": types.replace(b"</Types>", project),
        "xl/_rels/workbook.xml.rels": rels.replace(b"</Relationships>", of + b'vbaProject.bin"/></Relationships>'),
        "xl/vbaProject.bin": bytes(range(256)) * 9,
    }


def protected(parts):
    """The workbook with a password on its structure and on its sheet."""
    book = parts["xl/workbook.xml"]
    sheet = parts["xl/worksheets/sheet2.xml"]
    lock = b'<workbookProtection workbookPassword="CC1A" lockStructure="1"/><bookViews>'
    return {
        **parts,
        "xl/workbook.xml": book.replace(b"<bookViews>", lock),
        "xl/worksheets/sheet2.xml": sheet.replace(
            b"</sheetData>", b'</sheetData><sheetProtection password="CC1A" sheet="1"/>'
        ),
    }


def renamed(parts):
    """The workbook as Excel leaves it when a person renames the sheet."""
    book = parts["xl/workbook.xml"].replace(b'name="Sheet1"', b'name="New name"')
    return {**parts, "xl/workbook.xml": book.replace(b">Sheet1!", b">'New name'!")}


@pytest.mark.parametrize("change", [with_macros, protected, renamed])
def test_what_excel_adds_to_a_workbook_of_dialogs_stays(tmp_path, change):
    path = tmp_path / "book.xlsx"
    save(path, CELLS, [[SKID, OFFSET, Asked(S, "$B$5", "Total")]])
    write_parts(path, change(read_parts(path)))
    new = read_parts(converts(path))  # compares all parts
    assert ("xl/vbaProject.bin" in new) == (change is with_macros)


def test_a_strict_workbook_is_converted(tmp_path):
    path = tmp_path / "book.xlsx"
    save(path, CELLS, [[SKID, OFFSET, Asked(S, "$B$5", "Total")]])
    expected = simulated(load(path), 100).forecasts["Total"]
    pairs = [(f"{OPEN}/spreadsheetml/2006/main", f"{STRICT}/spreadsheetml/main")]
    pairs += [(f"{OPEN}/officeDocument/2006/relationships", f"{STRICT}/officeDocument/relationships")]
    parts = read_parts(path)
    for name in [name for name in parts if name.endswith((".xml", ".rels"))]:
        for old, new in pairs:
            parts[name] = parts[name].replace(old.encode(), new.encode())
    write_parts(path, parts)
    model = load(path)
    np.testing.assert_array_equal(simulated(model, 100).forecasts["Total"], expected)
    new = convert(model, tmp_path / "new.xlsx").path
    np.testing.assert_array_equal(simulated(load(new), 100).forecasts["Total"], expected)


def test_the_workbook_itself_is_not_replaced_by_whatever_name(tmp_path):
    path = written(tmp_path / "book.xlsx", BOOKS["one call"])
    (tmp_path / "link.xlsx").symlink_to(path)
    before, model = path.read_bytes(), load(path)
    for name in ("book.xlsx", "link.xlsx"):
        with pytest.raises(WorkbookError, match="This is the file that is read"):
            convert(model, tmp_path / name, overwrite=True)
    assert path.read_bytes() == before
