"""The options that say who computes a run and when it ends."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from xlmc.cli.parameter_types import OneOf, WholeNumber
from xlmc.definitions.stopping import GOALS, RARE, Option
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


def _goal_option(option: Option) -> Callable[[F], F]:
    kind = WholeNumber(*option.takes) if isinstance(option.takes, tuple) else str
    return click.option(f"--{option.name.replace('_', '-')}", type=kind, metavar=option.metavar, help=option.help)


_OPTIONS = (
    *(_goal_option(option) for goal in GOALS.values() for option in goal.options),
    click.option(
        "--rare",
        type=OneOf(*RARE),
        help="Find rare accepted trials by learning where they are.  [default: auto: where -n would not be enough]",
    ),
    click.option("--for", "forecasts", multiple=True, metavar="FORECAST", help="Whose.  [default: every forecast's]"),
    click.option("--time-limit", metavar="TIME", help="End the run after 60s, 5m or 1h30m."),
)


def stopping_options(command: F) -> F:
    """Adds the options, under the names that `Model.simulate` has for them."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command
