"""`xlmc simulate`: run a workbook, print the answers, write them into a copy of it."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from xlmc.cli.blocks import show
from xlmc.cli.options import (
    FilePath,
    WholeNumber,
    feed_option,
    functions_option,
    jobs_option,
    run_options,
)
from xlmc.cli.output_options import Outputs, ReportContents, output_options, results_beside
from xlmc.cli.terminal import INTERRUPTED, is_quiet, paragraph, say
from xlmc.cli.writing import NOT_WRITTEN

if TYPE_CHECKING:
    from xlmc.analysis.studies.scenario_answers import ScenarioAnswers
    from xlmc.errors import Notice
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["show_run", "simulate"]

NOT_TO_BE_USED = 1

_MOST_MOVED = 4
"""Forecasts of which the terminal shows what evidence moves; the sheet Evidence results shows all."""


@click.command()
@click.argument("book", type=FilePath())
@run_options
@feed_option
@jobs_option
@click.option(
    "--scheduler",
    help="threads, processes, local (a Dask cluster on this machine), or a Dask scheduler's address; same result."
    "  [default: processes for long runs with -j, else threads]",
)
@click.option("--workers", type=WholeNumber(1), help="Workers of --scheduler local.  [default: one for each processor]")
@click.option("--in-place", is_flag=True, help="Write the result sheets into BOOK itself.")
@output_options("BOOK-results.xlsx")
@functions_option
def simulate(
    book: Path,
    feed: tuple[str, ...],
    in_place: bool,
    output: tuple[Path, ...],
    also: tuple[Path, ...],
    overwrite: bool,
    contents: ReportContents,
    functions: OwnFunctions | None,
    **asked: Any,
) -> None:
    """Run BOOK, print the summary, and write result sheets and charts into a copy of it, or what -o names."""
    from xlmc.analysis.studies.scenario_answers import refuse_no_scenarios
    from xlmc.cli.printing import notices, use_number_style, warnings
    from xlmc.cli.progress_bar import progress_bar
    from xlmc.montecarlo.definitions.feeds import read_feeds
    from xlmc.montecarlo.definitions.run_options import KEPT_INPUTS, RunOptions
    from xlmc.montecarlo.model.loading import load
    from xlmc.montecarlo.number_text import count_text
    from xlmc.montecarlo.simulation.simulate import run_model

    if os.path.isdir(book):
        load(book, functions=functions)  # says so
    feeds = read_feeds(feed)
    default = None if in_place or output else results_beside(book)
    wanted = Outputs(book, book.name, (*output, *also), default, in_place, overwrite, contents)
    wanted = wanted._replace(fed_by=tuple(Path(each.source) for each in feeds), functions=functions)
    if in_place and len(wanted.books) > 1:
        raise click.UsageError("--in-place and -o with a workbook cannot both be given.")
    outputs = wanted.check(book) if os.path.exists(book) else wanted  # `load` says that there is no book
    model = load(book, feeds, functions)
    use_number_style(asked["number_style"] or model.definitions.settings.number_style)
    outputs.check_against(model)
    scenarios = bool(asked["scenarios"])
    if scenarios:
        refuse_no_scenarios(model)
    notices([*model.notices, *_hints(model, asked["trials"], asked["engine"])])
    with progress_bar() as progress:
        keep_inputs = None if outputs.trials else KEPT_INPUTS
        run = run_model(
            model,
            RunOptions.of(**asked, keep_inputs=keep_inputs, keep_interrupted=True),
            progress=progress,
            tell=None if is_quiet() else lambda sentence: say(sentence, err=True),
        )
    run, answers = _with_scenarios(run, asked["jobs"])
    written, lines = outputs.write(run)  # before the answer is printed, so that no terminal can cost a run
    show_run(run)
    for line in lines:
        say(line)
    of_scenarios = _of_scenarios(run, answers)
    warnings([*run.warnings, *of_scenarios], run.refused)
    if run.stopped.interrupted:
        filtered = "; those that were accepted were written" if written else ""
        say(f"xlmc: interrupted after {count_text(run.trials)} trials{filtered}.", err=True)
    if not written:
        raise click.exceptions.Exit(NOT_WRITTEN)
    if run.stopped.interrupted or (scenarios and not answers):
        raise click.exceptions.Exit(INTERRUPTED)
    if run.warnings or of_scenarios:
        raise click.exceptions.Exit(NOT_TO_BE_USED)


def _with_scenarios(run: RunResult, jobs: int) -> tuple[RunResult, Sequence[ScenarioAnswers]]:
    """Return the answers of the scenarios; after Ctrl-C none, and the run as if made without them."""
    from dataclasses import replace

    from xlmc.analysis.studies.scenario_answers import scenario_answers
    from xlmc.cli.progress_bar import step_line

    try:
        if run.stopped.interrupted and run.settings.scenarios:
            raise KeyboardInterrupt
        with step_line() as tell:
            return run, scenario_answers(run, jobs=jobs, tell=tell)
    except KeyboardInterrupt:
        say(
            "xlmc: interrupted before all scenarios were run: the results are those of the workbook as it is.", err=True
        )
        return replace(run, settings=replace(run.settings, scenarios=False)), ()


def _of_scenarios(run: RunResult, answers: Sequence[ScenarioAnswers]) -> list[str]:
    """Why the answers of scenarios must not be used, without the reasons that hold for the workbook itself too."""
    from xlmc.analysis.studies.scenario_answers import impossible_scenarios

    own = answers[0].warnings if answers else []
    impossible = [
        f"scenario {name!r} is not possible: {why.rstrip('.')}" for name, why in impossible_scenarios(run).items()
    ]
    unusable = ((each.name, message) for each in answers[1:] for message in each.warnings if message not in own)
    return [*impossible, *(f"scenario {name!r}: {why}" for name, why in unusable)]


def _hints(model: CompiledModel, trials: int | None, engine: str | None) -> list[Notice]:
    """Yield hints that could make the run shorter."""
    from xlmc.engine.llvm import REPAYS_FROM, available
    from xlmc.errors import Notice

    settings = model.definitions.settings
    if (engine or settings.engine) != "numpy" or (trials or settings.trials) < REPAYS_FROM or not available():
        return []
    return [Notice("a run of so many trials may be shorter with `--engine jit`, which compiles the model first")]


def show_run(run: RunResult) -> None:
    """Print the paper's table, the acceptance and what each filter rejected."""
    from xlmc.analysis.results.statements.run_in_words import sampling_sentence
    from xlmc.cli.check import check_table, show_first
    from xlmc.cli.printing import table
    from xlmc.montecarlo.loop.stopping.stopped import ALL_TRIALS
    from xlmc.montecarlo.number_text import count_text, counted_text
    from xlmc.outputs.document import further_sections
    from xlmc.outputs.document.parts import Heading
    from xlmc.outputs.summary import error_sentence, rejection_rows, summarise, summary_text

    show_first(run)
    headings, rows = summary_text(summarise(run))
    table(f"{run.model.workbook.name}: accepted trials", headings, rows, right=range(2, len(headings)))
    _show_sentences(run)
    say(f"{_acceptance_sentence(run)}; seed {run.settings.seed}.")
    ended = "" if run.stopped == ALL_TRIALS else f"Ended when {run.stopped.sentence}.\n"
    say(ended + paragraph(sampling_sentence(run)) + "\n")
    if run.model.filters:
        of = (
            "Trials rejected"
            if run.rare is None
            else f"Trials rejected of {count_text(run.trials)} drawn before the search"
        )
        table(of, ("Filter", "Keeps", "Rejected", "Only by it"), rejection_rows(run), right=(2, 3))
    if run.model.forecast_filters:
        of = f"Discarded of {counted_text(run.accepted, 'accepted trial')}, for one forecast only"
        table(of, ("Filter", "Only for", "Keeps", "Discarded", "Share"), _discards(run), right=(3, 4))
    _show_evidence(run)
    check_table(run)
    _show_scenarios(run)
    for heading, blocks in further_sections(run, "terminal").values():
        show([Heading(heading), *blocks])
    say(paragraph(error_sentence(run.model.workbook)))
    for notice in run.notices_of_run:
        say(paragraph(f"{notice}."))


def _show_sentences(run: RunResult) -> None:
    """Print what may be quoted, where a forecast says how it is to be stated."""
    from xlmc.analysis.results.statements.sentences import statements

    if any(each.says_how for each in run.model.forecasts):
        sentences = [paragraph(f"{each.text}.") for each in statements(run)]
        say("\n".join([*sentences, ""]) if sentences else "")


def _show_evidence(run: RunResult) -> None:
    """Print whether the evidence agrees, and what each item moves; nothing where none is used."""
    from xlmc.errors import capitalised
    from xlmc.outputs.document.content.evidence import item_table, means_tables, trials_sentence
    from xlmc.outputs.document.parts import Paragraph

    agreement = run.agreement
    if agreement is None:
        return
    sentences = [] if agreement.sentence in agreement.remarks else [f"{capitalised(agreement.sentence)}."]
    paragraph = Paragraph(" ".join([*sentences, trials_sentence(agreement)]))  # remarks come with the other notices
    show(
        [
            item_table(agreement),
            paragraph,
            *means_tables(run, agreement, [*agreement.evidence_trials.forecasts][:_MOST_MOVED]),
        ]
    )


def _show_scenarios(run: RunResult) -> None:
    """Print what each scenario changes and accepts, then a table for each forecast; nothing where they were not run."""
    from xlmc.analysis.studies.scenario_answers import impossible_scenarios, scenario_answers
    from xlmc.outputs.document.content.scenarios import scenario_blocks

    show(scenario_blocks(scenario_answers(run), impossible_scenarios(run)))


def _acceptance_sentence(run: RunResult) -> str:
    from xlmc.analysis.results.record.errors_met import rest_sentences
    from xlmc.montecarlo.number_text import count_text, counted_text
    from xlmc.outputs.summary import share_text

    if run.rare is not None:
        from xlmc.montecarlo.rare.account import probability_text

        return (
            f"{counted_text(run.accepted, 'accepted trial')}; a trial is accepted with probability "
            f"{probability_text(run.rare)}"
        )
    if any(errors.total() for errors in run.faults.values()) or run.model.forecast_filters:
        filtered = (
            [f"the filters kept {count_text(run.accepted)}, {share_text(run.acceptance)}"]
            if run.accepted < run.trials
            else []
        )
        return "; ".join((*rest_sentences(run), *filtered))
    if run.weighting is not None and run.accepted == run.trials:
        return f"No trial is rejected: the evidence weights all {count_text(run.trials)}"
    if not run.model.filters and run.accepted == run.trials:
        every = f"all {count_text(run.trials)} trials are" if run.trials > 1 else "the only trial is"
        return f"The workbook has no filters: {every} accepted"
    return f"Accepted {count_text(run.accepted)} of {count_text(run.trials)} trials, {share_text(run.acceptance)}"


def _discards(run: RunResult) -> list[tuple[str, ...]]:
    from xlmc.analysis.results.statements.in_words import limits_text
    from xlmc.analysis.results.statements.run_in_words import discards_of
    from xlmc.montecarlo.number_text import count_text
    from xlmc.outputs.summary import share_text

    return [
        (
            discarded.filter.name,
            discarded.forecast,
            limits_text(discarded.filter),
            count_text(discarded.trials),
            share_text(discarded.share),
        )
        for discarded in discards_of(run)
    ]
