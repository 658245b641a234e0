"""Does `xlmc optimise` find known optima, and does its stated confidence hold?

`python benchmarks/optimum_coverage.py` runs it with 20 seeds on workbooks whose optimum has a closed form: a
newsvendor (one decision, any value), one who also chooses among prices (two decisions, any value and whole numbers), a
portfolio (two shares, the largest mean with a given standard deviation), and a knapsack of yes and no. It prints in how
many of them the chosen candidate is within the stated indifference of the optimum, and what a search costs in plain
runs. Then it runs a newsvendor with whole orders 200 times with so few trials that candidates are hard to tell apart,
and prints how often the stated confidence held where it was 95 % or more.

The bars: 18 of 20 seeds; 92 % of 200 runs; at most the cost of 100 plain runs for two decisions.
"""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
import xlsxwriter

import xlmc

__all__ = ["PROBLEMS", "Problem", "coverage", "write"]

SEEDS, RUNS = 20, 200
FOUND, HELD, COST = 18, 0.92, 100.0


@dataclass(frozen=True, slots=True)
class Problem:
    """A workbook whose optimum is known.

    Attributes:
        assumptions: name, distribution, and two numbers.
        formula: of the forecast, by names; a decision or an assumption is written in braces.
        decisions: name, value, low, high, step, values.
        goal: what is largest.
        requirements: what must hold.
        true: the goal with some decisions.
        optimum: the largest goal there is.
        trials: of a run.
    """

    assumptions: tuple[tuple[str, str, float, float], ...]
    formula: str
    decisions: tuple[tuple[str, float, float | None, float | None, float | None, str], ...]
    goal: str
    requirements: tuple[str, ...]
    true: Callable[[Mapping[str, float]], float]
    optimum: float
    trials: int = 50_000


def write(problem: Problem, path: Path) -> None:
    """Write the workbook of a problem."""
    cells = {name: f"Inputs!B{row}" for row, (name, *_) in enumerate(problem.assumptions, 2)}
    begin = len(problem.assumptions) + 4
    cells |= {name: f"Inputs!B{row}" for row, (name, *_) in enumerate(problem.decisions, begin)}
    with xlsxwriter.Workbook(path) as book:
        inputs, model, table = (book.add_worksheet(name) for name in ("Inputs", "Model", "Decisions"))
        rows = [
            (name, first, kind, "", "", first, second)
            if kind == "Normal"
            else (name, (first + second) / 2, kind, first, second, "", "")
            for name, kind, first, second in problem.assumptions
        ]
        _table(inputs, "xlmc_assumptions", ("Name", "Value", "Distribution", "Low", "High", "Mean", "Std dev"), rows)
        for row, (name, value, *_) in enumerate(problem.decisions, begin):
            inputs.write_row(row - 1, 0, (name, value))
        model.write_formula("D1", "=" + problem.formula.format(**{k.replace(" ", "_"): v for k, v in cells.items()}))
        _table(model, "xlmc_forecasts", ("Name", "Cell"), [("Gain", "=Model!D1")])
        heads = ("Name", "Cell", "Low", "High", "Step", "Values")
        lines = [
            (name, f"={cells[name]}", *("" if x is None else x for x in (low, high, step)), values)
            for name, _, low, high, step, values in problem.decisions
        ]
        _table(table, "xlmc_decisions", heads, lines)


def _table(
    sheet: xlsxwriter.worksheet.Worksheet, name: str, heads: tuple[str, ...], rows: list[tuple[object, ...]]
) -> None:
    columns = [{"header": head} for head in heads]
    sheet.add_table(0, 0, len(rows), len(heads) - 1, {"name": name, "columns": columns, "data": rows})


def _newsvendor(order: float, price: float = 5.0) -> float:
    """Return the mean profit: demand is uniform from 0 to 150 − 10·price·…, a piece costs 3."""
    most = 200.0 - 20.0 * price
    sold = order - order * order / (2.0 * most) if order <= most else most / 2.0
    return price * sold - 3.0 * order


def _best_newsvendor(prices: tuple[float, ...]) -> float:
    return max(_newsvendor((1.0 - 3.0 / price) * (200.0 - 20.0 * price), price) for price in prices)


_MEANS, _DEVIATIONS, _LIMIT = (0.06, 0.10, 0.14), (0.05, 0.12, 0.22), 0.10


def _best_portfolio() -> float:
    """Return the largest mean of a portfolio of independent shares with the limit of the standard deviation.

    The efficient ones are w = (λ Σ⁻¹ μ + ν Σ⁻¹ 1) with shares that add up to 1: a parabola in the mean.
    """
    mu, precision = np.array(_MEANS), 1.0 / np.array(_DEVIATIONS) ** 2
    a, b, c = precision.sum(), (precision * mu).sum(), (precision * mu * mu).sum()
    return float(b / a + math.sqrt((a * c - b * b) / a * (_LIMIT**2 - 1.0 / a)))


_WORTHS, _WEIGHTS, _CARRIED = (12, 7, 9, 15, 5, 11, 8, 6), (5, 3, 4, 7, 2, 5, 4, 3), 15


def _best_knapsack() -> float:
    taken = (t for t in product((0, 1), repeat=len(_WORTHS)) if np.dot(t, _WEIGHTS) <= _CARRIED)
    return float(max(np.dot(each, _WORTHS) for each in taken))


_ITEMS = tuple(f"x{number}" for number in range(len(_WORTHS)))

PROBLEMS = {
    "newsvendor, any order": Problem(
        (("Demand", "Uniform", 0, 100),),
        "5*MIN({Order},{Demand})-3*{Order}",
        (("Order", 50, 0, 100, None, ""),),
        "mean of Gain",
        (),
        lambda at: _newsvendor(at["Order"]),
        _newsvendor(40.0),
    ),
    "newsvendor, order and price": Problem(
        (("Share", "Uniform", 0, 1),),
        "{Price}*MIN({Order},{Share}*(200-20*{Price}))-3*{Order}",
        (("Order", 50, 0, 100, None, ""), ("Price", 5, None, None, None, "4; 5; 6; 7; 8")),
        "mean of Gain",
        (),
        lambda at: _newsvendor(at["Order"], at["Price"]),
        _best_newsvendor((4.0, 5.0, 6.0, 7.0, 8.0)),
    ),
    "newsvendor, whole numbers": Problem(
        (("Share", "Uniform", 0, 1),),
        "{Price}*MIN({Order},{Share}*(200-20*{Price}))-3*{Order}",
        (("Order", 50, 1, 100, 1, ""), ("Price", 5, 4, 8, 1, "")),
        "mean of Gain",
        (),
        lambda at: _newsvendor(at["Order"], at["Price"]),
        max(_newsvendor(order, price) for order in range(1, 101) for price in (4.0, 5.0, 6.0, 7.0, 8.0)),
    ),
    "portfolio": Problem(
        tuple((f"r{n}", "Normal", mean, sd) for n, (mean, sd) in enumerate(zip(_MEANS, _DEVIATIONS, strict=True))),
        "{w0}*{r0}+{w1}*{r1}+(1-{w0}-{w1})*{r2}",
        (("w0", 0.4, 0, 1, None, ""), ("w1", 0.3, 0, 1, None, "")),
        "mean of Gain",
        (f"SD of Gain <= {_LIMIT}", "w0 + w1 <= 1"),
        lambda at: at["w0"] * _MEANS[0] + at["w1"] * _MEANS[1] + (1.0 - at["w0"] - at["w1"]) * _MEANS[2],
        _best_portfolio(),
        200_000,
    ),
    "knapsack": Problem(
        tuple((f"v{number}", "Normal", worth, 0.3 * worth) for number, worth in enumerate(_WORTHS)),
        "+".join(f"{{x{number}}}*{{v{number}}}" for number in range(len(_WORTHS))),
        tuple((name, 0, None, None, None, "0; 1") for name in _ITEMS),
        "mean of Gain",
        (" + ".join(f"{w}*{name}" for w, name in zip(_WEIGHTS, _ITEMS, strict=True)) + f" <= {_CARRIED}",),
        lambda at: float(np.dot([at[name] for name in _ITEMS], _WORTHS)),
        _best_knapsack(),
    ),
}  # fmt: skip


def coverage(model: xlmc.Model, problem: Problem, runs: int) -> tuple[int, int]:
    """Run a search many times with few trials; count those that state 95 % or more, and in how many of them it holds.

    It holds where no candidate is better than the chosen one by more than the indifference.
    """
    stated = held = 0
    for seed in range(runs):
        result = model.optimise(maximise=problem.goal, trials=2_000, seed=2 * seed + 10_000, indifference=0.2, runs=60)
        if result.confidence >= 0.95:
            stated += 1
            held += problem.optimum - problem.true(result.values) <= result.indifference
    return stated, held


def main() -> int:
    """Measure, print, and say whether the bars are met."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--only", choices=PROBLEMS, help="one of the problems, and not the confidence")
    asked, met = parser.parse_args(), True
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "book.xlsx"
        for name, problem in PROBLEMS.items() if asked.only is None else [(asked.only, PROBLEMS[asked.only])]:
            write(problem, path)
            model = xlmc.load(path)
            model.simulate(1_000)
            began = time.process_time()
            for seed in range(3):
                model.simulate(problem.trials, seed=seed)
            plain, began, within, gaps = (time.process_time() - began) / 3, time.process_time(), 0, []
            for seed in range(asked.seeds):
                result = model.optimise(
                    maximise=problem.goal, subject_to=problem.requirements, trials=problem.trials, seed=2 * seed
                )
                gap = problem.optimum - problem.true(result.values)
                gaps.append(gap / result.indifference)
                within += gap <= result.indifference
            cost = (time.process_time() - began) / asked.seeds / plain
            trials = result.trials / problem.trials
            print(
                f"{name}: within the indifference of the optimum with {within} of {asked.seeds} seeds, at most "
                f"{max(gaps):.2f} of it away; {cost:.0f} plain runs of time, {trials:.0f} of trials"
            )
            met &= within >= FOUND * asked.seeds / SEEDS and (cost <= COST or len(problem.decisions) > 2)
        if asked.only is not None:
            return not met
        problem = PROBLEMS["newsvendor, whole numbers"]
        write(problem, path)
        stated, held = coverage(xlmc.load(path), problem, asked.runs)
        print(f"confidence: {stated} of {asked.runs} runs state 95 % or more, and in {held} of these it holds")
        met &= stated > 0 and held >= HELD * stated
    return not met


if __name__ == "__main__":
    sys.exit(main())
