"""Whatever is printed is in the JSON of the same run, to the digits printed: every command, every output.

The book has a forecast of each kind, ranges given by formulas, and values from 1E-9 to 1E12. A number with an error,
`48,210 ± 870`, must be the value and the error of one estimate in the JSON; a number on a sheet must be one of the JSON
to the last bits. `NOT_OF_THE_RUN` lists the few that are not numbers of a run.
"""

from __future__ import annotations

import json
import re
import subprocess
from datetime import date, timedelta
from functools import cache
from html.parser import HTMLParser
from pathlib import Path

import docx
import numpy as np
import openpyxl
import pytest
from click.testing import CliRunner
from kinds_book import write_full_book
from workbook_files import add_tables

from xlmc.cli import xlmc
from xlmc.montecarlo.statistics import format_estimate

NUMBER = r"[\d,]+(?:\.\d+)?(?:e[+-]\d+)?"
WITH_ERROR = re.compile(
    rf"\((?P<far>{NUMBER}) ± (?P<far_error>{NUMBER})\)e(?P<power>[+-]\d+)|"
    rf"(?<![\d.,])(?P<value>{NUMBER})(?: ?%)? ± \$?(?P<error>{NUMBER})"
)
FACTORS = (1.0, 100.0, 24.0, 1440.0, 86_400.0)
"""What a number is multiplied by: shares in percent; of days hours, minutes and seconds."""

NOT_OF_THE_RUN = {
    *("Model", "Tables", "More"),  # of the book itself
    "Trials",  # each of them
    "Certainty",  # ranges that a reader types
    *("Bins", "Curves", "Numbers", "Chart data"),  # what charts draw
    "Record",  # settings
    "Lost to errors in cells",  # the bound of a share that JSON gives as a count
}
"""Sheets, and rows by their first cell, that have other numbers than those of JSON."""


COMMANDS = {
    "simulate": ["simulate", "{filtered}", "-n", "2000", "--scenarios"],
    "simulate without filters": ["simulate", "{plain}", "-n", "2000", "--sampling", "lhs"],
    "compare": ["compare", "{plain}", "{filtered}", "-n", "2000", "--no-causes"],
    "screen": ["screen", "{filtered}", "-n", "1000"],
    "decide": ["decide", "{filtered}", "-n", "1000"],
    "uncertainty": [
        "uncertainty",
        "{filtered}",
        "--outer",
        "40",
        "--inner",
        "50",
        "--uncertain",
        "Cost in,Start,Share in",
    ],
    "stress": ["stress", "{filtered}", "-n", "2000"],
    "seek": ["seek", "{filtered}", "--cell", "Model!B11", "--to", "250000", "--by", "Model!B1"],
    "fit": ["fit", "{plain}!Model!H1:H40"],
    "stability": ["stability", "{filtered}", "-n", "1000"],
    "optimise": ["optimise", "{filtered}", "--maximise", "mean of Cost", "-n", "1000", "--runs", "5"],
    "verify": ["verify", "{filtered}"],
    "report": ["report", "{run}"],
    "methods": ["methods", "{filtered}", "--reference-trials", "4096", "-n", "1024", "--replicates", "2"],
}
WITHOUT_ERRORS = ("seek", "stability", "verify", "optimise")
"""Commands whose numbers are exact, or a few."""
ENDINGS = ("html", "pdf", "docx", "xlsx")


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    """The JSON of a command, and the texts of its outputs by ending; each command is run once."""
    folder = tmp_path_factory.mktemp("printed")
    books = {
        name: write_full_book(folder / f"{name}.xlsx", filtered=name == "filtered") for name in ("plain", "filtered")
    }

    books["run"] = str(folder / "kept.xlsx")
    kept = CliRunner().invoke(xlmc, ["simulate", books["filtered"], "-n", "2000", "-o", books["run"]])
    assert kept.exit_code == 0, kept.output

    @cache
    def run(command):
        stem = folder / command.replace(" ", "-")
        files = [f"{stem}.{ending}" for ending in ("json", *ENDINGS)]
        words = [each.format(**books) for each in COMMANDS[command]]
        outputs = [part for each in files for part in ("-o", each)]
        result = CliRunner().invoke(xlmc, ["--quiet", *words, *outputs], env={"COLUMNS": "200"})
        assert result.exit_code in (0, 1), result.output
        texts = {ending: text_of(Path(f"{stem}.{ending}")) for ending in ENDINGS[:-1]}
        texts["tables"] = text_of(Path(f"{stem}.html"), ("script", "style", "svg", "nav"))
        document = json.loads(Path(files[0]).read_text(encoding="utf-8"))
        return document, texts | {"terminal": result.output}, Path(f"{stem}.xlsx")

    return run


class _Words(HTMLParser):
    """The words of a page that a reader sees."""

    def __init__(self, unseen):
        super().__init__()
        self.words, self._hidden, self._unseen = [], 0, unseen

    def handle_starttag(self, tag, attrs):
        self._hidden += tag in self._unseen

    def handle_endtag(self, tag):
        self._hidden -= tag in self._unseen

    def handle_data(self, data):
        if not self._hidden:
            self.words.append(data)


def text_of(path, unseen=("script", "style")):
    """All that a file says; of a page without what stands in some elements."""
    if path.suffix == ".pdf":
        command = ["pdftotext", "-raw", path, "-"]
        return subprocess.run(command, capture_output=True, check=True, encoding="utf-8").stdout
    if path.suffix == ".html":
        words = _Words(unseen)
        words.feed(path.read_text(encoding="utf-8"))
        return " ".join(words.words)
    document = docx.Document(str(path))
    cells = (cell.text for table in document.tables for row in table.rows for cell in row.cells)
    return "\n".join([*(each.text for each in document.paragraphs), *cells])


def estimates_in(value):
    """Yield the value and the error of each estimate in a document."""
    if isinstance(value, dict):
        result = value.get("value", value.get("rms"))  # root mean squares of `methods` have errors, too
        if isinstance(result, int | float) and isinstance(value.get("error"), int | float):
            yield float(result), float(value["error"])
        for name, error in value.get("standard_errors", {}).items():
            yield value["parameters"][name], float("nan") if error is None else error
        for each in value.values():
            yield from estimates_in(each)
    elif isinstance(value, list):
        for each in value:
            yield from estimates_in(each)


def numbers_in(value):
    """Yield all numbers of a document."""
    if isinstance(value, dict | list):
        for each in value.values() if isinstance(value, dict) else value:
            yield from numbers_in(each)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield float(value)


def read(text, power):
    """Read a printed number: itself, and half a unit of its last digit, zeros before the point not being digits."""
    mantissa, _, exponent = text.replace(",", "").partition("e")
    decimals = len(mantissa.partition(".")[2])
    zeros = 0 if decimals else len(mantissa) - len(mantissa.rstrip("0") or "0")
    scale = 10.0 ** (int(exponent or 0) + int(power or 0))
    return float(mantissa) * scale, 0.5001 * scale * 10.0 ** (zeros - decimals)


MOMENT = re.compile(r"(?:(?P<day>\d{4}-\d\d-\d\d)|(?P<hours>\d+):(?P<minutes>\d\d)) ± (?P<error>[\d.,]+) ")


def told(text):
    """Yield each number with an error that a text tells: the two, half a unit of each, the words, and in what units
    the error may be, beside those of the number.

    A day is told without its time, and a time without its seconds.
    """
    text = re.sub(r"\s+", " ", text)
    for result in MOMENT.finditer(text):
        if result["day"]:
            value, unit = float((date.fromisoformat(result["day"]) - date(1899, 12, 30)).days), 1.0
        else:
            value, unit = (int(result["hours"]) + int(result["minutes"]) / 60.0) / 24.0, 1.0 / 1440.0
        yield value + unit / 2.0, unit / 2.0 + 1e-5, *read(result["error"], None), result[0], FACTORS
    text = MOMENT.sub(" ", text)
    for result in WITH_ERROR.finditer(text):
        power = result["power"]
        if power is None and result[0].find("%") < 0 and text[result.start() - 1 : result.start()] == "(":
            continue  # a line of a narrow column, whose power of ten stands in the next
        value, half = read(result["value"] or result["far"], power)
        error, half_error = read(result["error"] or result["far_error"], power)
        if not value:  # a zero has no digits that say how it was rounded: it was as its error was
            half = max(half, half_error)
        yield value, half, error, half_error, result[0], (1.0,)


@pytest.mark.parametrize("output", ["terminal", "html", "pdf", "docx"])
@pytest.mark.parametrize("command", list(COMMANDS))  # errors in % of ranges
def test_a_number_with_its_error_is_an_estimate_of_the_json(printed, command, output):
    document, texts, _ = printed(command)
    known = np.array(list(estimates_in(document))).reshape(-1, 2)
    values, errors = np.concatenate([known * factor for factor in FACTORS]).T
    lost = []
    for value, half, error, half_error, words, units in told(texts[output]):
        at_value = np.abs(np.abs(values) - value) <= half + 1e-9 * value
        at_error = [np.abs(unit * errors - error) <= half_error + 1e-9 * error for unit in units]
        if not np.any(at_value & np.any(at_error, axis=0)):
            lost.append(words)
    assert not lost
    assert command in WITHOUT_ERRORS or texts[output].count("±") > 5


DATE = re.compile(r"\d{4}-\d\d-\d\d(?: \d\d:\d\d)?|\d+:\d\d(?::\d\d)?")
ALONE = re.compile(r"(?<![\w.,:/!-])(\d[\d,]*(?:\.\d+)?(?:e[+-]\d+)?)(?![\w.]*[A-Za-z_/:!])(?!\.\d)")
"""A number that stands alone, and is no part of a word, a version or a cell."""
OF_THE_RECORD = ("Every number is in full", "What the numbers depend on", "How to repeat")
WORDS = {"99.9"}
"""Numbers of sentences: "more than 99.9 % confidence"."""


def strings_in(value):
    """Yield all texts of a document, the keys among them."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | list):
        for each in [*value, *value.values()] if isinstance(value, dict) else value:
            yield from strings_in(each)


def without_certainty(text):
    """Leave out the page's table of ranges, whose ends are rounded: the trials in these are counted for it alone."""
    before, result, after = text.partition("The share of the accepted trials below")
    return before + after[max(after.find("Forecasts two at a time"), 0) :] if result else text


@pytest.mark.parametrize("output", ["terminal", "tables", "docx"])
@pytest.mark.parametrize("command", list(COMMANDS))
def test_every_number_is_one_of_the_json(printed, command, output):
    """Also one without an error: a base case, a threshold, a percentile's end, a count, a tolerance."""
    document, texts, _ = printed(command)
    message = [read(each[1], None)[0] for text in strings_in(document) for each in ALONE.finditer(text)]
    result = np.array([*numbers_in(document), *derived(document)])
    known = np.sort(np.abs(np.concatenate([np.outer(result, FACTORS).ravel(), message])))
    text = without_certainty(re.sub(r"\s+", " ", texts[output]))
    for words in OF_THE_RECORD:
        text = text.partition(words)[0]
    text = WITH_ERROR.sub(" ", DATE.sub(" ", text))
    lost = []
    for each in ALONE.finditer(text):
        value, half = read(each[1], None)
        half *= 2.0 if re.search(r"at (most|least) $", text[: each.start()]) else 1.0  # bounds are rounded outwards
        small = value <= 100.0 and "." not in each[1]  # "the 51 % range", "3 runs"
        if not (small or each[1] in WORDS or is_close(value, known, half + 1e-9 * value)):
            lost.append(text[max(0, each.start() - 50) : each.end() + 20])
    assert lost == []


NOISE = re.compile(
    r"\d(?:\.\d+)?e\+(?:0\d|1[01])\b"  # a power of ten of a number that people write without
    r"|(?<![\d.e])\d+\.\d{13,}"  # more digits than a number has
)


@pytest.mark.parametrize("output", ["terminal", "html", "pdf", "docx"])
@pytest.mark.parametrize("command", COMMANDS)
def test_no_number_is_noise(printed, command, output):
    _, texts, _ = printed(command)
    text = texts[output].partition("SHA-256 of every")[0].partition("Every number is in full")[0]  # Record
    result = [text[max(0, each.start() - 40) : each.end() + 20] for each in NOISE.finditer(text)]
    assert result == []


@pytest.mark.parametrize("output", ["terminal", "html", "pdf", "docx"])
@pytest.mark.parametrize("command", ["simulate", "simulate without filters", "report"])
def test_both_ends_of_a_range_have_the_same_decimals(printed, command, output):
    _, texts, _ = printed(command)
    text = re.sub(r"\s+", " ", texts[output])
    ranges = re.findall(rf"\bbetween [$]?({NUMBER})(?: EUR| %)? and [$]?({NUMBER})", text)
    ranges += re.findall(rf"({NUMBER}) ± {NUMBER}(?: EUR| %)? to [$]?({NUMBER}) ± ", text)
    assert ranges
    assert [each for each in ranges if len(each[0].partition(".")[2]) != len(each[1].partition(".")[2])] == []


def derived(document):
    """Yield the numbers of sheets that follow from those of the JSON."""
    best = min((each["aic"] for each in document.get("fits", ())), default=0.0)
    yield from (each["aic"] - best for each in document.get("fits", ()))
    if "methods" in document:
        share = document["reference"]["acceptance"]["value"]
        runs = [each for method in document["methods"] for each in method["runs"]]
        yield from (each["acceptance_error"] / share for each in runs if each["acceptance_error"] is not None)
        yield document["reference"]["acceptance"]["error"] / share
    if "sensitivity" not in document:
        return
    for each in document["sensitivity"]["forecasts"]:
        answers = (answer for bar in each["bars"] for answer in bar["answers"] if answer is not None)
        yield from (answer - (each["base"] or 0.0) for answer in answers)
    for limit in document["sensitivity"]["filter_limits"]:
        now = next(point["answers"] for point in limit["points"] if point["limit"] == limit["limit"])
        widths = {each["forecast"]: each["high"]["value"] - each["low"]["value"] for each in now}
        for answer in (answer for point in limit["points"] for answer in point["answers"]):
            width = widths[answer["forecast"]]
            yield from (answer["change"][key] / width for key in ("value", "error") if width)
    for each in document["forecasts"]:
        yield from (round(text["share"]["value"] * document["trials"]["accepted"]) for text in each["categories"])


def is_close(number, known, half):
    """Whether a number is one of `(n,)` ascending known ones, half a unit of its last digit or less apart."""
    at = known.searchsorted([abs(number) - half, abs(number) + half])
    return at[0] < at[1]


@pytest.mark.parametrize("command", list(COMMANDS))
def test_a_number_on_a_sheet_is_a_number_of_the_json(printed, command):
    """Those of result sheets to the last bits, those of studies, which are texts made numbers, to their digits."""
    document, _, path = printed(command)
    is_run = command.startswith(("simulate", "report"))
    result = [*numbers_in(document), *derived(document)]
    factors = (1.0,) if is_run else FACTORS
    known = np.sort(np.abs(np.outer(result, factors)).ravel())
    lost = []
    for sheet in openpyxl.load_workbook(path):
        for row in sheet.iter_rows() if sheet.title not in NOT_OF_THE_RUN else ():
            if row[0].value in NOT_OF_THE_RUN:
                continue
            for cell in row:
                if isinstance(cell.value, int | float) and not isinstance(cell.value, bool):
                    half = max(1e-11 * abs(cell.value), 0.0 if is_run else read(repr(abs(cell.value)), None)[1])
                    if not is_close(cell.value, known, half + 1e-300):
                        lost.append((sheet.title, cell.coordinate, cell.value))
    assert not lost


def test_an_assumption_that_is_a_date_is_told_as_one(printed):
    document, texts, path = printed("simulate")
    start = next(each for each in document["assumptions"] if each["name"] == "Start")
    assert start["parameters"] == "Low 2025-12-09, High 2026-06-27"
    for text in (*texts.values(), xlmc_check(path.parent / "filtered.xlsx")):
        assert "46,000" not in text
    mean = date(1899, 12, 30) + timedelta(days=int(start["accepted"]["mean"]["value"]))
    assert all(f"{mean} ± " in re.sub(r"\s+", " ", texts[ending]) for ending in ("html", "pdf", "docx"))


def test_assumptions_that_are_percentages_and_money_are_told_as_such(printed):
    document, texts, path = printed("simulate")
    share = next(each for each in document["assumptions"] if each["name"] == "Share in")
    assert share["parameters"] == "Low 30 %, High 50 %"
    for text in (*texts.values(), xlmc_check(path.parent / "filtered.xlsx")):
        assert not re.search(r"Low 0\.3\b", text)
    mean = share["accepted"]["mean"]
    messages = format_estimate(100.0 * mean["value"], 100.0 * mean["error"])
    assert all(f"{messages} %" in re.sub(r"\s+", " ", texts[ending]) for ending in ("html", "pdf", "docx"))
    (row,) = [
        [cell.number_format for cell in row]
        for row in openpyxl.load_workbook(path)["Sensitivity"].iter_rows()
        if row[0].value == "Share in" and row[2].value == 0.4
    ][:1]
    assert "%" in row[2]


def test_calculated_cells_are_told_in_their_formats(printed):
    _, _, path = printed("simulate")
    book = str(path.parent / "filtered.xlsx")
    words = ["calculate", book, "--cells", "Model!B10:B21"]
    result = CliRunner().invoke(xlmc, [*words, "--number-style", "1.234,5"], env={"COLUMNS": "200"})
    shown = dict(line.split(maxsplit=1) for line in result.output.splitlines() if "Model!" in line)
    exact = json.loads(CliRunner().invoke(xlmc, [*words, "--json"]).output)
    assert shown["Model!B12"].strip() == str(date(1899, 12, 30) + timedelta(days=exact["Model!B12"]))
    assert shown["Model!B13"].strip() == f"{100 * exact['Model!B13']:.6g} %".replace(".", ",")
    assert shown["Model!B11"].strip() == f"${exact['Model!B11']:,.0f}".replace(",", ".")
    assert "e+" not in result.output


def printed_by(*words):
    """What a command prints on a wide terminal, in lines whose columns stand one space apart."""
    result = CliRunner().invoke(xlmc, list(map(str, words)), env={"COLUMNS": "200"})
    assert result.exit_code in (0, 1), result.output
    return "\n".join(re.sub(r" {2,}", " ", line).strip() for line in result.output.splitlines())


def test_check_says_of_definitions_what_the_json_of_a_run_says(printed):
    document, _, path = printed("simulate")
    messages = printed_by("check", path.parent / "filtered.xlsx")
    for each in document["assumptions"]:
        assert f"{each['distribution']}: {each['parameters']}" in messages
    for each in (*document["filters"], *document["scenarios"][1:]):
        assert f"{each['name']} {each.get('changes', '')}" in messages
        assert each.get("limits", "") in messages
    changes = {each["name"]: each["changes"] for each in document["scenarios"]}
    assert changes["dearer"] == "Cost in High = $300,000; Model!B31 = $5.50; Share in from 35 % to 45 %"
    assert changes["known"] == "Share in = 45 %; Limit at most 38"
    assert "Order Model!B30 pieces 20; 40" in messages
    assert "Price Model!B31 $5; $6" in messages


def test_scenario_shows_cells_in_their_formats(printed):
    messages = printed_by("scenario", printed("simulate")[2].parent / "filtered.xlsx", "cheap")
    assert "Model!B31 $5 $4" in messages


def test_limits_of_filters_are_written_as_their_cells(tmp_path):
    book = openpyxl.load_workbook(write_full_book(tmp_path / "book.xlsx", filtered=True))
    limits = [["Name", "Cell", "At least"], ["Late", "=Model!B12", 46_100], ["Share", "=Model!B13", 0.28]]
    limits += [["Dear", "=Model!B11", "=Model!B3*1.2"]]
    del book["Tables"].tables["xlmc_filters"], book["More"].tables["xlmc_scenarios"]
    add_tables(book.create_sheet("Limits"), {"xlmc_filters": limits})
    book.save(tmp_path / "book.xlsx")
    messages = printed_by("check", tmp_path / "book.xlsx")
    assert "at least 2026-03-19" in messages
    assert "at least 28 %" in messages
    assert "at least $216,000 (=Model!B3*1.2)" in messages


def test_prepare_shows_cells_in_their_formats(tmp_path):
    book = openpyxl.load_workbook(write_full_book(tmp_path / "book.xlsx", filtered=False))
    for name in ("Tables", "More"):
        del book[name]
    book.save(tmp_path / "book.xlsx")
    messages = printed_by("prepare", tmp_path / "book.xlsx", "--assumption", "Model!B1:B7", "--number-style", "1.234,5")
    for cell, shown in {"B2": "$200.000", "B4": "2e-09", "B5": "3", "B6": "2026-03-01", "B7": "40 %"}.items():
        assert f" Model!{cell} {shown}" in messages


def test_replay_tells_numbers_that_its_json_has(printed):
    _, _, path = printed("simulate")
    book = openpyxl.load_workbook(path)
    edited = {}
    for sheet, row in (("Results", 12), ("Statistics", 8)):
        cells = [cell for line in book[sheet].iter_rows(min_row=row) for cell in line]
        cell = next(cell for cell in cells if isinstance(cell.value, float) and cell.value % 1.0)
        cell.value = edited[f"{sheet}!{cell.coordinate}"] = round(1.5 * cell.value, 3)
    changed = path.with_name("changed.xlsx")
    book.save(changed)
    messages = printed_by("replay", changed, "--quiet")
    result = CliRunner().invoke(xlmc, ["replay", str(changed), "--quiet", "--json"])
    differences = json.loads(result.output)["result_sheets"]["differences"]
    assert edited.items() <= {each["where"]: each["says"] for each in differences}.items()
    for each in (each for each in differences[:20] if isinstance(each["says"], float)):  # others openpyxl has changed
        assert f"{each['where']} says {each['says']!r}, the run gives {each['gives']!r}" in messages


def test_convert_counts_the_rows_that_its_tables_have(tmp_path):
    book = openpyxl.Workbook()
    sheet = book.active
    for row, call in enumerate(("RiskUniform(1E-9,3E-9)", "RiskNormal(1E12,1E11)", "RiskUniform(0.3,0.5)"), 1):
        sheet.cell(row, 1, f"name {row}")
        sheet.cell(row, 2, f"={call}").number_format = "0.0%" if row == 3 else "General"
    sheet["A4"], sheet["B4"] = "answer", "=RiskOutput()+B1*B2*B3"
    book.save(tmp_path / "calls.xlsx")
    messages = printed_by("convert", tmp_path / "calls.xlsx", "-o", tmp_path / "tables.xlsx")
    converted = openpyxl.load_workbook(tmp_path / "tables.xlsx")
    tables = {name: ref for each in converted for name, ref in each.tables.items()}
    for kind, rows in (("xlmc_assumptions", 3), ("xlmc_forecasts", 1)):
        assert f"{kind} {rows}" in messages
        first, last = (int(re.sub(r"\D", "", end)) for end in tables[kind].split(":"))
        assert last - first == rows
    for book in ("calls.xlsx", "tables.xlsx"):
        result = printed_by("check", tmp_path / book)
        assert "Low 1e-09, High 3e-09" in result
        assert "Mean 1,000,000,000,000, Std dev 100,000,000,000" in result
        assert "Low 30 %, High 50 %" in result


def xlmc_check(book):
    """What `xlmc check` prints."""
    return CliRunner().invoke(xlmc, ["check", str(book)], env={"COLUMNS": "200"}).output
