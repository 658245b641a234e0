"""The command line: `xlmc new`, `xlmc prepare`, `xlmc check`, `xlmc fit`, `xlmc verify`, `xlmc calculate`,
`xlmc simulate`, `xlmc open`, `xlmc report`, `xlmc replay`, `xlmc compare`, `xlmc screen`, `xlmc methods`,
`xlmc stability`, `xlmc stress`, `xlmc uncertainty`, `xlmc seek`, `xlmc decide`, `xlmc optimise`.

Exit codes: 0 done; 1 the run finished but its answer must not be used as it is; 2 bad input, with the cell and what
to do; 130 interrupted by Ctrl-C; 143 ended by SIGTERM. Modules here import what costs time inside their functions.
"""

from __future__ import annotations

import atexit
import gc
import os
import signal
import sys
import threading
from collections.abc import Iterator, MutableMapping
from contextlib import contextmanager
from importlib import import_module
from types import FrameType
from typing import Final

import click

from xlmc.cli.mistakes import did_you_mean, mistake
from xlmc.cli.terminal import INTERRUPTED, be_quiet, say
from xlmc.cli.terminal import prepare as prepare_terminal  # a module here is called prepare
from xlmc.errors import XlmcError
from xlmc.montecarlo.loop.version import __version__

__all__ = ["main", "xlmc"]

BAD_INPUT = 2

_BOOKS: Final = (".xlsx", ".xlsm", ".xltx", ".xltm", ".xls", ".xlsb", ".ods")

_ASKING_TO_END: Final = ("SIGTERM", "SIGHUP", "SIGBREAK")
_STDERR: Final = 2
_NEW_OBJECTS: Final = 300_000
"""How many more objects than before make Python search for garbage; by itself it does so from 700 on."""
_FROM_SIGNAL: Final = 128
"""Added to a signal's number, as shells do: 143 after SIGTERM, 129 after SIGHUP."""


_BEGINNING: Final = """\b
Where to begin:
  xlmc prepare BOOK.xlsx        a workbook of your own: adds the tables, with rows to choose from
  xlmc new blank BOOK.xlsx      a model that you write from scratch; xlmc new lists templates
  xlmc check BOOK.xlsx          what xlmc understood, and every mistake with its cell
  xlmc simulate BOOK.xlsx       runs it, and writes BOOK-results.xlsx
  xlmc calculate BOOK.xlsx      only the values of its formulas, without Excel
  xlmc help COMMAND             the options of a command
"""
"""What a person does first; click does not wrap what follows `\\b`."""


def _be_quiet(_context: click.Context, _option: click.Parameter, quiet: bool) -> None:
    if quiet:
        be_quiet()


_quiet_option = click.option(
    "-q", "--quiet", is_flag=True, expose_value=False, callback=_be_quiet, help="Print no notes and no progress."
)
"""Of every command: what `xlmc -q` says, where people look for it."""


class _Imported(MutableMapping[str, click.Command]):
    """Commands by their names, each imported when it is looked up: most of the start would be theirs."""

    def __init__(self, names: dict[str, str]) -> None:
        self._names = names
        self._loaded: dict[str, click.Command] = {}

    def __getitem__(self, name: str) -> click.Command:
        if name not in self._loaded:
            module, _, command = self._names[name].partition(".")
            self._loaded[name] = _quiet_option(getattr(import_module(f"xlmc.cli.{module}"), command))
        return self._loaded[name]

    def __setitem__(self, name: str, command: click.Command) -> None:
        self._names.setdefault(name, "")
        self._loaded[name] = command

    def __delitem__(self, name: str) -> None:
        del self._names[name]
        self._loaded.pop(name, None)

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


_COMMANDS: Final = {
    "new": "new.new",
    "prepare": "prepare.prepare_book",
    "check": "check.check",
    "convert": "convert.convert",
    "fit": "fit.fit",
    "verify": "verify.verify",
    "calculate": "calculate.calculate",
    "seek": "seek.seek",
    "simulate": "simulate.simulate",
    "scenario": "scenario.scenario",
    "open": "open.open_window",
    "report": "report.report",
    "replay": "replay.replay",
    "compare": "compare.compare",
    "screen": "screen.screen",
    "decide": "decide.decide",
    "optimise": "optimise.optimise",
    "methods": "methods.methods",
    "stability": "stability.stability",
    "stress": "stress.stress",
    "uncertainty": "uncertainty.uncertainty",
    "help": "",
    "completion": "completion.completion",
}
"""Name -> the module and the command in it, in the order in which a person needs them; `help` is added below."""


class _Commands(click.Group):
    """xlmc's commands, in the order in which a person needs them."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names, in the order in which they were added."""
        return list(self.commands)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list, each command with all of its first sentence; what is long wraps."""
        rows = [(name, self.commands[name].get_short_help_str(limit=1_000)) for name in self.list_commands(ctx)]
        with formatter.section("Commands"):
            formatter.write_dl(rows)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the command that the first argument names.

        Raises:
            UsageError: it names none; the message offers the nearest.
        """
        typed = args[0]
        if typed not in self.commands and not typed.startswith("-"):
            near = did_you_mean(typed, self.commands)
            if typed.casefold().endswith(_BOOKS):
                near = f" To run that workbook, type: xlmc simulate {typed}"
            raise click.UsageError(f"there is no command {typed!r}.{near}", ctx)
        return super().resolve_command(ctx, args)


@click.group(
    cls=_Commands,
    commands=_Imported({**_COMMANDS}),
    epilog=_BEGINNING,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(__version__, prog_name="xlmc")
@click.option(
    "--no-kept-code", is_flag=True, help="With the engine jit, compile again and keep no code for later runs."
)
@click.option(
    "-q", "--quiet", is_flag=True, help="Print no notes and no progress: only answers, warnings and problems."
)
@click.pass_context
def xlmc(context: click.Context, no_kept_code: bool, quiet: bool) -> None:
    """Monte Carlo simulation of Excel workbooks, without Excel."""
    if no_kept_code:
        os.environ["XLMC_KEEP_CODE"] = "0"
    be_quiet(quiet)
    if context.invoked_subcommand is None:
        say(context.get_help())


@click.command(name="help")
@click.argument("command", required=False)
@click.pass_context
def show_help(context: click.Context, command: str | None) -> None:
    """Tell where to begin, or the options of COMMAND."""
    group = context.find_root()
    if command is None:
        say(group.get_help())
        return
    result = xlmc.get_command(group, command)
    if result is None:
        near = did_you_mean(command, xlmc.list_commands(group))
        raise click.UsageError(f"there is no command {command!r}.{near}")
    with click.Context(result, info_name=command, parent=group) as inner:
        say(result.get_help(inner))


xlmc.add_command(show_help)


def main() -> None:
    """Run the command line; a mistake in the input is a message and exit code 2."""
    prepare_terminal()
    atexit.register(gc.freeze)  # or Python searches all objects, several times, for garbage in memory that goes anyway
    try:
        # A command that asks for an exit code returns it.
        with _end_in_order(), _rare_collections():
            sys.exit(xlmc.main(prog_name="xlmc", standalone_mode=False) or 0)
    except click.ClickException as error:
        say(f"xlmc: {mistake(error)}", err=True)
        sys.exit(BAD_INPUT)
    except XlmcError as error:
        say(f"xlmc: {error}", err=True, cure=error.hint)
        sys.exit(BAD_INPUT)
    except (click.Abort, KeyboardInterrupt):
        say("xlmc: interrupted; nothing was written.", err=True)
        sys.exit(INTERRUPTED)
    except OSError as error:
        if error.strerror is None:
            raise
        where = f"{error.filename}: " if error.filename is not None else ""
        say(f"xlmc: {where}{error.strerror}.", err=True)
        sys.exit(BAD_INPUT)
    except MemoryError:
        say("xlmc: out of memory. Ask for fewer trials.", err=True)
        sys.exit(BAD_INPUT)


@contextmanager
def _rare_collections() -> Iterator[None]:
    """Search for garbage seldom: imports and sheets make a million objects, hardly one of which is garbage.

    An eighth of the time of a short run goes into these searches. They still come often enough that what a long run
    leaves behind takes little memory: 8 MB more than with a third of the number.
    """
    before = gc.get_threshold()
    gc.set_threshold(_NEW_OBJECTS, *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)


@contextmanager
def _end_in_order() -> Iterator[None]:
    """Make a signal that asks the process to end an exit, on whose way temporary files are removed.

    A signal that is ignored stays ignored. Python hears signals in its main thread alone: elsewhere this does nothing.
    """
    ours = []
    if threading.current_thread() is threading.main_thread():
        numbers = [getattr(signal, name) for name in _ASKING_TO_END if hasattr(signal, name)]
        ours = [number for number in numbers if signal.getsignal(number) is signal.SIG_DFL]
    for number in ours:
        signal.signal(number, _exit)
    try:
        yield
    finally:
        for number in ours:
            signal.signal(number, signal.SIG_DFL)


def _exit(number: int, frame: FrameType | None) -> None:
    signal.signal(number, signal.SIG_DFL)  # a second one ends it at once
    # Not by `click`: the code that was interrupted may be in the middle of printing.
    os.write(_STDERR, f"xlmc: ended by {signal.Signals(number).name}; no file is left half-written.\n".encode())
    raise SystemExit(_FROM_SIGNAL + number)
