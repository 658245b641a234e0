"""What a cell of each kind costs in the engines `numpy` and `jit`: the table of `xlmc/engine/llvm/costs.py`.

    python benchmarks/node_costs.py [--quick]

A book has so many cells of one formula over as many different numbers; the cost of a cell is the difference between a
book of 40 and one of 10, divided by 30, processor time, the least of several runs. So the sum that the forecast is, and
the number that each cell reads, are in it: the line `a number` has these alone. `jit` is measured with loops, also
where it would leave the book to `numpy`.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import books

import xlmc
from xlmc.api import Model
from xlmc.engine.llvm import program

__all__ = ["FORMULAS", "main", "measured"]

FORMULAS = {
    "a number": "A{r}",
    "sum": "A{r}+first*2",
    "product": "A{r}*second",
    "quotient": "1/A{r}",
    "choice": "IF(A{r}>{r}/7+1,A{r},first)",
    "SQRT": "SQRT(A{r})",
    "SIN": "SIN(A{r})",
    "EXP": "EXP(A{r}/9)",
    "LN": "LN(A{r})",
    "power": "A{r}^1.3",
    "ATAN": "ATAN(A{r})",
    "VLOOKUP": "VLOOKUP(A{r},{{0,1;1,2;2,4;3,5}},2)",
    "MAX": "MAX(A{r},first)",
    "SINH": "SINH(A{r})",
    "QUOTIENT": "QUOTIENT(A{r},0.3)",
    "MOD": "MOD(A{r},0.3)",
    "INT": "INT(A{r}*10)",
    "ROUND": "ROUND(A{r},2)",
    "MEDIAN": "MEDIAN(A{r},A1,A2)",
    "ISEVEN": "IF(ISEVEN(A{r}),1,2)",
}
ENGINES = ("numpy", "jit")
FEW, MANY = 10, 40


def measured(formula: str, trials: int, rounds: int) -> dict[str, float]:
    """Engine -> nanoseconds that a cell costs in a trial."""
    best: dict[tuple[str, int], float] = {}
    with tempfile.TemporaryDirectory() as folder:
        models = {}
        for cells in (FEW, MANY):
            path = Path(folder, f"{cells}.xlsx")
            books.write_kind(path, formula, cells)
            models[cells] = xlmc.load(path)
        for number in range(rounds + 1):
            for cells, model in models.items():
                for engine in ENGINES:
                    seconds = _seconds(model, engine, trials)
                    if number:  # the first compiles
                        best[engine, cells] = min(seconds, best.get((engine, cells), seconds))
    return {engine: (best[engine, MANY] - best[engine, FEW]) / (MANY - FEW) / trials * 1e9 for engine in ENGINES}


def _seconds(model: Model, engine: str, trials: int) -> float:
    start = time.process_time()
    model.simulate(trials, 1, engine=engine, keep_inputs=0)
    return time.process_time() - start


def main(given: Sequence[str] | None = None) -> None:
    """Measure, and print a line a formula."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--quick", action="store_true", help="show that it runs")
    quick = parser.parse_args(given).quick
    trials, rounds = (1_000, 1) if quick else (131_072, 6)
    formulas = dict(list(FORMULAS.items())[:2]) if quick else FORMULAS
    chosen, program.loops_pay = program.loops_pay, lambda *_: True
    try:
        print("| cell | numpy, ns | jit, ns | saved, ns |\n| --- | ---: | ---: | ---: |")
        for name, formula in formulas.items():
            result = measured(formula, trials, rounds)
            figures = result["numpy"], result["jit"], result["numpy"] - result["jit"]
            print(f"| {name} | {' | '.join(f'{figure:.2f}' for figure in figures)} |", flush=True)
    finally:
        program.loops_pay = chosen


if __name__ == "__main__":
    main()
