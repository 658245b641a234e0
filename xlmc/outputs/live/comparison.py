"""All scenarios of a window in one table, whose runs are kept while it is made: it can be given up and resumed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from xlmc.analysis.studies.scenario_answers import answers_of, model_of, run_scenario
from xlmc.errors import XlmcError
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.outputs.live.adjusted_scenarios import scenario_of
from xlmc.outputs.live.adjustments import Adjustments
from xlmc.outputs.live.frames import scenarios_html

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.scenarios import Scenario
    from xlmc.montecarlo.loop.stopping import Progress
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["Comparison"]


class Comparison:
    """See the module. For one thread.

    Args:
        own: the workbook's model.
        stored: scenarios of the window, by name; they take the place of the workbook's of the same name.
        piece: trials after which it is looked whether the table is still wanted.
        in_memory: bytes of the trials of all runs together that stay in memory.
        asked: trials and seed, where they are not those of the workbook.
    """

    def __init__(
        self,
        own: CompiledModel,
        stored: Mapping[str, Adjustments],
        piece: int,
        in_memory: int | None = None,
        asked: RunOptions | None = None,
    ) -> None:
        self._asked = asked or RunOptions()
        fitting = {name: each.only(own.definitions) for name, each in stored.items()}
        mine = [scenario_of(own.definitions, name, each) for name, each in fitting.items()]
        self._own, self._piece = own, piece
        self._scenarios = [*(each for each in own.definitions.scenarios if each.name not in stored), *mine]
        self._of_a_run = None if in_memory is None else in_memory // (len(self._scenarios) + 1)
        self._base: RunResult | None = None
        self._runs: dict[str, RunResult | str] = {}

    def html(self, go_on: Callable[[], None], report_share: Callable[[float], None]) -> str:
        """Do what is not done yet, and write the table; a scenario that is not possible is a row that says why.

        Args:
            go_on: called again and again; what it raises ends the work until this is called again.
            report_share: takes the share that is done.

        Raises:
            XlmcError: the workbook as it is cannot be run.
        """
        count = len(self._scenarios) + 1

        def watch(progress: Progress) -> None:
            go_on()
            done = len(self._runs) + (self._base is not None)
            report_share((done + progress.share) / count)

        if self._base is None:
            options = replace(self._asked, scenarios=True, in_memory=self._of_a_run)
            self._base = run_model(self._own, options, progress=watch, pieces=self._piece)
        for scenario in self._scenarios:
            go_on()
            if scenario.name not in self._runs:
                self._runs[scenario.name] = self._run(scenario, self._base, watch)
        runs = {each.name: self._runs[each.name] for each in self._scenarios}
        answers = [answers_of(self._base, None, self._base)]
        for scenario in self._scenarios:
            go_on()
            if not isinstance(run := runs[scenario.name], str):
                answers.append(answers_of(run, scenario, self._base))
        return scenarios_html(answers, {name: why for name, why in runs.items() if isinstance(why, str)})

    def _run(self, scenario: Scenario, base: RunResult, watch: Callable[[Progress], None]) -> RunResult | str:
        """Run a scenario; returns why it is not possible where it is not."""
        try:
            model = model_of(self._own, scenario)
            return run_scenario(model, base, progress=watch, pieces=self._piece, in_memory=self._of_a_run)
        except XlmcError as error:
            return str(error)
