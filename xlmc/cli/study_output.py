"""How `xlmc compare`, `screen`, `stability`, `fit` and `verify` give out what they found: files, the terminal, JSON."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from xlmc.cli.terminal import paragraph, say

if TYPE_CHECKING:
    from xlmc.analysis.studies.comparison import Acceptance, Change, Difference
    from xlmc.montecarlo.statistics import Estimate
    from xlmc.outputs.study_report import Block

__all__ = ["acceptance_json", "difference_json", "estimate_json", "show", "study_options"]


Command = TypeVar("Command", bound=Callable[..., Any])


def study_options(command: Command) -> Command:
    """Add the options."""
    path = click.Path(path_type=Path)
    command = click.option("--overwrite", is_flag=True, help="Replace existing files, whoever wrote them.")(command)
    command = click.option("--docx", type=path, help="Also write it for a word processor, .docx.")(command)
    command = click.option("--pdf", type=path, help="Also write the result as a document, .pdf.")(command)
    command = click.option("--html", type=path, help="Also write the result as a page, .html.")(command)
    return click.option("-o", "--output", type=path, help="Also write the result as a sheet, .xlsx.")(command)


def show(blocks: Iterable[Block]) -> None:
    """Print paragraphs, and tables with a line of space around them; curves are for files."""
    from xlmc.cli.printing import table
    from xlmc.outputs.study_report import Table

    spaced = True
    for each in blocks:
        if isinstance(each, str):
            say(paragraph(each))
            spaced = False
        elif isinstance(each, Table):
            if not spaced:
                say()
            table(each.title, each.headings, each.rows, right=each.right)
            spaced = True


def estimate_json(estimate: Estimate) -> dict[str, float | None]:
    """Value and standard error."""
    from xlmc.montecarlo.statistics.estimate import finite

    return {"value": finite(estimate.value), "error": finite(estimate.error)}


def difference_json(found: Difference) -> dict[str, object]:
    """The four numbers of a forecast in two runs, and the distances."""
    from xlmc.montecarlo.statistics.estimate import finite

    return {
        "mean": _change(found.mean),
        "standard_deviation": _change(found.standard_deviation),
        "central_range": {"share": found.share, "low": _change(found.low), "high": _change(found.high)},
        **({} if found.above is None else {"above_threshold": {"threshold": found.threshold, **_change(found.above)}}),
        "kolmogorov": estimate_json(found.kolmogorov),
        "wasserstein_1": estimate_json(found.wasserstein),
        "largest_in_one_trial": finite(found.largest),
        "root_mean_square_in_one_trial": finite(found.typical),
    }


def _change(change: Change) -> dict[str, object]:
    return {
        "first": estimate_json(change.first),
        "second": estimate_json(change.second),
        "difference": estimate_json(change.difference),
    }


def acceptance_json(found: Acceptance) -> dict[str, object]:
    """How many trials both accept, and each alone."""
    return {
        "both": found.both,
        "first_only": found.first_only,
        "second_only": found.second_only,
        "first": estimate_json(found.first),
        "second": estimate_json(found.second),
        "relative_change": estimate_json(found.relative),
    }
