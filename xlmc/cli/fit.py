"""`xlmc fit`: which distributions describe measurements in a workbook."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from xlmc.cli.blocks import show
from xlmc.cli.options import FilePath, OneOf
from xlmc.cli.study_output import STUDY, StudyOutput, study_options
from xlmc.cli.terminal import say, say_json
from xlmc.cli.writing import NOT_WRITTEN, write_files, written_or_reported

if TYPE_CHECKING:
    from xlmc.analysis.studies.fitting import Fitted, Fitting
    from xlmc.excel.address import Area
    from xlmc.outputs.document.parts import Block, Figure, Table
    from xlmc.outputs.study_report import StudyReport

__all__ = ["fit"]

TOO_FEW = 1

_DRAWN, _POINTS, _VALUES, _BESIDE = 4, 201, 2_000, 0.1
"""Families that are drawn, their points, the most values, and how far beyond these, as a share of their range."""

_BY = (
    "Rank them by: aic or bic (how probable the values are, with a deduction for each parameter); ad"
    " (Anderson-Darling) or ks (Kolmogorov-Smirnov), both of which say how far the distribution is from the values."
)
_BOOK_AND_RANGE = re.compile(r"(?P<book>.+\.(?:xlsx|xlsm|xltx|xltm|xlsb?|ods))!(?P<range>.+)", re.IGNORECASE)


@click.command()
@click.argument("source")
@click.argument("cells", metavar="[RANGE]", required=False)
@click.option(
    "--kind",
    type=OneOf("continuous", "counts"),
    help="The kind of values.  [default: counts if all are whole numbers, 0 or more]",
)
@click.option("--by", type=OneOf("aic", "bic", "ad", "ks"), default="aic", show_default=True, help=_BY)
@click.option("--name", default="", help="Name of the assumption, for the row to paste or to write.")
@click.option("--distribution", help="The distribution of that row.  [default: the best]")
@click.option(
    "--into",
    type=FilePath(),
    help="Write the row into the table xlmc_assumptions of this workbook: into the row of that name, or below all.",
)
@click.option(
    "--tests",
    type=OneOf("1", "2"),
    help="SOURCE, a CSV file or a range, holds crash tests: copy them into the sheet Stiffness of --into, as tests of"
    " vehicle 1 or 2.",
)
@click.option(
    "--columns",
    is_flag=True,
    help="Fit each column of RANGE, whose first row has the headings, for itself, and how they hang together. So are "
    "the columns of a file of comma-separated values (.csv), where RANGE names headings, joined by commas.  [default "
    "there: all]",
)
@click.option(
    "--uncertain",
    is_flag=True,
    help="With several columns: parameters become assumptions of their own, marked Uncertain, from a bootstrap.",
)
@study_options(STUDY)
def fit(
    source: str,
    cells: str | None,
    kind: str | None,
    by: str,
    name: str,
    distribution: str | None,
    into: Path | None,
    tests: str | None,
    columns: bool,
    uncertain: bool,
    output: StudyOutput,
) -> None:
    """Rank the distributions that describe the values in BOOK!RANGE, or in BOOK RANGE; or those of several columns.

    RANGE is a range of cells, with its sheet where the workbook has several (data.xlsx!Sheet1!A2:A50), a defined name,
    or a column of a table (Tests[Friction]).
    """
    import numpy as np

    from xlmc.analysis.studies import fitting
    from xlmc.cli import fit_columns as several
    from xlmc.cli import fit_into
    from xlmc.excel.workbook.printable import label
    from xlmc.outputs.document.parts import blocks_of

    if tests is not None:
        _copy_tests(source, cells, int(tests), into, as_json=output.as_json)
        return
    if columns or Path(source).suffix.casefold() in several.CSV:
        if name or distribution:
            raise click.UsageError("--name and --distribution are for one column alone.")
        if Path(source).suffix.casefold() in several.CSV:
            path = Path(source)
            read, where = several.columns_of_csv(path, cells), path.name
        else:
            path, reference = _book_and_range(source, cells)
            read, where = several.columns_of_range(path, reference)
        sources = [path] if into is None else [path, into]
        files = output.files(*sources)
        several.fit_columns(read, where, output, files, kind=kind, by=by, uncertain=uncertain, into=into)
        return
    if uncertain:
        raise click.UsageError("--uncertain is for several columns: give --columns, or a .csv file.")
    book, reference = _book_and_range(source, cells)
    name = label(name.strip())
    if into is not None and not name:
        raise click.UsageError("--into needs --name, the name of the assumption.")
    sources = [book] if into is None else [book, into]
    files = output.files(*sources)
    values, where, blank, pooled = _values(book, reference)
    result = fitting.fit(values, kind=kind, by=by)
    result = replace(result, cautions=(*pooled, *result.cautions))
    described = f"fitted by maximum likelihood to {book.name} {where}, n = {result.n}"
    chosen = _chosen(result, distribution)
    row = fitting.row_to_paste(chosen, name or "…", described)
    edited = None if into is None else fit_into.prepare(into, name, chosen, float(np.median(values)), described)
    as_json_of = partial(_as_json, result, f"{book} {where}", blank, row)
    report = _report(result, values, f"{book.name} {where}", blank, row, as_json_of)
    written = write_files(files.writers(report))
    into = None if edited is None else written_or_reported(edited.path, partial(fit_into.write, edited))
    if output.as_json:
        say_json(report.json())
    else:
        cautions = blocks_of(_cautions(result))  # as warnings, below
        show([each for each in report.blocks[:-1] if each not in cautions])
        say(f"\n{chosen.name} as a row of xlmc_assumptions, to paste under these headings:\n")
        say("\t".join(row))
        say("\t".join(row.values()))
        if edited is not None and into is not None:
            done = "a new row" if edited.row.is_new else "its row"
            say(f"Written: {chosen.name} for {label(name)}, {done} in {into}, {edited.row.where}")
        written.print_paths()
    for caution in _cautions(result):
        say(f"warning: {caution}", err=True)
    written.check()
    if edited is not None and into is None:
        raise click.exceptions.Exit(NOT_WRITTEN)
    if result.n < fitting.FEW:
        raise click.exceptions.Exit(TOO_FEW)


def _copy_tests(source: str, cells: str | None, vehicle: int, into: Path | None, *, as_json: bool) -> None:
    """Copy crash tests, and say what stiffness they give."""
    from xlmc.cli import fit_tests
    from xlmc.montecarlo.number_text import number_text

    if into is None:
        raise click.UsageError("--tests needs --into, the workbook whose sheet Stiffness takes the tests.")
    if cells is None and not _BOOK_AND_RANGE.fullmatch(source) and Path(source).suffix.lower() in (".csv", ".txt"):
        copied = fit_tests.prepare(into, vehicle, Path(source), None)
    else:
        copied = fit_tests.prepare(into, vehicle, *_book_and_range(source, cells))
    if written_or_reported(copied.path, partial(fit_tests.write, copied)) is None:
        raise click.exceptions.Exit(NOT_WRITTEN)
    if as_json:
        say_json({"rows": [copied.first, copied.last], "gives": dict(copied.gives)})
        return
    say(f"Written: {copied.last - copied.first + 1} tests of vehicle {vehicle}, {into}, Stiffness!A{copied.first}")
    for name, value in copied.gives.items():
        say(f"  {name:<12} {number_text(value)}")


def _chosen(fitting: Fitting, distribution: str | None) -> Fitted:
    """Return the distribution that the row is to have.

    Raises:
        DefinitionError: there is none of that name.
        UsageError: it was not fitted.
    """
    from xlmc.montecarlo.distributions import family_named

    if distribution is None:
        return fitting.fits[0]
    name = family_named(distribution).name
    for fitted in fitting.fits:
        if fitted.name == name:
            return fitted
    why = fitting.unfit.get(name, f"{fitting.kind} values are not fitted with it")
    raise click.UsageError(f"{name} was not fitted: {why}.")


def _book_and_range(source: str, cells: str | None) -> tuple[Path, str]:
    """Return the workbook, and the reference in it.

    Raises:
        UsageError: no range is named, or two are.
    """
    joined = _BOOK_AND_RANGE.fullmatch(source)
    if joined and cells is not None:
        raise click.UsageError(f"Two ranges are named: {joined['range']} and {cells}.")
    if joined:
        return Path(joined["book"]), joined["range"]
    if cells is None:
        raise click.UsageError(
            f"Name the range, too: {source}!A2:A50, or a column of a table: '{source}!Tests[Value]'."
        )
    return Path(source), cells


def _values(book: Path, reference: str) -> tuple[list[float], str, int, tuple[str, ...]]:
    """Return the numbers, where they stand, how many blank cells were left out, and whether several columns are pooled.

    Raises:
        DefinitionError: there is no such range, or a cell in it holds something else.
    """
    from xlmc.cli.printing import use_number_style
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.montecarlo.definitions.cell_references import area_of_reference
    from xlmc.montecarlo.definitions.computed import Computed
    from xlmc.montecarlo.definitions.definitions_reader import number_style_of
    from xlmc.montecarlo.definitions.tables.data import area_values
    from xlmc.montecarlo.definitions.tables.table_rows import number_in

    workbook = read_workbook(book)
    use_number_style(number_style_of(workbook))
    only_sheet = next(iter(workbook.sheets)) if len(workbook.sheets) == 1 else None
    area = area_of_reference(workbook, reference, only_sheet, book)
    rows = list(area_values(workbook, area, Computed(workbook, ())))
    numbers = [value for row in rows for value in row if value is not None]
    values = [
        value if isinstance(value, float) else number_in("The data cell", workbook.content(value), value)
        for value in numbers
    ]
    return values, str(area), area.rows * area.columns - len(values), _pooled(area, rows)


def _pooled(area: Area, rows: Sequence[Sequence[object]]) -> tuple[str, ...]:
    """Return a caution if the values of several columns are taken for one quantity; a single row is one."""
    from xlmc.excel.address import column_letters, quote_sheet

    filled = [at for at, column in enumerate(zip(*rows, strict=True)) if any(value is not None for value in column)]
    if len(rows) == 1 or len(filled) < 2:
        return ()
    first, last = (column_letters(area.left + at) for at in (filled[0], filled[-1]))
    one = f"{quote_sheet(area.sheet)}!{first}{area.top}:{first}{area.bottom}"
    return (
        f"the values of {len(filled)} columns ({first} to {last}) are fitted together, as values of one quantity; "
        f"where each column is a quantity of its own, fit one at a time, such as {one}",
    )


def _as_json(fitting: Fitting, source: str, blank: int, row: dict[str, str]) -> dict[str, object]:
    return {
        "source": source,
        "values": fitting.n,
        "blank_cells": blank,
        "kind": fitting.kind,
        "ranked_by": fitting.by,
        "fits": [_entry(fitted) for fitted in fitting.fits],
        "not_fitted": dict(fitting.unfit),
        "cautions": list(fitting.cautions),
        "row": row,
    }


def _entry(fitted: Fitted) -> dict[str, object]:
    from xlmc.montecarlo.statistics.estimate import finite

    return {
        "distribution": fitted.name,
        "parameters": dict(fitted.parameters),
        "standard_errors": {heading: finite(error) for heading, error in fitted.errors.items()},
        "standard_errors_from": fitted.errors_from,
        "not_estimated": sorted(fitted.fixed),
        "log_likelihood": fitted.log_likelihood,
        "aic": fitted.aic,
        "bic": fitted.bic,
        "anderson_darling": finite(fitted.ad),
        "kolmogorov_smirnov": fitted.ks,
    }


def _report(
    fitting: Fitting,
    values: list[float],
    source: str,
    blank: int,
    row: dict[str, str],
    as_json: Callable[[], dict[str, object]],
) -> StudyReport:
    """Report what was found; the row to paste comes last."""
    from xlmc.montecarlo.number_text import count_text
    from xlmc.outputs.document.parts import Table, blocks_of
    from xlmc.outputs.study_report import StudyReport

    as_row = Table(f"{row['Distribution']} as a row of xlmc_assumptions", tuple(row), (tuple(row.values()),))
    below = f"{source}: {count_text(fitting.n)} values"
    verdict = f"{fitting.fits[0].name} describes the {count_text(fitting.n)} values best by {fitting.by.upper()}."
    blocks: list[str | Block] = [
        verdict,
        *_cautions(fitting),
        _ranking(fitting, source, blank),
        _curves(fitting, values),
    ]
    blocks += [f"Not fitted: {name}: {reason}." for name, reason in fitting.unfit.items()]
    blocks += [f"Standard errors of {', '.join(names)}: {source}." for source, names in _sources(fitting).items()]
    title = "Distributions fitted to measurements"
    return StudyReport(title, below, blocks_of([*blocks, _MEANING, as_row]), "Fit", as_json)


def _cautions(fitting: Fitting) -> list[str]:
    return [f"{caution}." for caution in fitting.cautions]


def _ranking(fitting: Fitting, source: str, blank: int) -> Table:
    from xlmc.montecarlo.number_text import count_text, fixed_text
    from xlmc.outputs.document.parts import Table

    left_out = f"; {count_text(blank)} blank cells left out" if blank else ""
    title = (
        f"{source}: {count_text(fitting.n)} values as {fitting.kind}{left_out}; the best by {fitting.by.upper()} first"
    )
    best = min(fitted.aic for fitted in fitting.fits)
    rows = tuple(
        (
            fitted.name,
            _parameters(fitted),
            fixed_text(fitted.aic - best, 1),
            fixed_text(fitted.aic, 1),
            fixed_text(fitted.bic, 1),
            _statistic(fitted.ad),
            _statistic(fitted.ks),
        )
        for fitted in fitting.fits
    )
    headings = ("Distribution", "Parameters ± standard error", "ΔAIC", "AIC", "BIC", "A²", "D")
    return Table(title, headings, rows, (2, 3, 4, 5, 6))


def _curves(fitting: Fitting, values: list[float]) -> Figure:
    """Return the values and the families that describe them best, as shares at most."""
    import numpy as np

    from xlmc.analysis.studies.fitting import share_at_most
    from xlmc.outputs.document.parts import Chart, Figure, Line, Lines

    ranked = np.sort(values)
    shown = np.unique(np.linspace(0, ranked.size - 1, min(ranked.size, _VALUES)).astype(int))
    x, own = ranked[shown], (shown + 1) / ranked.size
    margin = _BESIDE * (x[-1] - x[0])
    at = np.linspace(x[0] - margin, x[-1] + margin, _POINTS)
    if fitting.kind == "counts":
        at = np.unique(np.maximum(np.floor(np.linspace(x[0] - margin, x[-1] + margin + 1.0, 4 * _POINTS)), 0.0))
    lines = [Line("Values", _staircase(np.append(x, at[-1]), np.append(own, 1.0)))]
    for fitted in fitting.fits[:_DRAWN]:
        shares = share_at_most(fitted, at)
        points = _staircase(at, shares) if fitting.kind == "counts" else zip(at.tolist(), shares.tolist(), strict=True)
        lines.append(Line(fitted.name, tuple(points)))
    title = f"The values and the {len(lines) - 1} distributions that describe them best"
    message = f"{title}: {', '.join(line.name for line in lines)}"
    data = Lines(tuple(lines), "Share at most", share=True)
    return Figure(Chart("", "Value", data, message), f"{title}.")


def _staircase(x: Any, shares: Any) -> tuple[tuple[float, float], ...]:
    """Return the corners of shares `(n,)` that step up at numbers `(n,)`."""
    below = [0.0, *shares.tolist()[:-1]]
    return tuple(
        (at, share) for at, low, high in zip(x.tolist(), below, shares.tolist(), strict=True) for share in (low, high)
    )


_MEANING = (
    "Smaller is better in all four. AIC and BIC weigh how probable the values are against the number of parameters "
    "that were estimated. A² (Anderson-Darling) and D (Kolmogorov-Smirnov) are distances from the values; no p-values "
    "are given, because the usual ones hold only for distributions that were not fitted to the same values."
)


def _parameters(fitted: Fitted) -> str:
    from xlmc.analysis.studies.fitting import parameter_texts
    from xlmc.montecarlo.number_text import MOST_DIGITS, number_text
    from xlmc.montecarlo.statistics import format_estimate

    parts, texts = [], parameter_texts(fitted)
    for heading, value in fitted.parameters.items():
        error = fitted.errors[heading]
        if heading in fitted.fixed:
            parts.append(f"{heading} {number_text(value)} (not estimated)")
        elif error is None or not math.isfinite(error):
            parts.append(f"{heading} {number_text(float(texts[heading]), MOST_DIGITS)}")
        else:
            parts.append(f"{heading} {format_estimate(value, error)}")
    return ", ".join(parts)


def _statistic(value: float | None) -> str:
    from xlmc.montecarlo.number_text import styled_text

    return "–" if value is None else "∞" if math.isinf(value) else styled_text(value, ".3f")


def _sources(fitting: Fitting) -> dict[str, list[str]]:
    sources: dict[str, list[str]] = {}
    for fitted in fitting.fits:
        sources.setdefault(fitted.errors_from, []).append(fitted.name)
    return sources
