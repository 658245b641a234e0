"""What `xlmc uncertainty` found, as a document: how uncertain answers are where a mean or a range is not known."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from xlmc.analysis.studies.uncertainty import Band, ForecastBands, TwoLoops
    from xlmc.montecarlo.statistics import Estimate
    from xlmc.outputs.document.parts import Block, Figure, Table
    from xlmc.outputs.study_report import StudyReport

__all__ = ["uncertainty_report"]


def uncertainty_report(loops: TwoLoops) -> StudyReport:
    """Make the report."""
    from xlmc.montecarlo.number_text import count_text
    from xlmc.outputs.document.parts import blocks_of
    from xlmc.outputs.study_report import StudyReport

    below = (
        f"{loops.run.model.workbook.name}: {count_text(loops.outer)} outer draws, "
        f"{count_text(loops.inner)} trials each, "
        f"seed {loops.run.settings.seed}"
    )
    blocks = blocks_of([*_sentences(loops), *_tables(loops), *_meaning(loops)])
    title = "How uncertain are the distributions of the answers?"
    return StudyReport(title, below, blocks, "Uncertainty", partial(_as_json, loops), loops.run)


def _sentences(loops: TwoLoops) -> Iterator[str]:
    from xlmc.montecarlo.number_text import number_text

    for each in loops.forecasts:
        for band in each.stated:
            if band.is_share and band.low.value == band.high.value in (0.0, 1.0):
                share = band.form.number(band.low.value)
                draws = f"{number_text(loops.confidence)} % of the outer draws or more"
                yield f"{_subject(each, band)} is {share} in {draws}, as far as their trials tell."
                continue
            yield f"{_subject(each, band)} is {_ends(each, band)} with {number_text(loops.confidence)} % confidence."
    if loops.texts:
        yield f"Not told, since the answers are texts: {'; '.join(loops.texts)}."
    if loops.valueless:
        yield f"No number in any accepted trial: {'; '.join(loops.valueless)}."


def _subject(each: ForecastBands, band: Band) -> str:
    name = each.definition.name
    if band.number.startswith("P("):
        return f"{name}: {band.number}"
    return f"The {band.number.removesuffix(' of yes')} of {name}"


def _ends(each: ForecastBands, band: Band) -> str:
    """`between 41.2 and 47.9 mph`, both in the digits that the larger of their errors supports; as the table without
    errors. Ends that read alike, as those of a constant, stand once.
    """
    both = (band.low, band.high)
    decimals = band.form.decimals_of_both(*both)
    if any(end.error is None for end in both):
        low, high = (band.form.beside(end.value, _like(each, band)) for end in both)
    else:
        low, high = (band.form.number(end.value, decimals) for end in both)
    ends = low if low == high else f"between {low} and {high}"
    units = f" {each.definition.units}" if each.definition.units and not band.is_share else ""
    return f"{ends}{units}"


def _like(each: ForecastBands, band: Band) -> Estimate:
    """Return the number whose digits those of a row take that have no error: that of all trials, or the mean where that
    has none, either; whole numbers stay whole.
    """
    from xlmc.montecarlo.definitions.stating import Kind

    has_own = band.pooled.error is not None or band.is_share or band.form.kind is Kind.WHOLE
    return band.pooled if has_own else each.bands[0].pooled


def _tables(loops: TwoLoops) -> Iterator[Block]:
    for each in loops.forecasts:
        yield _table(loops, each)
        if any(low != high for low, high in zip(each.low, each.high, strict=True)) and not each.bands[0].is_share:
            yield _curve(loops, each)
    if len(loops.uncertain) > 1 and loops.forecasts:
        yield _causes(loops)


def _title(each: ForecastBands) -> str:
    return f"{each.definition.name}, {each.definition.units}" if each.definition.units else each.definition.name


def _table(loops: TwoLoops, each: ForecastBands) -> Table:
    from xlmc.analysis.studies.uncertainty import DEVIATION
    from xlmc.outputs.document.parts import Table

    rows = tuple(
        (band.number, *_texts(band, _like(each, band), is_spread=band.number == DEVIATION)) for band in each.bands
    )
    heads = ("Number", "All trials", "Band from", "Band to")
    return Table(_title(each), heads, rows, (1, 2, 3))


def _texts(band: Band, like: Estimate, *, is_spread: bool) -> Iterator[str]:
    """Yield the number of all trials and both ends; an end without an error in the digits of the other numbers."""
    from xlmc.montecarlo.definitions.stating import Kind

    write = band.form.spread if is_spread else band.form.estimate
    for end in (band.pooled, band.low, band.high):
        if end.error is not None or (is_spread and band.form.kind is Kind.DATE):
            yield write(end)
        else:
            yield band.form.beside(end.value, like)


def _curve(loops: TwoLoops, each: ForecastBands) -> Figure:
    from xlmc.montecarlo.number_text import number_text
    from xlmc.outputs.document.parts import Chart, Figure, Line, Lines

    shares = each.shares.tolist()
    columns = (("All trials", each.curve), ("Band, lower end", each.low), ("Band, upper end", each.high))
    lines = tuple(Line(name, tuple(zip(values.tolist(), shares, strict=True))) for name, values in columns)
    name = each.definition.name
    message = f"{name}: the cumulative curve of all trials, and its {number_text(loops.confidence)} % band"
    shown = Lines(lines, "Cumulative share", share=True, form_across=each.form)
    return Figure(Chart("", _title(each), shown, message), message)


def _causes(loops: TwoLoops) -> Table:
    from xlmc.outputs.document.parts import Table
    from xlmc.outputs.summary import estimate_text

    shown = loops.forecasts
    rows = tuple((name, *(estimate_text(each.causes[name]) for each in shown)) for name in loops.uncertain)
    title = "What makes the bands wide: rank correlation of each uncertain assumption with the mean"
    heads = ("Uncertain", *(each.definition.name for each in shown))
    return Table(title, heads, rows, tuple(range(1, len(heads))))


def _meaning(loops: TwoLoops) -> Iterator[str]:
    from xlmc.montecarlo.number_text import count_text, fixed_text, number_text, styled_text

    run = loops.run
    yield (
        f"Uncertain, drawn in the outer loop: {'; '.join(loops.uncertain)}. "
        f"Variable, drawn in the inner loop: {'; '.join(loops.variable) or 'none'}."
    )
    if run.accepted < run.trials:
        empty = f" For {count_text(loops.empty)} of the outer draws no trial was accepted." if loops.empty else ""
        few = min((each.effective for each in loops.forecasts), default=0.0)
        yield (
            f"Of {count_text(run.trials)} trials {count_text(run.accepted)} were accepted. An outer "
            "draw counts by its accepted trials; "
            f"together they say as much as {fixed_text(few, 0)} draws of equal weight.{empty}"
        )
    losing = [each.definition.name for each in loops.forecasts if run.loses_too_many(each.definition.name)]
    if losing:
        most = max(run.lost_share(name) for name in losing)
        yield (
            f"Errors in cells take up to {number_text(100.0 * most, 2)} % of the trials: what is said of "
            f"{'; '.join(losing)} concerns those that are left."
        )
    if any(end.error is None for each in loops.forecasts for band in each.bands for end in (band.low, band.high)):
        yield "An end without ± is decided by one or two outer draws: take more of them (--outer)."
    if loops.wide:
        each, band = max(loops.wide, key=lambda one: one[1].excess)
        yield (
            f"Too wide by up to {styled_text(band.excess, '.0%')} ({band.number} of "
            f"{each.definition.name}): {count_text(loops.inner)} inner "
            "trials scatter. More of them (--inner) make the bands narrower."
        )
    yield (
        "Each outer draw is one thing that may be true, and its inner trials show what then varies. All trials: both "
        f"together, as xlmc simulate has them. Band: the central {number_text(loops.confidence)} % of "
        "what the outer draws give. "
        "± is the standard error (Monte Carlo error) of a number; more outer draws (--outer) make that of the ends "
        "smaller."
    )


def _as_json(loops: TwoLoops) -> dict[str, object]:
    run = loops.run
    return {
        "book": str(run.model.path),
        "outer": loops.outer,
        "inner": loops.inner,
        "seed": run.settings.seed,
        "confidence": loops.confidence,
        "trials": run.trials,
        "accepted": run.accepted,
        "outer_draws_without_accepted_trials": loops.empty,
        "uncertain": loops.uncertain,
        "variable": loops.variable,
        "forecasts": [_forecast_json(each) for each in loops.forecasts],
        "forecasts_of_texts": loops.texts,
        "forecasts_without_numbers": loops.valueless,
    }


def _forecast_json(each: ForecastBands) -> dict[str, object]:
    from xlmc.outputs.studies.json_numbers import estimate_json

    columns = (column.tolist() for column in (each.shares, each.curve, each.low, each.high))
    return {
        "name": each.definition.name,
        "cell": str(each.definition.cell),
        "units": each.definition.units,
        "outer_draws": each.draws,
        "effective_outer_draws": each.effective,
        "numbers": [
            {
                "number": band.number,
                "all_trials": estimate_json(band.pooled),
                "low": estimate_json(band.low),
                "high": estimate_json(band.high),
                "too_wide_by": band.excess,
            }
            for band in each.bands
        ],
        "curve": [
            {"share": share, "all_trials": value, "low": low, "high": high}
            for share, value, low, high in zip(*columns, strict=True)
        ],
        "rank_correlations_with_mean": {name: estimate_json(one) for name, one in each.causes.items()},
    }
