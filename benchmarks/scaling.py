"""One job against two, on the case study: the same runs in turn, in one process for each engine and round.

Where xlmc runs the blocks in processes, these wait for the next run. So it is measured twice: with a process that
waits, as from the second run of a program on, and with one that every run starts anew. Two programs at once, with one
job each, show what the machine itself has to give.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from line_up import Entry
from one_scaling import ANEW, APART, ONE
from processes import answer_of

__all__ = ["ANEW", "APART", "TURNS", "measure"]

TURNS = 5
"""Runs of each way in a round; other work on the machine only ever slows."""

ENGINES = {"xlmc/numpy": "processes", "xlmc/jit": "threads"}
"""Those measured, and by what they run long runs; `formulas` is the slow reference."""


def measure(
    entries: Sequence[Entry],
    path: Path,
    rounds: int,
    turns: int,
    seconds: float,
    limit: float,
    say: Callable[[str], None],
) -> dict[str, Any]:
    """Engine -> way -> rates, and `ratios`: way -> the median of its ratio to one job in the same round.

    A run with one job takes about `seconds`. In a round each way has so many `turns`, of which the fastest counts.
    """
    result: dict[str, Any] = {}
    for round_ in range(rounds):
        for entry in (each for each in entries if each.name in ENGINES):
            task = {
                "path": str(path),
                "engine": entry.name.removeprefix("xlmc/"),
                "seconds": seconds,
                "turns": turns,
                "processes": ENGINES[entry.name] == "processes",
                "other": False,
            }
            answer = answer_of(entry.python, "one_scaling.py", task, limit)
            if isinstance(answer, str):
                raise RuntimeError(f"{entry.name}: {answer}")
            rates = result.setdefault(entry.name, {way: [] for way in answer["seconds"]})
            for way, taken in answer["seconds"].items():
                runs = 2 if way == APART else 1
                rates[way].append(runs * answer["trials"] / min(taken))
                say(f"round {round_ + 1}, {entry.name}, {way}: {rates[way][-1]:,.4g}/s, {answer['trials']:,} trials")
    for rates in result.values():
        ratios = {way: [b / a for a, b in zip(rates[ONE], many, strict=True)] for way, many in rates.items()}
        rates["ratios"] = {way: statistics.median(ratio) for way, ratio in ratios.items() if way != ONE}
    return result
