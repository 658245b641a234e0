"""Goal seek at the base case: the value of one cell at which another has the value it is to have.

The range is scanned and every change of sign narrowed down, as the rows of `xlmc_solve` do in each trial of a run. So
all values are found that a fine scan can tell apart, and not only one near a guess. Without a range the scan goes
outwards from the value in the cell, in steps that double, as far as 10¹² times its size.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.shown import Shown
from xlmc.engine.engines import ENGINES
from xlmc.engine.roots import find_roots
from xlmc.errors import DefinitionError, SimulationError
from xlmc.excel.address import Cell, InFormula
from xlmc.excel.own_functions import OwnFunctions
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.cell_references import cell_of_reference, is_address, split_sheet
from xlmc.montecarlo.definitions.definitions import Definitions
from xlmc.montecarlo.definitions.definitions_reader import read_definitions
from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.distributions.spelling import did_you_mean, name_key
from xlmc.montecarlo.model.cell_forms import forms_of
from xlmc.montecarlo.model.data_tables import with_data_tables
from xlmc.montecarlo.model.labels import calculate_labels
from xlmc.montecarlo.model.solving import unknown_of, with_solved_cells
from xlmc.montecarlo.number_text import number_text

__all__ = ["Solutions", "seek"]

Floats = NDArray[np.float64]

_PARTS: Final = 256
"""Ranges that are scanned one by one, each in as many steps as `find_roots` takes."""

_NEAREST, _FARTHEST = -20, 40
"""Powers of two: the steps outwards, relative to the size of the cell's own value."""

_DRAWN: Final = 201
"""Points of the curve."""


@dataclass(frozen=True, slots=True, repr=False)
class Solutions(Shown):
    """What a search found.

    Attributes:
        workbook: that was searched in.
        cell: that is to have the value.
        to: the value.
        by: the cell that was varied.
        base: the value in that cell; None where it is blank.
        base_answer: what the cell is with it; None where that is no number.
        low: the lower end of the range.
        high: the upper end.
        values: `(r,)` all values of `by` at which the cell is `to`: ascending, or the nearest to the base first where
            no range was given.
        answers: `(r,)` what the cell is at these.
        throughout: ranges of `by` in which the cell is `to` everywhere, as finely as was looked; of each, `values` has
            both ends.
        curve: `(p,)` values of `by`, and `(p,)` what the cell is there; NaN where it has no number.
        form: how the numbers of the cell are written.
        form_by: how those of `by` are.
        number_style: the workbook's.
    """

    workbook: Workbook
    cell: Cell
    to: float
    by: Cell
    base: float | None
    base_answer: float | None
    low: float
    high: float
    values: Floats
    answers: Floats
    throughout: tuple[tuple[float, float], ...]
    curve: tuple[Floats, Floats]
    form: Form
    form_by: Form
    number_style: str = ""

    @property
    def value(self) -> float | None:
        """The first of the values; None where there is none."""
        return float(self.values[0]) if self.values.size else None


def seek(
    path: str | Path,
    cell: str,
    to: float,
    by: str,
    *,
    low: float | None = None,
    high: float | None = None,
    functions: OwnFunctions | None = None,
) -> Solutions:
    """Find the values of one cell at which another is what it is to be, every other input as the workbook has it.

    Args:
        path: of the workbook, which need not have any table of xlmc.
        cell: the one with a formula: `Model!D9`, a defined name, or the name of a forecast.
        to: what it is to be.
        by: the one to vary, without a formula; it may be an assumption or a decision, also by its name.
        low: the least value of that; it comes with `high`. Without them the search goes outwards from its own value.
        high: the largest one.
        functions: a person's own, which formulas may call.

    Raises:
        WorkbookError: the file cannot be read.
        DefinitionError: a cell is none, or the one does not depend on the other.
        SimulationError: an argument is out of its range, or an assumption has no base value.
        FormulaError: a cell between them cannot be computed.
    """
    _check(to, low, high)
    workbook = calculate_labels(read_workbook(path, functions=functions))
    definitions = read_definitions(workbook, ENGINES)
    wanted, unknown = (_cell(workbook, text, definitions) for text in (cell, by))
    if workbook.content(unknown).formula is not None:
        hint = "Name the input that is to be found"
        raise DefinitionError(f"{unknown} holds a formula, and only a cell without one can be varied", hint=hint)
    definitions = _without(with_solved_cells(workbook, _without(definitions, unknown)), unknown)
    definitions = with_data_tables(workbook, definitions, (unknown,))
    compiled = unknown_of(workbook, definitions, wanted, to, unknown, None, workbook.name)
    given = _bases(definitions, compiled.inputs)
    content = workbook.content(unknown).value
    base = float(content) if isinstance(content, int | float) and not isinstance(content, bool) else None
    edges = _outwards(base or 0.0) if low is None or high is None else np.linspace(low, high, _PARTS + 1)
    columns = {name: np.full(edges.size, value) for name, value in given.items()}
    function = compiled.evaluated(columns)

    def answers(at: Floats) -> Floats:
        """Return what the cell is where `by` is this."""
        parts = [at[start : start + edges.size] for start in range(0, at.size, edges.size)]
        result = [function(part, np.zeros(part.size, np.intp)) for part in parts]
        return np.concatenate([np.empty(0), *result]) + to

    values, throughout = _without_insides(np.unique(find_roots(function, edges[:-1], edges[1:]).values), answers, to)
    ends = float(edges[0]), float(edges[-1])
    if low is None or high is None:
        values = values[np.argsort(np.abs(values - (base or 0.0)), kind="stable")]
        ends = _shown_range(base or 0.0, values)
    at = np.linspace(*ends, _DRAWN)
    start = answers(np.full(1, base or 0.0))[0]
    form, form_by = forms_of(workbook, (wanted, unknown))
    return Solutions(
        workbook=workbook,
        cell=wanted,
        to=to,
        by=unknown,
        base=base,
        base_answer=float(start) if np.isfinite(start) else None,
        low=float(edges[0]),
        high=float(edges[-1]),
        values=values,
        answers=answers(values),
        throughout=throughout,
        curve=(at, answers(at)),
        form=form,
        form_by=form_by,
        number_style=definitions.settings.number_style,
    )


def _without_insides(
    values: Floats, answers: Callable[[Floats], Floats], to: float
) -> tuple[Floats, tuple[tuple[float, float], ...]]:
    """Return `(r,)` ascending values without those inside a range in which the cell is `to` throughout; and the ranges.

    A cell that is rounded, or is TRUE or FALSE, is exactly `to` at many points of a scan, one beside the other.
    """
    joined = answers((values[:-1] + values[1:]) / 2.0) == to
    begins, ends = (
        np.flatnonzero(np.diff(np.concatenate([[False], joined, [False]]).astype(int)) == step) for step in (1, -1)
    )
    inside = np.zeros(values.size, bool)
    inside[1:-1] = joined[:-1] & joined[1:]
    ranges = zip(values[begins].tolist(), values[ends].tolist(), strict=True)
    return values[~inside], tuple(ranges)


def _check(to: float, low: float | None, high: float | None) -> None:
    """Refuse arguments that are out of their range.

    Raises:
        SimulationError: one is.
    """
    if not np.isfinite(to):
        raise SimulationError(f"A cell cannot be {number_text(to)}", hint="Give a number")
    if (low is None) != (high is None):
        raise SimulationError("Only one end of the range is given", hint="Give both, or neither")
    if low is not None and high is not None and not (np.isfinite([low, high]).all() and low < high):
        raise SimulationError(
            f"The range from {number_text(low)} to {number_text(high)} is none", hint="Give the lower end first"
        )


def _cell(workbook: Workbook, text: str, definitions: Definitions) -> Cell:
    """Return the cell that a person names: by its address, a defined name, or the name of a row that has a cell.

    Raises:
        DefinitionError: it is none.
    """
    head, tail = split_sheet(text.strip().removeprefix("="))
    first = next(iter(workbook.sheets))
    if head is None and is_address(tail) and len(workbook.sheets) > 1:
        message = f"{text!r} names no sheet"
        raise DefinitionError(message, where=workbook.name, hint=f"Name it, such as {first}!{tail.upper()}")
    rows = [(each.name, each.cell) for each in definitions.forecasts]
    rows += [(each.name, each.cell) for each in definitions.assumptions]
    rows += [(each.name, each.cell) for each in definitions.decisions]
    named = {name_key(name): cell for name, cell in reversed(rows) if isinstance(cell, Cell)}
    try:
        return cell_of_reference(workbook, text.strip().removeprefix("="), first, Cell(first, 1, 1))
    except DefinitionError as error:
        result = named.get(name_key(text))
        if result is None:
            message, hint = f"{text!r} names no cell", error.hint
            known = did_you_mean(text, [name for name, _ in rows])
            if "did you mean" in known.casefold():
                hint = known
            raise DefinitionError(message, where=workbook.name, hint=hint) from error
        return result


def _without(definitions: Definitions, unknown: Cell) -> Definitions:
    """Return the definitions without a row that solves for a cell that is varied."""
    solves = tuple(each for each in definitions.solves if each.by != unknown)
    rewritten = {cell: tree for cell, tree in definitions.rewritten.items() if cell != unknown}
    return replace(definitions, solves=solves, rewritten=rewritten)


def _bases(definitions: Definitions, needed: tuple[str, ...]) -> dict[str, float]:
    """Return the base values of the assumptions that are needed.

    Raises:
        SimulationError: one has none.
    """
    result = {}
    for each in definitions.assumptions:
        if each.name in needed:
            if each.base is None:
                what = "draw" if isinstance(each.cell, InFormula) else "assumption"
                message = f"The {what} {each.name!r} has no base value"
                raise SimulationError(message, where=each.cell, hint="Type one into its cell")
            result[each.name] = each.base
    return result


def _outwards(base: float) -> Floats:
    """Return points on both sides of a value, at distances that double."""
    size = abs(base) or 1.0
    steps = size * 2.0 ** np.arange(_NEAREST, _FARTHEST + 0.5, 0.5)
    return np.concatenate([base - steps[::-1], [base], base + steps])


def _shown_range(base: float, values: Floats) -> tuple[float, float]:
    """Return the range of the curve: the value in the cell and the nearest that was found, with room on both sides."""
    nearest = values[:1].tolist()
    low, high = min([base, *nearest]), max([base, *nearest])
    room = 0.5 * (high - low) or 0.5 * (abs(base) or 1.0)
    return low - room, high + room
