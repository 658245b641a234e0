"""How soon `xlmc --help` answers: `python benchmarks/startup.py` prints its time over that of importing click."""

from __future__ import annotations

import statistics
import subprocess
import sys
from time import perf_counter

ROUNDS = 15
BARE = [sys.executable, "-c", "import sys, click"]
HELP = [sys.executable, "-m", "xlmc", "--help"]


def seconds(command: list[str]) -> float:
    """How long a command takes as a whole process."""
    start = perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return perf_counter() - start


def main() -> None:
    """Run both in turn and print the median of the ratios."""
    ratios = [seconds(HELP) / seconds(BARE) for _ in range(ROUNDS)]
    print(f"xlmc --help takes {statistics.median(ratios):.2f} times as long as Python importing click")


if __name__ == "__main__":
    main()
