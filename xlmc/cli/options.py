"""Options that several commands share, and the kinds of values that options take."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from xlmc.engine.engines import ENGINES
from xlmc.montecarlo.definitions.evidence_ways import EVIDENCE_WAYS
from xlmc.montecarlo.definitions.stopping import GOALS, RARE, Option
from xlmc.montecarlo.sampling.sampling_methods import METHODS

__all__ = [
    "OneOf",
    "WholeNumber",
    "chance_option",
    "engine_option",
    "evidence_option",
    "jobs_option",
    "sampling_option",
    "stopping_options",
    "tolerance_option",
]

F = TypeVar("F", bound=Callable[..., Any])

_MOST_JOBS = 1024

_SAMPLINGS = "; ".join(f"{method.key}: {method.name}" for method in METHODS.values())

_ENGINES = "; ".join(f"{engine.key}: {engine.what}" if engine.what else engine.key for engine in ENGINES.values())


class WholeNumber(click.ParamType):  # type: ignore[type-arg]  # no generic before click 8.2
    """A whole number from `least` to `most`: `200000`, `200,000`, `2e5` or `200k`."""

    name = "integer"

    def __init__(self, least: int, most: int | None = None) -> None:
        self._least, self._most = least, most

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:
        """The number that was typed.

        Raises:
            BadParameter: it is none, or lies outside.
        """
        from xlmc.montecarlo.definitions.amounts import typed_whole_number

        found = value if isinstance(value, int) else typed_whole_number(value)
        if found is None:
            self.fail(f"{value!r} is not a whole number. Type it like 200000, 200,000, 2e5 or 200k.", param, ctx)
        if found < self._least:
            self.fail(f"{found:,} is too small. Type {self._least:,} or more.", param, ctx)
        if self._most is not None and found > self._most:
            self.fail(f"{found:,} is too large. Type {self._most:,} or less.", param, ctx)
        return found


class OneOf(click.Choice):  # type: ignore[type-arg]  # likewise
    """One of some words, in any case."""

    def __init__(self, *words: str) -> None:
        super().__init__(words, case_sensitive=False)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """The word that was typed.

        Raises:
            BadParameter: it is another.
        """
        from xlmc.cli.mistakes import did_you_mean

        words: dict[str, str] = {word.casefold(): word for word in self.choices}
        found = words.get(str(value).strip().casefold())
        if found is None:
            known = ", ".join(self.choices)
            self.fail(f"{value!r} is not one of {known}.{did_you_mean(value, self.choices)}", param, ctx)
        return found


jobs_option = click.option(
    "-j",
    "--jobs",
    type=WholeNumber(1, _MOST_JOBS),
    default=1,
    show_default=True,
    help="Threads or processes to use.",
)
"""The option for threads or processes; the result does not depend on it."""

sampling_option = click.option(
    "--sampling", type=OneOf(*METHODS), help=f"{_SAMPLINGS}.  [default: the book's, else mc]"
)

evidence_option = click.option(
    "--evidence",
    type=OneOf(*EVIDENCE_WAYS),
    help="How evidence with a normal or lognormal error is used: rejection: it rejects trials; weights: it weights"
    " them; auto: the run's first trials decide.  [default: the book's, else auto]",
)

engine_option = click.option("--engine", type=OneOf(*ENGINES), help=f"{_ENGINES}.  [default: the book's, else numpy]")

tolerance_option = click.option(
    "--tolerance",
    multiple=True,
    help="The largest difference that counts as none: 0.5, '0.5 mph', '10 %' of the SD, 'Name=0.5 mph'; may be given"
    " several times.  [default: 10 %]",
)

chance_option = click.option(
    "--chance",
    type=float,
    help="The largest difference that counts as none, in percentage points, of the probability of being above a"
    " forecast's threshold.  [default: a tenth of it or of the probability below, at least 0.1]",
)


def _goal_option(option: Option) -> Callable[[F], F]:
    kind = WholeNumber(*option.takes) if isinstance(option.takes, tuple) else str
    return click.option(f"--{option.name.replace('_', '-')}", type=kind, metavar=option.metavar, help=option.help)


_OPTIONS = (
    *(_goal_option(option) for goal in GOALS.values() for option in goal.options),
    click.option(
        "--rare",
        type=OneOf(*RARE),
        help="Where accepted trials are rare, learn where they are and draw there.  [default: auto: if -n would not be"
        " enough]",
    ),
    click.option(
        "--for",
        "forecasts",
        multiple=True,
        metavar="FORECAST",
        help="The forecast whose precision or digits count; may be given several times.  [default: all]",
    ),
    click.option("--time-limit", metavar="TIME", help="End the run after 60s, 5m or 1h30m."),
)


def stopping_options(command: F) -> F:
    """Add the options, under the names that `Model.simulate` has for them."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command
