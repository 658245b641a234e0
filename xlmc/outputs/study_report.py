"""What `xlmc compare`, `screen`, `stability`, `fit` or `verify` found, as paragraphs, tables of texts, and curves.

The terminal, a page, a sheet and a document show the same content.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Final

from xlmc.excel.workbook.seal import sealed_json, sealed_parts, sealed_text
from xlmc.excel.workbook.target import Target, refuse_other_ending, refuse_same_file
from xlmc.excel.workbook.writer import package_bytes, write_workbook
from xlmc.montecarlo.statistics.estimate import finite_json
from xlmc.outputs.sheets.cells import Shown
from xlmc.outputs.sheets.page import Page
from xlmc.outputs.sheets.styles import CREATED, Styles
from xlmc.outputs.study_curves import Curves, drawing_of, write_chart

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["Block", "Files", "StudyReport", "Table", "column_widths"]

_WIDTHS: Final = (44.0, *[17.0] * 7)

_DOCUMENTS: Final = (".pdf", ".docx")
_ENDINGS: Final = (".xlsx", ".html", ".htm", *_DOCUMENTS, ".json")
_OF_RUN: Final = (".csv", ".parquet", ".xlmcrun")

_WIDEST, _NARROW, _FEW = 40, 14, 8
"""Characters of a column of a document that may stay in one line: of a table of few columns, and of one of more."""

_LONG: Final = 60
"""Characters of a column of the sheet that stay in one line."""

_LAST: Final = 5
"""The column to which paragraphs reach."""


@dataclass(frozen=True, slots=True)
class Table:
    """A table of texts.

    Attributes:
        title: above it.
        headings: of its columns.
        rows: their cells.
        right: the columns of numbers.
    """

    title: str
    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    right: tuple[int, ...] = ()


Block = str | Table | Curves


@dataclass(frozen=True, slots=True)
class StudyReport:
    """What a study found.

    Attributes:
        title: what it is.
        below: of which book, from how many trials.
        blocks: paragraphs, tables and curves in their order.
        sheet: the name of its sheet.
        as_json: gives all that was found, as JSON holds it.
        run: the run of the workbook itself; None where the study has none, or several.
    """

    title: str
    below: str
    blocks: Sequence[Block]
    sheet: str
    as_json: Callable[[], dict[str, object]]
    run: RunResult | None = None


class Files:
    """The files that a report is written to, each by its ending.

    Args:
        paths: where to.
        sources: the workbooks that were studied, which are never written to.
        overwrite: replace files that are not ours, too.
        of_run: the study has a run, whose trials can be written, and which can be saved.
    """

    def __init__(self, paths: Sequence[Path], sources: Sequence[Path], *, overwrite: bool, of_run: bool = False):
        self._paths, self._sources, self._overwrite = paths, sources, overwrite
        self._endings = (*_ENDINGS, *(_OF_RUN if of_run else ()))

    def check(self) -> None:
        """See that every file can be written, before anything is run.

        Raises:
            TakenError: a file is not ours to replace, is a workbook that is studied, or a program has it open.
            WorkbookError: a file has an ending that is not written, its folder is not there, or it is named twice.
            SimulationError: a library is missing.
        """
        refuse_same_file(self._paths)
        for path in self._paths:
            refuse_other_ending(path, self._endings)
            if path.suffix.casefold() in _DOCUMENTS:
                from xlmc.outputs.document import check_report_path

                check_report_path(path)
            elif path.suffix.casefold() in _OF_RUN[:2]:
                from xlmc.outputs.extract import check_extract_path

                check_extract_path(path)
            self._target(path).check()

    def _target(self, path: Path) -> Target:
        return Target(path, self._sources[0].name, self._overwrite, read=self._sources)

    def writers(self, report: StudyReport) -> Iterator[tuple[Path, Callable[[], Path]]]:
        """Each file with what writes it; an untouched file of ours is replaced.

        What writes it raises `TakenError` where the file is not ours to replace or has become a workbook that is
        studied, and `WorkbookError` where it cannot be written.
        """
        for path in self._paths:
            yield path, partial(self._write, report, path)

    def _write(self, report: StudyReport, path: Path) -> Path:
        name, ending = self._sources[0].name, path.suffix.casefold()
        if ending in _OF_RUN and report.run is not None:
            return self._write_run(report.run, path, ending)
        if ending in _DOCUMENTS:
            content = _document(report, ending)
        elif ending == ".html":
            content = sealed_text(_page(report).encode(), ending, name)
        elif ending == ".json":
            content = sealed_json(finite_json(report.as_json()), name)
        else:
            content = package_bytes(sealed_parts(_book(report, report.sheet), "xl/worksheets/sheet1.xml", name))
        write_workbook(path, content, self._target(path).check)
        return path

    def _write_run(self, run: RunResult, path: Path, ending: str) -> Path:
        if ending == ".xlmcrun":
            from xlmc.analysis.results.saved import keep

            return keep(run, path, overwrite=self._overwrite)
        from xlmc.outputs.extract import extract

        return extract(run, path, overwrite=self._overwrite)


def _document(report: StudyReport, ending: str) -> bytes:
    """The report as a document, without a date: what a study finds depends on no clock."""
    from xlmc.outputs.document import document_bytes, parts

    blocks: list[parts.Block] = [parts.Paragraph(report.below)]
    for each in report.blocks:
        if isinstance(each, Table):
            blocks.append(parts.Heading(each.title))
            widths = column_widths(each.headings, each.rows)
            blocks.append(parts.Table("", each.headings, each.rows, widths, frozenset(each.right)))
        elif isinstance(each, Curves):
            blocks.append(parts.Figure(drawing_of(each), f"{each.title}."))
        else:
            blocks.append(parts.Paragraph(each))
    document = parts.Document(report.title, "", None, report.title, "", (), tuple(blocks))
    return document_bytes(document, ending)


def column_widths(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> tuple[float, ...]:
    """How wide each column is beside the others: numbers and names stay whole, sentences need not."""
    widest = _WIDEST if len(headings) <= _FEW else _NARROW
    return tuple(3.0 + min(max(map(len, column)), widest) for column in zip(headings, *rows, strict=True))


def _page(report: StudyReport) -> str:
    """The report as one HTML page that needs no other file."""
    body = "".join(map(_html, report.blocks))
    return (
        "<!DOCTYPE html>\n"
        f'<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(report.title)}</title>\n'
        f"<style>{_STYLE}</style>\n</head>\n<body>\n"
        f'<h1>{escape(report.title)}</h1>\n<p class="below">{escape(report.below)}</p>\n{body}</body>\n</html>\n'
    )


def _html(block: Block) -> str:
    if isinstance(block, Table):
        return _table(block)
    if isinstance(block, Curves):
        drawn = drawing_of(block)
        svg = drawn.svg.replace("<svg ", f'<svg role="img" aria-label="{escape(drawn.said)}" ', 1)
        return f"<figure>{svg}<figcaption>{escape(block.title)}</figcaption></figure>\n"
    return f"<p>{escape(block)}</p>\n"


def _table(table: Table) -> str:
    def row(cells_: Sequence[str], tag: str) -> str:
        found = (
            f"<{tag}>{escape(cell)}</{tag}>" if index in table.right else f'<{tag} class="left">{escape(cell)}</{tag}>'
            for index, cell in enumerate(cells_)
        )
        return f"<tr>{''.join(found)}</tr>\n"

    rows = "".join(row(each, "td") for each in table.rows)
    return (
        f'<h2>{escape(table.title)}</h2>\n<div class="wide"><table><thead>{row(table.headings, "th")}</thead>\n'
        f"<tbody>{rows}</tbody></table></div>\n"
    )


def _book(report: StudyReport, sheet: str) -> dict[str, bytes]:
    """The report as the parts of a workbook of one sheet."""
    from xlmc.outputs.sheets.exact_book import ExactBook

    with ExactBook() as made:
        made.set_properties({"created": CREATED})
        styles = Styles(made)
        written = Page(made.add_worksheet(sheet), styles, _widths(report))
        drawn = any(isinstance(each, Curves) for each in report.blocks)
        numbers = Page(made.add_worksheet("Numbers"), styles, ()) if drawn else None
        written.title(report.title, report.below)
        written.row += 1
        for each in report.blocks:
            if isinstance(each, Table):
                written.heading(each.title)
                written.table(each.headings, [_cells(row, each.right) for row in each.rows])
                written.row += 1
            elif isinstance(each, Curves):
                assert numbers is not None
                write_chart(written, made, each, numbers)
            else:
                written.wide(each, "paragraph", _LAST)
        written.set_up_printing(report.title)
        if numbers is not None:
            numbers.sheet.hide()
            numbers.set_up_printing(report.title, repeat=0)
    parts: dict[str, bytes] = made.parts
    return parts


def _widths(report: StudyReport) -> list[float]:
    """The widths of the sheet's columns: wider where a table has long texts."""
    widths = list(_WIDTHS)
    for each in report.blocks:
        if isinstance(each, Table):
            for column, texts in enumerate(zip(*each.rows, strict=True)):
                if column not in each.right and column < len(widths):
                    widths[column] = max(widths[column], min(max(map(len, texts)), _LONG))
    return widths


def _cells(row: Sequence[str], right: Sequence[int]) -> list[Shown]:
    """The cells of a row: a text that is a number becomes one; a number with its error stays text."""
    return [_cell(text, index, index in right) for index, text in enumerate(row)]


def _cell(text: str, index: int, is_number: bool) -> Shown:
    if not is_number:
        return Shown(text, look="name" if index == 0 else "text")
    try:
        return Shown(float(text))
    except ValueError:
        return Shown(text, look="number")


_STYLE: Final = """
body { font: 15px/1.5 "Segoe UI", "Helvetica Neue", Arial, sans-serif; color: #1F3044; margin: 2em auto;
  max-width: 1000px; padding: 0 1em; }
h1 { font-size: 1.5em; margin-bottom: 0; }
h2 { font-size: 1.1em; margin-top: 1.8em; }
p { max-width: 60em; overflow-wrap: anywhere; }
p.below { color: #52606D; margin-top: .2em; }
div.wide { overflow-x: auto; }
figure { margin: 1.5em 0; }
figure svg { max-width: 100%; height: auto; }
figcaption { color: #52606D; font-size: 13px; }
table { border-collapse: collapse; font-size: 13px; }
th { background: #1F3044; color: #fff; font-weight: 600; text-align: right; padding: .35em .6em; }
td { border-bottom: 1px solid #D5DBE3; padding: .3em .6em; text-align: right; font-variant-numeric: tabular-nums; }
th.left, td.left { text-align: left; }
td:not(.left) { white-space: nowrap; }
@media print {
  body { margin: 0; max-width: none; font-size: 11px; }
  table { font-size: 9px; }
  h2 { break-after: avoid; }
}
"""
