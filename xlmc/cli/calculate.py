"""`xlmc calculate`: the values of all formulas, as Excel would have saved them."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from xlmc.cli.options import FilePath, functions_option, number_style_option
from xlmc.cli.terminal import paragraph, plain, put, say, say_json
from xlmc.errors import capitalised

if TYPE_CHECKING:
    from xlmc.engine.calculation import Calculation
    from xlmc.excel.address import Cell
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.excel.workbook.typed_values import ValueRows
    from xlmc.excel.workbook.workbook import CellValue, Workbook

__all__ = ["calculate"]

NO_VALUE: Final = 1
"""Exit code where a cell has no value that should have one."""

_TABLES: Final = (".csv", ".json")
_MOST_LISTED: Final = 12


@click.command()
@click.argument("book", type=FilePath())
@click.option(
    "-o",
    "--output",
    "outputs",
    type=FilePath(),
    multiple=True,
    help="Write a copy with the values (.xlsx), or the --cells (.csv, .json); may be repeated.",
)
@click.option("--set", "changes", metavar="CELL=VALUE", multiple=True, help="Type a value in first; may be repeated.")
@click.option(
    "--values",
    type=FilePath(),
    metavar="FILE.csv",
    help="Type in values of a CSV file: headings are cells, each row is calculated on its own.",
)
@click.option("--cells", metavar="CELLS", multiple=True, help="Print these cells (Results!B2:B9, a name).")
@click.option("--volatile", is_flag=True, help="Compute NOW, TODAY, RAND and RANDBETWEEN anew, too.")
@click.option("--json", "as_json", is_flag=True, help="Print the cells as JSON.")
@click.option("--csv", "as_csv", is_flag=True, help="Print the cells as CSV.")
@click.option("--overwrite", is_flag=True, help="Replace existing files, whoever wrote them.")
@number_style_option
@functions_option
def calculate(
    book: Path,
    outputs: tuple[Path, ...],
    changes: tuple[str, ...],
    values: Path | None,
    cells: tuple[str, ...],
    volatile: bool,
    as_json: bool,
    as_csv: bool,
    overwrite: bool,
    functions: OwnFunctions | None,
) -> None:
    """Compute all formulas of BOOK and save the values in a copy, by default BOOK-calculated.xlsx.

    A saved value that is right stays to the last digit, and so does everything else in the file. What cannot be
    computed is named, and keeps the value that Excel saved, unless it depends on a change.
    """
    from xlmc.cli.printing import use_number_style
    from xlmc.engine.calculation import Calculator
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.excel.workbook.target import copy_ending
    from xlmc.excel.workbook.typed_values import read_value_rows, typed_change
    from xlmc.montecarlo.definitions.definitions_reader import number_style_of

    if as_json and as_csv:
        raise click.UsageError("--json and --csv cannot both be given.")
    if (as_json or as_csv) and not cells:
        raise click.UsageError("which cells are to be printed? Name them: --cells Results!B2:B9")
    workbook = read_workbook(book, functions=functions)
    use_number_style(number_style_of(workbook))
    wanted = _wanted(workbook, cells)
    typed = _typed(typed_change(workbook, each) for each in changes)
    table = None if values is None else read_value_rows(values, workbook)
    if not outputs and not cells:
        outputs = (book.with_name(f"{book.stem}-calculated{copy_ending(book)}"),)
    read = [book, *([] if values is None else [values]), *([] if functions is None else [functions.path])]
    _check(outputs, read, values, wanted, 1 if table is None else len(table.rows), overwrite)
    rows = [typed] if table is None else [{**typed, **row} for row in table.rows]
    calculator = Calculator(workbook, {*typed, *(() if table is None else table.rows[0])}, volatile=volatile)
    copies = any(path.suffix.casefold() not in _TABLES for path in outputs)
    only = None if copies or table is None else frozenset(wanted)
    calculations = [calculator.calculate(row, only) for row in rows]
    answers = _Answers(workbook, wanted, table, rows, calculations)
    for path in outputs:
        _write(path, answers, read, overwrite)
    _print(answers, as_json=as_json, as_csv=as_csv)
    _tell(answers, book, outputs)
    if any(answers.lacking()):
        raise click.exceptions.Exit(NO_VALUE)


@dataclass(frozen=True, slots=True)
class _Answers:
    """What was computed, row by row of the values that were typed in."""

    book: Workbook
    wanted: Sequence[Cell]
    table: ValueRows | None
    typed: Sequence[Mapping[Cell, CellValue]]
    calculations: Sequence[Calculation]

    def value(self, cell: Cell, row: int) -> CellValue:
        """Return the value of a cell in a row."""
        if cell in self.typed[row]:
            return self.typed[row][cell]
        if cell in self.calculations[row].unknown:
            return None
        return self.calculations[row].values.get(cell, self.book.content(cell).value)

    def lines(self) -> Iterator[list[CellValue]]:
        """Yield the lines of a table: each cell with its value, or each row with the values of all cells."""
        if self.table is None or not self.table.headings:
            yield from ([str(cell), self.value(cell, 0)] for cell in self.wanted)
            return
        for number, given in enumerate(self.table.given):
            yield [*given.values(), *(self.value(cell, number) for cell in self.wanted)]

    def shown(self) -> list[list[str]]:
        """Return the lines as people read them: numbers as the formats of their cells say."""
        from xlmc.montecarlo.definitions.forms import PLAIN
        from xlmc.montecarlo.model.cell_forms import content_in, forms_of

        forms = forms_of(self.book, self.wanted)
        if self.table is None or not self.table.headings:
            return [
                [str(cell), content_in(form, self.value(cell, 0))]
                for cell, form in zip(self.wanted, forms, strict=True)
            ]
        given = [PLAIN] * len(self.table.headings)
        known = [*given, *forms]
        return [[content_in(*each) for each in zip(known, line, strict=True)] for line in self.lines()]

    def headings(self) -> list[str]:
        """Return the headings of these lines."""
        if self.table is None or not self.table.headings:
            return ["Cell", "Value"]
        return [*self.table.headings, *map(str, self.wanted)]

    def as_json(self) -> object:
        """Return the cells with their values; one such object for each row of values."""
        rows = [{str(cell): plain(self.value(cell, at)) for cell in self.wanted} for at in range(len(self.typed))]
        if self.table is None or not self.table.headings:
            return rows[0]
        given = ({heading: plain(value) for heading, value in each.items()} for each in self.table.given)
        return [{**texts, **row} for texts, row in zip(given, rows, strict=True)]

    def as_csv(self) -> str:
        """Return the lines as CSV."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.headings())
        writer.writerows([[_exact(value) for value in line] for line in self.lines()])
        return text.getvalue()

    def lacking(self) -> Iterator[Cell]:
        """Yield the cells without a value: of the whole book, or of the wanted cells with rows of values."""
        for each in self.calculations:
            yield from (cell for cell in each.unknown if self.table is None or not self.wanted or cell in self.wanted)


def _typed(changes: Iterable[tuple[Cell, CellValue]]) -> dict[Cell, CellValue]:
    result: dict[Cell, CellValue] = {}
    for cell, value in changes:
        if cell in result:
            raise click.UsageError(f"{cell} is set twice.")
        result[cell] = value
    return result


def _wanted(book: Workbook, places: Iterable[str]) -> list[Cell]:
    from xlmc.errors import WorkbookError
    from xlmc.excel.workbook.places import area_named

    result: dict[Cell, None] = {}
    for place in places:
        try:
            result |= dict.fromkeys(area_named(book, place).cells())
        except KeyError as error:
            raise WorkbookError(f"--cells {place}: {error.args[0]}") from None
    return list(result)


def _check(
    outputs: Sequence[Path],
    read: Sequence[Path],
    values: Path | None,
    wanted: Sequence[Cell],
    rows: int,
    overwrite: bool,
) -> None:
    """Refuse, before anything is computed, what could not be written; `read` are the files read, BOOK first."""
    from xlmc.errors import WorkbookError
    from xlmc.excel.workbook.target import Target, refuse_folder, refuse_other_copy, refuse_same_file
    from xlmc.montecarlo.number_text import count_text

    refuse_same_file(outputs)
    book = read[0]
    for path in outputs:
        refuse_folder(path)
        ending = path.suffix.casefold()
        if ending in _TABLES and not wanted:
            raise click.UsageError(f"which cells is {path} to hold? Name them: --cells Results!B2:B9")
        if ending not in _TABLES:
            refuse_other_copy(path, book, beside="; cells alone go to .csv or .json")
        if ending not in _TABLES and rows > 1:
            hint = f"Write the cells of all rows to a table: -o {path.with_suffix('.csv').name} --cells Results!B2:B9"
            raise WorkbookError(
                f"a copy holds the values of one row, and there are {count_text(rows)}", where=values, hint=hint
            )
        Target(path, "", overwrite, read=read).check()
    if rows > 1 and not wanted:
        raise click.UsageError("which cells are to be shown for each row? Name them: --cells Results!B2:B9")


def _write(path: Path, answers: _Answers, read: Sequence[Path], overwrite: bool) -> None:
    import json

    from xlmc.excel.workbook.calculated_copy import copy_with_values
    from xlmc.excel.workbook.target import Target
    from xlmc.excel.workbook.writer import write_workbook

    match path.suffix.casefold():
        case ".csv":
            data = answers.as_csv().encode("utf-8")
        case ".json":
            data = (json.dumps(answers.as_json(), indent=2, ensure_ascii=False) + "\n").encode("utf-8")
        case _:
            (calculation,), (typed,) = answers.calculations, answers.typed
            data = copy_with_values(answers.book, typed, calculation.values, calculation.unknown)
    write_workbook(path, data, Target(path, "", overwrite, read=read).check)


def _print(answers: _Answers, *, as_json: bool, as_csv: bool) -> None:
    from xlmc.cli.printing import table

    if as_json:
        say_json(answers.as_json())
    elif as_csv:
        put(answers.as_csv())
    elif answers.wanted:
        headings = answers.headings()
        table(f"{answers.book.name}: values of cells", headings, answers.shown(), right=tuple(range(1, len(headings))))


def _tell(answers: _Answers, book: Path, outputs: Sequence[Path]) -> None:
    """Say what was computed, to stderr where the values were printed for a program."""
    from xlmc.montecarlo.number_text import count_text

    first, only = answers.calculations[0], len(answers.calculations) == 1
    if only and not answers.wanted:
        new, lost = len(first.values), len(first.unknown)
        parts = [
            f"{count_text(count)} {_cells(count)} {what}"
            for count, what in ((new, "computed"), (lost, "without a value"))
            if count
        ]
        rest = "every other saved value stays as it is" if parts else "every saved value stays as it is"
        say(paragraph(f"{book.name}: {', '.join([*parts, rest])}."))
    for path in outputs:
        say(f"Written: {path}", err=bool(answers.wanted))
    by_reason: dict[tuple[str, str], list[Cell]] = {}
    for each in answers.calculations:
        for message, cells in (("has no value", each.unknown), ("keeps the saved value", each.kept)):
            for cell, why in cells.items():
                listed = by_reason.setdefault((message, _reason(answers.book, cell, why)), [])
                if cell not in listed:
                    listed.append(cell)
    for (message, why), listed in by_reason.items():
        shown = ", ".join(map(str, listed[:_MOST_LISTED]))
        more = f" and {count_text(len(listed) - _MOST_LISTED)} more" if len(listed) > _MOST_LISTED else ""
        if len(listed) > 1:
            message = message.replace("has", "have").replace("keeps", "keep")
        who = "it" if len(listed) == 1 else "they"
        say(f"note: {shown}{more}: {capitalised(why)}; {who} {message}.", err=True)


def _reason(book: Workbook, cell: Cell, why: str) -> str:
    """Return why a cell could not be computed, in other words where its formula calls Crystal Ball, @RISK or the like.

    Such functions are known, but give values in a run alone.
    """
    from xlmc.montecarlo.definitions.in_cells.suspects import holds_call

    formula = book.content(cell).formula
    called = formula is not None and "(" in formula.text and holds_call(formula.text)
    return "the formula draws at random or shows results of a simulation" if called else why


def _cells(count: int) -> str:
    return "cell" if count == 1 else "cells"


def _exact(value: CellValue) -> object:
    """Return a value for CSV: a number with all its digits, TRUE and FALSE as Excel writes them."""
    match plain(value):
        case bool() as logical:
            return "TRUE" if logical else "FALSE"
        case float() as number if number.is_integer() and abs(number) < 1e15:
            return int(number)
        case other:
            return other
