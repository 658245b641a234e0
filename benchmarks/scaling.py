"""One thread against two, on the case study: the same run with `jobs=1` and `jobs=2`, in turn, in fresh processes."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from line_up import Entry
from processes import ask
from rates import task_of

__all__ = ["THREADS", "measure"]

THREADS = (1, 2)


def measure(
    entries: Sequence[Entry], path: Path, rounds: int, seconds: float, limit: float, say: Callable[[str], None]
) -> dict[str, Any]:
    """Engine -> rates with one and with two threads, and the median of their ratio in the same round."""
    task = task_of("case-study", path, seconds)
    found: dict[str, Any] = {}
    for round_ in range(rounds):
        for entry in entries:
            if entry.family != "xlmc" or entry.name == "xlmc/formulas":
                continue
            rates = found.setdefault(entry.name, {str(jobs): [] for jobs in THREADS})
            for jobs in THREADS:
                options = {**entry.variants[task.book][0], "jobs": jobs}
                answer = ask(entry.python, entry.module, type(task)(**{**vars(task), "options": options}), limit)
                if isinstance(answer, str) or answer.rate is None:
                    raise RuntimeError(f"{entry.name} with {jobs} threads: {answer}")
                rates[str(jobs)].append(answer.rate)
                say(f"round {round_ + 1}, {entry.name}, {jobs} threads: {answer.rate:,.4g} trials/s")
    for rates in found.values():
        pairs = list(zip(rates["1"], rates["2"], strict=True))
        rates["ratio"] = statistics.median(two / one for one, two in pairs)
    return found
