"""What was typed wrongly, in one line that says what to do."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

import click

from xlmc.errors import capitalised, sentence

__all__ = ["did_you_mean", "mistake"]

_EXTRA: Final = re.compile(r"unexpected extra arguments? \((.*)\)")
"""How click tells of arguments that a command does not take."""


def mistake(error: click.ClickException) -> str:
    """Return the line for a mistake that click has found."""
    return capitalised(_line(error))


def _line(error: click.ClickException) -> str:
    context = getattr(error, "ctx", None)
    command = context.command_path if context is not None else "xlmc"
    match error:
        case click.NoSuchOption():
            above = None if context is None else context.parent
            if above is not None and any(error.option_name in each.opts for each in above.command.params):
                rest = command.removeprefix(f"{above.command_path} ")
                return f"{error.option_name} stands before the command: {above.command_path} {error.option_name} {rest}"
            known = [name for each in context.command.params for name in each.opts] if context is not None else []
            near = did_you_mean(error.option_name, known)
            return f"there is no option {error.option_name}.{near}{_see(command)}"
        case click.MissingParameter() if context is not None and error.param is not None:
            return f"{_name(error.param)} is missing. Type: {_usage(context)}"
        case click.BadParameter() if error.param is not None:
            return f"{_name(error.param)}: {sentence(error.message)}"
        case click.UsageError() if context is not None and (extra := _EXTRA.search(error.message)):
            return f"{extra[1]!r} does not belong here. Type: {_usage(context)}"
        case _:
            return sentence(error.format_message()) + (_see(command) if context is not None else "")


def _usage(context: click.Context) -> str:
    """Write the command with its arguments, `[…]` around those that may be left out."""
    pieces = context.command.collect_usage_pieces(context)
    return " ".join([context.command_path, *(piece for piece in pieces if piece != "[OPTIONS]")])


def _name(param: click.Parameter) -> str:
    """Return the longest name of an option; of an argument what the usage line writes."""
    if isinstance(param, click.Option):
        return max(param.opts, key=len)
    return (param.metavar or (param.name or "").upper()).strip("[]")


def _see(command: str) -> str:
    return f" See {command} --help."


def did_you_mean(typed: str, known: Iterable[str]) -> str:
    """Ask whether a known name was meant, with a blank before the question; empty if no known name is alike.

    >>> did_you_mean("planar-imapct", ["skid", "planar-impact"])
    ' Did you mean planar-impact?'
    """
    from difflib import get_close_matches

    spellings = {name.casefold(): name for name in known}
    result = get_close_matches(typed.casefold(), spellings, n=1, cutoff=0.6)
    return f" Did you mean {spellings[result[0]]}?" if result else ""
