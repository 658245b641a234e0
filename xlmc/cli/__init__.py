"""The command line: `xlmc new`, `xlmc check`, `xlmc fit`, `xlmc verify`, `xlmc simulate`, `xlmc report`,
`xlmc replay`, `xlmc compare`, `xlmc screen`, `xlmc methods`, `xlmc stability`.

Exit codes: 0 done; 1 the run finished but its answer must not be used as it stands; 2 bad input, with the cell and what
to do; 130 interrupted by Ctrl-C; 143 ended by SIGTERM. Modules here import what costs time inside their functions.
"""

from __future__ import annotations

import sys

import click

from xlmc.cli.check import check
from xlmc.cli.commands import Commands
from xlmc.cli.compare import compare
from xlmc.cli.ending import ending_in_order
from xlmc.cli.fit import fit
from xlmc.cli.methods import methods
from xlmc.cli.mistakes import mistake
from xlmc.cli.new import new
from xlmc.cli.replay import replay
from xlmc.cli.report import report
from xlmc.cli.screen import screen
from xlmc.cli.simulate import INTERRUPTED, simulate
from xlmc.cli.stability import stability
from xlmc.cli.terminal import prepare, say
from xlmc.cli.verify import verify
from xlmc.errors import XlmcError
from xlmc.run.version import __version__

__all__ = ["main", "xlmc"]

BAD_INPUT = 2


@click.group(
    cls=Commands,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(__version__, prog_name="xlmc")
@click.pass_context
def xlmc(context: click.Context) -> None:
    """Monte Carlo simulation of Excel workbooks, without Excel."""
    if context.invoked_subcommand is None:
        say(context.get_help())


for _command in (new, check, fit, verify, simulate, report, replay, compare, screen, methods, stability):
    xlmc.add_command(_command)


def main() -> None:
    """Run the command line; a mistake in the input is a message and exit code 2."""
    prepare()
    try:
        # A command that asks for an exit code returns it.
        with ending_in_order():
            sys.exit(xlmc.main(prog_name="xlmc", standalone_mode=False) or 0)
    except click.ClickException as error:
        say(f"xlmc: {mistake(error)}", err=True)
        sys.exit(BAD_INPUT)
    except XlmcError as error:
        say(f"xlmc: {error}", err=True)
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
