"""`xlmc simulate --scenarios`, from the workbook to the terminal, the sheets, the page, JSON and the record."""

from __future__ import annotations

import json
import shutil
from contextlib import closing
from pathlib import Path

import jsonschema
import openpyxl
import pytest
from openpyxl.worksheet.table import Table

from xlmc.outputs.json_document import SCHEMA

pytestmark = pytest.mark.usefixtures("short_books")

ROWS = [
    ["Name", "Note", "width", "root", "Rate", "area Threshold"],
    ["narrow", "measured", "1.5 to 2"],
    ["held", None, 2.5],
    ["looser", None, None, "at most 1.5"],
    ["higher rate", None, None, None, 3, 22],
]


def with_scenarios(small_book, path, rows=ROWS):
    book = openpyxl.load_workbook(small_book)
    sheet = book.create_sheet("Other states")
    for row in rows:
        sheet.append(row)
    last = f"{chr(64 + len(rows[0]))}{len(rows)}"
    sheet.add_table(Table(displayName="xlmc_scenarios", ref=f"A1:{last}"))
    book.save(path)
    return path


@pytest.fixture(scope="module")
def original(small_book, tmp_path_factory):
    return with_scenarios(small_book, tmp_path_factory.mktemp("scenarios") / "book.xlsx")


@pytest.fixture
def book(original, tmp_path):
    return Path(shutil.copy(original, tmp_path / "book.xlsx"))


def shown(path):
    """Of the sheet Scenarios the rows, and of the workbook the names of its sheets."""
    with closing(openpyxl.load_workbook(path, read_only=True)) as results:
        rows = results["Scenarios"].iter_rows(values_only=True) if "Scenarios" in results.sheetnames else ()
        return [[*row] for row in rows], results.sheetnames


def lines_of(out, title):
    """The rows of a table of the terminal, as lists of words."""
    rows = f"\n{out}"[f"\n{out}".index(f"\n{title}\n") :].split("─\n", 1)[1].split("\n\n", 1)[0]
    return [line.split("  ") for line in rows.splitlines()]


def test_from_the_workbook_to_all_outputs(xlmc, book, tmp_path):
    plain = xlmc("simulate", book, "-o", tmp_path / "plain.xlsx")
    outputs = ("--html", tmp_path / "p.html", "--json", tmp_path / "r.json", "--save-run", tmp_path / "r.xlmcrun")
    outcome = xlmc("simulate", book, "--scenarios", *outputs)
    assert outcome.code == plain.code
    assert outcome.out.startswith(plain.out[: plain.out.index("± is the standard error")])
    names = ["as it is", "narrow", "held", "looser", "higher rate"]
    for title in ("Scenarios: what is changed, and how many trials are accepted", "area, ft²", "inverse"):
        assert [line[0].strip() for line in lines_of(outcome.out, title)] == names

    result = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8"))).validate(result)
    assert [each["name"] for each in result["scenarios"]] == [None, *names[1:]]
    base, narrow, held, looser, higher = result["scenarios"]
    assert (narrow["changes"], narrow["note"]) == ("width from 1.5 to 2", "measured")
    assert higher["changes"] == "Rate = 3; area Threshold = 22"
    assert looser["accepted"] > base["accepted"]
    for each in (narrow, held, looser, higher):
        for mine, theirs in zip(each["forecasts"], base["forecasts"], strict=True):
            gap = mine["mean"]["estimate"]["value"] - theirs["mean"]["estimate"]["value"]
            assert mine["mean"]["difference"]["value"] == pytest.approx(gap)
            assert theirs["mean"]["difference"] is None

    cells = shown(tmp_path / "book-results.xlsx")[0]
    assert [row[0] for row in cells if row and row[0] in names] == names * 3
    means = [row[1] for row in cells if row and row[0] == "narrow"]
    assert narrow["accepted"] in means
    assert narrow["forecasts"][0]["mean"]["estimate"]["value"] in means
    page = (tmp_path / "p.html").read_text(encoding="utf-8")
    assert '<section id="scenarios">' in page
    assert "width from 1.5 to 2" in page
    docx = pytest.importorskip("docx")
    report = ("--docx", tmp_path / "r.docx", "--sections", "scenarios", "--forecasts", "area")
    assert xlmc("report", tmp_path / "r.xlmcrun", *report).code == plain.code
    word = docx.Document(str(tmp_path / "r.docx"))
    changed, answers = ([[cell.text for cell in row.cells] for row in table.rows[1:]] for table in word.tables)
    assert [row[0] for row in changed] == [row[0] for row in answers] == names
    expected = "".join(outcome.out.split())
    assert all("".join("".join(row).split()) in expected for row in (*changed, *answers))
    assert any("Differences are those to the workbook as it is" in each.text for each in word.paragraphs)

    for kept in ("book-results.xlsx", "r.xlmcrun"):
        assert xlmc("replay", tmp_path / kept).code == 0
    xlmc("report", tmp_path / "r.xlmcrun", "-o", tmp_path / "again.xlsx")
    assert (tmp_path / "again.xlsx").read_bytes() == (tmp_path / "book-results.xlsx").read_bytes()


def test_a_number_edited_on_the_sheet_is_found(xlmc, book, tmp_path):
    xlmc("simulate", book, "--scenarios")
    path = tmp_path / "book-results.xlsx"
    results = openpyxl.load_workbook(path)
    sheet = results["Scenarios"]
    row = next(row for row in sheet.iter_rows() if row[0].value == "held")
    row[1].value += 1
    results.save(path)
    outcome = xlmc("replay", path)
    assert outcome.code == 1
    assert f"Scenarios!{row[1].coordinate}" in outcome.out


def test_check_shows_them_and_says_what_is_not_possible(xlmc, small_book, tmp_path):
    good = xlmc("check", with_scenarios(small_book, tmp_path / "good.xlsx"))
    assert lines_of(good.out, "Scenarios")[0][0].strip() == "narrow"
    bad = with_scenarios(small_book, tmp_path / "bad.xlsx", [ROWS[0], ["wrong", None, "2 to 1"]])
    message = "'Other states'!C2: In the scenario 'wrong': width: Low (2) is above High (1)"
    for outcome in (xlmc("check", bad), xlmc("scenario", bad)):
        assert outcome.code == 1
        assert message in outcome.err.replace("\n", " ")


@pytest.mark.parametrize("wrong", [1, 2, 3])
def test_an_impossible_scenario_is_a_row_that_says_why_and_the_others_have_their_answers(
    xlmc, small_book, tmp_path, wrong
):
    rows = [ROWS[0], *ROWS[1:3]]
    good = with_scenarios(small_book, tmp_path / "good.xlsx", rows)
    xlmc("simulate", good, "--scenarios", "--json", tmp_path / "good.json")
    bad = with_scenarios(small_book, tmp_path / "bad.xlsx", [*rows[:wrong], ["wrong", None, "2 to 1"], *rows[wrong:]])
    results, page, kept = (tmp_path / name for name in ("r.xlsx", "r.html", "r.xlmcrun"))
    outputs = ("--json", tmp_path / "bad.json", "-o", results, "--html", page, "--save-run", kept)
    outcome = xlmc("simulate", bad, "--scenarios", *outputs)
    assert outcome.code == 1
    why = f"'Other states'!C{wrong + 1}: In the scenario 'wrong': width: Low (2) is above High (1)"
    assert f"scenario 'wrong' is not possible: {why}" in outcome.err.replace("\n", " ")
    first, second = (json.loads((tmp_path / f"{name}.json").read_text(encoding="utf-8")) for name in ("good", "bad"))
    assert second["scenarios"] == first["scenarios"]
    assert list(second["impossible_scenarios"]) == ["wrong"]
    assert second["impossible_scenarios"]["wrong"].startswith(why)
    jsonschema.validate(second, json.loads(SCHEMA.read_text(encoding="utf-8")))
    (row,) = (row for row in shown(results)[0] if row and row[0] == "wrong")
    assert any(f"Not possible: {why}" in str(each) for each in row)
    assert "Not possible" in page.read_text(encoding="utf-8")
    assert xlmc("replay", results).code == 0
    docx = pytest.importorskip("docx")
    xlmc("report", kept, "--docx", tmp_path / "r.docx", "--sections", "scenarios")
    tables = docx.Document(str(tmp_path / "r.docx")).tables
    assert any("Not possible" in cell.text for table in tables for row in table.rows for cell in row.cells)


def test_a_workbook_without_scenarios(xlmc, small_book, tmp_path):
    outcome = xlmc("simulate", shutil.copy(small_book, tmp_path / "b.xlsx"), "--scenarios")
    assert outcome.code == 2
    assert "The workbook defines no scenario" in outcome.err
    assert "xlmc_scenarios" in outcome.err


def test_a_scenario_that_accepts_nothing_gives_exit_code_1(xlmc, small_book, tmp_path):
    none = with_scenarios(small_book, tmp_path / "b.xlsx", [ROWS[0], ["none", None, None, "at most -1"]])
    outcome = xlmc("simulate", none, "--scenarios")
    assert outcome.code == 1
    assert "scenario 'none': no trial was accepted" in outcome.err.replace("\n", " ")


def test_typing_a_scenario_into_a_workbook(xlmc, book, tmp_path):
    listed = xlmc("scenario", book)
    assert [line[0].strip() for line in lines_of(listed.out, "Scenarios")] == [
        "narrow",
        "held",
        "looser",
        "higher rate",
    ]
    before = book.read_bytes()
    shown = xlmc("scenario", book, "narrow")
    assert (shown.code, book.read_bytes()) == (0, before)
    for words in ("Inputs!C2", "Inputs!D2", "1.5", "Nothing was written"):
        assert words in shown.out
    copy = tmp_path / "copy.xlsx"
    assert xlmc("scenario", book, "NARROW", "-o", copy).code == 0
    assert "exists already" in xlmc("scenario", book, "narrow", "-o", copy).err
    inputs = openpyxl.load_workbook(copy)["Inputs"]
    assert [inputs["C2"].value, inputs["D2"].value] == [1.5, 2]
    run = json.loads(_json(xlmc, book, tmp_path, "--scenarios"))["scenarios"][1]
    own = json.loads(_json(xlmc, copy, tmp_path))
    assert run["accepted"] == own["trials"]["accepted"]
    assert run["forecasts"][0]["mean"]["estimate"] == own["forecasts"][0]["statistics"]["mean"]

    (tmp_path / "~$book.xlsx").touch()
    held = xlmc("scenario", book, "narrow", "--in-place")
    assert (held.code, book.read_bytes()) == (2, before)
    assert "Excel holds the workbook open" in held.err
    (tmp_path / "~$book.xlsx").unlink()
    assert xlmc("scenario", book, "narrow", "--in-place").code == 0
    assert "the workbook holds all of them already" in xlmc("scenario", book, "narrow").out


def _json(xlmc, book, tmp_path, *options):
    xlmc("simulate", book, *options, "--json", tmp_path / "x.json", "-o", tmp_path / "x.xlsx", "--overwrite")
    return (tmp_path / "x.json").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("nope",), "There is no scenario 'nope'"),
        (("held", "-o", "new.xlsx"), "needs a column Frozen for 'width'"),
        (("narrow", "-o", "new.xlsm"), "workbook must end in .xlsx"),
        (("narrow", "-o", "new.xlsx", "--in-place"), "cannot both be given"),
        (("--in-place",), "Which scenario?"),
    ],
)
def test_what_cannot_be_typed(xlmc, book, tmp_path, monkeypatch, arguments, message):
    monkeypatch.chdir(tmp_path)
    outcome = xlmc("scenario", book, *arguments)
    assert outcome.code == 2
    assert message in outcome.err.replace("\n", " ")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["book.xlsx"]


def test_ctrl_c_while_scenarios_are_run_keeps_the_run(xlmc, book, tmp_path, monkeypatch):
    from xlmc.analysis.studies import scenario_answers

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    xlmc("simulate", book, "-o", tmp_path / "plain.xlsx")
    monkeypatch.setattr(scenario_answers, "run_scenario", interrupted)
    outcome = xlmc("simulate", book, "--scenarios", "--json", tmp_path / "r.json")
    assert outcome.code == 130
    assert "interrupted before all scenarios were run" in outcome.err.replace("\n", " ")
    result = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))
    assert "scenarios" not in result
    assert shown(tmp_path / "book-results.xlsx")[1] == shown(tmp_path / "plain.xlsx")[1]


def test_another_threshold_of_a_scenario_is_told_and_differences_are_of_what_is_shown(xlmc, small_book, tmp_path):
    rows = [
        ["Name", "area Threshold", "inverse Threshold"],
        ["higher", 22],
        ["one more", None, 0.1],
        ["none", "none"],
    ]
    path = with_scenarios(small_book, tmp_path / "book.xlsx", rows)
    outcome = xlmc("simulate", path, "--scenarios", "--json", tmp_path / "r.json")
    assert outcome.out.count("Above threshold") == 2  # of the answers, and of the scenarios of area
    assert "Above 0.1" in outcome.out
    base, higher, more, none = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))["scenarios"]
    own, changed = base["forecasts"][0], higher["forecasts"][0]
    assert (changed["threshold"], none["forecasts"][0]["threshold"], none["forecasts"][0]["above"]["estimate"]) == (
        22,
        None,
        None,
    )
    gap = changed["above"]["estimate"]["value"] - own["above"]["estimate"]["value"]
    assert gap < -0.01
    assert changed["above"]["difference"]["value"] == pytest.approx(gap)
    assert more["forecasts"][1]["above"]["estimate"]["value"] > 0
    assert more["forecasts"][1]["above"]["difference"] is None
    expected = " ".join(outcome.out.split())
    assert f"Thresholds of 'area': 'as it is' {own['threshold']:g}, 'higher' 22, 'one more'" in expected
    assert "Thresholds of 'inverse': 'as it is' none, 'higher' none, 'one more' 0.1, 'none' none." in expected
    rows = shown(tmp_path / "book-results.xlsx")[0]
    (row,) = (row for row in rows if row and row[0] == "higher" and changed["above"]["estimate"]["value"] in row)
    assert row[15] == pytest.approx(gap)
