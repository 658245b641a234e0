"""One contestant on one book, in this process: the task as JSON on stdin, the answer as JSON on stdout."""

from __future__ import annotations

import importlib
import json
import math
import sys
from collections.abc import Iterator
from dataclasses import asdict
from time import perf_counter
from typing import Any

from contest import Answer, Contestant, Task, measured

CHECKED_FOR = 3.0
"""Seconds after which no further check trial is begun."""


def main() -> None:
    """Import, load, answer, measure."""
    given = json.load(sys.stdin)
    module, task = given["module"], Task.of(given["task"])
    start = perf_counter()
    contestant = importlib.import_module(f"contestants.{module}").prepare(task)
    first = contestant.answers(task.check[:1])
    ready = perf_counter() - start
    values = [[_real(value) for value in row] for row in [*first, *_more(contestant, task.check[1:])]]
    answer = Answer(values, ready, versions=contestant.versions)
    if task.seconds:
        contestant.settle()
        answer.rate, answer.trials = measured(contestant.run, contestant.fewest, task.seconds)
    for trials in task.ladder:
        contestant.sample(trials, 0)  # type: ignore[attr-defined]  # only those that draw are asked
        answer.samples[str(trials)] = [_sampled(contestant, trials, seed) for seed in range(1, task.seeds + 1)]
    answer.note = contestant.note
    # What a library prints must not get between the answer and its reader.
    sys.stdout.write("\n" + json.dumps(asdict(answer)) + "\n")


def _more(contestant: Contestant, rows: list[list[float]]) -> Iterator[list[Any]]:
    """Answers to further check trials, as many as come in reasonable time."""
    start = perf_counter()
    for row in rows:
        if perf_counter() - start > CHECKED_FOR:
            return
        yield contestant.answers([row])[0]


def _sampled(contestant: Any, trials: int, seed: int) -> list[Any]:
    start = perf_counter()
    columns = contestant.sample(trials, seed)
    return [perf_counter() - start, statistics(columns)]


def statistics(columns: Any) -> list[list[float]]:
    """Mean, standard deviation and the ends of the central 51 % range of every forecast, (f, 4)."""
    import numpy as np

    return [[v.mean(), v.std(ddof=1), *np.quantile(v, (0.245, 0.755))] for v in columns]


def _real(value: object) -> float | None:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return None
    return float(value)


if __name__ == "__main__":
    main()
