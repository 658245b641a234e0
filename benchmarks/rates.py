"""Trials per second of every contestant on every book, and whether they give the same forecasts."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

from contest import Answer, CellPlace, Task
from line_up import Entry
from processes import ask

__all__ = ["TOLERANCE", "differing", "measure", "task_of"]

TOLERANCE = 1e-9
"""Relative difference up to which forecasts are the same."""

CHECK, ROWS = 5, 256
SLOW = 20.0
"""A contestant whose process took more seconds takes part in the first round alone."""

Say = Callable[[str], None]


def task_of(book: str, path: Path, seconds: float) -> Task:
    """A task on a book: its check trials are accepted ones, its rows are any."""
    from xlmc.montecarlo.definitions.run_options import RunOptions
    from xlmc.montecarlo.model.loading import load
    from xlmc.montecarlo.simulation.simulate import run_model

    model = load(path)
    drawn = model.sampler(7, ROWS).draw(0)
    rows = [list(row) for row in zip(*(drawn[a.name].tolist() for a in model.live), strict=True)]
    check = rows[:CHECK]
    if model.filters:
        run = run_model(model, RunOptions.of(trials=100 * ROWS, seed=7))
        columns = [run.inputs[a.name][:CHECK].tolist() for a in model.live]
        check = [list(row) for row in zip(*columns, strict=True)]
    inputs = [CellPlace(a.cell.sheet, a.cell.row, a.cell.column) for a in model.live]
    forecasts = [CellPlace(f.cell.sheet, f.cell.row, f.cell.column) for f in model.forecasts]
    return Task(book, str(path), inputs, forecasts, check, rows, seconds)


def measure(
    entries: Sequence[Entry], paths: dict[str, Path], rounds: int, seconds: float, limit: float, say: Say
) -> dict[str, Any]:
    """Book -> contestant -> what was found. The contestants run one after another, round by round."""
    tasks = {book: task_of(book, path, seconds) for book, path in paths.items()}
    cells = {book: _cells(path) for book, path in paths.items()}
    result: dict[str, Any] = {book: {} for book in paths}
    best = {(b, e.name): _best_variant(e, tasks[b], limit, say) for b in paths for e in entries if b in e.books}
    for round_ in range(rounds):
        for book, entry in ((b, e) for b in paths for e in entries if b in e.books):
            record = result[book].setdefault(entry.name, _blank(entry, best[book, entry.name]))
            if round_ and (record["absent"] or record["slow"]):
                continue
            options = entry.variants.get(book, [{}])[record["variant"]]
            _one(record, entry, _with(tasks[book], options), limit)
            say(f"round {round_ + 1}, {book}, {entry.name}: {_said(record)}")
    for book, records in result.items():
        _compare(tasks[book], records)
        _ratios(records)
        _costs(records, cells[book])
    return result


def differing(task: Task, values: Sequence[Sequence[float | None]], truth: Sequence[Sequence[float]]) -> list[str]:
    """The forecasts that are not the same, each with its cell. Only numbers count."""
    result = []
    for trial, (row, true) in enumerate(zip(values, truth, strict=False)):
        for place, mine, theirs in zip(task.forecasts, row, true, strict=True):
            if mine is None or abs(mine - theirs) > TOLERANCE * max(abs(mine), abs(theirs)):
                result.append(f"{place} in check trial {trial + 1}: {mine!r}, not {theirs!r}")
    return result


def _blank(entry: Entry, variant: int) -> dict[str, Any]:
    return {"family": entry.family, "variant": variant, "rates": [], "ready": [], "slow": False, "absent": None}


def _one(record: dict[str, Any], entry: Entry, task: Task, limit: float) -> None:
    start = perf_counter()
    answer = ask(entry.python, entry.module, task, limit)
    record["slow"] = perf_counter() - start > SLOW
    if isinstance(answer, str):
        record["absent"] = answer
        return
    record["rates"].append(answer.rate)
    record["ready"].append(answer.ready)
    record |= {"trials": answer.trials, "note": answer.note, "versions": answer.versions, "values": answer.values}


def _said(record: dict[str, Any]) -> str:
    return record["absent"] or f"{record['rates'][-1]:,.4g} trials/s"


def _with(task: Task, options: dict[str, Any], seconds: float | None = None) -> Task:
    plain = {**vars(task), "options": options}
    return Task(**(plain if seconds is None else {**plain, "seconds": seconds}))


def _best_variant(entry: Entry, task: Task, limit: float, say: Say) -> int:
    """Which variant is the fastest, in short measurements."""
    variants = entry.variants.get(task.book, [{}])
    if len(variants) == 1:
        return 0
    rates = []
    for variant in variants:
        answer = ask(entry.python, entry.module, _with(task, variant, task.seconds / 4), limit)
        rates.append(answer.rate or 0.0 if isinstance(answer, Answer) else 0.0)
    best = rates.index(max(rates))
    kernel, chunk = variants[best]["kernel"], variants[best]["chunk"]
    say(f"{entry.name} on {task.book}: fastest with {kernel or 'its only kernel'} and chunks of {chunk}")
    return best


def _compare(task: Task, records: dict[str, Any]) -> None:
    """Add to every record how its forecasts compare with those of the first that has any."""
    answers = {name: record.pop("values") for name, record in records.items() if "values" in record}
    whole = [name for name, values in answers.items() if all(None not in row for row in values)]
    truth = answers[whole[0]] if whole else []
    for name, values in answers.items():
        records[name]["same as"] = whole[0] if whole else None
        records[name]["checked"] = len(values)
        records[name]["differs"] = differing(task, values, truth)


def _ratios(records: dict[str, Any]) -> None:
    """Add to every record its rate over that of others in the same round, medians."""
    for record in records.values():
        if record["absent"]:
            continue
        record["rate"] = statistics.median(record["rates"])
        record["ready_median"] = statistics.median(record["ready"])
        for other in ("hand/NumPy", "hand/C", "xlmc/numpy", "xlmc/jit"):
            theirs = records.get(other, {}).get("rates", [])
            both = list(zip(record["rates"], theirs, strict=False))
            if both:
                record[f"to {other}"] = statistics.median(mine / their for mine, their in both)


def _costs(records: dict[str, Any], cells: int) -> None:
    """Add to every record nanoseconds for each trial and formula cell that the forecasts need."""
    for record in records.values():
        if not record["absent"]:
            record["ns a cell"] = 1e9 / record["rate"] / cells


def _cells(path: Path) -> int:
    """Formula cells that the forecasts and filters of a book need and that depend on an assumption."""
    from xlmc.montecarlo.model.loading import load

    graph = load(path).needed.graph
    return sum(cell in graph.varying for cell in graph.formulas)
