"""One forecast of each kind, with and without a filter: outputs print the numbers of the JSON, each in its form."""

from __future__ import annotations

import json
import re
import subprocess
from datetime import date, timedelta
from functools import cache
from pathlib import Path

import docx
import numpy as np
import openpyxl
import pytest
from click.testing import CliRunner
from kinds_book import FORECASTS, write_book
from openpyxl.worksheet.table import Table
from workbook_files import add_tables

from xlmc.analysis.results.saved import open_run
from xlmc.analysis.studies.methods import STATISTICS, recommendation, study
from xlmc.analysis.studies.scenario_answers import scenario_answers
from xlmc.api import load
from xlmc.cli import xlmc
from xlmc.montecarlo.model.loading import load as load_model
from xlmc.montecarlo.statistics import format_estimate
from xlmc.outputs.document.content.answers import answer_tables
from xlmc.outputs.document.parts import cell_text
from xlmc.outputs.live.frames import frame_of
from xlmc.outputs.methods.methods_json import study_json
from xlmc.outputs.methods.methods_tables import bounds_table, forecast_table, reference_table
from xlmc.outputs.summary import mean_heading, summarise, summary_text

KINDS = {
    "Speed": "number",
    "Cost": "currency",
    "End": "date or time",
    "Rate": "percent",
    "Events": "whole number",
    "Avoided": "yes/no",
    "Never": "yes/no",
    "Verdict": "category",
    "Tiny": "number",
    "Huge": "number",
    "Duration": "date or time",
    "Fixed": "currency",
}


@pytest.fixture(scope="module", params=[False, True], ids=["no-filters", "filters"])
def outputs(request, tmp_path_factory):
    """The run, its JSON, and where its other outputs are."""
    folder = tmp_path_factory.mktemp("kinds")
    run = load(write_book(folder / "book.xlsx", filtered=request.param)).simulate()
    run.save(folder / "out.xlsx")
    run.save_json(folder / "out.json")
    run.save_page(folder / "out.html")
    run.save_report(folder / "out.pdf")
    run.save_report(folder / "out.docx")
    run.keep(folder / "out.xlmcrun")
    run.extract(folder / "out.csv")
    return run, json.loads((folder / "out.json").read_text(encoding="utf-8")), folder


def text_of(path):
    """All that a PDF or Word file says, without its blanks."""
    if path.suffix == ".pdf":
        result = subprocess.run(["pdftotext", path, "-"], capture_output=True, check=True, encoding="utf-8").stdout
    else:
        document = docx.Document(str(path))
        cells = (cell.text for table in document.tables for row in table.rows for cell in row.cells)
        result = "\n".join([*(each.text for each in document.paragraphs), *cells])
    return re.sub(r"\s+", "", result)


def forecast(document, name):
    return next(each for each in document["forecasts"] if each["name"] == name)


def test_each_forecast_knows_its_kind(outputs):
    run, document, folder = outputs
    assert {each["name"]: each["kind"] for each in document["forecasts"]} == KINDS
    assert {name: result.kind.value for name, result in run.results.items()} == KINDS
    again = open_run(folder / "out.xlmcrun")
    assert {name: result.kind.value for name, result in again.results.items()} == KINDS


def test_texts_are_answers_and_not_lost(outputs):
    run, document, folder = outputs
    shares = {each["text"]: each["share"]["value"] for each in forecast(document, "Verdict")["categories"]}
    speeds = run.inputs["Speed in"]
    assert shares["low"] == pytest.approx((speeds < 28).mean())
    assert shares["high"] == pytest.approx((speeds >= 36).mean())
    assert sum(shares.values()) == pytest.approx(1.0)
    assert document["trials"]["lost_to_errors"] == 0
    assert not forecast(document, "Verdict")["without_number"]
    frame = run.frame()
    assert (frame["Verdict"] == "low").mean() == pytest.approx(shares["low"])
    assert forecast(document, "Verdict")["base_case"] == "middle"
    again = open_run(folder / "out.xlmcrun")
    assert {text: share.value for text, share in again["Verdict"].categories.items()} == shares
    lines = (folder / "out.csv").read_text(encoding="utf-8").splitlines()
    column = lines[0].split(",").index("Verdict")
    assert {line.split(",")[column] for line in lines[1:]} == {"low", "middle", "high"}


def test_certainties_of_counted_answers_are_their_shares(outputs):
    _, document, folder = outputs
    assert not forecast(document, "Avoided")["certainties"]
    rows = [[*row] for row in openpyxl.load_workbook(folder / "out.xlsx")["Certainty"].iter_rows(values_only=True)]
    for name, labels in (("Avoided", ["yes", "no"]), ("Verdict", None)):
        messages = forecast(document, name)
        shares = {each["text"]: each["share"]["value"] for each in messages["categories"]} or {
            "yes": messages["yes"]["value"],
            "no": 1.0 - messages["yes"]["value"],
        }
        result = {row[1]: row[3] for row in rows if row[0] == name}
        assert result == pytest.approx(shares)
        assert [*result] == (labels or [*shares])


def test_pairs_have_limits_in_the_form_of_their_cells(outputs):
    run, document, folder = outputs
    yes = [each for each in document["pairs"] if each["second"] == "Avoided" and each["first"] == "Speed"]
    both = np.mean((run.forecasts["Avoided"] == 1.0) & (run.forecasts["Speed"] > 100.0))
    assert yes[0]["both_above"]["value"] == pytest.approx(both)
    sheet = openpyxl.load_workbook(folder / "out.xlsx")["Pairs"]
    message = {cell.value for row in sheet.iter_rows() for cell in row if isinstance(cell.value, str)}
    assert {"Avoided, yes", "Cost, threshold $260,000", "End, threshold 2026-06-07"} <= message


NUMBER = r"-?[\d,]+(?:\.\d+)?(?:e[+-]\d+)?"


def numbers_in(text):
    """The value and the error of `$48,210 ± 870`, `5.44 ± 0.32 %` and `(2.3 ± 0.1)e-09`; one unit of the last digit."""
    power = re.search(r"\)e([+-]\d+)", text)
    scale = 10.0 ** int(power[1]) if power else 0.01 if text.endswith("%") else 1.0
    plain = [result.replace(",", "") for result in re.findall(NUMBER, text.replace("(", "").partition(")e")[0])]
    decimals = len(plain[-1].partition(".")[2])
    zeros = min(len(each) - len(each.rstrip("0")) for each in plain) if not decimals else 0
    return [float(each) * scale for each in plain], scale * 10.0 ** (zeros - decimals)


def check(text, value, error):
    result, unit = numbers_in(text)
    assert result[0] == pytest.approx(value, abs=0.5001 * unit), text
    assert result[1] == pytest.approx(error, abs=0.5001 * unit), text


def table(run):
    headings, rows = summary_text(summarise(run._run))
    return {row[0]: dict(zip(headings, row, strict=True)) for row in rows}


@pytest.mark.parametrize("name", ["Speed", "Cost", "Rate", "Events", "Tiny", "Huge", "Fixed"])
def test_the_table_prints_the_json_to_its_digits(outputs, name):
    run, document, _ = outputs
    messages, row = forecast(document, name), table(run)[name]
    mean, spread = messages["statistics"]["mean"], messages["statistics"]["standard_deviation"]
    check(row["Mean or share"], mean["value"], mean["error"])
    check(row["SD"], spread["value"], spread["error"])
    ends = next(row[key] for key in row if key.endswith("range")).split(" to ")
    for text, end in zip(ends, ("low", "high"), strict=True):
        if " ± " in text:
            check(text, messages["central_range"][end]["value"], messages["central_range"][end]["error"])
    decimals = {len(text.partition(" ")[0].partition(".")[2]) for text in ends}
    assert len(decimals) == 1  # both ends of a range have the same
    assert not re.search(r"\de\+(0\d|1[01])\b", " ".join(row.values()))


def test_dates_are_dates(outputs):
    run, document, folder = outputs
    messages, row = forecast(document, "End"), table(run)["End"]
    day = date(1899, 12, 30) + timedelta(days=int(messages["statistics"]["mean"]["value"]))
    assert row["Mean or share"].startswith(f"{day} ± ")
    assert row["SD"].endswith(" days")
    assert row["Base case"] == "2026-05-30"
    assert row["Threshold"] == "2026-06-07"
    message = next(each for each in run.sentences if each.startswith("End: "))
    assert re.search(r"between 2026-\d\d-\d\d and 2026-\d\d-\d\d$", message)
    assert table(run)["Duration"]["Base case"] == "3:00"
    for text in ((folder / "out.html").read_text(encoding="utf-8"), *map(text_of, sorted(folder.glob("out.[pd]*")))):
        assert str(day) in text
        assert "P(End&gt;2026-06-07)" in re.sub(r"\s+", "", text).replace("(End>", "(End&gt;")


def test_yes_and_no_are_shares_with_exact_bounds(outputs):
    run, document, _ = outputs
    rows = table(run)
    assert rows["Avoided"]["SD"] == rows["Never"]["SD"] == ""
    trials = document["trials"]["accepted"]
    assert forecast(document, "Never")["yes"]["value"] == 0.0
    assert rows["Never"]["Mean or share"].startswith("0 %, at most 0.")
    assert f"Never: yes in 0 of {trials:,} trials; at most" in "\n".join(run.sentences)


def test_every_output_gives_the_shares_of_texts(outputs):
    _, document, folder = outputs
    shares = {each["text"]: each["share"] for each in forecast(document, "Verdict")["categories"]}
    texts = [(folder / "out.html").read_text(encoding="utf-8"), *map(text_of, sorted(folder.glob("out.[pd]*")))]
    for share in shares.values():
        shown = f"{100 * share['value']:.2f} ± {100 * share['error']:.2f}"
        assert all(shown.replace(" ", "") in re.sub(r"\s+", "", text) for text in texts), shown
    rows = openpyxl.load_workbook(folder / "out.xlsx")["Results"].iter_rows(values_only=True)
    sheet = {row[0]: row[2] for row in rows if row[0] in shares}
    assert sheet == {t: each["value"] for t, each in shares.items()}


def test_cells_have_the_formats_of_their_kinds(outputs):
    _, _, folder = outputs
    rows = openpyxl.load_workbook(folder / "out.xlsx")["Results"].iter_rows()
    formats = {}
    for row in rows:
        formats.setdefault(row[0].value, row[3].number_format)  # of the first table, the answers
    assert formats["End"] == "yyyy-mm-dd"
    assert formats["Cost"].startswith('"$"#,##0')
    assert formats["Rate"].endswith("%")
    assert formats["Fixed"].endswith('" EUR"')
    assert "E" not in formats["Huge"]


def test_the_window_has_forms_and_shares(outputs):
    run, _, _ = outputs
    charts = frame_of(run._run, None, list(FORECASTS), None, moving=False, fits=False)["forecasts"]
    assert charts["Rate"]["form"]["factor"] == 100.0
    assert charts["Cost"]["form"]["before"] == "$"
    assert charts["End"]["form"]["moment"] == "day"
    assert [label for label, *_ in charts["Verdict"]["shares"]] == [*run["Verdict"].categories]
    assert [label for label, *_ in charts["Avoided"]["shares"]] == ["yes", "no"]


def test_a_range_given_by_a_formula_stands_with_its_value(outputs):
    _, document, folder = outputs
    message = "Low 180,000 (=Model!B3), High 252,000 (=Model!B3*1.4)"
    assert document["assumptions"][1]["parameters"] == message
    book = openpyxl.load_workbook(folder / "out.xlsx")
    assert any(message in str(cell.value) for row in book["Assumptions"].iter_rows() for cell in row)
    assert message in (folder / "out.html").read_text(encoding="utf-8")
    for path in sorted(folder.glob("out.[pd]*")):
        assert message.replace(" ", "") in text_of(path)


def test_without_filters_nothing_stands_before_and_after(outputs):
    run, _, folder = outputs
    texts = [(folder / "out.html").read_text(encoding="utf-8"), *map(text_of, sorted(folder.glob("out.[pd]*")))]
    sheet = openpyxl.load_workbook(folder / "out.xlsx")["Assumptions"]
    texts.append("".join(str(cell.value) for row in sheet.iter_rows() for cell in row))
    filtered = bool(run.model.filters)
    assert all(("Filterskeeponly" in re.sub(r"\s+", "", text)) == filtered for text in texts)
    assert any(cell.value == "before" for row in sheet.iter_rows() for cell in row) == filtered


def test_the_column_kind_overrides(tmp_path):
    kinds = {"Speed": "currency", "Events": "category", "Avoided": "number", "Cost": "number"}
    run = load(write_book(tmp_path / "book.xlsx", filtered=False, kinds=kinds)).simulate(trials=500)
    assert {name: run[name].kind.value for name in kinds} == kinds
    assert {"1", "2", "3"} <= set(run["Events"].categories)
    assert "$" not in table(run)["Cost"]["Mean or share"]


@pytest.mark.parametrize("jobs", [1, 2])
@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_texts_are_numbered_alike_however_they_are_computed(tmp_path, jobs, engine):
    model = load(write_book(tmp_path / "book.xlsx", filtered=True))
    one, other = (
        model.simulate(trials=3_000),
        model.simulate(trials=3_000, jobs=jobs, engine=engine, scheduler="threads"),
    )
    assert one._run.labels == other._run.labels
    assert one.forecasts["Verdict"].tobytes() == other.forecasts["Verdict"].tobytes()


def test_a_book_of_texts_alone_has_a_workbook_though_no_mean_moves_with_its_limits(tmp_path):
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "Model"
    sheet["A1"], sheet["B1"] = 0.5, '=IF(A1>0.5,"high","low")'
    for name, rows in {
        "xlmc_assumptions": (["Name", "Cell", "Distribution", "Low", "High"], ["a", "=Model!A1", "Uniform", 0, 1]),
        "xlmc_forecasts": (["Name", "Cell"], ["Text", "=Model!B1"]),
        "xlmc_filters": (["Name", "Cell", "At least", "Because"], ["f", "=Model!A1", 0.2, "seen"]),
    }.items():
        at = book.create_sheet(name)
        for row in rows:
            at.append(row)
        at.add_table(Table(displayName=name, ref=at.dimensions))
    book.save(tmp_path / "texts.xlsx")
    run = load(tmp_path / "texts.xlsx").simulate(trials=400, seed=1)
    run.save(tmp_path / "texts-results.xlsx")
    limits = openpyxl.load_workbook(tmp_path / "texts-results.xlsx")["Filter limits"]
    assert any("at least 0.2" in str(row[0]) for row in limits.iter_rows(values_only=True))


@pytest.fixture(scope="module")
def studied(tmp_path_factory):
    """The text and the JSON of a study of the books with and without filters, made once for each command."""
    folder = tmp_path_factory.mktemp("studies")
    plain, filtered = (write_book(folder / name, filtered=name == "b.xlsx") for name in ("a.xlsx", "b.xlsx"))
    commands = {
        "compare": ["compare", str(plain), str(filtered), "--no-causes"],
        "screen": ["screen", str(filtered)],
    }

    @cache
    def run(name):
        names = [str(folder / f"{name}.{ending}") for ending in ("json", "html", "pdf", "docx", "xlsx")]
        files = [part for each in names for part in ("-o", each)]
        result = CliRunner().invoke(xlmc, [*commands[name], *files, "--quiet"])
        assert result.exit_code in (0, 1), result.output
        return re.sub(r"\s+", " ", result.output), json.loads(Path(names[0]).read_text(encoding="utf-8")), folder

    return run


def test_a_comparison_writes_every_forecast_in_its_form(studied):
    text, document, folder = studied("compare")
    result = {each["name"]: each for each in document["forecasts"]}
    assert "lost" not in text
    assert "is a number in none" not in text
    for name, before, after in (("Cost", "$", ""), ("Fixed", "", " EUR"), ("Rate", "", " %")):
        change, factor = result[name]["mean"], 100.0 if name == "Rate" else 1.0
        for key in ("first", "second", "difference"):
            shown = format_estimate(factor * abs(change[key]["value"]), factor * change[key]["error"])
            assert f"{'-' * (change[key]['value'] < 0)}{before}{shown}{after}" in text, (name, key)
    day = date(1899, 12, 30) + timedelta(days=int(result["End"]["mean"]["first"]["value"]))
    assert f"{day} ± " in text
    assert "P(> 2026-06-07)" in text
    assert not re.search(r"\b46[,.]?\d{3}\b", text)  # no serial number of a day
    for name, labels in (("Avoided", {"yes"}), ("Never", {"yes"}), ("Verdict", {"low", "middle", "high"})):
        assert set(result[name]["shares"]) == labels
        for each in result[name]["shares"].values():
            difference = each["difference"]
            assert format_estimate(100 * difference["value"], 100 * difference["error"]) in text
    assert result["Never"]["verdict"] == "within"
    assert result["Verdict"]["verdict"] == "beyond"
    page = re.sub(r"\s+", "", (folder / "compare.html").read_text(encoding="utf-8"))
    for other in (page, text_of(folder / "compare.pdf"), text_of(folder / "compare.docx")):
        assert f"{day}±" in other
        assert "P(middle),%" in other


def test_a_screening_judges_texts_and_dates_as_such(studied):
    _, document, folder = studied("screen")
    text = text_of(folder / "screen.docx")
    assert document["forecasts_without_numbers"] == []
    held = next(each for each in document["held_alone"] if each["names"] == ["Speed in"])["forecasts"]
    moved = held["Verdict"]["shares"]["high"]["difference"]
    shown = format_estimate(100 * moved["value"], 100 * moved["error"])
    assert f"{shown}points".replace(" ", "") in text
    assert "P(>2026-06-07)" in text
    assert not re.search(r"\b46[,.]?\d{3}\b", text)
    assert not re.search(r"\de\+", text)


def test_methods_write_every_forecast_in_its_form(tmp_path):
    model = load_model(write_book(tmp_path / "book.xlsx", filtered=True))
    result = study(model, reference_trials=4_096, trials=1_024, replicates=2, patience=0.2)
    messages = study_json(result)["reference"]["forecasts"]
    rows = {row[0]: row for row in reference_table(result).rows}
    assert "Verdict" not in rows
    assert any(each.endswith("texts: Verdict.") for each in recommendation(result))
    for name, factor in (("Cost", 1.0), ("Fixed", 1.0), ("Rate", 100.0), ("Speed", 1.0), ("Avoided", 100.0)):
        mean = messages[name]["mean"]
        assert format_estimate(factor * mean["value"], factor * mean["error"]) in rows[name][2], name
    day = date(1899, 12, 30) + timedelta(days=int(messages["End"]["mean"]["value"]))
    assert rows["End"][2].startswith(f"{day} ± ")
    assert rows["Avoided"][3:] == ("–",) * 3
    assert not any(result.converges("Avoided", each) for each in STATISTICS if each != "mean")
    written = [cell for each in (bounds_table(result), forecast_table(result)) for row in each.rows for cell in row]
    assert not any(re.search(r"\b46[,.]?\d{3}\b", cell) for cell in written)
    assert not any(re.search(r"\de\+", each) for each in recommendation(result))


def test_scenarios_compare_counted_answers_by_their_shares(tmp_path):
    """No trial says yes to Never, in the book and in the scenario: that does not prove that none can."""
    path = write_book(tmp_path / "book.xlsx", filtered=False)
    book = openpyxl.load_workbook(path)
    sheet = book.create_sheet("Scenarios")
    for row in (["Name", "Speed in High"], ["slower", 37]):
        sheet.append(row)
    sheet.add_table(Table(displayName="xlmc_scenarios", ref="A1:B2"))
    book.save(path)
    run = load(path).simulate(trials=1_000, scenarios=True)._run
    _, slower = scenario_answers(run)
    result = {each.forecast.name: each for each in slower.forecasts}
    assert result["Never"].differences["mean"].error > 0.0
    assert result["Verdict"].text == "middle"
    assert result["Verdict"].differences["mean"].error > 0.0
    assert result["Avoided"].differences["mean"].value > 0.0


def test_a_text_that_is_another_in_every_trial_fills_no_output(tmp_path):
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "Model"
    sheet["A1"], sheet["B1"], sheet["B2"] = "Cost", 5.0, '=IF(B1<0.5,"cheap",TEXT(B1,"0.000000"))'
    for row in (["Name", "Cell", "Distribution", "Low", "High"], ["Cost", "Model!B1", "Uniform", 0, 1]):
        sheet.append(row)
    sheet.append([])
    for row in (["Name", "Cell"], ["Label", "Model!B2"]):
        sheet.append(row)
    sheet.add_table(Table(displayName="xlmc_assumptions", ref="A3:E4"))
    sheet.add_table(Table(displayName="xlmc_forecasts", ref="A6:B7"))
    sheet["B1"] = 0.25
    book.save(tmp_path / "labels.xlsx")
    run = load(tmp_path / "labels.xlsx").simulate(trials=5_000)
    shares = run["Label"].categories
    left = 5_000 - sum(round(5_000 * share.value) for share in [*shares.values()][:20])
    message = f"{len(shares) - 20:,} rarer texts"
    run.save_page(tmp_path / "out.html")
    page = (tmp_path / "out.html").read_text(encoding="utf-8")
    assert message in page
    assert page.count("<tr") < 200
    for name in ("out.pdf", "out.docx"):
        run.save_report(tmp_path / name)
        text = text_of(tmp_path / name)
        assert message.replace(" ", "") in text, name
        assert len(text) < 20_000, name
    run.save(tmp_path / "out.xlsx")
    results = openpyxl.load_workbook(tmp_path / "out.xlsx")
    for name, column in (("Results", 1), ("Certainty", 2)):
        rows = [row for row in results[name].iter_rows(values_only=True) if row[column - 1] == message]
        assert [row[column] for row in rows] == [left], name
        assert results[name].max_row < 100, name


def test_shares_are_called_so_and_have_no_range(tmp_path):
    path = write_book(tmp_path / "book.xlsx", filtered=False)
    book = openpyxl.load_workbook(path)
    sheet = book["Tables"]
    sheet.tables.pop("xlmc_forecasts")
    rows = [["Name", "Cell", "Range %"], ["Speed", "=Model!B10", 80], ["Rate", "=Model!B13", None]]
    rows += [["Avoided", "=Model!B15", None], ["Verdict", "=Model!B17", None]]
    add_tables(book.create_sheet("Asked"), {"xlmc_forecasts": rows})
    book.save(path)
    run = load(path).simulate(trials=500)
    table = next(answer_tables(run._run))
    assert (table.heads[3], table.heads[-1]) == ("Mean or share", "Range holds")
    assert [cell_text(row[-1]) for row in table.rows] == ["80 %", "51 %", "–", "–"]
    rows = summarise(run._run)
    assert (mean_heading(rows[:2]), mean_heading(rows[2:]), mean_heading(rows)) == ("Mean", "Share", "Mean or share")
