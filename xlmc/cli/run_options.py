"""The options that say when a run ends, and what they come to."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

__all__ = ["stopping_options"]

F = TypeVar("F", bound=Callable[..., Any])

_OPTIONS = (
    click.option(
        "--until-accepted",
        type=click.IntRange(2),
        metavar="N",
        help="Run until N trials are accepted, -n at most.",
    ),
    click.option(
        "--rare",
        type=click.Choice(["auto", "never", "always"]),
        help="Find rare accepted trials by learning where they are.  [default: auto: where -n would not be enough]",
    ),
    click.option(
        "--precision", metavar="WIDTH", help="Run until numbers are known to 1% of themselves, or 0.1 in their units."
    ),
    click.option("--precision-of", metavar="NAMES", help="Which: mean,sd,range,p75.5.  [default: mean,range]"),
    click.option("--confidence", metavar="PERCENT", help="Confidence of --precision.  [default: 95]"),
    click.option(
        "--adaptive",
        type=click.IntRange(1, 6),
        metavar="DIGITS",
        help="Run until digits are stable (JCGM 101, 7.9).",
    ),
    click.option("--for", "forecasts", multiple=True, metavar="FORECAST", help="Whose.  [default: every forecast's]"),
    click.option("--time-limit", metavar="TIME", help="End the run after 60s, 5m or 1h30m."),
)


def stopping_options(command: F) -> F:
    """Adds the options, under the names that `Model.simulate` has for them."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command
