"""`xlmc methods`: what each method of uncertainty analysis costs on a workbook, and what it misses."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from xlmc.cli.options import WholeNumber
from xlmc.cli.study_output import estimate_json
from xlmc.cli.terminal import paragraph, say, say_json
from xlmc.cli.writing import write_files

if TYPE_CHECKING:
    from xlmc.analysis.studies.methods import Curve, Runs, Study

__all__ = ["methods", "study_json"]


NOT_TO_BE_USED = 1


@click.command()
@click.argument("book", type=click.Path(path_type=Path))
@click.option(
    "--accuracy",
    default="1%",
    show_default=True,
    help="The accuracy wanted of mean, standard deviation and both ends of the central range, in 95 of 100 runs: 1% of"
    " each forecast's range from 5 % to 95 %, or 0.1 in the forecasts' units.",
)
@click.option(
    "--reference-trials",
    type=WholeNumber(1_024),
    help="Trials of the reference, the long run that errors are measured against.  [default: what takes about eight"
    " seconds, 33554432 at most]",
)
@click.option(
    "-n",
    "--trials",
    type=WholeNumber(1_024),
    help="Trials of the longest runs; others have a fourth of them, a sixteenth, and so on.  [default: 16384 times as"
    " many as the shortest runs, or what takes two and a half seconds]",
)
@click.option("--replicates", type=WholeNumber(2), help="How many runs of each length.  [default: 24]")
@click.option("--quick", is_flag=True, help="Few and short runs: a first look, in about half a minute.")
@click.option("--seed", type=WholeNumber(0), help="Seed of the reference; the runs have others.  [default: the book's]")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    multiple=True,
    help="Also write charts and tables: .png, .html, .xlsx, .pdf or .docx; may be given several times.",
)
@click.option("--html", type=click.Path(path_type=Path), help="Also write the result as a page, .html.")
@click.option("--pdf", type=click.Path(path_type=Path), help="Also write the result as a document, .pdf.")
@click.option("--docx", type=click.Path(path_type=Path), help="Also write it for a word processor, .docx.")
@click.option("--overwrite", is_flag=True, help="Replace existing files, whoever wrote them.")
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
@click.option("--quiet", is_flag=True, help="Print no notes of what is running.")
def methods(
    book: Path,
    accuracy: str,
    reference_trials: int | None,
    trials: int | None,
    replicates: int | None,
    quick: bool,
    seed: int | None,
    output: tuple[Path, ...],
    html: Path | None,
    pdf: Path | None,
    docx: Path | None,
    overwrite: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Measure every method of uncertainty analysis on BOOK: time, evaluations, errors, and which to use."""
    from xlmc.analysis.studies.methods import quick_settings, study
    from xlmc.cli.progress_bar import step_line
    from xlmc.montecarlo.model.loading import load
    from xlmc.outputs.methods import check_targets, save_methods
    from xlmc.outputs.study_report import refuse_other_ending

    model = load(book)
    for path, ending in ((html, ".html"), (pdf, ".pdf"), (docx, ".docx")):
        if path is not None:
            refuse_other_ending(path, ending)
            output += (path,)
    check_targets(output, book, overwrite=overwrite)
    asked: dict[str, Any] = {"reference_trials": reference_trials, "trials": trials, "replicates": replicates}
    given = {name: value for name, value in asked.items() if value is not None}
    if quick:
        given = quick_settings(given)
    with step_line(quiet) as told:
        found = study(model, accuracy=accuracy, seed=seed, told=told, **given)
    written = write_files((path, partial(save_methods, found, path, overwrite=overwrite)) for path in output)
    if as_json:
        say_json(study_json(found))
    else:
        _show(found)
        written.tell()
    written.check()
    if found.reference.warnings:
        raise click.exceptions.Exit(NOT_TO_BE_USED)


def _show(found: Study) -> None:
    from xlmc.analysis.studies.methods import recommendation
    from xlmc.cli.printing import table
    from xlmc.outputs.methods import methods_tables

    shown = methods_tables.reference_table(found), methods_tables.error_table(found), methods_tables.bounds_table(found)
    for each in shown:
        if each.rows:
            table(each.title, each.headings, each.rows, right=range(each.right, len(each.headings)))
    for name, said in methods_tables.cannot_lines(found):
        say(paragraph(f"{name}: {said}.", hanging="    "))
    say()
    for advice in recommendation(found):
        say(paragraph(advice))
        say()


def study_json(found: Study) -> dict[str, Any]:
    """Everything that was measured, as JSON holds it."""
    from xlmc.analysis.studies.methods import STATISTICS, recommendation
    from xlmc.analysis.studies.methods.need import choice
    from xlmc.montecarlo.statistics.estimate import finite

    reference = found.reference
    best = choice(found) if found.varying else None
    chosen = best and best.chosen
    return {
        "workbook": found.model.workbook.name,
        "accuracy": found.accuracy[0],
        "seed": found.seed,
        "reference": {
            "trials": reference.trials,
            "accepted": reference.accepted,
            "sampling": reference.sampling,
            "engine": reference.engine,
            "seconds": reference.seconds,
            "acceptance": estimate_json(reference.acceptance),
            "forecasts": {
                name: {
                    each: {
                        "value": finite(getattr(answer, each)),
                        "error": finite(getattr(reference.errors[name], each)),
                    }
                    for each in STATISTICS
                }
                for name, answer in reference.answers.items()
            },
            "widths": {name: finite(width) for name, width in reference.widths.items()},
        },
        "recommended": chosen and chosen.method.key,
        "cheapest": [curve.method.key for curve in best.cheapest] if best else [],
        "methods": [_curve(found, curve) for curve in found.every],
        "not_used": dict(found.absent),
        "recommendation": recommendation(found),
    }


def _curve(found: Study, curve: Curve) -> dict[str, Any]:
    from xlmc.analysis.studies.methods import STATISTICS, need
    from xlmc.analysis.studies.methods.need import shortfall
    from xlmc.montecarlo.statistics.estimate import finite
    from xlmc.outputs.methods.methods_tables import cannot

    drawn = curve not in found.once
    wanted = need(found, curve) if drawn and found.varying else None
    near = shortfall(found, curve) if curve.answers and found.varying and not drawn else None
    return {
        "method": curve.method.key,
        "name": curve.method.name,
        "cannot": cannot(found, curve.method),
        "remarks": list(curve.remarks),
        "setup_seconds": curve.setup,
        "bounds": {name: {"least": least, "most": most} for name, (least, most) in curve.ranges.items()},
        "bounds_at": [
            {"forecast": name, "end": end, "assumptions": dict(point)} for (name, end), point in curve.ends.items()
        ],
        "runs": [_of_length(found, runs, drawn) for runs in curve.lengths],
        "slopes": {
            each: {"trials": finite(curve.slope(each, "budget")), "seconds": finite(curve.slope(each, "seconds"))}
            for each in STATISTICS
        },
        "needs": wanted
        and {"trials": finite(wanted.trials), "seconds": finite(wanted.seconds), "reaches": wanted.reaches},
        "near_enough": near and near.reaches,
    }


def _of_length(found: Study, runs: Runs, drawn: bool) -> dict[str, Any]:
    from xlmc.analysis.studies.methods import STATISTICS
    from xlmc.montecarlo.statistics.estimate import finite

    return {
        "trials": runs.budget if drawn else None,
        "seconds": finite(runs.seconds),
        "seconds_median": finite(runs.usual),
        "seconds_measured": runs.measured,
        "evaluations": runs.evaluations,
        "effective": runs.effective,
        "failed": runs.failed,
        "acceptance_error": None if runs.acceptance is None else finite(runs.acceptance.value),
        "errors": {
            forecast.name: {
                each: {
                    "rms": finite(runs.errors[forecast.name, each].value),
                    "error": finite(runs.errors[forecast.name, each].error),
                    "bias": finite(runs.errors[forecast.name, each].bias),
                }
                for each in STATISTICS
            }
            for forecast in found.model.forecasts
        },
    }
