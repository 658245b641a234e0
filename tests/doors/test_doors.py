"""What is added through the doors of the house works everywhere: command line, settings, engines, sheets, docs."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import openpyxl
import pytest
from openpyxl.worksheet.table import Table

MADE_UP = Path(__file__).with_name("made_up.py")


def run(*arguments):
    """`xlmc ARGUMENTS` where the made-up things are there."""
    command = [sys.executable, str(MADE_UP), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8")
    assert not done.stderr, done.stderr
    return done


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A workbook whose distribution, sampling method and engine are the made-up ones."""
    place = tmp_path_factory.mktemp("doors")
    book = openpyxl.Workbook()
    sheet = book.active
    for row in (["Name", "Value", "Distribution", "Least of all", "Low", "High"],
                ["end", 2, "either-end", 1, None, 3], ["share", 0.5, "Uniform", None, 0, 1]):  # fmt: skip
        sheet.append(row)
    sheet["A6"], sheet["B6"], sheet["A7"], sheet["B7"] = "Name", "Value", "twice", "=2*B2"
    sheet["A8"], sheet["B8"] = "sum", "=B2+B3"
    sheet["A10"], sheet["B10"] = "Setting", "Value"
    for row, pair in enumerate((("Trials", 4000), ("Sampling", "Mirrored"), ("Engine", "slower")), 11):
        sheet.cell(row, 1, pair[0])
        sheet.cell(row, 2, pair[1])
    for name, ref in (("assumptions", "A1:F3"), ("forecasts", "A6:B8"), ("settings", "A10:B13")):
        sheet.add_table(Table(displayName=f"xlmc_{name}", ref=ref))
    book.save(place / "made-up.xlsx")
    return place


@pytest.fixture(scope="module")
def found(folder):
    """The result of the workbook's own settings, and of the engine `jit`."""
    answers = {}
    for engine, options in {"slower": (), "jit": ("--engine", "jit", "--sampling", "mirrored")}.items():
        results, answer = folder / f"{engine}.xlsx", folder / f"{engine}.json"
        done = run("simulate", folder / "made-up.xlsx", "-o", results, "--json", answer, "--quiet", *options)
        assert done.returncode == 0, done.stdout
        answers[engine] = json.loads(answer.read_text(encoding="utf-8"))
    return answers


def test_engines_agree_on_the_made_up_distribution_and_sampling_method(found):
    """To the last bit: nothing but draws, a doubling and a sum."""
    assert found["slower"]["forecasts"] == found["jit"]["forecasts"]
    twice = found["slower"]["forecasts"][0]
    assert twice["name"] == "twice"
    assert (twice["statistics"]["minimum"]["value"], twice["statistics"]["maximum"]["value"]) == (2.0, 6.0)


def test_its_replicates_are_known_to_the_statistics(found):
    """Mirrored pairs of either end have one mean; independent trials would know it to 2/√4000 = 0.032."""
    mean = found["slower"]["forecasts"][0]["statistics"]["mean"]
    assert mean["value"] == 4.0
    assert mean["error"] < 0.01


def test_the_made_up_sheet_is_the_last_and_holds_what_it_was_given(folder, found):
    book = openpyxl.load_workbook(folder / "slower.xlsx")
    assert book.sheetnames[-1] == "Made up"
    assert 4000 in [cell.value for row in book["Made up"].iter_rows() for cell in row]


def test_the_run_is_recorded_and_repeated(folder, found):
    done = run("replay", folder / "slower.xlsx")
    assert done.returncode == 0, done.stdout
    assert "identical" in done.stdout
    texts = [cell.value for row in openpyxl.load_workbook(folder / "slower.xlsx")["Record"].iter_rows() for cell in row]
    assert "pairs of a stream" in texts
    assert any("mirrored pairs: 2000 independent replicates" in str(text).replace(",", "") for text in texts)


def test_the_help_lists_them():
    text = run("simulate", "--help").stdout
    assert "mirrored: mirrored pairs" in " ".join(text.split())
    assert "slower: as numpy" in " ".join(text.split())


def test_the_pages_that_lack_them_are_named():
    assert run("--undescribed").stdout.split("\n") == [
        "docs/sampling.md: mirrored",
        "docs/command-line.md: mirrored",
        "docs/workbooks.md: mirrored",
        "docs/engines.md: slower",
        "docs/command-line.md: slower",
        "docs/workbooks.md: slower",
        "docs/guide.md: Made up",
        "docs/distributions.md: Either End",
        "",
    ]
