"""How fast is solving for a cell in every trial, beside a loop over SciPy's `brentq`?

`python benchmarks/solving.py` runs a workbook with a row of `xlmc_solve` for a million trials, on both engines, and the
same equation in a loop of `scipy.optimize.brentq` over a part of these trials, one after the other in several rounds;
it prints trials a second by their medians, their ratio, and how far the solutions are from the closed form. The
equation: the speed at which a stop, reaction and braking, takes a given distance, v t + v² / (2 μ g) = d.

The bar: at least 50 times faster, which the engine for long runs, `jit`, is to meet, with `numpy` measured beside it;
within 1e-10 of the closed form with both.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import xlsxwriter
from numpy.typing import NDArray
from scipy.optimize import brentq

import xlmc

__all__ = ["closed_form", "loop", "write"]

TRIALS, ROUNDS, LOOPED = 1_000_000, 5, 20_000
TIMES = {"numpy": 1.0, "jit": 50.0}
APART = 1e-10
G = 9.81

Floats = NDArray[np.float64]


def write(path: Path) -> None:
    """Write the workbook."""
    tables = {
        "xlmc_assumptions": (
            ("Name", "Value", "Low", "High"),
            [("Reaction", 1.2, 0.8, 1.6), ("Friction", 0.75, 0.6, 0.9), ("Distance", 50, 40, 60)],
        ),
        "xlmc_solve": (
            ("Name", "Cell", "To", "By", "Low", "High"),
            [("Speed", "=Model!B10", "=Model!B4", "=Model!B9", 0, 60)],
        ),
        "xlmc_forecasts": (("Name", "Cell", "Units"), [("Speed", "=Model!B9", "m/s")]),
    }
    with xlsxwriter.Workbook(path) as book:
        model = book.add_worksheet("Model")
        model.write_row(8, 0, ("Speed", 20))
        model.write_row(9, 0, ("Stopping distance",))
        model.write_formula(9, 1, f"=B9*B2+B9^2/(2*B3*{G})")
        for name, (heads, rows) in tables.items():
            sheet = model if name == "xlmc_assumptions" else book.add_worksheet(name[5:].title())
            columns = [{"header": head} for head in heads]
            sheet.add_table(0, 0, len(rows), len(heads) - 1, {"name": name, "columns": columns, "data": rows})


def closed_form(reaction: Floats, friction: Floats, distance: Floats) -> Floats:
    """Return the speeds, m/s."""
    braking = friction * G
    return np.asarray(2.0 * distance / (reaction + np.sqrt(reaction**2 + 2.0 * distance / braking)))


def loop(reaction: Floats, friction: Floats, distance: Floats) -> Floats:
    """Solve trial by trial with SciPy."""
    return np.array(
        [
            brentq(lambda v, t=t, mu=mu, d=d: v * t + v**2 / (2 * mu * G) - d, 0.0, 60.0)
            for t, mu, d in zip(reaction.tolist(), friction.tolist(), distance.tolist(), strict=True)
        ]
    )


def main() -> int:
    """Measure, print, and say whether the bar is met."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=TRIALS)
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    asked = parser.parse_args()
    met = True
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "stop.xlsx"
        write(path)
        model = xlmc.load(path)
        engines = (*TIMES,)
        spent: dict[str, list[float]] = {each: [] for each in (*engines, "loop")}
        apart = dict.fromkeys(engines, 0.0)
        for engine in engines:
            model.simulate(10_000, engine=engine)
        for _ in range(asked.rounds):
            for engine in engines:
                began = time.process_time()
                run = model.simulate(asked.trials, engine=engine, keep_inputs=None)
                spent[engine].append((time.process_time() - began) / asked.trials)
                drawn = [run.inputs[name] for name in ("Reaction", "Friction", "Distance")]
                exact = closed_form(*drawn)
                apart[engine] = max(apart[engine], float(np.max(np.abs(run.forecasts["Speed"] / exact - 1.0))))
            few = [column[:LOOPED] for column in drawn]
            began = time.process_time()
            loop(*few)
            spent["loop"].append((time.process_time() - began) / LOOPED)
        looped = statistics.median(spent["loop"])
        for engine in engines:
            each = statistics.median(spent[engine])
            print(
                f"{engine}: {1 / each:,.0f} trials a second of processor time, a loop over brentq {1 / looped:,.0f}: "
                f"{looped / each:.0f} times as fast; at most {apart[engine]:.1e} from the closed form"
            )
            met &= looped >= TIMES[engine] * each and apart[engine] <= APART
    return not met


if __name__ == "__main__":
    sys.exit(main())
