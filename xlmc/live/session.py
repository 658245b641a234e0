"""What the window of one workbook knows, and what it does next: no sockets, files, threads or clocks.

A session takes messages and gives messages. What takes time it gives as a `Job`, which depends on nothing that changes
later: somebody runs it, wherever he likes, and hands the outcome back. While a handle is held, jobs are runs of
`MOVING_TRIALS` trials by Monte Carlo; as soon as nothing is newer, the run of the workbook's own settings follows,
whose numbers are those of `xlmc simulate` to the last bit, and then what the open tab shows. All runs have the same
seed, and assumptions streams of their own: what is not moved is drawn as before, so that the picture stands still.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final, Literal

from xlmc.errors import XlmcError
from xlmc.live.adjustments import (
    Adjustments,
    adjustments_of,
    in_words,
    own_values,
    scenario_of,
    usual_variants,
)
from xlmc.live.frames import bases_of, frame_of, matters_html, pair_of, rest_of, scenarios_html, tables_html
from xlmc.live.hand_over import AtRest
from xlmc.live.moving_models import MANY_FORMULAS, KnownModels
from xlmc.live.protocol import Message, Said
from xlmc.live.window_book import assumption_rows, filter_rows, forecast_rows, shapes_of
from xlmc.report.page.element import element, join
from xlmc.report.page.payload import CONFIDENCE
from xlmc.results.record.in_words import changes_text
from xlmc.run.simulate import BLOCK, simulate
from xlmc.statistics.estimate import t_quantile

if TYPE_CHECKING:
    from xlmc.run.model import Model
    from xlmc.run.simulation import Simulation
    from xlmc.run.stopping import Progress

__all__ = ["MOVING_TRIALS", "Job", "Outcome", "Replies", "Session", "SupersededError"]

MOVING_TRIALS: Final = 50_000
"""Of a run while a handle moves."""

_QUICK_TRIALS, _FEWEST_TRIALS = 2_000, 200
"""Of the first short run, as long as nothing is known of its time, and of any."""

_SLOW: Final = 0.2
"""Seconds that a run of `MOVING_TRIALS` may take; one that takes longer has a shorter one before it."""

_QUICK: Final = 0.03
"""Seconds that a short run may take."""

_PIECE: Final = 0.4
"""Seconds after which a longer run looks whether something newer is wanted."""

_SMALLEST_PIECE: Final = 4_096
"""Of trials: with fewer, what does not depend on their number would take most of the time."""

Sight = tuple[int, tuple[str, ...], bool, int]
"""Version, forecasts, whether with fits, and what is behind."""

_SKETCH: Final = 0.15
"""Seconds that what a tab shows may take while states move; what takes longer waits until they are at rest."""

Stage = Literal["quick", "moving", "sketch", "rest", "shown", "part", "compare"]

OPENS_WITH: Final = 3
"""Forecasts whose charts are open at first."""


_PARTS: Final[Mapping[str, Callable[[Simulation, Tab], Message]]] = {
    "matters": lambda run, _: {"html": matters_html(run)},
    "tables": lambda run, _: {"html": tables_html(run)},
    "pairs": lambda run, tab: {"pair": pair_of(run, tab.first, tab.second)},
}
"""Tab whose contents are made of a run at rest -> what makes them."""

_SKETCHED: Final = "matters"
"""The tab that is brought up to date while a state moves, too."""


class SupersededError(Exception):
    """Something newer was asked for, or the run was stopped."""


@dataclass(slots=True)
class Replies:
    """Messages for the window that asked, and for all windows."""

    own: list[Message] = field(default_factory=list)
    all: list[Message] = field(default_factory=list)


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
        """Of what each window said that it shows, the forecasts in the order of the workbook."""
        views = list(said)
        seen = {name for each in views for name in each["forecasts"]}
        tabs = dict.fromkeys(Tab(each["tab"], each["first"], each["second"]) for each in views)
        return cls(tuple(name for name in order if name in seen), tuple(tabs), any(each["fits"] for each in views))


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a job found.

    Attributes:
        seconds: for a trial, roughly; None where nothing was run.
        problem: why the state cannot be run; None where it can.
        done: what a job that runs nothing was about.
    """

    messages: tuple[Message, ...] = ()
    simulation: Simulation | None = None
    seconds: float | None = None
    problem: str | None = None
    done: object = None


@dataclass(frozen=True, slots=True)
class Job:
    """A piece of work that a session asks for.

    Attributes:
        stage: which.
        version: of the state that it is of.
        held: whether a handle is held: there is hurry then, and more to come.
        run: does it; it is given a function that says whether it is still wanted, one that takes the share done, and a
            clock. It raises `SupersededError` where it is not wanted any more.
    """

    stage: Stage
    version: int
    held: bool
    run: Callable[[Callable[[], bool], Callable[[float], None], Callable[[], float]], Outcome]


class Session:
    """The state of all windows on one workbook.

    Args:
        model: the workbook's.
        kept: scenarios by name.
        offered: a state that was not kept under a name when the window was last closed.
    """

    def __init__(
        self, model: Model, kept: Mapping[str, Adjustments] | None = None, offered: Adjustments | None = None
    ) -> None:
        self.own = model
        self.adjustments = Adjustments()
        self.kept: dict[str, Adjustments] = dict(kept or {})
        self.offered = (offered or Adjustments()).only(model.definitions)
        self.shown = ""
        self.version = 0
        self.rest: Simulation | None = None
        self.behind: Simulation | None = None
        self.behind_is = "the workbook as it was opened"
        self._behind_of: tuple[int, Adjustments] | None = None
        self.view = View(tuple(each.name for each in model.forecasts[:OPENS_WITH]))
        self._pin_next = True
        self._held = False
        self._seq = 0
        self._done: dict[str, object] = {}
        self._models = KnownModels(model, MOVING_TRIALS)
        self._problem: str | None = None
        self._last: dict[str, Message] = {}
        self._seconds: dict[bool, float] = {}
        self._moving: Simulation | None = None
        self._sketch_seconds = 0.0
        self._stopped_at = -1
        self._ended = False
        self._compare = 0

    # What windows are told

    def greeting(self) -> list[Message]:
        """All that a window needs that was just opened, or that comes back."""
        return [self._book(), self._state(), *self._last.values(), *self._trouble()]

    def _book(self) -> Message:
        model = self.own
        return {
            "kind": "book",
            "name": model.workbook.name,
            "folder": str(model.path.parent),
            "forecasts": forecast_rows(model),
            "notices": [str(each) for each in model.notices],
            "settings": _settings_text(model),
            "shapes": shapes_of(model),
            "z": t_quantile(math.inf, CONFIDENCE),
        }

    def _state(self) -> Message:
        return {
            "kind": "state",
            "version": self.version,
            "assumptions": assumption_rows(self.own, self.adjustments),
            "filters": filter_rows(self.own, self.adjustments),
            "changes": in_words(self.own.definitions, self.adjustments),
            "scenarios": list(self._scenarios()),
            "shown": self.shown,
            "offered": in_words(self.own.definitions, self.offered),
            "behind": self.behind_is,
        }

    def _scenarios(self) -> Iterator[Message]:
        """Those of the workbook, then those that are kept here, which take the place of one of the same name."""
        definitions = self.own.definitions
        for scenario in definitions.scenarios:
            if scenario.name not in self.kept:
                shows = adjustments_of(definitions, scenario) is not None
                yield {"name": scenario.name, "changes": [changes_text(scenario)], "own": True, "shows": shows}
        for name, each in self.kept.items():
            yield {"name": name, "changes": in_words(definitions, each), "own": False, "shows": True}

    def _known(self, name: str) -> Adjustments | None:
        """A scenario by name; None where there is none, or none that can be shown."""
        if name in self.kept:
            return self.kept[name].only(self.own.definitions)
        definitions = self.own.definitions
        found = next((each for each in definitions.scenarios if each.name == name), None)
        return None if found is None else adjustments_of(definitions, found)

    def _trouble(self) -> list[Message]:
        return [{"kind": "trouble", "about": "state", "text": self._problem or ""}]

    # What windows say

    def receive(self, said: Said) -> Replies:
        """Take a message.

        Raises:
            XlmcError: it asks for what there is not.
        """
        match said.kind:
            case "set":
                return self._set(said)
            case "reset":
                self._change(self.adjustments.without(said["of"], said["name"]) if said["name"] else Adjustments())
                return Replies(all=[self._state()])
            case "view":
                self.look(View.of([said], [each.name for each in self.own.forecasts]))
            case "pin":
                self.behind, self._behind_of = self.at_rest().run, self._now
                self.behind_is = "; ".join(in_words(self.own.definitions, self.adjustments)) or "the workbook"
                return Replies(all=[self._state()])
            case "stop":
                self._stopped_at = self.version
            case "restore":
                found, self.offered = self.offered, Adjustments()
                if said["take"]:
                    self._held = False
                    self._change(found)
                return Replies(all=[self._state()])
            case "keep":
                return self._keep(said["name"].strip())
            case "show":
                return self._show(said["name"])
            case "compare":
                self._compare += 1
            case "variants":
                self.kept |= usual_variants(self.own.definitions)
                return Replies(all=[self._state()])
            case "drop":
                self.kept.pop(said["name"], None)
                self.shown = "" if self.shown == said["name"] else self.shown
                return Replies(all=[self._state()])
        return Replies()

    def _set(self, said: Said) -> Replies:
        of, name, key, value = said["of"], said["name"], said["key"], said["value"]
        own = own_values(self.own.definitions, of, name)
        if key not in own or ((key == "frozen") != isinstance(value, bool) and value is not None):
            raise XlmcError(f"the workbook has no {of} {name!r} with {key!r} to be set")
        self._held, self._seq = said["held"], said["seq"]
        self._change(self.adjustments.having(of, name, key, None if value == own[key] else value))
        moved = {"kind": "moved", "of": of, "name": name, "key": key, "value": own[key] if value is None else value}
        return Replies(all=[moved if self._held else self._state()])

    def _change(self, adjustments: Adjustments) -> None:
        self.adjustments = adjustments
        if self.shown and self._known(self.shown) != adjustments:
            self.shown = ""
        self.version += 1

    def _keep(self, name: str) -> Replies:
        if not name:
            raise XlmcError("a scenario needs a name")
        self.kept[name] = self.adjustments
        self.shown = name
        return Replies(all=[self._state()])

    def _show(self, name: str) -> Replies:
        found = self._known(name) if name else Adjustments()
        if found is None:
            raise XlmcError(f"there is no scenario {name!r} that can be shown")
        self._held = False
        self._change(found)
        self.shown = name
        return Replies(all=[self._state()])

    def replace_book(self, model: Model, news: Sequence[str]) -> list[Message]:
        """Take the workbook as it was saved meanwhile.

        Args:
            model: of the workbook now.
            news: what changed, in words.
        """
        self.own = model
        self.adjustments = self.adjustments.only(model.definitions)
        self.version += 1
        self._models, self._seconds = KnownModels(model, MOVING_TRIALS), {}
        self._moving, self._sketch_seconds = None, 0.0
        self._problem, self._done = None, {}
        self.behind_is = "the workbook before it was saved"
        text = f"{model.workbook.name} was saved: {'; '.join(news) or 'nothing that a run depends on changed'}"
        return [self._book(), self._state(), {"kind": "news", "text": text, "link": ""}, *self._trouble()]

    def at_rest(self) -> AtRest:
        """The state that is shown, with its run.

        Raises:
            XlmcError: the run is not done yet.
        """
        if self.rest is None or not self._is_at_rest:
            raise XlmcError("the run of this state is not done yet", hint="wait until it is")
        return AtRest(self.own, self.adjustments, self.shown, self.rest)

    # What is to be done

    def job(self) -> Job | None:
        """What comes next; None where all is done."""
        version, stopped = self.version, self._stopped_at == self.version
        if self._done.get("compare", 0) != self._compare:
            return Job("compare", version, False, self._comparing())
        if self._problem is not None and self._done.get("tried") == version:
            return None
        if not stopped:
            for stage in ("quick", "moving", "sketch", "rest"):
                if self._wants(stage):
                    run = self._sketch() if stage == "sketch" else self._runner(stage)
                    return Job(stage, version, self._held, run)
        if self.rest is not None and self._done.get("rest") == version:
            if self._done.get("shown") != self._sight:
                return Job("shown", version, self._held, self._shown(self.rest, self._sight))
            tab = next(
                (each for each in self.view.tabs if each.key in _PARTS and self._shown_part(each) != version), None
            )
            if tab is not None:
                return Job("part", version, self._held, self._part(self.rest, tab))
        return None

    def look(self, view: View) -> None:
        """Take what can be seen now."""
        self.view = view

    def _shown_part(self, tab: Tab) -> object:
        """The version that the contents of a tab are of."""
        return self._done.get(f"{tab.key} {tab.first} {tab.second}")

    @property
    def _now(self) -> tuple[int, Adjustments]:
        """What tells a state from others: the workbook, and what was changed."""
        return id(self.own), self.adjustments

    @property
    def _compared(self) -> Simulation | None:
        """The state to be drawn behind; None where it is the one in front."""
        return None if self._behind_of == self._now else self.behind

    @property
    def _sight(self) -> Sight:
        """What the charts at rest depend on."""
        return self.version, self.view.forecasts, self.view.fits, id(self._compared)

    def _wants(self, stage: str) -> bool:
        if self._done.get(stage) == self.version:
            return False
        if stage == "sketch":
            shown = any(tab.key == _SKETCHED for tab in self.view.tabs)
            return shown and self._moving is not None and self._sketch_seconds < _SKETCH and not self._is_at_rest
        if stage == "quick":
            return self._is_slow and self.version not in (self._done.get("moving"), self._done.get("rest"))
        return stage == "rest" or self._done.get("rest") != self.version

    @property
    def _is_at_rest(self) -> bool:
        return self.rest is not None and self._done.get("rest") == self.version

    @property
    def unkept(self) -> Adjustments:
        """What would be lost with the windows: the state now, unless a scenario holds it, or what is still offered."""
        if self.adjustments and self.adjustments not in self.kept.values():
            return self.adjustments
        return self.offered

    @property
    def _is_slow(self) -> bool:
        """Whether a run of `MOVING_TRIALS` takes long; before the first run, whether it looks so."""
        if False not in self._seconds:
            return len(self.own.needed.graph.formulas) > MANY_FORMULAS
        return self._seconds[False] * MOVING_TRIALS > _SLOW

    def _trials_in(self, seconds: float, *, resting: bool) -> int:
        """How many trials take so long, a power of two; of a run at rest, or of one that moves."""
        known = self._seconds.get(resting, self._seconds.get(False))
        return _QUICK_TRIALS if not known else 1 << max(_FEWEST_TRIALS, int(seconds / known)).bit_length() - 1

    def _runner(self, stage: Stage) -> Callable[..., Outcome]:
        version, adjustments, models, view = self.version, self.adjustments, self._models, self.view
        behind, seq = self._compared, self._seq
        way = "rejection" if self.rest is None else self.rest.settings.evidence
        resting, slow = stage == "rest", self._is_slow
        trials = self._trials_in(_QUICK, resting=False) if stage == "quick" else MOVING_TRIALS
        piece = max(_SMALLEST_PIECE, self._trials_in(_PIECE, resting=resting)) if slow else MOVING_TRIALS

        def run(wanted: Callable[[], bool], tell: Callable[[float], None], clock: Callable[[], float]) -> Outcome:
            def watch(progress: Progress) -> None:
                if not wanted():
                    raise SupersededError
                tell(progress.share)

            try:
                if resting:
                    model = models.at_rest(adjustments)
                    begun = clock()
                    found = simulate(model, progress=watch, pieces=piece if slow else BLOCK, evidence=None)
                    base = bases_of(found)
                else:
                    moving = models.moving(adjustments)
                    model, base = moving.model, moving.base
                    runner = moving.runner(-(-trials // -(-trials // min(piece, moving.kept.largest_block))))
                    begun = clock()
                    watched = slow and stage == "moving"  # one that is quick ends sooner than the next move comes
                    found = simulate(
                        model,
                        trials=trials,
                        sampling="mc",
                        engine=moving.kept.engine,
                        evidence=way or "rejection",
                        own_runner=None if way == "weights" else runner,  # it computes other filters
                        progress=watch if watched else None,
                    )
                seconds = (clock() - begun) / max(found.evaluated, 1)
                frame = frame_of(found, behind, view.forecasts, base, moving=not resting, fits=resting and view.fits)
                messages = [_frame("rest" if resting else "moving", version, seq, frame)]
                messages += [_pairs(found, version, tab) for tab in view.tabs if tab.key == "pairs" and not resting]
                messages[0]["shapes"] = shapes_of(model, list(adjustments.assumptions))
                if resting:
                    messages.append({"kind": "rest", "version": version, **rest_of(found)})
            except XlmcError as error:
                return Outcome(problem=str(error))
            done = (version, view.forecasts, view.fits, id(behind))
            return Outcome(tuple(messages), found, seconds, done=done)

        return run

    def _shown(self, simulation: Simulation, sight: Sight) -> Callable[..., Outcome]:
        """The charts of a run that is done, for what can be seen now."""
        behind, seq, names = self._compared, self._seq, self.view.forecasts

        def run(*_: object) -> Outcome:
            frame = frame_of(simulation, behind, names, bases_of(simulation), moving=False, fits=sight[2])
            return Outcome((_frame("rest", sight[0], seq, frame),), done=sight)

        return run

    def _sketch(self) -> Callable[..., Outcome]:
        """What matters, of the run of a state that moves."""
        simulation, version = self._moving, self.version
        assert simulation is not None

        def run(_wanted: object, _tell: object, clock: Callable[[], float]) -> Outcome:
            begun = clock()
            found = _PARTS[_SKETCHED](simulation, Tab(_SKETCHED))
            message = {"kind": "part", "tab": _SKETCHED, "version": version, **found}
            return Outcome((message,), seconds=clock() - begun)

        return run

    def _part(self, simulation: Simulation, tab: Tab) -> Callable[..., Outcome]:
        """The contents of an open tab."""
        version = self.version

        def run(*_: object) -> Outcome:
            found = _PARTS[tab.key](simulation, tab)
            return Outcome(({"kind": "part", "tab": tab.key, "version": version, **found},), done=(tab, version))

        return run

    def _comparing(self) -> Callable[..., Outcome]:
        """All scenarios in one table, those of the workbook and those that are kept here."""
        own, asked = self.own, self._compare
        scenarios = tuple(scenario_of(own.definitions, name, each) for name, each in self.kept.items())

        def run(wanted: Callable[[], bool], tell: Callable[[float], None], clock: Callable[[], float]) -> Outcome:
            known = [each for each in own.definitions.scenarios if each.name not in self.kept]
            all_of_them = (*known, *scenarios)
            model = own.changed(own.workbook, replace(own.definitions, scenarios=all_of_them))
            begun: list[str] = []

            def told(name: str) -> None:
                if not wanted():
                    raise SupersededError
                begun.append(name)
                tell(len(begun) / (len(all_of_them) + 1))

            try:
                html = scenarios_html(model, lambda model: simulate(model, scenarios=True, evidence=None), told)
            except XlmcError as error:
                html = join([element("p", str(error), class_="warning")]).source
            message = {"kind": "part", "tab": "scenarios", "version": asked, "html": html}
            return Outcome((message,), done=asked)

        return run

    def finish(self, job: Job, outcome: Outcome) -> list[Message]:
        """Take what a job found; what windows are told of it."""
        if job.stage == "compare":
            self._done["compare"] = self._compare if outcome.done is None else outcome.done
            self._remember(outcome.messages)
            return list(outcome.messages)
        if job.stage == "sketch":
            self._done["sketch"], self._sketch_seconds = job.version, outcome.seconds or 0.0
            self._remember(outcome.messages)
            return list(outcome.messages)
        if job.stage in ("shown", "part"):
            if isinstance(outcome.done, tuple) and isinstance(outcome.done[0], Tab):
                tab, version = outcome.done
                self._done[f"{tab.key} {tab.first} {tab.second}"] = version
            else:
                self._done["shown"] = outcome.done
            self._remember(outcome.messages)
            return list(outcome.messages)
        if outcome.problem is not None:
            if job.version != self.version:
                return []
            self._problem = outcome.problem
            self._done["tried"] = job.version
            return self._trouble()
        over = self._trouble() if self._problem is not None and job.version == self.version else []
        if over:
            self._problem = None
            over = self._trouble()
        self._done[job.stage] = job.version
        if outcome.seconds is not None and (job.stage != "quick" or not self._seconds):
            resting = job.stage == "rest"
            before = self._seconds.get(resting, outcome.seconds)
            self._seconds[resting] = min(outcome.seconds, 2.0 * before)  # other work on the machine only ever slows
        found = list(outcome.messages)
        self._moving = outcome.simulation if job.stage == "moving" and job.version == self.version else None
        if job.stage == "rest" and job.version == self.version:
            self.rest, self._done["shown"] = outcome.simulation, outcome.done
            if self._pin_next and not self.adjustments and outcome.simulation is not None:
                self.behind, self._behind_of, self._pin_next = outcome.simulation, self._now, False
        self._remember(found)
        return [*over, *found]

    def superseded(self, job: Job) -> list[Message]:
        """A job was given up: something newer is wanted, or a person stopped it."""
        if job.stage == "compare":
            self._done["compare"] = self._compare
        return [{"kind": "running", "version": job.version, "stage": "stopped", "share": 1.0}]

    def wanted(self, job: Job) -> bool:
        """Whether a job's outcome is still wanted."""
        newest = job.version == self.version or job.stage == "compare"
        return not self._ended and newest and self._stopped_at != job.version

    def end(self) -> None:
        """Want nothing any more."""
        self._ended = True

    def _remember(self, messages: Sequence[Message]) -> None:
        for each in messages:
            if each["kind"] in ("frame", "rest", "part"):
                self._last[f"{each['kind']} {each.get('tab', '')}"] = each


def _frame(stage: str, version: int, seq: int, charts: Message) -> Message:
    return {"kind": "frame", "stage": stage, "version": version, "seq": seq, **charts}


def _pairs(simulation: Simulation, version: int, tab: Tab) -> Message:
    return {"kind": "part", "tab": "pairs", "version": version, **_PARTS["pairs"](simulation, tab)}


def _settings_text(model: Model) -> str:
    """`200,000 trials, Monte Carlo, seed 999`."""
    from xlmc.sampling.sampling_methods import METHODS

    settings = model.definitions.settings
    return f"{settings.trials:,} trials, {METHODS[settings.sampling].name}, seed {settings.seed}"
