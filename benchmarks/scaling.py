"""One job against two, on the case study: the same run with `jobs=1` and `jobs=2`, in turn, in fresh processes.

Where xlmc runs the blocks in processes, these wait for the next run. So it is measured twice: with a process that
waits, as from the second run of a program on, and with one that every run starts anew.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from contest import REPEATS
from line_up import Entry
from processes import ask
from rates import task_of

__all__ = ["ANEW", "measure"]

ANEW = "2 anew"
WAYS: dict[str, dict[str, Any]] = {"1": {"jobs": 1}, "2": {"jobs": 2}, ANEW: {"jobs": 2, "anew": True}}
BY_PROCESSES = ("xlmc/numpy",)


def measure(
    entries: Sequence[Entry], path: Path, rounds: int, seconds: float, limit: float, say: Callable[[str], None]
) -> dict[str, Any]:
    """Engine -> way -> rates, and `ratios`: way -> the median of its ratio to one job in the same round."""
    task = task_of("case-study", path, REPEATS * seconds)
    found: dict[str, Any] = {}
    for round_ in range(rounds):
        for entry in entries:
            if entry.family != "xlmc" or entry.name == "xlmc/formulas":
                continue
            ways = {way: more for way, more in WAYS.items() if way != ANEW or entry.name in BY_PROCESSES}
            rates = found.setdefault(entry.name, {way: [] for way in ways})
            trials = 0
            for way, more in ways.items():
                asked = replace(task, options={**entry.variants[task.book][0], **more}, trials=trials)
                answer = ask(entry.python, entry.module, asked, limit)
                if isinstance(answer, str) or answer.rate is None:
                    raise RuntimeError(f"{entry.name} with -j {way}: {answer}")
                trials = answer.trials  # the same with two jobs as with one
                rates[way].append(answer.rate)
                say(f"round {round_ + 1}, {entry.name}, -j {way}: {answer.rate:,.4g}/s, {trials:,} trials")
    for rates in found.values():
        ratios = {way: [b / a for a, b in zip(rates["1"], many, strict=True)] for way, many in rates.items()}
        rates["ratios"] = {way: statistics.median(ratio) for way, ratio in ratios.items() if way != "1"}
    return found
