"""The work that the window of a workbook asks for: what is run, and which messages are made of it.

A piece of work depends on nothing that changes later: it holds all that it needs, so that any thread can do it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final, Literal

from xlmc.errors import XlmcError
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.interruption import looking
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.outputs.document.element import element, join
from xlmc.outputs.live.adjustments import Adjustments
from xlmc.outputs.live.comparison import Comparison
from xlmc.outputs.live.frames import Bases, bases_of, frame_of, matrix_of, matters_html, pair_of, rest_of, tables_html
from xlmc.outputs.live.moving_models import KnownModels
from xlmc.outputs.live.protocol import Message, PageMessage
from xlmc.outputs.live.single_step import step_of
from xlmc.outputs.live.window_book import Shapes, shapes_of

if TYPE_CHECKING:
    from xlmc.montecarlo.loop.stopping import Progress
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulate import OnProgress
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = [
    "MOVING_TRIALS",
    "PARTS",
    "RUNS",
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


RUNS: Final[tuple[Stage, ...]] = ("quick", "moving", "sketch", "rest")
"""The stages of a state, in order; what comes after them shows more of the last one."""


class SupersededError(Exception):
    """Something newer was asked for, or the run was stopped."""


@dataclass(frozen=True, slots=True)
class Tab:
    """An open tab, the two quantities of the tab `pairs`, the forecasts that tabs are of, and the trial of `step`."""

    key: str = "charts"
    first: str = ""
    second: str = ""
    chosen: tuple[str, ...] = ()
    trial: int = 0


@dataclass(frozen=True, slots=True)
class View:
    """What can be seen in all windows together: the charts of these forecasts, these tabs, fitted distributions."""

    forecasts: tuple[str, ...]
    tabs: tuple[Tab, ...] = (Tab(),)
    fits: bool = False

    @classmethod
    def of(cls, sent: Iterable[PageMessage], order: Sequence[str]) -> View:
        """Return the union of what the windows show, with the forecasts in the order of the workbook."""
        views = list(sent)
        seen = {name for each in views for name in each["forecasts"]}
        chosen = {name for each in views for name in each["chosen"]}
        of = tuple(name for name in order if name in chosen)
        tabs = dict.fromkeys(_tab(each, of) for each in views)
        return cls(tuple(name for name in order if name in seen), tuple(tabs), any(each["fits"] for each in views))


def _tab(sent: PageMessage, chosen: tuple[str, ...]) -> Tab:
    if sent["tab"] == "pairs":
        return Tab("pairs", sent["first"], sent["second"], chosen)
    if sent["tab"] == "step":
        return Tab("step", trial=sent["trial"])
    return Tab(sent["tab"], chosen=chosen if sent["tab"] in ("matters", "tables") else ())


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
ReportShare = Callable[[float], None]
Clock = Callable[[], float]
Work = Callable[[Wanted, ReportShare, Clock], Outcome]
"""Is given what says whether it is still wanted, what takes the share done, and a clock."""


@dataclass(frozen=True, slots=True)
class Job:
    """A piece of work that a session asks for.

    Attributes:
        stage: which.
        version: of the state that it is of.
        dragged: whether a handle is held: there is hurry then, and more to come.
        run: does it. It raises `SupersededError` where it is not wanted any more.
        done: what is up to date when it was run -> the state that it is up to date with.
    """

    stage: Stage
    version: int
    dragged: bool
    run: Work
    done: Mapping[str | Tab, object]


PARTS: Final[Mapping[str, Callable[[RunResult, Tab, ReportShare], Message]]] = {
    "matters": lambda run, tab, report_share: {"html": matters_html(run, tab.chosen, report_share)},
    "tables": lambda run, tab, report_share: {"html": tables_html(run, tab.chosen, report_share)},
    "pairs": lambda run, tab, _: {
        "pair": pair_of(run, tab.first, tab.second),
        **({"matrix": matrix_of(run, tab.chosen)} if tab.chosen else {}),
    },
    "step": lambda run, tab, _: step_of(run, tab.trial),
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
        shapes: of the distributions that were shown last.
        view: what can be seen.
        behind: the state to be drawn behind it; None where there is none.
        method: how evidence is used while states move.
        trials: of a run that moves.
        piece: trials after which it is looked whether the run is still wanted.
        in_memory: bytes of its trials that stay in memory.
        watched: whether that is looked at all; a run that is quick ends sooner than the next move comes.
        draws: trials of a run that moves whose draws are kept, as what is shown of it needs them.
        asked: trials and seed, where they are not those of the workbook.
    """

    stage: Stage
    version: int
    seq: int
    adjustments: Adjustments
    models: KnownModels
    shapes: Shapes
    view: View
    behind: RunResult | None
    method: str | None
    trials: int
    piece: int
    in_memory: int
    watched: bool
    draws: int
    asked: RunOptions

    def run(self, wanted: Wanted, report_share: ReportShare, clock: Clock) -> Outcome:
        """Do it; see `Work`."""

        def watch(progress: Progress) -> None:
            if not wanted():
                raise SupersededError
            report_share(progress.share)

        with looking(_giving_up(wanted)) if self.watched else nullcontext():
            return self._run(watch if self.watched else None, clock)

    def _run(self, watched: OnProgress | None, clock: Clock) -> Outcome:
        resting = self.stage == "rest"
        try:
            if resting:
                model = self.models.at_rest(self.adjustments)
                begun = clock()
                options = replace(self.asked, in_memory=self.in_memory)
                run = run_model(model, options, progress=watched, pieces=self.piece, follow=())
                base = bases_of(run)
            else:
                moving = self.models.moving(self.adjustments)
                model, base = moving.model, moving.base
                pieces = -(-self.trials // min(self.piece, moving.reusing.largest_block))
                runner = moving.runner(-(-self.trials // pieces))
                begun = clock()
                method = self.method or "rejection"
                options = RunOptions(
                    trials=self.trials,
                    seed=self.asked.seed,
                    sampling="mc",
                    engine=moving.reusing.engine,
                    evidence=method,
                    keep_inputs=self.draws,
                    keep_prior=False,
                    in_memory=self.in_memory,
                )
                run = run_model(
                    model,
                    options,
                    own_runner=None if self.method == "weights" else runner,  # it computes other filters
                    progress=watched,
                    follow=(),
                )
            seconds = (clock() - begun) / max(run.evaluated, 1)
            messages = self._messages(run, model, base)
        except XlmcError as error:
            return Outcome(problem=str(error))
        return Outcome(tuple(messages), run, seconds)

    def _messages(self, run: RunResult, model: CompiledModel, base: Bases | None) -> list[Message]:
        """Return what is shown of a run."""
        resting, view = self.stage == "rest", self.view
        frame = frame_of(run, self.behind, view.forecasts, base, moving=not resting, fits=resting and view.fits)
        messages = [_frame("rest" if resting else "moving", self.version, self.seq, frame)]
        messages[0]["shapes"] = shapes_of(model, self._reshaped(model), self.shapes)
        if resting:
            return [*messages, {"kind": "rest", "version": self.version, **rest_of(run)}]
        pairs = (replace(tab, chosen=()) for tab in view.tabs if tab.key == "pairs")  # whose matrix takes its time
        return [*messages, *(_part(run, self.version, tab, lambda share: None) for tab in pairs)]

    def _reshaped(self, model: CompiledModel) -> list[str]:
        """Return the assumptions whose distribution may differ from the workbook's."""
        changed = list(self.adjustments.assumptions)
        if self.adjustments.typed_part():  # which formulas of parameters may read
            changed += [each.name for each in model.assumptions if each.stated and each.name not in changed]
        return changed


def charts_of(simulation: RunResult, behind: RunResult | None, seq: int, sight: Sight) -> Work:
    """Make the charts of a finished run, for what can be seen now."""
    version, names, fits, _ = sight

    def run(wanted: Wanted, *_: object) -> Outcome:
        with looking(_giving_up(wanted)):
            frame = frame_of(simulation, behind, names, bases_of(simulation), moving=False, fits=fits)
        return Outcome((_frame("rest", version, seq, frame),))

    return run


def sketched_tab(simulation: RunResult, version: int, tab: Tab, most: float) -> Work:
    """Make *What matters* of the run of a state that moves; it is given up if it takes more than `most` seconds."""

    def run(_wanted: Wanted, _report_share: ReportShare, clock: Clock) -> Outcome:
        begun = clock()
        with looking(_giving_up(lambda: clock() - begun < most)):
            message = _part(simulation, version, tab, lambda share: None)
        return Outcome((message,), seconds=clock() - begun)

    return run


def tab_of(simulation: RunResult, version: int, tab: Tab) -> Work:
    """Make the contents of an open tab."""

    def run(wanted: Wanted, report_share: ReportShare, _clock: Clock) -> Outcome:
        with looking(_giving_up(wanted)):
            return Outcome((_part(simulation, version, tab, report_share),))

    return run


def scenario_table(comparison: Comparison, asked: int) -> Work:
    """Put all scenarios into one table, those of the workbook and those that are kept in the window.

    Args:
        comparison: of them; what is done of it is kept where the work is given up.
        asked: how often the table was asked for.
    """

    def run(wanted: Wanted, report_share: ReportShare, _clock: Clock) -> Outcome:
        try:
            with looking(go_on := _giving_up(wanted)):
                html = comparison.html(go_on, report_share)
        except XlmcError as error:
            html = join([element("p", str(error), class_="warning")]).source
        message = {"kind": "part", "tab": "scenarios", "version": asked, "html": html}
        return Outcome((message,))

    return run


def _giving_up(wanted: Wanted) -> Callable[[], None]:
    """Return a check that ends work which is not wanted any more."""

    def look() -> None:
        if not wanted():
            raise SupersededError

    return look


def _frame(stage: str, version: int, seq: int, charts: Message) -> Message:
    return {"kind": "frame", "stage": stage, "version": version, "seq": seq, **charts}


def _part(simulation: RunResult, version: int, tab: Tab, report_share: ReportShare) -> Message:
    return {"kind": "part", "tab": tab.key, "version": version, **PARTS[tab.key](simulation, tab, report_share)}
