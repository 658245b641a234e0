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

import xlmc
from xlmc.cli.methods_json import study_json
from xlmc.methods import STATISTICS, Curve, Study, recommendation, study
from xlmc.report.methods import save_methods, tables

__all__ = ["PAGE", "filled", "theory_rows"]

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
PAGE = ROOT / "docs" / "uncertainty-methods.md"
PICTURE = ROOT / "docs" / "pictures" / "methods" / "uncertainty-methods.png"
RESULTS = HERE / "results" / "uncertainty-methods.json"
BOOK = ROOT / "examples" / "intersection.xlsx"

REFERENCE, TRIALS, REPLICATES = 33_554_432, 131_072, 200


def theory_rows(found: Study) -> list[tuple[str, ...]]:
    """Monte Carlo's errors over those that theory says, one row a run length and forecast, ± their standard errors."""
    curve = next(curve for curve in found.curves if curve.method.key == "mc")
    return [
        (f"{rung.budget:,}", forecast.name, *(_ratio(found, curve, place, forecast.name, each) for each in STATISTICS))
        for place, rung in enumerate(curve.rungs)
        for forecast in found.model.forecasts
    ]


def _ratio(found: Study, curve: Curve, place: int, forecast: str, statistic: str) -> str:
    rung = curve.rungs[place]
    error = rung.errors[forecast, statistic]
    theory = found.reference.theory(forecast, statistic, rung.budget)
    return f"{error.value / theory:.2f} ± {error.error / theory:.2f}"


def filled(page: str, found: Study) -> str:
    """The page with its tables and words made anew."""
    made = {
        "reference": tables.reference_table(found),
        "bounds": tables.bounds_table(found),
        "errors": tables.error_table(found),
        "forecasts": tables.forecast_table(found),
        "lengths": tables.rung_table(found),
    }
    for name, table in made.items():
        page = placed(page, name, f"*{table.title}*\n\n{_markdown(table.headings, table.rows, table.right)}")
    headings = ("Trials", "Forecast", *STATISTICS.values())
    page = placed(page, "theory", _markdown(headings, theory_rows(found), 2))
    words = "\n\n".join(f"> {said}" if said else "" for said in recommendation(found))
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
    """Measure, write, and say whether theory holds."""
    asked = _arguments(given)
    found = study(
        xlmc.load(BOOK),
        reference_trials=asked.reference_trials,
        trials=asked.trials,
        replicates=asked.replicates,
        told=lambda what: print(what, file=sys.stderr, flush=True),
    )
    record: dict[str, Any] = {"machine": describe(), "found": study_json(found)}
    RESULTS.write_text(json.dumps(record, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), found), encoding="utf-8")
    save_methods(found, PICTURE, overwrite=True)
    ratios = [float(cell.partition(" ")[0]) for row in theory_rows(found) for cell in row[2:]]
    print(
        f"Monte Carlo's errors are {min(ratios):.2f} to {max(ratios):.2f} of theory's, {np.median(ratios):.2f} mostly"
    )


if __name__ == "__main__":
    main()
