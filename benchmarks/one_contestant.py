"""One contestant on one book, in this process: the task as JSON on stdin, the answer as JSON on stdout."""

from __future__ import annotations

import importlib
import json
import math
import sys
from dataclasses import asdict
from time import perf_counter

from contest import Answer, Task, measured


def main() -> None:
    """Import, load, answer, measure."""
    given = json.load(sys.stdin)
    module, task = given["module"], Task.of(given["task"])
    start = perf_counter()
    contestant = importlib.import_module(f"contestants.{module}").prepare(task)
    contestant.answers(task.check[:1])
    ready = perf_counter() - start
    values = [[_real(value) for value in row] for row in contestant.answers(task.check)]
    answer = Answer(values, ready, versions=contestant.versions)
    if task.seconds:
        contestant.settle()
        answer.rate, answer.trials = measured(contestant.run, contestant.fewest, task.seconds)
    answer.note = contestant.note
    # What a library prints must not get between the answer and its reader.
    sys.stdout.write("\n" + json.dumps(asdict(answer)) + "\n")


def _real(value: object) -> float | None:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return None
    return float(value)


if __name__ == "__main__":
    main()
