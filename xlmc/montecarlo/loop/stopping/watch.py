"""Watch a run: its goal, its number of trials, its time, and Ctrl-C, which asks it to end."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Collection, Sequence
from types import FrameType, TracebackType
from typing import Any, Final

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.definitions.stopping import Stopping
from xlmc.montecarlo.distributions.spelling import by_names, name_key
from xlmc.montecarlo.loop.stopping.adaptive import UntilStable
from xlmc.montecarlo.loop.stopping.precision import UntilPrecise
from xlmc.montecarlo.loop.stopping.rule import Columns, Observed, StopRule, UntilAccepted
from xlmc.montecarlo.loop.stopping.stopped import Stopped
from xlmc.montecarlo.model.plain_words import duration
from xlmc.montecarlo.number_text import count_text
from xlmc.montecarlo.sampling.sampling_methods import METHODS

__all__ = ["RULES", "Interruption", "Watch", "chosen_rule", "may_end_early", "refuse_other_sampling"]

RULES: Final[dict[str, Callable[..., StopRule]]] = {
    UntilAccepted.key: UntilAccepted,
    UntilPrecise.key: UntilPrecise,
    UntilStable.key: UntilStable,
}
"""The key of a goal -> its rule: made of the goal and, where it looks at forecasts, of these, each as (index, name,
share of the central range)."""


class Watch:
    """Looks at the blocks of a run in their order, and says what ends it.

    Args:
        rule: what it goes on until; None if it is to run its trials.
        trials: how many at most.
        seconds: how long at most; None for as long as it takes.
        clock: seconds from any moment on; read for the first time now.
    """

    def __init__(self, rule: StopRule | None, trials: int, seconds: float | None, clock: Callable[[], float]) -> None:
        self._rule, self._trials, self._seconds, self._clock = rule, trials, seconds, clock
        self._began = clock()
        self._seen = 0

    @property
    def share(self) -> float:
        """How much of the run is done, 0 to 1; an estimate where it goes on until something is reached."""
        shares = [self._seen / self._trials]
        if self._rule is not None:
            shares.append(self._rule.share)
        if self._seconds is not None:
            shares.append(min(1.0, (self._clock() - self._began) / self._seconds))
        return max(shares)

    @property
    def goal_reached(self) -> Stopped:
        """What is said of a run that came to its goal; it has one."""
        assert self._rule is not None
        return Stopped(self._rule.key, self._rule.goal, self._rule.goal)

    def counting(self, block: Observed) -> int:
        """How many of the block's trials count; if fewer than it has, they are the run's last."""
        return block.trials if self._rule is None else self._rule.counting(block, self._seen)

    def after(self, block: Observed, columns: Columns, *, interrupted: bool = False) -> Stopped | None:
        """Return what ends the run with this block, cut to the trials that count; None if nothing does."""
        self._seen += block.trials
        goal = None if self._rule is None else self._rule.goal
        if self._rule is not None and self._rule.reached(block, columns):
            return Stopped(self._rule.key, self._rule.goal, goal)
        if self._seen >= self._trials:
            limit = (
                "all trials were run" if goal is None else f"the limit of {count_text(self._trials)} trials was reached"
            )
            return Stopped("trials", limit, goal)
        return self.meanwhile(interrupted=interrupted)

    def meanwhile(self, *, interrupted: bool = False) -> Stopped | None:
        """Return what ends the run where no block was run: somebody, or the time; None if nothing does."""
        goal = None if self._rule is None else self._rule.goal
        if interrupted:
            return Stopped("interruption", "it was interrupted", goal)
        if self._seconds is not None and self._clock() - self._began >= self._seconds:
            return Stopped("time", f"the time limit of {duration(self._seconds)} was reached", goal)
        return None


class Interruption:
    """Notes a first Ctrl-C while there is something to keep; any other is a `KeyboardInterrupt` as ever.

    Python hears signals in its main thread alone: elsewhere, or where Ctrl-C is ignored, this does nothing.

    Args:
        wanted: whether to note anything.

    Attributes:
        asked: whether the run is to end.
        keeping: whether there is something to keep; to be set by whoever has it.
        at_once: whether the first is a `KeyboardInterrupt` too, of whose raiser `left` says that it was the first.
        left: whether the first was raised, and not taken notice of yet.
    """

    def __init__(self, *, wanted: bool) -> None:
        self._wanted = wanted
        self._before: Any = None
        self.asked = self.keeping = self.at_once = self.left = False

    def __enter__(self) -> Interruption:
        usual = self._wanted and threading.current_thread() is threading.main_thread()
        if usual and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            self._before = signal.signal(signal.SIGINT, self._heard)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)

    def _heard(self, number: int, frame: FrameType | None) -> None:
        if self.asked or not self.keeping:
            raise KeyboardInterrupt
        self.asked = True
        if self.at_once:
            self.left = True
            raise KeyboardInterrupt


def chosen_rule(asked: Stopping, forecasts: Sequence[Forecast], texts: Collection[int] = ()) -> StopRule | None:
    """Make the rule; None if the run is to run its trials.

    Raises:
        SimulationError: there is no forecast of a name, or none at all, or its answers are texts: the numbers of those
            are `texts`.
    """
    goal = asked.goal
    if goal is None:
        return None
    rule = RULES[goal.key]
    return rule(goal, _named(asked.forecasts, forecasts, texts)) if goal.of_forecasts else rule(goal)


def _named(names: Sequence[str], forecasts: Sequence[Forecast], texts: Collection[int]) -> list[tuple[int, str, float]]:
    numbers = {each.name: index for index, each in enumerate(forecasts) if index not in texts}
    index_of = {key: numbers[each.name] for key, each in by_names(forecasts).items() if each.name in numbers}
    if not index_of:
        raise SimulationError("there is no forecast whose precision could be asked for", hint="Define a forecast")
    for name in names:
        if name_key(name) not in index_of:
            hint = f"choose from {', '.join(map(repr, numbers))}"
            raise SimulationError(f"there is no forecast {name!r}", hint=hint)
    result = dict.fromkeys(index_of[name_key(name)] for name in names) or numbers.values()
    return [(index, forecasts[index].name, forecasts[index].central) for index in result]


def may_end_early(sampling: str) -> bool:
    """Whether the first trials of a run are a sample, as those of a Latin hypercube or a Sobol sequence are not."""
    return METHODS[sampling].independent


def refuse_other_sampling(sampling: str, asked: Stopping) -> None:
    """Refuse to end a run early whose trials belong together.

    Raises:
        SimulationError: something but the number of trials may end it.
    """
    if asked.asked and not may_end_early(sampling):
        message = f"a run with {sampling} sampling cannot end before all its trials are run"
        raise SimulationError(message, hint="Use mc, plain Monte Carlo, or give a number of trials alone")
