"""Speed against accuracy: the error of the case study's answers against the seconds that they cost.

The truth is a run of 2·10⁹ trials made independently of this project. The error of a statistic at a trial count is the
root of the mean square over seeds and the four forecasts, in mph. Contestants that draw are run. The error of those
that only answer given trials is that of xlmc at the same trials, for they give the same forecasts; their time is the
trials over their measured rate.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from contest import Answer, Task
from line_up import Entry
from processes import ask
from rates import task_of

__all__ = ["LADDER", "SEEDS", "STATISTICS", "TRUTH", "errors", "measure"]

STATISTICS = ("mean", "SD", "24.5 %", "75.5 %")
TRUTH = np.array([
    [11.80333, 0.73709, 11.2793, 12.3532],
    [23.06344, 1.41424, 22.0565, 24.1252],
    [33.16317, 1.76307, 31.7987, 34.4853],
    [4.74205, 2.00052, 3.3507, 6.1320],
])  # fmt: skip
"""Forecasts by STATISTICS, mph. Its standard errors are .0001 to .0005."""

LADDER = (5_000, 20_000, 80_000, 320_000, 1_280_000)
SEEDS = 20


def measure(
    entries: Sequence[Entry],
    path: Path,
    rates: dict[str, Any],
    ladder: Sequence[int],
    seeds: int,
    limit: float,
    say: Callable[[str], None],
) -> dict[str, Any]:
    """Contestant -> trials, seconds (medians), errors (a list by STATISTICS for each trial count).

    `rates` are those of the case study, as `rates.measure` finds them: they tell the variants and the peers' speeds.
    """
    task = task_of("case-study", path, 0)
    curves: dict[str, Any] = {}
    for entry in entries:
        record = rates.get(entry.name)
        if record is None or record["absent"] or not _draws(entry):
            continue
        options = entry.variants[task.book][record["variant"]]
        given = {**vars(task), "options": options, "ladder": list(ladder), "seeds": seeds}
        answer = ask(entry.python, entry.module, Task(**given), limit)
        if isinstance(answer, str):
            say(f"accuracy of {entry.name}: {answer}")
            continue
        curves[entry.name] = _curve(answer, ladder)
        say(f"accuracy of {entry.name}: {curves[entry.name]['seconds'][-1]:.3g} s for {ladder[-1]:,} trials")
    for name, record in rates.items():
        if name not in curves and not record["absent"] and "xlmc/numpy" in curves:
            seconds = [trials / record["rate"] for trials in ladder]
            curves[name] = {**curves["xlmc/numpy"], "seconds": seconds, "by rate": True}
    return curves


def _draws(entry: Entry) -> bool:
    return entry.family != "peer" and entry.name != "xlmc/formulas"


def _curve(answer: Answer, ladder: Sequence[int]) -> dict[str, Any]:
    runs = [answer.samples[str(trials)] for trials in ladder]
    seconds = [statistics.median(seconds for seconds, _ in results) for results in runs]
    result = [errors(np.array([answers for _, answers in run])) for run in runs]
    return {
        "trials": list(ladder),
        "seeds": len(runs[0]),
        "seconds": seconds,
        "errors": [row.tolist() for row in result],
        "by rate": False,
    }


def errors(answers: Any) -> Any:
    """Root mean square errors, (4,) by STATISTICS, of answers (seeds, forecasts, 4), mph."""
    return np.sqrt(np.mean((np.asarray(answers) - TRUTH) ** 2, axis=(0, 1)))
