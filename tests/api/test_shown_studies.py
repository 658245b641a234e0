from __future__ import annotations

import json

import openpyxl
import pytest
from openpyxl.worksheet.table import Table
from workbook_files import workbook_of

import xlmc


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    """A seller of newspapers: demand, an order that is decided, a profit."""
    path = tmp_path_factory.mktemp("shown") / "news.xlsx"
    workbook_of(
        {
            "A": [
                ("Name", "Value", "Distribution", "Mean", "Std dev", "Kind of uncertainty"),
                ("Demand", 100, "Normal", 100, 20, "Uncertain"),
            ],
            "F": [("Name", "Value", "Units"), ("Profit", "=MIN(A!B2,D!C5)-0.4*D!C5", "$")],
            "D": [("Name", "Cell", "Values"), ("Order", "=D!C5", "80; 105; 130"), (), (), ("Bought", "", 100)],
        },
        {"xlmc_assumptions": "A!A1:F2", "xlmc_forecasts": "F!A1:C2", "xlmc_decisions": "D!A1:C2"},
    ).save(path)
    return path


@pytest.fixture(scope="module")
def model(book):
    return xlmc.load(book)


STUDIES = {
    "compare": (lambda model: xlmc.compare(model, model, trials=2000), "Profit"),
    "decide": (lambda model: xlmc.decide(model, trials=2000), "Order = 105"),
    "methods": (lambda model: xlmc.methods(model, trials=2000, replicates=3, reference_trials=4000), "Monte Carlo"),
    "optimise": (lambda model: model.optimise(maximise="mean of Profit", trials=2000), "Order = 105"),
    "screen": (lambda model: xlmc.screen(model, trials=2000), "Every assumption is needed"),
    "seek": (lambda model: xlmc.seek(model.path, "F!B2", 50, "D!C5", low=0, high=100), "83.33"),
    "stability": (lambda model: xlmc.stability(model, trials=2000), "Can the digits be trusted?"),
    "stress": (lambda model: xlmc.stress(model, trials=2000), "Profit moves most with Demand"),
    "uncertainty": (lambda model: xlmc.uncertainty(model, outer=50, inner=100), "Profit"),
}


@pytest.fixture(scope="module", params=STUDIES)
def study(request, model):
    make, message = STUDIES[request.param]
    return make(model), message


def test_it_prints_itself_in_sentences(study):
    result, message = study
    assert message in repr(result)
    assert " object at 0x" not in repr(result)
    assert len(repr(result)) < 6000


def test_a_notebook_shows_its_tables(study):
    result, message = study
    assert message in result._repr_html_()
    assert "<table" in result._repr_html_()


def test_it_is_saved_as_its_command_saves_it(study, tmp_path):
    result, message = study
    assert message in result.save(tmp_path / "found.html").read_text(encoding="utf-8")
    assert json.loads(result.save(tmp_path / "found.json").read_text(encoding="utf-8"))
    assert result.save(tmp_path / "found.xlsx").stat().st_size > 1000


def test_what_was_studied_is_never_replaced(model):
    with pytest.raises(xlmc.errors.XlmcError, match=r"news\.xlsx"):
        xlmc.decide(model, trials=1000).save(model.path, overwrite=True)


def test_other_endings_are_refused(model, tmp_path):
    with pytest.raises(xlmc.errors.WorkbookError, match=r"\.txt"):
        xlmc.decide(model, trials=1000).save(tmp_path / "found.txt")


def test_sensitivities_a_check_and_a_fit_print_themselves_shortly(model):
    assert "Demand 100" in repr(xlmc.sensitivities(model.simulate(2000)))
    assert repr(xlmc.verify(model.path)).startswith("1 formula cell: ")
    assert repr(xlmc.fit([1.2, 1.9, 2.4, 3.1, 3.3, 4.8])).startswith("6 values as continuous, the best by AIC first:")


def test_numbers_have_the_style_of_the_workbook(tmp_path, book):
    made = openpyxl.load_workbook(book)
    sheet = made.create_sheet("S")
    for row in (("Setting", "Value"), ("Number style", "1.234,5")):
        sheet.append(row)
    sheet.add_table(Table(displayName="xlmc_settings", ref="A1:B2"))
    made.save(tmp_path / "styled.xlsx")
    result = xlmc.decide(xlmc.load(tmp_path / "styled.xlsx"), trials=2000)
    assert "2.000 trials" in repr(result)
    assert "2.000 trials" in result._repr_html_()
