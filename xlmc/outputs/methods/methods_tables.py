"""The tables of a study of methods, as texts: the same for the terminal, the page and the workbook."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from xlmc.analysis.studies.methods import STATISTICS, Curve, Method, Runs, Study, need
from xlmc.analysis.studies.methods.answer import seconds_text, trials_text
from xlmc.analysis.studies.methods.need import worst_error
from xlmc.montecarlo.definitions.forms import Form, span_text
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.number_text import count_text, fixed_text, number_text, styled_text
from xlmc.montecarlo.sampling.sampling_methods import METHODS
from xlmc.montecarlo.statistics import Estimate
from xlmc.outputs.document.parts import Table
from xlmc.outputs.summary import share_text

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Forecast

__all__ = [
    "accepted_text",
    "bounds_table",
    "cannot",
    "cannot_lines",
    "ends_lines",
    "error_table",
    "floor_of",
    "forecast_table",
    "length_table",
    "near_text",
    "reference_table",
]

_NONE = "–"


def floor_of(study: Study, statistic: str) -> float:
    """Return the reference's own error of a statistic, over the forecasts' 5–95 % ranges."""
    reference = study.reference
    parts = [
        float(getattr(reference.errors[name], statistic)) / width
        for name, width in reference.widths.items()
        if study.converges(name, statistic)
    ]
    known = [part for part in parts if np.isfinite(part)]
    return float(np.sqrt(np.mean(np.square(known)))) if known else np.nan


def reference_table(study: Study) -> Table:
    """Return the reference, with its standard errors."""
    reference = study.reference
    rows = []
    for forecast in study.model.forecasts:
        answer, error = reference.answers[forecast.name], reference.errors[forecast.name]
        form = reference.form(forecast.name)
        numbers = (
            _of_kind(form, each, getattr(answer, each), getattr(error, each), spread=each == "sd")
            for each in STATISTICS
        )
        rows.append((forecast.name, forecast.units, *numbers))
    how = METHODS[reference.sampling].name
    title = (
        f"Reference: {count_text(reference.trials)} trials ({how}, engine {reference.engine}, seed {reference.seed}), "
        f"{accepted_text(study)}, {seconds_text(reference.seconds)}"
    )
    return _table(title, ("Forecast", "Units", *STATISTICS.values()), rows, 2)


def error_table(study: Study) -> Table:
    """Every method at its longest run: cost, error, slope, and what the accuracy asked for would take."""
    headings = (
        "Method", "Trials", "Time", "Evaluations", *STATISTICS.values(), "Accepted", "Effective", "Slope", "Needs",
    )  # fmt: skip
    rows = [(curve.method.name, *_cells(study, curve)) for curve in study.every if curve.answers]
    text = study.accuracy[0]
    title = (
        "Root mean square errors, in % of each forecast's 5–95 % range (over the forecasts); of the accepted share, in "
        f"% of it. Needs: for {text}, in 95 of 100 runs"
    )
    return _table(title, headings, rows)


def _cells(study: Study, curve: Curve) -> Iterator[str]:
    runs = curve.lengths[-1]
    drawn = curve not in study.once
    yield count_text(runs.budget) if drawn else _NONE
    yield ("" if runs.measured else "≈ ") + seconds_text(runs.seconds)
    yield fixed_text(runs.evaluations, 0)
    for statistic in STATISTICS:
        yield _share_text(runs.shares[statistic], 0.0 if drawn else floor_of(study, statistic))
    yield _accepted_share(study, runs)
    yield _NONE if runs.effective is None else fixed_text(runs.effective, 0)
    yield slope_text(curve.slope("mean", "budget"))
    yield _need_text(study, curve) if drawn else near_text(study, curve)


def _accepted_share(study: Study, runs: Runs) -> str:
    """Return the error of the share of accepted trials, in % of it; a dash without filters."""
    if runs.acceptance is None or not study.model.filters:
        return _NONE
    return percent_text(runs.acceptance.value / study.reference.acceptance.value)


def near_text(study: Study, curve: Curve) -> str:
    """Whether the answer of a method that gives only one is near enough."""
    if not study.varying:
        return _NONE
    return {"yes": "near enough", "no": "never", "unknown": "cannot tell"}[worst_error(study, curve).reaches]


def _need_text(study: Study, curve: Curve) -> str:
    result = need(study, curve)
    if not result.forecast:
        return _NONE
    if result.reaches != "yes":
        return {"no": "never", "unknown": "cannot tell"}[result.reaches]
    return f"{trials_text(result.trials)} trials, {seconds_text(result.seconds)}"


def length_table(study: Study) -> Table:
    """Every run length of every method."""
    work = ("Method", "Trials", "Runs", "Time", "Evaluations")
    headings = (*work, *STATISTICS.values(), "Accepted", "Effective", "Failed")
    rows: list[tuple[str, ...]] = []
    for curve in study.every:
        floors = {each: floor_of(study, each) if curve in study.once else 0.0 for each in STATISTICS}
        rows += [
            (
                curve.method.name,
                _NONE if curve in study.once else count_text(runs.budget),
                count_text(_runs(runs)),
                ("" if runs.measured else "≈ ") + seconds_text(runs.seconds),
                fixed_text(runs.evaluations, 0),
                *(_share_text(runs.shares[each], floors[each]) for each in STATISTICS),
                _accepted_share(study, runs),
                _NONE if runs.effective is None else fixed_text(runs.effective, 0),
                count_text(runs.failed) if runs.failed else _NONE,
            )
            for runs in (curve.lengths if curve.answers else ())
        ]
    title = "Errors in % of each forecast's 5–95 % range, root mean square over runs and forecasts"
    return _table(title, headings, rows)


def _runs(runs: Runs) -> int:
    return max(each.n for each in runs.errors.values()) + runs.failed


def forecast_table(study: Study) -> Table:
    """Every method's longest runs, forecast by forecast, in their units, beside what theory says of Monte Carlo."""
    rows = []
    for forecast in study.model.forecasts:
        trials = study.ladder[-1]
        form = study.reference.form(forecast.name)
        theory = (
            _of_kind(form, each, study.reference.theory(forecast.name, each, trials), np.nan, spread=True)
            for each in STATISTICS
        )
        rows.append((forecast.name, forecast.units, f"Theory, {count_text(trials)} independent trials", *theory))
        for curve in study.every:
            if curve.answers:
                result = {each: curve.lengths[-1].errors[forecast.name, each] for each in STATISTICS}
                cells = (_of_kind(form, key, each.value, each.error, spread=True) for key, each in result.items())
                rows.append((forecast.name, forecast.units, curve.method.name, *cells))
    headings = ("Forecast", "Units", "Method", *STATISTICS.values())
    return _table("Root mean square errors of the longest runs, in the forecasts' units", headings, rows, 3)


def bounds_table(study: Study) -> Table:
    """Return what the bounds methods give, beside the central range of the reference."""
    curves = [curve for curve in study.once if curve.ranges]
    rows: list[tuple[str, ...]] = []
    for forecast in study.model.forecasts:
        result = [curve.ranges.get(forecast.name, (np.nan, np.nan)) for curve in curves]
        form = study.reference.form(forecast.name)
        rows.append(
            (forecast.name, forecast.units, *(_ends(form, *each) for each in result), _central(study, forecast))
        )
    last = [curve.lengths[-1] for curve in curves]
    rows.append(("Evaluations", "", *(fixed_text(runs.evaluations, 0) for runs in last), ""))
    rows.append(("Time", "", *(seconds_text(runs.seconds) for runs in last), ""))
    headings = ("Forecast", "Units", *(curve.method.name for curve in curves), "Reference, central range")
    return _table("Bounds: what is possible", headings, rows, 2)


def ends_lines(study: Study) -> list[tuple[str, str]]:
    """Each optimised bound, and the point at which it is reached: the workbook accepts it, and gives this forecast."""
    units = {forecast.name: f" {forecast.units}" if forecast.units else "" for forecast in study.model.forecasts}
    result = []
    for curve in study.once:
        for (name, end), point in curve.ends.items():
            value = curve.ranges[name][end == "most"]
            message = study.reference.form(name).rough(value)
            sentence = f"{'Lowest' if end == 'least' else 'Highest'} {name}: {message}{units[name]}"
            result.append(
                (sentence, "; ".join(f"{assumption} = {number_text(at, 10)}" for assumption, at in point.items()))
            )
    return result


def cannot_lines(study: Study) -> list[tuple[str, str]]:
    """List method -> what it cannot do, and what its run had to say; methods that could not be used, and why."""
    result = []
    for curve in study.every:
        parts = [each for each in (cannot(study, curve.method), *curve.remarks) if each]
        if curve.setup > 0.1:
            parts.append(f"its first run took {seconds_text(curve.setup)} longer, to compile or import")
        if parts:
            result.append((curve.method.name, "; ".join(parts)))
    result += [(name, f"not used: {why.removesuffix('.')}") for name, why in study.absent.items()]
    return result


def cannot(study: Study, method: Method) -> str:
    """Say what a method cannot do on this workbook: without filters, nothing that only filters would show."""
    if study.model.filters:
        return method.cannot
    return "; ".join(
        part
        for sentence in method.cannot.split("; ")
        if (part := sentence.replace(", does not see filters,", "")) and not part.startswith(_OF_FILTERS)
    )


_OF_FILTERS: Final = ("does not see filters", "filters take", "sees one assumption at a time")


def accepted_text(study: Study) -> str:
    """Write the acceptance, `accepted 1.7566 ± 0.0023 %`, or that there is no filter."""
    return f"accepted {share_text(study.reference.acceptance)}" if study.model.filters else "no filters"


def _of_kind(form: Form, statistic: str, value: float, error: float, *, spread: bool) -> str:
    """Write a number as the forecast is written, with its error and no more digits than that supports.

    A dash where there is none, and of a yes/no answer for all but its share.

    Args:
        form: of the forecast.
        statistic: attribute of an `Answer`.
        value: the number.
        error: its own; nan where it is not known, and two digits are written.
        spread: whether it is a standard deviation or an error: of dates a span of time.
    """
    if not np.isfinite(value) or (form.kind is Kind.YES_NO and statistic != "mean"):
        return _NONE
    if np.isfinite(error):
        estimate = Estimate(float(value), float(error))
        return form.spread(estimate) if spread else form.estimate(estimate)
    return span_text(float(value)) if form.kind is Kind.DATE else form.rough(float(f"{value:.2g}"))


def _central(study: Study, forecast: Forecast) -> str:
    """Return the central range of the reference, in the digits that its errors support."""
    answer, error = study.reference.answers[forecast.name], study.reference.errors[forecast.name]
    form = study.reference.form(forecast.name)
    if form.kind is Kind.YES_NO or not (np.isfinite(answer.low) and np.isfinite(answer.high)):
        return _NONE
    low, high = Estimate(answer.low, error.low), Estimate(answer.high, error.high)
    decimals = form.decimals_of_both(low, high)
    if decimals is None:
        return " to ".join(form.value(end) for end in (low, high))
    return " to ".join(form.number(end.value, decimals) for end in (low, high))


def _ends(form: Form, least: float, most: float) -> str:
    """Both to a hundredth, whole from 1,000 on, or to four digits where they are small."""
    if not (np.isfinite(least) and np.isfinite(most)):
        return _NONE
    size = form.factor * max(abs(least), abs(most))
    if form.kind is Kind.DATE or size < 0.1:
        return " to ".join(form.rough(end if form.kind is Kind.DATE else float(f"{end:.4g}")) for end in (least, most))
    decimals = 0 if size >= 1_000.0 or form.kind in (Kind.WHOLE, Kind.YES_NO) else 2
    return " to ".join(form.number(end, decimals) for end in (least, most))


def _number(value: float) -> str:
    """Two significant digits, whole numbers from 10 on; a dash where there is none."""
    if not np.isfinite(value):
        return _NONE
    return fixed_text(value, 0) if abs(value) >= 10 else styled_text(value, "#.2g").removesuffix(".")


def _share_text(share: float, floor: float) -> str:
    if not np.isfinite(share):
        return _NONE
    return f"≤ {_number(100.0 * floor)}" if share < floor else percent_text(share)


def percent_text(share: float) -> str:
    """`2.4`: two significant digits, whole numbers from 10 on."""
    return _number(100.0 * share)


def slope_text(slope: float) -> str:
    """`−0.49`."""
    return _NONE if not np.isfinite(slope) else styled_text(slope, ".2f").replace("-", "−")


def _table(title: str, headings: Sequence[str], rows: Sequence[tuple[str, ...]], first: int = 1) -> Table:
    """Make a table whose columns from `first` on hold numbers."""
    return Table(title, tuple(headings), tuple(rows), tuple(range(first, len(headings))))
