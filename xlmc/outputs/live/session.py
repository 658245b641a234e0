"""What the window of one workbook knows, and what it does next: no sockets, files, threads or clocks.

A session takes messages and gives messages. What takes time it gives as a `Job`, which depends on nothing that changes
later: somebody runs it, wherever he likes, and hands the outcome back. While a handle is held, jobs are runs of
`MOVING_TRIALS` trials by Monte Carlo; as soon as nothing is newer, the run of the workbook's own settings follows,
whose numbers are those of `xlmc simulate` to the last bit, and then what the open tab shows. All runs have the same
seed, and assumptions streams of their own: what is not moved is drawn as before, so that the picture stands still.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

from xlmc.errors import XlmcError
from xlmc.montecarlo.definitions.number_styles import in_style, in_style_of
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.outputs.live.adjustments import (
    LIMITS,
    NONE,
    REMOVABLE,
    SWITCHES,
    Adjustments,
    Amount,
    is_choice,
    is_own,
    own_values,
)
from xlmc.outputs.live.adjustments_in_words import in_words
from xlmc.outputs.live.comparison import Comparison
from xlmc.outputs.live.hand_over import AtRest
from xlmc.outputs.live.history import History, Moment
from xlmc.outputs.live.jobs import (
    MOVING_TRIALS,
    PARTS,
    RUNS,
    SKETCHED,
    Job,
    Outcome,
    Sight,
    Stage,
    StateRun,
    Tab,
    View,
    Work,
    charts_of,
    scenario_table,
    sketched_tab,
    tab_of,
)
from xlmc.outputs.live.kinds import KINDS
from xlmc.outputs.live.moving_models import KnownModels
from xlmc.outputs.live.pace import Pace
from xlmc.outputs.live.protocol import Message, PageMessage
from xlmc.outputs.live.usual_variants import usual_variants
from xlmc.outputs.live.window_book import (
    Shapes,
    assumption_rows,
    book_message,
    correlation_rows,
    decision_rows,
    filter_rows,
    known_scenario,
    run_row,
    scenario_rows,
    solve_rows,
    stated_rows,
)

if TYPE_CHECKING:
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["MEMORY", "Replies", "Session"]

_SKETCH: Final = 0.05
"""Seconds that what a tab shows may take while states move; what takes longer waits until they are at rest."""

MEMORY: Final = 500
"""Megabytes of runs and draws: more of a run lies in a temporary folder."""

_OF_DRAWS, _OF_A_RUN = 1 / 4, 1 / 10
"""The shares of that for draws that are kept while states move, and for each run at rest: the last one, the one behind
it, the next one, and those of scenarios together. A run that moves, which is to be quick, may take as much as three.
"""

_SCATTERED: Final = 10_000
"""Trials of a run that moves whose scatter and correlation are shown."""

_SKETCHED_DRAWS: Final = 1 << 21
"""Draws of all assumptions together that *What matters* of a run that moves is made of: to keep more takes longer than
the run.
"""

_RunOf = tuple[int, Adjustments, RunOptions]
"""What tells a state from others: which workbook, what was changed, and trials and seed."""
_IN_OWN_STYLE: Final = in_style_of("own.definitions.settings.number_style")
"""What windows are sent has the workbook's signs of thousands and decimals."""

OPENS_WITH: Final = 3
"""Forecasts whose charts are open at first."""


@dataclass(slots=True)
class Replies:
    """Messages for the window that asked, and for all windows."""

    own: list[Message] = field(default_factory=list)
    all: list[Message] = field(default_factory=list)


class Session:
    """The state of all windows on one workbook.

    Args:
        model: the workbook's.
        stored: scenarios by name.
        offered: a state that was not kept under a name when the window was last closed.
        memory: megabytes that its runs and draws may take.
    """

    def __init__(
        self,
        model: CompiledModel,
        stored: Mapping[str, Adjustments] | None = None,
        offered: Adjustments | None = None,
        memory: int = MEMORY,
    ) -> None:
        self.own, self._memory = model, memory
        self.adjustments, self.asked = Adjustments(), RunOptions()
        self.stored: dict[str, Adjustments] = dict(stored or {})
        self.offered = offered or Adjustments()
        self.shown = ""
        self.version = 0
        self.rest: RunResult | None = None
        self.behind: RunResult | None = None
        self.behind_is = "the workbook as it was opened"
        self._behind_of: _RunOf | None = None
        self._answered: _RunOf | None = None
        self.view = View(tuple(each.name for each in model.forecasts[:OPENS_WITH]))
        self._pin_next = True
        self._dragged = False
        self._seq = 0
        self._done: dict[str | Tab, object] = {}
        self._models = self._new_models()
        self._shapes: Shapes = {}
        self._problem: str | None = None
        self._last: dict[str, Message] = {}
        self._pace = Pace(len(model.needed.graph.formulas))
        self._moving: RunResult | None = None
        self._sketch_of: Tab | None = None
        self._sketch_seconds = 0.0
        self._stopped_at = -1
        self._ended = False
        self._stopped: Job | None = None
        self._stopped_tabs: set[Tab] = set()
        self._current: Job | None = None
        self._compare = 0
        self._comparison: Comparison | None = None
        self._failed: set[Stage] = set()
        self._history = History()

    # What windows are sent

    @_IN_OWN_STYLE
    def greeting(self) -> list[Message]:
        """Return all that a window needs that was just opened, or that comes back."""
        return [book_message(self.own), self._state(), *self._last.values(), *self._trouble()]

    def _new_models(self) -> KnownModels:
        return KnownModels(self.own, MOVING_TRIALS, int(_OF_DRAWS * (self._memory << 20)), self.asked.seed)

    @property
    def _of_a_run(self) -> int:
        """Return the bytes of the trials of a run that stay in memory."""
        return int(_OF_A_RUN * (self._memory << 20))

    def _state(self) -> Message:
        return {
            "kind": "state",
            "version": self.version,
            "assumptions": assumption_rows(self.own, self.adjustments),
            "filters": filter_rows(self.own, self.adjustments),
            "forecasts": stated_rows(self.own, self.adjustments),
            "correlations": correlation_rows(self.own, self.adjustments),
            "decisions": decision_rows(self.own, self.adjustments),
            "solves": solve_rows(self.own, self.adjustments),
            "run": run_row(self.own, self.asked),
            "changes": in_words(self.own.definitions, self.adjustments),
            "scenarios": list(scenario_rows(self.own.definitions, self.stored)),
            "shown": self.shown,
            "offered": in_words(self.own.definitions, self.offered),
            "behind": self.behind_is,
            **dict(zip(("undo", "redo"), self._history.goes, strict=True)),
        }

    def _known(self, name: str) -> Adjustments | None:
        return known_scenario(self.own.definitions, self.stored, name)

    def _trouble(self) -> list[Message]:
        return [{"kind": "trouble", "about": "state", "text": self._problem or ""}]

    # What windows say

    @_IN_OWN_STYLE
    def receive(self, sent: PageMessage) -> Replies:
        """Take a message.

        Raises:
            XlmcError: it asks for what there is not, or it has met a fault of xlmc, and is taken back.
        """
        before = self._moment
        try:
            return self._go(sent.kind) if sent.kind in ("undo", "redo") else self._answer(sent, before)
        except XlmcError:
            raise
        except Exception as error:  # a fault of xlmc's own must not end the window
            self._go_to(before)
            raise XlmcError(f"xlmc has failed, and takes this back: {type(error).__name__}: {error}") from error

    def _answer(self, sent: PageMessage, before: Moment) -> Replies:
        """Do what a message asks for, and return what to say; `before` is what there was."""
        changed = self._take(sent)
        dragged = (sent["of"], sent["name"], sent["key"]) if sent.kind == "set" and sent["held"] else None
        if sent.kind not in ("view", "stop", "compare"):
            self._history.note(before, self._moment, dragged)
        if isinstance(changed, Replies):
            return changed
        return Replies(all=[self._state()] if changed else [])

    def _take(self, sent: PageMessage) -> Replies | bool:
        """Do what a message asks for; returns what to say, or whether the state is another one now."""
        match sent.kind:
            case "set":
                return self._set(sent)
            case "numbers":
                return self._set_all(sent)
            case "reset":
                self._change(self.adjustments.without(sent["of"], sent["name"]) if sent["name"] else Adjustments())
                self._ask(self.asked if sent["name"] else RunOptions())
            case "run":
                self._ask(self._asked_of(sent["trials"], sent["seed"]))
            case "view":
                self.look(View.of([sent], [each.name for each in self.own.forecasts]))
                return False
            case "pin":
                self.behind, self._behind_of = self.at_rest().run, self._now
                self.behind_is = "; ".join(in_words(self.own.definitions, self.adjustments)) or "the workbook"
            case "stop":
                self._stop()
                return False
            case "restore":
                adjustments, self.offered = self.offered, Adjustments()
                if sent["take"]:
                    self._dragged = False
                    self._change(adjustments.only(self.own.definitions))
            case "keep":
                self._keep(sent["name"].strip())
            case "show":
                self._show(sent["name"])
            case "compare":
                self._compare += 1
                self._comparison = Comparison(
                    self.own, self.stored, self._pace.piece(resting=True), self._of_a_run, self.asked
                )
                return False
            case "variants":
                self.stored |= usual_variants(self.own.definitions)
            case "drop":
                self.stored.pop(sent["name"], None)
                self.shown = "" if self.shown == sent["name"] else self.shown
        return True

    def _stop(self) -> None:
        """Give up what is going on, and do not begin it again until something changes."""
        self._stopped = self._current
        if self._current is None or self._current.stage in RUNS:
            self._stopped_at = self.version

    @property
    def _moment(self) -> Moment:
        return Moment(self.adjustments, dict(self.stored), self.shown, self.asked)

    def _asked_of(self, trials: int | None, seed: int | None) -> RunOptions:
        """Return what differs of these from the workbook.

        Raises:
            SimulationError: one is out of its range.
        """
        own = self.own.definitions.settings
        asked = RunOptions(trials=None if trials == own.trials else trials, seed=None if seed == own.seed else seed)
        asked.settings(own)  # refuses what is out of range
        return asked

    def _fitting(self, asked: RunOptions) -> RunOptions:
        """Return what still differs from a workbook that may have been saved meanwhile; nothing if it fits no more."""
        try:
            return self._asked_of(asked.trials, asked.seed)
        except XlmcError:  # another sampling method may take other numbers of trials
            return RunOptions()

    def _ask(self, asked: RunOptions) -> None:
        """Run with these from now on."""
        if asked == self.asked:
            return
        self.asked, other_seed = asked, asked.seed != self.asked.seed
        self.version += 1
        if other_seed:
            self._models = self._new_models()

    def _go(self, where: str) -> Replies:
        """Go back to the moment before, or forth again."""

        def fitting(each: Moment) -> Moment:
            adjustments = each.adjustments.only(self.own.definitions)
            return replace(each, adjustments=adjustments, asked=self._fitting(each.asked))

        go = self._history.undo if where == "undo" else self._history.redo
        moment = go(self._moment, fitting)
        if moment is not None:
            self._go_to(moment)
        return Replies(all=[self._state()])

    def _go_to(self, moment: Moment) -> None:
        """Be as at another moment."""
        self.stored, self._dragged = dict(moment.stored), False
        if moment.adjustments != self.adjustments:
            self._change(moment.adjustments)
        self._ask(moment.asked)
        self.shown = moment.shown if moment.shown in self.stored or not moment.shown else ""

    def _set(self, sent: PageMessage) -> Replies | bool:
        of, name, key, value = sent["of"], sent["name"], sent["key"], sent["value"]
        self._adjust(of, name, {key: value}, sent["seq"])
        self._dragged = sent["held"]
        own = own_values(self.own.definitions, of, name, self.adjustments.kind(of, name))
        moved = {"kind": "moved", "of": of, "name": name, "key": key, "value": own[key] if value is None else value}
        return Replies(all=[moved]) if self._dragged else True

    @_IN_OWN_STYLE
    def let_go(self) -> Message:
        """Take it that no handle is dragged any more, as its window is gone; returns the state."""
        self._dragged = False
        return self._state()

    def _set_all(self, sent: PageMessage) -> bool:
        self._adjust(sent["of"], sent["name"], sent["values"], sent["seq"])
        self._dragged = False
        return True

    def _adjust(self, of: str, name: str, values: Mapping[str, Amount | None], seq: int) -> None:
        """Set numbers, switches and a kind; None for the workbook's own."""
        own = own_values(self.own.definitions, of, name, self.adjustments.kind(of, name))
        for key, value in values.items():
            fits = (key in SWITCHES) == isinstance(value, bool) and (value != NONE or key in REMOVABLE)
            fits = fits and (key == "kind") == (value in KINDS) and is_choice(self.own.definitions, of, name, value)
            if key not in own or not (fits or value is None):
                raise XlmcError(f"the workbook has no {of} {name!r} with {key!r} to be set")
        adjustments = self.adjustments
        if "kind" in values:
            kind, values = values["kind"], {}
            adjustments = adjustments.in_kind(name, None if kind == own["kind"] or kind is None else str(kind))
        for key, value in values.items():
            adjustments = adjustments.having(of, name, key, None if value is None or is_own(value, own[key]) else value)
        if of == "filter":
            _refuse_without_limit(adjustments, name, own)
        self._seq = seq
        self._change(adjustments)

    def _change(self, adjustments: Adjustments) -> None:
        self.adjustments = adjustments
        if self.shown and self._known(self.shown) != adjustments:
            self.shown = ""
        self.version += 1

    def _keep(self, name: str) -> None:
        if not name:
            raise XlmcError("a scenario needs a name")
        self.stored[name] = self.adjustments
        self.shown = name

    def _show(self, name: str) -> None:
        adjustments = self._known(name) if name else Adjustments()
        if adjustments is None:
            raise XlmcError(f"there is no scenario {name!r} that can be shown")
        self._dragged = False
        self._change(adjustments)
        self.shown = name

    def adopt(self, stored: Mapping[str, Adjustments]) -> None:
        """Take the scenarios that there are once those that another window kept are among them."""
        self._history.learn({name: each for name, each in stored.items() if name not in self.stored})
        self.stored = dict(stored)

    def replace_book(self, model: CompiledModel, news: Sequence[str]) -> list[Message]:
        """Take the workbook as it was saved meanwhile.

        Args:
            model: of the workbook now.
            news: what changed, in words.
        """
        self.own = model
        before, self.adjustments = self.adjustments, self.adjustments.only(model.definitions)
        if before != self.adjustments and before not in self.stored.values() and not self.offered:
            self.offered = before  # what no longer fits is not lost: it may fit again
        self.version += 1
        self.asked = self._fitting(self.asked)
        self._models = self._new_models()
        self._pace = self._pace.of_saved(len(model.needed.graph.formulas))
        self._moving, self._sketch_seconds = None, 0.0
        self._problem, self._done = None, {}
        self.behind_is = "the workbook before it was saved"
        text = f"{model.workbook.name} was saved: {'; '.join(news) or 'nothing that a run depends on changed'}"
        with in_style(model.definitions.settings.number_style):
            messages = [book_message(model), self._state()]
        return [*messages, {"kind": "news", "text": text, "link": ""}, *self._trouble()]

    def at_rest(self) -> AtRest:
        """Return the state that is shown, with its run.

        Raises:
            XlmcError: the run is not done yet, or not possible.
        """
        if self._is_faulty:
            raise XlmcError(f"This state cannot be run: {self._problem}", hint="Move what it names back, or undo it")
        if self.rest is None or not self._is_at_rest:
            raise XlmcError("the run of this state is not done yet", hint="wait until it is")
        return AtRest(self.own, self.adjustments, self.shown, self.rest, self.asked)

    # What is to be done

    def job(self) -> Job | None:
        """Return what comes next; None if all is done."""
        self._current = self._run() or self._shown() or self._of_scenarios() or self._part()
        return self._current

    def _run(self) -> Job | None:
        """Return a run of the state, or what is shown of it while it moves."""
        version = self.version
        if self._is_faulty or self._stopped_at == version:
            return None
        for stage in RUNS:
            if self._wants(stage):
                done: dict[str | Tab, object] = {stage: version}
                if stage == "rest":
                    done["shown"] = self._sight
                return Job(stage, version, self._dragged, self._work(stage), done)
        return None

    def _shown(self) -> Job | None:
        """Return the charts of a run at rest for what can be seen now."""
        if self.rest is None or not self._is_at_rest or self._done.get("shown") == self._sight:
            return None
        work = charts_of(self.rest, self._compared, self._seq, self._sight)
        return Job("shown", self.version, self._dragged, work, {"shown": self._sight})

    def _of_scenarios(self) -> Job | None:
        if self._comparison is None or self._done.get("compare", 0) == self._compare:
            return None
        work = scenario_table(self._comparison, self._compare)
        return Job("compare", self.version, self._dragged, work, {"compare": self._compare})

    def _part(self) -> Job | None:
        """Return the contents of an open tab."""
        if self.rest is None or not self._is_at_rest:
            return None
        for tab in self.view.tabs:
            if tab.key in PARTS and self._done.get(tab) != self.version:
                work = tab_of(self.rest, self.version, tab)
                return Job("part", self.version, self._dragged, work, {tab: self.version})
        return None

    def look(self, view: View) -> None:
        """Take what can be seen now; a tab that was stopped and closed is made when it is opened again."""
        for tab in self._stopped_tabs - set(view.tabs):
            self._stopped_tabs.discard(tab)
            self._done.pop(tab, None)
        sketched = _sketched(view)
        if sketched is not None and sketched != self._sketch_of:
            self._sketch_of, self._sketch_seconds = sketched, 0.0
        self.view = view

    @property
    def _now(self) -> _RunOf:
        """Return what tells a state from others: the workbook, what was changed, and how it is run."""
        return id(self.own), self.adjustments, self.asked

    @property
    def _drawn(self) -> _RunOf:
        """Return what the trials that move depend on: all but how answers are stated, and how long runs at rest are."""
        return id(self.own), replace(self.adjustments, forecasts={}), RunOptions(seed=self.asked.seed)

    @property
    def _compared(self) -> RunResult | None:
        """Return the state to be drawn behind; None if it is the one in front."""
        return None if self._behind_of == self._now else self.behind

    @property
    def _sight(self) -> Sight:
        """Return what the charts at rest depend on."""
        return self.version, self.view.forecasts, self.view.fits, id(self._compared)

    def _wants(self, stage: str) -> bool:
        if self._done.get(stage) == self.version or (stage in ("quick", "moving") and self._drawn == self._answered):
            return False
        if stage == "sketch":
            return (
                _sketched(self.view) is not None
                and self._moving is not None
                and self._sketch_seconds < _SKETCH
                and not self._is_at_rest
                and not self.adjustments.decisions  # which would be told as assumptions
            )
        if stage == "quick":
            return self._pace.is_slow and self.version not in (self._done.get("moving"), self._done.get("rest"))
        return stage == "rest" or self._done.get("rest") != self.version

    @property
    def _is_at_rest(self) -> bool:
        return self.rest is not None and self._done.get("rest") == self.version

    @property
    def unkept(self) -> Adjustments:
        """Return what would be lost with the windows: the state now, unless a scenario holds it, or what is offered."""
        if self.adjustments and self.adjustments not in self.stored.values():
            return self.adjustments
        return self.offered

    @property
    def _is_faulty(self) -> bool:
        """Return whether the state was tried and is not possible."""
        return self._problem is not None and self._done.get("tried") == self.version

    def _work(self, stage: Stage) -> Work:
        """Return what a stage before the run at rest, or that run itself, has to do."""
        if stage == "sketch":
            tab = _sketched(self.view)
            assert self._moving is not None
            assert tab is not None
            return sketched_tab(self._moving, self.version, tab, 2.0 * _SKETCH)
        resting, pace = stage == "rest", self._pace
        return StateRun(
            stage=stage,
            version=self.version,
            seq=self._seq,
            adjustments=self.adjustments,
            models=self._models,
            shapes=self._shapes,
            view=self.view,
            behind=self._compared,
            method="rejection" if self.rest is None else self.rest.settings.evidence,
            trials=pace.quick_trials if stage == "quick" else MOVING_TRIALS,
            piece=pace.piece(resting=resting),
            in_memory=self._of_a_run if resting else 3 * self._of_a_run,
            watched=resting or (pace.is_slow and stage == "moving"),
            draws=self._draws_shown(stage),
            asked=self.asked,
        ).run

    def _draws_shown(self, stage: Stage) -> int:
        """Return of how many trials draws are shown: many in *What matters* if there is time, few in a scatter of an
        assumption.
        """
        if _sketched(self.view) is not None and stage == "moving" and self._sketch_seconds < _SKETCH:
            return _SKETCHED_DRAWS // max(len(self.own.draws), 1)
        pairs = {name for tab in self.view.tabs if tab.key == "pairs" for name in (tab.first, tab.second)}
        return 0 if pairs.isdisjoint(self.own.draws) else _SCATTERED

    @_IN_OWN_STYLE
    def finish(self, job: Job, outcome: Outcome) -> list[Message]:
        """Take what a job found; returns what windows are sent of it."""
        if job.stage == "sketch" or job.stage not in RUNS:
            return self._finish_shown(job, outcome)
        if outcome.problem is not None:
            if job.version != self.version:
                return []
            self._problem = outcome.problem
            self._done["tried"] = job.version
            return self._trouble()
        over: list[Message] = []
        if self._problem is not None and job.version == self.version:
            self._problem = None
            over = self._trouble()
        self._done |= job.done
        if outcome.seconds is not None:
            self._pace.learn(outcome.seconds, resting=job.stage == "rest", quick=job.stage == "quick")
        result = list(outcome.messages)
        if job.stage != "quick" and job.version == self.version:
            self._answered = self._drawn
        self._moving = outcome.simulation if job.stage == "moving" and job.version == self.version else None
        if job.stage == "rest" and job.version == self.version:
            self.rest = outcome.simulation
            if not self._pace.is_slow:
                self._sketch_seconds = 0.0
            if self._pin_next and not self.adjustments and outcome.simulation is not None:
                self.behind, self._behind_of, self._pin_next = outcome.simulation, self._now, False
        self._remember(result)
        return [*over, *result]

    def _finish_shown(self, job: Job, outcome: Outcome) -> list[Message]:
        """Take what a job found that shows more of a run; one that failed is not tried again for the same."""
        self._done |= job.done
        if job.stage == "sketch":
            self._sketch_seconds = outcome.seconds or 0.0
        self._remember(outcome.messages)
        messages = list(outcome.messages)
        if outcome.problem is not None or job.stage in self._failed:
            messages.append({"kind": "trouble", "about": job.stage, "text": outcome.problem or ""})
        if outcome.problem is None:
            self._failed.discard(job.stage)
        else:
            self._failed.add(job.stage)
            if job.stage == "compare":
                self._done["compare"] = self._compare
                messages.append(_over(job, "stopped"))
        return messages

    @_IN_OWN_STYLE
    def superseded(self, job: Job) -> list[Message]:
        """Note that a job was given up: something newer is wanted, or a person stopped it."""
        if job.stage == "sketch":
            self._sketch_seconds = math.inf  # until other answers are chosen, or a quick state is at rest
            return []
        stopped = job is self._stopped
        if stopped and job.stage not in RUNS:
            self._done |= job.done
            self._stopped_tabs |= {key for key in job.done if isinstance(key, Tab)}
        return [_over(job, "stopped" if stopped else "over")]

    def wanted(self, job: Job) -> bool:
        """Return whether a job's outcome is still wanted: of the newest state, and of what is open."""
        is_open = all(key in self.view.tabs for key in job.done if isinstance(key, Tab))
        asked = job.done.get("compare", self._compare) == self._compare
        return not self._ended and job.version == self.version and is_open and asked and self._stopped is not job

    def end(self) -> None:
        """Want nothing any more."""
        self._ended = True

    def _remember(self, messages: Sequence[Message]) -> None:
        for each in messages:
            if each["kind"] in ("frame", "rest", "part"):
                self._last[f"{each['kind']} {each.get('tab', '')}"] = each


def _sketched(view: View) -> Tab | None:
    """Return the open tab that is brought up to date while states move."""
    return next((tab for tab in view.tabs if tab.key == SKETCHED), None)


def _refuse_without_limit(adjustments: Adjustments, name: str, own: Mapping[str, object]) -> None:
    """Refuse to take the last limit of a filter away: its cell would have to be TRUE then.

    Raises:
        XlmcError: none is left.
    """
    limits, given = LIMITS.keys() & own.keys(), adjustments.filters.get(name, {})
    if limits and all(given.get(key) == NONE for key in limits):
        raise XlmcError(f"{name!r} would have no limit", hint="Switch Use off to leave the filter out")


def _over(job: Job, how: str) -> Message:
    return {"kind": "running", "version": job.version, "stage": how, "share": 1.0}
