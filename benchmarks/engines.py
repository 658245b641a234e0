"""Trials per second of xlmc's engines beside the case study hand-written in NumPy, one thread each.

`python benchmarks/engines.py` runs every contestant in a process of its own, in turn, several rounds, and prints the
median of each with its ratio to the best hand-written kernel of the same round. A contestant's time covers drawing,
model, filters and keeping what was accepted; reading the workbook and compiling are not in it (the first run compiles,
and the fastest of a few counts).
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
from pathlib import Path
from time import perf_counter

HERE = Path(__file__).resolve().parent
CASE_STUDY = HERE.parent / "examples" / "intersection.xlsx"
TRIALS = {"formulas": 40, "jit": 10_000_000}
DEFAULT_TRIALS = 1_000_000
REPEATS = 3


def contestants() -> list[str]:
    """`hand/KERNEL/BLOCK` and `xlmc/ENGINE`."""
    sys.path.insert(0, str(HERE))
    from hand_written import BLOCKS, KERNELS

    return [
        *(f"hand/{kernel}/{block}" for kernel in KERNELS for block in BLOCKS),
        "xlmc/numpy",
        "xlmc/jit",
        "xlmc/formulas",
    ]


def rate(contestant: str) -> float:
    """Trials per second of one contestant, the best of a few runs in this process."""
    family, name, *block = contestant.split("/")
    trials = TRIALS.get(name, DEFAULT_TRIALS)
    if family == "hand":
        sys.path.insert(0, str(HERE))
        from hand_written import simulate

        def run() -> object:
            return simulate(trials, 1, int(block[0]), name)
    else:
        import xlmc

        model = xlmc.load(CASE_STUDY)

        def run() -> object:
            return model.simulate(trials, 1, engine=name)

    return max(_timed(run, trials) for _ in range(REPEATS))


def _timed(run: object, trials: int) -> float:
    start = perf_counter()
    run()  # type: ignore[operator]
    return trials / (perf_counter() - start)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--only", help="measure one contestant in this process and print its rate")
    arguments = parser.parse_args()
    if arguments.only:
        print(rate(arguments.only))
        return
    names = contestants()
    rounds: list[dict[str, float]] = []
    for _ in range(arguments.rounds):
        command = [sys.executable, __file__, "--only"]
        found = {n: float(subprocess.run([*command, n], check=True, capture_output=True).stdout) for n in names}
        rounds.append(found)
    best = [max(rate for name, rate in found.items() if name.startswith("hand")) for found in rounds]
    print(f"{'contestant':<24}{'trials/s':>14}{'ratio to best hand-written':>30}")
    for name in names:
        rates = [found[name] for found in rounds]
        ratios = [rate / top for rate, top in zip(rates, best, strict=True)]
        print(f"{name:<24}{statistics.median(rates):>14,.0f}{statistics.median(ratios):>30.3g}")


if __name__ == "__main__":
    main()
