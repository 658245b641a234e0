"""The answer in a few lines, as the paper's Table 2 gives it: the same numbers for the command line and the sheets."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from xlmc.analysis.results.statements.in_words import limits_text
from xlmc.analysis.results.statements.run_in_words import discards_of
from xlmc.analysis.results.statements.significant_digits import reach_text
from xlmc.engine.engine import UNDECIDED_RESULT
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.definitions.vocabulary import vocabulary_of
from xlmc.montecarlo.distributions.parameters import range_text
from xlmc.montecarlo.loop.categories import labelled
from xlmc.montecarlo.model.certain_filters import breakable
from xlmc.montecarlo.model.draw_binding import base_point
from xlmc.montecarlo.number_text import count_text, decimals_of, exact_digits, number_text, percent
from xlmc.montecarlo.rare.account import probability_text
from xlmc.montecarlo.statistics import Estimate, complement, format_estimate
from xlmc.montecarlo.statistics.estimate import finite

if TYPE_CHECKING:
    from xlmc.engine.engine import Column
    from xlmc.excel.workbook.workbook import Workbook
    from xlmc.montecarlo.definitions.definitions import Filter
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = [
    "BaseCase",
    "Phrase",
    "SummaryRow",
    "answer_text",
    "base_case",
    "base_text",
    "central_text",
    "end_texts",
    "error_sentence",
    "estimate_text",
    "first_forecasts",
    "frequent_texts",
    "mean_heading",
    "question",
    "range_heading",
    "rejection_rows",
    "share_text",
    "shares_of",
    "summarise",
    "summary_text",
    "with_units",
]

_ERROR_SENTENCE = (
    "± is the standard error that comes from a limited number of trials (Monte Carlo error): infinitely many trials "
    "would give a number within twice ± of the one shown, with about 95 % confidence. Monte Carlo error is not "
    "{model_error}: it does not say whether the model {fits}, or whether the ranges of the assumptions are right."
)

MIXED = "Central range"

_LONG = 7
"""Characters from which on a base case has no more decimals than the mean beside it."""


@dataclass(frozen=True, slots=True)
class SummaryRow:
    """The answer of one forecast, in its units.

    Attributes:
        trials: accepted trials in which it is a number.
        share: of the trials, held by the central range from `low` to `high`.
        base: at the assumptions' base values; None if that is no number.
        threshold, above: the probability above the threshold, where one was asked for.
        asked, certainty: the probability of a range, where one was asked for; its ends, infinite where it has none.
        yes: the share of the trials that say yes; None if it is no yes/no answer.
        kind: what its answers are.
        form: how its numbers are written.
        categories: text -> the share of the trials that have it, the most frequent first; empty where it has numbers.
        numbers: what stands for these texts in its column, in their order.
        base_text: of a text, the base case.
    """

    name: str
    units: str
    trials: int
    mean: Estimate
    standard_deviation: Estimate
    share: float
    low: Estimate
    high: Estimate
    base: float | None
    threshold: float | None
    above: Estimate | None
    asked: tuple[float, float] | None = None
    certainty: Estimate | None = None
    yes: Estimate | None = None
    kind: Kind = Kind.NUMBER
    form: Form = PLAIN
    categories: Mapping[str, Estimate] = field(default_factory=dict)
    numbers: tuple[float, ...] = ()
    base_text: str = ""

    @property
    def is_share(self) -> bool:
        """Whether what is shown first is a share of the trials: of yes, or of the most frequent text."""
        return self.yes is not None or bool(self.categories)

    @property
    def answer(self) -> Estimate:
        """What is shown first: the mean; the share of yes or of the most frequent text, which is shown in percent."""
        return self.yes or next(iter(self.categories.values()), self.mean)

    @property
    def spread(self) -> tuple[Estimate, Estimate, Estimate]:
        """What is shown of its scatter, SD and central range; nothing of yes/no answers and texts: shares say all."""
        return (_NOTHING, _NOTHING, _NOTHING) if self.is_share else (self.standard_deviation, self.low, self.high)

    @property
    def unit(self) -> str:
        """The unit of what is shown first; of a share what it is of."""
        if self.categories:
            return next(iter(self.categories)) or "(empty)"
        return self.units if self.yes is None else self.units or "yes"


_NOTHING = Estimate(math.nan)


def error_sentence(workbook: Workbook) -> str:
    """Return what no table of results of a workbook may be without."""
    return vocabulary_of(workbook).fill(_ERROR_SENTENCE)


def summarise(simulation: RunResult, names: Collection[str] | None = None) -> list[SummaryRow]:
    """One row for each forecast, in the order of the workbook.

    Args:
        simulation: the finished run.
        names: of the forecasts; by default all.
    """
    base = base_case(simulation)
    return [
        SummaryRow(
            name=name,
            units=result.definition.units,
            trials=result.statistics.trials,
            mean=result.statistics.mean,
            standard_deviation=result.statistics.standard_deviation,
            share=result.definition.central,
            low=result.statistics.central[0],
            high=result.statistics.central[1],
            base=None if base is None else base.forecasts[name],
            threshold=result.definition.threshold,
            above=result.statistics.probability_above,
            asked=result.definition.asked,
            certainty=result.certainty,
            yes=result.yes,
            kind=result.kind,
            form=result.form,
            categories=result.categories,
            numbers=result.numbers_of_texts,
            base_text="" if base is None else base.texts.get(name, ""),
        )
        for name, result in simulation.results.items()
        if names is None or name in names
    ]


def summary_text(rows: Sequence[SummaryRow]) -> tuple[list[str], list[list[str]]]:
    """Headings and rows of text, ready to be printed; columns that no forecast fills are left out.

    Every number has its standard error and no more digits than that supports.
    """
    lines = [_line(row, mean_heading(rows), range_heading(rows)) for row in rows]
    headings = list(lines[0]) if lines else ["Forecast"]
    used = [name for name in headings if name == "Forecast" or any(line[name] for line in lines)]
    return used, [[line[name] for name in used] for line in lines]


def _line(row: SummaryRow, mean: str, heading: str) -> dict[str, str]:
    threshold = "" if row.threshold is None else row.form.number(row.threshold)
    spread, low, _ = row.spread
    return {
        "Forecast": row.name,
        "Units": row.unit,
        mean: answer_text(row),
        "SD": row.form.spread(spread),
        heading: "" if math.isnan(low.value) else central_text(row),
        "Range": "" if heading != MIXED or math.isnan(low.value) else percent(row.share),
        "Base case": base_text(row),
        "Threshold": threshold,
        "Above threshold": "" if row.above is None else share_text(row.above),
        "Certainty of": "" if row.asked is None else range_text(*row.asked, row.form.number),
        "Certainty": "" if row.certainty is None else share_text(row.certainty),
    }


def answer_text(row: SummaryRow) -> str:
    """Write what is shown first: the mean, `11.799 ± 0.013`, or the share of yes or of a text, `5.44 ± 0.32 %`."""
    return share_text(row.answer) if row.is_share else row.form.estimate(row.mean)


def base_text(row: SummaryRow) -> str:
    """Write a forecast at the base case; empty without one."""
    if row.kind is Kind.CATEGORY:
        return row.base_text
    if row.base is None or row.kind is not Kind.YES_NO:
        return "" if row.base is None else beside_mean(row.base, row)
    return "yes" if row.base else "no"


def central_text(row: SummaryRow) -> str:
    """`172.53 ± 0.70 to 243.16 ± 0.97`; ends without an error have the digits of the mean."""
    return row.form.ends(row.low, row.high, row.mean)


def end_texts(row: SummaryRow) -> tuple[str, str]:
    """Return the lower and the upper end of the central range; empty where none is shown."""
    if row.is_share or math.isnan(row.low.value):
        return "", ""
    low, _, high = central_text(row).partition(" to ")
    return low, high


def beside_mean(value: float, row: SummaryRow) -> str:
    """Write a number without an error, to six digits or to more where it stands beside a mean that is known better."""
    if row.kind is Kind.DATE:
        return row.form.number(value)
    exact, error = row.form.number(value), row.mean.error
    decimals = decimals_of(row.form.factor * error) if error else None
    if decimals is None or (len(exact) <= _LONG and exact_digits(row.form.factor * value)):
        return exact
    return min(exact, row.form.number(value, decimals), key=len)


def with_units(name: str, units: str) -> str:
    """Return a name, with its units behind it where it has some: `Speed (mph)`."""
    return f"{name} ({units})" if units else name


def mean_heading(rows: Sequence[SummaryRow]) -> str:
    """`Mean`; of yes/no answers and texts `Share`; `Mean or share` where forecasts have either."""
    result = {row.is_share for row in rows}
    return "Mean or share" if len(result) > 1 else "Share" if True in result else "Mean"


def range_heading(rows: Sequence[SummaryRow]) -> str:
    """`51 % range`, or `Central range` where forecasts have different ones; yes/no answers and texts have none."""
    shares = {row.share for row in rows if not row.is_share}
    return f"{percent(shares.pop())} range" if len(shares) == 1 else MIXED


def estimate_text(estimate: Estimate) -> str:
    """`11.799 ± 0.013`; empty where there is no number."""
    return "" if math.isnan(estimate.value) else format_estimate(estimate.value, estimate.error)


def share_text(estimate: Estimate) -> str:
    """Write a share in percent, `1.771 ± 0.029 %`; empty where there is no number.

    Of none of the trials it is `0 %, at most 0.013 %`, of all of them `100 %, at least 99.987 %`: an error that is the
    same on both sides would not say how far off these are.
    """
    reach = reach_text(estimate) if estimate.value in (0.0, 1.0) else ""
    if reach:
        return f"{number_text(100.0 * estimate.value)} %, {reach}"
    if math.isnan(estimate.value) or estimate.error is None:
        return ""
    if estimate.error == 0.0 and estimate.value in (0.0, 1.0):
        return f"{number_text(100.0 * estimate.value)} %"
    return f"{format_estimate(100.0 * estimate.value, 100.0 * estimate.error)} %"


@dataclass(frozen=True, slots=True)
class BaseCase:
    """What the workbook shows before any simulation.

    Attributes:
        forecasts: forecast -> its value; None if it is no number.
        rejected_by: the filters that reject it.
        texts: forecast whose answers are texts -> its text.
    """

    forecasts: Mapping[str, float | None]
    rejected_by: tuple[str, ...]
    texts: Mapping[str, str] = field(default_factory=dict)


def base_case(simulation: RunResult) -> BaseCase | None:
    """Compute the base case of a run's model; None if an assumption has none.

    It is computed, not read: a file may hold no cached values, or stale ones.
    """
    model = simulation.model
    known = base_point(model.bases)
    if known is None:
        return None
    settings = simulation.settings  # always in float64
    evaluator = model.program(settings.engine).evaluator(1)
    filters = [_fails(column) for column in evaluator.filters(known | model.certain(1), 1)]
    columns = evaluator.forecasts(np.zeros(1, np.intp))
    return BaseCase(
        forecasts={
            f.name: None if number in model.categories else _number(column)
            for number, (f, column) in enumerate(zip(model.forecasts, columns, strict=True))
        },
        texts={model.forecasts[n].name: text for n in model.categories for text in labelled(columns[n])[1]},
        rejected_by=tuple(f.name for f, fails in zip(model.filters, filters, strict=True) if fails),
    )


def _fails(column: Column) -> bool:
    return bool(column.values[0] == 0 or (column.codes is not None and column.codes[0] > 0))


def _number(column: Column) -> float | None:
    """Return the only value, also that of a forecast which its own filter discards: a base case is shown all
    the same.
    """
    discarded = column.codes is not None and column.codes[0] >= UNDECIDED_RESULT
    return finite(column.values[0] if discarded else column.as_floats()[0])


class Phrase(NamedTuple):
    """A part of a sentence; a name of the workbook's may be in a script that runs from right to left."""

    text: str
    is_name: bool = False


def question(simulation: RunResult) -> Iterator[Phrase]:
    """Say what was asked of the workbook, in sentences: how many answers, from what, and which trials count."""
    model = simulation.model
    yield Phrase(
        f"The workbook computes {_count_text(len(model.forecasts), 'answer (forecast)', 'answers (forecasts)')} from "
        f"{_count_text(len(model.live), 'quantity', 'quantities')} known only within ranges (assumptions). "
        f"{_count_text(simulation.evaluated, 'combination', 'combinations')} of values from these ranges "
        f"{'was' if simulation.evaluated == 1 else 'were'} tried. "
    )
    asked = _asked(simulation)
    if not asked:
        without = "no filters" if not model.forecast_filters else "no filters of all forecasts"
        without = f"has {without}" if not model.filters else "has no filter that a trial could break"
        yield Phrase(f"The workbook {without}: every trial is accepted.")
        yield from _of_some(simulation)
        return
    filters, evidence = ([each for each in asked if (each.evidence is None) is plain] for plain in (True, False))
    yield Phrase(_counted(simulation, bool(filters), bool(evidence)))
    yield from _listed(" The filters ask: ", filters)
    yield from _listed(" The evidence: ", evidence)
    yield Phrase(" The answers are those of these accepted trials.")
    yield from _of_some(simulation)


def _asked(simulation: RunResult) -> list[Filter]:
    """Return the filters that trials can break, or have broken."""
    may = {each.name for each in breakable(simulation.model)}
    rejected = zip(simulation.model.filters, simulation.tally.rejected, strict=True)
    return [each for each, trials in rejected if trials or each.name in may]


def _counted(simulation: RunResult, filters: bool, evidence: bool) -> str:
    """How many trials do what is asked of them, by filters, by evidence or by both."""
    count, share, one = count_text(simulation.accepted), share_text(simulation.acceptance), simulation.accepted == 1
    does = ["passes all filters" if one else "pass all filters"] * filters
    if simulation.weighting is not None:
        each = f"{count} of them ({share}) {does[0]}, and each" if does else "Each of them"
        return f"{each} counts with the chance that the evidence would keep it."
    does += ["agrees with the evidence" if one else "agree with the evidence"] * evidence
    phrase = " and ".join(does)
    if simulation.rare is not None:
        chance = probability_text(simulation.rare)
        return f"{count} that {phrase} were kept; one as they come does so with probability {chance}."
    return f"{count} of them ({share}) {phrase}."


def _listed(opening: str, filters: Sequence[Filter]) -> Iterator[Phrase]:
    """Say what filters ask, one after the other."""
    for index, filter_ in enumerate(filters):
        yield Phrase("; " if index else opening)
        yield Phrase(filter_.name, is_name=True)
        yield Phrase(f" {limits_text(filter_)}" + "." * (filter_ is filters[-1]))


def _of_some(simulation: RunResult) -> Iterator[Phrase]:
    """Say what the filters of some forecasts only ask."""
    for each in discards_of(simulation):
        yield Phrase(" Of ")
        yield Phrase(each.forecast, is_name=True)
        yield Phrase(f" only those {count_text(simulation.accepted - each.trials)} count in which ")
        yield Phrase(each.filter.name, is_name=True)
        yield Phrase(f" is {limits_text(each.filter)}.")


def _count_text(count: int, one: str, several: str) -> str:
    return f"{count_text(count)} {one if count == 1 else several}"


def shares_of(answer: SummaryRow | ForecastResult) -> Mapping[str, Estimate]:
    """Return the share of each text, or of yes and no; nothing of numbers."""
    return answer.categories if answer.yes is None else {"yes": answer.yes, "no": complement(answer.yes)}


def frequent_texts(shares: Mapping[str, Estimate]) -> tuple[dict[str, Estimate], str, float]:
    """Return the texts that a table tells, what it calls all the others, and their share; ("", 0) without others."""
    frequent = dict([*shares.items()][:_MOST_TEXTS])
    others = len(shares) - len(frequent)
    if others == 0:
        return frequent, "", 0.0
    return frequent, f"{count_text(others)} rarer texts", 1.0 - math.fsum(share.value for share in frequent.values())


_MOST_TEXTS: Final = 20
"""Texts of an answer that a table tells one by one: a text with a number in it may be another in every trial."""


def rejection_rows(simulation: RunResult) -> list[tuple[str, str, str, str]]:
    """Return a row for each filter: its name, what it keeps, how many trials it rejected, and how many it alone did."""
    counts = zip(simulation.model.filters, simulation.tally.rejected, simulation.tally.only, strict=True)
    return [(f.name, limits_text(f), count_text(rejected), count_text(only)) for f, rejected, only in counts]


def first_forecasts(begin: str, shown: int, left: int) -> str:
    """Return the sentence that says of how many forecasts something is shown, and how to ask for more.

    Args:
        begin: what is shown, as the sentence begins: `Charts are drawn of`.
        shown: of how many.
        left: how many others there are.
    """
    total = shown + left
    more = f"for all, type --detailed {total}, or Detailed forecasts in xlmc_settings"
    return f"{begin} the first {count_text(shown)} of {count_text(total)} forecasts; {more}."
