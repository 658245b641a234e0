"""Of very many forecasts the first ones have charts and sensitivities, all have answers; more are a setting."""

from __future__ import annotations

import json

import jsonschema
import openpyxl
import pytest
from workbook_files import workbook_of

import xlmc
from xlmc.analysis.results.record import make_record
from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.run_settings import DETAILED
from xlmc.outputs.json_document import SCHEMA, document
from xlmc.outputs.page import page_text

MANY = DETAILED + 3


@pytest.fixture(scope="module")
def make_book(tmp_path_factory):
    """`make_book(forecasts, *settings)`: a book whose forecast k is k·a + b."""

    def make(forecasts, *settings):
        sheets = {
            "Inputs": [["Name", "Value", "Low", "High"], ["a", 0.5, 0, 1], ["b", 0.5, 0, 2]],
            "Answers": [["Name", "Value"], *([f"Answer {k}", f"=Inputs!B2*{k}+Inputs!B3"] for k in range(forecasts))],
            "Settings": [["Setting", "Value"], ["Trials", 300], *settings],
        }
        tables = {
            "xlmc_assumptions": "Inputs!A1:D3",
            "xlmc_forecasts": f"Answers!A1:B{forecasts + 1}",
            "xlmc_settings": f"Settings!A1:B{2 + len(settings)}",
        }
        path = tmp_path_factory.mktemp("many") / "many.xlsx"
        workbook_of(sheets, tables).save(path)
        return path

    return make


@pytest.fixture(scope="module")
def book(make_book):
    return make_book(MANY)


@pytest.fixture(scope="module")
def run(book):
    return xlmc.load(book).simulate()


def texts(sheet):
    return [cell for row in sheet.iter_rows(values_only=True) for cell in row if isinstance(cell, str)]


def drawn(book):
    """How many forecasts' histograms, and how many sensitivities, a result workbook holds; and what it says of them."""
    charts, sensitivity = texts(book["Charts"]), texts(book["Sensitivity"])
    figures = sum(": mean " in text for text in charts)
    return figures, sum(text.endswith(": all numbers") for text in sensitivity), charts + sensitivity


@pytest.mark.parametrize(
    ("settings", "options", "messages"),
    [
        ((), {}, DETAILED),
        ((), {"detailed": 2}, 2),
        ((), {"detailed": MANY}, MANY),
        ((["Detailed forecasts", 22],), {}, 22),
    ],
)
def test_charts_and_sensitivity_are_of_the_first_forecasts(make_book, tmp_path, settings, options, messages):
    run = xlmc.load(make_book(MANY, *settings)).simulate(**options)
    assert len(xlmc.sensitivities(run).forecasts) == messages
    assert xlmc.sensitivities(run).omitted_forecasts == MANY - messages
    saved = openpyxl.load_workbook(run.save(tmp_path / "out.xlsx"))
    figures, measured, message = drawn(saved)
    assert (figures, measured) == (messages, messages)
    assert {f"Answer {k}" for k in range(MANY)} <= set(texts(saved["Results"]))
    asking = [text for text in message if f"--detailed {MANY}" in text]
    assert len(asking) == (2 if messages < MANY else 0)
    assert all(f" first {messages} of {MANY} " in text for text in asking)
    page = page_text(run._run)
    assert page.count('class="forecast"') == page.count('class="sensitivity"') == messages
    assert ("Charts are drawn of" in page) is (messages < MANY)


def test_json_says_how_many_forecasts_it_leaves_out(make_book, run):
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    many, few = document(run._run), document(xlmc.load(make_book(2)).simulate()._run)
    for each in (many, few):
        jsonschema.validate(each, schema)
    assert len(many["forecasts"]) == MANY
    assert many["sensitivity"]["omitted_forecasts"] == MANY - DETAILED
    assert "omitted_forecasts" not in few["sensitivity"]


def test_forecasts_beyond_the_first_are_measured_where_they_are_named(run):
    result = xlmc.sensitivities(run, forecasts=["answer 21"])
    assert [each.forecast for each in result.forecasts] == ["Answer 21"]
    assert [each.assumption for each in result.forecasts[0].influences] == ["a", "b"]
    with pytest.raises(SimulationError, match="There is no forecast 'answer 99'"):
        xlmc.sensitivities(run, forecasts=["answer 99"])


def test_a_report_about_a_later_forecast_says_what_it_depends_on(run, tmp_path):
    from docx import Document

    path = run.save_report(tmp_path / "report.docx", sections=["sensitivity"], forecasts=["Answer 22"])
    cells = [cell.text for table in Document(path).tables for row in table.rows for cell in row.cells]
    assert {"Answer 22", "a", "b"} <= set(cells)


def test_the_setting_is_recorded_repeated_and_saved(book, run, tmp_path):
    asked = xlmc.load(book).simulate(detailed=4)
    assert make_record(asked._run, None).as_dict()["settings"]["detailed"] == 4
    assert "--detailed 4" in str(make_record(asked._run, None).as_dict())
    assert "detailed" not in str(make_record(run._run, None).as_dict())
    opened = xlmc.open_run(asked.keep(tmp_path / "kept.xlmcrun"))
    assert len(xlmc.sensitivities(opened).forecasts) == 4
    with pytest.raises(SimulationError, match="Charts and sensitivity of -1 forecasts were asked for"):
        xlmc.load(book).simulate(detailed=-1)
