"""`xlmc check`: what a workbook asks for, as understood, and what is wrong with it.

Other commands take from here what the terminal says of checks that fail and of trials lost to errors.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.options import FilePath, functions_option, number_style_option
from xlmc.cli.terminal import paragraph, say
from xlmc.errors import capitalised, sentence

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.excel.workbook.workbook import Workbook
    from xlmc.montecarlo.definitions.definitions import Assumption, Correlation, Definitions, Forecast
    from xlmc.montecarlo.diagnostics.cell_errors import BaseErrors
    from xlmc.montecarlo.diagnostics.checking import CheckResult
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["check", "check_table", "failing_lines", "scenario_table", "show_first"]

_MOST_CELLS = 12
"""Cells of one kind that are listed."""


@click.command()
@click.argument("book", type=FilePath())
@number_style_option
@functions_option
def check(
    book: Path,
    functions: OwnFunctions | None,
) -> None:
    """Show the assumptions, forecasts and filters of BOOK as xlmc understands them, and every problem with its cell.

    Checks that fail at the base case, and cells that are errors there, come first.
    """
    from xlmc.cli.printing import notices, use_number_style
    from xlmc.engine.engines import ENGINES
    from xlmc.errors import XlmcError
    from xlmc.excel.workbook.injection.host import refuse_unwritable
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.montecarlo.definitions.definitions_reader import read_definitions
    from xlmc.montecarlo.model.labels import calculate_labels
    from xlmc.montecarlo.model.loading import filter_faults
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.model.stated_formulas import in_their_forms

    workbook = calculate_labels(read_workbook(book, functions=functions))
    definitions = in_their_forms(workbook, read_definitions(workbook, ENGINES))
    use_number_style(definitions.settings.number_style)
    problems: list[XlmcError] = list(definitions.problems)
    model: CompiledModel | None = None
    if not problems:
        try:
            model = CompiledModel(workbook, definitions, book)
            problems += filter_faults(model)
            refuse_unwritable(workbook.parts)
        except XlmcError as error:
            problems.append(error)
    faults = [] if model is None else _show_base_case(model)
    impossible: list[XlmcError] = []
    if model is not None and not problems and model.definitions.scenarios:
        from xlmc.analysis.studies.scenario_answers import scenario_faults

        impossible = list(scenario_faults(model).values())
    _show_definitions(definitions if model is None else model.definitions, model)
    if model is not None:
        _show_need(model, workbook)
        notices(model.notices)
    elif definitions.problems:
        notices((*workbook.notices, *definitions.notices))
    for problem in problems:
        say(f"problem: {problem}", err=True, cure=problem.hint)
    if problems:
        say(f"{len(problems)} problem{'s' * (len(problems) > 1)} found; nothing can be run yet.", err=True)
        raise click.exceptions.Exit(2)
    for fault in faults:
        say(f"warning: {fault}; an answer must not be used as it is.", err=True)
    for refused in (*impossible, *definitions.refused):
        say(f"warning: {refused}", err=True)
    if faults or impossible or definitions.refused:
        raise click.exceptions.Exit(1)
    say("No problem found.")


def _show_base_case(model: CompiledModel) -> list[str]:
    """Print the checks that fail and the cells in error; return why the answer must not be used as it is."""
    from xlmc.montecarlo.diagnostics.cell_errors import errors_at_base
    from xlmc.montecarlo.diagnostics.checking import base_checks

    failing = [check.fault for check in base_checks(model) if check.holds is False]
    errors = errors_at_base(model)
    lines = [sentence(capitalised(fault)) for fault in failing]
    lines += _error_lines(model, errors)
    if lines:
        say(f"{model.workbook.name}: at the base case, with every assumption at the value in its cell\n")
    for line in lines:
        say(paragraph(line, hanging="  "))
    if lines:
        say()
    if not errors.answers:
        return failing
    cell, code = next(iter(errors.roots.items()))
    return [*failing, f"at the base case {cell} is {code.text}, and a forecast, filter or check is an error with it"]


def _error_lines(model: CompiledModel, errors: BaseErrors) -> Iterator[str]:
    """Return the cells that errors come from with their formulas, then the cells that have theirs from these."""
    from xlmc.montecarlo.number_text import count_text

    handled = "" if errors.answers else " (handled: no forecast, filter or check is an error)"
    for cell, code in list(errors.roots.items())[:_MOST_CELLS]:
        from xlmc.analysis.results.record.needed_cells import content_text
        from xlmc.excel.address import host_of

        content = content_text(model.workbook, host_of(cell), tabulated=model.tabulated)
        yield f"{cell} {code.text}{handled}: {content}"
    if len(errors.roots) > _MOST_CELLS:
        yield f"… and {count_text(len(errors.roots) - _MOST_CELLS)} more cells with an error of their own"
    if errors.others:
        named = ", ".join(f"{cell} {code.text}" for cell, code in list(errors.others.items())[:_MOST_CELLS])
        more = f" and {count_text(len(errors.others) - _MOST_CELLS)} more" if len(errors.others) > _MOST_CELLS else ""
        yield f"Cells that are errors because of these: {named}{more}."


def _standing(assumption: Assumption) -> str:
    return "frozen" if assumption.frozen else "uncertain" * assumption.uncertain


def _show_definitions(definitions: Definitions, model: CompiledModel | None) -> None:
    from xlmc.analysis.results.statements.in_words import distribution_text, evidence_text, given_text, limits_text
    from xlmc.cli.printing import table
    from xlmc.montecarlo.definitions.stating import NOT_ROUNDED
    from xlmc.montecarlo.number_text import exact_text, percent

    table(
        "Assumptions",
        ("Name", "Cell", "Units", "Distribution", ""),
        [(a.name, str(a.cell), a.units, distribution_text(a), _standing(a)) for a in definitions.assumptions],
    )
    stated = any(f.says_how for f in definitions.forecasts)
    words = [f for f in definitions.forecasts if f.kind in NOT_ROUNDED]  # which have no range
    if model is not None:
        words += [f for n, f in enumerate(model.forecasts) if f.name in model.two_valued or n in model.categories]
    table(
        "Forecasts",
        ("Name", "Cell", "Units", "Central range", *["Report to", "Kind", "Role"] * stated),
        [
            (f.name, str(f.cell), f.units, "" if f in words else percent(f.central), *(_stated(f) if stated else ()))
            for f in definitions.forecasts
        ],
    )
    if definitions.solves:
        table(
            "Cells that are solved for",
            ("Name", "Solved for", "Root", "Low", "High", "So that", "Is"),
            [
                (
                    s.name,
                    str(s.by),
                    s.root or "only",
                    given_text(s.low, s.form_by),
                    given_text(s.high, s.form_by),
                    str(s.cell),
                    given_text(s.to, s.form),
                )
                for s in definitions.solves
            ],
        )
    if definitions.decisions:
        table(
            "Decisions",
            ("Name", "Cell", "Units", "Values"),
            [(d.name, str(d.cell), d.units, d.values_text) for d in definitions.decisions],
        )
    filters = [f for f in (*definitions.filters, *definitions.unused) if f.evidence is None]
    if filters:
        rows = [(f.name, str(f.cell), limits_text(f), f.because) for f in filters]
        table("Filters", ("Name", "Cell", "Keeps", "Because"), rows)
    if definitions.forecast_filters:
        own = [(f.name, str(f.cell), limits_text(f), "; ".join(f.only_for)) for f in definitions.forecast_filters]
        table("Filters for some forecasts only", ("Name", "Cell", "Keeps", "Only for"), own)
    evidence = definitions.evidence if model is None else model.evidence
    if evidence:
        rows = [(each.name, str(each.cell), evidence_text(each), each.source) for each in evidence]
        table("Evidence", ("Name", "Cell", "Reading", "Source"), rows)
    if definitions.checks:
        table("Checks", ("Name", "Cell", "Because"), [(c.name, str(c.cell), c.because) for c in definitions.checks])
    correlations = (model.definitions if model else definitions).correlations
    if correlations:
        asked = [exact_text(c.value) if isinstance(c.value, float) else str(c.value) for c in correlations]
        pairs = [(c.first, c.second, a, _drawn_with(model, c)) for c, a in zip(correlations, asked, strict=True)]
        table("Rank correlations", ("First", "Second", "Asked for", "Drawn with"), pairs, right=(2, 3))
    scenario_table(definitions)


def _stated(forecast: Forecast) -> tuple[str, str, str]:
    """How a forecast is to be stated: its resolution, its kind and its role."""
    from xlmc.montecarlo.number_text import exact_text

    resolution = "" if forecast.report_to is None else exact_text(forecast.report_to)
    return resolution, "" if forecast.kind is None else forecast.kind.value, forecast.role.value


def scenario_table(definitions: Definitions) -> None:
    """Print what each scenario changes; nothing where there are none."""
    if not definitions.scenarios:
        return
    from xlmc.analysis.results.statements.scenarios_in_words import changes_text
    from xlmc.cli.printing import table

    changes = [(each.name, changes_text(each, definitions), each.note) for each in definitions.scenarios]
    table("Scenarios", ("Name", "Changes", "Note"), changes)


def _drawn_with(model: CompiledModel | None, correlation: Correlation) -> str:
    from xlmc.montecarlo.model.correlating import drawn_correlation
    from xlmc.montecarlo.number_text import number_text

    value = None if model is None else drawn_correlation(model.groups, correlation.first, correlation.second)
    return "-" if value is None else number_text(value, 3)


def _show_need(model: CompiledModel, workbook: Workbook) -> None:
    from xlmc.montecarlo.number_text import count_text

    formulas = sum(1 for _ in workbook.formula_cells())
    needed, varying = model.needed.graph.formulas, model.needed.graph.varying
    count = sum(cell in varying for cell in needed)
    counted = (
        f"Of {count_text(formulas)} formula cells the forecasts and filters need {count_text(len(needed))}; "
        f"{count_text(count)} {'varies' if count == 1 else 'vary'} with an assumption."
    )
    say(paragraph(counted))
    if model.needed.idle:
        say(paragraph("No forecast or filter needs: " + ", ".join(a.name for a in model.needed.idle) + "."))


def show_first(run: RunResult) -> None:
    """Print the checks that fail, then evidence that contradicts, then the cells that trials were lost in."""
    from xlmc.analysis.results.record.errors_met import lost_sentences

    name = run.model.workbook.name
    _show_lines(f"{name}: checks that fail", failing_lines(run))
    conflict = [] if run.agreement is None or not run.agreement.conflicts else [run.agreement.sentence]
    _show_lines(f"{name}: evidence that contradicts", [f"{capitalised(each)}." for each in conflict])
    _show_lines(f"{name}: trials lost to errors", [f"{sentence}." for sentence in lost_sentences(run)])


def failing_lines(run: RunResult) -> list[str]:
    """One line for each check that fails, at the base case or in too many accepted trials."""
    return [sentence(capitalised(warning)) for check in run.checks for warning in check.warnings]


def _show_lines(title: str, lines: Sequence[str]) -> None:
    if not lines:
        return
    say(f"{title}\n")
    for line in lines:
        say(paragraph(line, hanging="  "))
    say()


def check_table(run: RunResult) -> None:
    """Print how many accepted trials fail each check; only how many checks there are where no trial fails one."""
    from xlmc.cli.printing import table
    from xlmc.montecarlo.diagnostics.checking import checks_sentence
    from xlmc.montecarlo.number_text import count_text

    if not run.checks:
        return
    if all(check.holds and not check.failed for check in run.checks):
        say(paragraph(f"{checks_sentence(run.checks)}.") + "\n")
        return
    rows = [(check.name, check.base.content or "", count_text(check.failed), _share(check)) for check in run.checks]
    title = f"Checks, in {run.checks[0].looked_at}"
    table(title, ("Check", "Base case", "Failing", "Share"), rows, right=(2, 3))


def _share(check: CheckResult) -> str:
    from xlmc.outputs.summary import share_text

    return share_text(check.share)
