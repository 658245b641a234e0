"""`xlmc new`: list the templates, or copy one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.near import did_you_mean
from xlmc.cli.parameter_types import OneOf
from xlmc.cli.terminal import paragraph, say
from xlmc.errors import WorkbookError

if TYPE_CHECKING:
    from xlmc.cli.templates_folder import Template

__all__ = ["new"]


@click.command()
@click.argument("template", required=False)
@click.argument("book", required=False, type=click.Path(readable=False, path_type=Path))
@click.option("--units", type=OneOf("imperial", "si"), default="imperial", show_default=True, help="Units of the copy.")
@click.option("--overwrite", is_flag=True, help="Replace an existing file, whoever wrote it.")
def new(template: str | None, book: Path | None, units: str, overwrite: bool) -> None:
    """List the templates, or copy TEMPLATE to BOOK (by default TEMPLATE.xlsx here)."""
    from xlmc.cli.templates_folder import templates

    known = templates()
    if template is None:
        _list(known)
        return
    template = {name.casefold(): name for name in known}.get(template.casefold(), template)
    if template not in known:
        near = did_you_mean(template, known) or f" There are {', '.join(known)}."
        raise click.UsageError(f"there is no template {template!r}.{near}")
    if units not in known[template].editions:
        raise WorkbookError(f"the {units} edition of {template} is missing", hint="install xlmc again")
    target = book or Path(f"{template}.xlsx")
    if target.suffix.casefold() != ".xlsx":
        hint = f"Name it {target.with_suffix('.xlsx').name if target.name else 'case.xlsx'}"
        raise WorkbookError("a template is an Excel workbook, whose name ends in .xlsx", where=target, hint=hint)
    editions = [edition for entry in known.values() for edition in entry.editions.values()]
    _copy(known[template].editions[units], target, editions, overwrite=overwrite)
    say(f"{target} is ready: open it, fill in the green cells, then run: xlmc simulate {target}")


def _list(known: Mapping[str, Template]) -> None:
    from xlmc.cli.printing import table

    rows = [(name, entry.question, entry.needs) for name, entry in known.items()]
    table("Templates, the simplest first", ("Template", "Answers", "Needs"), rows)
    say(paragraph("xlmc new TEMPLATE my-case.xlsx copies one; --units si for metres, kilograms and km/h."))


def _copy(source: Path, target: Path, templates: Sequence[Path], *, overwrite: bool) -> None:
    """Copy a template; a file that is there is replaced where it is an untouched copy of one."""
    from xlmc.workbook.target import Target
    from xlmc.workbook.writer import write_workbook

    goal = Target(target, "", overwrite, templates)
    goal.check()
    write_workbook(target, source.read_bytes(), goal.check)
