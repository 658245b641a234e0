"""The whole command, workbook to workbook, against the least that any Python program would need for the same sheets.

`python benchmarks/whole_command.py` runs in turn, in fresh processes:

- `xlmc simulate examples/intersection.xlsx -n 200000` with the result workbook written;
- a baseline that imports NumPy, openpyxl and XlsxWriter and writes the same result sheets with XlsxWriter: every call
  that xlmc made to XlsxWriter, recorded once and made again with the same arguments. It reads no workbook, draws and
  evaluates nothing, computes no statistic, and injects the sheets into no package. The time to read the recording is
  taken off, for xlmc has its numbers in memory.

The ratio is of the same round, the median over rounds.
"""

from __future__ import annotations

import argparse
import os
import pickle
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter
from typing import Any

HERE = Path(__file__).resolve().parent
CASE_STUDY = HERE.parent / "examples" / "intersection.xlsx"
TRIALS = 200_000
ROUNDS = 7

Call = tuple[int, str, tuple[Any, ...], dict[str, Any], int]
"""The object's number, method, arguments, and the number of the object that it gave; Made stands for an object."""


class Made:
    """An object of XlsxWriter in a recording."""

    def __init__(self, number: int) -> None:
        self.number = number


class Recorder:
    """Stands before an object of XlsxWriter: passes every call on and keeps it."""

    def __init__(self, real: Any, number: int, calls: list[Call]) -> None:
        self._real, self._number, self._calls = real, number, calls

    def __getattr__(self, name: str) -> Any:
        attribute = getattr(self._real, name)
        if not callable(attribute):
            return attribute

        def call(*arguments: Any, **named: Any) -> Any:
            made = len(self._calls) + 1
            plain = tuple(_stored(argument) for argument in arguments)
            self._calls.append((self._number, name, plain, {k: _stored(v) for k, v in named.items()}, made))
            given = attribute(*(_real(a) for a in arguments), **{k: _real(v) for k, v in named.items()})
            return Recorder(given, made, self._calls) if _of_xlsxwriter(given) else given

        return call

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _of_xlsxwriter(thing: object) -> bool:
    """Whether it is an object of the library, or of a class made from one of its."""
    return any(kind.__module__.startswith("xlsxwriter") for kind in type(thing).__mro__)


def _stored(argument: Any) -> Any:
    if isinstance(argument, Recorder):
        return Made(argument._number)
    return None if isinstance(argument, type) else argument  # a worksheet class of xlmc's: the plain one will do


def _real(argument: Any) -> Any:
    return argument._real if isinstance(argument, Recorder) else argument


def record(path: Path, trials: int = TRIALS) -> int:
    """Write what xlmc asks of XlsxWriter for the result sheets of a run; how many calls that are."""
    from xlmc.montecarlo.definitions.run_options import RunOptions
    from xlmc.montecarlo.model.loading import load
    from xlmc.montecarlo.simulation.simulate import run_model
    from xlmc.outputs.sheets import exact_book
    from xlmc.outputs.sheets.book import build_sheets

    run = run_model(load(CASE_STUDY), RunOptions.of(trials=trials))
    calls: list[Call] = []
    real = exact_book.ExactBook
    exact_book.ExactBook = lambda: Recorder(real(), 0, calls)
    try:
        build_sheets(run, command="")
    finally:
        exact_book.ExactBook = real
    path.write_bytes(pickle.dumps(calls))
    return len(calls)


def baseline(recording: Path, target: Path) -> float:
    """Make the recorded calls; seconds that reading the recording took."""
    import numpy
    import openpyxl
    from xlsxwriter import Workbook

    assert numpy
    assert openpyxl
    start = perf_counter()
    calls: list[Call] = pickle.loads(recording.read_bytes())
    reading = perf_counter() - start
    options = {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False}
    objects: dict[int, Any] = {0: Workbook(target, options)}
    for number, name, arguments, named, made in calls:
        given = [_object_of(a, objects) for a in arguments]
        if name == "write_numbers":  # a method of xlmc's own
            row, column, values, style = given
            for at, value in enumerate(values, row):
                objects[number].write_number(at, column, value, style)
            continue
        objects[made] = getattr(objects[number], name)(*given, **{k: _object_of(v, objects) for k, v in named.items()})
    return reading


def _object_of(argument: Any, objects: dict[int, Any]) -> Any:
    return objects[argument.number] if isinstance(argument, Made) else argument


def measure(rounds: int = ROUNDS) -> dict[str, Any]:
    """Seconds of every round, medians, and the median of the ratios."""
    paths = os.pathsep.join(filter(None, (str(HERE.parent), os.environ.get("PYTHONPATH"))))
    environment = {**os.environ, "PYTHONPATH": paths}

    def seconds(*command: object) -> tuple[float, str]:
        start = perf_counter()
        arguments = [sys.executable, *map(str, command)]
        done = subprocess.run(arguments, check=True, capture_output=True, text=True, env=environment)
        return perf_counter() - start, done.stdout

    with tempfile.TemporaryDirectory() as folder:
        recording, theirs, ours = (Path(folder) / name for name in ("calls", "baseline.xlsx", "results.xlsx"))
        calls = int(seconds(__file__, "--record", recording)[1])
        result: dict[str, Any] = {"trials": TRIALS, "calls": calls, "xlmc": [], "baseline": [], "imports": []}
        command = "-m", "xlmc", "simulate", CASE_STUDY, "-n", TRIALS, "--quiet", "-o", ours
        for _ in range(rounds):
            result["xlmc"].append(seconds(*command)[0])
            whole, reading = seconds(__file__, "--baseline", recording, theirs)
            result["baseline"].append(whole - float(reading))
            result["imports"].append(seconds("-c", "import numpy, openpyxl, xlsxwriter")[0])
        result["sizes"] = [ours.stat().st_size, theirs.stat().st_size]
    result["ratio"] = statistics.median(a / b for a, b in zip(result["xlmc"], result["baseline"], strict=True))
    return result


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description="The whole command against the least that its sheets would need.")
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    parser.add_argument("--record", type=Path, help="write the recording, and print how many calls it holds")
    parser.add_argument("--baseline", nargs=2, type=Path, metavar=("RECORDING", "TARGET"), help="be the baseline")
    chosen = parser.parse_args()
    if chosen.record:
        print(record(chosen.record))
        return
    if chosen.baseline:
        print(baseline(*chosen.baseline))
        return
    result = measure(chosen.rounds)
    print(f"xlmc simulate, {TRIALS:,} trials, workbook written: {statistics.median(result['xlmc']):.3f} s")
    print(f"baseline, the same sheets from recorded calls:  {statistics.median(result['baseline']):.3f} s")
    print(f"  of it importing the three libraries:          {statistics.median(result['imports']):.3f} s")
    print(f"ratio: {result['ratio']:.2f}")


if __name__ == "__main__":
    main()
