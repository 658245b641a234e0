"""What `xlmc compare` found, as a document: two models side by side."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from math import isnan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from xlmc.analysis.studies.comparison import Comparison, ForecastComparison
    from xlmc.analysis.studies.comparison.causes import Step
    from xlmc.outputs.study_report import StudyReport

from xlmc.analysis.studies.steps import ended_early

__all__ = ["compare_report"]


def compare_report(comparison: Comparison) -> StudyReport:
    """Make the report."""
    from xlmc.analysis.studies.comparison.verdicts import book_names, verdict_text
    from xlmc.montecarlo.definitions.vocabulary import vocabulary_of
    from xlmc.outputs.document.parts import Table, blocks_of
    from xlmc.outputs.study_report import StudyReport

    books, words = book_names(comparison), vocabulary_of(comparison.first.model.workbook)
    headings = ("", "First", "Second", "Difference", "Tolerance")
    tables = [Table(_title(each), headings, tuple(_rows(each)), (1, 2, 3, 4)) for each in comparison.forecasts]
    blocks = blocks_of([*verdict_text(comparison), *tables, *_sentences(comparison), words.fill(_MEANING)])
    title, below = "Do two models give the same answer?", f"{books[0]} (first) and {books[1]} (second)"
    return StudyReport(title, below, blocks, "Comparison", partial(_as_json, comparison))


def _sentences(comparison: Comparison) -> Iterator[str]:
    from xlmc.analysis.studies.comparison.verdicts import book_names, inputs_text
    from xlmc.montecarlo.number_text import count_text
    from xlmc.outputs.summary import share_text

    books, accepted, trials = book_names(comparison), comparison.acceptance, comparison.first.trials
    if comparison.ended:
        yield ended_early(
            "search for causes", comparison.ended, "Where no cause is named, none was looked for to the end."
        )
    yield (
        f"Of {count_text(trials)} trials both accept {count_text(accepted.both)}; {books[0]} alone "
        f"{count_text(accepted.first_only)}, "
        f"{books[1]} alone {count_text(accepted.second_only)}; seed {comparison.first.settings.seed}."
    )
    if not (comparison.first.model.filters or comparison.second.model.filters):
        yield "Neither book has filters: every trial is accepted."
    elif accepted.both and not accepted.first_only + accepted.second_only:
        yield f"The acceptance is the same in both: {share_text(accepted.first)}."
    yield from inputs_text(comparison)


_MEANING = (
    "± is the standard error of each number (Monte Carlo error). That of a difference allows for the draws that both "
    "books share. The last two lines of a table compare the answers as a whole: the average difference of all "
    "percentiles (Wasserstein's distance), and the largest difference of the cumulative curves (Kolmogorov's "
    "distance). A verdict is given only where a difference is at least three errors away from the tolerance. It says "
    "that two models agree, not that either {fits}."
)


def _title(each: ForecastComparison) -> str:
    name = each.first.name if each.factor == 1.0 else f"{each.first.name} (second converted)"
    return f"{name}, {each.first.units}" if each.first.units else name


def _rows(each: ForecastComparison) -> list[tuple[str, ...]]:
    from xlmc.analysis.studies.comparison.verdicts import amount, is_chance, tolerance_text
    from xlmc.montecarlo.number_text import number_text, percent
    from xlmc.outputs.summary import estimate_text

    result, form = each.difference, each.difference.form
    rows = []
    for number, change in result.changes:
        label = f"{percent(result.share)} range, {number}" if number.endswith("end") else number
        both, apart = (change.first, change.second), change.difference
        if is_chance(number):
            values = [amount(number, one, form).removesuffix(" points") for one in (*both, apart)]
            rows.append((f"{label}, %", *values, number_text(100 * each.limits[number], 3)))
        else:
            written = form.spread if number == "SD" else form.estimate
            difference = "" if isnan(apart.value) else form.spread(apart)
            rows.append((label, *map(written, both), difference, tolerance_text(each.tolerance, form)))
    if not result.shares:
        rows.append(("percentiles, on average", "", "", form.spread(result.wasserstein), ""))
        rows.append(("cumulative curves, at most", "", "", estimate_text(result.kolmogorov), ""))
    return rows


def _as_json(comparison: Comparison) -> dict[str, object]:
    from xlmc.analysis.studies.comparison.verdicts import book_names, verdict_text
    from xlmc.outputs.studies.json_numbers import acceptance_json

    books, inputs = book_names(comparison), comparison.inputs
    return {
        "books": books,
        "ended_early": comparison.ended or None,
        "fed_by": None if comparison.source is None else comparison.source.model.path.name,
        "simpler": None if comparison.simpler is None else books[comparison.simpler],
        "trials": comparison.first.trials,
        "seed": comparison.first.settings.seed,
        "acceptance": acceptance_json(comparison.acceptance),
        "assumptions": {
            "alike": inputs.alike,
            "unlike": [
                {"name": u.name, "first": u.first, "second": u.second}
                for u in (*inputs.unlike, *inputs.frozen_differently)
            ],
            "drawn_only_in": dict(zip(books, inputs.drawn, strict=True)),
        },
        "filters_only_in": dict(zip(books, inputs.filters, strict=True)),
        "forecasts_only_in": dict(zip(books, comparison.unpaired, strict=True)),
        "forecasts": [_entry(each, books) for each in comparison.forecasts],
        "verdict": verdict_text(comparison),
        "trials_needed": comparison.trials_needed,
        "runs": comparison.runs,
    }


def _entry(each: ForecastComparison, books: tuple[str, str]) -> dict[str, object]:
    from xlmc.montecarlo.statistics.estimate import finite
    from xlmc.outputs.studies.json_numbers import difference_json, estimate_json

    entry: dict[str, object] = {
        "name": each.first.name,
        "name_in_second": each.second.name,
        "units": each.first.units,
        "second_multiplied_by": each.factor,
        "tolerance": finite(each.tolerance),
        "tolerance_stated": each.stated,
        "tolerances": dict(each.limits),
        "verdict": each.judgement.verdict.value,
        "decided_by": each.judgement.largest,
        "same_in_every_trial_both_accept": each.same_in_every_trial,
        **difference_json(each.difference),
    }
    if each.rivalry is not None:
        rivals = each.rivalry
        entry["two_models"] = {
            "drawn_only_for": dict(zip(books, rivals.own, strict=True)),
            "tells_more": None if rivals.sharper is None else books[rivals.sharper],
            "standard_deviations": [estimate_json(e) for e in (rivals.deviation.first, rivals.deviation.second)],
            "widths_of_central_range": [estimate_json(e) for e in (rivals.width.first, rivals.width.second)],
            "chance_of_such_a_difference": finite(rivals.chance),
            "trials_both_accept": rivals.both,
            "agreement": rivals.agreement.value,
        }
    if each.cause is not None:
        entry["cause"] = {
            "taken_out": [_step(step, books) for step in each.cause.steps],
            "largest_left": {"number": each.cause.number, "difference": estimate_json(each.cause.left)},
        }
    return entry


def _step(step: Step, books: tuple[str, str]) -> dict[str, str]:
    return {"kind": step.word, "book": books[step.side], "name": step.name}
