"""How `xlmc compare`, `screen`, `stability`, `fit` and `verify` give out what they found: files, the terminal, JSON."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from xlmc.cli.blocks import show
from xlmc.cli.options import number_style_option
from xlmc.cli.output_options import with_files, with_options
from xlmc.cli.terminal import INTERRUPTED, say, say_json
from xlmc.cli.writing import Written, write_files

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.document.parts import Block
    from xlmc.outputs.study_report import StudyReport

STUDY = "a sheet (.xlsx), a document (.pdf, .docx), a page (.html), the result as JSON (.json)"
STUDY_OF_A_RUN = f"{STUDY}, the accepted trials of the book's run (.csv, .parquet), that run (.xlmcrun)"

NOT_TO_BE_USED = 1
"""The exit code where there are answers that must not be used."""

Command = TypeVar("Command", bound=Callable[..., Any])

__all__ = [
    "NOT_TO_BE_USED",
    "STUDY",
    "STUDY_OF_A_RUN",
    "conclude",
    "end_early",
    "give_out",
    "study_options",
]


def study_options(kinds: str) -> Callable[[Command], Command]:
    """Add `-o`, the options that stand for one kind of file each, `--overwrite` and `--json`.

    The command is given the files as `output` and `also`, `overwrite` and `as_json`.

    Args:
        kinds: what it writes, as the help says it.
    """
    text = f"What to write, by its ending: {kinds}. May be given several times; by default nothing is written."
    others = (
        click.option("--overwrite", is_flag=True, help="Replace existing files, whoever wrote them."),
        click.option("--json", "as_json", is_flag=True, help="Print the result as JSON."),
    )

    def add(command: Command) -> Command:
        return with_files(text, ("html", "pdf", "docx"))(with_options(*others, number_style_option)(command))

    return add


def give_out(
    report: StudyReport, files: Iterable[tuple[Path, Callable[[], Path]]], as_json: bool, said: Iterable[Block | str]
) -> Written:
    """Write the files of a study, then print its result as JSON, or what it says and where the files are.

    Args:
        report: of the study.
        files: what to write, and how.
        as_json: print the result as JSON.
        said: what else is printed, in order.

    Returns:
        What was written; what failed is to be raised after the warnings (`Written.check`).
    """
    from xlmc.outputs.document.parts import blocks_of

    written = write_files(files)
    if as_json:
        say_json(report.json())
    else:
        show(blocks_of(said))
        written.print_paths()
    return written


def conclude(written: Written, run: RunResult, doubts: Sequence[str] = (), ended: str = "") -> None:
    """Print the warnings of a study's run, and end with exit code 1 where there is one, with 130 after Ctrl-C.

    Args:
        written: the files of the study, whose errors come behind the warnings.
        run: of the book.
        doubts: other reasons why answers must not be used.
        ended: why the study ended early; empty if it did not.

    Raises:
        XlmcError: a file could not be written.
        Exit: the answers must not be used, or are not all there.
    """
    from xlmc.cli.printing import warnings

    reasons = [*run.warnings, *doubts]
    warnings(reasons, run.refused)
    written.check()
    end_early(ended)
    if reasons:
        raise click.exceptions.Exit(NOT_TO_BE_USED)


def end_early(ended: str) -> None:
    """End with exit code 130 where a study was ended by Ctrl-C.

    Raises:
        Exit: it was.
    """
    if ended:
        say(f"xlmc: {ended}; what was known by then is what is told.", err=True)
        raise click.exceptions.Exit(INTERRUPTED)
