"""`xlmc screen`: which assumptions the answer does not need."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.parameter_types import OneOf, WholeNumber
from xlmc.cli.run_options import jobs_option
from xlmc.cli.terminal import paragraph, say, say_json

if TYPE_CHECKING:
    from xlmc.analysis import Cost, Screening

__all__ = ["screen"]

NOT_TO_BE_USED = 1


@click.command()
@click.argument("book", type=click.Path(path_type=Path))
@click.option(
    "--tolerance",
    multiple=True,
    help="What difference counts as none: 0.5, '0.5 mph', '10 %' of the SD, 'Name=0.5 mph'; may be given several"
    " times.  [default: 10 %]",
)
@click.option(
    "--acceptance",
    type=click.FloatRange(0, min_open=True),
    default=10.0,
    show_default=True,
    help="What change of the share of accepted trials counts as none, in % of it.",
)
@click.option(
    "--freeze",
    multiple=True,
    help="Also say what holding these assumptions at once costs: names joined by commas, * for any letters; may be"
    " given several times.",
)
@click.option("-n", "--trials", type=WholeNumber(1), help="Trials of each run.  [default: the book's, else 200000]")
@click.option("--seed", type=WholeNumber(0), help="Seed of each run.  [default: the book's, else 999]")
@click.option("--engine", type=OneOf("numpy", "jit", "formulas"), help="As for xlmc simulate.")
@jobs_option
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
@click.option("--quiet", is_flag=True, help="Print no notes of what is running.")
def screen(
    book: Path,
    tolerance: tuple[str, ...],
    acceptance: float,
    freeze: tuple[str, ...],
    trials: int | None,
    seed: int | None,
    engine: str | None,
    jobs: int,
    as_json: bool,
    quiet: bool,
) -> None:
    """Find which assumptions of BOOK may be held, and which filters left out, without moving its answers."""
    from xlmc import analysis
    from xlmc.cli.printing import telling, warnings
    from xlmc.model import load

    model = load(book)
    with telling(quiet) as told:
        found = analysis.screen(
            model,
            tolerance,
            acceptance_tolerance=acceptance / 100.0,
            sets=freeze,
            trials=trials,
            seed=seed,
            engine=engine,
            jobs=jobs,
            told=told,
        )
    if as_json:
        say_json(_as_json(found))
    else:
        _show(found)
    warnings(found.run.warnings)
    if found.run.warnings:
        raise click.exceptions.Exit(NOT_TO_BE_USED)


def _show(found: Screening) -> None:
    name, trials = found.run.model.workbook.name, found.run.trials
    expected = [f"{each.size:.2g}" for each in found.expected]
    title = f"{name}: each assumption held at its base value, the least expected cost first"
    _table(found, title, found.single, ("Held", _names(found.single)), ("Expected", expected))
    if found.sets:
        _table(found, "Held at once, as asked", found.sets, ("Held", _names(found.sets)))
    if found.filters:
        held = " with the assumptions below held" if found.joint else ""
        _table(found, f"Each filter left out{held}", found.filters, ("Left out", _names(found.filters)))
    for sentence in _sentences(found):
        say(paragraph(sentence))
    say(
        paragraph(
            f"{found.runs} runs of {trials:,} trials, seed {found.run.settings.seed}, over the same draws; ± is the "
            "standard error of a change (Monte Carlo error). A verdict clears the tolerance by three errors."
        )
    )


def _table(found: Screening, title: str, costs: Sequence[Cost], *first: tuple[str, Sequence[str]]) -> None:
    """What each change moves: of every forecast, the number that it moves most. `first` are columns with headings."""
    from xlmc.cli.printing import table

    headings = [*(heading for heading, _ in first), "Cost", "Accepted, %"]
    headings += [_heading(found, name) for name in found.tolerances]
    rows = [
        [
            *(column[place] for _, column in first),
            f"{cost.size:.2g}",
            _percent(cost),
            *(_most_moved(cost, name) for name in found.tolerances),
            cost.judgement.verdict.value,
        ]
        for place, cost in enumerate(costs)
    ]
    table(title, [*headings, "Verdict"], rows, right=range(1, len(headings)))


def _names(costs: Sequence[Cost]) -> list[str]:
    return [", ".join(cost.names) for cost in costs]


def _heading(found: Screening, name: str) -> str:
    forecast = found.run[name].definition
    return f"{name}, {forecast.units}" if forecast.units else name


def _percent(cost: Cost) -> str:
    from xlmc.statistics import format_estimate

    change = cost.acceptance.relative
    return format_estimate(100.0 * change.value, None if change.error is None else 100.0 * change.error)


def _most_moved(cost: Cost, name: str) -> str:
    """The largest of the changes of mean, SD and both ends of the central range."""
    from xlmc.report.summary import estimate_text

    changes = [change.difference for _, change in cost.forecasts[name].changes]
    return estimate_text(max(changes, key=lambda change: abs(change.value)))


def _sentences(found: Screening) -> Iterable[str]:
    from xlmc.analysis.wording import undecided_text

    yield (
        "Under each forecast: the largest move of mean, SD and both ends of its central range. Cost and expected cost: "
        f"the largest of all moves, measured in its tolerance. Tolerances: {_tolerances(found)}."
    )
    if found.idle:
        yield f"No forecast or filter needs {'; '.join(found.idle)}."
    if found.baseless:
        yield f"Not screened, for their cells are blank: {'; '.join(found.baseless)}."
    if found.joint:
        yield (
            f"Not needed: {'; '.join(found.joint.names)}. With all of them held at their base values in one run, no "
            f"number moves by more than {found.joint.size:.2f} of its tolerance; acceptance {_percent(found.joint)} %."
        )
    else:
        yield "Every assumption is needed, as far as these trials tell."
    if found.only_alone:
        yield f"Within the tolerance alone, but not surely together with those: {'; '.join(found.only_alone)}."
    if found.reduced:
        yield (
            f"Filters that then decide nothing here: {'; '.join(found.reduced.names)}. Without them no number moves by "
            f"more than {found.reduced.size:.2f} of its tolerance. A filter that rejects the impossible may stay."
        )
    if found.constant:
        yield f"Formula cells that then do not vary: {', '.join(map(str, found.constant))}."
    if found.dropped:
        yield f"Formula cells that then are not needed: {', '.join(map(str, found.dropped))}."
    yield f"Of {found.cells} formula cells that the book needs, {found.varying} then vary."
    if found.undecided:
        names = "; ".join(undecided_text(cost, found.run.trials) for cost in found.undecided)
        yield f"Undecided at {found.run.trials:,} trials, and therefore kept: {names}."


def _tolerances(found: Screening) -> str:
    parts = []
    for name, (value, stated) in found.tolerances.items():
        source = "" if stated else " (a tenth of the SD)"
        parts.append(f"{name} {value:.3g} {found.run[name].definition.units}".rstrip() + source)
    return "; ".join([*parts, f"acceptance {100 * found.acceptance_tolerance:g} % of itself"])


def _as_json(found: Screening) -> dict[str, object]:
    from xlmc.cli.plain import estimate_json

    run = found.run
    return {
        "book": str(run.model.path),
        "trials": run.trials,
        "seed": run.settings.seed,
        "acceptance": estimate_json(run.acceptance),
        "tolerances": {name: {"value": value, "stated": stated} for name, (value, stated) in found.tolerances.items()},
        "acceptance_tolerance": found.acceptance_tolerance,
        "not_needed_by_any_cell": found.idle,
        "without_base_value": found.baseless,
        "held_alone": [_entry(cost, found) for cost in found.single],
        "held_together": None if found.joint is None else _entry(found.joint, found),
        "held_as_asked": [_entry(cost, found) for cost in found.sets],
        "filters_left_out_alone": [_entry(cost, found) for cost in found.filters],
        "filters_left_out_together": None if found.reduced is None else _entry(found.reduced, found),
        "cells": {
            "needed": found.cells,
            "varying_then": found.varying,
            "constant_then": [str(cell) for cell in found.constant],
            "not_needed_then": [str(cell) for cell in found.dropped],
        },
        "runs": found.runs,
    }


def _entry(cost: Cost, found: Screening) -> dict[str, object]:
    from xlmc.cli.plain import acceptance_json, difference_json, finite

    expected = {each.name: each.size for each in found.expected}
    return {
        "names": cost.names,
        "expected_cost": finite(expected.get(cost.names[0])) if len(cost.names) == 1 else None,
        "cost": finite(cost.size),
        "verdict": cost.judgement.verdict.value,
        "decided_by": cost.judgement.largest,
        "trials_needed": finite(cost.judgement.times * found.run.trials),
        "acceptance": acceptance_json(cost.acceptance),
        "forecasts": {name: difference_json(each) for name, each in cost.forecasts.items()},
    }
