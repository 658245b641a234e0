"""Evidence added to the case study, beside numbers that a program of its own computed from 40 million trials.

    python benchmarks/evidence_case.py                 4 million trials, some 20 seconds
    python benchmarks/evidence_case.py --trials 200000

For each row: the share of the trials past the paper's filters that the evidence keeps (the mean weight, for a normal
error), the means of three answers, and the verdict. The exit code is 1 where a number is farther from the expected one
than four standard errors of both, and half a unit of its last printed digit. The shares and means stand for 703,090
trials past the filters; the direct runs of the last lines use rejection, and weights.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final, NamedTuple

from xlmc.excel.address import parse_address
from xlmc.montecarlo.definitions.evidence import Evidence
from xlmc.montecarlo.definitions.tables.evidence_rows import as_filter
from xlmc.montecarlo.diagnostics import evidence_trials
from xlmc.montecarlo.diagnostics.agreement import Agreement, agreement
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulate import simulate
from xlmc.montecarlo.statistics import Estimate

__all__ = ["ROWS", "Item", "Row", "faults", "found", "main", "with_evidence"]

BOOK: Final = Path(__file__).resolve().parents[1] / "examples" / "intersection.xlsx"
ANSWERS: Final = ("Chevrolet delta-V", "Chevrolet impact speed", "Nissan impact speed")
CELLS: Final = {"delta-V": "Model!D54", "speed": "Model!D56", "energy": "Model!D74"}
PAST: Final = 703_090
"""Trials past the filters that the expected numbers rest on."""

SEED: Final = 2001
_ERRORS: Final = 4.0


class Item(NamedTuple):
    """Evidence: of what, the reading, its error, and its size in percent."""

    of: str
    reading: float
    error: str
    percent: float


class Row(NamedTuple):
    """What is expected: texts, whose last digit says how exact they are; None where nothing is.

    Attributes:
        items: the evidence.
        kept: the share of the trials past the filters.
        means: of `ANSWERS`.
        verdict: in words.
        effective: the effective sample size by the trials past the filters.
        ratio: of the joint share to the product.
    """

    items: tuple[Item, ...]
    kept: str
    means: tuple[str | None, str | None, str | None]
    verdict: str
    effective: str | None = None
    ratio: str | None = None


_NONE: Final = (None, None, None)

ROWS: Final = (
    Row((Item("delta-V", 12.0, "instrument", 10.0),), ".8617", ("11.98", "33.50", "4.78"), "independent"),
    Row((Item("delta-V", 12.0, "normal", 5.0),), ".6158", ("11.96", "33.50", "4.78"), "independent", ".783"),
    Row((Item("delta-V", 10.5, "instrument", 10.0),), ".4072", ("11.08", "31.87", "4.58"), "independent"),
    Row((Item("delta-V", 14.0, "instrument", 10.0),), ".1011", ("12.99", "34.98", "5.01"), "independent"),
    Row((Item("delta-V", 15.0, "instrument", 10.0),), ".00097", ("13.75", "35.85", "7.09"), "inconsistent"),
    Row((Item("delta-V", 15.0, "normal", 5.0),), ".0045", ("13.05", "35.04", "5.24"), "strained", ".075"),
    Row((Item("delta-V", 16.0, "instrument", 10.0),), "0", _NONE, "inconsistent"),
    Row((Item("delta-V", 16.0, "normal", 5.0),), ".00017", ("13.21", "35.2", "5.5"), "inconsistent", ".029"),
    Row((Item("speed", 33.0, "uniform", 4.0),), ".5074", ("11.86", "32.94", "4.77"), "independent"),
    Row(
        (Item("delta-V", 12.0, "instrument", 10.0), Item("speed", 33.0, "uniform", 4.0)),
        ".4844",
        ("11.90", "32.97", "4.78"),
        "corroborates",
        ratio="1.11",
    ),
    Row((Item("delta-V", 10.5, "instrument", 10.0), Item("speed", 40.0, "uniform", 4.0)), "0", _NONE, "inconsistent"),
    Row((Item("energy", 83_000.0, "uniform", 25.0),), ".974", ("11.78", "33.07", "4.71"), "independent"),
    Row((Item("energy", 60_000.0, "uniform", 25.0),), ".208", ("10.99", "30.93", "4.49"), "independent"),
)

U_ROW: Final = ("1.0851", (11.962, 33.499, 4.790), 0.0023)
"""The first normal row by rejection: percent of all trials, its means, and the standard error of the percentage."""


def with_evidence(model: CompiledModel, items: Sequence[Item]) -> CompiledModel:
    """The model with these rows of evidence."""
    rows = []
    for each in items:
        cell = parse_address(CELLS[each.of], "-")
        name = f"{each.of} {each.reading:g}"
        rows.append(Evidence(name, cell, cell, each.reading, each.error, {"percent": each.percent}))
    definitions = replace(model.definitions, filters=(*model.filters, *map(as_filter, rows)), evidence=tuple(rows))
    return CompiledModel(model.workbook, definitions, model.path)


def found(model: CompiledModel, row: Row, trials: int) -> Agreement:
    """What a row of evidence does, by so many trials of the case study."""
    most, evidence_trials.MOST_TRIALS = evidence_trials.MOST_TRIALS, max(trials, evidence_trials.MOST_TRIALS)
    try:
        judged = agreement(with_evidence(model, row.items), SEED, trials)
    finally:
        evidence_trials.MOST_TRIALS = most
    assert judged is not None
    return judged


def _apart(value: float, error: float, past: int, expected: str) -> float:
    """How far a number is from what is expected, as a share of what is allowed."""
    digits = len(expected.partition(".")[2])
    allowed = _ERRORS * error * math.sqrt(1.0 + past / PAST) + 0.5 * 10.0**-digits
    return abs(value - float(expected)) / allowed


def faults(row: Row, judged: Agreement) -> Iterator[str]:
    """What is not as expected."""
    past = judged.past
    numbers: list[tuple[str, Estimate, str | None]] = [("kept", judged.together, row.kept)]
    means = {each.forecast: each.mean for each in judged.answers if each.used == "all evidence"}
    numbers += [(name, means[name], text) for name, text in zip(ANSWERS, row.means, strict=True)]
    numbers += [("ratio", judged.ratio, row.ratio)]
    for what, estimate, expected in numbers:
        if expected is not None and not _apart(estimate.value, estimate.error or 0.0, past, expected) <= 1.0:
            yield f"{what}: {estimate.value:.6g} ± {estimate.error}, and {expected} was expected"
    if row.effective is not None:
        share = judged.effective / past
        if abs(share - float(row.effective)) > 0.0005 + _ERRORS * share / math.sqrt(judged.effective):
            yield f"effective: {share:.4g} of the trials, and {row.effective} was expected"
    if judged.verdict.value != row.verdict:
        yield f"verdict: {judged.verdict.value}, and {row.verdict} was expected"


def _line(row: Row, judged: Agreement) -> str:
    named = " and ".join(f"{each.of} {each.reading:g}, {each.error} {each.percent:g} %" for each in row.items)
    means = {each.forecast: each.mean for each in judged.answers if each.used == "all evidence"}
    shown = ", ".join(f"{means[name].value:.3f}" for name in ANSWERS)
    expected = ", ".join(text or "–" for text in row.means)
    kept = f"{judged.together.value:.5f} ± {judged.together.error:.5f} ({row.kept})"
    return f"{named} | {kept} | {shown} ({expected}) | {judged.verdict.value}"


def _direct(model: CompiledModel, trials: int) -> Iterator[tuple[str, bool]]:
    """The first normal row as runs: by rejection and by weights."""
    percent, means, error = U_ROW
    own = with_evidence(model, ROWS[1].items)
    for way in ("rejection", "weights"):
        run = simulate(own, trials=trials, seed=SEED, engine="numpy", evidence=way)
        share = 100.0 * run.acceptance.value * (1.0 if run.weighting is None else run.weighting.mean)
        of_share = 100.0 * (run.acceptance.error or 0.0)
        good = abs(share - float(percent)) <= _ERRORS * math.hypot(of_share, error)
        found_means = [run[name].mean for name in ANSWERS]
        for each, truth in zip(found_means, means, strict=True):
            good &= abs(each.value - truth) <= _ERRORS * (each.error or 0.0) * math.sqrt(2.0) + 0.0005
        shown = ", ".join(f"{each.value:.3f}" for each in found_means)
        yield f"by {way}: {share:.4f} % ({percent}), means {shown} ({', '.join(map(str, means))})", good


def main(argv: Sequence[str] | None = None) -> int:
    """Print the table; 1 where something is not as expected."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trials", type=int, default=1 << 22)
    trials = parser.parse_args(argv).trials
    model, wrong = load(BOOK), 0
    print("evidence | kept of the trials past the filters (expected) | means (expected) | verdict")
    for row in ROWS:
        judged = found(model, row, trials)
        print(_line(row, judged))
        for fault in faults(row, judged):
            wrong += 1
            print(f"    not as expected: {fault}")
    for text, good in _direct(model, trials):
        wrong += not good
        print(text + ("" if good else ": not as expected"))
    print(f"{wrong} numbers are not as expected")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
