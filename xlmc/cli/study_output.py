"""The command of a study: the options that all have, and how it gives out what it found: files, the terminal, JSON."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, cast

import click

from xlmc.cli.blocks import show
from xlmc.cli.options import (
    engine_option,
    functions_option,
    jobs_option,
    number_style_option,
    seed_option,
    trials_option,
)
from xlmc.cli.output_options import with_files, with_options
from xlmc.cli.terminal import INTERRUPTED, say, say_json
from xlmc.cli.writing import Written, write_files

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.document.parts import Block
    from xlmc.outputs.study_report import Files, StudyReport

STUDY = "a sheet (.xlsx), a document (.pdf, .docx), a page (.html), the result as JSON (.json)"
STUDY_OF_A_RUN = f"{STUDY}, the accepted trials of the book's run (.csv, .parquet), that run (.xlmcrun)"

NOT_TO_BE_USED = 1
"""The exit code where there are answers that must not be used."""

Command = TypeVar("Command", bound=Callable[..., Any])

__all__ = [
    "NOT_TO_BE_USED",
    "STUDY",
    "STUDY_OF_A_RUN",
    "StudyOutput",
    "conclude",
    "end_early",
    "finishing",
    "study_options",
    "study_run_options",
]


class StudyOutput(NamedTuple):
    """Where a study goes, as it was typed: files, and the terminal or JSON."""

    paths: tuple[Path, ...]
    overwrite: bool
    as_json: bool

    def files(self, *sources: Path, **of: Any) -> Files:
        """Return the files to write, which all can be written.

        Args:
            sources: the workbooks that are studied.
            of: what else `Files` is to know.

        Raises:
            XlmcError: one of them cannot be written; see `Files.check`.
        """
        from xlmc.outputs.study_report import Files

        files = Files(self.paths, sources, overwrite=self.overwrite, **of)
        files.check()
        return files

    def open(self, book: Path, functions: OwnFunctions | None, **of: Any) -> tuple[CompiledModel, Files]:
        """Load the workbook, whose style all numbers have from now on, and return it with the files to write.

        Raises:
            XlmcError: the workbook cannot be run, or a file cannot be written.
        """
        from xlmc.cli.printing import use_number_style
        from xlmc.montecarlo.model.loading import load

        model = load(book, functions=functions)
        use_number_style(model.definitions.settings.number_style)
        return model, self.files(book, functions=functions, **of)

    def give(self, report: StudyReport, files: Files, messages: Iterable[Block | str] | None = None) -> Written:
        """Write the files of a study, then print its result as JSON, or what it says and where the files are.

        Args:
            report: of the study.
            files: what to write.
            messages: what is printed, in order; by default all of the report, below the line of its workbook.

        Returns:
            What was written; what failed is to be raised after the warnings (`Written.check`).
        """
        from xlmc.outputs.document.parts import blocks_of

        written = write_files(files.writers(report))
        if self.as_json:
            say_json(report.json())
        else:
            show(blocks_of([f"{report.below}.", *report.blocks] if messages is None else messages))
            written.print_paths()
        return written


def study_options(kinds: str) -> Callable[[Command], Command]:
    """Add `-o`, the options that stand for one kind of file each, `--overwrite`, `--json` and the style of numbers.

    The command is given all of them as `output`, a `StudyOutput`.

    Args:
        kinds: what it writes, as the help says it.
    """
    text = f"What to write, by its ending: {kinds}. May be given several times; by default nothing is written."
    others = (
        click.option("--overwrite", is_flag=True, help="Replace existing files, whoever wrote them."),
        click.option("--json", "as_json", is_flag=True, help="Print the result as JSON."),
    )

    def add(command: Command) -> Command:
        @wraps(command)
        def packed(
            *args: Any, output: tuple[Path, ...], also: tuple[Path, ...], overwrite: bool, as_json: bool, **rest: Any
        ) -> Any:
            return command(*args, output=StudyOutput((*output, *also), overwrite, as_json), **rest)

        with_others = with_options(*others, number_style_option)(cast(Command, packed))
        return with_files(text, ("html", "pdf", "docx"))(with_others)

    return add


def study_run_options(of: str, kinds: str = STUDY_OF_A_RUN) -> Callable[[Command], Command]:
    """Add what studies that run the workbook have: `trials`, `seed`, `engine`, `jobs`, `output`, `quiet`, `functions`.

    Args:
        of: `the run`, `each run`.
        kinds: as for `study_options`.
    """
    outputs = study_options(kinds), functions_option
    return with_options(trials_option(of), seed_option(of), engine_option, jobs_option, *outputs)


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


@contextmanager
def finishing() -> Iterator[None]:
    """Let a first Ctrl-C wait while the output of a study is made, which then lacks nothing; a second one ends it."""
    from xlmc.montecarlo.loop.stopping.watch import Interruption

    with Interruption(wanted=True) as interruption:
        interruption.keeping = True
        yield


def end_early(ended: str) -> None:
    """End with exit code 130 where a study was ended by Ctrl-C.

    Raises:
        Exit: it was.
    """
    if ended:
        say(f"xlmc: {ended}; the output is what was known by then.", err=True)
        raise click.exceptions.Exit(INTERRUPTED)
