from __future__ import annotations

import json
import sys
from zipfile import ZipFile

import pytest
from workbook_files import workbook_of

from xlmc.analysis.studies import methods

SHORT = ("--reference-trials", "65536", "-n", "4096", "--replicates", "2", "--quiet")


BOOK = {
    "Inputs": [["Name", "Value", "Low", "High"], ["a", 0.5, 0, 1], ["b", 2, 1, 3]],
    "Model": [["=Inputs!B2*Inputs!B3", "=3*4"]],
    "Wanted": [
        ["Name", "Cell", "Units"],
        ["Speed", "=Model!A1", "mph"],
        ["Constant", "=Model!B1", "mph"],
        [],
        ["Name", "Cell", "Above", "Because"],
        ["fast", "=Inputs!B3", 0.4, "seen"],
    ],
}
"""One of the forecasts does not vary, and the filter rejects nothing."""


@pytest.fixture(autouse=True)
def studied_once(made_once):
    made_once(methods, "study")


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    tables = {"xlmc_assumptions": "Inputs!A1:D3", "xlmc_forecasts": "Wanted!A1:C3", "xlmc_filters": "Wanted!A5:D6"}
    path = tmp_path_factory.mktemp("methods") / "book.xlsx"
    workbook_of(BOOK, tables).save(path)
    return path


def test_words_and_files(xlmc, book, tmp_path, monkeypatch):
    files = [tmp_path / name for name in ("m.png", "m.html", "m.xlsx")]
    outputs = [each for file in files for each in ("-o", file)]
    pypdf = pytest.importorskip("pypdf")
    pytest.importorskip("typst")
    figure = pytest.importorskip("matplotlib.figure").Figure
    monkeypatch.setattr(figure, "get_layout_engine", lambda _: None)  # where panels lie takes two thirds of the time
    axis = pytest.importorskip("matplotlib.axis").Axis
    monkeypatch.setattr(axis, "get_minorticklocs", lambda _: [])  # and the small ticks half of the rest
    pdf = tmp_path / "m.pdf"
    outcome = xlmc("methods", book, *SHORT, *outputs, "--pdf", pdf)
    assert outcome.code == 0
    text = " ".join(outcome.out.split())
    for name in ("Bounds, corners", "Taylor, second order", "Scrambled Sobol", "Importance grid", "engine formulas"):
        assert name in text
    assert "Recommended:" in text
    assert "does not see filters" in text
    assert files[0].read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    pages = list(pypdf.PdfReader(pdf).pages)
    figures = [len(each.get_contents().get_data()) > 100_000 for each in pages]  # shapes, which take long to read
    assert sum(figures) == 2
    printed = "".join(each.extract_text() for each, figure in zip(pages, figures, strict=True) if not figure)
    for name in ("Recommended:", "Bounds, corners"):
        assert name in " ".join(printed.split())
    page = files[1].read_text(encoding="utf-8")
    assert page.count("<svg") == 2
    assert "<script" not in page
    assert "https://" not in page.replace("https://matplotlib.org", "")
    with ZipFile(files[2]) as package:
        charts = [name for name in package.namelist() if name.startswith("xl/charts/chart")]
        assert len(charts) == 6
        assert all(b'<c:logBase val="10"/>' in package.read(name) for name in charts)


def test_json(xlmc, book):
    outcome = xlmc("methods", book, *SHORT, "--json", "--accuracy", "1%")
    assert outcome.code == 0
    result = json.loads(outcome.out)
    methods = {each["method"]: each for each in result["methods"]}
    bounds, truth = methods["corners"]["bounds"], result["reference"]["forecasts"]
    for name, answer in truth.items():
        assert bounds[name]["least"] <= answer["low"]["value"] <= answer["high"]["value"] <= bounds[name]["most"]
    assert any(answer["sd"]["value"] == 0.0 for answer in truth.values())
    assert methods["mc"]["runs"][-1]["trials"] == 4096
    assert methods["mc"]["needs"]["trials"] > 0
    assert result["accuracy"] == "1%"
    assert any("Recommended: " in sentence for sentence in result["recommendation"])
    assert result["reference"]["sampling"] == "sobol"
    assert result["not_used"] == {}


def test_an_engine_that_refuses_the_book_is_named_and_left_out(xlmc, tmp_path):
    """`formulas` cannot take a union of references; the other engines and methods answer all the same."""
    path = tmp_path / "union.xlsx"
    tables = {"xlmc_assumptions": "Inputs!A1:D3", "xlmc_forecasts": "Wanted!A1:C2"}
    sheets = BOOK | {"Model": [["=SUM((Inputs!B2,Inputs!B3))"]], "Wanted": BOOK["Wanted"][:2]}
    workbook_of(sheets, tables).save(path)
    outcome = xlmc("methods", path, *SHORT, "--json")
    assert outcome.code == 0
    result = json.loads(outcome.out)
    assert list(result["not_used"]) == ["Monte Carlo, engine formulas"]
    message = result["not_used"]["Monte Carlo, engine formulas"]
    assert message.startswith("Model!A1: The engine `formulas` cannot compute this.")
    assert "SUM((Inputs!B2,Inputs!B3))" in message
    methods = {each["method"]: each for each in result["methods"]}
    assert "mc" in methods
    assert not any("formulas" in key for key in methods)
    assert any("Recommended: " in messages for messages in result["recommendation"])
    shown = xlmc("methods", path, *SHORT)
    assert shown.code == 0
    assert "engine formulas" in shown.out
    assert "Traceback" not in shown.out + shown.err


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("m.doc", "This command writes no file that ends in .doc"),
        ("m", "The name of the file has no ending"),
        ("nowhere/m.png", "There is no folder"),
    ],
)
def test_an_output_that_cannot_be(xlmc, case_study, name, message):
    outcome = xlmc("methods", case_study, "-o", name)
    assert outcome.code == 2
    assert message in outcome.err


def test_a_document_must_have_the_ending_of_its_option(xlmc, case_study, tmp_path):
    outcome = xlmc("methods", case_study, "--pdf", tmp_path / "m.docx")
    assert outcome.code == 2
    assert "The report must end in .pdf" in outcome.err


def test_the_workbook_itself_is_no_output(xlmc, case_study, tmp_path):
    copy = tmp_path / "case.xlsx"
    copy.write_bytes(case_study.read_bytes())
    outcome = xlmc("methods", copy, "-o", copy)
    assert outcome.code == 2
    assert "This is the file that is read" in outcome.err
    assert copy.read_bytes() == case_study.read_bytes()


def test_nothing_to_draw_with(xlmc, case_study, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    outcome = xlmc("methods", case_study, "-o", "m.png")
    assert outcome.code == 2
    assert 'pip install "matplotlib>=3.8"' in outcome.err


def test_an_accuracy_that_cannot_be_read(xlmc, case_study):
    outcome = xlmc("methods", case_study, "--accuracy", "good")
    assert outcome.code == 2
    assert "'good' is not a precision" in outcome.err
