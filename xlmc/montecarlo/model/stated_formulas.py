"""Numbers of definitions that formulas compute, as people read them: `180,000 (=Estimate!B2)`, at the base case."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final

from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import Assumption, Definitions, Filter
from xlmc.montecarlo.statistics.number_text import exact_text

__all__ = ["with_stated_formulas"]

_LONGEST: Final = 40
"""Characters of a formula; a longer one is named by its cell."""

Values = Callable[[Sequence[Cell]], Mapping[Cell, float]]


def with_stated_formulas(
    workbook: Workbook, given: Definitions, definitions: Definitions, values: Values
) -> Definitions:
    """Return the definitions with each number that a formula computes in words.

    Args:
        workbook: that holds the formulas.
        given: the definitions as they were read.
        definitions: the same, with numbers where no assumption may vary them.
        values: computes cells at the base case, those that can be.
    """
    limits = (*definitions.filters, *definitions.forecast_filters)
    asked: list[Assumption | Filter] = [*definitions.assumptions, *limits, *given.assumptions]
    if not any(each.formulas for each in asked):
        return definitions
    cells = [cell for each in asked for cell in each.formulas.values()]
    known = _saved(workbook, cells)
    missing = [cell for cell in dict.fromkeys(cells) if cell not in known]
    known = {**known, **values(missing)} if missing else known
    read = {each.name: each.formulas for each in given.assumptions}
    return replace(
        definitions,
        assumptions=tuple(
            _assumption(workbook, each, read.get(each.name, {}), known) for each in definitions.assumptions
        ),
        filters=tuple(_filter(workbook, each, known) for each in definitions.filters),
        forecast_filters=tuple(_filter(workbook, each, known) for each in definitions.forecast_filters),
    )


def _saved(workbook: Workbook, cells: Iterable[Cell]) -> dict[Cell, float]:
    """Return the values that the file holds; none where they may be older than the formulas."""
    if workbook.may_be_stale:
        return {}
    found = {cell: workbook.content(cell).value for cell in cells}
    return {
        cell: float(value)
        for cell, value in found.items()
        if isinstance(value, int | float) and not isinstance(value, bool)
    }


def _assumption(
    workbook: Workbook, assumption: Assumption, read: Mapping[str, Cell], known: Mapping[Cell, float]
) -> Assumption:
    stated = {}
    for key, cell in {**read, **assumption.formulas}.items():
        number = assumption.given.get(key)
        value = known.get(cell) if isinstance(number, Cell) or number is None else number
        stated[key] = _text(workbook, cell, value)
    return replace(assumption, stated=stated) if stated else assumption


def _filter(workbook: Workbook, filter_: Filter, known: Mapping[Cell, float]) -> Filter:
    stated = {key: _text(workbook, cell, known.get(cell)) for key, cell in filter_.formulas.items()}
    return replace(filter_, stated=stated) if stated else filter_


def _text(workbook: Workbook, cell: Cell, value: float | None) -> str:
    formula = workbook.content(cell).formula
    text = "" if formula is None else f"={formula.text}"
    whole = text if "!" in text or "[" in text else f"{cell}: {text}"
    shown = whole if 0 < len(text) <= _LONGEST else str(cell)
    return shown if value is None else f"{exact_text(value)} ({shown})"
