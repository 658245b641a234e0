"""`xlmc new`: list the templates that people start from, or copy one."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Final

import click

from xlmc.cli.mistakes import did_you_mean
from xlmc.cli.options import FilePath, OneOf
from xlmc.cli.terminal import paragraph, say
from xlmc.errors import WorkbookError

__all__ = ["Template", "new", "templates"]

_UNITS: Final = {"imperial": "", "si": "-si"}
"""Units of an edition -> what its file name has after the template's name."""

_BLANK: Final = "blank"
"""The workbook for a model of one's own; it is made, and not copied."""

_CRASH: Final = "Reconstruction of crashes"
"""The group of the templates whose category is a rung of the ladder of models."""

_HEADINGS: Final = ("Template", "Answers", "Needs")

_PACKAGE: Final = Path(__file__).parents[1]

_DUBLIN_CORE: Final = "{http://purl.org/dc/elements/1.1/}"
_CATEGORY: Final = "{http://schemas.openxmlformats.org/package/2006/metadata/core-properties}category"

_NO_TEMPLATE: Final = re.compile(r"^~\$|-results(-\d+)?$")
"""What else may lie in the folder of a checkout: the mark that Excel makes beside an open workbook, and results."""


def _beginning_with(_: click.Context, __: click.Parameter, typed: str) -> list[str]:
    """Return the templates that a shell completes what was typed to."""
    return [name for name in (_BLANK, *templates()) if name.startswith(typed.casefold())]


@click.command()
@click.argument("template", required=False, shell_complete=_beginning_with)
@click.argument("book", required=False, type=FilePath())
@click.option("--units", type=OneOf(*_UNITS), default="imperial", show_default=True, help="Units of the copy.")
@click.option("--overwrite", is_flag=True, help="Replace an existing file, whoever wrote it.")
def new(template: str | None, book: Path | None, units: str, overwrite: bool) -> None:
    """List the templates, or copy TEMPLATE to BOOK (by default TEMPLATE.xlsx here)."""
    known = templates()
    if template is None:
        _list(known)
        return
    if template.casefold() == _BLANK:
        _write_blank(_target(_BLANK, book), overwrite=overwrite)
        return
    template = {name.casefold(): name for name in known}.get(template.casefold(), template)
    if template not in known:
        near = did_you_mean(template, (_BLANK, *known)) or f" There are {', '.join((_BLANK, *known))}."
        raise click.UsageError(f"there is no template {template!r}.{near}")
    target = _target(template, book)
    editions = [edition for entry in known.values() for edition in entry.editions.values()]
    _copy(known[template].in_units(units), target, editions, overwrite=overwrite)
    say(f"{target} is ready: open it, fill in the green cells, then run: xlmc simulate {target}")


def _target(template: str, book: Path | None) -> Path:
    """Return where the copy goes.

    Raises:
        WorkbookError: its name does not end as that of a workbook.
    """
    target = book or Path(f"{template}.xlsx")
    if target.suffix.casefold() != ".xlsx":
        hint = f"Name it {target.with_suffix('.xlsx').name if target.name else 'case.xlsx'}"
        raise WorkbookError("a template is an Excel workbook, whose name ends in .xlsx", where=target, hint=hint)
    return target


def _write_blank(target: Path, *, overwrite: bool) -> None:
    from xlmc.excel.workbook.target import Target
    from xlmc.excel.workbook.writer import write_workbook
    from xlmc.outputs.prepared.blank import blank_book

    goal = Target(target, "", overwrite)
    goal.check()
    write_workbook(target, blank_book(), goal.check)
    say(f"{target} is ready: its sheet Guide says what to do. To run it as it is, type: xlmc simulate {target}")


def _list(known: Mapping[str, Template]) -> None:
    from xlmc.cli.printing import table

    own = (_BLANK, "A model of your own", "Formulas of your own; tables with a worked row each")
    groups = groupby(known.items(), key=lambda item: item[1].group)
    table("Templates", _HEADINGS, [own])
    for group, entries in groups:
        rows = [(name, entry.question, entry.needs) for name, entry in entries]
        table(f"{group}, the simplest first", _HEADINGS, rows)
    say(paragraph("xlmc prepare BOOK.xlsx adds the tables to a workbook that you have already."))
    say(paragraph("xlmc new TEMPLATE my-case.xlsx copies one; --units si for metres, kilograms and km/h."))


def _copy(source: Path, target: Path, templates: Sequence[Path], *, overwrite: bool) -> None:
    """Copy a template; an existing file is replaced where it is an untouched copy of one."""
    from xlmc.excel.workbook.target import Target
    from xlmc.excel.workbook.writer import write_workbook

    goal = Target(target, "", overwrite, templates)
    goal.check()
    write_workbook(target, source.read_bytes(), goal.check)


@dataclass(frozen=True, slots=True)
class Template:
    """One template, as its document properties describe it.

    Attributes:
        editions: units -> file.
        question: what it answers.
        needs: the inputs it needs.
        group: the field it belongs to.
        place: its place there, from 1; the simplest come first.
    """

    editions: Mapping[str, Path]
    question: str
    needs: str
    group: str
    place: int

    def in_units(self, units: str) -> Path:
        """Return the edition in these units; the only one where no unit tells two apart, as in a model of costs."""
        return self.editions.get(units) or next(iter(self.editions.values()))


def templates(package: Path = _PACKAGE) -> dict[str, Template]:
    """Every template by name: those for crashes, then other fields; in each group the simplest first.

    Args:
        package: the folder of the installed package; the templates are in it, or in a checkout beside it.

    Raises:
        WorkbookError: the templates are missing from the installation.
    """
    for folder in (package / "templates", package.parent / "templates"):
        books = {path.stem: path for path in folder.glob("*.xlsx") if not _NO_TEMPLATE.search(path.stem)}
        names = [name for name in books if not any(end and name.endswith(end) for end in _UNITS.values())]
        if names:
            result = {name: _template(name, books) for name in names}
            return dict(sorted(result.items(), key=_order))
    raise WorkbookError("the templates are missing", where=package, hint="install xlmc again")


def _template(name: str, books: Mapping[str, Path]) -> Template:
    from xml.etree import ElementTree

    from xlmc.excel.workbook.package import read_parts

    editions = {units: books[name + end] for units, end in _UNITS.items() if name + end in books}
    core = read_parts(books[name].read_bytes()).get("docProps/core.xml", b"<none/>")
    properties = ElementTree.fromstring(core)
    question, needs = (properties.findtext(_DUBLIN_CORE + key, default="") for key in ("subject", "description"))
    group, _, place = properties.findtext(_CATEGORY, default="").rpartition(" ")
    return Template(editions, question, needs, _CRASH if group == "rung" else group, int(place or 0))


def _order(item: tuple[str, Template]) -> tuple[bool, str, int, str]:
    name, template = item
    return template.group != _CRASH, template.group, template.place, name
