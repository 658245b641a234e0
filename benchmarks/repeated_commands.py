"""Does the command in the record give the run's fingerprint, whatever the run was asked for?

`python benchmarks/repeated_commands.py` draws random settings for five workbooks, some in the table `xlmc_settings` (as
values or formulas) and some on the command line, where they often are the defaults that the workbook replaced. It runs
each, runs the command of its record in a fresh process, in the workbook's folder, and compares the two fingerprints. It
writes `results/repeated-commands.json`; 200 runs of at most 20,000 trials take a few minutes. `--only 17` shows one.

The bar: every fingerprint is the same. Settings that contradict each other are refused, and drawn again.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import shlex
import subprocess
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from math import prod
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

__all__ = ["KINDS", "RESULTS", "Case", "command_of", "drawn", "fingerprint_of", "repeated", "run_here", "write_book"]

RESULTS = Path(__file__).resolve().parent / "results" / "repeated-commands.json"
RUNS: Final = 200
MOST: Final = 20_000
NAMES = (
    "book.xlsx",
    "my book.xlsx",
    "Smith's case.xlsx",
    "a $5 `book`.xlsx",
    'the "red" car.xlsx',
    "-n.xlsx",
    "Größe 50 %.xlsx",
)

Table = list[list[Any]]

ASSUMPTIONS: Table = [
    ["Name", "Cell", "Distribution", "Low", "High"],
    ["a", "=Model!B1", "Uniform", 2, 4],
    ["b", "=Model!B2", "Uniform", 2, 4],
    ["c", "=Model!B3", "Uniform", 1, 3],
]
FORECASTS: Table = [["Name", "Cell", "Threshold"], ["sum", "=Model!D1", 15], ["ratio", "=Model!D2", None]]
EVIDENCE: Table = [
    ["Name", "Cell", "Reading", "Error", "Std dev", "Source"],
    *([f"reading {n}", f"=Model!C{n}", 6 - 2 * (n == 3), "Normal", 0.4, "EDR"] for n in (1, 2, 3)),
]
FILTERS: Table = [["Name", "Cell", "At least", "At most", "Because"], ["short", "=Model!D1", 12, 15, "marks"]]

KINDS: Final[dict[str, dict[str, Table]]] = {
    "evidence": {"evidence": EVIDENCE},
    "evidence beside a filter": {"evidence": EVIDENCE[:2], "filters": FILTERS},
    "rare": {"filters": [FILTERS[0], ["narrow", "=Model!D1", 18.9, None, "marks"]]},
    "correlated": {
        "filters": FILTERS,
        "correlations": [["First", "Second", "Correlation"], ["a", "b", 0.7], ["b", "c", -0.3]],
    },
    "scenarios": {
        "evidence": EVIDENCE[:3],
        "scenarios": [["Name", "a", "b High"], ["near", "2 to 3", None], ["far", None, 5]],
    },
}
"""What the tables of each workbook hold beside its assumptions and forecasts."""


@dataclass(frozen=True)
class Case:
    """A run to repeat: the workbook's kind and name, its own settings, and what is typed."""

    kind: str
    name: str
    settings: tuple[tuple[str, Any], ...]
    options: tuple[str, ...]


def drawn(chance: random.Random) -> Case:
    """A random run of one of the workbooks; some are refused, as its settings contradict each other."""
    kind = chance.choice(list(KINDS))
    own, typed = _lengths(chance), _lengths(chance)
    settings: list[tuple[str, Any]] = own[0] if chance.random() < 0.6 else [("Trials", 4_000)]
    options: list[str] = typed[1] if chance.random() < 0.6 else []
    choices: list[tuple[str, str, list[Any]]] = [
        ("Seed", "--seed", [999, 1, "=3*4", 10**12]),
        ("Sampling", "--sampling", ["mc", "mc", "lhs", "lhs500", "sobol"]),
        ("Engine", "--engine", ["numpy", "numpy", "jit"]),
        ("Evidence", "--evidence", ["auto", "rejection", "weights"]),
    ]
    for heading, option, values in choices:
        if chance.random() < 0.35:
            settings.append((heading, chance.choice(values)))
        if chance.random() < 0.35:
            options += [option, str(chance.choice([value for value in values if "=" not in str(value)]))]
    if chance.random() < 0.2:
        settings.append(("Range %", 90))
    if chance.random() < 0.15:
        options += ["--time-limit", "300s"]
    if chance.random() < 0.2:
        options += ["--jobs", "2"]
    if chance.random() < 0.15:
        options.append("--in-place")
    if kind == "scenarios" and chance.random() < 0.5:
        options.append("--scenarios")
    chance.shuffle(settings)
    return Case(kind, chance.choice(NAMES), tuple(settings), tuple(options))


def _lengths(chance: random.Random) -> tuple[list[tuple[str, Any]], list[str]]:
    """How long a run is, as rows of settings and as options."""
    trials = chance.choice([1_000, 3_000, 7_777, MOST])
    accepted, rare = chance.choice([50, 400]), chance.choice(["auto", "never"])
    precision = chance.choice([1, 3, 10])
    return chance.choice(
        [
            ([("Trials", trials)], ["--trials", str(trials)]),
            ([("Trials", f"={trials // 1000}*1000")], ["-n", str(trials)]),
            (
                [("Trials", trials), ("Until accepted", accepted), ("Rare", rare)],
                ["-n", str(trials), "--until-accepted", str(accepted), "--rare", rare],
            ),
            (
                [("Trials", trials), ("Precision %", precision), ("Precision of", "mean")],
                ["-n", str(trials), "--precision", f"{precision}%", "--precision-of", "mean,p90", "--for", "sum"],
            ),
            ([("Trials", trials), ("Significant digits", 1)], ["-n", str(trials), "--adaptive", "1"]),
        ]
    )


def write_book(case: Case, folder: Path) -> Path:
    """Write the workbook of a case, and give its path."""
    import xlsxwriter

    path = folder / case.name
    book = xlsxwriter.Workbook(path)
    model = book.add_worksheet("Model")
    for row, value in enumerate((3, 3, 2)):
        model.write(row, 1, value)
        model.write_formula(row, 2, f"=B{row + 1}*2", None, 2 * value)
    model.write_formula("D1", "=SUM(C1:C3)", None, 16)
    model.write_formula("D2", "=SQRT(B1)/B2", None, 3**-0.5)
    tables = {"assumptions": ASSUMPTIONS, "forecasts": FORECASTS, **KINDS[case.kind]}
    tables["settings"] = [["Setting", "Value"], *map(list, case.settings)]
    for name, rows in tables.items():
        sheet = book.add_worksheet(name)
        size = (len(rows) - 1, len(rows[0]) - 1)
        sheet.add_table(0, 0, *size, {"name": f"xlmc_{name}", "columns": [{"header": head} for head in rows[0]]})
        for row, values in enumerate(rows[1:], 1):
            for column, value in enumerate(values):
                if name == "settings" and str(value).startswith("="):
                    sheet.write_formula(row, column, value, None, _product(value))
                elif value is not None:
                    sheet.write(row, column, value)
    book.close()
    return path


def _product(formula: str) -> int:
    """The value of a formula that multiplies whole numbers."""
    return prod(int(factor) for factor in formula.removeprefix("=").split("*"))


def run_here(arguments: Sequence[str], folder: Path) -> int:
    """Run the command in this process, in a folder, and give its exit code."""
    from click.testing import CliRunner

    from xlmc.cli import xlmc

    before = Path.cwd()
    os.chdir(folder)
    try:
        return CliRunner().invoke(xlmc, list(arguments)).exit_code
    finally:
        os.chdir(before)


def run_afresh(command: str, more: Sequence[str], folder: Path) -> int:
    """Run a command as a shell would, in a process of its own, and give its exit code."""
    program, *arguments = shlex.split(command)
    assert program == "xlmc", command
    run = [sys.executable, "-m", "xlmc", *arguments, *more]
    return subprocess.run(run, cwd=folder, capture_output=True, check=False).returncode


def record_of(path: Path) -> dict[str, Any]:
    """The section on the run in the record of a JSON file."""
    result: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))["record"]["run"]
    return result


def command_of(path: Path) -> str:
    """The command that a record in a JSON file says to repeat the run with."""
    return str(record_of(path)["repeat"])


def fingerprint_of(path: Path) -> str:
    """The fingerprint in a record in a JSON file."""
    return str(record_of(path)["fingerprint"])


def repeated(case: Case) -> dict[str, Any] | None:
    """Run a case and then the command of its record; None where the run is refused."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        book = write_book(case, folder)
        typed = f"./{book.name}"
        code = run_here(["simulate", typed, *case.options, "--quiet", "--json", "first.json"], folder)
        if code not in (0, 1) or not (folder / "first.json").exists():
            return None
        command = command_of(folder / "first.json")
        again = run_afresh(command, ["--quiet", "--json", "again.json", "--overwrite"], folder)
        done = again in (0, 1) and (folder / "again.json").exists()
        same = done and fingerprint_of(folder / "again.json") == fingerprint_of(folder / "first.json")
        return {"kind": case.kind, "settings": case.settings, "options": case.options, "command": command, "same": same}


def main() -> None:
    """Repeat random runs, and write and print what came of it."""
    parser = argparse.ArgumentParser(description="Does the command in the record give the run's fingerprint?")
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, help="show this run")
    given = parser.parse_args()
    result: list[dict[str, Any]] = []
    refused = 0
    for number in range(10**6) if given.only is None else [given.only]:
        case = drawn(random.Random(f"{given.seed} {number}"))
        outcome = repeated(case)
        if outcome is None:
            refused += 1
            continue
        result.append({"number": number, **outcome})
        if given.only is not None or not outcome["same"]:
            print(json.dumps(result[-1], ensure_ascii=False), case, flush=True)
        if len(result) == given.runs:
            break
    other = [each for each in result if not each["same"]]
    summary = {
        "runs": len(result),
        "same": len(result) - len(other),
        "refused": refused,
        "seed": given.seed,
        "kinds": dict(sorted(Counter(each["kind"] for each in result).items())),
        "other": other,
    }
    print(json.dumps(summary, indent=2, ensure_ascii=False))
    if given.only is None:
        RESULTS.write_text(json.dumps(summary, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    raise SystemExit(bool(other))


if __name__ == "__main__":
    main()
