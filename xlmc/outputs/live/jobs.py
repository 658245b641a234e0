"""The work that the window of a workbook asks for: what is run, and which messages are made of it.

A piece of work depends on nothing that changes later: it holds all that it needs, so that any thread can do it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final, Literal

from xlmc.errors import XlmcError
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.outputs.live.adjustments import Adjustments, scenario_of
from xlmc.outputs.live.frames import bases_of, frame_of, matters_html, pair_of, rest_of, scenarios_html, tables_html
from xlmc.outputs.live.moving_models import KnownModels
from xlmc.outputs.live.protocol import Message, Said
from xlmc.outputs.live.window_book import shapes_of
from xlmc.outputs.page.element import element, join

if TYPE_CHECKING:
    from xlmc.montecarlo.loop.stopping import Progress
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = [
    "MOVING_TRIALS",
    "PARTS",
    "SKETCHED",
    "Job",
    "Outcome",
    "Sight",
    "Stage",
    "StateRun",
    "SupersededError",
    "Tab",
    "View",
    "Work",
    "charts_of",
    "scenario_table",
    "sketched_tab",
    "tab_of",
]

MOVING_TRIALS: Final = 50_000
"""Trials of a run while a handle moves."""

Sight = tuple[int, tuple[str, ...], bool, int]
"""Version, forecasts, whether with fits, and what is behind."""

Stage = Literal["quick", "moving", "sketch", "rest", "shown", "part", "compare"]


class SupersededError(Exception):
    """Something newer was asked for, or the run was stopped."""


@dataclass(frozen=True, slots=True)
class Tab:
    """An open tab, and the two quantities of the tab `pairs`."""

    key: str = "charts"
    first: str = ""
    second: str = ""


@dataclass(frozen=True, slots=True)
class View:
    """What can be seen in all windows together: the charts of these forecasts, these tabs, fitted distributions."""

    forecasts: tuple[str, ...]
    tabs: tuple[Tab, ...] = (Tab(),)
    fits: bool = False

    @classmethod
    def of(cls, said: Iterable[Said], order: Sequence[str]) -> View:
        """The union of what the windows show, with the forecasts in the order of the workbook."""
        views = list(said)
        seen = {name for each in views for name in each["forecasts"]}
        tabs = dict.fromkeys(Tab(each["tab"], each["first"], each["second"]) for each in views)
        return cls(tuple(name for name in order if name in seen), tuple(tabs), any(each["fits"] for each in views))


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a job found.

    Attributes:
        seconds: for a trial, roughly; None where nothing was run.
        problem: why nothing was found; None where something was.
    """

    messages: tuple[Message, ...] = ()
    simulation: RunResult | None = None
    seconds: float | None = None
    problem: str | None = None


Wanted = Callable[[], bool]
Tell = Callable[[float], None]
Clock = Callable[[], float]
Work = Callable[[Wanted, Tell, Clock], Outcome]
"""Is given what says whether it is still wanted, what takes the share done, and a clock."""


@dataclass(frozen=True, slots=True)
class Job:
    """A piece of work that a session asks for.

    Attributes:
        stage: which.
        version: of the state that it is of.
        held: whether a handle is held: there is hurry then, and more to come.
        run: does it. It raises `SupersededError` where it is not wanted any more.
        done: what is up to date when it was run -> the state that it is up to date with.
    """

    stage: Stage
    version: int
    held: bool
    run: Work
    done: Mapping[str, object]


PARTS: Final[Mapping[str, Callable[[RunResult, Tab], Message]]] = {
    "matters": lambda run, _: {"html": matters_html(run)},
    "tables": lambda run, _: {"html": tables_html(run)},
    "pairs": lambda run, tab: {"pair": pair_of(run, tab.first, tab.second)},
}
"""Tab whose contents are made of a run at rest -> what makes them."""

SKETCHED: Final = "matters"
"""The tab that is brought up to date while a state moves, too."""


@dataclass(frozen=True, slots=True)
class StateRun:
    """The run of a state, and what is shown of it.

    Attributes:
        stage: `quick`, `moving` or `rest`.
        version: of the state.
        seq: of the message that made it.
        adjustments: the state.
        models: what gives its model.
        view: what can be seen.
        behind: the state to be drawn behind it; None where there is none.
        way: how evidence is used while states move.
        trials: of a run that moves.
        piece: trials after which it is looked whether the run is still wanted.
        watched: whether that is looked at all; a run that is quick ends sooner than the next move comes.
    """

    stage: Stage
    version: int
    seq: int
    adjustments: Adjustments
    models: KnownModels
    view: View
    behind: RunResult | None
    way: str | None
    trials: int
    piece: int
    watched: bool

    def run(self, wanted: Wanted, tell: Tell, clock: Clock) -> Outcome:
        """See `Work`."""

        def watch(progress: Progress) -> None:
            if not wanted():
                raise SupersededError
            tell(progress.share)

        watched, resting, view = watch if self.watched else None, self.stage == "rest", self.view
        try:
            if resting:
                model = self.models.at_rest(self.adjustments)
                begun = clock()
                found = run_model(model, RunOptions(), progress=watched, pieces=self.piece)
                base = bases_of(found)
            else:
                moving = self.models.moving(self.adjustments)
                model, base = moving.model, moving.base
                pieces = -(-self.trials // min(self.piece, moving.kept.largest_block))
                runner = moving.runner(-(-self.trials // pieces))
                begun = clock()
                way = self.way or "rejection"
                options = RunOptions(trials=self.trials, sampling="mc", engine=moving.kept.engine, evidence=way)
                found = run_model(
                    model,
                    options,
                    own_runner=None if self.way == "weights" else runner,  # it computes other filters
                    progress=watched,
                )
            seconds = (clock() - begun) / max(found.evaluated, 1)
            frame = frame_of(found, self.behind, view.forecasts, base, moving=not resting, fits=resting and view.fits)
            messages = [_frame("rest" if resting else "moving", self.version, self.seq, frame)]
            messages += [_part(found, self.version, tab) for tab in view.tabs if tab.key == "pairs" and not resting]
            messages[0]["shapes"] = shapes_of(model, list(self.adjustments.assumptions))
            if resting:
                messages.append({"kind": "rest", "version": self.version, **rest_of(found)})
        except XlmcError as error:
            return Outcome(problem=str(error))
        return Outcome(tuple(messages), found, seconds)


def charts_of(simulation: RunResult, behind: RunResult | None, seq: int, sight: Sight) -> Work:
    """The charts of a run that is done, for what can be seen now."""
    version, names, fits, _ = sight

    def run(*_: object) -> Outcome:
        frame = frame_of(simulation, behind, names, bases_of(simulation), moving=False, fits=fits)
        return Outcome((_frame("rest", version, seq, frame),))

    return run


def sketched_tab(simulation: RunResult, version: int) -> Work:
    """What matters, of the run of a state that moves."""

    def run(_wanted: Wanted, _tell: Tell, clock: Clock) -> Outcome:
        begun = clock()
        message = _part(simulation, version, Tab(SKETCHED))
        return Outcome((message,), seconds=clock() - begun)

    return run


def tab_of(simulation: RunResult, version: int, tab: Tab) -> Work:
    """The contents of an open tab."""

    def run(*_: object) -> Outcome:
        return Outcome((_part(simulation, version, tab),))

    return run


def scenario_table(own: CompiledModel, kept: Mapping[str, Adjustments], asked: int) -> Work:
    """All scenarios in one table, those of the workbook and those that are kept in the window.

    Args:
        own: the workbook's model.
        kept: those of the window, by name; they take the place of one of the same name.
        asked: how often the table was asked for.
    """

    def run(wanted: Wanted, tell: Tell, _clock: Clock) -> Outcome:
        fitting = {name: each.only(own.definitions) for name, each in kept.items()}
        scenarios = tuple(scenario_of(own.definitions, name, each) for name, each in fitting.items())
        all_of_them = (*(each for each in own.definitions.scenarios if each.name not in kept), *scenarios)
        model = own.changed(own.workbook, replace(own.definitions, scenarios=all_of_them))
        begun: list[str] = []

        def told(name: str) -> None:
            if not wanted():
                raise SupersededError
            begun.append(name)
            tell(len(begun) / (len(all_of_them) + 1))

        try:
            html = scenarios_html(model, lambda model: run_model(model, RunOptions(scenarios=True)), told)
        except XlmcError as error:
            html = join([element("p", str(error), class_="warning")]).source
        message = {"kind": "part", "tab": "scenarios", "version": asked, "html": html}
        return Outcome((message,))

    return run


def _frame(stage: str, version: int, seq: int, charts: Message) -> Message:
    return {"kind": "frame", "stage": stage, "version": version, "seq": seq, **charts}


def _part(simulation: RunResult, version: int, tab: Tab) -> Message:
    return {"kind": "part", "tab": tab.key, "version": version, **PARTS[tab.key](simulation, tab)}
