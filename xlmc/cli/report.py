"""`xlmc report`: result sheets, page, JSON and tables of a saved run, without simulating."""

from __future__ import annotations

from pathlib import Path

import click

from xlmc.cli.output_options import Outputs, output_options

__all__ = ["report"]

NOT_TO_BE_USED = 1


@click.command()
@click.argument("run", metavar="RUN.xlmcrun", type=click.Path(path_type=Path))
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="Result workbook.  [default: RUN-results.xlsx, unless another file is asked for]",
)
@output_options
@click.option("--quiet", is_flag=True, help="Print no notes.")
def report(
    run: Path,
    output: Path | None,
    html: Path | None,
    json_path: Path | None,
    extract: tuple[Path, ...],
    quiet: bool,
) -> None:
    """Write the results of a saved run again, without simulating: the same as when it was run."""
    from xlmc.cli.printing import notices
    from xlmc.cli.simulate import show_run
    from xlmc.report import save
    from xlmc.saved import open_run
    from xlmc.workbook.writer import refuse_if_open

    others = Outputs(html=html, json=json_path, extract=extract)
    others.check()
    found = open_run(run)
    if not quiet:
        notices(found.model.notices)
    target = output
    if target is None and not others:
        target = run.with_name(f"{run.stem}-results{found.model.path.suffix}")
    if target is not None:
        refuse_if_open(target)
        save(found, target)
    show_run(found)
    if target is not None:
        click.echo(f"Results are in {target}")
    others.write(found)
    for warning in found.warnings:
        click.echo(f"warning: {warning}; the answer must not be used as it stands.", err=True)
    if found.warnings:
        raise click.exceptions.Exit(NOT_TO_BE_USED)
