"""`xlmc new`: list the templates, or copy one."""

from __future__ import annotations

import shutil
from pathlib import Path

import click

from xlmc.errors import WorkbookError

__all__ = ["new"]


@click.command()
@click.argument("template", required=False)
@click.argument("book", required=False, type=click.Path(path_type=Path))
def new(template: str | None, book: Path | None) -> None:
    """List the templates, or copy TEMPLATE to BOOK (by default TEMPLATE.xlsx here)."""
    from xlmc.templates_folder import templates

    known = templates()
    if template is None:
        width = max(len(name) for name in known)
        for name, entry in known.items():
            click.echo(f"{name:<{width}}  {entry.summary}")
        click.echo("\nxlmc new TEMPLATE my-case.xlsx copies one.")
        return
    if template not in known:
        raise click.UsageError(f"There is no template {template!r}; there are: {', '.join(known)}.")
    target = book or Path(f"{template}.xlsx")
    _copy(known[template].path, target)
    click.echo(f"{target} is ready: open it, fill in the green cells, then run: xlmc simulate {target}")


def _copy(source: Path, target: Path) -> None:
    if target.exists():
        raise WorkbookError("the file exists already", where=target, hint="choose another name, or remove it first")
    try:
        shutil.copyfile(source, target)
    except OSError as error:
        raise WorkbookError(f"the file cannot be written ({error.strerror})", where=target) from None
