"""Crystal Ball's precision control: a run goes on until numbers of forecasts are known well enough.

Crystal Ball asks of every forecast by itself; a run of xlmc has one precision, of some forecasts or of all. Where the
forecasts ask for one and the same, it becomes the goal of the run. Else the run is one of a number of trials, as where
nothing is asked, and a notice says what was asked for.

The confidence level is a run preference, which no workbook holds: xlmc's own is taken, which is also Crystal Ball's.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.crystal_ball.from_dialogs import UNPROVEN
from xlmc.montecarlo.definitions.definitions import Forecast, Settings
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.stopping import LIMIT
from xlmc.montecarlo.definitions.stopping import Precision as Goal
from xlmc.montecarlo.number_text import count_text, number_text

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.crystal_ball.stored_objects import Precision

__all__ = ["with_precision"]


def with_precision(
    settings: Settings,
    stated: Collection[str],
    asked: Mapping[str, Precision],
    forecasts: Sequence[Forecast],
    findings: Findings,
) -> Settings:
    """Return the settings with the precision that dialogs ask for.

    Args:
        settings: of the table `xlmc_settings`, which wins.
        stated: what is set there.
        asked: forecast -> what its dialog asks for.
        forecasts: that are run.
        findings: takes remarks.
    """
    goals: dict[str, Goal] = {}
    for forecast in (each for each in forecasts if each.name in asked):
        try:
            goals[forecast.name] = _goal(asked[forecast.name])
        except SimulationError as error:
            message = f"Crystal Ball's precision control of {forecast.name!r} is not used: {error.message}"
            findings.notice(message, forecast.cell)
    if not goals:
        return settings
    where = next(each.cell for each in forecasts if each.name in goals)
    what = "; ".join(f"{_words(goal)} of {name!r}" for name, goal in goals.items())
    reason = _why_not(stated, goals)
    if reason:
        message = f"Crystal Ball's precision control is not used, as {reason}. It asks for {what}"
        findings.notice(message, where)
        return settings
    message = (
        f"the run goes on until Crystal Ball's precision control is satisfied, {count_text(LIMIT)} "
        f"trials at most: {what}, at "
        f"95 % confidence. A number of trials, as -n 10000, runs so many instead; {UNPROVEN}"
    )
    findings.notice(message, where)
    names = () if len(goals) == len(forecasts) else tuple(goals)
    ends = replace(settings.stopping, goal=next(iter(goals.values())), forecasts=names)
    return replace(settings, trials=LIMIT, stopping=ends)


def _goal(asked: Precision) -> Goal:
    """Return the goal of one forecast.

    Raises:
        SimulationError: it asks for nothing that can be reached.
    """
    widths = [(width, of) for width, of in ((asked.absolute, False), (asked.relative, True)) if width is not None]
    if len(widths) != 1:
        raise SimulationError("it gives neither an absolute nor a relative width, or both")
    ((width, relative),) = widths
    return Goal(width, relative, asked.numbers)


def _why_not(stated: Collection[str], goals: Mapping[str, Goal]) -> str:
    """Why the goals are not used for the run, in words; empty if they are used."""
    if stated:
        return "the table xlmc_settings says how to run (its rows Precision, Precision of and Look at ask for one)"
    if len(set(goals.values())) > 1:
        return "a run has one precision, and the forecasts ask for several (--precision and --for ask for one)"
    return ""


def _words(goal: Goal) -> str:
    width = f"{number_text(100 * goal.tolerance)} %" if goal.relative else number_text(goal.tolerance)
    return f"{' and '.join(goal.numbers)} to within {width}"
