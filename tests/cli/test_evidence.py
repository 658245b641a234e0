"""What a person sees of evidence: on the terminal, the sheets, the page, in JSON, the report and the record."""

from __future__ import annotations

import json
from contextlib import closing

import jsonschema
import openpyxl
import pytest
from fewer_sheets import keep_few_trials, leave_out_fits
from openpyxl.worksheet.table import Table

from xlmc.outputs.json_document import SCHEMA

HEADINGS = ["Name", "Cell", "Reading", "Error", "±", "Std dev", "Source", "Use"]
EDR = ["EDR", "=Inputs!F1", 2, "Normal", None, 0.5, "CDR report, p. 4"]
VIDEO = ["video", "=Inputs!F1", 2.4, None, 0.5, None, "camera 3"]
FAR = ["video", "=Inputs!F1", -2.4, None, 0.3, None, "camera 3"]
OFF = ["damage", "=Inputs!F1", 9, "Normal", None, 0.5, "crush", "off"]


@pytest.fixture
def book(tmp_path):
    def make(*items):
        made = openpyxl.Workbook()
        sheet = made.active
        sheet.title = "Inputs"
        for row in (["Name", "Value", "Low", "High", "Source"], ["a", 1, -1, 3, "tape"], ["b", 0, -2, 2, "tape"]):
            sheet.append(row)
        sheet["F1"] = "=B2+B3"
        sheet.add_table(Table(displayName="xlmc_assumptions", ref="A1:E3"))
        answers = made.create_sheet("Answers")
        answers.append(["Name", "Cell", "Units"])
        answers.append(["Speed", "=Inputs!F1", "mph"])
        answers.add_table(Table(displayName="xlmc_forecasts", ref="A1:C2"))
        facts = made.create_sheet("Facts")
        for row in (HEADINGS, *items):
            facts.append(row)
        facts.add_table(Table(displayName="xlmc_evidence", ref=f"A1:H{len(items) + 1}"))
        made.save(tmp_path / "book.xlsx")
        return tmp_path / "book.xlsx"

    return make


def words(path):
    with closing(openpyxl.load_workbook(path, read_only=True)) as book:
        rows = [*book["Evidence results"].iter_rows(values_only=True)]
    return " ".join(str(value) for row in rows for value in row if value is not None)


def test_evidence_that_agrees_is_shown_everywhere_with_what_it_moves(xlmc, short_books, book, tmp_path):
    page, result, report, kept = (tmp_path / f"book{ending}" for ending in (".html", ".json", ".docx", ".xlmcrun"))
    outputs = ("--html", page, "--json", result, "--docx", report, "--save-run", kept)
    outcome = xlmc("simulate", book(EDR, VIDEO, OFF), "-n", 20_000, *outputs)
    assert outcome.code == 0, outcome.err
    out = " ".join(outcome.out.split())
    assert "note: Facts!A4: Evidence that is not used, because Use is off: 'damage'" in outcome.err
    assert "The items corroborate each other" in out
    assert "EDR alone, without video" in out
    data = json.loads(result.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8"))).validate(data)
    evidence = data["evidence"]
    assert evidence["verdict"] == "corroborates"
    assert [item["reading"] for item in evidence["items"]] == [2, 2.4]
    assert [answer["with"] for answer in evidence["answers"]][:2] == ["no evidence", "all evidence"]
    assert [row["verdict"] for row in data["record"]["evidence"]["rows"]] == [
        "corroborates",
        "corroborates",
        "not used",
    ]
    assert all(each["name"] in ("a", "b") for each in data["assumptions"])
    expected = words(tmp_path / "book-results.xlsx")
    for message in (
        "The items corroborate each other",
        "What each item moves",
        "CDR report, p. 4",
        "not used: Use is off",
    ):
        assert message in expected
        assert message in page.read_text(encoding="utf-8")
    assert "evidence\x1f" not in page.read_text(encoding="utf-8") + result.read_text(encoding="utf-8")
    docx = pytest.importorskip("docx")
    paragraphs = [each.text for each in docx.Document(report).paragraphs]
    assert "Evidence, and whether it agrees" in paragraphs
    for repeated in (tmp_path / "book-results.xlsx", kept):
        assert "identical" in xlmc("replay", repeated).out


def test_evidence_that_contradicts_stands_first_and_is_no_success(xlmc, short_books, book, tmp_path):
    outcome = xlmc("simulate", book(EDR, FAR), "-n", 20_000, "--until-accepted", 100, "--rare", "never", "-n", 40_000)
    assert outcome.code == 1
    first = " ".join(outcome.out.partition("accepted trials")[0].split())
    assert first.startswith(
        "book.xlsx: evidence that contradicts The evidence is inconsistent: 'EDR' and 'video' are out of reach"
    )
    assert "warning: the evidence is inconsistent" in outcome.err
    assert "Do not use these results as they are: the evidence is inconsistent" in " ".join(
        str(cell.value) for cell in openpyxl.load_workbook(tmp_path / "book-results.xlsx")["Results"]["A"]
    )


def test_a_book_whose_evidence_is_off_has_no_sheet_of_it_and_check_lists_its_rows(xlmc, short_books, book, tmp_path):
    path = book(OFF)
    assert xlmc("simulate", path, "-n", 2_000).code == 0
    assert "Evidence results" not in openpyxl.load_workbook(tmp_path / "book-results.xlsx").sheetnames
    assert "not used: Use is off" in " ".join(xlmc("check", path).out.split())
    assert "reads 2, normal (Std dev 0.5)" in " ".join(xlmc("check", book(EDR)).out.split())


def test_methods_that_draw_no_trials_say_that_they_cannot_use_a_normal_error(xlmc, book):
    outcome = xlmc("methods", book(EDR))
    assert outcome.code == 2
    assert "cannot use evidence with a normal or lognormal error: 'EDR'" in outcome.err


def test_a_weighted_run_that_keeps_no_trial_is_told_and_written(xlmc, short_books, book, tmp_path):
    path = book([*EDR[:2], 900, *EDR[3:]])
    made = openpyxl.load_workbook(path)
    settings = made.create_sheet("How")
    for row in (["Setting", "Value"], ["Evidence", "weights"]):
        settings.append(row)
    settings.add_table(Table(displayName="xlmc_settings", ref="A1:B2"))
    made.save(path)
    written = [tmp_path / f"book{ending}" for ending in (".html", ".json", ".docx", ".xlmcrun", ".csv")]
    asked = zip(("--html", "--json", "--docx", "--save-run", "--extract"), written, strict=True)
    options = [each for pair in asked for each in pair]
    outcome = xlmc("simulate", path, "-n", 2_000, *options)
    assert outcome.code == 1
    assert "no trial was accepted" in outcome.err
    assert all(each.exists() for each in written)
    jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8"))).validate(
        json.loads(written[1].read_text(encoding="utf-8"))
    )
    assert "identical" in xlmc("replay", tmp_path / "book-results.xlsx").out


def test_a_weighted_run_says_so_everywhere_and_leaves_out_what_cannot_weight(xlmc, book, tmp_path, monkeypatch):
    keep_few_trials(monkeypatch)
    leave_out_fits(monkeypatch)
    path = book([*EDR[:2], 6.5, *EDR[3:]])
    page, result, rows = (tmp_path / f"book{ending}" for ending in (".html", ".json", ".csv"))
    kept = tmp_path / "book.xlmcrun"
    outcome = xlmc(
        "simulate", path, "-n", 5_000, "--html", page, "--json", result, "--extract", rows, "--save-run", kept
    )
    out = " ".join(outcome.out.split())
    assert "Each accepted trial counts with the chance that the evidence would keep it (weights)" in out
    assert "Weighted results leave out" in out
    data = json.loads(result.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8"))).validate(data)
    assert data["record"]["settings"]["evidence"] == "weights"
    assert data["sensitivity"] is None
    assert 0 < data["weights"]["effective_trials"] < data["trials"]["accepted"] == 5_000
    assert data["weights"]["effective_trials"] == data["record"]["counts"]["effective"]
    results = openpyxl.load_workbook(tmp_path / "book-results.xlsx")
    assert not {"Certainty", "Pairs", "Sensitivity", "Filter limits"} & set(results.sheetnames)
    assert "Weight" in [cell.value for row in results["Trials"].iter_rows(max_row=8) for cell in row]
    text = page.read_text(encoding="utf-8")
    assert 'id="sensitivity"' not in text
    assert "Weighted results leave out" in text
    heading, *lines = rows.read_text(encoding="utf-8").splitlines()
    assert heading == "Trial,a,b,Weight,Speed"
    weights, values = zip(*((float(w), float(v)) for *_, w, v in (line.split(",") for line in lines)), strict=True)
    mean = sum(w * v for w, v in zip(weights, values, strict=True)) / sum(weights)
    assert mean == pytest.approx(data["forecasts"][0]["statistics"]["mean"]["value"])
    for repeated in (tmp_path / "book-results.xlsx", kept):
        assert "identical" in xlmc("replay", repeated).out


def test_the_way_evidence_is_used_is_an_option(xlmc, short_books, book, tmp_path):
    """Before the book's setting, which is none here; a run that was asked for weights says so and repeats."""
    path, result = book(EDR), tmp_path / "book.json"
    accepted = {}
    for way in ("rejection", "weights", "auto"):
        outcome = xlmc("simulate", path, "-n", 4_000, "--evidence", way, "--json", result, "--overwrite")
        assert outcome.code == 0, outcome.err
        data = json.loads(result.read_text(encoding="utf-8"))
        accepted[way] = data["accepted"] if "accepted" in data else data["record"]["counts"]["accepted"]
        assert (data["weights"] is not None) == (way == "weights")
        assert way != "weights" or xlmc("replay", tmp_path / "book-results.xlsx").code == 0
    assert accepted["weights"] == 4_000 > accepted["rejection"] == accepted["auto"]
    refused = xlmc("simulate", path, "--evidence", "both")
    assert (refused.code, "'both' is not one of auto, rejection, weights" in refused.err) == (2, True)


def test_the_weights_of_trials_have_a_heading_of_their_own(xlmc, short_books, book, tmp_path):
    """An assumption may be called Weight, as vehicles have one."""
    path = book([*EDR[:2], 6.5, *EDR[3:]])
    made = openpyxl.load_workbook(path)
    made["Inputs"]["A2"] = "Weight"
    made.save(path)
    xlmc("simulate", path, "-n", 5_000, "--extract", tmp_path / "book.csv")
    heads = ["Trial", "Weight", "b", "Weight of the trial", "Speed"]
    assert (tmp_path / "book.csv").read_text(encoding="utf-8").splitlines()[0].split(",") == heads
    shown = openpyxl.load_workbook(tmp_path / "book-results.xlsx")["Trials"]
    row = next(row for row in shown.iter_rows(values_only=True) if row[0] == "Trial")
    assert [each for each in row if each] == ["Trial", "Weight", "b", "Speed (mph)", "Weight of the trial"]
