"""One trial of a run at rest: what was drawn, what every formula gave, and whether the filters accept it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import islice
from typing import TYPE_CHECKING, Any, Final
from weakref import WeakKeyDictionary

import numpy as np

from xlmc.analysis.results.statements.in_words import limits_text
from xlmc.engine.engine import TEXT_RESULT, Column
from xlmc.engine.graph.nodes import Target
from xlmc.excel.functions.registry import Kind
from xlmc.montecarlo.loop.blocks import fault_text
from xlmc.montecarlo.model.cell_forms import content_in, forms_of
from xlmc.montecarlo.model.forecast_filters import conditions_of
from xlmc.montecarlo.number_text import count_text
from xlmc.outputs.document.html_writer import blocks_html
from xlmc.outputs.document.parts import Block, Paragraph, Table

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from xlmc.engine.engine import Evaluator
    from xlmc.excel.address import Cell
    from xlmc.montecarlo.definitions.definitions import Filter
    from xlmc.montecarlo.definitions.forms import Form
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["MOST_FORMULAS", "Step", "drawn_in", "step_html", "step_of"]

MOST_FORMULAS: Final = 1_000
"""Formulas that are shown: a table of more could not be read."""

_TOGETHER: Final = 2_048
"""Trials that are computed at a time, as in a short run: the last bit of a trial may depend on where it stands."""

_PREPARED: Final[WeakKeyDictionary[CompiledModel, Step]] = WeakKeyDictionary()


class Step:
    """What computes the cells of single trials of a model.

    Attributes:
        formulas: the cells of the formulas that are shown, in the order in which they are computed.
        left: how many more there are.
        filters: what accepts trials, but for evidence that keeps them by chance: no run holds its random numbers.
        by_chance: that evidence.
        forms: of each cell that is shown, how its numbers are written.
    """

    def __init__(self, model: CompiledModel) -> None:
        needed = model.needed.graph.formulas
        self.formulas: tuple[Cell, ...] = tuple(islice(needed, MOST_FORMULAS))
        self.left = len(needed) - len(self.formulas)
        every: tuple[Filter, ...] = (*model.filters, *model.forecast_filters)
        conditions = (*model.filter_targets, *conditions_of(model.forecast_filters))
        self.by_chance = [each for each in every if each.evidence is not None and each.evidence.by_chance]
        self.filters = [each for each in every if each not in self.by_chance]
        answers = (*(each.cell for each in every), *(each.cell for each in model.forecasts))
        self._cells = tuple(dict.fromkeys((*self.formulas, *answers)))
        targets = [each for of, each in zip(every, conditions, strict=True) if of in self.filters]
        targets += [Target(cell, cell) for cell in self._cells]
        kinds = [model.lowering.dag.types[model.lowering.target(each)] for each in targets]
        self._logical = [kind is Kind.LOGICAL for kind in kinds]
        cells = tuple(dict.fromkeys((*(each.cell for each in model.live), *self._cells)))
        self.forms: Mapping[Cell, Form] = dict(zip(cells, forms_of(model.workbook, cells), strict=True))
        self._evaluator: Evaluator = model.evaluator(targets, _TOGETHER)

    def at(
        self, draws: Mapping[str, NDArray[np.float64]], trial: int
    ) -> tuple[list[bool | None], dict[Cell, float | bool | str]]:
        """Return whether each filter holds in a trial, None for an error in it, and the value of each cell.

        Args:
            draws: assumption -> its draws in the first trials, `(n,)`.
            trial: which of them.
        """
        start = trial - trial % _TOGETHER
        block = {name: np.array(values[start : start + _TOGETHER]) for name, values in draws.items()}
        count = min(values.size for values in block.values())
        columns = self._evaluator.filters(block, count)
        values = [
            _value(column, trial - start, logical=logical)
            for column, logical in zip(columns, self._logical, strict=True)
        ]
        count = len(self.filters)
        holds = [None if isinstance(each, str) else bool(each) for each in values[:count]]
        return holds, dict(zip(self._cells, values[count:], strict=True))


def _value(column: Column, trial: int, *, logical: bool) -> float | bool | str:
    """Return what a cell holds: a number, a logical, a text, or what stands for an error or a blank."""
    at = trial if column.values.size > 1 else 0
    code = 0 if column.codes is None else int(column.codes[at])
    if code == TEXT_RESULT and column.texts is not None:
        return str(column.texts[at])
    if code:
        return fault_text(code)
    value: Any = column.values[at]
    return bool(value) if logical else float(value)


def step_of(run: RunResult, trial: int) -> dict[str, Any]:
    """Return a trial as tables: `html`, the number of the trial from 0, and how many trials can be stepped through.

    Args:
        run: at rest.
        trial: its number among the first trials of the run, whether they were accepted or not; for a number beyond
            the last one of those.
    """
    trials = min((values.size for values in drawn_in(run).values()), default=0)
    if not trials:
        html = blocks_html([Paragraph("Nothing is drawn, so that all trials are the base case.", "small")]).source
        return {"html": html, "trial": 0, "trials": 0}
    trial = min(trial, trials - 1)
    return {"html": step_html(run, trial), "trial": trial, "trials": trials}


def drawn_in(run: RunResult) -> Mapping[str, NDArray[np.float64]]:
    """Return assumption -> draws of the first trials, `(n,)`; of the accepted ones where a run keeps no others."""
    return run.prior if any(values.size for values in run.prior.values()) else run.inputs


def step_html(run: RunResult, trial: int) -> str:
    """Write the tables of a trial: what was drawn, filters, forecasts, and all formulas."""
    model = run.model
    if model not in _PREPARED:
        _PREPARED[model] = Step(model)
    step = _PREPARED[model]
    draws = drawn_in(run)
    holds, values = step.at(draws, trial)
    text = {cell: _text(value, step.forms[cell]) for cell, value in values.items()}
    drawn = [
        (each.name, str(each.cell), _text(float(draws[each.name][trial]), step.forms[each.cell]), each.units)
        for each in model.live
    ]
    word_of = {True: "yes", False: "no", None: "error"}
    words = [(each, word_of[met]) for each, met in zip(step.filters, holds, strict=True)]
    words += [(each, "by chance") for each in step.by_chance]
    asked = [(each.name, str(each.cell), limits_text(each), text[each.cell], word) for each, word in words]
    answers = [(each.name, str(each.cell), text[each.cell], each.units) for each in model.forecasts]
    formulas = [(str(cell), model.needed.graph.text(cell), text[cell]) for cell in step.formulas]
    message = f"{count_text(step.left)} more formulas are not shown." if step.left else ""
    blocks: list[Block] = [
        Paragraph(_verdict(run, trial, step, holds)),
        Table("", ("Drawn", "Cell", "Value", "Units"), tuple(drawn), right=(2,), caption="Assumptions"),
        *([_filters_table(asked)] if asked else []),
        Table("", ("Forecast", "Cell", "Value", "Units"), tuple(answers), right=(2,), caption="Forecasts"),
        Table("", ("Cell", "Formula", "Value"), tuple(formulas), right=(2,), caption="Formulas"),
        *([Paragraph(message, "small")] if message else []),
    ]
    return blocks_html(blocks).source


def _filters_table(rows: Sequence[tuple[str, ...]]) -> Table:
    return Table("", ("Filter", "Cell", "Holds if", "Value", "Holds"), tuple(rows), right=(3,), caption="Filters")


def _verdict(run: RunResult, trial: int, step: Step, holds: Sequence[bool | None]) -> str:
    """Say whether the filters of all forecasts accept a trial, and which do not."""
    which = f"Trial {count_text(trial + 1)}"
    asked = [(each, met) for each, met in zip(step.filters, holds, strict=True) if each in run.model.filters]
    against = [each.name for each, met in asked if met is False]
    wrong = [each.name for each, met in asked if met is None]
    if against:
        return f"{which} is rejected by: {'; '.join(against)}."
    if wrong:
        return f"{which} is lost: there is an error in {'; '.join(wrong)}."
    if step.by_chance:
        return f"{which} meets every limit; evidence keeps it by chance: {'; '.join(e.name for e in step.by_chance)}."
    weighted = "; evidence gives it a weight" if run.weighting is not None else ""
    return f"{which} is accepted{weighted}."


def _text(value: float | bool | str, form: Form) -> str:
    """Write what a cell holds, as the cell shows it."""
    return content_in(form, value) if isinstance(value, str) or np.isfinite(value) else "no number"
