"""What docs/adding.md adds works everywhere: command line, settings, engines, sheets, record, documents."""

from __future__ import annotations

import csv
import json
import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import openpyxl
import pytest
from openpyxl.worksheet.table import Table

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "adding.md"
BLOCK = re.compile(r"^```diff\n(.*?)^```", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"^--- (?:/dev/null|a/(\S+))\n\+\+\+ b/(\S+)\n", re.MULTILINE)


TRIALS = 2_000
FORECASTS = {
    "haversine": "HAVERSINE(B2)",
    "rows": "SUM(EVENROWS(B2:B3))",
    "row": "SUM(EVENROWS(HSTACK(B2:B3,B2:B3*10)))",
    "none": "IFERROR(EVENROWS(B2),7)",
}
EXAMPLES = {
    "A distribution": "Arcsine",
    "A sampling method": "antithetic",
    "An engine": "slow",
    "A section": "signs",
    "A result sheet": "Largest",
}
SETTINGS = {"Trials": TRIALS, "Sampling": "Antithetic", "Engine": "slow", "Purpose": "Final"}


def _lines(hunk, signs):
    return "".join(f"{line[1:]}\n" for line in hunk.splitlines() if (line[:1] or " ") in signs)


def apply(block, root):
    """Apply a diff whose hunks have no line numbers: what a hunk replaces stands in the file once."""
    _, *parts = FILE.split(block)
    for old, new, hunks in zip(parts[::3], parts[1::3], parts[2::3], strict=True):
        path = root / new
        assert (old == new and path.exists()) or (old is None and not path.exists()), new
        text = path.read_text(encoding="utf-8") if old else ""
        for hunk in filter(None, hunks.split("@@\n")):
            before, after = _lines(hunk, " -"), _lines(hunk, " +")
            assert not old or text.count(before) == 1, f"{new} has not once, but {text.count(before)} times:\n{before}"
            text = text.replace(before, after) if old else after
        path.write_text(text, encoding="utf-8")


@pytest.fixture(scope="module")
def enlarged(tmp_path_factory):
    """The folder in which the copy lies; bytecode goes with it, which spares compiling it."""
    folder = tmp_path_factory.mktemp("enlarged")
    shutil.copytree(ROOT / "xlmc", folder / "xlmc")
    (folder / "docs").mkdir()
    shutil.copy(ROOT / "docs" / "list_distributions.py", folder / "docs")
    for block in BLOCK.findall(PAGE.read_text(encoding="utf-8")):
        apply(block, folder)
    return folder


@pytest.fixture(scope="module")
def run(enlarged):
    """`python ARGUMENTS` with that copy of xlmc."""

    def run(*arguments, folder):
        paths = os.pathsep.join(map(str, (enlarged, ROOT / "tests" / "session")))
        command = [sys.executable, *map(str, arguments)]
        variables = {**os.environ, "PYTHONPATH": paths}
        done = subprocess.run(command, env=variables, cwd=folder, capture_output=True, text=True, encoding="utf-8")
        assert not done.stderr, f"if names have changed, change docs/adding.md, too:\n{done.stderr}"
        return done

    return run


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A workbook that has the page's functions and its distribution, and asks for its sampling method and engine."""
    folder = tmp_path_factory.mktemp("adding")
    book = openpyxl.Workbook()
    tables = {
        "assumptions": [
            ["Name", "Value", "Distribution", "Low", "High", "Location", "Amplitude"],
            ["angle", 0.5, "Uniform", 0, 1, None, None],
            ["swing", 2, "arc-sine", None, None, 2, 1],
        ],
        "forecasts": [["Name", "Value"], *([name, f"={formula}"] for name, formula in FORECASTS.items())],
        "settings": [["Setting", "Value"], *map(list, SETTINGS.items())],
    }
    top = 1
    for name, rows in tables.items():
        for row in rows:
            book.active.append(row)
        last = book.active.cell(top + len(rows) - 1, len(rows[0])).coordinate
        book.active.add_table(Table(displayName=f"xlmc_{name}", ref=f"A{top}:{last}"))
        book.active.append([])
        top += len(rows) + 1
    book.save(folder / "book.xlsx")
    shown = "import xlmc\nprint(xlmc.load('book.xlsx').simulate()._repr_html_())\n"
    (folder / "notebook.py").write_text(shown, encoding="utf-8")
    return folder


COMMANDS = """
import contextlib, io, json, runpy, sys
from xlmc.cli import main
from xlmc.outputs.sheets import book

book.SHEETS = tuple(sheet for sheet in book.SHEETS if sheet.name in ("Results", "Largest", "Record"))
said = []
for arguments in json.loads(sys.argv[1]):
    sys.argv = arguments
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.suppress(SystemExit):
        main() if arguments[0] == "xlmc" else runpy.run_path(arguments[0], run_name="__main__")
    said.append(out.getvalue())
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.definitions.run_settings import USUAL
usual = RunOptions.repeating(USUAL, trials=9, by="trials", weighable=False)
said.append(" ".join(usual.arguments(USUAL)))
json.dump(said, sys.stdout)
"""
"""Several commands in one program, which starts once; a message or a warning would stand at stderr."""


@pytest.fixture(scope="module")
def printed(enlarged, folder, run):
    """What programs print: two runs, by the workbook's own settings and with `jit`; a replay; a help; two scripts.

    Last come the arguments that repeat a run with the usual settings.
    """
    commands = {
        "notebook": ["notebook.py"],
        "replay": ["xlmc", "replay", "slow.xlsx"],
        "help": ["xlmc", "simulate", "--help"],
        "distributions": [str(enlarged / "docs" / "list_distributions.py")],
        "described": [str(ROOT / "tests" / "session" / "described.py")],
    }
    runs = {"slow": [], "jit": ["--engine", "jit", "--sampling", "antithetic"]}
    for engine, options in runs.items():
        reports = [each for ending in ("html", "pdf", "docx") * (engine == "slow") for each in ("-o", f"slow.{ending}")]
        files = ["-o", f"{engine}.xlsx", *reports, "--json", f"{engine}.json", "--extract", f"{engine}.csv"]
        runs[engine] = ["xlmc", "simulate", "book.xlsx", *files, "--quiet", *options]
    commands = runs | commands
    done = run("-c", COMMANDS, json.dumps(list(commands.values())), folder=folder)
    assert done.returncode == 0
    return dict(zip([*commands, "usual"], json.loads(done.stdout), strict=True))


@pytest.fixture(scope="module")
def answers(folder, printed):
    """The forecasts of both runs."""
    return {
        engine: json.loads((folder / f"{engine}.json").read_text(encoding="utf-8"))["forecasts"]
        for engine in ("slow", "jit")
    }


@pytest.fixture(scope="module")
def trials(folder, answers):
    with (folder / "slow.csv").open(encoding="utf-8", newline="") as file:
        return [{name: float(text) for name, text in row.items()} for row in csv.DictReader(file)]


def test_engines_agree(answers):
    assert len(answers["slow"]) == len(FORECASTS)
    assert answers["slow"] == answers["jit"]


def test_functions_give_what_they_say(trials):
    assert len(trials) == TRIALS
    for trial in trials:
        assert math.isclose(trial["haversine"], (1 - math.cos(trial["angle"])) / 2, rel_tol=1e-9, abs_tol=1e-15)
        assert trial["rows"] == trial["swing"]
        assert trial["row"] == trial["swing"] + 10 * trial["swing"]
        assert trial["none"] == 7


def test_the_distribution_has_its_ends_and_its_mean(trials):
    swings = sorted(trial["swing"] for trial in trials)
    assert 1 <= swings[0] < 1.001
    assert 2.999 < swings[-1] <= 3
    assert abs(sum(1.5 < swing < 2.5 for swing in swings) / TRIALS - 1 / 3) < 4 * math.sqrt(2 / 9 / TRIALS)


def test_trials_are_pairs_of_u_and_1_less_u(trials):
    for first, second in zip(trials[::2], trials[1::2], strict=True):
        assert first["angle"] + second["angle"] == 1 - 2.0**-53
        assert math.isclose(first["swing"] + second["swing"], 4, rel_tol=1e-15)


def test_its_errors_come_from_the_pairs(answers):
    """Pairs of a swing have one mean; independent trials would know it to 1/√2/√2000 = 0.016."""
    mean = answers["slow"][1]["statistics"]["mean"]
    assert abs(mean["value"] - 2) < 1e-12
    assert mean["error"] < 0.001


def test_the_setting_is_recorded_and_repeated(folder, printed):
    book = openpyxl.load_workbook(folder / "slow.xlsx")
    record = {row[0]: row[2] for row in book["Record"].iter_rows(values_only=True) if row[0]}
    assert record["settings.purpose"] == "final"
    assert "--purpose final" in record["run.repeat"]
    assert "--purpose" in printed["help"]
    assert printed["usual"].startswith("--trials 9")
    assert "--purpose" not in printed["usual"]  # it is not set


def test_the_sheet_holds_the_largest_values(folder, answers, trials):
    book = openpyxl.load_workbook(folder / "slow.xlsx")
    assert book.sheetnames[-4:-1] == ["Signs of the answers", "Record", "Largest"]  # then what its chart draws
    rows = {row[0]: row[1:6] for row in book["Largest"].iter_rows(values_only=True)}
    for name in FORECASTS:
        assert list(rows[name]) == sorted((trial[name] for trial in trials), reverse=True)[:5]


def test_the_section_is_in_every_output(folder, printed, trials):
    pypdf, docx = pytest.importorskip("pypdf"), pytest.importorskip("docx")
    shares = [sum(trial[name] > 0.0 for trial in trials) / TRIALS for name in FORECASTS]
    rows = openpyxl.load_workbook(folder / "slow.xlsx")["Signs of the answers"].iter_rows(values_only=True)
    assert [row[1] for row in rows if row[0] in FORECASTS] == shares
    texts = [(folder / "slow.html").read_text(encoding="utf-8"), printed["notebook"], printed["slow"]]
    texts.append("\n".join(each.text for each in docx.Document(str(folder / "slow.docx")).paragraphs))
    texts.append("".join(page.extract_text() for page in pypdf.PdfReader(folder / "slow.pdf").pages))
    for text in texts:
        assert "Signs of the answers" in text
        assert "on which side of 0" in " ".join(text.split())


def test_the_run_is_recorded_and_repeated(folder, printed):
    assert "\nidentical: the same " in printed["replay"]
    record = openpyxl.load_workbook(folder / "slow.xlsx")["Record"]
    texts = {str(cell) for row in record.iter_rows(values_only=True) for cell in row}
    assert "slow" in texts
    assert any("antithetic pairs: 1000 independent replicates" in text.replace(",", "") for text in texts)


def test_the_help_lists_them(printed):
    text = " ".join(printed["help"].split())
    assert "antithetic: antithetic pairs" in text
    assert "slow: the careful path alone" in text


def test_the_page_of_distributions_shows_it(enlarged, printed):
    assert printed["distributions"] == ""
    section = (enlarged / "docs" / "distributions.md").read_text(encoding="utf-8").partition("\n## Arcsine\n")[2]
    assert "Drawn: Location 0, Amplitude 1" in section.partition("\n## ")[0]
    drawn = (enlarged / "docs" / "pictures" / "distributions" / "arcsine.svg").read_text(encoding="utf-8")
    assert "<title>Arcsine: 0, 1</title>" in drawn


def test_the_page_of_distributions_is_not_written_without_the_numbers_of_a_picture(enlarged):
    """The script as it is, and a copy of xlmc that has one distribution more."""
    without = enlarged / "without" / "list_distributions.py"
    without.parent.mkdir()
    shutil.copy(ROOT / "docs" / "list_distributions.py", without)
    variables = {**os.environ, "PYTHONPATH": str(enlarged)}
    done = subprocess.run([sys.executable, without], env=variables, capture_output=True, text=True, encoding="utf-8")
    assert done.returncode == 1
    assert done.stderr.strip().endswith("parameters for the picture of: Arcsine")
    assert [path.name for path in without.parent.iterdir()] == ["list_distributions.py"]


def test_the_pages_that_it_names_are_those_that_lack_its_examples(printed):
    """All but the list of functions, which another test compares with the registry."""
    sections = dict(section.split("\n", 1) for section in PAGE.read_text(encoding="utf-8").split("\n## ")[1:])
    lines = printed["described"].splitlines()
    for heading, example in EXAMPLES.items():
        (named,) = re.findall(r"^Its pages?:(.*?)\. Its tests", sections[heading], re.MULTILINE | re.DOTALL)
        lacking = [page for page, _, name in (line.partition(": ") for line in lines) if name == example]
        assert re.findall(r"docs/[\w-]+\.md", named) == lacking
