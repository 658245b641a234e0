"""Trials and filters: how many trials were run and accepted, what each filter asks and rejected, and the errors met."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.analysis.results.record.errors_met import ErrorMet, errors_met
from xlmc.analysis.results.statements.in_words import limits_text
from xlmc.analysis.results.statements.run_in_words import REJECTED_SENTENCE, discards_of
from xlmc.montecarlo.loop.stopping.stopped import ALL_TRIALS
from xlmc.montecarlo.number_text import count_text, counted_text
from xlmc.montecarlo.statistics import proportion
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import NONE
from xlmc.outputs.document.measured import Measured, counted_share
from xlmc.outputs.document.parts import Block, Content, Heading, Paragraph, Table
from xlmc.outputs.summary import share_text

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Filter
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.document.material import Material

__all__ = ["count_blocks", "filter_blocks", "section"]


def count_blocks(simulation: RunResult) -> Iterator[Block]:
    """Yield how many trials were run, accepted and lost."""
    total, rare, weighting = simulation.trials, simulation.rare, simulation.weighting
    lost = proportion(min(simulation.error_trials, total), total)
    rows: list[tuple[Content, ...]] = []
    if rare is not None:
        rows.append(("Evaluated in all", cells.count(rare.evaluations), counted_share(None)))
    rows.append(("Run" if rare is None else "Drawn before the search", cells.count(total), counted_share(None)))
    accepted = "Accepted" if rare is None or not rare.at_least else "Accepted, at least"
    rows.append((accepted, cells.count(simulation.accepted), counted_share(simulation.acceptance)))
    if weighting is not None:
        rows.append(("Effective", cells.count(round(weighting.effective)), counted_share(None)))
    rows.append(("Lost to errors in cells", cells.count(simulation.error_trials), counted_share(lost)))
    yield Table("", ("", "Trials", "Share"), tuple(rows), caption="Trials.", spans=(2, 1, 1))
    if simulation.stopped != ALL_TRIALS:
        yield Paragraph(f"The run ended when {simulation.stopped.sentence}.", "small")


def filter_blocks(simulation: RunResult, *, full: bool) -> Iterator[Block]:
    """Yield the filters, what they rejected, and the errors in cells.

    Args:
        simulation: the finished run.
        full: with where the filters stand, which of them reject the same trials, and the errors.
    """
    if simulation.model.filters:
        yield from _in_full(simulation) if full else _in_brief(simulation)
        if simulation.plan.size:
            yield Paragraph(REJECTED_SENTENCE, "small")
    elif full:
        yield Heading("Filters: a trial is accepted when all hold", 2)
        yield Paragraph("The workbook has no filters: every trial is accepted.")
    yield from _discards(simulation)
    if full:
        yield from _errors(simulation)


def _in_full(simulation: RunResult) -> Iterator[Block]:
    yield _asked(simulation.model.filters)
    yield _rejections(simulation)
    if simulation.rare is not None:
        of = f"the first {count_text(simulation.trials)} trials"
        yield Paragraph(f"Counted among {of}, drawn before the search for accepted ones began.", "small")


def _in_brief(simulation: RunResult) -> Iterator[Block]:
    yield Paragraph(_accepted_sentence(simulation))
    yield _rejections_in_brief(simulation)


def _accepted_sentence(simulation: RunResult) -> str:
    message = "A trial is accepted when all filters hold."
    if simulation.rare is not None:
        of = f"the first {count_text(simulation.trials)}"
        return f"{message} Rejected trials are counted among {of}, drawn before the search for accepted ones began."
    return (
        f"{message} Of {count_text(simulation.trials)} trials, {count_text(simulation.accepted)} were accepted "
        f"({share_text(simulation.acceptance)})."
    )


def _asked(filters: tuple[Filter, ...]) -> Table:
    rows = [
        (f"{number}. {each.name}", str(each.cell), limits_text(each), each.because or NONE)
        for number, each in enumerate(filters, 1)
    ]
    caption = "Filters: a trial is accepted when all hold."
    return Table("", ("Filter", "Cell", "Must be", "Because"), tuple(rows), caption=caption, spans=(1, 2, 2, 7))


def _rejections(simulation: RunResult) -> Table:
    """Return how many trials each filter rejected, alone and with each other one."""
    filters = simulation.model.filters
    others = range(len(filters) if len(filters) > 1 else 0)
    heads = ("Filter", "Error in it", "Rejected", "Share", "Only by it", "Share")
    rows = [
        (
            f"{index + 1}. {each.name}",
            cells.count(sum(simulation.tally.errors[index].values())),
            *_count(int(simulation.tally.rejected[index]), simulation.trials),
            *_count(int(simulation.tally.only[index]), simulation.trials),
            *("" if index == other else cells.count(int(simulation.tally.together[index, other])) for other in others),
        )
        for index, each in enumerate(filters)
    ]
    also = (f"Also by {other + 1}" for other in others)
    return Table("", (*heads, *also), tuple(rows), caption="Trials rejected by the filters.")


def _rejections_in_brief(simulation: RunResult) -> Table:
    tally = simulation.tally
    rows = [
        (
            f"{index + 1}. {each.name}",
            limits_text(each),
            each.because or NONE,
            *_count(int(tally.rejected[index]), simulation.trials),
            cells.count(int(tally.only[index])),
        )
        for index, each in enumerate(simulation.model.filters)
    ]
    heads = ("Filter", "Must be", "Because", "Rejected trials", "Share", "Only by it")
    caption = "The filters and how many trials each rejected."
    return Table("", heads, tuple(rows), widths=(2.0, 1.5, 3.2, 1.1, 1.7, 1.1), caption=caption)


def _discards(simulation: RunResult) -> Iterator[Block]:
    """Yield the filters of some forecasts only; nothing where there are none."""
    if not simulation.model.forecast_filters:
        return
    rows = [
        (
            each.filter.name,
            each.forecast,
            str(each.filter.cell),
            limits_text(each.filter),
            *_count(each.trials, simulation.accepted),
            each.filter.because or NONE,
        )
        for each in discards_of(simulation)
    ]
    heads = ("Filter", "Only for", "Cell", "Must be", "Discarded", "Share", "Because")
    widths, spans = (2.0, 1.7, 1.2, 1.5, 1.1, 1.7, 2.0), (1, 3, 1, 2, 1, 1, 2)
    yield Table("", heads, tuple(rows), (), widths, "Filters for some forecasts only.", spans)
    yield Paragraph(
        f"These filters reject no trial. Of the {counted_text(simulation.accepted, 'accepted trial')}, a forecast "
        "named here counts those that its filters keep; all other forecasts count them all. A trial that two of its "
        "filters discard is counted for the first.",
        "small",
    )


def _count(trials: int, of: int) -> tuple[Content, Content]:
    return cells.count(trials), Measured(proportion(trials, of), "share")


def _errors(simulation: RunResult) -> Iterator[Block]:
    """Yield the errors in cells; nothing where there were none."""
    errors = errors_met(simulation)
    if errors:
        rows = [
            (met.name, met.kind, str(met.cell), met.error, *_count(met.trials, _among(simulation, met)))
            for met in errors
        ]
        heads = ("Name", "In a", "Cell", "Error", "Trials", "Share")
        yield Table("", heads, tuple(rows), caption="Errors in cells.")


def _among(simulation: RunResult, met: ErrorMet) -> int:
    """Return how many trials an error was counted in: after a search, forecasts were computed in accepted ones."""
    return simulation.accepted if simulation.rare is not None and met.kind == "forecast" else simulation.trials


def section(material: Material) -> Iterator[Block]:
    """Yield the filters in brief."""
    return filter_blocks(material.simulation, full=False)
