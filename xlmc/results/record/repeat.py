"""The command that repeats a run."""

from __future__ import annotations

import re
import shlex
from typing import TYPE_CHECKING

from xlmc.definitions.stopping import LIMIT

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["quoted_argument", "repeat_command"]

_PLAIN = re.compile(r"[\w.,:+@%/=-]+")
_SAFE_IN_DOUBLE_QUOTES = re.compile(r'[^"\\$`!%\n]+')


def repeat_command(simulation: Simulation) -> str:
    """What to type, in the workbook's folder, to get the same numbers: `xlmc simulate book.xlsx --trials … --seed …`.

    A run that ended with an accepted trial it waited for is repeated as that, any other by its number of trials. Other
    settings are named where they differ from the workbook's own, which the repeat reads again.
    """
    settings, own = simulation.settings, simulation.model.definitions.settings
    book = simulation.model.workbook.name
    options = [*_length(simulation), f"--seed {settings.seed}"]
    if settings.sampling != own.sampling:
        options.append(f"--sampling {settings.sampling}")
    if settings.stopping.rare is not None and simulation.stopped.by in ("accepted", "search"):
        options.append(f"--rare {settings.stopping.rare}")
    if settings.engine != own.engine:
        options.append(f"--engine {settings.engine}")
    return " ".join(["xlmc simulate", quoted_argument(f"./{book}" if book.startswith("-") else book), *options])


def _length(simulation: Simulation) -> list[str]:
    settings = simulation.settings
    if simulation.stopped.by == "search" or getattr(simulation, "rare", None) is not None:
        limit = [] if settings.trials == LIMIT else [f"--trials {settings.trials}"]
        return [*limit, f"--until-accepted {settings.stopping.accepted}"]
    if simulation.stopped.by != "accepted":
        return [f"--trials {simulation.trials}"]
    limit = [f"--trials {simulation.trials}"] if simulation.trials > LIMIT else []
    return [*limit, f"--until-accepted {simulation.accepted}"]


def quoted_argument(text: str) -> str:
    """The text as one argument of a command: in double quotes, which every shell knows, or else as POSIX quotes."""
    if _PLAIN.fullmatch(text):
        return text
    return f'"{text}"' if _SAFE_IN_DOUBLE_QUOTES.fullmatch(text) else shlex.quote(text)
