"""What the window of one workbook knows, and what it does next: no sockets, files, threads or clocks.

A session takes messages and gives messages. What takes time it gives as a `Job`, which depends on nothing that changes
later: somebody runs it, wherever he likes, and hands the outcome back. While a handle is held, jobs are runs of
`MOVING_TRIALS` trials by Monte Carlo; as soon as nothing is newer, the run of the workbook's own settings follows,
whose numbers are those of `xlmc simulate` to the last bit, and then what the open tab shows. All runs have the same
seed, and assumptions streams of their own: what is not moved is drawn as before, so that the picture stands still.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.statements.in_words import changes_text
from xlmc.errors import XlmcError
from xlmc.montecarlo.simulation.simulate import BLOCK
from xlmc.montecarlo.statistics.estimate import t_quantile
from xlmc.outputs.live.adjustments import (
    Adjustments,
    adjustments_of,
    in_words,
    own_values,
    usual_variants,
)
from xlmc.outputs.live.hand_over import AtRest
from xlmc.outputs.live.jobs import (
    MOVING_TRIALS,
    PARTS,
    SKETCHED,
    Job,
    Outcome,
    Sight,
    Stage,
    StateRun,
    View,
    Work,
    charts_of,
    scenario_table,
    sketched_tab,
    tab_of,
)
from xlmc.outputs.live.moving_models import MANY_FORMULAS, KnownModels
from xlmc.outputs.live.protocol import Message, Said
from xlmc.outputs.live.window_book import assumption_rows, filter_rows, forecast_rows, shapes_of
from xlmc.outputs.page.payload import CONFIDENCE

if TYPE_CHECKING:
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["Replies", "Session"]

_QUICK_TRIALS, _FEWEST_TRIALS = 2_000, 200
"""Trials of the first short run, before its time is known, and the fewest of any."""

_SLOW: Final = 0.2
"""Seconds that a run of `MOVING_TRIALS` may take; one that takes longer has a shorter one before it."""

_QUICK: Final = 0.03
"""Seconds that a short run may take."""

_PIECE: Final = 0.4
"""Seconds after which a longer run looks whether something newer is wanted."""

_SMALLEST_PIECE: Final = 4_096
"""Trials: with fewer, most of the time would go into what does not depend on their number."""

_SKETCH: Final = 0.15
"""Seconds that what a tab shows may take while states move; what takes longer waits until they are at rest."""

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
        kept: scenarios by name.
        offered: a state that was not kept under a name when the window was last closed.
    """

    def __init__(
        self, model: CompiledModel, kept: Mapping[str, Adjustments] | None = None, offered: Adjustments | None = None
    ) -> None:
        self.own = model
        self.adjustments = Adjustments()
        self.kept: dict[str, Adjustments] = dict(kept or {})
        self.offered = offered or Adjustments()
        self.shown = ""
        self.version = 0
        self.rest: RunResult | None = None
        self.behind: RunResult | None = None
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
        self._moving: RunResult | None = None
        self._sketch_seconds = 0.0
        self._stopped_at = -1
        self._ended = False
        self._compare = 0
        self._failed: set[Stage] = set()

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
        """The scenarios of the workbook, then those kept here, which replace one of the same name."""
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
                    self._change(found.only(self.own.definitions))
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

    def replace_book(self, model: CompiledModel, news: Sequence[str]) -> list[Message]:
        """Take the workbook as it was saved meanwhile.

        Args:
            model: of the workbook now.
            news: what changed, in words.
        """
        self.own = model
        before, self.adjustments = self.adjustments, self.adjustments.only(model.definitions)
        if before != self.adjustments and before not in self.kept.values() and not self.offered:
            self.offered = before  # what no longer fits is not lost: it may fit again
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
            work = scenario_table(self.own, dict(self.kept), self._compare)
            return Job("compare", version, False, work, {"compare": self._compare})
        if self._problem is not None and self._done.get("tried") == version:
            return None
        if not stopped:
            for stage in ("quick", "moving", "sketch", "rest"):
                if self._wants(stage):
                    done = {"rest": version, "shown": self._sight} if stage == "rest" else {stage: version}
                    return Job(stage, version, self._held, self._work(stage), done)
        if self.rest is not None and self._done.get("rest") == version:
            if self._done.get("shown") != self._sight:
                work = charts_of(self.rest, self._compared, self._seq, self._sight)
                return Job("shown", version, self._held, work, {"shown": self._sight})
            for tab in self.view.tabs:
                key = f"{tab.key} {tab.first} {tab.second}"
                if tab.key in PARTS and self._done.get(key) != version:
                    return Job("part", version, self._held, tab_of(self.rest, version, tab), {key: version})
        return None

    def look(self, view: View) -> None:
        """Take what can be seen now."""
        self.view = view

    @property
    def _now(self) -> tuple[int, Adjustments]:
        """What tells a state from others: the workbook, and what was changed."""
        return id(self.own), self.adjustments

    @property
    def _compared(self) -> RunResult | None:
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
            shown = any(tab.key == SKETCHED for tab in self.view.tabs)
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

    def _work(self, stage: Stage) -> Work:
        """What a stage before the run at rest, or that run itself, has to do."""
        if stage == "sketch":
            assert self._moving is not None
            return sketched_tab(self._moving, self.version)
        resting, slow = stage == "rest", self._is_slow
        whole = BLOCK if resting else MOVING_TRIALS
        return StateRun(
            stage=stage,
            version=self.version,
            seq=self._seq,
            adjustments=self.adjustments,
            models=self._models,
            view=self.view,
            behind=self._compared,
            way="rejection" if self.rest is None else self.rest.settings.evidence,
            trials=self._trials_in(_QUICK, resting=False) if stage == "quick" else MOVING_TRIALS,
            piece=max(_SMALLEST_PIECE, self._trials_in(_PIECE, resting=resting)) if slow else whole,
            watched=resting or (slow and stage == "moving"),
        ).run

    def finish(self, job: Job, outcome: Outcome) -> list[Message]:
        """Take what a job found; what windows are told of it."""
        if job.stage not in ("quick", "moving", "rest"):
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
        if outcome.seconds is not None and (job.stage != "quick" or not self._seconds):
            resting = job.stage == "rest"
            before = self._seconds.get(resting, outcome.seconds)
            self._seconds[resting] = min(outcome.seconds, 2.0 * before)  # other work on the machine only ever slows
        found = list(outcome.messages)
        self._moving = outcome.simulation if job.stage == "moving" and job.version == self.version else None
        if job.stage == "rest" and job.version == self.version:
            self.rest = outcome.simulation
            if self._pin_next and not self.adjustments and outcome.simulation is not None:
                self.behind, self._behind_of, self._pin_next = outcome.simulation, self._now, False
        self._remember(found)
        return [*over, *found]

    def _finish_shown(self, job: Job, outcome: Outcome) -> list[Message]:
        """Take what a job found that shows more of a run; one that failed is not tried again for the same."""
        self._done |= job.done
        if job.stage == "sketch":
            self._sketch_seconds = outcome.seconds or 0.0
        self._remember(outcome.messages)
        told = list(outcome.messages)
        if outcome.problem is not None or job.stage in self._failed:
            told.append({"kind": "trouble", "about": job.stage, "text": outcome.problem or ""})
        if outcome.problem is None:
            self._failed.discard(job.stage)
        else:
            self._failed.add(job.stage)
            told += self.superseded(job) if job.stage == "compare" else []
        return told

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


def _settings_text(model: CompiledModel) -> str:
    """`200,000 trials, Monte Carlo, seed 999`."""
    from xlmc.montecarlo.sampling.sampling_methods import METHODS

    settings = model.definitions.settings
    return f"{settings.trials:,} trials, {METHODS[settings.sampling].name}, seed {settings.seed}"
