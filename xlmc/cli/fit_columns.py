"""How `xlmc fit` fits several columns: those of a file of comma-separated values, or of a range with headings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.study_output import StudyOutput
from xlmc.cli.terminal import say

if TYPE_CHECKING:
    from xlmc.analysis.studies.fitting import Fitted
    from xlmc.analysis.studies.fitting.columns import ColumnFit, Fits
    from xlmc.excel.workbook.workbook import Workbook
    from xlmc.outputs.document.parts import Block, Table
    from xlmc.outputs.study_report import Files, StudyReport

__all__ = ["CSV", "columns_of_csv", "columns_of_range", "fit_columns"]

CSV = (".csv", ".tsv", ".txt")

_BLANK = ("", "na", "n/a", "nan", "null", "-")

_OTHER_HEADING = "Give each column a heading of its own"


def fit_columns(
    columns: Mapping[str, Sequence[float | str | None]],
    source: str,
    output: StudyOutput,
    files: Files,
    *,
    kind: str | None,
    by: str,
    uncertain: bool,
    into: Path | None,
) -> None:
    """Fit the columns, give out what was found, and write it into a workbook.

    Args:
        columns: heading -> its cells.
        source: where they stand.
        output: as it was typed.
        files: to write the report to.
        kind: of all numbers.
        by: what ranks the families.
        uncertain: whether parameters become assumptions of their own, by a bootstrap.
        into: the workbook that gets the sheet; it is made where there is none.

    Raises:
        Exit: some column has too few values to tell families apart.
    """
    from xlmc.analysis.studies import fitting
    from xlmc.analysis.studies.fitting.columns import BOOTSTRAPS
    from xlmc.analysis.studies.fitting.columns import fit_columns as study

    book = None if into is None else _book(into)
    fits = study(columns, kind=kind, by=by, bootstraps=BOOTSTRAPS if uncertain else 0)
    report = _report(fits, source)
    data = None if into is None else _data(book, fits, source)
    written = output.give(report, files)
    if into is not None and data is not None:
        _write(into, data, "" if book is None else book.sha256)
        if not output.as_json:
            rows = sum(each.best is not None for each in fits.columns)
            say(f"Written: {rows} distributions and {len(fits.pairs)} rank correlations on a sheet of {into}")
    for caution in _cautions(fits):
        say(f"warning: {caution}", err=True)
    written.check()
    if any(each.fitting is not None and each.fitting.n < fitting.FEW for each in fits.columns):
        raise click.exceptions.Exit(1)


def _book(path: Path) -> Workbook | None:
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.excel.workbook.target import refuse_into_other_format
    from xlmc.excel.workbook.writer import refuse_if_open

    if path.suffix.casefold() not in (".xlsx", ".xlsm"):
        raise click.UsageError(f"--into {path.name}: name a workbook that ends in .xlsx or .xlsm.")
    if not path.exists():
        return None
    refuse_if_open(path)
    book = read_workbook(path)
    refuse_into_other_format(path)
    return book


def _data(book: Workbook | None, fits: Fits, source: str) -> bytes:
    """Return the workbook with the sheet.

    Raises:
        DefinitionError: it would have a mistake that it had not.
    """
    from xlmc.cli.fit_into import refuse_new_problems
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.outputs.prepared.fitted_sheet import with_fits

    data = with_fits(book, fits, source)
    if book is not None:
        refuse_new_problems(book, read_workbook(data, book.name))
    return data


def _write(path: Path, data: bytes, sha256: str) -> None:
    from xlmc.excel.workbook.target import Target, refuse_into_source
    from xlmc.excel.workbook.writer import write_workbook

    if sha256:
        write_workbook(path, data, lambda: refuse_into_source(path, sha256, "Fit again"))
    else:
        write_workbook(path, data, Target(path, "", False).check)


def columns_of_csv(path: Path, wanted: str | None) -> dict[str, list[float | str | None]]:
    """Read the columns of a file, by their headings; a column in which every cell is a number or blank has numbers.

    Args:
        path: of the file, whose first line has the headings; parted by commas, semicolons or tabs.
        wanted: headings joined by commas, `*` for any letters; all where None.

    Raises:
        WorkbookError: the file cannot be read, a line has more cells than there are headings, a column with values has
            no heading, or two have the same.
        SimulationError: there is no column of a heading.
    """
    from xlmc.errors import WorkbookError
    from xlmc.excel.workbook.typed_values import lines_of

    mark, lines = lines_of(path)
    if len(lines) < 2:
        raise WorkbookError("the file has no values", where=path, hint="Its first line has the headings")
    heads = [each.strip() for each in lines[0][1]]
    for number, cells in lines[1:]:
        if len(cells) > len(heads):
            message = f"line {number} has {len(cells)} cells, and there are {len(heads)} headings"
            raise WorkbookError(message, where=path, hint="Put texts with commas in quotation marks")
    result: dict[str, list[float | str | None]] = {}
    for at, head in enumerate(heads):
        texts = [cells[at].strip() if at < len(cells) else "" for _, cells in lines[1:]]
        typed = _typed(texts, comma=mark == ";")
        if fault := _fault_of_heading(head, typed, result):
            raise WorkbookError(f"column {at + 1} of the file: {fault}", where=path, hint=_OTHER_HEADING)
        if head:
            result[head] = typed
    return _wanted(result, wanted)


def _fault_of_heading(head: str, cells: Sequence[float | str | None], others: Mapping[str, object]) -> str:
    """Say what is wrong with the heading of a column; the columns before it have others. A blank column needs none."""
    if head in others:
        return f"another column has the heading {head!r}, too"
    return "" if head or all(each is None for each in cells) else "the column has no heading"


def _typed(cells: Sequence[str], *, comma: bool) -> list[float | str | None]:
    """Return cells as numbers, and None for blank ones; as texts if one of them is no number."""
    known = [None if each.casefold() in _BLANK else each for each in cells]
    try:
        return [None if each is None else float(each.replace(",", ".") if comma else each) for each in known]
    except ValueError:
        return [*known]


def columns_of_range(
    book: Path, reference: str, wanted: str | None = None
) -> tuple[dict[str, list[float | str | None]], str]:
    """Read the columns of a range whose first row has their headings, or of a table; and where they stand.

    Raises:
        DefinitionError: there is no such range, it has a single row, a cell holds an error, a column with values has no
            heading, or two have the same.
    """
    from xlmc.cli.printing import use_number_style
    from xlmc.errors import DefinitionError, ErrorCode
    from xlmc.excel.address import Cell
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.montecarlo.definitions.cell_references import area_of_reference
    from xlmc.montecarlo.definitions.definitions_reader import number_style_of
    from xlmc.montecarlo.definitions.tables.table_rows import as_text

    workbook = read_workbook(book)
    use_number_style(number_style_of(workbook))
    only_sheet = next(iter(workbook.sheets)) if len(workbook.sheets) == 1 else None
    area = area_of_reference(workbook, reference, only_sheet, book)
    if area.rows < 2:
        raise DefinitionError("the range has one row", where=str(area), hint="Its first row has the headings")
    result: dict[str, list[float | str | None]] = {}
    for column in range(area.left, area.right + 1):
        head = as_text(workbook.content(Cell(area.sheet, area.top, column)).value).strip()
        cells: list[float | str | None] = []
        for row in range(area.top + 1, area.bottom + 1):
            value = workbook.content(Cell(area.sheet, row, column)).value
            if isinstance(value, ErrorCode):
                where, hint = Cell(area.sheet, row, column), "Correct it, or leave its row out"
                raise DefinitionError(f"the cell holds {as_text(value)}", where=where, hint=hint)
            if isinstance(value, str | None):
                cells.append((value or "").strip() or None)
            else:
                cells.append(str(value).upper() if isinstance(value, bool) else float(value))
        if fault := _fault_of_heading(head, cells, result):
            raise DefinitionError(fault, where=Cell(area.sheet, area.top, column), hint=_OTHER_HEADING)
        if head:
            result[head] = cells
    return _wanted(result, wanted), f"{book.name} {area}"


def _wanted(columns: dict[str, list[float | str | None]], wanted: str | None) -> dict[str, list[float | str | None]]:
    from xlmc.analysis.studies.comparison.variations import names_of

    return columns if wanted is None else {name: columns[name] for name in names_of(wanted, [*columns], "column")}


def _cautions(fits: Fits) -> list[str]:
    return [
        f"{each.name}: {caution}."
        for each in fits.columns
        if each.fitting is not None
        for caution in each.fitting.cautions
    ]


def _report(fits: Fits, source: str) -> StudyReport:
    from xlmc.outputs.document.parts import blocks_of
    from xlmc.outputs.study_report import StudyReport

    below = f"{source}: {len(fits.columns)} column{'s' * (len(fits.columns) != 1)}"
    title = "Distributions fitted to columns"
    return StudyReport(title, below, blocks_of(_blocks(fits)), "Fit", partial(_as_json, fits, source))


def _blocks(fits: Fits) -> Iterator[str | Block]:
    from xlmc.montecarlo.number_text import count_text
    from xlmc.outputs.document.parts import Table
    from xlmc.outputs.summary import share_text

    rows = []
    for each in fits.columns:
        if each.fitting is None or each.best is None:
            continue
        near = [f.name for f in each.fitting.fits[1:] if f.aic - each.best.aic < 2.0]
        rows.append(
            (each.name, count_text(each.fitting.n), each.best.name, _parameters(each, each.best), ", ".join(near))
        )
    if rows:
        heads = ("Column", "Values", "Distribution", "Parameters", "About as good")
        yield Table("The best distribution of each column", heads, tuple(rows), (1,))
    if fits.pairs:
        yield _pairs(fits)
        yield (
            "Copulas are fitted to the ranks of the two columns; ΔAIC says by how much the Gaussian one, which rank "
            "correlations stand for, is behind the best. “Turned” means that one goes up as the other goes down."
        )
    for each in fits.columns:
        if each.shares:
            shares = tuple((text, share_text(share)) for text, share in each.shares.items())
            yield Table(f"{each.name}: shares of its texts", ("Text", "Share"), shares, (1,))
        elif each.why:
            yield f"Not fitted: {each.name}: {each.why}."


def _parameters(each: ColumnFit, best: Fitted) -> str:
    from xlmc.analysis.studies.fitting import parameter_texts
    from xlmc.montecarlo.number_text import MOST_DIGITS, number_text
    from xlmc.montecarlo.statistics import format_estimate

    parts = []
    for heading, text in parameter_texts(best).items():
        repeated = (each.repeated or {}).get(heading)
        error = best.errors[heading] if repeated is None else float(repeated.std(ddof=1))
        if not error or error != error:  # no NaN equals itself
            parts.append(f"{heading} {number_text(float(text), MOST_DIGITS)}")
        else:
            parts.append(f"{heading} {format_estimate(best.parameters[heading], error)}")
    return ", ".join(parts)


def _pairs(fits: Fits) -> Table:
    from xlmc.montecarlo.number_text import count_text, fixed_text, number_text
    from xlmc.outputs.document.parts import Table

    rows = []
    for pair in fits.pairs:
        best, *_ = pair.copulas
        gaussian = next((each for each in pair.copulas if each.name == "Gaussian"), None)
        behind = "" if gaussian is None else fixed_text(gaussian.aic - best.aic, 1)
        numbers = ", ".join(f"{name} {number_text(value, 3)}" for name, value in best.parameters.items())
        name = f"{best.name}, turned" if best.turned else best.name
        rows.append((pair.first, pair.second, count_text(pair.n), repr(pair.correlation), name, numbers, behind))
    heads = ("First", "Second", "Rows", "Rank correlation", "Best copula", "Its numbers", "ΔAIC of Gaussian")
    return Table("How the columns hang together", heads, tuple(rows), (2, 3, 6))


def _as_json(fits: Fits, source: str) -> dict[str, object]:
    from xlmc.outputs.studies.json_numbers import estimate_json

    return {
        "source": source,
        "columns": [
            {
                "name": each.name,
                "values": int(each.values.size),
                "distribution": None if each.best is None else each.best.name,
                "parameters": None if each.best is None else dict(each.best.parameters),
                "bootstrap": {heading: float(values.std(ddof=1)) for heading, values in (each.repeated or {}).items()},
                "shares": {text: estimate_json(share) for text, share in each.shares.items()},
                "not_fitted": each.why or None,
            }
            for each in fits.columns
        ],
        "pairs": [
            {
                "first": pair.first,
                "second": pair.second,
                "rows": pair.n,
                "rank_correlation": estimate_json(pair.correlation),
                "copulas": [
                    {
                        "name": each.name,
                        "parameters": dict(each.parameters),
                        "aic": float(each.aic),
                        "turned": each.turned,
                    }
                    for each in pair.copulas
                ],
            }
            for pair in fits.pairs
        ],
    }
