"""The paper's section on uncertainty methods, with numbers: every method on the case study, against a long run.

`python benchmarks/uncertainty_methods.py` measures them as `xlmc methods` does, with more runs of each length, and
writes `results/uncertainty-methods.json`, the tables and the words of docs/uncertainty-methods.md, and its picture.
Seconds depend on the machine; nothing else does.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from machine import describe
from tables import placed

from xlmc.analysis.studies.methods import STATISTICS, Runs, Study, recommendation, study
from xlmc.analysis.studies.methods.curve import runs_of
from xlmc.analysis.studies.methods.sampled import MONTE_CARLO
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.outputs.methods import methods_tables
from xlmc.outputs.methods.matplotlib_figure import png
from xlmc.outputs.methods.methods_json import study_json

__all__ = ["PAGE", "filled", "theory_rows", "theory_runs", "write"]

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
PAGE = ROOT / "docs" / "uncertainty-methods.md"
PICTURE = ROOT / "docs" / "pictures" / "methods" / "uncertainty-methods.png"
RESULTS = HERE / "results" / "uncertainty-methods.json"
BOOK = ROOT / "examples" / "intersection.xlsx"

REFERENCE, TRIALS, REPLICATES = 33_554_432, 4_194_304, 10
"""The longest runs have 16,384 times the trials of the shortest, four decades."""

THEORY_TRIALS, THEORY_RUNS = (8_192, 32_768, 131_072), 200
_SEED = 5_000_000


def theory_runs(model: CompiledModel, result: Study) -> list[Runs]:
    """Many runs by Monte Carlo of a few lengths, which theory is held against."""
    return [
        runs_of(
            trials,
            [MONTE_CARLO.run(model, trials, _SEED + trials + run) for run in range(THEORY_RUNS)],
            result.reference,
        )
        for trials in THEORY_TRIALS
    ]


def theory_rows(result: Study, lengths: Sequence[Runs]) -> list[tuple[str, ...]]:
    """Monte Carlo's errors over those that theory says, one row a run length and forecast, ± their standard errors."""
    return [
        (f"{runs.budget:,}", forecast.name, *(_ratio(result, runs, forecast.name, each) for each in STATISTICS))
        for runs in lengths
        for forecast in result.model.forecasts
    ]


def _ratio(result: Study, runs: Runs, forecast: str, statistic: str) -> str:
    error = runs.errors[forecast, statistic]
    theory = result.reference.theory(forecast, statistic, runs.budget)
    return f"{error.value / theory:.2f} ± {error.error / theory:.2f}"


def filled(page: str, result: Study, lengths: Sequence[Runs]) -> str:
    """The page with its tables and words made anew."""
    made = {
        "reference": methods_tables.reference_table(result),
        "bounds": methods_tables.bounds_table(result),
        "errors": methods_tables.error_table(result),
        "forecasts": methods_tables.forecast_table(result),
        "lengths": methods_tables.length_table(result),
    }
    for name, table in made.items():
        page = placed(page, name, f"*{table.title}*\n\n{_markdown(table.heads, table.rows, min(table.at_right))}")
    headings = ("Trials", "Forecast", *STATISTICS.values())
    page = placed(page, "theory", _markdown(headings, theory_rows(result, lengths), 2))
    words = "\n\n".join(f"> {message}" if message else "" for message in recommendation(result))
    return placed(page, "words", words.replace("\n\n>", "\n>\n>"))


def _markdown(headings: Sequence[str], rows: Sequence[Sequence[str]], right: int) -> str:
    lines = [headings, ["---"] * right + ["---:"] * (len(headings) - right), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def _arguments(given: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--replicates", type=int, default=REPLICATES)
    parser.add_argument("--trials", type=int, default=TRIALS)
    parser.add_argument("--reference-trials", type=int, default=REFERENCE)
    return parser.parse_args(given)


def main(given: Sequence[str] | None = None) -> None:
    """Measure and write."""
    asked = _arguments(given)
    model = load(BOOK)
    result = study(
        model,
        reference_trials=asked.reference_trials,
        trials=asked.trials,
        replicates=asked.replicates,
        tell=lambda what: print(what, file=sys.stderr, flush=True),
    )
    write(result, theory_runs(model, result))


def write(result: Study, lengths: Sequence[Runs]) -> None:
    """The record, the page and the picture, and whether theory holds."""
    record: dict[str, Any] = {"machine": describe(), "found": study_json(result)}
    RESULTS.write_text(json.dumps(record, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), result, lengths), encoding="utf-8")
    PICTURE.write_bytes(png(result))
    ratios = [float(cell.partition(" ")[0]) for row in theory_rows(result, lengths) for cell in row[2:]]
    print(
        f"Monte Carlo's errors are {min(ratios):.2f} to {max(ratios):.2f} of theory's, {np.median(ratios):.2f} mostly"
    )


if __name__ == "__main__":
    main()
