"""How answers are stated, in every output of one workbook: at their resolution, on one side, as a probability."""

from __future__ import annotations

import json
import re
import zipfile

import openpyxl
import pytest
from click.testing import CliRunner
from openpyxl.worksheet.table import Table
from simulated import simulated

from xlmc.analysis.results.saved import open_run
from xlmc.api import Simulation
from xlmc.cli import xlmc as command
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.live.frames import rest_of

ROWS = [
    ["Name", "Value", "Units", "Threshold", "Report to", "Kind", "Role"],
    ["delta-V", "=B7*2", "mph", None, "1 mph", None, None],
    ["projection speed, at least", "=B7+1", "mph", None, 1, "number", "lower bound"],
    ["avoided", "=B7>12", None, None, None, "yes/no", None],
    ["residual", "=B7-15", "mph", 0, None, None, "diagnostic"],
]
"""B7 is the assumption, uniform from 10 to 20."""


@pytest.fixture(scope="module")
def outputs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("stated")
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "S"
    for row in (*ROWS, ["Name", "Value", "Low", "High"], ["speed", 15, 10, 20]):
        sheet.append(row)
    sheet.add_table(Table(displayName="xlmc_forecasts", ref="A1:G5"))
    sheet.add_table(Table(displayName="xlmc_assumptions", ref="A6:D7"))
    book.save(folder / "book.xlsx")
    run = simulated(load(folder / "book.xlsx"), 20_000)
    Simulation(run).save_page(folder / "out.html")
    Simulation(run).save_json(folder / "out.json")
    Simulation(run).save_report(folder / "out.docx")
    Simulation(run).keep(folder / "out.xlmcrun")
    result = CliRunner().invoke(command, ["simulate", str(folder / "book.xlsx"), "-n20000", f"-o{folder / 'out.xlsx'}"])
    assert result.exit_code == 0, result.output
    return folder, " ".join(result.output.split())


@pytest.fixture(scope="module")
def stated(outputs):
    """What Python says of the saved run."""
    return Simulation(open_run(outputs[0] / "out.xlmcrun")).sentences


def test_each_answer_is_stated_as_its_row_asks(stated):
    first, bound, avoided = stated
    assert first.startswith("delta-V: the 51 % range (")
    assert first.endswith((" between 25 and 36 mph", " between 24 and 35 mph"))
    assert bound.startswith("projection speed, at least: at least 15 mph, with a probability of at least ")
    share, _, rest = avoided.removeprefix("avoided: yes with probability ").partition(" % ± 0.3 %")
    assert abs(float(share) - 80.0) < 4 * 0.29  # of 20,000 trials
    assert rest == ""  # the book is of no crash
    assert not any("residual" in each for each in stated)


def test_every_output_says_the_same(outputs, stated):
    folder, terminal = outputs
    page = (folder / "out.html").read_text(encoding="utf-8").replace("\u00a0", " ")
    with zipfile.ZipFile(folder / "out.docx") as package:
        report = re.sub(
            "<[^>]+>", "", package.read("word/document.xml").decode().replace("\u00a0", " ")
        )  # names are bold
    sheet = openpyxl.load_workbook(folder / "out.xlsx")["Certainty"]
    cells = [cell.value for row in sheet for cell in row]
    document = json.loads((folder / "out.json").read_text(encoding="utf-8"))
    window = rest_of(open_run(folder / "out.xlmcrun"))
    assert [each["text"] for each in document["statements"]] == window["sentences"] == list(stated)
    for each in stated:
        assert f"{each}." in cells
        assert f"{each}." in terminal
        assert f"{each}." in report
        assert each.partition(": ")[2] in page


def test_the_record_and_the_json_keep_what_was_asked(outputs):
    document = json.loads((outputs[0] / "out.json").read_text(encoding="utf-8"))
    result = [(each["report_to"], each["kind"], each["role"]) for each in document["forecasts"]]
    assert result == [
        (1, "number", "answer"),
        (1, "number", "lower bound"),
        (None, "yes/no", "answer"),
        (None, "number", "diagnostic"),
    ]
    rows = document["record"]["forecasts"]["rows"]
    assert [(each["report_to"], each["kind"], each["role"]) for each in rows] == [
        (1, "", ""),
        (1, "number", "lower bound"),
        (None, "yes/no", ""),
        (None, "", "diagnostic"),
    ]


def test_a_bound_is_typed_with_one_end_and_the_run_can_be_repeated(outputs):
    folder, _ = outputs
    sheet = openpyxl.load_workbook(folder / "out.xlsx")["Certainty"]
    typed = [row for row in sheet.iter_rows(values_only=True) if row[0] == ROWS[2][0] and row[1] == "mph"]
    assert [row[2:4] for row in typed] == [(15, None)]
    result = CliRunner().invoke(command, ["replay", str(folder / "out.xlsx")])
    assert result.exit_code == 0, result.output


def test_check_shows_how_answers_are_stated(outputs):
    result = CliRunner().invoke(command, ["check", str(outputs[0] / "book.xlsx")])
    assert result.exit_code == 0
    assert all(word in result.output for word in ("Report to", "lower bound", "yes/no", "diagnostic"))


def answer_rows(path):
    """The rows of the sheet Results that begin with a forecast's name, with the numbers' formats."""
    sheet = openpyxl.load_workbook(path)["Results"]
    names = {row[0] for row in ROWS[1:]}
    result = {}
    for row in sheet.iter_rows():
        filled = [each for each in row if each.value is not None]
        if filled and filled[0].value in names:
            result.setdefault(filled[0].value, [(each.value, each.number_format) for each in filled])
    return result


def test_a_yes_or_no_is_a_share_in_percent_in_every_table_of_answers(outputs):
    folder, printed = outputs
    share = open_run(folder / "out.xlmcrun").results["avoided"].yes
    text = f"{100 * share.value:.2f} ± {100 * share.error:.2f} %"
    assert f"avoided yes {text} yes residual" in printed  # no SD and no range; at the base case: yes
    rows = answer_rows(folder / "out.xlsx")
    (_, units, _, mean, error, *spread, base) = rows["avoided"]
    assert {value for value, _ in spread} == {"–"}
    assert (units[0], base[0]) == ("yes", "yes")
    assert (mean, error) == ((share.value, "0.00%"), (share.error, "0.00%"))
    page = (folder / "out.html").read_text(encoding="utf-8").replace("\u00a0", " ")
    assert f">{text}</data>" in page
    assert f"avoided: yes in {text} of 20,000 accepted trials, else no" in page
    with zipfile.ZipFile(folder / "out.docx") as package:
        assert text in package.read("word/document.xml").decode().replace("\u00a0", " ")


def test_a_zero_that_no_draw_reaches_is_known_exactly(tmp_path):
    """Not as a share of none of the trials is, which has a bound."""
    book = openpyxl.Workbook()
    sheet = book.active
    for row in (["Name", "Value"], ["never", "=IF(D7>100,1,0)"], ["cost", "=D9*2"], ["speed", "=B7*2"]):
        sheet.append(row)
    for row in ([], ["Name", "Value", "Low", "High"], ["v", 15, 10, 20]):
        sheet.append(row)
    sheet["D7"] = 20
    sheet["B2"] = "=IF(B7>100,1,0)"
    sheet.add_table(Table(displayName="xlmc_forecasts", ref="A1:B4"))
    sheet.add_table(Table(displayName="xlmc_assumptions", ref="A6:D7"))
    book.save(tmp_path / "book.xlsx")
    run = simulated(load(tmp_path / "book.xlsx"), 2_000)
    cost, never = run.results["cost"], run.results["never"]
    assert (cost.mean.value, cost.mean.error, cost.standard_deviation.error) == (0.0, 0.0, 0.0)
    assert cost.yes is None
    assert never.yes.value == 0.0
    assert never.mean.interval[1] > 0.0
