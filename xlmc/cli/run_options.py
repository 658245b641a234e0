"""The options that say who computes a run and when it ends."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from xlmc.cli.parameter_types import OneOf, WholeNumber
from xlmc.evaluation.engines import ENGINES
from xlmc.sampling.methods import METHODS

__all__ = ["engine_option", "jobs_option", "sampling_option", "stopping_options"]

F = TypeVar("F", bound=Callable[..., Any])

_MOST_JOBS = 1024

jobs_option = click.option(
    "-j", "--jobs", type=WholeNumber(1, _MOST_JOBS), default=1, show_default=True, help="Threads or processes."
)
"""Who computes; the result does not depend on it."""

_SAMPLINGS = "; ".join(f"{method.key}: {method.name}" for method in METHODS.values())
_ENGINES = "; ".join(f"{engine.key}: {engine.what}" if engine.what else engine.key for engine in ENGINES.values())

sampling_option = click.option(
    "--sampling", type=OneOf(*METHODS), help=f"{_SAMPLINGS}.  [default: the book's, else mc]"
)
engine_option = click.option("--engine", type=OneOf(*ENGINES), help=f"{_ENGINES}.  [default: the book's, else numpy]")

_OPTIONS = (
    click.option(
        "--until-accepted",
        type=WholeNumber(2),
        metavar="N",
        help="Run until N trials are accepted, -n at most.",
    ),
    click.option(
        "--rare",
        type=OneOf("auto", "never", "always"),
        help="Find rare accepted trials by learning where they are.  [default: auto: where -n would not be enough]",
    ),
    click.option(
        "--precision", metavar="WIDTH", help="Run until numbers are known to 1% of themselves, or 0.1 in their units."
    ),
    click.option("--precision-of", metavar="NAMES", help="Which: mean,sd,range,p75.5.  [default: mean,range]"),
    click.option("--confidence", metavar="PERCENT", help="Confidence of --precision.  [default: 95]"),
    click.option(
        "--adaptive",
        type=WholeNumber(1, 6),
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
